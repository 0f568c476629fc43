//! From outlines to toolpaths, and from programs back to what they cut.

pub mod time;
