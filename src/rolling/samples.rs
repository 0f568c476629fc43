//! Chords of a concave curve that the disk follows.
//!
//! A curve is drawn by chords, and the disk does not fit into the corner between two of them even where it fits the
//! curve. So a vertex that a curve was sampled at is left alone where the disk touches both chords in the halves that
//! meet there, as it does if the radius of the curve is not below the disk's.

use super::excess::half_turn_tangent;
use crate::plane::{Joint, Link, Ring, Segment, Turn};

/// A concave arc this near to the disk's radius, relative to it, is one of the disk: it holds the disk still.
pub(super) const STUCK: f64 = 1e-7;

/// Samples are evenly spaced in the parameter, not in length: a little room for that.
const UNEVEN: f64 = 1e-3;

/// The tangent of half a radian: a greater turn is no sample of a curve.
const SHARP: f64 = 0.546;

/// The tangent of a twentieth of a radian, nearly: where arcs of the disk have shortened both chords, no length is left to
/// judge by, and the disk misses what it should touch by up to twice the square of it, relative to the radius.
const SHARP_BETWEEN_ARCS: f64 = 0.05;

/// Whether a disk of radius `r` follows a concave curve at vertex `k` of `ring`, a sample of it between two chords.
pub(super) fn is_followed(ring: &Ring, k: usize, r: f64) -> bool {
    if ring.vertices[k].joint != Joint::Smooth {
        return false;
    }
    let n = ring.len();
    let at = |offset: usize| (k + offset) % n;
    let (incoming, outgoing) = (ring.segment(at(n - 1)), ring.segment(k));
    if incoming.link != Link::Line || outgoing.link != Link::Line {
        return false;
    }
    let (l1, l2) = (incoming.length(), outgoing.length());
    // Where the disk has already been rolled along, its arc has taken a part of the chord that it touches, and what is left
    // says nothing of the curve: the other chord speaks for both, and what is left of two is taken on trust.
    let is_of_disk = |i: usize| is_of_disk(&ring.segment(i), r);
    let shorter = match (is_of_disk(at(2 * n - 2)), is_of_disk(at(1))) {
        (true, false) => l2,
        (false, true) => l1,
        (true, true) => f64::INFINITY,
        (false, false) => l1.min(l2),
    };
    let half = half_turn_tangent(incoming.end - incoming.start, outgoing.end - outgoing.start);
    let sharp = if shorter.is_finite() { SHARP } else { SHARP_BETWEEN_ARCS };
    half < sharp && r * half <= 0.5 * shorter * (1.0 + UNEVEN)
}

/// Whether a link is an arc of a disk of radius `r`.
fn is_of_disk(link: &Segment, r: f64) -> bool {
    matches!(link.link, Link::Arc(arc) if arc.turn == Turn::Right && (arc.radius - r).abs() <= STUCK * r)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::{Arc, Point, Vertex};

    /// Two chords that turn to the right by `turn` at vertex 2, of the given lengths, between links with arcs of radius 1 where
    /// asked for.
    fn chords(turn: f64, lengths: [f64; 2], arcs: [bool; 2]) -> Ring {
        let (sin, cos) = turn.sin_cos();
        let (a, b) = (Point::new(-lengths[0], 0.0), Point::new(cos * lengths[1], -sin * lengths[1]));
        let arc = |is_arc: bool| match is_arc {
            true => Link::Arc(Arc { center: Point::origin(), radius: 1.0, turn: Turn::Right }),
            false => Link::Line,
        };
        let vertex = |point: Point, link: Link| Vertex { link, ..Vertex::corner(point) };
        let sample = Vertex { joint: Joint::Smooth, ..Vertex::corner(Point::origin()) };
        let far = [a - crate::plane::Vector::x(), b - crate::plane::Vector::y()];
        let vertices = vec![
            vertex(far[0], arc(arcs[0])),
            vertex(a, Link::Line),
            sample,
            vertex(b, arc(arcs[1])),
            vertex(far[1], Link::Line),
        ];
        Ring { vertices }
    }

    #[test]
    fn the_chord_that_no_arc_of_the_disk_has_shortened_speaks_for_both() {
        let is = |turn, lengths, arcs| is_followed(&chords(turn, lengths, arcs), 2, 1.0);
        let (whole, rest) = (0.06, 0.01);
        assert!(is(0.05, [whole, whole], [false, false]));
        assert!(!is(0.07, [whole, whole], [false, false]), "a curve below the radius");
        assert!(!is(0.05, [whole, rest], [false, false]) && !is(0.05, [rest, whole], [false, false]));
        assert!(is(0.05, [whole, rest], [false, true]) && is(0.05, [rest, whole], [true, false]));
        assert!(!is(0.05, [whole, rest], [true, false]) && !is(0.05, [rest, whole], [false, true]));
        assert!(is(0.05, [rest, rest], [true, true]));
        assert!(!is(0.2, [whole, whole], [true, true]), "a corner");
    }
}
