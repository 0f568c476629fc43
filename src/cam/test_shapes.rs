//! Closed regions for tests.

use std::f64::consts::TAU;

use crate::plane::{Arc, Joint, Link, Point, Region, Ring, Turn, Vertex, left_normal, right_normal, turn_angle};

pub(crate) fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

/// The polygon with every concave corner filled by an arc of `radius`; links have to be long enough.
pub(crate) fn filled(points: &[Point], radius: f64) -> Ring {
    let n = points.len();
    let mut vertices = Vec::new();
    for i in 0..n {
        let (a, b, c) = (points[(i + n - 1) % n], points[i], points[(i + 1) % n]);
        let (u, v) = ((b - a).normalize(), (c - b).normalize());
        let turn = turn_angle(u, v);
        if turn >= 0.0 || radius == 0.0 {
            vertices.push(Vertex::corner(b));
            continue;
        }
        let cut = radius * (-0.5 * turn).tan();
        assert!(cut < 0.5 * (b - a).norm() && cut < 0.5 * (c - b).norm(), "the links are too short for the radius");
        let start = b - u * cut;
        let arc = Arc { center: start + right_normal(u) * radius, radius, turn: Turn::Right };
        vertices.push(Vertex { link: Link::Arc(arc), ..Vertex::corner(start) });
        vertices.push(Vertex::corner(b + v * cut));
    }
    Ring { vertices }
}

/// An L, 40 by 30, with its inside corner filled.
pub(crate) fn rounded_l(radius: f64) -> Region {
    let points = [p(0.0, 0.0), p(40.0, 0.0), p(40.0, 10.0), p(10.0, 10.0), p(10.0, 30.0), p(0.0, 30.0)];
    Region::new(vec![filled(&points, radius)])
}

/// A plate of `columns` by `rows` cells of 12 mm with a round hole of `radius` in each.
pub(crate) fn plate(columns: usize, rows: usize, radius: f64) -> Region {
    let (w, h) = (12.0 * columns as f64, 12.0 * rows as f64);
    let mut rings = vec![Ring::polygon([p(0.0, 0.0), p(w, 0.0), p(w, h), p(0.0, h)])];
    for row in 0..rows {
        for column in 0..columns {
            let center = p(12.0 * column as f64 + 6.0, 12.0 * row as f64 + 6.0);
            rings.push(Ring::circle(center, radius).reversed());
        }
    }
    Region::new(rings)
}

/// A smooth closed curve given by chords: r(φ) = size (1 + depth cos(lobes φ)), its samples marked smooth.
pub(crate) fn wavy(size: f64, depth: f64, lobes: f64, count: usize) -> Ring {
    let vertices = (0..count)
        .map(|k| {
            let angle = TAU * k as f64 / count as f64;
            let r = size * (1.0 + depth * (lobes * angle).cos());
            Vertex { joint: Joint::Smooth, ..Vertex::corner(p(r * angle.cos(), r * angle.sin())) }
        })
        .collect();
    Ring { vertices }
}

/// The exact curve of [`wavy`] at an angle, moved outward by `distance`.
pub(crate) fn wavy_offset(size: f64, depth: f64, lobes: f64, angle: f64, distance: f64) -> Point {
    let (r, dr) = (size * (1.0 + depth * (lobes * angle).cos()), -size * depth * lobes * (lobes * angle).sin());
    let radial = crate::plane::Vector::new(angle.cos(), angle.sin());
    let tangent = (radial * dr + left_normal(radial) * r).normalize();
    Point::origin() + radial * r + right_normal(tangent) * distance
}

/// A star of straight links around `center`, one radius a ray.
pub(crate) fn star(center: Point, radii: &[f64]) -> Vec<Point> {
    let n = radii.len() as f64;
    radii
        .iter()
        .enumerate()
        .map(|(k, r)| {
            let angle = TAU * k as f64 / n;
            center + crate::plane::Vector::new(r * angle.cos(), r * angle.sin())
        })
        .collect()
}

/// The largest turn at the joints of a ring, in radians.
pub(crate) fn largest_corner(ring: &Ring) -> f64 {
    let segments: Vec<_> = ring.segments().collect();
    let n = segments.len();
    (0..n)
        .map(|i| turn_angle(segments[(i + n - 1) % n].end_tangent(), segments[i].start_tangent()).abs())
        .fold(0.0, f64::max)
}
