//! A result against its reference, and what a result has lost of the part.
//!
//! [`compare`] measures; it believes neither side, and reports the reference's own error bound beside its numbers.
//! [`surface`] does so for surfaces in space, by the definition of the closing alone.
//! [`differences`] says how much results differ from each other. [`lost_features`] names what a closing fills or an opening removes beyond rounding corners.

mod compare;
mod differ;
mod farthest;
mod features;
mod half_spaces;
mod inside;
mod moved;
mod report;
mod surface;
mod surface_contact;
mod surface_report;
mod surface_samples;
mod surface_shape;
mod surface_whole;

pub use compare::compare;
pub use differ::{Difference, Named, differences};
pub use features::{
    CORNER_DEPTH, CORNER_FULLNESS, LostFeature, SHALLOWEST_FILLING, SLOT_DEPTH, SLOT_FULLNESS, lost_features,
};
pub(crate) use report::finite_or_word;
pub use report::{Area, Containment, Distance, Kept, Report, SmallestRadius, Topology};

pub use surface::{MOVED, surface};
pub use surface_report::{
    ContactError, CurvatureBound, SelfIntersections, SurfaceCheckError, SurfaceContainment, SurfaceKept, SurfacePlace,
    SurfaceReport, SurfaceTopologies, SurfaceTopology, SurfaceWhole, TriangleQuality,
};

/// A place for reports: x and y in the units of the drawing.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Place {
    /// Horizontal coordinate in the units of the drawing.
    pub x: f64,
    /// Vertical coordinate in the units of the drawing, upward.
    pub y: f64,
}

impl From<crate::plane::Point> for Place {
    fn from(p: crate::plane::Point) -> Place {
        Place { x: p.x, y: p.y }
    }
}
