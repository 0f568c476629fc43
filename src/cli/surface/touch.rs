//! Whether a region of space meets a surface: also where no vertex lies in it, as on large faces.

use crate::mesh::{Hierarchy, Point, TriangleMesh, Vector, nearest_on_triangle};

/// A region of space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Space {
    /// Between two corners.
    Box([Point; 2]),
    /// Within a distance of the line between two points, which may be one.
    Line([Point; 2], f64),
}

impl Space {
    /// Whether some point of the surface is in it.
    pub fn meets(&self, mesh: &TriangleMesh, hierarchy: &Hierarchy) -> bool {
        let (low, high) = match *self {
            Space::Box([low, high]) => (low, high),
            Space::Line([a, b], r) => {
                let around = Vector::repeat(r);
                (a.inf(&b) - around, a.sup(&b) + around)
            }
        };
        hierarchy.any_in_box(low, high, |face| {
            let triangle = mesh.triangle(face as usize);
            match *self {
                Space::Box(corners) => is_in_box(triangle, corners),
                Space::Line(ends, r) => distance(triangle, ends) <= r,
            }
        })
    }
}

/// Whether something of a triangle is in a box: what each side of the box leaves of it.
fn is_in_box(triangle: [Point; 3], [low, high]: [Point; 2]) -> bool {
    let mut left: Vec<Point> = triangle.to_vec();
    for k in 0..3 {
        for (sign, limit) in [(1.0, high[k]), (-1.0, -low[k])] {
            let beyond = |p: &Point| sign * p[k] - limit;
            let mut inside = Vec::with_capacity(left.len() + 1);
            for (i, p) in left.iter().enumerate() {
                let q = &left[(i + 1) % left.len()];
                let (a, b) = (beyond(p), beyond(q));
                if a <= 0.0 {
                    inside.push(*p);
                }
                if (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0) {
                    inside.push(p + (q - p) * (a / (a - b)));
                }
            }
            left = inside;
        }
    }
    !left.is_empty()
}

/// The distance between a triangle and a line from one point to another.
fn distance(triangle: [Point; 3], [a, b]: [Point; 2]) -> f64 {
    let of_end = |p: Point| (p - nearest_on_triangle(p, triangle).0).norm();
    let sides = (0..3).map(|k| between([triangle[k], triangle[(k + 1) % 3]], [a, b]));
    let least = sides.fold(of_end(a).min(of_end(b)), f64::min);
    if is_pierced(triangle, a, b) { 0.0 } else { least }
}

/// Whether the line from `a` to `b` passes through a triangle.
fn is_pierced([p, q, s]: [Point; 3], a: Point, b: Point) -> bool {
    let volume = |u: Point, v: Point, w: Point, x: Point| (v - u).cross(&(w - u)).dot(&(x - u));
    let turns = [volume(a, b, p, q), volume(a, b, q, s), volume(a, b, s, p)];
    volume(p, q, s, a) * volume(p, q, s, b) < 0.0 && (turns.iter().all(|t| *t > 0.0) || turns.iter().all(|t| *t < 0.0))
}

/// The distance between two lines that have ends (Ericson, Real-Time Collision Detection, 2005, section 5.1.9).
fn between([p, q]: [Point; 2], [a, b]: [Point; 2]) -> f64 {
    let (u, v, w) = (q - p, b - a, p - a);
    let (uu, vv, uv) = (u.norm_squared(), v.norm_squared(), u.dot(&v));
    let part = |over: f64, under: f64| if under > 0.0 { (over / under).clamp(0.0, 1.0) } else { 0.0 };
    let s = part(uv * v.dot(&w) - u.dot(&w) * vv, uu * vv - uv * uv);
    // The nearest to that on the other line, and the nearest to this on the first.
    let t = part(uv * s + v.dot(&w), vv);
    let s = part(uv * t - u.dot(&w), uu);
    ((p + u * s) - (a + v * t)).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_in_the_middle_of_a_face_meet_it() {
        let points = [[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [0.0, 9.0, 0.0]].map(Point::from).to_vec();
        let mesh = TriangleMesh::new(points, vec![[0, 1, 2]]);
        let hierarchy = Hierarchy::new(&mesh.points, &mesh.faces);
        let line = |a: [f64; 3], b: [f64; 3], r| Space::Line([a.into(), b.into()], r).meets(&mesh, &hierarchy);
        let within = |a: [f64; 3], b: [f64; 3]| Space::Box([a.into(), b.into()]).meets(&mesh, &hierarchy);
        assert!(within([2.0, 2.0, -1.0], [3.0, 3.0, 1.0]) && within([-1.0; 3], [10.0; 3]));
        assert!(within([4.0, 4.0, -0.5], [6.0, 6.0, 0.5]), "across an edge");
        assert!(!within([5.0, 5.0, -0.5], [6.0, 6.0, 0.5]), "beyond the edge, in the box around the triangle");
        assert!(!within([2.0, 2.0, 0.1], [3.0, 3.0, 1.0]));
        assert!(line([2.0, 2.0, -5.0], [2.0, 2.0, 5.0], 0.01), "through it");
        assert!(line([2.0, 2.0, 0.5], [2.0, 2.0, 0.5], 0.6) && !line([2.0, 2.0, 0.5], [2.0, 2.0, 0.5], 0.4));
        assert!(line([-9.0, -0.5, 0.5], [19.0, -0.5, 0.5], 0.8) && !line([-9.0, -0.5, 0.5], [19.0, -0.5, 0.5], 0.7));
        assert!(!line([2.0, 2.0, 1.0], [2.0, 2.0, 5.0], 0.9));
    }
}
