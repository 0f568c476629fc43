//! The unbounded lines and whole circles that pieces of an offset run on.

use std::f64::consts::{PI, TAU};

use crate::plane::{Arc, Link, Point, Vector, right_normal};

/// Newton steps to the intersection of two carriers: from a start that is good to a percent, six reach the last digit.
const MEETING_STEPS: usize = 12;

/// Sine of the angle below which two carriers have no usable intersection.
const MEETING_SINE: f64 = 1e-7;

/// Distance from both carriers, relative to the reach, at which they are taken to meet.
const MEETING_TOLERANCE: f64 = 1e-9;

/// What a piece runs on.
#[derive(Clone, Copy, Debug)]
pub(super) enum Carrier {
    /// A line.
    Line {
        /// A point of it.
        through: Point,
        /// Unit direction of travel.
        direction: Vector,
    },
    /// A circle and the sense of travel.
    Circle(Arc),
}

impl Carrier {
    /// As the link of a ring.
    pub(super) fn link(&self) -> Link {
        match self {
            Carrier::Line { .. } => Link::Line,
            Carrier::Circle(arc) => Link::Arc(*arc),
        }
    }

    /// The way along the carrier from `a` to `b`, negative where `b` lies behind.
    pub(super) fn travelled(&self, a: Point, b: Point, expected_sweep: f64) -> f64 {
        match self {
            Carrier::Line { direction, .. } => (b - a).dot(direction),
            Carrier::Circle(arc) => {
                let sweep = arc.angle_between(a, b);
                arc.radius * if sweep > expected_sweep + PI { sweep - TAU } else { sweep }
            }
        }
    }

    /// Signed distance of `p`, and the direction in which it grows.
    fn distance(&self, p: Point) -> (f64, Vector) {
        match self {
            Carrier::Line { through, direction } => {
                let normal = right_normal(*direction);
                ((p - through).dot(&normal), normal)
            }
            Carrier::Circle(arc) => {
                let spoke = p - arc.center;
                let norm = spoke.norm();
                let normal = if norm > 0.0 { spoke / norm } else { Vector::x() };
                (norm - arc.radius, normal)
            }
        }
    }
}

/// The intersection of two carriers that lies nearest to `guess` and within `reach` of it.
pub(super) fn meet(a: &Carrier, b: &Carrier, guess: Point, reach: f64) -> Option<Point> {
    let mut p = guess;
    for _ in 0..MEETING_STEPS {
        let ((da, na), (db, nb)) = (a.distance(p), b.distance(p));
        let det = na.perp(&nb);
        if det.abs() < MEETING_SINE {
            return None;
        }
        // na·s = -da, nb·s = -db by Cramer's rule.
        let step = Vector::new(db * na.y - da * nb.y, da * nb.x - db * na.x) / det;
        p += step;
        if !(p - guess).norm().is_finite() || (p - guess).norm() > reach {
            return None;
        }
    }
    let off = a.distance(p).0.abs().max(b.distance(p).0.abs());
    (off <= MEETING_TOLERANCE * reach).then_some(p)
}
