//! The curvature-bounded flow, of which closing and opening are the limits.
//!
//! Closing moves a boundary outward, along its normal and at the speed of its curvature, wherever the curvature is below
//! -1/r, and leaves the rest where it is (eq. 7 and 8 of the paper); opening is the mirror image, clopening is both. The
//! flow has what the direct road of [`crate::rolling`] has not: the states on the way, radii that vary, points that
//! stay, both bounds at once. The two share no code, and each is the other's witness.
//!
//! # How near it comes
//!
//! The worst distance of the limit to the exact closing and opening of eight shapes, in edge lengths h, against h and the time
//! step tau (as the paper's Fig. 14; `cargo run --release --example flow_table` prints every shape):
//!
//! | h | tau = .2 h² | .05 h² | .0125 h² |
//! |---|---|---|---|
//! | r/6.5 | .039 | .039 | .039 |
//! | r/13 | .022 | .021 | .021 |
//! | r/26 | .012 | .011 | .011 |
//!
//! So the error falls with h², and the time step does not matter for the limit: steps land on the bound ([`step`]).
//! Without that the error is in proportion to tau / h².
//!
//! # The parts
//!
//! [`Obstacle`] says which curvatures stay, [`step`] takes one semi-implicit step, [`Advance`] is the loop with its clock and
//! its reasons to stop: all three for curves and surfaces alike, which differ in their [`Front`]. [`CurveFlow`] is the flow
//! of outlines, [`SurfaceFlow`] that of surfaces.

mod advance;
mod curve;
mod obstacle;
mod step;
mod surface;

pub use advance::{Advance, DEFAULT_TOLERANCE, End, OnContact, Status};
pub use curve::{CurveFlow, CurveFront, DEFAULT_EDGE, DEFAULT_TIME_STEP, Field, FlowError, Report, Runs, Settings};
pub use obstacle::{Obstacle, Way};
pub use step::{Displaced, Factor, Front, SparseStiffness, Stiffness, System, step};
pub use surface::{
    Contact, DEFAULT_SURFACE_TIME_STEP, DEFAULT_SURFACE_TOLERANCE, FlownSurface, Kind, Landing, SurfaceField,
    SurfaceFlow, SurfaceFlowError, SurfaceFront, SurfaceReport, SurfaceSettings,
};
