//! Curvature at the nodes of an outline, in excess form.
//!
//! The turn of the chords at a node is compared with the turn that a polygon inscribed in a circle of the disk's radius
//! would have there: asin(a / 2r) + asin(b / 2r) for chords of lengths a and b. So any polygon whose vertices lie on a
//! circle of radius r or larger is at the bound or within it, whatever its edge lengths: samples of the limit do not move,
//! and neither do those of a smooth curve that the disk can follow. Edges longer than they may be ([`LONGEST`]) count as chords
//! of the edge length h, which is what they become once the node moves.

use super::outline::{NONE, Outline};
use super::remesh::LONGEST;
use crate::plane::{Vector, turn_angle};

/// Turns smaller than this, in radians, are no turns: rounding of coordinates in files with nine digits.
const TURN_SLACK: f64 = 1e-9;

/// Coordinates of so many units in the last place may be off.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A turn, what it is compared with, and how far rounding may have changed it; radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turning {
    /// Positive to the left, where the solid is convex.
    pub turn: f64,
    /// The turn along a circle of the disk's radius.
    pub unit: f64,
    pub slack: f64,
}

/// The turning at node `i`, where edges are to have the length `h`.
pub(super) fn turning(outline: &Outline, i: u32, h: f64) -> Turning {
    let node = outline.node(i);
    let (into, a) = chord(outline, node.prev, End::End, h);
    let (out, b) = chord(outline, i, End::Start, h);
    let farthest = node.point.x.abs().max(node.point.y.abs());
    Turning {
        turn: turn_angle(into, out),
        unit: unit_turn(a, b, node.radius),
        slack: TURN_SLACK + ROUNDING * farthest / a.min(b),
    }
}

/// The turn of a polygon inscribed in a circle of radius `r` between edges of the lengths `a` and `b`.
pub(super) fn unit_turn(a: f64, b: f64, r: f64) -> f64 {
    let half_turn = |length: f64| (0.5 * length / r).min(1.0).asin();
    half_turn(a) + half_turn(b)
}

#[derive(Clone, Copy, PartialEq)]
enum End {
    Start,
    End,
}

/// The chord of the edge that leaves `i` at one of its ends, of the length `h` at most: its direction and length.
fn chord(outline: &Outline, i: u32, end: End, h: f64) -> (Vector, f64) {
    let node = outline.node(i);
    if node.arc == NONE {
        let d = outline.node(node.next).point - node.point;
        let length = d.norm();
        return (d, if length > LONGEST * h { h } else { length });
    }
    let edge = outline.edge(i);
    let length = edge.length();
    let d = if length <= LONGEST * h {
        edge.end - edge.start
    } else {
        match end {
            End::Start => edge.point_at(h / length) - edge.start,
            End::End => edge.end - edge.point_at(1.0 - h / length),
        }
    };
    (d, d.norm())
}
