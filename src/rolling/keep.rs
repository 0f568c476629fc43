//! Every ring by itself: the limit of the flow, which sees distance along the curve only.
//!
//! The flow moves a curve outward, and where two curves come to cross each other there is no region any more that they
//! bound. So rings are rolled along one by one; those that run into each other, or one into itself, are closed in the
//! plane, together and without the others. That holds whatever the flow could fill, and bounds a region.

use super::{close_merged, merge, scan};
use crate::plane::{Point, Region, Ring};

/// What becomes of some rings of the input.
struct Part {
    /// Which rings of the input.
    of: Vec<usize>,
    rings: Vec<Ring>,
    /// Whether they are closed in the plane: that is final.
    merged: bool,
}

/// The rings of a region, rolled along.
pub(super) struct Kept<'a> {
    input: &'a Region,
    r: f64,
    resolution: f64,
    parts: Vec<Part>,
    /// A point of every ring that was closed in the plane.
    pub(super) places: Vec<Point>,
    /// What those closings say against themselves.
    pub(super) contradictions: usize,
}

impl<'a> Kept<'a> {
    pub(super) fn new(input: &'a Region, r: f64, resolution: f64) -> Kept<'a> {
        let mut kept = Kept { input, r, resolution, parts: vec![], places: vec![], contradictions: 0 };
        for (k, ring) in input.rings.iter().enumerate() {
            let scan = scan::scan(ring, r, scan::Mode::Geodesic, resolution);
            let part = if scan.finished {
                // Nothing is left of a hole that is filled.
                let rings = if scan.ring.is_empty() { vec![] } else { vec![scan.ring] };
                Part { of: vec![k], rings, merged: false }
            } else {
                kept.closed(vec![k])
            };
            kept.parts.push(part);
        }
        kept
    }

    /// What the rings have become.
    pub(super) fn region(&self) -> Region {
        Region::new(self.parts.iter().flat_map(|part| &part.rings).cloned().collect())
    }

    /// Closes together what has run into each other, until nothing does.
    pub(super) fn part_ways(&mut self) {
        loop {
            let owner: Vec<usize> =
                self.parts.iter().enumerate().flat_map(|(k, part)| part.rings.iter().map(move |_| k)).collect();
            let mut groups = Groups::new(self.parts.len());
            let mut affected = vec![false; self.parts.len()];
            for (i, j) in merge::meetings(&self.region(), self.r, self.resolution) {
                let (a, b) = (owner[i], owner[j]);
                // What was closed in the plane and seems to cross itself does so by rounding.
                if a == b && self.parts[a].merged {
                    continue;
                }
                affected[a] = true;
                affected[b] = true;
                groups.join(a, b);
            }
            // Every round leaves fewer parts, or fewer that are not final: this ends.
            if !affected.contains(&true) {
                return;
            }
            let parts = std::mem::take(&mut self.parts);
            let mut together: Vec<Vec<usize>> = vec![vec![]; parts.len()];
            for (k, part) in parts.iter().enumerate() {
                together[groups.first(k)].extend(&part.of);
            }
            for (k, part) in parts.into_iter().enumerate() {
                if !affected[k] {
                    self.parts.push(part);
                } else if groups.first(k) == k {
                    let part = self.closed(std::mem::take(&mut together[k]));
                    self.parts.push(part);
                }
            }
        }
    }

    /// Some rings of the input, closed in the plane.
    fn closed(&mut self, of: Vec<usize>) -> Part {
        let rings: Vec<Ring> = of.iter().map(|&k| self.input.rings[k].clone()).collect();
        self.places.extend(rings.iter().filter_map(|ring| ring.vertices.first()).map(|v| v.point));
        let outcome = close_merged(&Region::new(rings), self.r, self.resolution);
        self.contradictions += outcome.contradictions;
        Part { of, rings: outcome.region.rings, merged: true }
    }
}

/// Which parts belong together.
struct Groups {
    /// Of every part one of its group that does not come after it; the first of a group is its own.
    before: Vec<usize>,
}

impl Groups {
    fn new(count: usize) -> Groups {
        Groups { before: (0..count).collect() }
    }

    /// The first of the group of `k`.
    fn first(&mut self, mut k: usize) -> usize {
        while self.before[k] != k {
            self.before[k] = self.before[self.before[k]];
            k = self.before[k];
        }
        k
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.first(a), self.first(b));
        self.before[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_grow_together_under_their_first_part() {
        let mut groups = Groups::new(7);
        for (a, b) in [(5, 4), (3, 4), (1, 6), (6, 6), (6, 3)] {
            groups.join(a, b);
        }
        let firsts: Vec<usize> = (0..7).map(|k| groups.first(k)).collect();
        assert_eq!(firsts, [0, 1, 2, 1, 1, 1, 1]);
    }
}
