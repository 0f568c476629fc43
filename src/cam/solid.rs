//! What must remain, arranged for distance queries.

use crate::plane::{BoundaryIndex, Point, Region, Segment};

/// Which side of a region's boundary must remain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Remainder {
    /// The region: a part is cut out of the stock.
    #[default]
    Inside,
    /// Everything but the region: a pocket or an opening is cut into the stock.
    Outside,
}

/// A region or what is around it.
pub(super) struct Solid {
    pub(super) boundary: BoundaryIndex,
    remainder: Remainder,
}

/// Most evaluations in the search along one element.
const MOST_EVALUATIONS: usize = 20_000;

impl Solid {
    pub(super) fn new(region: &Region, remainder: Remainder) -> Solid {
        Solid { boundary: BoundaryIndex::new(region), remainder }
    }

    pub(super) fn contains(&self, p: Point) -> bool {
        (self.boundary.winding_number(p) > 0) == (self.remainder == Remainder::Inside)
    }

    /// How deep `p` lies in the solid; negative outside of it.
    pub(super) fn depth(&self, p: Point) -> f64 {
        let distance = self.boundary.distance(p);
        if self.contains(p) { distance } else { -distance }
    }

    /// The deepest point of `element` in the solid and its depth, within `tolerance`.
    ///
    /// Depth changes by no more than the way, so that an interval whose ends are shallow cannot hide a deep middle. What
    /// is not deeper than `known` is not searched for, and some end of the element returned instead.
    pub(super) fn deepest(&self, element: &Segment, known: f64, tolerance: f64) -> (f64, Point) {
        let length = element.length();
        let at = |t: f64| {
            let p = element.point_at(t);
            (self.depth(p), p)
        };
        let (first, last) = (at(0.0), at(1.0));
        let mut best = if first.0 >= last.0 { first } else { last };
        let mut open = vec![(0.0, first.0, 1.0, last.0)];
        let mut evaluations = 0;
        while let Some((t0, d0, t1, d1)) = open.pop() {
            let highest = 0.5 * (d0 + d1 + (t1 - t0) * length);
            if highest <= best.0.max(known) + tolerance || evaluations >= MOST_EVALUATIONS {
                continue;
            }
            evaluations += 1;
            let t = 0.5 * (t0 + t1);
            let middle = at(t);
            if middle.0 > best.0 {
                best = middle;
            }
            open.push((t0, d0, t, middle.0));
            open.push((t, middle.0, t1, d1));
        }
        best
    }
}
