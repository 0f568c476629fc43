//! G-code programs: written, read back, linted.

mod motion;

pub use motion::{Motion, MotionKind, Point3, Program};
