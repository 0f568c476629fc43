//! Going along a closed path by length.

use crate::plane::{Point, Segment, Vector};

/// Parts of an element shorter than this, in millimetres, are added to their neighbour: far below what is written.
const SLIVER: f64 = 1e-7;

/// A closed path from one of its points, with the length up to every element.
#[derive(Clone, Debug)]
pub(super) struct Walk {
    segments: Vec<Segment>,
    /// Length before element i; the last entry is the whole length.
    before: Vec<f64>,
}

impl Walk {
    /// The closed path of `segments`, none empty, each starting where the one before ends.
    pub(super) fn new(segments: Vec<Segment>) -> Walk {
        let mut before = vec![0.0];
        let mut sum = 0.0;
        for segment in &segments {
            sum += segment.length();
            before.push(sum);
        }
        Walk { segments, before }
    }

    /// The whole length.
    pub(super) fn length(&self) -> f64 {
        self.before[self.segments.len()]
    }

    /// The elements.
    pub(super) fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// The point at `way`.
    pub(super) fn point_at(&self, way: f64) -> Point {
        self.at(way.rem_euclid(self.length())).point
    }

    /// The direction of travel behind `way`.
    pub(super) fn tangent_at(&self, way: f64) -> Vector {
        let stop = self.at(way.rem_euclid(self.length()));
        let segment = self.segments[stop.element];
        Segment { start: stop.point, ..segment }.start_tangent()
    }

    /// The way to the point of the path that is nearest to `p`, and its distance; no way where there are no elements.
    pub(super) fn nearest_way(&self, p: Point) -> (Option<f64>, f64) {
        let mut best = (None, f64::INFINITY);
        for (segment, before) in self.segments.iter().zip(&self.before) {
            let near = segment.nearest(p);
            if near.distance < best.1 {
                let part = Segment { end: near.point, ..*segment };
                let length = if near.point == segment.start { 0.0 } else { part.length() };
                best = (Some(before + length), near.distance);
            }
        }
        best
    }

    /// The place at `way`; near an end of an element it is the end itself, so that no slivers are left.
    fn at(&self, way: f64) -> Stop {
        let i = self.before.partition_point(|b| *b <= way).clamp(1, self.segments.len()) - 1;
        let (start, end, segment) = (self.before[i], self.before[i + 1], &self.segments[i]);
        if way - start <= SLIVER {
            Stop { element: i, way: start, point: segment.start }
        } else if end - way <= SLIVER {
            let next = (i + 1) % self.segments.len();
            Stop { element: next, way: self.before[next], point: segment.end }
        } else {
            Stop { element: i, way, point: segment.point_at((way - start) / (end - start)) }
        }
    }

    /// The elements from `way` (in [0, length)) on for `length`, which may be several times around.
    ///
    /// Whole laps end where they began, to the last bit.
    pub(super) fn stretch(&self, way: f64, length: f64) -> Vec<Segment> {
        let (n, whole) = (self.segments.len(), self.length());
        let laps = ((length + 4.0 * SLIVER) / whole).floor().max(0.0);
        let rest = length - laps * whole;
        let from = self.at(way);
        let (to, mut ends) = if rest <= 4.0 * SLIVER {
            (from, 0)
        } else {
            let to = self.at((way + rest) % whole);
            let around = if to.way > from.way { 0 } else { n };
            (to, around + to.element - from.element)
        };
        ends += laps as usize * n;
        let mut out = Vec::with_capacity(ends + 1);
        let (mut i, mut start) = (from.element, from.point);
        for _ in 0..ends {
            let segment = self.segments[i];
            if start != segment.end {
                out.push(Segment { start, ..segment });
            }
            i = (i + 1) % n;
            start = self.segments[i].start;
        }
        if start != to.point {
            out.push(Segment { start, end: to.point, ..self.segments[i] });
        }
        out
    }
}

/// A place of a walk.
#[derive(Clone, Copy)]
struct Stop {
    element: usize,
    way: f64,
    point: Point,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Ring;

    fn length(segments: &[Segment]) -> f64 {
        segments.iter().map(Segment::length).sum()
    }

    #[test]
    fn stretches_have_the_length_asked_for_and_hang_together() {
        let p = |x: f64, y: f64| Point::new(x, y);
        let square = Ring::polygon([p(0.0, 0.0), p(10.0, 0.0), p(10.0, 10.0), p(0.0, 10.0)]);
        let circle = Ring::circle(p(3.0, 4.0), 2.0);
        for ring in [square, circle] {
            let walk = Walk::new(ring.segments().collect());
            let whole = walk.length();
            for way in [0.0, 0.1, 0.25, 0.3, 0.77, 0.999] {
                for part in [0.001, 0.05, 0.25, 0.5, 0.9, 1.0, 1.001, 2.0, 3.3] {
                    let stretch = walk.stretch(way * whole, part * whole);
                    assert!((length(&stretch) - part * whole).abs() < 1e-6, "{way} {part}: {}", length(&stretch));
                    assert!((stretch[0].start - walk.at(way * whole).point).norm() == 0.0);
                    assert!(stretch.windows(2).all(|w| w[0].end == w[1].start));
                }
                // Once around ends where it began, to the bit.
                let lap = walk.stretch(way * whole, whole);
                assert_eq!(lap[0].start, lap[lap.len() - 1].end);
            }
        }
    }
}
