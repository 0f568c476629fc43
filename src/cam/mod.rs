//! From outlines to toolpaths, and from programs back to what they cut.

mod certificate;
mod gouge;
mod path_radius;
mod removal;
mod solid;
mod stroke;
pub mod time;

pub use certificate::{Certificate, CertifyOptions, ProgramStatistics, certify, statistics};
pub use gouge::{Gouge, deepest_cut};
pub use path_radius::{PathPlace, PathRadius, path_radius};
pub use removal::{LEAST_UNCUT_DEPTH, Uncut, UncutPlace, uncut};
pub use solid::Remainder;
