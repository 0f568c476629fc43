//! Chords of a concave curve that the disk follows.
//!
//! A curve is drawn by chords, and the disk does not fit into the corner between two of them even where it fits the
//! curve. So a vertex that a curve was sampled at is left alone where the disk touches both chords in the halves that
//! meet there, as it does if the radius of the curve is not below the disk's.

use super::excess::half_turn_tangent;
use crate::plane::{Joint, Link, Ring, Segment, Turn, Vector};

/// A concave arc this near to the disk's radius, relative to it, is one of the disk: it holds the disk still.
pub(super) const STUCK: f64 = 1e-7;

/// Samples are evenly spaced in the parameter, not in length: a little room for that.
const UNEVEN: f64 = 1e-3;

/// The tangent of half a radian: a greater turn is no sample of a curve.
const SHARP: f64 = 0.546;

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
    // says nothing of the curve: the other chord speaks for both.
    let is_of_disk = |i: usize| is_of_disk(&ring.segment(i), r);
    let shorter = match (is_of_disk(at(2 * n - 2)), is_of_disk(at(1))) {
        (true, false) => l2,
        (false, true) => l1,
        _ => l1.min(l2),
    };
    fits(incoming.end - incoming.start, outgoing.end - outgoing.start, shorter, r)
}

/// Whether a link is an arc of a disk of radius `r`.
fn is_of_disk(link: &Segment, r: f64) -> bool {
    matches!(link.link, Link::Arc(arc) if arc.turn == Turn::Right && (arc.radius - r).abs() <= STUCK * r)
}

/// Whether the disk touches both chords, of which `shorter` is the length of the shorter one, in the halves that meet.
fn fits(incoming: Vector, outgoing: Vector, shorter: f64, r: f64) -> bool {
    let half = half_turn_tangent(incoming, outgoing);
    half < SHARP && r * half <= 0.5 * shorter * (1.0 + UNEVEN)
}
