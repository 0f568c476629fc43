//! Drawings and surfaces in and out; letters and fonts; grey pictures in.

#[cfg(feature = "text")]
pub mod font;
pub mod mesh;
pub mod picture;
pub mod svg;
mod unite;
