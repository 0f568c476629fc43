//! One boundary element: a straight link or a circular arc between two points.

use std::f64::consts::{PI, TAU};

use super::{Bounds, Point, Vector, left_normal, right_normal};

/// The side to which a curve bends along its direction of travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub enum Turn {
    /// Counterclockwise: the centre is on the left. Convex on the boundary of a region.
    Left,
    /// Clockwise: the centre is on the right. Concave on the boundary of a region.
    Right,
}

impl Turn {
    /// The other side.
    pub fn opposite(self) -> Turn {
        match self {
            Turn::Left => Turn::Right,
            Turn::Right => Turn::Left,
        }
    }

    /// +1 for left, -1 for right.
    #[inline]
    pub fn sign(self) -> f64 {
        match self {
            Turn::Left => 1.0,
            Turn::Right => -1.0,
        }
    }
}

/// The circle that an arc runs on, and the way it runs. The end points belong to the vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Centre of the circle.
    pub center: Point,
    /// Radius, positive.
    pub radius: f64,
    /// Direction of travel.
    pub turn: Turn,
}

impl Arc {
    /// The direction of travel at `p`, a point of the circle.
    #[inline]
    pub fn tangent_at(&self, p: Point) -> Vector {
        let spoke = (p - self.center) / self.radius;
        match self.turn {
            Turn::Left => left_normal(spoke),
            Turn::Right => right_normal(spoke),
        }
    }

    /// The angle travelled from `from` to `to`, in [0, 2π).
    #[inline]
    pub fn angle_between(&self, from: Point, to: Point) -> f64 {
        let (u, v) = (from - self.center, to - self.center);
        let angle = (self.turn.sign() * u.perp(&v)).atan2(u.dot(&v));
        if angle < 0.0 { angle + TAU } else { angle }
    }

    /// The point reached from `from`, a point of the circle, after travelling `angle` radians.
    #[inline]
    pub fn travel(&self, from: Point, angle: f64) -> Point {
        let (sin, cos) = (self.turn.sign() * angle).sin_cos();
        let v = from - self.center;
        self.center + Vector::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
    }
}

/// How the boundary goes from one vertex to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Link {
    /// Straight.
    Line,
    /// Along a circle. An arc sweeps less than a full turn; a circle is at least two arcs.
    Arc(Arc),
}

impl Link {
    /// The same link travelled the other way.
    pub fn reversed(self) -> Link {
        match self {
            Link::Line => Link::Line,
            Link::Arc(arc) => Link::Arc(Arc { turn: arc.turn.opposite(), ..arc }),
        }
    }

    /// The same link moved by `by`.
    pub fn translated(self, by: Vector) -> Link {
        match self {
            Link::Line => Link::Line,
            Link::Arc(arc) => Link::Arc(Arc { center: arc.center + by, ..arc }),
        }
    }
}

/// A boundary element with its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where it starts.
    pub start: Point,
    /// Where it ends.
    pub end: Point,
    /// How it gets there.
    pub link: Link,
}

/// An arc becomes no more chords than this: beyond it a tolerance is below what `f64` can resolve on its radius, or the
/// arc is absurd.
const MOST_CHORDS: f64 = 1e5;

/// The nearest point of a boundary element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The point.
    pub point: Point,
    /// Its distance.
    pub distance: f64,
}

impl Segment {
    /// A straight element.
    pub fn line(start: Point, end: Point) -> Segment {
        Segment { start, end, link: Link::Line }
    }

    /// The angle swept by an arc in [0, 2π); 0 for a straight element.
    pub fn sweep(&self) -> f64 {
        match self.link {
            Link::Line => 0.0,
            Link::Arc(arc) => arc.angle_between(self.start, self.end),
        }
    }

    /// Arc length.
    pub fn length(&self) -> f64 {
        match self.link {
            Link::Line => (self.end - self.start).norm(),
            Link::Arc(arc) => arc.radius * self.sweep(),
        }
    }

    /// Unit direction of travel at the start; the x axis for an element without length.
    pub fn start_tangent(&self) -> Vector {
        self.tangent(self.start)
    }

    /// Unit direction of travel at the end; the x axis for an element without length.
    pub fn end_tangent(&self) -> Vector {
        self.tangent(self.end)
    }

    #[inline]
    fn tangent(&self, p: Point) -> Vector {
        match self.link {
            Link::Line => (self.end - self.start).try_normalize(0.0).unwrap_or(Vector::x()),
            Link::Arc(arc) => arc.tangent_at(p),
        }
    }

    /// The point at the fraction `t` of the length, `t` in [0, 1]; the ends are returned as they are.
    pub fn point_at(&self, t: f64) -> Point {
        if t <= 0.0 {
            return self.start;
        }
        if t >= 1.0 {
            return self.end;
        }
        match self.link {
            Link::Line => self.start + (self.end - self.start) * t,
            Link::Arc(arc) => arc.travel(self.start, self.sweep() * t),
        }
    }

    /// The same element travelled from end to start.
    pub fn reversed(&self) -> Segment {
        Segment { start: self.end, end: self.start, link: self.link.reversed() }
    }

    /// The smallest axis-parallel box that holds the element.
    pub fn bounds(&self) -> Bounds {
        let mut bounds = Bounds::of_points([self.start, self.end]);
        if let Link::Arc(arc) = self.link {
            let sweep = self.sweep();
            for axis in [Vector::x(), Vector::y(), -Vector::x(), -Vector::y()] {
                let extreme = arc.center + axis * arc.radius;
                if arc.angle_between(self.start, extreme) < sweep {
                    bounds = bounds.with_point(extreme);
                }
            }
        }
        bounds
    }

    /// The nearest point of the element to `p`.
    pub fn nearest(&self, p: Point) -> Nearest {
        let at = |point: Point| Nearest { point, distance: (point - p).norm() };
        match self.link {
            Link::Line => {
                let d = self.end - self.start;
                let length_squared = d.norm_squared();
                let t = if length_squared > 0.0 { (p - self.start).dot(&d) / length_squared } else { 0.0 };
                at(self.point_at(t))
            }
            Link::Arc(arc) => {
                let spoke = p - arc.center;
                let norm = spoke.norm();
                if norm > 0.0 {
                    let foot = arc.center + spoke * (arc.radius / norm);
                    if arc.angle_between(self.start, foot) <= self.sweep() {
                        return Nearest { point: foot, distance: (norm - arc.radius).abs() };
                    }
                }
                let (a, b) = (at(self.start), at(self.end));
                if a.distance <= b.distance { a } else { b }
            }
        }
    }

    /// Whether some point of the element lies nearer to `p` than `limit`.
    #[inline]
    pub fn is_nearer(&self, p: Point, limit: f64) -> bool {
        match self.link {
            Link::Line => {
                let (d, w) = (self.end - self.start, p - self.start);
                let (along, length_squared) = (w.dot(&d), d.norm_squared());
                let nearest = if along <= 0.0 {
                    w.norm_squared()
                } else if along >= length_squared {
                    (p - self.end).norm_squared()
                } else {
                    let across = d.perp(&w);
                    across * across / length_squared
                };
                nearest < limit * limit && limit > 0.0
            }
            Link::Arc(_) => self.nearest(p).distance < limit,
        }
    }

    /// Twice the signed area between the element and the origin, counterclockwise positive.
    pub fn doubled_area(&self) -> f64 {
        let chord = self.start.coords.perp(&self.end.coords);
        match self.link {
            Link::Line => chord,
            Link::Arc(arc) => {
                let sweep = self.sweep();
                // The circular segment between chord and arc: r² (φ - sin φ), doubled.
                chord + arc.turn.sign() * arc.radius * arc.radius * (sweep - sweep.sin())
            }
        }
    }

    /// Points after the start up to and including the end, so that the chords stay within `tolerance` of the element.
    ///
    /// `tolerance` is the largest distance (sagitta) and must be positive; a straight element gives its end alone.
    pub fn flatten(&self, tolerance: f64, mut emit: impl FnMut(Point)) {
        if let Link::Arc(arc) = self.link {
            let sweep = self.sweep();
            let step = if tolerance < arc.radius { 2.0 * (1.0 - tolerance / arc.radius).acos() } else { PI };
            let count = (sweep / step).ceil().clamp(1.0, MOST_CHORDS);
            for k in 1..count as usize {
                emit(arc.travel(self.start, sweep * k as f64 / count));
            }
        }
        emit(self.end);
    }
}

impl Segment {
    /// The element moved by `by`.
    pub fn translated(&self, by: Vector) -> Segment {
        Segment { start: self.start + by, end: self.end + by, link: self.link.translated(by) }
    }

    /// Signed crossings of the element with the ray from `p` towards +x: +1 upward, -1 downward.
    ///
    /// Summed over a ring this is its winding number about `p`. Ends are half-open in y, so that a ray through a vertex
    /// counts once.
    pub fn ray_crossings(&self, p: Point) -> i32 {
        let line = |a: Point, b: Point| -> i32 {
            let side = (b - a).perp(&(p - a));
            if a.y <= p.y && b.y > p.y && side > 0.0 {
                1
            } else if b.y <= p.y && a.y > p.y && side < 0.0 {
                -1
            } else {
                0
            }
        };
        match self.link {
            Link::Line => line(self.start, self.end),
            Link::Arc(arc) => {
                // The chord, and then the circular segment between chord and arc, which is a convex set.
                let chord = line(self.start, self.end);
                let spoke = p - arc.center;
                if spoke.norm_squared() >= arc.radius * arc.radius {
                    return chord;
                }
                let side = (self.end - self.start).perp(&(p - self.start));
                match arc.turn {
                    // Counterclockwise: the circular segment lies right of the chord.
                    Turn::Left if side < 0.0 => chord + 1,
                    Turn::Right if side > 0.0 => chord - 1,
                    _ => chord,
                }
            }
        }
    }
}
