//! A surface cut by a plane, and closed there by a cap.
//!
//! Stages: each vertex is behind the plane, in front of it or on it; polygons without a vertex in front are kept as they are;
//! those with vertices on both sides are cut, triangle by triangle; what is then open in the plane is capped ([`cap`]); and
//! vertices in which only corners touch become several, so that a surface stays one.

mod cap;

use std::collections::HashMap;

use super::fans::part_fans;
use super::{NONE, Point, PolygonMesh, Vector};

/// A vertex nearer to the plane than this, over the diagonal of the box around the surface, lies on it: cut faces get no edges
/// that are shorter than rounding is long, and the cap passes through the vertex as it is.
const ON_PLANE: f64 = 1e-10;

/// A plane with a front and a back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutPlane {
    point: Point,
    normal: Vector,
}

/// Why a surface cannot be cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CutError {
    /// The plane has no normal.
    #[error("the normal of the plane has no length, or is no number: 0,0,1 is upward")]
    Normal,
    /// Nothing is behind the plane.
    #[error(
        "all of the surface is in front of the plane, which cuts it off: turn the normal the other way, or move the plane"
    )]
    NothingLeft,
    /// The surface passes through itself in the plane.
    #[error(
        "what the plane cuts open crosses itself and cannot be capped: look for self-intersections, or cut without a cap"
    )]
    Crossed,
}

/// What is left of a surface.
#[derive(Clone, Debug, Default)]
pub struct CutSurface {
    /// The polygons of the input that were not cut, in their order, then parts of cut ones, then caps. Vertices of the input
    /// that are left come first, in their order.
    pub mesh: PolygonMesh,
    /// The vertex of the input that each vertex is, bit for bit; [`NONE`] for new ones.
    pub origins: Vec<u32>,
    /// How many polygons are those of the input.
    pub kept: usize,
    /// How many triangles the caps have, which are the last.
    pub caps: usize,
    /// How many pieces of border in the plane could not be capped, as they end at borders of the input.
    pub open_ends: usize,
}

/// What becomes of the place where the surface is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cap {
    /// A face in the plane closes it.
    Closed,
    /// It stays open.
    Open,
}

impl CutPlane {
    /// The plane through a point, with its front where the normal points.
    ///
    /// # Errors
    /// Where the normal has no direction.
    pub fn new(point: Point, normal: Vector) -> Result<CutPlane, CutError> {
        let is_finite = point.iter().chain(normal.iter()).all(|x| x.is_finite());
        // By the largest part first: squares of very long and very short ones leave the range of numbers.
        let normal = (normal / normal.amax()).try_normalize(0.0).filter(|n| is_finite && n.norm() > 0.5);
        let normal = normal.ok_or(CutError::Normal)?;
        Ok(CutPlane { point, normal })
    }

    /// How far in front of the plane a place is.
    pub fn height(&self, p: Point) -> f64 {
        self.normal.dot(&(p - self.point))
    }
}

/// The part of a surface behind a plane.
///
/// Vertices, polygons and their order stay bit for bit where nothing is cut. A surface that is closed stays closed with
/// [`Cap::Closed`]; colours and numbers of new vertices are those between the ends of their edges.
///
/// # Errors
/// Where nothing is left, or the surface crosses itself in the plane.
///
/// # Panics
/// If a polygon has a corner that is no vertex.
pub fn cut(mesh: &PolygonMesh, plane: &CutPlane, cap: Cap) -> Result<CutSurface, CutError> {
    let mut work = Work::new(mesh, plane);
    let mut polygons = PolygonMesh::default();
    let is_kept: Vec<bool> = mesh.polygons().map(|p| work.is_behind(p)).collect();
    for (polygon, _) in mesh.polygons().zip(&is_kept).filter(|(_, kept)| **kept) {
        polygons.push(polygon);
    }
    let kept = polygons.polygon_count();
    // Only these are cut into triangles.
    let mut crossing = PolygonMesh::new(vec![]);
    for (polygon, _) in mesh.polygons().zip(&is_kept).filter(|(_, kept)| !**kept) {
        if polygon.iter().any(|&v| work.height[v as usize] < 0.0) {
            crossing.push(polygon);
        }
    }
    std::mem::swap(&mut crossing.points, &mut work.points);
    let triangles = crossing.triangulated();
    std::mem::swap(&mut crossing.points, &mut work.points);
    for face in triangles.faces {
        let part = work.behind(face);
        if part.len() > 2 {
            polygons.push(&part);
        }
    }
    if polygons.polygon_count() == 0 {
        return Err(CutError::NothingLeft);
    }
    let (mut caps, mut open_ends) = (0, 0);
    if cap == Cap::Closed {
        let rim = work.rim(mesh, &polygons);
        let capped = cap::cap(&work.points, &rim, plane.normal).ok_or(CutError::Crossed)?;
        capped.faces.iter().for_each(|face| polygons.push(face));
        (caps, open_ends) = (capped.faces.len(), capped.open_ends);
    }
    let (mesh, origins) = work.finish(mesh, &polygons);
    Ok(CutSurface { mesh, origins, kept, caps, open_ends })
}

/// A surface that is being cut.
struct Work {
    /// The vertices of the input, then new ones.
    points: Vec<Point>,
    /// How far in front of the plane each is; exactly 0 on it.
    height: Vec<f64>,
    /// The new vertices by the edges of the input that they are on, and where on them.
    new: HashMap<(u32, u32), u32>,
    places: Vec<(u32, u32, f64)>,
    normal: Vector,
    through: Point,
}

impl Work {
    fn new(mesh: &PolygonMesh, plane: &CutPlane) -> Work {
        let first = mesh.points.first().copied().unwrap_or(Point::origin());
        let [low, high] = mesh.points.iter().fold([first; 2], |[low, high], p| [low.inf(p), high.sup(p)]);
        let near = ON_PLANE * (high - low).norm();
        let snapped = |h: f64| if h.abs() <= near { 0.0 } else { h };
        Work {
            height: mesh.points.iter().map(|p| snapped(plane.height(*p))).collect(),
            points: mesh.points.clone(),
            new: HashMap::new(),
            places: vec![],
            normal: plane.normal,
            through: plane.point,
        }
    }

    /// Whether a polygon is left as it is. One in the plane is left where the solid is behind it.
    fn is_behind(&self, polygon: &[u32]) -> bool {
        let heights = || polygon.iter().map(|&v| self.height[v as usize]);
        if heights().any(|h| h != 0.0) {
            return heights().all(|h| h <= 0.0);
        }
        super::triangulate::newell(&self.points, polygon).dot(&self.normal) > 0.0
    }

    /// The part of a triangle that is behind the plane.
    fn behind(&mut self, face: [u32; 3]) -> Vec<u32> {
        let mut part = vec![];
        for k in 0..3 {
            let (a, b) = (face[k], face[(k + 1) % 3]);
            let (h, g) = (self.height[a as usize], self.height[b as usize]);
            if h <= 0.0 {
                part.push(a);
            }
            if h * g < 0.0 {
                part.push(self.on_edge(a, b));
            }
        }
        // What only touches the plane from the front.
        if part.iter().all(|&v| self.height[v as usize] == 0.0) {
            let is_left = face.iter().all(|&v| self.height[v as usize] == 0.0) && self.is_behind(&face);
            if !is_left {
                part.clear();
            }
        }
        part
    }

    /// Where an edge passes through the plane.
    fn on_edge(&mut self, a: u32, b: u32) -> u32 {
        let (a, b) = (a.min(b), a.max(b));
        if let Some(&v) = self.new.get(&(a, b)) {
            return v;
        }
        let (h, g) = (self.height[a as usize], self.height[b as usize]);
        let t = h / (h - g);
        let (p, q) = (self.points[a as usize], self.points[b as usize]);
        let mut place = p + (q - p) * t;
        // In the plane as well as rounding lets it be.
        place -= self.normal * self.normal.dot(&(place - self.through));
        let v = self.points.len() as u32;
        self.points.push(place);
        self.height.push(0.0);
        self.places.push((a, b, t));
        self.new.insert((a, b), v);
        v
    }

    /// The edges in the plane that a cap must have, in its direction: those that were no border and have become one.
    fn rim(&self, input: &PolygonMesh, polygons: &PolygonMesh) -> Vec<[u32; 2]> {
        let on_plane = |v: u32| self.height[v as usize] == 0.0;
        let balanced = |mesh: &PolygonMesh| {
            let mut balance: HashMap<[u32; 2], i32> = HashMap::new();
            for polygon in mesh.polygons() {
                for (k, &a) in polygon.iter().enumerate() {
                    let b = polygon[(k + 1) % polygon.len()];
                    if on_plane(a) && on_plane(b) {
                        *balance.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
                    }
                }
            }
            balance
        };
        let borders = balanced(input);
        let mut rim: Vec<[u32; 2]> = balanced(polygons)
            .into_iter()
            .filter(|(edge, _)| borders.get(edge).is_none_or(|n| *n == 0))
            .flat_map(|([a, b], n)| {
                let edge = if n > 0 { [b, a] } else { [a, b] };
                std::iter::repeat_n(edge, n.unsigned_abs() as usize)
            })
            .collect();
        rim.sort_unstable();
        rim
    }

    /// The vertices that are left, numbered anew, each with one fan of polygons.
    fn finish(&self, input: &PolygonMesh, polygons: &PolygonMesh) -> (PolygonMesh, Vec<u32>) {
        let count = input.points.len();
        let mut was_used = vec![false; count];
        input.polygons().flatten().for_each(|&v| was_used[v as usize] = true);
        let mut is_used = vec![false; self.points.len()];
        polygons.polygons().flatten().for_each(|&v| is_used[v as usize] = true);
        let mut sources: Vec<u32> = vec![];
        let mut number = vec![NONE; self.points.len()];
        for v in 0..self.points.len() {
            // What no polygon ever used stays as long as it is behind.
            if is_used[v] || (v < count && !was_used[v] && self.height[v] <= 0.0) {
                number[v] = sources.len() as u32;
                sources.push(v as u32);
            }
        }
        let mut corners: Vec<Vec<u32>> =
            polygons.polygons().map(|p| p.iter().map(|&v| number[v as usize]).collect()).collect();
        let on_plane = |v: u32| self.height[sources[v as usize] as usize] == 0.0;
        let copies = part_fans(&mut corners, sources.len() as u32, on_plane);
        let all: Vec<u32> = sources.iter().copied().chain(copies.iter().map(|&v| sources[v as usize])).collect();
        let mut mesh = PolygonMesh::new(all.iter().map(|&v| self.points[v as usize]).collect());
        corners.iter().for_each(|polygon| mesh.push(polygon));
        let (mut colours, mut scalars) = (input.colours.clone(), input.scalars.clone());
        for &(a, b, t) in &self.places {
            let (a, b) = (a as usize, b as usize);
            if !input.colours.is_empty() {
                let mix = |k: usize| f64::from(colours[a][k]) * (1.0 - t) + f64::from(colours[b][k]) * t;
                let colour = [0, 1, 2].map(|k| mix(k).round() as u8);
                colours.push(colour);
            }
            if !input.scalars.is_empty() {
                scalars.push(scalars[a] * (1.0 - t) + scalars[b] * t);
            }
        }
        mesh.colours = all.iter().filter_map(|&v| colours.get(v as usize).copied()).collect();
        mesh.scalars = all.iter().filter_map(|&v| scalars.get(v as usize).copied()).collect();
        let origin = |(k, &v): (usize, &u32)| if k < sources.len() && (v as usize) < count { v } else { NONE };
        let origins = all.iter().enumerate().map(origin).collect();
        (mesh, origins)
    }
}

#[cfg(test)]
mod tests;
