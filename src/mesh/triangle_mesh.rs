//! Surfaces of triangles.

use super::{Point, Vector};

/// A surface of triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// The vertices.
    pub points: Vec<Point>,
    /// Three corners each, counterclockwise seen from outside.
    pub faces: Vec<[u32; 3]>,
    /// The polygon that each triangle is a part of, where it was made from polygons; as many as faces, or none.
    pub parents: Vec<u32>,
}

impl TriangleMesh {
    /// The surface of these triangles.
    pub fn new(points: Vec<Point>, faces: Vec<[u32; 3]>) -> TriangleMesh {
        TriangleMesh { points, faces, parents: Vec::new() }
    }

    /// The corners of face `k`.
    pub fn triangle(&self, k: usize) -> [Point; 3] {
        self.faces[k].map(|v| self.points[v as usize])
    }

    /// Twice the area of face `k`, as a vector that points outward.
    pub fn area_vector(&self, k: usize) -> Vector {
        let [a, b, c] = self.triangle(k);
        (b - a).cross(&(c - a))
    }

    /// The volume inside, negative where the surface is inside out.
    pub fn volume(&self) -> f64 {
        // Away from the origin rounding would grow: from the first corner.
        let Some(origin) = self.faces.first().map(|face| self.points[face[0] as usize]) else { return 0.0 };
        let triangles = (0..self.faces.len()).map(|k| self.triangle(k).map(|p| p - origin));
        triangles.map(|[a, b, c]| a.dot(&b.cross(&c))).sum::<f64>() / 6.0
    }

    /// The area of all faces.
    pub fn area(&self) -> f64 {
        (0..self.faces.len()).map(|k| 0.5 * self.area_vector(k).norm()).sum()
    }

    /// The corners of the smallest box around the faces; nothing where there are none. Vertices without faces do not count.
    pub fn bounds(&self) -> Option<[Point; 2]> {
        let mut corners = self.faces.as_flattened().iter().map(|&v| self.points[v as usize]);
        let first = corners.next()?;
        Some(corners.fold([first, first], |[low, high], p| [low.inf(&p), high.sup(&p)]))
    }

    /// The length of the diagonal of the box around the faces.
    pub fn diagonal(&self) -> f64 {
        self.bounds().map_or(0.0, |[low, high]| (high - low).norm())
    }

    /// The mean length of the edges of all faces; 0 where there are none.
    pub fn mean_edge(&self) -> f64 {
        let edges = (0..self.faces.len()).flat_map(|k| {
            let [a, b, c] = self.triangle(k);
            [(b - a).norm(), (c - b).norm(), (a - c).norm()]
        });
        edges.sum::<f64>() / (3 * self.faces.len()).max(1) as f64
    }

    /// The same surface inside out: what was empty is solid.
    pub fn reversed(&self) -> TriangleMesh {
        TriangleMesh { faces: self.faces.iter().map(|&[a, b, c]| [a, c, b]).collect(), ..self.clone() }
    }

    /// Unit normals of the vertices, weighted by the angles of the faces there: they tell inside from outside (Bærentzen and
    /// Aanæs, 2005). Zero where a vertex has no face.
    pub fn vertex_normals(&self) -> Vec<Vector> {
        let mut normals = vec![Vector::zeros(); self.points.len()];
        for (k, face) in self.faces.iter().enumerate() {
            let corners = self.triangle(k);
            let Some(normal) = self.area_vector(k).try_normalize(0.0) else { continue };
            for i in 0..3 {
                let (u, w) = (corners[(i + 1) % 3] - corners[i], corners[(i + 2) % 3] - corners[i]);
                normals[face[i] as usize] += normal * u.cross(&w).norm().atan2(u.dot(&w));
            }
        }
        for normal in &mut normals {
            *normal = normal.try_normalize(0.0).unwrap_or_default();
        }
        normals
    }
}
