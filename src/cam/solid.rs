//! What must remain, arranged for distance queries.

use crate::plane::{BoundaryIndex, Link, Point, Region, Segment};

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
    pub(super) remainder: Remainder,
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

    /// The deepest point of `element` in the solid and its depth, within `tolerance`.
    ///
    /// Depth changes by no more than the way, so that an interval whose ends are shallow cannot hide a deep middle. Nor is
    /// a straight stretch anywhere farther from a straight piece of the boundary than at its ends, which ends the search at
    /// once where a path follows the boundary. What is not deeper than `known` is not searched for, and some end of the
    /// element returned instead.
    pub(super) fn deepest(&self, element: &Segment, known: f64, tolerance: f64) -> (f64, Point) {
        let length = element.length();
        let bulge = |share: f64| match element.link {
            Link::Line => 0.0,
            Link::Arc(arc) => arc.radius * (1.0 - (0.5 * share * element.sweep()).cos()),
        };
        let at = |t: f64| {
            let point = element.point_at(t);
            let (nearest, distance) = self.boundary.nearest(point).map_or((0, f64::INFINITY), |(i, n)| (i, n.distance));
            Sample { t, point, nearest, depth: if self.contains(point) { distance } else { -distance } }
        };
        let (first, last) = (at(0.0), at(1.0));
        let mut best = if first.depth >= last.depth { first } else { last };
        let mut open = vec![(first, last)];
        let mut evaluations = 0;
        while let Some((a, b)) = open.pop() {
            let share = b.t - a.t;
            let mut highest = 0.5 * (a.depth + b.depth + share * length);
            for own in [a.nearest, b.nearest] {
                if let Some(piece) = self.boundary.segments().get(own).filter(|s| s.link == Link::Line) {
                    let ends = piece.nearest(a.point).distance.max(piece.nearest(b.point).distance);
                    highest = highest.min(ends + bulge(share));
                }
            }
            if highest <= best.depth.max(known) + tolerance || evaluations >= MOST_EVALUATIONS {
                continue;
            }
            evaluations += 1;
            let middle = at(0.5 * (a.t + b.t));
            if middle.depth > best.depth {
                best = middle;
            }
            open.push((a, middle));
            open.push((middle, b));
        }
        (best.depth, best.point)
    }
}

/// A place of an element.
#[derive(Clone, Copy)]
struct Sample {
    t: f64,
    point: Point,
    /// The piece of the boundary that is nearest.
    nearest: usize,
    depth: f64,
}
