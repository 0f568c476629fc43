//! Polygons cut into triangles.
//!
//! Triangles stay. Quads are cut along the diagonal that does not fold them, or, where neither does, along the one with the
//! better smallest angle. Larger polygons lose one ear after the other (Meisters, 1975), the best shaped first, in the
//! coordinate plane that they face most by their Newell normal, so that no coordinate is rounded.
//! Every polygon of n corners becomes n - 2 triangles over its own corners, whatever its shape.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::{Point, PolygonMesh, TriangleMesh, Vector};

/// A diagonal of a quad must beat the other one by this in its largest cosine: in squares and rectangles rounding must not
/// decide, but the numbers of the corners.
const SAME_SHAPE: f64 = 1e-9;

/// So many corners may be tested against ears for each corner of a polygon; what is left then is cut as a fan. Only polygons
/// with thousands of corners, most of them concave, come so far, and without it they would take quadratic time.
const TESTS: usize = 2000;

impl PolygonMesh {
    /// The same surface in triangles, with the polygon that each is a part of as its parent.
    ///
    /// # Panics
    /// If a polygon has a corner that is no vertex.
    pub fn triangulated(&self) -> TriangleMesh {
        let count = self.polygons().map(|p| p.len().saturating_sub(2)).sum();
        let mut faces = Vec::with_capacity(count);
        let mut parents = Vec::with_capacity(count);
        for (polygon, number) in self.polygons().zip(0..) {
            match *polygon {
                [] | [_] | [_, _] => {}
                [a, b, c] => faces.push([a, b, c]),
                [a, b, c, d] => faces.extend(cut_quad(&self.points, [a, b, c, d])),
                _ => cut_ears(&self.points, polygon, &mut faces),
            }
            parents.resize(faces.len(), number);
        }
        TriangleMesh { points: self.points.clone(), faces, parents }
    }
}

/// The cosine of the smallest angle of a triangle; 1 where two corners coincide.
fn largest_cosine(a: Point, b: Point, c: Point) -> f64 {
    let (u, v, w) = ((b - a).norm_squared(), (c - b).norm_squared(), (a - c).norm_squared());
    let cosine = |opposite: f64, s: f64, t: f64| {
        let cosine = (s + t - opposite) / (2.0 * (s * t).sqrt());
        if cosine.is_finite() { cosine } else { 1.0 }
    };
    cosine(u, v, w).max(cosine(v, w, u)).max(cosine(w, u, v)).min(1.0)
}

/// Twice the area of a triangle as a vector.
fn area_vector(a: Point, b: Point, c: Point) -> Vector {
    (b - a).cross(&(c - a))
}

/// The two triangles of a quad.
fn cut_quad(points: &[Point], quad: [u32; 4]) -> [[u32; 3]; 2] {
    // From the corner with the least number: where the quad starts in the file does not matter.
    let least = (0..4).min_by_key(|&k| quad[k]).unwrap_or(0);
    let [a, b, c, d] = [0, 1, 2, 3].map(|k| quad[(least + k) % 4]);
    let [p, q, r, s] = [a, b, c, d].map(|v| points[v as usize]);
    let normal = (r - p).cross(&(s - q));
    let folds = |one: Vector, other: Vector| one.dot(&normal) <= 0.0 || other.dot(&normal) <= 0.0;
    let by_ac =
        (folds(area_vector(p, q, r), area_vector(p, r, s)), largest_cosine(p, q, r).max(largest_cosine(p, r, s)));
    let by_bd =
        (folds(area_vector(q, r, s), area_vector(q, s, p)), largest_cosine(q, r, s).max(largest_cosine(q, s, p)));
    let takes_bd = if by_ac.0 == by_bd.0 { by_bd.1 < by_ac.1 - SAME_SHAPE } else { by_ac.0 };
    if takes_bd { [[b, c, d], [b, d, a]] } else { [[a, b, c], [a, c, d]] }
}

/// An ear, or what was one when it was found.
struct Ear {
    /// The cosine of its smallest angle: the best has the least.
    cosine: f64,
    corner: u32,
    /// How often the neighbours of the corner had changed then.
    version: u32,
}

impl Ord for Ear {
    fn cmp(&self, other: &Ear) -> Ordering {
        other.cosine.total_cmp(&self.cosine).then(other.corner.cmp(&self.corner)).then(self.version.cmp(&other.version))
    }
}

impl PartialOrd for Ear {
    fn partial_cmp(&self, other: &Ear) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Ear {
    fn eq(&self, other: &Ear) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Ear {}

/// A polygon that loses its ears.
struct Clipped<'a> {
    points: &'a [Point],
    polygon: &'a [u32],
    /// The corners in a plane, counterclockwise.
    flat: Vec<[f64; 2]>,
    before: Vec<u32>,
    after: Vec<u32>,
    version: Vec<u32>,
    /// The corners that were not convex at the start, by their first coordinate: only they can lie in an ear.
    dents: Vec<u32>,
    /// How many tests are left.
    tests: usize,
}

fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The normal of a polygon (Newell), twice its area long.
pub(super) fn newell(points: &[Point], polygon: &[u32]) -> Vector {
    let Some(&first) = polygon.first() else { return Vector::zeros() };
    let origin = points[first as usize];
    let at = |k: usize| points[polygon[k] as usize] - origin;
    (1..polygon.len().saturating_sub(1)).map(|k| at(k).cross(&at(k + 1))).sum()
}

impl<'a> Clipped<'a> {
    fn new(points: &'a [Point], polygon: &'a [u32], normal: Vector) -> Clipped<'a> {
        let n = polygon.len();
        let axis = normal.iamax();
        let (mut x, mut y) = ((axis + 1) % 3, (axis + 2) % 3);
        if normal[axis] < 0.0 {
            (x, y) = (y, x);
        }
        let flat: Vec<[f64; 2]> = polygon.iter().map(|&v| [points[v as usize][x], points[v as usize][y]]).collect();
        let before: Vec<u32> = (0..n as u32).map(|k| if k == 0 { n as u32 - 1 } else { k - 1 }).collect();
        let after: Vec<u32> = (0..n as u32).map(|k| if k + 1 == n as u32 { 0 } else { k + 1 }).collect();
        let mut clipped =
            Clipped { points, polygon, flat, before, after, version: vec![0; n], dents: vec![], tests: TESTS * n };
        clipped.dents = (0..n as u32).filter(|&k| clipped.turn_at(k) <= 0.0).collect();
        let flat = &clipped.flat;
        clipped.dents.sort_by(|a, b| flat[*a as usize][0].total_cmp(&flat[*b as usize][0]));
        clipped
    }

    fn corners_at(&self, k: u32) -> [u32; 3] {
        [self.before[k as usize], k, self.after[k as usize]]
    }

    fn turn_at(&self, k: u32) -> f64 {
        let [a, b, c] = self.corners_at(k).map(|i| self.flat[i as usize]);
        turn(a, b, c)
    }

    fn triangle_at(&self, k: u32) -> [u32; 3] {
        self.corners_at(k).map(|i| self.polygon[i as usize])
    }

    /// The ear at corner `k`, if it is one.
    fn ear(&mut self, k: u32) -> Option<Ear> {
        let [a, b, c] = self.corners_at(k).map(|i| self.flat[i as usize]);
        if turn(a, b, c) <= 0.0 {
            return None;
        }
        let (low, high) = (a[0].min(b[0]).min(c[0]), a[0].max(b[0]).max(c[0]));
        let start = self.dents.partition_point(|&i| self.flat[i as usize][0] < low);
        for &i in &self.dents[start..] {
            let p = self.flat[i as usize];
            if p[0] > high || self.tests == 0 {
                break;
            }
            self.tests -= 1;
            let is_inside = turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
            // Corners that are gone are no obstacle; nor are those of the ear, also where polygons touch themselves.
            let is_gone = self.after[i as usize] == u32::MAX;
            if is_inside && !is_gone && p != a && p != b && p != c && self.turn_at(i) <= 0.0 {
                return None;
            }
        }
        let [p, q, r] = self.triangle_at(k).map(|v| self.points[v as usize]);
        Some(Ear { cosine: largest_cosine(p, q, r), corner: k, version: self.version[k as usize] })
    }

    /// Cuts off corner `k`; answers with its neighbours.
    fn clip(&mut self, k: u32) -> [u32; 2] {
        let [a, _, c] = self.corners_at(k);
        self.after[a as usize] = c;
        self.before[c as usize] = a;
        self.after[k as usize] = u32::MAX;
        self.version[a as usize] += 1;
        self.version[c as usize] += 1;
        [a, c]
    }
}

/// Cuts a polygon into triangles over its own corners.
pub(super) fn cut_ears(points: &[Point], polygon: &[u32], faces: &mut Vec<[u32; 3]>) {
    let normal = newell(points, polygon);
    let mut clipped = Clipped::new(points, polygon, normal);
    let mut left = polygon.len();
    let mut some = 0;
    let mut ears = BinaryHeap::new();
    while left > 3 && clipped.tests > 0 {
        let found = std::iter::from_fn(|| ears.pop()).find(|e: &Ear| {
            clipped.after[e.corner as usize] != u32::MAX && clipped.version[e.corner as usize] == e.version
        });
        let corner = match found {
            Some(ear) => ear.corner,
            None => {
                // At the start, and where dents that are no longer any have made ears of others.
                let mut k = some;
                for _ in 0..left {
                    ears.extend(clipped.ear(k));
                    k = clipped.after[k as usize];
                }
                // The search itself counts: a shape that has no ears must not take quadratic time.
                clipped.tests = clipped.tests.saturating_sub(left);
                match ears.peek() {
                    Some(_) => continue,
                    // No simple polygon: any corner will do.
                    None => some,
                }
            }
        };
        faces.push(clipped.triangle_at(corner));
        let neighbours = clipped.clip(corner);
        some = neighbours[0];
        left -= 1;
        for k in neighbours {
            ears.extend(clipped.ear(k));
        }
    }
    while left >= 3 {
        let k = clipped.after[some as usize];
        faces.push(clipped.triangle_at(k));
        clipped.clip(k);
        left -= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn in_plane(corners: &[[f64; 2]]) -> PolygonMesh {
        let points = corners.iter().map(|p| Point::new(p[0], p[1], 2.0)).collect();
        let mut mesh = PolygonMesh::new(points);
        mesh.push(&(0..corners.len() as u32).collect::<Vec<_>>());
        mesh
    }

    fn area_of(corners: &[[f64; 2]]) -> f64 {
        let n = corners.len();
        (0..n).map(|k| turn([0.0, 0.0], corners[k], corners[(k + 1) % n]) / 2.0).sum()
    }

    /// The triangles cover the polygon once: none is turned over, and the areas add up.
    fn assert_covered(corners: &[[f64; 2]]) {
        for start in 0..corners.len() {
            let turned: Vec<_> = corners[start..].iter().chain(&corners[..start]).copied().collect();
            let mesh = in_plane(&turned).triangulated();
            assert_eq!(mesh.faces.len(), corners.len() - 2);
            assert_eq!(mesh.parents, vec![0; corners.len() - 2]);
            let areas: Vec<f64> = (0..mesh.faces.len()).map(|k| mesh.area_vector(k).z / 2.0).collect();
            assert!(areas.iter().all(|a| *a >= 0.0), "{turned:?}: {areas:?}");
            let expected = area_of(corners);
            assert!((areas.iter().sum::<f64>() - expected).abs() < 1e-12 * expected.abs().max(1.0));
        }
    }

    #[test]
    fn triangles_and_squares_are_cut_where_their_numbers_say() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(in_plane(&square).triangulated().faces, [[0, 1, 2], [0, 2, 3]]);
        let mut turned = in_plane(&square);
        turned = PolygonMesh::new(turned.points);
        turned.push(&[1, 2, 3, 0]);
        turned.push(&[2, 1, 0]);
        let mesh = turned.triangulated();
        assert_eq!(mesh.faces, [[0, 1, 2], [0, 2, 3], [2, 1, 0]]);
        assert_eq!(mesh.parents, [0, 0, 1]);
    }

    #[test]
    fn quads_are_cut_by_the_diagonal_with_the_better_angles() {
        let rhombus = in_plane(&[[-3.0, 0.0], [0.0, -1.0], [3.0, 0.0], [0.0, 1.0]]);
        assert_eq!(rhombus.triangulated().faces, [[1, 2, 3], [1, 3, 0]]);
    }

    #[test]
    fn concave_quads_are_cut_at_their_dent() {
        let dart = [[0.0, 0.0], [4.0, -3.0], [1.0, 0.0], [4.0, 3.0]];
        assert_covered(&dart);
        assert_eq!(in_plane(&dart).triangulated().faces, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn concave_polygons_are_covered_once() {
        let l = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        assert_covered(&l);
        let mut reversed = l;
        reversed.reverse();
        let mesh = in_plane(&reversed).triangulated();
        assert!((0..4).all(|k| mesh.area_vector(k).z < 0.0));
        // Corners in a row, on both sides of a slot.
        let slot = [
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [3.0, 0.0],
            [3.0, 3.0],
            [2.0, 3.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [0.0, 3.0],
        ];
        assert_covered(&slot);
        let comb: Vec<[f64; 2]> = (0..40)
            .map(|k| [f64::from(k / 2), if (k + 1) / 2 % 2 == 0 { 1.0 } else { 9.0 }])
            .chain([[20.0, 0.0], [-1.0, 0.0]])
            .rev()
            .collect();
        assert_covered(&comb);
    }

    #[test]
    fn spirals_in_any_plane_are_covered_once() {
        let at = |t: f64, r: f64| [r * t.cos(), r * t.sin()];
        let outer = (0..120).map(|k| f64::from(k) * 0.1).map(|t| at(t, 2.0 + t));
        let inner = (0..120).rev().map(|k| f64::from(k) * 0.1).map(|t| at(t, 1.0 + t));
        let spiral: Vec<_> = outer.chain(inner).collect();
        assert_covered(&spiral);
        let normal = Vector::new(1.0, -2.0, -3.0).normalize();
        let u = normal.cross(&Vector::x()).normalize();
        let v = normal.cross(&u);
        let points: Vec<Point> = spiral.iter().map(|p| Point::from(u * p[0] + v * p[1])).collect();
        let mut mesh = PolygonMesh::new(points);
        mesh.push(&(0..spiral.len() as u32).collect::<Vec<_>>());
        let mesh = mesh.triangulated();
        let areas: Vec<f64> = (0..mesh.faces.len()).map(|k| mesh.area_vector(k).dot(&normal) / 2.0).collect();
        assert!(areas.iter().all(|a| *a > -1e-12));
        assert!((areas.iter().sum::<f64>() - area_of(&spiral)).abs() < 1e-9);
    }

    #[test]
    fn degenerate_polygons_give_as_many_triangles_as_others() {
        let shapes: [&[[f64; 2]]; 5] = [
            &[[1.0, 1.0]; 7],
            &[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [4.0, 0.0]],
            &[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0], [0.5, 2.0]],
            &[[0.0, 0.0], [2.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]],
            &[[f64::NAN, 0.0], [2.0, 0.0], [f64::INFINITY, 0.0], [2.0, 2.0], [0.0, 2.0]],
        ];
        for shape in shapes {
            let mesh = in_plane(shape).triangulated();
            assert_eq!(mesh.faces.len(), shape.len() - 2);
            assert!(mesh.faces.iter().flatten().all(|v| (*v as usize) < shape.len()));
        }
    }

    #[test]
    fn polygons_without_end_are_cut_in_no_time() {
        // A zigzag of 200 000 corners, half of them concave.
        let n = 100_000;
        let zigzag: Vec<[f64; 2]> = (0..n)
            .map(|k| [f64::from(k), f64::from(k % 2)])
            .chain((0..n).rev().map(|k| [f64::from(k), 5.0 + f64::from(k % 2)]))
            .collect();
        let mesh = in_plane(&zigzag).triangulated();
        let areas: Vec<f64> = (0..mesh.faces.len()).map(|k| mesh.area_vector(k).z / 2.0).collect();
        assert!(areas.iter().all(|a| *a >= 0.0));
        assert!((areas.iter().sum::<f64>() / area_of(&zigzag) - 1.0).abs() < 1e-9);
    }
}
