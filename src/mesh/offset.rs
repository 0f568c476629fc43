//! A surface moved along its normals, and what lies between both.

use std::collections::HashMap;

use super::{Point, PolygonMesh, Vector};

/// At sharp corners vertices move farther than faces, but no more than so many times as far: an edge of 60 degrees does.
pub const FARTHEST: f64 = 2.0;

/// Faces whose normals spread less than this (over the sum of their angles, along an axis) count as one smooth surface, which
/// moves along its normal: about 12 degrees.
const SMOOTH: f64 = 0.01;

/// Why a surface cannot be moved.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum OffsetError {
    /// The distance is no number.
    #[error("a distance of {0}: it must be a finite number other than zero, positive is outward")]
    Distance(f64),
    /// Faces at a vertex have no area.
    #[error("vertex {0} has no normal, as its faces have no area")]
    NoNormal(u32),
}

/// What an offset is to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Thickness {
    /// The moved surface alone.
    Surface,
    /// The solid between the surface and the moved one; borders get a wall.
    Shell,
}

/// The surface with every face moved by `distance` along its normal, outward where that is positive.
///
/// A vertex goes to where the planes of its faces meet after the move, as well as there is such a place, and no farther than
/// [`FARTHEST`] times the distance; on smooth surfaces that is along the normal. Polygons stay polygons in their order. A shell has
/// the vertices of the surface first, bit for bit, then the moved ones; its polygons are those of both in the same order,
/// then the walls. Where the surface is more curved than the distance allows, the result passes through itself.
///
/// # Errors
/// Where the distance is no number or zero, or a vertex has no normal.
///
/// # Panics
/// If a polygon has a corner that is no vertex.
pub fn offset(mesh: &PolygonMesh, distance: f64, thickness: Thickness) -> Result<PolygonMesh, OffsetError> {
    let moved = moved(mesh, distance)?;
    Ok(result(mesh.clone(), moved, distance, thickness))
}

/// As [`offset`], of the polygons alone for which `is_wanted` holds. They move as they would with all the others, so that parts
/// with a corner in common keep it in common.
///
/// # Errors
/// As [`offset`].
///
/// # Panics
/// As [`offset`].
pub fn offset_part(
    mesh: &PolygonMesh,
    distance: f64,
    thickness: Thickness,
    is_wanted: impl Fn(&[u32]) -> bool,
) -> Result<PolygonMesh, OffsetError> {
    let moved = moved(mesh, distance)?;
    let (part, sources) = mesh.part(is_wanted);
    Ok(result(part, sources.iter().map(|&v| moved[v as usize]).collect(), distance, thickness))
}

/// The moved surface, or what is between.
fn result(mut mesh: PolygonMesh, moved: Vec<Point>, distance: f64, thickness: Thickness) -> PolygonMesh {
    if thickness == Thickness::Surface {
        mesh.points = moved;
        return mesh;
    }
    let count = mesh.points.len() as u32;
    let mut shell = PolygonMesh::new([mesh.points.as_slice(), &moved].concat());
    // The solid is between both: the inner one is turned over.
    let is_outward = distance > 0.0;
    for is_moved in [false, true] {
        for polygon in mesh.polygons() {
            let mut corners: Vec<u32> = polygon.iter().map(|v| v + if is_moved { count } else { 0 }).collect();
            if is_moved != is_outward {
                corners[1..].reverse();
            }
            shell.push(&corners);
        }
    }
    for [a, b] in borders(&mesh) {
        let (a, b) = if is_outward { (a, b) } else { (b, a) };
        shell.push(&[a, b, b + count, a + count]);
    }
    shell.colours = [mesh.colours.as_slice(), &mesh.colours].concat();
    shell.scalars = [mesh.scalars.as_slice(), &mesh.scalars].concat();
    shell
}

/// The sides of polygons that have no neighbour there, in the order of the polygons.
fn borders(mesh: &PolygonMesh) -> Vec<[u32; 2]> {
    let sides = || mesh.polygons().flat_map(|p| (0..p.len()).map(move |k| [p[k], p[(k + 1) % p.len()]]));
    let mut count: HashMap<[u32; 2], u32> = HashMap::new();
    sides().for_each(|[a, b]| *count.entry([a.min(b), a.max(b)]).or_default() += 1);
    sides().filter(|&[a, b]| count[&[a.min(b), a.max(b)]] == 1).collect()
}

/// Where the vertices go.
fn moved(polygons: &PolygonMesh, distance: f64) -> Result<Vec<Point>, OffsetError> {
    if !distance.is_finite() || distance == 0.0 {
        return Err(OffsetError::Distance(distance));
    }
    let mesh = polygons.triangulated();
    let normals = mesh.vertex_normals();
    // Of each vertex, over its faces and weighted by their angles: the sum of n nᵀ, of n, and of the weights.
    let mut spread = vec![nalgebra::Matrix3::<f64>::zeros(); mesh.points.len()];
    let mut sum = vec![Vector::zeros(); mesh.points.len()];
    let mut weights = vec![0.0; mesh.points.len()];
    let mut is_used = vec![false; mesh.points.len()];
    for (k, face) in mesh.faces.iter().enumerate() {
        let corners = mesh.triangle(k);
        face.iter().for_each(|&v| is_used[v as usize] = true);
        let Some(normal) = mesh.area_vector(k).try_normalize(0.0) else { continue };
        for i in 0..3 {
            let (u, w) = (corners[(i + 1) % 3] - corners[i], corners[(i + 2) % 3] - corners[i]);
            let weight = u.cross(&w).norm().atan2(u.dot(&w));
            let v = face[i] as usize;
            spread[v] += normal * normal.transpose() * weight;
            sum[v] += normal * weight;
            weights[v] += weight;
        }
    }
    let mut points = polygons.points.clone();
    for (v, point) in points.iter_mut().enumerate().filter(|(v, _)| is_used[*v]) {
        if normals[v] == Vector::zeros() {
            return Err(OffsetError::NoNormal(v as u32));
        }
        // The least squares of n · move = 1 over the faces, beginning with the normal and correcting it only in directions in
        // which the faces differ.
        let start = normals[v];
        let rest = sum[v] - spread[v] * start;
        let eigen = spread[v].symmetric_eigen();
        let mut towards = start;
        for k in 0..3 {
            let (value, axis) = (eigen.eigenvalues[k], Vector::from(eigen.eigenvectors.column(k)));
            if value > SMOOTH * weights[v] {
                towards += axis * (axis.dot(&rest) / value);
            }
        }
        let length = towards.norm();
        if length > FARTHEST {
            towards *= FARTHEST / length;
        }
        *point += towards * distance;
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::problems;

    fn cube() -> PolygonMesh {
        let points = (0..8).map(|k| Point::from([k & 1, k >> 1 & 1, k >> 2].map(f64::from)));
        let mut mesh = PolygonMesh::new(points.collect());
        for quad in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            mesh.push(&quad);
        }
        mesh
    }

    fn volume(mesh: &PolygonMesh) -> f64 {
        mesh.triangulated().volume()
    }

    #[test]
    fn faces_of_a_cube_move_by_the_distance() {
        for d in [0.25, -0.25, 3.0] {
            let moved = offset(&cube(), d, Thickness::Surface).unwrap();
            assert!((volume(&moved) - (1.0f64 + 2.0 * d).powi(3)).abs() < 1e-9, "{d}");
            assert!(moved.polygons().eq(cube().polygons()));
        }
    }

    #[test]
    fn round_surfaces_move_along_their_normals() {
        // A cylinder of many sides, open at both ends.
        let (n, r) = (200u32, 2.0);
        let ring = |z: f64| {
            (0..n).map(move |k| {
                let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(n)).sin_cos();
                Point::new(r * cos, r * sin, z)
            })
        };
        let mut mesh = PolygonMesh::new(ring(0.0).chain(ring(1.0)).collect());
        (0..n).for_each(|k| mesh.push(&[k, (k + 1) % n, (k + 1) % n + n, k + n]));
        let out = offset(&mesh, 0.5, Thickness::Surface).unwrap();
        assert!(out.points.iter().all(|p| (p.x.hypot(p.y) - 2.5).abs() < 1e-3));
        assert!(out.points.iter().zip(&mesh.points).all(|(p, q)| (p.z - q.z).abs() < 1e-9));
        // As a shell it is a tube, closed by walls.
        for d in [0.5, -0.5] {
            let tube = offset(&mesh, d, Thickness::Shell).unwrap();
            assert_eq!(problems(&tube), []);
            let expected = std::f64::consts::PI * ((2.0f64 + d).powi(2) - 4.0).abs();
            assert!((volume(&tube) / expected - 1.0).abs() < 1e-3, "{} {expected}", volume(&tube));
            assert_eq!(tube.points[..mesh.points.len()], mesh.points);
        }
    }

    #[test]
    fn the_shell_of_a_closed_surface_is_hollow() {
        for (d, expected) in [(0.5, 7.0), (-0.25, 0.875)] {
            let shell = offset(&cube(), d, Thickness::Shell).unwrap();
            assert_eq!(problems(&shell), []);
            assert!((volume(&shell) - expected).abs() < 1e-9);
        }
    }

    #[test]
    fn needles_do_not_grow_without_end() {
        let mut mesh = PolygonMesh::new(
            [[0.0, 0.0, 9.0], [0.1, 0.0, 0.0], [-0.05, 0.1, 0.0], [-0.05, -0.1, 0.0]].map(Point::from).to_vec(),
        );
        for face in [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]] {
            mesh.push(&face);
        }
        let moved = offset(&mesh, 0.1, Thickness::Surface).unwrap();
        let farthest = moved.points.iter().zip(&mesh.points).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
        assert!(farthest <= 0.1 * FARTHEST + 1e-12 && farthest > 0.1);
    }

    #[test]
    fn what_cannot_be_moved_is_said() {
        assert_eq!(offset(&cube(), 0.0, Thickness::Shell).err(), Some(OffsetError::Distance(0.0)));
        let mut flat = PolygonMesh::new([[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]].map(Point::from).to_vec());
        flat.push(&[0, 1, 2]);
        assert_eq!(offset(&flat, 1.0, Thickness::Surface).err(), Some(OffsetError::NoNormal(0)));
    }
}
