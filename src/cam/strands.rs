//! What else of the paths passes near a place.

use crate::plane::{Bounds, Point, Segment};

/// A path that comes back to a place has gone at least so many times as far as it is away from there: more than half a
/// circle, and than the two sides of a corner of 60 degrees.
const DETOUR: f64 = 2.0;

/// The paths of one operation.
#[derive(Clone, Debug, Default)]
pub(super) struct Strands {
    elements: Vec<Strand>,
}

/// One element of a path.
#[derive(Clone, Copy, Debug)]
struct Strand {
    segment: Segment,
    bounds: Bounds,
    /// The number of its path.
    path: usize,
    /// Length of the path up to the element.
    before: f64,
    /// Length of the path.
    whole: f64,
}

impl Strands {
    /// Adds the elements of the closed path with this number.
    pub(super) fn add(&mut self, path: usize, segments: &[Segment]) {
        let whole = segments.iter().map(Segment::length).sum();
        let mut before = 0.0;
        for &segment in segments {
            self.elements.push(Strand { segment, bounds: segment.bounds(), path, before, whole });
            before += segment.length();
        }
    }

    /// Those that may pass within `distance` of something in `bounds`.
    pub(super) fn near(&self, bounds: Bounds, distance: f64) -> Strands {
        let reached = bounds.inflated(distance);
        let elements = self.elements.iter().filter(|strand| strand.bounds.overlaps(&reached));
        Strands { elements: elements.copied().collect() }
    }

    /// Whether any path comes nearer than `distance` to `p`.
    pub(super) fn come_nearer(&self, p: Point, distance: f64) -> bool {
        self.elements.iter().any(|strand| strand.segment.is_nearer(p, distance))
    }

    /// Whether another path, or the same path on its way back, is nearer than `distance` to `p`, which is on `path` at
    /// `way` from its start.
    pub(super) fn pass(&self, p: Point, path: usize, way: f64, distance: f64) -> bool {
        self.elements.iter().any(|strand| {
            let segment = &strand.segment;
            if (p - segment.start).norm() > distance + segment.length() {
                return false;
            }
            let nearest = segment.nearest(p);
            if nearest.distance >= distance {
                return false;
            }
            if strand.path != path {
                return true;
            }
            let gone =
                if nearest.point == segment.start { 0.0 } else { Segment { end: nearest.point, ..*segment }.length() };
            let apart = (strand.before + gone - way).rem_euclid(strand.whole);
            // Rounding tells nothing apart from the place itself.
            apart.min(strand.whole - apart) > DETOUR * nearest.distance + SAME_PLACE * distance
        })
    }
}

/// Ways shorter than this, in the distance asked for, lead nowhere: rounding of lengths.
const SAME_PLACE: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Ring;

    fn square(corner: f64, side: f64) -> Vec<Segment> {
        let far = corner + side;
        let corners = [(corner, corner), (far, corner), (far, far), (corner, far)];
        Ring::polygon(corners.map(|(x, y)| Point::new(x, y))).segments().collect()
    }

    #[test]
    fn other_paths_and_ways_back_pass_near_a_place_and_the_place_itself_does_not() {
        let mut strands = Strands::default();
        strands.add(0, &square(0.0, 10.0));
        assert!(!strands.pass(Point::new(5.0, 0.0), 0, 5.0, 4.0));
        // The side of a long rectangle comes back ten away from the other one, behind way enough.
        let corners = [(200.0, 0.0), (230.0, 0.0), (230.0, 10.0), (200.0, 10.0)];
        let long: Vec<Segment> = Ring::polygon(corners.map(|(x, y)| Point::new(x, y))).segments().collect();
        strands.add(4, &long);
        assert!(!strands.pass(Point::new(215.0, 0.0), 4, 15.0, 9.9));
        assert!(strands.pass(Point::new(215.0, 0.0), 4, 15.0, 10.1));
        strands.add(1, &square(12.0, 10.0));
        assert!(!strands.pass(Point::new(10.0, 5.0), 0, 15.0, 1.9));
        assert!(strands.pass(Point::new(10.0, 9.0), 0, 19.0, 4.0));
        // Out and back: every place is passed twice.
        let (a, b, c) = (Point::new(50.0, 0.0), Point::new(60.0, 0.0), Point::new(50.0, 30.0));
        strands.add(2, &[Segment::line(a, b), Segment::line(b, a), Segment::line(a, c), Segment::line(c, a)]);
        assert!(strands.pass(Point::new(55.0, 0.0), 2, 5.0, 0.1));
        // A circle comes no nearer to a place than it goes.
        let circle: Vec<Segment> = Ring::circle(Point::new(100.0, 0.0), 2.0).segments().collect();
        let start = circle[0].start;
        strands.add(3, &circle);
        assert!(!strands.pass(start, 3, 0.0, 3.9));
    }
}
