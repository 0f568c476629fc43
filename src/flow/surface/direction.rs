//! The direction in which a face bends least.
//!
//! It is that of the tensor of the edges at its three corners: no fit that could be singular, exact where the surface is a
//! cylinder, and as sharp as the mesh, where the two-ring of a quadratic fit rounds fillets of few edges off.

use super::curvature::{Frame, Tensor};
use crate::mesh::{HalfEdgeMesh, Vector};

/// The dihedral angle at an edge, positive where it is convex; 0 at a boundary.
pub(super) fn dihedral(mesh: &HalfEdgeMesh, h: u32) -> f64 {
    let Some(t) = mesh.twin(h) else { return 0.0 };
    let (m, n) = (mesh.area_vector(mesh.face_of(t)), mesh.area_vector(mesh.face_of(h)));
    let e = mesh.points[mesh.target(h) as usize] - mesh.points[mesh.origin(h) as usize];
    let length = e.norm().max(f64::MIN_POSITIVE);
    -(m.cross(&n).dot(&e) / length).atan2(m.dot(&n))
}

/// The direction in the plane of face `f`, of unit normal `normal`, in which the surface bends least, or most.
pub(super) fn direction(mesh: &HalfEdgeMesh, f: u32, normal: Vector, most: bool) -> Vector {
    let frame = Frame::new(normal);
    let mut tensor = Tensor::default();
    for v in mesh.face(f) {
        for h in mesh.spokes(v) {
            let e = mesh.points[mesh.target(h) as usize] - mesh.points[v as usize];
            tensor.add(frame.project(e), dihedral(mesh, h));
        }
    }
    let [x, y] = tensor.direction(most);
    frame.u * x + frame.v * y
}
