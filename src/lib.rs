//! Morphological closing and opening of outlines without dilating and eroding.

pub mod check;
pub mod cli;
pub mod gcode;
pub mod plane;
pub mod reference;
pub mod units;
