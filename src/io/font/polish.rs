//! Rounded points moved by single units to where the contour is nearer to the outline.
//!
//! Rounding each point by itself may add up where a control point and its knots go the same way. Here every point that is part
//! of such a place tries its eight neighbours on the grid, and takes the one that is best for all it is part of; what
//! the font itself had on the grid stays.

use super::grid::{Placed, Rounded};
use crate::plane::{BoundaryIndex, Point, Vector};

/// Points try to move where the contour is off by more than this part of the tolerance.
const WORTH_IT: f64 = 0.6;

/// Rounds over the contour: each can only make it better, and few are needed.
const ROUNDS: usize = 4;

/// What a kink costs, by how far the knot is from the line through its neighbours.
const KINK_COST: f64 = 0.1;

/// Parts of a curve between the points where it is measured.
const PARTS: usize = 6;

/// Moves the movable points of a contour towards `exact`.
pub(super) fn polish(rounded: &mut Rounded, exact: &BoundaryIndex, tolerance: f64) {
    let n = rounded.points.len();
    if n < 3 {
        return;
    }
    for _ in 0..ROUNDS {
        let mut moved = false;
        for k in 0..n {
            if !(rounded.points[k].is_free && rounded.points[k].is_smooth) {
                continue;
            }
            let (off, mut least) = cost(&rounded.points, k, exact, f64::INFINITY);
            if off <= WORTH_IT * tolerance {
                continue;
            }
            let place = rounded.points[k].point;
            let mut best = place;
            for step in STEPS {
                rounded.points[k].point = place + Vector::new(step[0], step[1]);
                let (_, cost) = cost(&rounded.points, k, exact, least);
                if cost < least {
                    (best, least) = (rounded.points[k].point, cost);
                }
            }
            rounded.points[k].point = best;
            moved |= best != place;
        }
        if !moved {
            return;
        }
    }
}

/// To the neighbours on the grid.
const STEPS: [[f64; 2]; 8] =
    [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];

/// A turn (radians) that is a corner, and no kink in a smooth outline.
const CORNER: f64 = 0.3;

/// How far what point `k` is part of is from the outline, and what that and the kinks in it cost; where it costs more than
/// `limit`, as much as is known.
fn cost(contour: &[Placed], k: usize, exact: &BoundaryIndex, limit: f64) -> (f64, f64) {
    let n = contour.len();
    let at = |i: usize| contour[(k + n + i - 2) % n];
    // The points from one before to one after, and what lies next to them.
    let mut farthest = 0.0f64;
    let mut kinks = 0.0;
    for i in 1..4 {
        let [before, point, after] = [at(i - 1), at(i), at(i + 1)];
        let (incoming, outgoing) = (point.point - before.point, after.point - point.point);
        if point.on_curve {
            if after.on_curve && i < 3 {
                farthest = off(farthest, |t| point.point + outgoing * t, exact);
            }
            let turn = incoming.perp(&outgoing).abs().atan2(incoming.dot(&outgoing));
            if turn < CORNER
                && let Some(along) = (after.point - before.point).try_normalize(0.0)
            {
                kinks += along.perp(&incoming).abs();
            }
        } else {
            let end = |p: Placed| if p.on_curve { p.point } else { nalgebra::center(&p.point, &point.point) };
            let (a, b) = (end(before), end(after));
            let curve = |t: f64| {
                let s = 1.0 - t;
                Point::from(a.coords * (s * s) + point.point.coords * (2.0 * s * t) + b.coords * (t * t))
            };
            farthest = off(farthest, curve, exact);
        }
        if farthest > limit {
            return (farthest, farthest);
        }
    }
    (farthest, farthest + KINK_COST * kinks)
}

/// The largest distance of points along a curve from the outline, or `farthest` where that is larger.
fn off(mut farthest: f64, curve: impl Fn(f64) -> Point, exact: &BoundaryIndex) -> f64 {
    for k in 0..=PARTS {
        let p = curve(k as f64 / PARTS as f64);
        if !exact.is_nearer(p, farthest) {
            farthest = farthest.max(exact.distance(p));
        }
    }
    farthest
}
