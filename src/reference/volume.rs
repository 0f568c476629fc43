//! Closing on a grid, as a method for comparison: dilate, then erode, by the level sets of exact distances.
//!
//! 1. The surface at distance r outside the input, on the cells of a grid that it passes through ([`contour`](super::contour)); its
//!    creases, which carry the fillets of the closing, are kept sharp.
//! 2. The surface at distance r inside of that one.
//!
//! The input must be closed and must not cross itself: the side that a point is on is that of the nearest face.
//!
//! Nothing is kept of the input: every vertex is new, as with all methods on grids. What is thinner than a cell between two
//! sheets may be lost or joined; elsewhere the error falls with the square of the cell.

use super::contour::{Sample, contour};
use super::solid::Solid;
use crate::mesh::{Point, TriangleMesh};

/// The most cells that the surface may pass through: each takes about 300 bytes at the worst moment.
pub const MOST_CELLS: usize = 6_000_000;

/// The most cells along one side of the grid.
pub const LONGEST_SIDE: u32 = 1 << 20;

/// Why there is no closing on a grid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum VolumeError {
    /// A coordinate is infinite or not a number.
    #[error("vertex {vertex} has a coordinate that is not finite: repair the mesh first")]
    NotFinite {
        /// Index of the vertex.
        vertex: usize,
    },
    /// A corner of a face does not exist.
    #[error("face {face} has a corner that does not exist: repair the mesh first")]
    Face {
        /// Index of the face.
        face: usize,
    },
    /// A length that is none.
    #[error("radius {radius} and voxel {voxel} must both be positive and finite")]
    Length {
        /// The radius.
        radius: f64,
        /// The side of a cell.
        voxel: f64,
    },
    /// The grid would not fit into memory.
    #[error(
        "a grid of voxel {voxel} has more than {MOST_CELLS} cells at the surface, or more than {LONGEST_SIDE} along a side: \
         use a voxel of {suggestion:.3e} or larger"
    )]
    TooFine {
        /// The side of a cell.
        voxel: f64,
        /// One that is likely to do.
        suggestion: f64,
    },
}

/// The closing of the solid within `mesh` by a ball of `radius`, on cells of side `voxel`. For an opening, reverse the mesh
/// before and the result after.
///
/// # Errors
/// See [`VolumeError`]. A mesh without faces has an empty closing.
pub fn volumetric_close(mesh: &TriangleMesh, radius: f64, voxel: f64) -> Result<TriangleMesh, VolumeError> {
    let is_length = |x: f64| x.is_finite() && x > 0.0;
    if !is_length(radius) || !is_length(voxel) {
        return Err(VolumeError::Length { radius, voxel });
    }
    if let Some(vertex) = mesh.points.iter().position(|p| !p.coords.iter().all(|x| x.is_finite())) {
        return Err(VolumeError::NotFinite { vertex });
    }
    let exists = |f: &[u32; 3]| f.iter().all(|&v| (v as usize) < mesh.points.len());
    if let Some(face) = mesh.faces.iter().position(|f| !exists(f)) {
        return Err(VolumeError::Face { face });
    }
    let Some([low, high]) = mesh.bounds().filter(|_| !mesh.faces.is_empty()) else {
        return Ok(TriangleMesh::default());
    };
    let solid = Solid::new(mesh);
    let margin = radius + 3.0 * voxel;
    let grow = crate::mesh::Vector::repeat(margin);
    let bounds = [low - grow, high + grow];
    let outward = |p: Point| {
        let Some(s) = solid.signed(p, f64::INFINITY) else {
            return Sample { value: f64::INFINITY, gradient: crate::mesh::Vector::zeros() };
        };
        let gradient = (p - s.nearest) * s.distance.signum();
        Sample {
            value: s.distance - radius,
            gradient: gradient.try_normalize(0.0).unwrap_or(solid.face_normal(s.face)),
        }
    };
    let offset = contour(&outward, bounds, voxel)?;
    // The offset is asked for distances only: which side a point is on, the input itself tells better.
    let sheet = Solid::new(&offset);
    let inward = |p: Point| {
        let Some(near) = sheet.hierarchy().nearest(p, f64::INFINITY) else {
            return Sample { value: f64::NEG_INFINITY, gradient: crate::mesh::Vector::zeros() };
        };
        let is_dilated = solid.hierarchy().is_nearer(p, radius) || solid.distance(p) < 0.0;
        let away = (p - near.point).try_normalize(0.0).unwrap_or(sheet.face_normal(near.face));
        let sign = if is_dilated { -1.0 } else { 1.0 };
        Sample { value: sign * near.distance + radius, gradient: away * sign }
    };
    contour(&inward, bounds, voxel)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::HalfEdgeMesh;
    use crate::reference::surface_shapes::{both, extruded, overlapping_spheres, sphere};

    /// V - E + F of a closed surface, which it is checked to be.
    fn euler(mesh: &TriangleMesh) -> i64 {
        let half_edges = HalfEdgeMesh::new(mesh.points.clone(), &mesh.faces).expect("a manifold");
        assert!((0..3 * mesh.faces.len() as u32).all(|h| half_edges.twin(h).is_some()), "a closed surface");
        mesh.points.len() as i64 - mesh.faces.len() as i64 / 2
    }

    /// Vertices and centroids.
    fn samples(mesh: &TriangleMesh) -> impl Iterator<Item = Point> + '_ {
        let center = |k| Point::from(mesh.triangle(k).iter().map(|p| p.coords).sum::<crate::mesh::Vector>() / 3.0);
        mesh.points.iter().copied().chain((0..mesh.faces.len()).map(center))
    }

    #[test]
    fn the_fillet_of_an_extruded_l_is_met_and_its_error_falls_with_the_square_of_the_voxel() {
        let l = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        let input = extruded(&l, 1.5, 0.5);
        let r = 0.4;
        let worst = |voxel: f64| {
            let closed = volumetric_close(&input, r, voxel).unwrap();
            assert_eq!(euler(&closed), 2);
            // In the notch, away from the end faces, the fillet is about the axis at (1 + r, 1 + r).
            let axis = 1.0 + r;
            let in_notch = |p: &Point| p.x > 1.01 && p.y > 1.01 && p.x < axis && p.y < axis && p.z > 0.5 && p.z < 1.0;
            let errors: Vec<f64> =
                samples(&closed).filter(in_notch).map(|p| ((p.x - axis).hypot(p.y - axis) - r).abs()).collect();
            assert!(errors.len() > 100);
            errors.into_iter().fold(0.0, f64::max)
        };
        let (coarse, fine) = (worst(0.08), worst(0.04));
        assert!(coarse < 0.25 * 0.08 * 0.08 / r, "{coarse}");
        assert!(fine < 0.4 * coarse, "{coarse} {fine}");
    }

    #[test]
    fn two_spheres_that_overlap_get_the_neck_of_a_torus() {
        let a = 0.8;
        let spheres = overlapping_spheres(a, 48);
        let (r, voxel) = (0.3, 0.05);
        let closed = volumetric_close(&spheres, r, voxel).unwrap();
        assert_eq!(euler(&closed), 2);
        // The centres of the balls that touch both spheres run on a circle of this radius in the plane between them.
        let ring = ((1.0 + r) * (1.0 + r) - a * a).sqrt();
        let reach = r * a / (1.0 + r);
        let on_neck = |p: &Point| p.x.abs() < 0.9 * reach;
        let error = |p: Point| ((ring - p.y.hypot(p.z)).hypot(p.x) - r).abs();
        let errors: Vec<f64> = samples(&closed).filter(on_neck).map(error).collect();
        assert!(errors.len() > 500);
        // Of the spheres' own facets: sagittas of edges of about 0.131.
        let facets = 2.0 * 0.131 * 0.131 / 8.0;
        let worst = errors.into_iter().fold(0.0, f64::max);
        assert!(worst < facets + 0.25 * voxel * voxel / r, "{worst}");
    }

    #[test]
    fn a_gap_narrower_than_the_ball_closes_and_a_cavity_too_small_for_it_fills() {
        let apart = both(&sphere(Point::new(-1.1, 0.0, 0.0), 1.0, 10), &sphere(Point::new(1.1, 0.0, 0.0), 1.0, 10));
        assert_eq!(euler(&volumetric_close(&apart, 0.05, 0.05).unwrap()), 4);
        assert_eq!(euler(&volumetric_close(&apart, 0.5, 0.1).unwrap()), 2);
        let shell = both(&sphere(Point::origin(), 1.0, 10), &sphere(Point::origin(), 0.4, 10).reversed());
        assert_eq!(euler(&volumetric_close(&shell, 0.3, 0.08).unwrap()), 4);
        assert_eq!(euler(&volumetric_close(&shell, 0.5, 0.08).unwrap()), 2);
    }

    #[test]
    fn what_cannot_be_done_is_said() {
        let ball = sphere(Point::origin(), 1.0, 4);
        assert!(matches!(volumetric_close(&ball, 0.1, 1e-9), Err(VolumeError::TooFine { .. })));
        assert!(matches!(volumetric_close(&ball, 0.1, 1e-4), Err(VolumeError::TooFine { .. })));
        assert!(matches!(volumetric_close(&ball, -0.1, 0.1), Err(VolumeError::Length { .. })));
        assert!(matches!(volumetric_close(&ball, 0.1, f64::NAN), Err(VolumeError::Length { .. })));
        let mut broken = ball.clone();
        broken.faces[7][1] = 999;
        assert_eq!(volumetric_close(&broken, 0.1, 0.1), Err(VolumeError::Face { face: 7 }));
        let mut broken = ball;
        broken.points[5].z = f64::INFINITY;
        assert_eq!(volumetric_close(&broken, 0.1, 0.1), Err(VolumeError::NotFinite { vertex: 5 }));
        assert_eq!(volumetric_close(&TriangleMesh::default(), 0.1, 0.1), Ok(TriangleMesh::default()));
    }
}
