//! What a surface encloses: distances with a sign.

use crate::mesh::{Feature, Hierarchy, Nearest, Point, TriangleMesh, Vector};
use std::collections::HashMap;

/// A surface to ask for signed distances: negative inside.
///
/// The sign is that of the normal at the nearest point, where edges and vertices have the normals of Bærentzen and Aanæs
/// (2005): exact for closed surfaces that do not cross themselves.
pub struct Solid {
    hierarchy: Hierarchy,
    faces: Vec<[u32; 3]>,
    face_normals: Vec<Vector>,
    vertex_normals: Vec<Vector>,
    /// The sum of the unit normals of the faces at an edge, by its vertices, the lower first.
    edge_normals: HashMap<[u32; 2], Vector>,
}

/// Where a point is with respect to a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Signed {
    /// Distance from the surface, negative inside.
    pub distance: f64,
    /// The nearest point of the surface.
    pub nearest: Point,
    /// The face that it is on.
    pub face: u32,
}

impl Solid {
    /// The solid within a surface.
    pub fn new(mesh: &TriangleMesh) -> Solid {
        let unit = |k: usize| mesh.area_vector(k).try_normalize(0.0).unwrap_or_default();
        let face_normals: Vec<Vector> = (0..mesh.faces.len()).map(unit).collect();
        let mut edge_normals = HashMap::with_capacity(3 * mesh.faces.len() / 2);
        for (face, normal) in mesh.faces.iter().zip(&face_normals) {
            for k in 0..3 {
                *edge_normals.entry(edge(face, k)).or_insert_with(Vector::zeros) += *normal;
            }
        }
        Solid {
            hierarchy: Hierarchy::new(&mesh.points, &mesh.faces),
            faces: mesh.faces.clone(),
            face_normals,
            vertex_normals: mesh.vertex_normals(),
            edge_normals,
        }
    }

    /// The triangles.
    pub fn hierarchy(&self) -> &Hierarchy {
        &self.hierarchy
    }

    /// The unit normal of a face.
    pub fn face_normal(&self, face: u32) -> Vector {
        self.face_normals[face as usize]
    }

    /// The signed distance of `p`, if the surface is nearer than `within`.
    pub fn signed(&self, p: Point, within: f64) -> Option<Signed> {
        let nearest = self.hierarchy.nearest(p, within)?;
        let is_inside = (p - nearest.point).dot(&self.normal(&nearest)) < 0.0;
        let distance = if is_inside { -nearest.distance } else { nearest.distance };
        Some(Signed { distance, nearest: nearest.point, face: nearest.face })
    }

    /// The signed distance of `p`, however far; infinite where there is no surface.
    pub fn distance(&self, p: Point) -> f64 {
        self.signed(p, f64::INFINITY).map_or(f64::INFINITY, |s| s.distance)
    }

    /// The normal that tells inside from outside at a point of the surface: not of unit length.
    fn normal(&self, at: &Nearest) -> Vector {
        let face = &self.faces[at.face as usize];
        match at.feature {
            Feature::Face => self.face_normals[at.face as usize],
            Feature::Edge(k) => self.edge_normals.get(&edge(face, k as usize)).copied().unwrap_or_default(),
            Feature::Corner(k) => self.vertex_normals[face[k as usize] as usize],
        }
    }
}

/// The edge from corner `k` of a face to the next, the lower vertex first.
fn edge(face: &[u32; 3], k: usize) -> [u32; 2] {
    let (a, b) = (face[k], face[(k + 1) % 3]);
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::surface_shapes::extruded;

    #[test]
    fn points_are_inside_or_outside_of_corners_and_notches() {
        // An L: a square of 2 without the square of 1 at its upper right.
        let l = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        let solid = Solid::new(&extruded(&l, 1.0, 0.3));
        let at = |x: f64, y: f64, z: f64| solid.distance(Point::new(x, y, z));
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        near(at(0.9, 0.9, 0.5), -(0.02f64.sqrt()));
        near(at(1.2, 1.1, 0.5), 0.1);
        near(at(2.3, -0.4, 0.5), 0.5);
        near(at(1.0, -0.4, -0.3), 0.5);
        near(at(2.2, -0.3, -0.6), 0.7);
        near(at(0.5, 0.5, 0.1), -0.1);
        assert_eq!(Solid::new(&TriangleMesh::default()).distance(Point::origin()), f64::INFINITY);
    }
}
