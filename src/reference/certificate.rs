//! How far a claimed offset is from the true one, by distances alone.

use super::curve::Features;
use super::{SAMPLE_STEP, Side};
use crate::plane::{BoundaryIndex, Point, Region, Segment};

/// How much nearer than the radius another part of the boundary may come to a point of the level set, over the extent of
/// the drawing in radii: the rounding of a coordinate, several times.
const LEVEL_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Parts of the level set shorter than this, in radii, may go unseen between samples.
const SHORTEST_STRETCH: f64 = 1e-5;

/// Stretches of which both ends are this near to the level, in radii, are not searched: where two curves run along each
/// other, only a change of the radius could tell them apart.
const NEAR_LEVEL: f64 = 1e-9;

/// The largest distance found between the boundary of `offset` and the set of points that lie on the given side of
/// `source`, at distance 1 of it. Infinite where a ring of the offset lies on the wrong side or runs the wrong way.
///
/// Forth: samples of the offset have distance 1 from the source. Back: points that the source sends to distance 1, and
/// that nothing else of the source comes nearer to, lie on the offset.
pub(super) fn offset_error(source: &Region, offset: &Region, side: Side) -> f64 {
    let source_index = BoundaryIndex::new(source);
    let offset_index = BoundaryIndex::new(offset);
    let mut error: f64 = 0.0;
    for ring in &offset.rings {
        // A curve that keeps its distance from the boundary stays on one side of it: one point decides for the ring.
        let Some(first) = ring.vertices.first() else { continue };
        if source.contains(first.point) == (side == Side::Outward) || !runs_right(ring, &source_index, side) {
            return f64::INFINITY;
        }
        for s in ring.segments() {
            each_sample(&s, |p| error = error.max((source_index.distance(p) - 1.0).abs()));
        }
    }
    let bounds = source.bounds();
    let level = 1.0 - LEVEL_ROUNDING * (bounds.diagonal() + 1.0);
    let mut back = Back { source: &source_index, offset: &offset_index, level, error };
    for curve in Features::new(source, side).curves() {
        let pieces = (curve.length() / SAMPLE_STEP).ceil().max(2.0);
        let sample = |k: f64| (k / pieces, source_index.distance(curve.point_at(k / pieces)));
        for k in 0..pieces as usize {
            back.between(&curve, sample(k as f64), sample((k + 1) as f64));
        }
    }
    back.error
}

/// The search for parts of the level set that the offset lacks.
struct Back<'a> {
    source: &'a BoundaryIndex,
    offset: &'a BoundaryIndex,
    level: f64,
    error: f64,
}

impl Back<'_> {
    /// Looks at the stretch between two parameters of an offset curve of the source, each with its distance from it.
    ///
    /// A distance changes no faster than its place, so where both ends come nearer to the source than the level by half
    /// the stretch or more, no part between them is on the level: only what this leaves open is halved.
    fn between(&mut self, curve: &Segment, a: (f64, f64), b: (f64, f64)) {
        let settled = a.1.min(b.1) >= self.level - NEAR_LEVEL;
        for (t, _) in [a, b].into_iter().filter(|(_, d)| *d >= self.level) {
            self.error = self.error.max(self.offset.distance(curve.point_at(t)));
        }
        let length = (b.0 - a.0) * curve.length();
        let excluded = 2.0 * self.level - a.1 - b.1 >= length;
        if settled || excluded || length < SHORTEST_STRETCH {
            return;
        }
        let t = 0.5 * (a.0 + b.0);
        let middle = (t, self.source.distance(curve.point_at(t)));
        self.between(curve, a, middle);
        self.between(curve, middle, b);
    }
}

/// Whether the source lies on the solid's side of an offset ring: on its left after growing, on its right after shrinking.
fn runs_right(ring: &crate::plane::Ring, source_index: &BoundaryIndex, side: Side) -> bool {
    let longest = ring.segments().max_by(|a, b| a.length().total_cmp(&b.length()));
    let Some(s) = longest else { return true };
    let middle = s.point_at(0.5);
    let Some((_, nearest)) = source_index.nearest(middle) else { return false };
    let tangent = match s.link {
        crate::plane::Link::Line => s.start_tangent(),
        crate::plane::Link::Arc(arc) => arc.tangent_at(middle),
    };
    let to_source_is_left = tangent.perp(&(nearest.point - middle)) > 0.0;
    to_source_is_left == (side == Side::Outward)
}

/// The ends of the element, its middle and points at most [`SAMPLE_STEP`] apart.
fn each_sample(s: &Segment, mut visit: impl FnMut(Point)) {
    let pieces = (s.length() / SAMPLE_STEP).ceil().max(2.0);
    for k in 0..=pieces as usize {
        visit(s.point_at(k as f64 / pieces));
    }
}
