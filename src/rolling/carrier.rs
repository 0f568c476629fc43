//! Where the centre of a disk can be while it touches something: lines, circles and points, and their common points.

use crate::plane::{Point, Vector};

/// A curve that carries the centres of a disk of one radius touching one boundary element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Carrier {
    /// A disk rolling on a straight link: through the point, along the unit direction.
    Line(Point, Vector),
    /// A disk rolling on a vertex or on an arc.
    Circle(Point, f64),
    /// A disk lying in an arc of its own radius: it cannot roll.
    Fixed(Point),
}

/// Up to two points.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Roots {
    points: [Option<Point>; 2],
}

impl Roots {
    fn two(a: Point, b: Point) -> Roots {
        Roots { points: [Some(a), Some(b)] }
    }

    fn one(a: Point) -> Roots {
        Roots { points: [Some(a), None] }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = Point> + '_ {
        self.points.iter().flatten().copied()
    }

    /// The root nearest to `p`.
    pub(super) fn nearest(&self, p: Point) -> Option<Point> {
        self.iter().min_by(|a, b| (a - p).norm_squared().total_cmp(&(b - p).norm_squared()))
    }
}

/// The common points of a line through `p` along the unit vector `u` and a circle; a line that misses the circle by
/// no more than `slack` touches it.
pub(super) fn line_circle(p: Point, u: Vector, center: Point, radius: f64, slack: f64) -> Roots {
    let w = center - p;
    let along = w.dot(&u);
    let height = u.perp(&w).abs();
    if height > radius + slack {
        return Roots::default();
    }
    let half = ((radius - height) * (radius + height)).max(0.0).sqrt();
    Roots::two(p + u * (along - half), p + u * (along + half))
}

/// The common points of two circles; circles that miss each other by no more than `slack` touch.
///
/// The first root lies left of the way from the first centre to the second.
pub(super) fn circle_circle(c1: Point, r1: f64, c2: Point, r2: f64, slack: f64) -> Roots {
    let d = c2 - c1;
    let distance = d.norm();
    if distance == 0.0 || distance > r1 + r2 + slack || distance < (r1 - r2).abs() - slack {
        return Roots::default();
    }
    let along = 0.5 * (distance + (r1 - r2) * (r1 + r2) / distance);
    let half = ((r1 - along) * (r1 + along)).max(0.0).sqrt();
    let u = d / distance;
    let (foot, n) = (c1 + u * along, Vector::new(-u.y, u.x) * half);
    Roots::two(foot + n, foot - n)
}

impl Carrier {
    /// The common points of two carriers; near misses of up to `slack` (a distance) count as touching.
    pub(super) fn roots(&self, other: &Carrier, slack: f64) -> Roots {
        match (*self, *other) {
            (Carrier::Fixed(p), _) | (_, Carrier::Fixed(p)) => Roots::one(p),
            (Carrier::Line(p, u), Carrier::Line(q, v)) => {
                let sine = u.perp(&v);
                // Below this the crossing lies so far away that no disk near the links can mean it.
                const PARALLEL: f64 = 1e-12;
                if sine.abs() < PARALLEL { Roots::default() } else { Roots::one(p + u * ((q - p).perp(&v) / sine)) }
            }
            (Carrier::Line(p, u), Carrier::Circle(c, r)) | (Carrier::Circle(c, r), Carrier::Line(p, u)) => {
                line_circle(p, u, c, r, slack)
            }
            (Carrier::Circle(c1, r1), Carrier::Circle(c2, r2)) => circle_circle(c1, r1, c2, r2, slack),
        }
    }
}

/// The centre of the circle of radius `r` through `a` and `b` that lies right of the way from `a` to `b`.
pub(super) fn center_of_chord(a: Point, b: Point, r: f64) -> Point {
    let d = b - a;
    let length = d.norm();
    if length == 0.0 {
        return a;
    }
    let height = ((r - 0.5 * length) * (r + 0.5 * length)).max(0.0).sqrt();
    a + d * 0.5 + Vector::new(d.y, -d.x) * (height / length)
}
