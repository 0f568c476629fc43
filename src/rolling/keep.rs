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
            let mut group: Vec<usize> = (0..self.parts.len()).collect();
            let mut affected = vec![false; group.len()];
            for (i, j) in merge::meetings(&self.region(), self.r, self.resolution) {
                let (a, b) = (owner[i], owner[j]);
                // What was closed in the plane and seems to cross itself does so by rounding.
                if a == b && self.parts[a].merged {
                    continue;
                }
                affected[a] = true;
                affected[b] = true;
                let (from, to) = (group[a].max(group[b]), group[a].min(group[b]));
                group.iter_mut().filter(|g| **g == from).for_each(|g| *g = to);
            }
            if !affected.contains(&true) {
                return;
            }
            let mut parts = std::mem::take(&mut self.parts);
            for first in 0..parts.len() {
                if group[first] != first {
                    continue;
                }
                let part = if affected[first] {
                    let of = (first..parts.len()).filter(|&k| group[k] == first).flat_map(|k| parts[k].of.clone());
                    self.closed(of.collect())
                } else {
                    let Part { of, rings, merged } = &mut parts[first];
                    Part { of: std::mem::take(of), rings: std::mem::take(rings), merged: *merged }
                };
                self.parts.push(part);
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
