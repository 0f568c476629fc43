//! How far two outlines are apart.

use crate::plane::{BoundaryIndex, Region};

/// Outlines are compared at their vertices and at points no farther apart than this, in parts of the em: between such points
/// two smooth outlines hardly come nearer or part.
const SPACING: f64 = 4e-3;

/// At most so many points on one element.
const MOST_POINTS: f64 = 64.0;

/// The largest distance from a point of either outline to the other, in font units; infinite where only one is empty.
pub(super) fn deviation(a: (&Region, &BoundaryIndex), b: (&Region, &BoundaryIndex), units_per_em: f64) -> f64 {
    if a.0.is_empty() && b.0.is_empty() {
        return 0.0;
    }
    one_way(a.0, b.1, units_per_em).max(one_way(b.0, a.1, units_per_em))
}

fn one_way(from: &Region, to: &BoundaryIndex, units_per_em: f64) -> f64 {
    let mut farthest = 0.0f64;
    for segment in from.segments() {
        let count = (segment.length() / (SPACING * units_per_em)).ceil().clamp(1.0, MOST_POINTS);
        for k in 0..count as usize {
            let p = segment.point_at(k as f64 / count);
            // Most points are nearer than the farthest so far.
            if !to.is_nearer(p, farthest) {
                farthest = farthest.max(to.distance(p));
            }
        }
    }
    farthest
}
