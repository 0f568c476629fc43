//! How far two outlines are apart.

use crate::plane::{BoundaryIndex, Point, Region};

/// Outlines are compared at their vertices and at points no farther apart than this, in parts of the em. Two smooth outlines
/// part between such points by the square of it over their radii; at four units of a thousand that was a hundredth of one.
const SPACING: f64 = 1e-3;

/// At most so many points on one element.
const MOST_POINTS: f64 = 1024.0;

/// The largest distance from a point of either outline to the other, in font units; infinite where only one is empty.
pub(super) fn deviation(a: (&Region, &BoundaryIndex), b: (&Region, &BoundaryIndex), units_per_em: f64) -> f64 {
    if a.0.is_empty() && b.0.is_empty() {
        return 0.0;
    }
    one_way(a.0, b.1, units_per_em).max(one_way(b.0, a.1, units_per_em))
}

/// The points at which an outline is measured, in its order.
pub(super) fn points(region: &Region, units_per_em: f64) -> impl Iterator<Item = Point> + '_ {
    region.segments().flat_map(move |segment| {
        let count = (segment.length() / (SPACING * units_per_em)).ceil().clamp(1.0, MOST_POINTS);
        (0..count as usize).map(move |k| segment.point_at(k as f64 / count))
    })
}

fn one_way(from: &Region, to: &BoundaryIndex, units_per_em: f64) -> f64 {
    let mut farthest = 0.0f64;
    for p in points(from, units_per_em) {
        // Most points are nearer than the farthest so far.
        if !to.is_nearer(p, farthest) {
            farthest = farthest.max(to.distance(p));
        }
    }
    farthest
}
