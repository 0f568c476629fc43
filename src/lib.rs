//! Morphological closing and opening of outlines without dilating and eroding.

pub mod cam;
pub mod gcode;
pub mod plane;
pub mod preview;
pub mod units;
