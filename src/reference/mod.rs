//! Closing and opening by offsetting there and back: slow, and independent of the rolling disk.
//!
//! Two roads lead to a [`Reference`]: true arcs by `cavalier_contours` ([`arcs`]) and the union of swept pieces by
//! `i_overlay`, whose polygons are then read back as lines and arcs ([`overlay`]). Neither is believed: both results pass
//! through one certificate by distances ([`Reference::error_bound`]), and a result that fails it is refused.
//! Where even certified references disagree with a result, [`witness`] decides point by point from the definition of the
//! closing alone.
//!
//! Surfaces in space are closed on a grid of exact distances ([`volumetric_close`]).
//!
//! All of this is the *morphological* closing: components that come together merge, holes fill, narrow inlets close.

pub mod arcs;
mod certificate;
mod contour;
mod curve;
mod frame;
pub mod overlay;
mod solid;
#[cfg(test)]
pub(crate) mod surface_shapes;
mod volume;
pub mod witness;

pub use solid::{Signed, Solid};
pub use volume::{LONGEST_SIDE, MOST_CELLS, VolumeError, volumetric_close};

use crate::plane::Region;
use crate::units::Radius;

use frame::Frame;

/// What is done to the outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Operation {
    /// Dilate, then erode: rounds concave corners, fills what the disk cannot enter from outside.
    Close,
    /// Erode, then dilate: rounds convex corners, removes what the disk cannot enter from inside.
    Open,
}

/// Who computed a reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// True arcs, `cavalier_contours`.
    Arcs,
    /// Swept pieces, `i_overlay`.
    Overlay,
}

/// A closing or opening whose error was measured.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The closing or opening, with true arcs.
    pub region: Region,
    /// The largest distance between this boundary and the true one, as found by the certificate: in the units of the
    /// drawing. It is measured in both directions on samples [`SAMPLE_STEP`] radii apart, denser where parts of
    /// the boundary begin and end, and includes the rounding of the coordinates. Where two curves of the offset cross at a
    /// small angle α, their crossing may be displaced by the bound over α.
    pub error_bound: f64,
    /// The radius that the bound holds for: the one asked for, or where that has no certified answer the one that is smaller
    /// by [`NUDGE`]. A gap of exactly 2 r is such a case: by definition the disk fits into it, and by rounding
    /// anything may happen.
    pub radius: f64,
    /// Who computed it.
    pub method: Method,
}

/// Distance of the certificate's samples, in radii; every element has at least its ends and middle sampled.
pub const SAMPLE_STEP: f64 = 1.0 / 16.0;

/// A certified error at which the search for a better reference ends, in radii: rounding alone stays below it.
pub const EXCELLENT: f64 = 1e-9;

/// How much smaller than asked for the radius is taken, over the radius, where gaps of exactly 2 r leave no certified
/// answer: above the rounding of all coordinates, below the accuracy that anyone asks for.
pub const NUDGE: f64 = 1e-8;

/// The largest certified error of a reference, in radii. Failures are either below 1e-6 or as large as a feature.
pub const ACCEPTABLE: f64 = 1e-5;

/// The largest extent of a drawing in radii: beyond it the coordinates leave too few digits of a radius.
pub const LARGEST_EXTENT: f64 = 1e7;

/// Why there is no reference.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ReferenceError {
    /// A coordinate is infinite or not a number.
    #[error(
        "the outline has a coordinate that is not finite at ring {ring}, vertex {vertex}: repair the outline first"
    )]
    NotFinite {
        /// Index of the ring.
        ring: usize,
        /// Index of the vertex in the ring.
        vertex: usize,
    },
    /// The drawing is far larger than the disk.
    #[error(
        "the outline is {extent:.3e} radii wide, more than {LARGEST_EXTENT:.0e}: the reference would have no digits left; \
         use a larger radius or a part of the outline"
    )]
    TooLarge {
        /// Diagonal of the bounding box in radii.
        extent: f64,
    },
    /// No method gave a result that its certificate accepts.
    #[error(
        "no offset reference passes its own check by distances (best error found: {best:.1e} radii); rings that cross or \
         touch are the usual cause: unite the outline first, or change the radius a little"
    )]
    NotCertified {
        /// The smallest error that the certificate found, in radii.
        best: f64,
    },
}

/// The closing or opening of `region` by a disk of `radius`, by offsetting: the most accurate certified answer.
///
/// # Errors
/// See [`ReferenceError`]. An empty region has an empty reference.
pub fn closing(region: &Region, radius: Radius, operation: Operation) -> Result<Reference, ReferenceError> {
    let by_arcs = arcs::closing(region, radius, operation);
    match by_arcs {
        Ok(reference) if reference.radius == radius.get() && reference.error_bound <= EXCELLENT * radius.get() => {
            return Ok(reference);
        }
        Err(error @ (ReferenceError::NotFinite { .. } | ReferenceError::TooLarge { .. })) => return Err(error),
        _ => {}
    }
    match (by_arcs, overlay::closing(region, radius, operation)) {
        (Ok(a), Ok(b)) => {
            // Right for the radius asked for comes before right to more digits.
            let rank = |x: &Reference| (x.radius != radius.get(), x.error_bound);
            Ok(if rank(&b) < rank(&a) { b } else { a })
        }
        (Ok(a), Err(_)) => Ok(a),
        (Err(_), b) => b,
    }
}

/// The two offsets of an operation, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    /// The solid grows.
    Outward,
    /// The solid shrinks.
    Inward,
}

impl Operation {
    fn sides(self) -> [Side; 2] {
        match self {
            Operation::Close => [Side::Outward, Side::Inward],
            Operation::Open => [Side::Inward, Side::Outward],
        }
    }
}

/// Runs `offset_twice` with each of `settings` in the coordinates of the [`Frame`] until a result is certified as
/// excellent, and returns the best.
fn best_certified<S: Copy>(
    region: &Region,
    radius: Radius,
    operation: Operation,
    method: Method,
    settings: &[S],
    mut offset_twice: impl FnMut(&Region, S) -> Option<[Region; 2]>,
) -> Result<Reference, ReferenceError> {
    validate(region, radius)?;
    if region.is_empty() {
        return Ok(Reference { region: Region::default(), error_bound: 0.0, radius: radius.get(), method });
    }
    let mut smallest = f64::INFINITY;
    for r in [radius.get(), radius.get() * (1.0 - NUDGE)] {
        let frame = Frame::new(region.bounds(), r);
        let unit = frame.to_unit(region);
        match best_in_unit(&unit, operation, settings, &mut offset_twice) {
            Some((error, unit_result)) if error <= ACCEPTABLE => {
                let region = frame.to_drawing(&unit_result);
                let rounding = 4.0 * f64::EPSILON * largest_coordinate(&region);
                return Ok(Reference { region, error_bound: error * r + rounding, radius: r, method });
            }
            other => smallest = other.map_or(smallest, |(error, _)| smallest.min(error)),
        }
    }
    Err(ReferenceError::NotCertified { best: smallest })
}

/// The result with the smallest certified error in radii, where the radius is 1.
fn best_in_unit<S: Copy>(
    unit: &Region,
    operation: Operation,
    settings: &[S],
    offset_twice: &mut impl FnMut(&Region, S) -> Option<[Region; 2]>,
) -> Option<(f64, Region)> {
    let [first_side, second_side] = operation.sides();
    let mut best: Option<(f64, Region)> = None;
    for &setting in settings {
        let Some([first, second]) = offset_twice(unit, setting) else { continue };
        // The second offset moves no boundary by more than the first was wrong: errors add.
        let error = certificate::offset_error(unit, &first, first_side)
            + certificate::offset_error(&first, &second, second_side);
        if best.as_ref().is_none_or(|(e, _)| error < *e) {
            best = Some((error, second));
        }
        if error <= EXCELLENT {
            break;
        }
    }
    best
}

fn largest_coordinate(region: &Region) -> f64 {
    let b = region.bounds();
    [b.min.x, b.min.y, b.max.x, b.max.y].into_iter().filter(|x| x.is_finite()).fold(0.0, |m, x| x.abs().max(m))
}

fn validate(region: &Region, radius: Radius) -> Result<(), ReferenceError> {
    for (ring_index, ring) in region.rings.iter().enumerate() {
        for (vertex_index, v) in ring.vertices.iter().enumerate() {
            let arc_is_finite = match v.link {
                crate::plane::Link::Line => true,
                crate::plane::Link::Arc(arc) => {
                    arc.radius.is_finite() && arc.center.x.is_finite() && arc.center.y.is_finite()
                }
            };
            if !(v.point.x.is_finite() && v.point.y.is_finite() && arc_is_finite) {
                return Err(ReferenceError::NotFinite { ring: ring_index, vertex: vertex_index });
            }
        }
    }
    let extent = region.bounds().diagonal() / radius.get();
    if extent > LARGEST_EXTENT { Err(ReferenceError::TooLarge { extent }) } else { Ok(()) }
}
