//! The colours of the pictures, on white.

use super::canvas::Rgba;

pub(super) const WHITE: Rgba = [255, 255, 255, 255];
/// Words, scale bar.
pub(super) const INK: Rgba = [52, 58, 64, 255];
/// The line above the legend.
pub(super) const RULE: Rgba = [222, 226, 230, 255];
/// What must remain.
pub(super) const PART: Rgba = [250, 236, 209, 255];
/// What the tool takes away.
pub(super) const SWATH: Rgba = [233, 238, 243, 255];
/// A boundary that stays.
pub(super) const KEPT: Rgba = [73, 80, 87, 255];
/// A boundary that moved.
pub(super) const MOVED: Rgba = [214, 51, 108, 255];
/// The solid of one state among many.
pub(super) const SOLID: Rgba = [73, 80, 87, 255];
/// A boundary that was there before.
pub(super) const BEFORE: Rgba = [134, 142, 150, 255];
/// Material that stays where it should not.
pub(super) const UNCUT: Rgba = [255, 169, 77, 255];
pub(super) const UNCUT_LINE: Rgba = [217, 72, 15, 255];
/// Rapids.
pub(super) const RAPID: Rgba = [134, 142, 150, 255];
/// Where the tool goes down.
pub(super) const START: Rgba = [47, 158, 68, 255];
/// Where x and y are zero.
pub(super) const ORIGIN: Rgba = [112, 72, 232, 255];
/// What an operation adds to an outline, and what it takes from it.
pub(super) const ADDED: Rgba = [252, 194, 215, 255];
pub(super) const REMOVED: Rgba = [165, 216, 255, 255];

/// Where stock is cut through.
pub(super) const THROUGH: Rgba = [241, 243, 245, 255];
/// Where something went wrong.
pub(super) const WRONG: Rgba = [224, 49, 49, 255];

/// From the first pass to the last: light to dark, and readable to the colour-blind.
const DEPTHS: [Rgba; 4] = [[116, 192, 252, 255], [51, 154, 240, 255], [24, 100, 171, 255], [11, 39, 94, 255]];

/// The colour of the fraction `t` of the full depth.
pub(super) fn depth(t: f64) -> Rgba {
    let x = t.clamp(0.0, 1.0) * (DEPTHS.len() - 1) as f64;
    let k = (x as usize).min(DEPTHS.len() - 2);
    let f = x - k as f64;
    std::array::from_fn(|i| {
        let (a, b) = (f64::from(DEPTHS[k][i]), f64::from(DEPTHS[k + 1][i]));
        (a + (b - a) * f).round() as u8
    })
}
