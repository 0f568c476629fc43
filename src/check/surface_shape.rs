//! What a surface of triangles is like by itself: topology, crossings, angles, curvature.

use super::surface_report::SurfaceTopology;
use crate::mesh::{Point, TriangleMesh, Vector};

/// The sides of all edges, those of one edge together: the vertices of the edge, the lower first, and 3 face + corner.
pub(super) fn sides(mesh: &TriangleMesh) -> Vec<([u32; 2], u32)> {
    let of_face = |(f, face): (usize, &[u32; 3])| {
        let face = *face;
        (0..3).map(move |k| {
            let (a, b) = (face[k], face[(k + 1) % 3]);
            ([a.min(b), a.max(b)], (3 * f + k) as u32)
        })
    };
    let mut sides: Vec<_> = mesh.faces.iter().enumerate().flat_map(of_face).collect();
    sides.sort_unstable();
    sides
}

/// Sets of numbers that are united.
struct Sets(Vec<u32>);

impl Sets {
    fn new(count: usize) -> Sets {
        Sets((0..count as u32).collect())
    }

    fn find(&mut self, mut k: u32) -> u32 {
        while self.0[k as usize] != k {
            self.0[k as usize] = self.0[self.0[k as usize] as usize];
            k = self.0[k as usize];
        }
        k
    }

    fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b) as usize] = a.min(b);
    }

    /// How many sets the numbers of `which` are in.
    fn count(&mut self, which: impl Iterator<Item = u32>) -> usize {
        let mut roots: Vec<u32> = which.map(|k| self.find(k)).collect();
        roots.sort_unstable();
        roots.dedup();
        roots.len()
    }
}

/// Whether a face has the same corner twice: rounding may bring corners together, and what is left has no sides.
fn is_collapsed([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// The edges with a single face.
pub(super) fn border_edges(mesh: &TriangleMesh) -> Vec<[u32; 2]> {
    let mut sides = sides(mesh);
    sides.retain(|side| !is_collapsed(mesh.faces[side.1 as usize / 3]));
    sides.chunk_by(|a, b| a.0 == b.0).filter(|edge| edge.len() == 1).map(|edge| edge[0].0).collect()
}

/// Counts vertices, parts and boundaries.
pub(super) fn topology(mesh: &TriangleMesh) -> SurfaceTopology {
    let mut sides = sides(mesh);
    sides.retain(|side| !is_collapsed(mesh.faces[side.1 as usize / 3]));
    let faces = mesh.faces.iter().filter(|face| !is_collapsed(**face)).count();
    let mut parts = Sets::new(mesh.faces.len());
    let mut boundary = Sets::new(mesh.points.len());
    let mut on_boundary = Vec::new();
    let (mut edges, mut nonmanifold_edges) = (0, 0);
    for edge in sides.chunk_by(|a, b| a.0 == b.0) {
        edges += 1;
        let [u, v] = edge[0].0;
        for side in edge {
            parts.unite(edge[0].1 / 3, side.1 / 3);
        }
        let runs_up = |side: &([u32; 2], u32)| mesh.faces[side.1 as usize / 3][side.1 as usize % 3] == u;
        match edge {
            [_] => {
                boundary.unite(u, v);
                on_boundary.push(u);
            }
            [a, b] if runs_up(a) != runs_up(b) => {}
            _ => nonmanifold_edges += 1,
        }
    }
    let vertices = is_used(mesh).into_iter().filter(|used| *used).count();
    SurfaceTopology {
        vertices,
        faces: mesh.faces.len(),
        euler_characteristic: vertices as i64 - edges + faces as i64,
        components: parts.count((0u32..).zip(&mesh.faces).filter(|(_, face)| !is_collapsed(**face)).map(|(k, _)| k)),
        boundary_loops: boundary.count(on_boundary.into_iter()),
        nonmanifold_edges,
    }
}

/// Whether some face has each vertex.
pub(super) fn is_used(mesh: &TriangleMesh) -> Vec<bool> {
    let mut used = vec![false; mesh.points.len()];
    for &v in mesh.faces.as_flattened() {
        used[v as usize] = true;
    }
    used
}

/// How often the surface winds around `p` (van Oosterom and Strackee, 1983): 1 inside, 0 outside, whatever single faces are like.
pub(super) fn winding_number(mesh: &TriangleMesh, p: Point) -> f64 {
    let solid_angle = |k: usize| {
        let [a, b, c] = mesh.triangle(k).map(|v| v - p);
        let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
        let below = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
        a.dot(&b.cross(&c)).atan2(below)
    };
    (0..mesh.faces.len()).map(solid_angle).sum::<f64>() / std::f64::consts::TAU
}

/// The angles of a triangle in radians.
pub(super) fn angles([a, b, c]: [Point; 3]) -> [f64; 3] {
    let angle = |p: Point, q: Point, r: Point| {
        let (u, v): (Vector, Vector) = (q - p, r - p);
        u.cross(&v).norm().atan2(u.dot(&v))
    };
    [angle(a, b, c), angle(b, c, a), angle(c, a, b)]
}

/// The minimum curvature of all vertices by equations 17 and 18 of the paper: with the integrated mean curvature H (a quarter of
/// length times dihedral angle over the edges at the vertex: equation 18's half is twice that), the angle defect K and
/// the mass M, it is (H - √(H² - M K)) / M. Zero where there is no mass.
pub(super) fn minimum_curvatures(mesh: &TriangleMesh) -> Vec<f64> {
    let n = mesh.points.len();
    let (mut mean, mut defect, mut mass) = (vec![0.0; n], vec![std::f64::consts::TAU; n], vec![0.0; n]);
    for (k, face) in mesh.faces.iter().enumerate() {
        let third = mesh.area_vector(k).norm() / 6.0;
        for (v, angle) in face.iter().zip(angles(mesh.triangle(k))) {
            mass[*v as usize] += third;
            defect[*v as usize] -= angle;
        }
    }
    for edge in sides(mesh).chunk_by(|a, b| a.0 == b.0) {
        let [(ends, one), (_, other)] = edge else { continue };
        let [p, q] = ends.map(|v| mesh.points[v as usize]);
        let [u, v] = [one, other].map(|s| mesh.area_vector(*s as usize / 3));
        let far =
            mesh.points[mesh.faces[*other as usize / 3][(*other as usize + 2 - *other as usize / 3 * 3) % 3] as usize];
        let sign = if (far - p).dot(&u) > 0.0 { -1.0 } else { 1.0 };
        let part = 0.25 * (q - p).norm() * u.cross(&v).norm().atan2(u.dot(&v)) * sign;
        for v in ends {
            mean[*v as usize] += part;
        }
    }
    let least = |k: usize| {
        let (h, m) = (mean[k], mass[k]);
        if m > 0.0 { (h - (h * h - m * defect[k]).max(0.0).sqrt()) / m } else { 0.0 }
    };
    (0..n).map(least).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::surface_shapes::{both, sphere};

    #[test]
    fn surfaces_are_counted() {
        let ball = sphere(Point::origin(), 1.0, 3);
        for (p, expected) in [([0.1, 0.2, 0.3], 1.0), ([1.0, 0.2, 0.3], 0.0)] {
            assert!((winding_number(&ball, p.into()) - expected).abs() < 1e-12);
            assert!((winding_number(&ball.reversed(), p.into()) + expected).abs() < 1e-12);
        }
        let one = topology(&ball);
        assert_eq!((one.vertices, one.faces, one.euler_characteristic), (38, 72, 2));
        assert_eq!((one.components, one.boundary_loops, one.nonmanifold_edges), (1, 0, 0));
        let two = topology(&both(&ball, &sphere(Point::new(5.0, 0.0, 0.0), 1.0, 2)));
        assert_eq!((two.euler_characteristic, two.components), (4, 2));
        let mut open = ball.clone();
        open.faces.remove(0);
        let last = open.faces.len() - 1;
        open.faces.remove(last);
        let open = topology(&open);
        assert_eq!((open.euler_characteristic, open.components, open.boundary_loops), (0, 1, 2));
        let mut twisted = ball;
        twisted.faces[10].swap(0, 1);
        assert_eq!(topology(&twisted).nonmanifold_edges, 3);
    }

    #[test]
    fn spheres_have_the_curvature_of_spheres_and_dents_of_dents() {
        let ball = sphere(Point::origin(), 2.0, 20);
        let curvatures = minimum_curvatures(&ball);
        let mean = |k: &[f64]| k.iter().sum::<f64>() / k.len() as f64;
        assert!((mean(&curvatures) - 0.5).abs() < 0.03, "{}", mean(&curvatures));
        let inside_out = minimum_curvatures(&ball.reversed());
        assert!((mean(&inside_out) + 0.5).abs() < 0.03);
    }
}
