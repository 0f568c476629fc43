//! What a disk inside of a region can touch: a line, an arc, a concave vertex; and the disks that touch a given place.
//!
//! The disks tangent to the boundary at one place form a nested family: the larger holds the smaller. The one through a
//! point q has the radius |q - p|² / (2 (q - p)·n), p the place and n its inward normal; the least of that over an element
//! is where the growing disk first touches it, which for a line or a circle is a common tangent in closed form.

use crate::plane::{Arc, Link, Point, Segment, Turn, Vector, left_normal, turn_angle};

/// A place of the boundary.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    pub point: Point,
    /// Unit normal into the solid.
    pub normal: Vector,
}

impl Foot {
    /// The centre of the tangent disk of a radius.
    pub fn center(&self, radius: f64) -> Point {
        self.point + self.normal * radius
    }

    /// The radius of the tangent disk through `q`; infinite where `q` is behind the tangent.
    fn radius_through(&self, q: Point) -> f64 {
        let v = q - self.point;
        let ahead = v.dot(&self.normal);
        if ahead > 0.0 { v.norm_squared() / (2.0 * ahead) } else { f64::INFINITY }
    }
}

/// Where a growing disk first touches a piece.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// Radius of the disk.
    pub radius: f64,
    /// The place on the piece.
    pub param: f64,
}

/// An element of the boundary, with a parameter: length along a line, the angle turned along an arc or about a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) enum Site {
    Line {
        start: Point,
        direction: Vector,
        length: f64,
    },
    Arc {
        arc: Arc,
        spoke: Vector,
        sweep: f64,
    },
    /// A concave vertex: disks touch it in all the directions between the normals of the two links.
    Vertex {
        at: Point,
        first_normal: Vector,
        turn: f64,
    },
}

/// A part of a site.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub site: usize,
    pub from: f64,
    pub to: f64,
}

impl Site {
    pub fn of_segment(segment: &Segment) -> Site {
        match segment.link {
            Link::Line => Site::Line {
                start: segment.start,
                direction: segment.start_tangent(),
                length: (segment.end - segment.start).norm(),
            },
            Link::Arc(arc) => {
                let spoke = (segment.start - arc.center).try_normalize(0.0).unwrap_or(Vector::x());
                Site::Arc { arc, spoke, sweep: segment.sweep() }
            }
        }
    }

    /// The largest value of the parameter; the least is 0.
    pub fn end(&self) -> f64 {
        match *self {
            Site::Line { length, .. } => length,
            Site::Arc { sweep, .. } => sweep,
            Site::Vertex { turn, .. } => turn,
        }
    }

    /// How long the boundary is between two values of the parameter.
    pub fn length(&self, from: f64, to: f64) -> f64 {
        match self {
            Site::Line { .. } => to - from,
            Site::Arc { arc, .. } => arc.radius * (to - from),
            Site::Vertex { .. } => 0.0,
        }
    }

    /// The place at `param`.
    pub fn at(&self, param: f64) -> Foot {
        match *self {
            Site::Line { start, direction, .. } => {
                Foot { point: start + direction * param, normal: left_normal(direction) }
            }
            Site::Arc { arc, spoke, .. } => {
                let out = turned(spoke, arc.turn.sign() * param);
                Foot { point: arc.center + out * arc.radius, normal: out * -arc.turn.sign() }
            }
            Site::Vertex { at, first_normal, .. } => Foot { point: at, normal: turned(first_normal, -param) },
        }
    }

    /// The radius beyond which a disk that touches the site cannot grow, whatever else there is: that of a convex arc.
    pub fn own_limit(&self) -> f64 {
        match self {
            Site::Arc { arc, .. } if arc.turn == Turn::Left => arc.radius,
            _ => f64::INFINITY,
        }
    }

    /// The direction of a vertex's centre, as its parameter.
    fn turn_to(first_normal: Vector, direction: Vector) -> f64 {
        -turn_angle(first_normal, direction)
    }

    /// Where the growing disk at `foot` first touches the part of the site between `from` and `to`; `None` where it never
    /// does. Whatever lies within `tiny` of the foot belongs to it.
    pub fn touch(&self, from: f64, to: f64, foot: &Foot, tiny: f64) -> Option<Touch> {
        if let Site::Vertex { at, first_normal, .. } = *self {
            let radius = foot.radius_through(at);
            let is_apart = (at - foot.point).norm() > tiny;
            return (radius.is_finite() && is_apart).then(|| {
                let param = Site::turn_to(first_normal, foot.center(radius) - at);
                Touch { radius, param: param.clamp(from, to) }
            });
        }
        let tangent = self.tangent_disk(foot).filter(|t| (from..=to).contains(&t.param));
        let best = tangent.or_else(|| {
            let ends = [from, to].map(|param| Touch { radius: foot.radius_through(self.at(param).point), param });
            Some(if ends[0].radius <= ends[1].radius { ends[0] } else { ends[1] })
        })?;
        (best.radius.is_finite() && (self.at(best.param).point - foot.point).norm() > tiny).then_some(best)
    }

    /// The disk at `foot` that is tangent to the whole line or circle of the site from its solid side.
    fn tangent_disk(&self, foot: &Foot) -> Option<Touch> {
        match *self {
            Site::Line { start, direction, .. } => {
                let across = left_normal(direction);
                let from_start = foot.point - start;
                // 1 - cos of the angle between the normals, without cancellation.
                let opening = 0.5 * (foot.normal - across).norm_squared();
                let height = from_start.dot(&across);
                let radius = height / opening;
                let param = from_start.dot(&direction) + radius * foot.normal.dot(&direction);
                (height > 0.0 && radius.is_finite()).then_some(Touch { radius, param })
            }
            Site::Arc { arc, spoke, .. } => {
                // |c - O| = R - t inside of a convex arc, R + t outside of a concave one, with c = p + t n.
                let signed = arc.turn.sign() * arc.radius;
                let e = foot.center(signed) - arc.center;
                let along = e.dot(&foot.normal);
                let radius = signed - e.norm_squared() / (2.0 * along);
                if !(radius.is_finite() && radius > 0.0 && arc.turn.sign() * along > 0.0) {
                    return None;
                }
                let out = (foot.center(radius) - arc.center).try_normalize(0.0)?;
                let angle = arc.turn.sign() * turn_angle(spoke, out);
                let param = if angle < 0.0 { angle + std::f64::consts::TAU } else { angle };
                Some(Touch { radius, param })
            }
            Site::Vertex { .. } => None,
        }
    }

    /// The parameter of the leftmost place between `from` and `to`.
    pub fn leftmost(&self, from: f64, to: f64) -> f64 {
        let extreme = match *self {
            Site::Line { .. } => None,
            Site::Arc { arc, spoke, .. } => {
                let angle = arc.turn.sign() * turn_angle(spoke, -Vector::x());
                Some(if angle < 0.0 { angle + std::f64::consts::TAU } else { angle })
            }
            // All of it is one place: that which faces left.
            Site::Vertex { first_normal, .. } => return Site::turn_to(first_normal, -Vector::x()).clamp(from, to),
        };
        let x = |param: &f64| self.at(*param).point.x;
        let inner = extreme.filter(|e| (from..=to).contains(e));
        [from, to].into_iter().chain(inner).min_by(|a, b| x(a).total_cmp(&x(b))).unwrap_or(from)
    }
}

/// `v` turned counterclockwise.
fn turned(v: Vector, angle: f64) -> Vector {
    let (sin, cos) = angle.sin_cos();
    Vector::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}
