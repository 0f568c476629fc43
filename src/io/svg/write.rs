//! Regions back to SVG.

use super::drawing::Drawing;
use crate::plane::Region;

/// Writes.
pub fn write(_drawing: &Drawing, _region: &Region) -> String {
    String::new()
}
