//! Drawings in and out; letters and fonts.

#[cfg(feature = "text")]
pub mod font;
pub mod svg;
mod unite;
