//! Neighbouring elements that are one: collinear lines, arcs of one circle.

use std::f64::consts::PI;

use crate::plane::{Joint, Link, Ring, Segment, Vertex};

/// How far a vertex may lie off the line that replaces it, in millimetres, summed over the vertices of a run.
const COLLINEAR_TOLERANCE: f64 = 1e-6;

/// How far the centres of two arcs, and their radii, may differ for the arcs to be one, in millimetres.
const CONCENTRIC_TOLERANCE: f64 = 1e-6;

/// Sweep that two arcs may make together, in radians: half a circle, with room for rounding. Longer arcs would be exact
/// too, but controllers that compute in single precision find the ends of half circles best.
const LARGEST_SWEEP: f64 = PI * (1.0 + 1e-9);

/// A ring of `segments`, each of which starts where the one before ends.
pub(super) fn ring_of_segments(segments: &[Segment]) -> Ring {
    let vertices =
        segments.iter().map(|s| Vertex { point: s.start, link: s.link, joint: Joint::Corner, id: None }).collect();
    Ring { vertices }
}

/// The same closed path with neighbours that lie on one line or one circle joined.
pub(super) fn join_aligned(segments: &[Segment]) -> Vec<Segment> {
    let mut out: Vec<Segment> = Vec::with_capacity(segments.len());
    // What the last element of `out` is off its vertices already.
    let mut used = 0.0;
    for &segment in segments {
        match out.last().and_then(|last| joined(last, &segment, used)) {
            Some((whole, off)) => {
                used += off;
                *out.last_mut().expect("there was a last element to join") = whole;
            }
            None => {
                used = 0.0;
                out.push(segment);
            }
        }
    }
    // Around the start; a closed path keeps two elements.
    while out.len() > 2 {
        let Some((whole, _)) = joined(&out[out.len() - 1], &out[0], used) else { break };
        out.pop();
        out[0] = whole;
        used = COLLINEAR_TOLERANCE;
    }
    out
}

/// One element for two that follow each other, and how far it is off the vertex between them.
fn joined(a: &Segment, b: &Segment, used: f64) -> Option<(Segment, f64)> {
    match (a.link, b.link) {
        (Link::Line, Link::Line) => {
            let whole = Segment::line(a.start, b.end);
            let forward = (a.end - a.start).dot(&(b.end - b.start)) > 0.0;
            let off = whole.nearest(a.end).distance;
            (forward && used + off <= COLLINEAR_TOLERANCE).then_some((whole, off))
        }
        (Link::Arc(p), Link::Arc(q)) => {
            let same = p.turn == q.turn
                && (p.center - q.center).norm() <= CONCENTRIC_TOLERANCE
                && (p.radius - q.radius).abs() <= CONCENTRIC_TOLERANCE;
            let whole = Segment { start: a.start, end: b.end, link: a.link };
            (same && a.sweep() + b.sweep() <= LARGEST_SWEEP).then_some((whole, 0.0))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Point;

    #[test]
    fn aligned_neighbours_become_one() {
        let p = |x: f64, y: f64| Point::new(x, y);
        let square =
            Ring::polygon([p(1.0, 0.0), p(3.0, 0.0), p(4.0, 0.0), p(4.0, 4.0), p(0.0, 4.0), p(0.0, 1.0), p(0.0, 0.0)]);
        let segments: Vec<Segment> = square.segments().collect();
        let joined = join_aligned(&segments);
        assert_eq!(joined.len(), 4);
        assert_eq!(ring_of_segments(&joined).area(), 16.0);
        // A corner off by more than the tolerance stays.
        let bent = Ring::polygon([p(0.0, 0.0), p(2.0, -1e-5), p(4.0, 0.0), p(4.0, 4.0)]);
        assert_eq!(join_aligned(&bent.segments().collect::<Vec<_>>()).len(), 4);
    }

    #[test]
    fn circles_keep_two_arcs() {
        let circle = Ring::circle(p0(), 2.0);
        let joined = join_aligned(&circle.segments().collect::<Vec<_>>());
        assert_eq!(joined.len(), 2);
        assert!((ring_of_segments(&joined).area() - circle.area()).abs() < 1e-12);
    }

    fn p0() -> Point {
        Point::new(7.0, -3.0)
    }
}
