//! Drawings in and out.

pub mod svg;
mod unite;
