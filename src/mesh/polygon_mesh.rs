//! Surfaces of polygons, as files hold them.

use super::fans::part_fans;
use super::{NONE, Point};

/// What polygons with so many corners repeat is looked at corner by corner elsewhere.
const SIMPLE: usize = 6;

/// A surface of polygons: triangles, quads and larger faces, in the order of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolygonMesh {
    /// The vertices.
    pub points: Vec<Point>,
    /// The corners of all polygons, one polygon after the other, as numbers of vertices.
    corners: Vec<u32>,
    /// Where each polygon ends in `corners`.
    ends: Vec<u32>,
    /// A colour for each vertex, red green blue; or none at all.
    pub colours: Vec<[u8; 3]>,
    /// A number for each vertex, of whatever meaning; or none at all.
    pub scalars: Vec<f64>,
}

impl PolygonMesh {
    /// A surface without faces.
    pub fn new(points: Vec<Point>) -> PolygonMesh {
        PolygonMesh { points, ..PolygonMesh::default() }
    }

    /// The surface of triangles.
    pub fn of_triangles(points: Vec<Point>, faces: &[[u32; 3]]) -> PolygonMesh {
        let mut mesh = PolygonMesh::new(points);
        mesh.corners = faces.as_flattened().to_vec();
        mesh.ends = (1..=faces.len() as u32).map(|k| 3 * k).collect();
        mesh
    }

    /// Adds a polygon by the numbers of its corners, counterclockwise seen from outside.
    pub fn push(&mut self, polygon: &[u32]) {
        self.corners.extend_from_slice(polygon);
        self.ends.push(self.corners.len() as u32);
    }

    /// The first polygon that comes back to its corners so often that it is none, and how many vertices they are: corners that
    /// follow themselves aside, what goes around a part of the plane with n vertices has fewer than 2 n corners: a tree
    /// has the most, of which both sides are walked along.
    pub fn first_tangled(&self) -> Option<(usize, usize)> {
        self.polygons().enumerate().filter(|(_, polygon)| polygon.len() > SIMPLE).find_map(|(k, polygon)| {
            let mut corners = polygon.to_vec();
            corners.dedup();
            let count = corners.len();
            corners.sort_unstable();
            corners.dedup();
            (count > SIMPLE && count > 2 * corners.len()).then_some((k, corners.len()))
        })
    }

    /// How many polygons there are.
    pub fn polygon_count(&self) -> usize {
        self.ends.len()
    }

    /// The polygons for which `is_wanted` holds, in their order, with their vertices, in theirs; where they touch in a corner only,
    /// each part has a vertex of its own. With them the vertex of this mesh that each vertex is.
    pub fn part(&self, is_wanted: impl Fn(&[u32]) -> bool) -> (PolygonMesh, Vec<u32>) {
        let mut number = vec![NONE; self.points.len()];
        let wanted: Vec<&[u32]> = self.polygons().filter(|p| is_wanted(p)).collect();
        wanted.iter().flat_map(|p| p.iter()).for_each(|&v| number[v as usize] = 0);
        let mut sources: Vec<u32> = vec![];
        for (v, number) in (0u32..).zip(&mut number).filter(|(_, number)| **number == 0) {
            *number = sources.len() as u32;
            sources.push(v);
        }
        let mut corners: Vec<Vec<u32>> =
            wanted.iter().map(|p| p.iter().map(|&v| number[v as usize]).collect()).collect();
        let copies = part_fans(&mut corners, sources.len() as u32, |_| true);
        let all: Vec<u32> = sources.iter().copied().chain(copies.iter().map(|&v| sources[v as usize])).collect();
        let mut part = PolygonMesh::new(all.iter().map(|&v| self.points[v as usize]).collect());
        part.colours = all.iter().filter_map(|&v| self.colours.get(v as usize).copied()).collect();
        part.scalars = all.iter().filter_map(|&v| self.scalars.get(v as usize).copied()).collect();
        corners.iter().for_each(|polygon| part.push(polygon));
        (part, all)
    }

    /// The corners of polygon `k`.
    pub fn polygon(&self, k: usize) -> &[u32] {
        let start = if k == 0 { 0 } else { self.ends[k - 1] };
        &self.corners[start as usize..self.ends[k] as usize]
    }

    /// All polygons, in order.
    pub fn polygons(&self) -> impl ExactSizeIterator<Item = &[u32]> {
        (0..self.polygon_count()).map(|k| self.polygon(k))
    }
}
