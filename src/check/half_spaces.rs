//! The point of an intersection of half-spaces that is nearest to a given one.

use crate::mesh::{Point, Vector};

/// All z with normal · z at least `offset`.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfSpace {
    pub(super) normal: Vector,
    pub(super) offset: f64,
}

impl HalfSpace {
    /// How far `p` is outside, along the normal; negative inside.
    pub(super) fn lack(&self, p: Point) -> f64 {
        self.offset - self.normal.dot(&p.coords)
    }
}

/// Planes that include a smaller angle have no line or corner in common that means anything: the determinant of their
/// normals.
const PARALLEL: f64 = 1e-9;

/// The point nearest to `x` in all of `spaces`, within `tolerance`, by trying which of them hold it: one, two or three. Nothing where no such
/// point is found.
pub(super) fn nearest_in_all(x: Point, spaces: &[HalfSpace], tolerance: f64) -> Option<Point> {
    let is_in_all = |p: Point| spaces.iter().all(|s| s.lack(p) <= tolerance);
    if is_in_all(x) {
        return Some(x);
    }
    for (i, a) in spaces.iter().enumerate() {
        let p = x + a.normal * a.lack(x);
        if a.lack(x) > 0.0 && is_in_all(p) {
            return Some(p);
        }
        for (j, b) in spaces[..i].iter().enumerate() {
            if let Some(p) = on_line(x, [a, b]).filter(|p| is_in_all(*p)) {
                return Some(p);
            }
            for c in &spaces[..j] {
                if let Some(p) = in_corner(x, [a, b, c]).filter(|p| is_in_all(*p)) {
                    return Some(p);
                }
            }
        }
    }
    None
}

/// The nearest point where two planes meet, if both are needed to hold it there.
fn on_line(x: Point, spaces: [&HalfSpace; 2]) -> Option<Point> {
    let [a, b] = spaces;
    let cos = a.normal.dot(&b.normal);
    let det = 1.0 - cos * cos;
    if det < PARALLEL {
        return None;
    }
    let (u, v) = (a.lack(x), b.lack(x));
    let (s, t) = ((u - cos * v) / det, (v - cos * u) / det);
    (s >= 0.0 && t >= 0.0).then(|| x + a.normal * s + b.normal * t)
}

/// The point where three planes meet, if all are needed to hold it there.
fn in_corner(x: Point, spaces: [&HalfSpace; 3]) -> Option<Point> {
    let normals = nalgebra::Matrix3::from_columns(&spaces.map(|s| s.normal));
    let gram = normals.transpose() * normals;
    if gram.determinant() < PARALLEL {
        return None;
    }
    let forces = gram.lu().solve(&Vector::from(spaces.map(|s| s.lack(x))))?;
    forces.iter().all(|f| *f >= 0.0).then(|| x + normals * forces)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_edges_and_corners_hold_the_nearest_point() {
        let space = |n: [f64; 3], offset: f64| HalfSpace { normal: Vector::from(n).normalize(), offset };
        let octant = [space([1.0, 0.0, 0.0], 1.0), space([0.0, 1.0, 0.0], 2.0), space([0.0, 0.0, 1.0], 3.0)];
        let nearest = |x: [f64; 3]| nearest_in_all(x.into(), &octant, 1e-12).unwrap();
        assert!((nearest([4.0, 5.0, 6.0]) - Point::new(4.0, 5.0, 6.0)).norm() < 1e-12);
        assert!((nearest([0.0, 5.0, 6.0]) - Point::new(1.0, 5.0, 6.0)).norm() < 1e-12);
        assert!((nearest([0.0, 0.0, 6.0]) - Point::new(1.0, 2.0, 6.0)).norm() < 1e-12);
        assert!((nearest([0.0, 0.0, 0.0]) - Point::new(1.0, 2.0, 3.0)).norm() < 1e-12);
        let against = [space([1.0, 0.0, 0.0], 1.0), space([-1.0, 0.0, 0.0], 0.0)];
        assert!(nearest_in_all(Point::origin(), &against, 1e-12).is_none());
    }
}
