//! Pieces of a result as quadratic curves, still in exact coordinates.
//!
//! A line needs its ends; a quadratic curve and any part of it are one quadratic curve; a cubic curve becomes a spline of
//! quadratic ones; an arc becomes the polygon of its tangents, whose corners are the control points: the middles of its sides
//! lie on the circle and are implied, so that rounding to whole units never makes a kink between them. Arcs have points
//! on the curve where they are extreme in x or y, as fonts want them.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::trace::{Piece, PieceKind};
use crate::io::svg::{Curve, CurveKind, Sources};
use crate::plane::{Arc, Point, Segment, Vector, VertexId};

/// A point on the curve, and the control points from it to the next: consecutive ones have an implied point on the curve in
/// their middle.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Knot {
    pub point: Point,
    pub controls: Vec<Point>,
}

/// An extreme point is not marked within this many units of an end of an arc: the marks would fall together.
const EXTREME_APART: f64 = 3.0;

/// The widest angle of one quadratic curve, in radians: of a wider one the tangents meet far away.
const WIDEST: f64 = 1.2;

/// A closed contour of knots for `pieces`, within `accuracy` of them, in font units.
pub(super) fn knots(pieces: &[Piece], sources: &Sources, accuracy: f64) -> Vec<Knot> {
    let Some(last) = pieces.last() else { return Vec::new() };
    let mut start = last.end;
    let mut knots = Vec::with_capacity(pieces.len());
    for piece in pieces {
        match piece.kind {
            PieceKind::Line => knots.push(Knot { point: start, controls: Vec::new() }),
            PieceKind::Arc(arc) => add_arc(arc, start, piece.end, accuracy, &mut knots),
            PieceKind::Curve { number, from, to } => {
                let curve = sources.curves.get(number as usize);
                let controls = curve.and_then(|c| controls(c, sources, from, to, accuracy)).unwrap_or_default();
                knots.push(Knot { point: start, controls });
            }
        }
        start = piece.end;
    }
    knots
}

/// The control points of the part of a curve between two parameters.
fn controls(curve: &Curve, sources: &Sources, from: f64, to: f64, accuracy: f64) -> Option<Vec<Point>> {
    let point = |id: VertexId| sources.vertex(id).map(|v| v.point);
    let (a, b) = (point(curve.from)?, point(curve.to)?);
    match curve.kind {
        CurveKind::Quadratic(c) => {
            if (from, to) == (0.0, 1.0) || (from, to) == (1.0, 0.0) {
                return Some(vec![c]);
            }
            // The blossom of the curve at both parameters.
            let lerp = |p: Point, q: Point, t: f64| p + (q - p) * t;
            Some(vec![lerp(lerp(a, c, from), lerp(c, b, from), to)])
        }
        CurveKind::Cubic(c, d) => {
            let plain = |p: Point| kurbo::Point::new(p.x, p.y);
            let [p0, p1, p2, p3] = [a, c, d, b].map(plain);
            let whole = kurbo::CubicBez::new(p0, p1, p2, p3);
            let (low, high) = (from.min(to), from.max(to));
            let part = if (low, high) == (0.0, 1.0) { whole } else { kurbo::ParamCurve::subsegment(&whole, low..high) };
            let spline: Vec<Point> = match part.approx_spline(accuracy) {
                Some(spline) => spline.points().iter().map(|p| Point::new(p.x, p.y)).collect(),
                // Cusps and loops: by halves of a parameter that need not join smoothly.
                None => part.to_quads(accuracy).map(|(_, _, q)| Point::new(q.p1.x, q.p1.y)).collect(),
            };
            let is_spline = spline
                .first()
                .zip(spline.last())
                .is_some_and(|(s, e)| (s.x, s.y) == (part.p0.x, part.p0.y) && (e.x, e.y) == (part.p3.x, part.p3.y));
            let mut controls =
                if is_spline && spline.len() > 2 { spline[1..spline.len() - 1].to_vec() } else { spline };
            if to < from {
                controls.reverse();
            }
            Some(controls)
        }
        CurveKind::Elliptic { .. } => None,
    }
}

/// Adds the knots of an arc: its start, its extreme points, and the corners of the polygon of its tangents.
fn add_arc(arc: Arc, start: Point, end: Point, accuracy: f64, knots: &mut Vec<Knot>) {
    let segment = Segment { start, end, link: crate::plane::Link::Arc(arc) };
    let sweep = segment.sweep();
    let apart = (EXTREME_APART / arc.radius).min(0.25 * sweep);
    let mut stops = vec![0.0];
    // The angles travelled to the directions of the axes, in order.
    let spoke = start - arc.center;
    let travelled = arc.turn.sign() * spoke.y.atan2(spoke.x);
    let first = (travelled / FRAC_PI_2).ceil() * FRAC_PI_2 - travelled;
    let extremes = (0..5).map(|k| first + f64::from(k) * FRAC_PI_2);
    stops.extend(extremes.filter(|angle| *angle > apart && *angle < sweep - apart && *angle < TAU));
    stops.push(sweep);
    // A quadratic curve over the angle 2α is farthest from the circle in its middle: r α⁴ / 8.
    let widest = (2.0 * (8.0 * accuracy / arc.radius).powf(0.25)).min(WIDEST);
    for (k, stop) in stops.windows(2).enumerate() {
        let (from, angle) = (stop[0], stop[1] - stop[0]);
        let count = (angle / widest).ceil().max(1.0);
        let half = 0.5 * angle / count;
        let corner = |j: usize| {
            let middle = arc.travel(start, from + half * (2 * j + 1) as f64);
            arc.center + (middle - arc.center) / half.cos()
        };
        let point = if k == 0 { start } else { on_axis(arc, arc.travel(start, from)) };
        knots.push(Knot { point, controls: (0..count as usize).map(corner).collect() });
    }
}

/// An extreme point of a circle without the rounding of sine and cosine.
fn on_axis(arc: Arc, p: Point) -> Point {
    let spoke = p - arc.center;
    if spoke.x.abs() < spoke.y.abs() {
        arc.center + Vector::new(0.0, arc.radius * spoke.y.signum())
    } else {
        arc.center + Vector::new(arc.radius * spoke.x.signum(), 0.0)
    }
}
