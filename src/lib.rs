//! Morphological closing and opening of outlines without dilating and eroding.

pub mod cam;
pub mod check;
pub mod cli;
pub mod gcode;
pub mod io;
pub mod plane;
pub mod preview;
pub mod reference;
pub mod rolling;
pub mod units;
