//! G-code programs: written, read back, linted.

mod comment;
mod dialect;
mod grid;
mod motion;
mod round_arc;
mod writer;

pub use dialect::{Dialect, GRBL, LINUXCNC};
pub use motion::{Motion, MotionKind, Point3, Program};
pub use writer::{Arcs, LINES_FOR_ARC_TOLERANCE, Units, WriteError, WriteOptions, write};
