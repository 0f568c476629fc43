//! Lengths that make sense on a mesh: its own size, radii and edges.

use std::path::Path;

use anyhow::{Result, bail};

use super::digits::number;

/// Edges are no longer than this, in diagonals of the mesh, unless they are asked for: with a ball much larger than the mesh, whose
/// closing is nearly the convex hull, parts of the radius would be.
const LONGEST_EDGE: f64 = 1.0 / 40.0;

/// Radii from the smallest to the largest of these, in diagonals of the mesh, make sense. Beyond the largest the closing is the
/// convex hull but for a thousandth of the diagonal.
const RADII: [f64; 2] = [1e-5, 100.0];

/// Beyond these, in units of the mesh, products of lengths leave the range of numbers.
const DIAGONALS: [f64; 2] = [1e-50, 1e50];

/// Edges shorter than this, in diagonals, would make more triangles than a machine can hold.
pub(super) const SHORTEST_EDGE: f64 = 1e-5;

/// Edges shorter than this part of the largest coordinate are lost in its rounding.
const STEPS: f64 = 1e-12;

/// Refuses meshes of a size that lengths on it cannot be reckoned with.
pub(super) fn keep_size(path: &Path, diagonal: f64) -> Result<()> {
    if (DIAGONALS[0]..=DIAGONALS[1]).contains(&diagonal) {
        return Ok(());
    }
    bail!(
        "{}: the diagonal of its box is {diagonal:e}: give it other units, so that it is from {:e} to {:e}",
        path.display(),
        DIAGONALS[0],
        DIAGONALS[1]
    )
}

/// Refuses radii that make no sense on a mesh of this diagonal.
pub(super) fn keep_radius(path: &Path, radius: f64, diagonal: f64) -> Result<()> {
    if (RADII[0] * diagonal..=RADII[1] * diagonal).contains(&radius) {
        return Ok(());
    }
    bail!(
        "{}: a radius of {} on a mesh whose box has a diagonal of {}: give one from {:.3e} to {:.3e}, for example 2%",
        path.display(),
        number(radius),
        number(diagonal),
        RADII[0] * diagonal,
        RADII[1] * diagonal
    )
}

/// Refuses `--edge-length` where it is longer than the radius, or makes more triangles than can be held.
pub(super) fn keep_edge(edge: f64, radius: f64, diagonal: f64) -> Result<()> {
    let shortest = SHORTEST_EDGE * diagonal;
    if (shortest..=radius).contains(&edge) {
        return Ok(());
    }
    bail!(
        "--edge-length {}: an edge length must be at most the radius ({}) and at least {shortest:.3e}",
        number(edge),
        number(radius)
    )
}

/// The longest edges on a mesh of this diagonal, unless they are asked for.
pub(super) fn longest_edge(diagonal: f64) -> f64 {
    LONGEST_EDGE * diagonal
}

/// Refuses edges that the rounding of coordinates as large as `far` leaves nothing of.
pub(super) fn keep_near(path: &Path, far: f64, edge: f64) -> Result<()> {
    if edge >= STEPS * far {
        return Ok(());
    }
    bail!(
        "{}: coordinates as large as {far:.3e} are rounded too coarsely for an edge length of {}; move the mesh nearer to the origin",
        path.display(),
        number(edge)
    )
}
