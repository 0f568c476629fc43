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
    half_turn(0.5 * a / r) + half_turn(0.5 * b / r)
}

/// asin(x), of edges longer than the diameter that of 1.
fn half_turn(x: f64) -> f64 {
    // Below this the series ends, to the last digit, with the power written here; the general function takes ten times
    // as long, and most edges are an edge length.
    const SHORT: f64 = 0.06;
    if x >= SHORT {
        return x.min(1.0).asin();
    }
    let s = x * x;
    x * (1.0 + s * (1.0 / 6.0 + s * (3.0 / 40.0 + s * (5.0 / 112.0 + s * (35.0 / 1152.0 + s * (63.0 / 2816.0))))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_turns_are_right_to_the_last_digits() {
        for k in 0..2000 {
            let x = f64::from(k) * 1e-4;
            assert!((half_turn(x) - x.asin()).abs() <= 8.0 * f64::EPSILON * x, "{x}");
        }
        assert_eq!(half_turn(3.0), std::f64::consts::FRAC_PI_2);
    }
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
