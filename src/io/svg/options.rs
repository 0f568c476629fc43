//! How a drawing is to be read.

use std::path::PathBuf;

/// How far a chord may stray from its curve, in parts of the larger side (width or height) of the largest filled shape.
///
/// Ten times finer than anything that a machine or an eye resolves on a part of that size; the number of samples grows
/// with the root.
pub const DEFAULT_FLATTEN: f64 = 2e-6;

/// What becomes of curves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Curves {
    /// Circles and circular arcs stay arcs; all other curves become chords between samples.
    #[default]
    Arcs,
    /// Everything becomes chords, and what is smooth stays smooth: for maps that make ellipses of circles.
    Chords,
    /// Everything becomes chords, and every sample a corner: for comparison with tools that know polygons only.
    Polygon,
}

/// What strokes mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Strokes {
    /// Nothing: filled areas are the drawing.
    #[default]
    Ignore,
    /// The area that a stroke covers belongs to the drawing.
    Areas,
    /// Lines for a tool to follow: beside what is filled, no part of it.
    Lines,
}

/// What to read, and how finely.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadOptions {
    /// How far chords may stray from curves, in parts of the larger side of the largest filled shape.
    pub flatten: f64,
    /// Whether true arcs are kept.
    pub curves: Curves,
    /// Whether strokes count.
    pub strokes: Strokes,
    /// User units in an inch: gives a size to a drawing that says none, and overrules one that does.
    pub dpi: Option<f64>,
    /// The width, in millimetres, that the filled part of the drawing (not the page) is to have; overrules `dpi`.
    pub width_mm: Option<f64>,
    /// Font files to set text in, before those of the system.
    pub fonts: Vec<PathBuf>,
}

impl Default for ReadOptions {
    fn default() -> ReadOptions {
        ReadOptions {
            flatten: DEFAULT_FLATTEN,
            curves: Curves::Arcs,
            strokes: Strokes::Ignore,
            dpi: None,
            width_mm: None,
            fonts: Vec::new(),
        }
    }
}
