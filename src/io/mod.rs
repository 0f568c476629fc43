//! Drawings in and out; grey pictures in.

pub mod picture;
pub mod svg;
mod unite;
