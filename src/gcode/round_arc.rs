//! Arcs between places of the grid.
//!
//! Once the ends are rounded, the old centre is at a different distance from each. The centre is solved again on the
//! bisector of the rounded ends, rounded itself, and the best of its neighbours on the grid is taken. What comes out is
//! measured; an arc that does not pass is written as lines.

use std::f64::consts::PI;

use crate::plane::{Arc, Point, Segment, Turn, Vector, left_normal};

/// Largest difference between the radii at start and end, in millimetres. GRBL refuses 0.005, LinuxCNC 0.02.
pub(super) const LARGEST_MISMATCH: f64 = 0.002;

/// Arcs whose sagitta is below this share of the last decimal are lines.
const FLAT_SAGITTA: f64 = 0.1;

/// How far the middle of the written arc may be off, in last decimals, beyond what rounding its ends explains.
const LARGEST_DEVIATION: f64 = 1.0;

/// Half the chord over the radius below which an arc keeps its radius exactly, a quarter turn: its sagitta, which is soon no
/// more than the rounding of its ends, says too little about its radius, and a path must not turn tighter than promised.
const KEEPS_RADIUS: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Radii below this many last decimals cannot be told from their rounding.
const SMALLEST_RADIUS: f64 = 5.0;

/// Sweep in radians above which an arc is written as two: near a full circle its rounded ends could become one.
pub(super) const LARGEST_SWEEP: f64 = 1.5 * PI;

/// What an arc becomes on the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Rounded {
    /// An arc about the centre at this offset from the start, in multiples of the grid.
    Arc {
        /// The word I.
        i: i64,
        /// The word J.
        j: i64,
    },
    /// As good as straight, or too small for an arc.
    Line,
    /// No centre on the grid will do: the arc has to be cut into lines.
    Unwritable,
}

/// The arc `exact` between the rounded ends `start` and `end`, all in multiples of the grid.
pub(super) fn round_arc(exact: &Segment, arc: &Arc, start: [i64; 2], end: [i64; 2]) -> Rounded {
    let point = |p: [i64; 2]| Point::new(p[0] as f64, p[1] as f64);
    let (s, e) = (point(start), point(end));
    let chord = e - s;
    let sweep = exact.sweep();
    let sagitta = arc.radius * (1.0 - (0.5 * sweep.min(PI)).cos());
    if arc.radius < SMALLEST_RADIUS || sagitta < FLAT_SAGITTA {
        return Rounded::Line;
    }
    let Some(along) = chord.try_normalize(0.0) else {
        // The ends became one: a controller would read a full circle.
        return if sweep < PI { Rounded::Line } else { Rounded::Unwritable };
    };
    // Of all centres on the bisector, on short arcs the one at the exact radius, on others the one whose arc passes through
    // the middle of the exact arc. Unlike the centre nearest to the exact one both stay good where the rounded chord points
    // elsewhere.
    let middle = exact.point_at(0.5);
    let half = 0.5 * chord.norm();
    let normal = left_normal(along);
    let center_of_chord = nalgebra::center(&s, &e);
    // Height of the arc over the chord, to the right for arcs that turn left.
    let height = -arc.turn.sign() * (middle - center_of_chord).dot(&normal);
    let depth = if half < KEEPS_RADIUS * arc.radius && sweep < PI {
        (arc.radius * arc.radius - half * half).sqrt()
    } else if height < FLAT_SAGITTA {
        return Rounded::Line;
    } else {
        (half * half - height * height) / (2.0 * height)
    };
    let ideal = center_of_chord + normal * (arc.turn.sign() * depth);
    let mut best: Option<(f64, f64, [i64; 2])> = None;
    for dj in -1..=1 {
        for di in -1..=1 {
            let c = Point::new((ideal.x - s.x).round() + f64::from(di), (ideal.y - s.y).round() + f64::from(dj));
            let center = s + c.coords;
            let (rs, re) = ((center - s).norm(), (center - e).norm());
            // The middle of the arc as the controller will run it: half of the sweep at half of the radius change.
            let outward = normal * -arc.turn.sign();
            let deviation = middle_deviation(center, 0.5 * (rs + re), outward, middle);
            let cost = (rs - re).abs() + deviation;
            if best.is_none_or(|(b, _, _)| cost < b) {
                best = Some((cost, (rs - re).abs(), [c.x as i64, c.y as i64]));
            }
        }
    }
    let Some((cost, mismatch, [i, j])) = best else { return Rounded::Unwritable };
    if (i, j) == (0, 0)
        || cost - mismatch > LARGEST_DEVIATION
        || !same_way(s, e, Vector::new(i as f64, j as f64), arc.turn, sweep)
    {
        return Rounded::Unwritable;
    }
    Rounded::Arc { i, j }
}

/// How far the point of the circle in the direction `outward` is from `middle`, measured in that direction.
fn middle_deviation(center: Point, radius: f64, outward: Vector, middle: Point) -> f64 {
    ((center + outward * radius - middle).dot(&outward)).abs()
}

/// Whether the written arc sweeps what the exact one does, and not its complement.
fn same_way(s: Point, e: Point, to_center: Vector, turn: Turn, sweep: f64) -> bool {
    let center = s + to_center;
    let written = Arc { center, radius: to_center.norm(), turn }.angle_between(s, e);
    (written - sweep).abs() < 0.5 * PI
}

/// Points after the start up to and including the end that replace an arc within `tolerance`.
///
/// Chords of an arc that bends towards the part would cut into it; there the lines touch the arc from outside.
pub(super) fn lines_for_arc(exact: &Segment, arc: &Arc, part_side: Turn, tolerance: f64) -> Vec<Point> {
    let mut points = Vec::new();
    if arc.turn != part_side {
        exact.flatten(tolerance, |p| points.push(p));
        return points;
    }
    let sweep = exact.sweep();
    // Tangents at both ends of a piece meet outside of its middle: radius / cos(half a piece) is the tolerance too far.
    let half = (arc.radius / (arc.radius + tolerance)).acos().min(0.25 * PI);
    let count = (0.5 * sweep / half).ceil().max(1.0);
    let piece = sweep / count;
    let reach = 1.0 / (0.5 * piece).cos();
    for k in 0..count as usize {
        let on_arc = arc.travel(exact.start, piece * (k as f64 + 0.5));
        points.push(arc.center + (on_arc - arc.center) * reach);
    }
    points.push(exact.end);
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Link;

    #[test]
    fn short_arcs_keep_their_radius() {
        let mut written = 0;
        for radius in [800.3, 5555.56, 21_430.7] {
            for step in 1..400 {
                let (sweep, from) = (1.4 / f64::from(step), f64::from(step) * 0.7);
                let turn = if step % 2 == 0 { Turn::Left } else { Turn::Right };
                let arc = Arc { center: Point::new(0.3, -0.4), radius, turn };
                let start = arc.center + Vector::new(from.cos(), from.sin()) * radius;
                let exact = Segment { start, end: arc.travel(start, sweep), link: Link::Arc(arc) };
                let grid = |p: Point| [p.x.round() as i64, p.y.round() as i64];
                let (s, e) = (grid(exact.start), grid(exact.end));
                if let Rounded::Arc { i, j } = round_arc(&exact, &arc, s, e) {
                    written += 1;
                    let r = (i as f64).hypot(j as f64);
                    assert!((r - radius).abs() < 2.0, "{r} for {radius}, sweep {sweep}");
                }
            }
        }
        assert!(written > 300, "{written}");
    }
}
