//! A boundary link as something that a disk rolls on, always on its right side.

use super::carrier::Carrier;
use crate::plane::{Arc, Link, Point, Segment, Turn, Vector, right_normal};

/// A straight link or an arc of the input, with what rolling needs of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Track {
    pub(super) start: Point,
    shape: Shape,
    /// Arc length.
    pub(super) length: f64,
}

#[derive(Clone, Copy, Debug)]
enum Shape {
    Line { direction: Vector },
    Arc(Arc),
}

/// Where a disk touches a track.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    /// Arc length from the start of the track; beyond its ends where the touching point lies on the continuation.
    pub(super) at: f64,
    pub(super) point: Point,
}

impl Track {
    pub(super) fn new(segment: Segment) -> Track {
        let start = segment.start;
        match segment.link {
            Link::Line => {
                let d = segment.end - start;
                let length = d.norm();
                let direction = if length > 0.0 { d / length } else { Vector::x() };
                Track { start, shape: Shape::Line { direction }, length }
            }
            Link::Arc(arc) => Track { start, shape: Shape::Arc(arc), length: segment.length() },
        }
    }

    /// The path of the centre of a disk of radius `r` that rolls on the right side.
    pub(super) fn carrier(&self, r: f64) -> Carrier {
        match self.shape {
            Shape::Line { direction } => Carrier::Line(self.start + right_normal(direction) * r, direction),
            Shape::Arc(arc) => {
                let radius = arc.radius + arc.turn.sign() * r;
                // A concave arc of the disk's own radius holds the disk still. The bound is far above the rounding of
                // the arc's ends and far below any radius that somebody draws.
                const OWN_RADIUS: f64 = 1e-7;
                if radius.abs() <= OWN_RADIUS * r {
                    Carrier::Fixed(arc.center)
                } else {
                    Carrier::Circle(arc.center, radius.abs())
                }
            }
        }
    }

    /// Where a disk with this centre, which touches the continued track, touches it.
    pub(super) fn contact(&self, center: Point) -> Contact {
        match self.shape {
            Shape::Line { direction } => {
                let at = (center - self.start).dot(&direction);
                Contact { at, point: self.start + direction * at }
            }
            Shape::Arc(arc) => {
                let spoke = center - arc.center;
                let norm = spoke.norm();
                if norm == 0.0 {
                    return Contact { at: 0.0, point: self.start };
                }
                let point = arc.center + spoke * (arc.radius / norm);
                let mut at = arc.radius * arc.angle_between(self.start, point);
                // The shorter way round to a point before the start.
                let around = std::f64::consts::TAU * arc.radius;
                if at > 0.5 * (around + self.length) {
                    at -= around;
                }
                Contact { at, point }
            }
        }
    }

    /// The centre of the disk of radius `r` that touches the track at `contact` from the right.
    pub(super) fn center_at(&self, contact: &Contact, r: f64) -> Point {
        contact.point + right_normal(self.tangent_at(contact.point)) * r
    }

    /// The contact of a disk of radius `r` with this centre, where it touches the continued track from the right.
    pub(super) fn touch(&self, center: Point, r: f64) -> Option<Contact> {
        // Centres come from crossings of carriers; along flat crossings they are good to the root of the rounding.
        const TOUCHING: f64 = 1e-7;
        let contact = self.contact(center);
        ((center - contact.point).norm() - r).abs().le(&(TOUCHING * r)).then_some(contact)
    }

    /// Unit direction of travel at a point of the track.
    pub(super) fn tangent_at(&self, p: Point) -> Vector {
        match self.shape {
            Shape::Line { direction } => direction,
            Shape::Arc(arc) => arc.tangent_at(p),
        }
    }

    /// Whether a disk of radius `r` fits everywhere along the right side: false for a concave arc below `r`.
    pub(super) fn fits(&self, r: f64) -> bool {
        match self.shape {
            Shape::Arc(Arc { radius, turn: Turn::Right, .. }) => radius >= r,
            _ => true,
        }
    }

    pub(super) fn is_straight(&self) -> bool {
        matches!(self.shape, Shape::Line { .. })
    }
}
