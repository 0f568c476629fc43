//! Morphological closing and opening of outlines without dilating and eroding.

pub mod cam;
pub mod gcode;
pub mod io;
pub mod plane;
pub mod preview;
pub mod rolling;
pub mod units;
