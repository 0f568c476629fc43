//! The system of a step on a surface: L = Gᵀ Dᵀ A D G.
//!
//! G is the gradient on each face, D its component in the direction of minimum curvature there, A the areas. Without D it is
//! the Laplacian of mean curvature flow, with weights that are negative taken as none.

use super::direction::direction;
use crate::linalg::Entry;
use crate::mesh::{HalfEdgeMesh, Vector};

/// In which directions a face pulls its corners together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pull {
    /// That of minimum curvature.
    Least,
    /// That of maximum curvature.
    Most,
    /// All.
    Every,
}

/// Faces with less than this part of the area of the square of their longest edge have no gradient.
const NO_AREA: f64 = 1e-8;

/// The 3 x 3 stiffness of a face; `None` where it has no area.
pub(super) fn stiffness(mesh: &HalfEdgeMesh, f: u32, pull: Pull) -> Option<[[f64; 3]; 3]> {
    let [a, b, c] = mesh.triangle(f);
    // Opposite to each corner.
    let edges = [c - b, a - c, b - a];
    let doubled = mesh.area_vector(f);
    let doubled_area = doubled.norm();
    let longest2 = edges.iter().fold(0.0, |m: f64, e| m.max(e.norm_squared()));
    if doubled_area.is_nan() || doubled_area <= NO_AREA * longest2 {
        return None;
    }
    let mut matrix = [[0.0; 3]; 3];
    if pull == Pull::Every {
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let weight = (-0.5 * edges[j].dot(&edges[k]) / doubled_area).max(0.0);
            matrix[j][k] -= weight;
            matrix[k][j] -= weight;
            matrix[j][j] += weight;
            matrix[k][k] += weight;
        }
        return Some(matrix);
    }
    let normal = doubled / doubled_area;
    let along = direction(mesh, f, normal, pull == Pull::Most);
    let slope = edges.map(|e: Vector| normal.cross(&e).dot(&along) / doubled_area);
    for i in 0..3 {
        for j in 0..3 {
            matrix[i][j] = 0.5 * doubled_area * slope[i] * slope[j];
        }
    }
    Some(matrix)
}

/// Adds the stiffness of face `f` to the entries and the forces of the rows that its corners have.
pub(super) fn add(
    mesh: &HalfEdgeMesh,
    f: u32,
    pull: Pull,
    rows: [Option<usize>; 3],
    entries: &mut Vec<Entry>,
    force: &mut [[f64; 3]],
) {
    let Some(matrix) = stiffness(mesh, f, pull) else { return };
    let corners = mesh.triangle(f);
    for i in 0..3 {
        let Some(row) = rows[i] else { continue };
        // From the corner itself: far from the origin rounding would grow.
        let pulled: Vector = (0..3).map(|j| (corners[j] - corners[i]) * -matrix[i][j]).sum();
        for k in 0..3 {
            force[row][k] += pulled[k];
        }
        for j in 0..3 {
            if let Some(column) = rows[j].filter(|column| *column <= row) {
                entries.push(Entry { row, column, value: matrix[i][j] });
            }
        }
    }
}
