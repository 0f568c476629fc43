//! Every ring by itself: the limit of the flow, which sees distance along the curve only.
//!
//! The flow moves a curve outward, and where two curves come to cross each other there is no region any more that they
//! bound. So rings are rolled along one by one; those that have run into each other, or one into itself, are replaced by
//! the boundary of what they hold together, and the disk rolls along that: away from the crossings nothing of them
//! changes. What that does not settle is closed in the plane, ring by ring, which holds whatever the flow could fill.

use super::unite::Meetings;
use super::{close_merged, scan};
use crate::plane::{Point, Region, Ring};

/// How often rings are united that have run into each other, before they are closed in the plane.
pub(super) const ROUNDS: usize = 8;

/// What becomes of some rings of the input.
#[derive(Default)]
struct Part {
    /// Which rings of the input.
    of: Vec<usize>,
    rings: Vec<Rolled>,
    /// Whether they are closed in the plane: that is final.
    merged: bool,
}

/// A ring that the disk has been rolled along.
struct Rolled {
    ring: Ring,
    /// Whether to the end: where a curve has run into itself the disk finds no way on.
    finished: bool,
}

/// The rings of a region, rolled along.
pub(super) struct Kept<'a> {
    input: &'a Region,
    r: f64,
    resolution: f64,
    parts: Vec<Part>,
    /// Where rings were united, and a point of every ring that was closed in the plane.
    pub(super) places: Vec<Point>,
    /// What those closings say against themselves.
    pub(super) contradictions: usize,
}

impl<'a> Kept<'a> {
    pub(super) fn new(input: &'a Region, r: f64, resolution: f64) -> Kept<'a> {
        let mut kept = Kept { input, r, resolution, parts: vec![], places: vec![], contradictions: 0 };
        for (k, ring) in input.rings.iter().enumerate() {
            let rings = kept.rolled(ring).into_iter().collect();
            kept.parts.push(Part { of: vec![k], rings, merged: false });
        }
        kept
    }

    /// A ring with the disk rolled along it; nothing is left of a hole that is filled.
    fn rolled(&self, ring: &Ring) -> Option<Rolled> {
        let scan = scan::scan(ring, self.r, scan::Mode::Geodesic, self.resolution);
        (!scan.ring.is_empty() || !scan.finished).then_some(Rolled { ring: scan.ring, finished: scan.finished })
    }

    /// What the rings have become.
    pub(super) fn region(&self) -> Region {
        Region::new(self.parts.iter().flat_map(|part| &part.rings).map(|rolled| rolled.ring.clone()).collect())
    }

    /// Whether the disk has been rolled along every ring to its end.
    pub(super) fn is_finished(&self) -> bool {
        self.parts.iter().flat_map(|part| &part.rings).all(|rolled| rolled.finished)
    }

    /// Unites what has run into each other, until nothing does, in so many rounds; then what still does is closed in the
    /// plane.
    pub(super) fn unite(&mut self, rounds: usize) {
        // An opening is the closing of what is empty, and far away that is solid.
        let far = i32::from(self.input.area() < 0.0);
        for round in 0.. {
            let region = self.region();
            let owner: Vec<usize> =
                self.parts.iter().enumerate().flat_map(|(k, part)| part.rings.iter().map(move |_| k)).collect();
            // What was closed in the plane and seems to cross itself does so by rounding.
            let counts = |i: usize, j: usize| owner[i] != owner[j] || !self.parts[owner[i]].merged;
            let meetings = Meetings::new(&region, self.r, self.resolution, counts);
            let mut groups = Groups::new(self.parts.len());
            let mut met = Met { parts: vec![false; self.parts.len()], rings: vec![false; owner.len()] };
            for (i, j, place) in meetings.places() {
                for ring in [i, j] {
                    met.rings[ring] = true;
                    met.parts[owner[ring]] = true;
                }
                groups.join(owner[i], owner[j]);
                self.places.push(place);
            }
            // Nothing but the plane helps where the disk finds no way on and nothing crosses.
            let rings = self.parts.iter().flat_map(|part| &part.rings).zip(&met.rings);
            let stuck: Vec<usize> =
                rings.zip(&owner).filter(|((rolled, met), _)| !rolled.finished && !**met).map(|(_, &k)| k).collect();
            if stuck.is_empty() && !met.parts.contains(&true) {
                return;
            }
            // Every round in the plane leaves fewer parts, or fewer that are not final: this ends.
            let (united, open) = if round < rounds { meetings.united(far) } else { (vec![], vec![]) };
            let mut hopeless = if round < rounds { vec![false; self.parts.len()] } else { met.parts.clone() };
            let open = open.into_iter().map(|ring| owner[ring]);
            stuck.into_iter().chain(open).for_each(|k| hopeless[groups.first(k)] = true);
            let united = united.into_iter().map(|u| (groups.first(owner[u.of]), u.ring)).collect();
            self.regroup(&met, &mut groups, united, &hopeless);
        }
    }

    /// Every group of parts that have met becomes one part: of the rings that did not meet and those that were `united`, by
    /// the first part of their group; or it is closed in the plane if that first part is `hopeless`.
    fn regroup(&mut self, met: &Met, groups: &mut Groups, united: Vec<(usize, Ring)>, hopeless: &[bool]) {
        let parts = std::mem::take(&mut self.parts);
        let mut together: Vec<Part> = parts.iter().map(|_| Part::default()).collect();
        let mut ring_met = met.rings.iter();
        for (k, part) in parts.into_iter().enumerate() {
            let group = &mut together[groups.first(k)];
            group.of.extend(part.of);
            group.merged = part.merged && !met.parts[k];
            group.rings.extend(part.rings.into_iter().filter(|_| ring_met.next() != Some(&true)));
        }
        for (group, ring) in united.into_iter().filter(|(group, _)| !hopeless[*group]) {
            together[group].rings.extend(self.rolled(&ring));
        }
        for (part, hopeless) in together.into_iter().zip(hopeless).filter(|(part, _)| !part.of.is_empty()) {
            let part = if *hopeless { self.closed(part.of) } else { part };
            self.parts.push(part);
        }
    }

    /// Some rings of the input, closed in the plane.
    fn closed(&mut self, of: Vec<usize>) -> Part {
        let rings: Vec<Ring> = of.iter().map(|&k| self.input.rings[k].clone()).collect();
        self.places.extend(rings.iter().filter_map(|ring| ring.vertices.first()).map(|v| v.point));
        let outcome = close_merged(&Region::new(rings), self.r, self.resolution);
        self.contradictions += outcome.contradictions;
        let rings = outcome.region.rings.into_iter().map(|ring| Rolled { ring, finished: true }).collect();
        Part { of, rings, merged: true }
    }
}

/// What has run into something.
struct Met {
    parts: Vec<bool>,
    /// Of all rings, those of one part after those of the part before.
    rings: Vec<bool>,
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
