//! Which walls are cut again at full depth, and which need all passes: the roughing does not come everywhere.

use super::Work;
use crate::cam::contour::Contour;
use crate::plane::{BoundaryIndex, Region};

/// How much more than the allowance, in tool radii, a cut at full depth may take: in corners sharper than about 25 degrees
/// the roughing keeps farther away than that.
const LIGHT: f64 = 0.5;

/// Places of a contour are looked at in such steps, in tool radii.
const STEP: f64 = 0.25;

/// The contours of the walls.
pub(super) struct Walls {
    /// Beside the roughing all along: the allowance is all that is left of them.
    pub roughed: Vec<Contour>,
    /// Where the roughing had no room, at some place at least: the tool would stand in the full material.
    pub full: Vec<Contour>,
}

impl Walls {
    /// Sorts the contours of the walls by the roughing's path.
    pub(super) fn new(work: &Work, contours: Vec<Contour>, rough: &Region) -> Walls {
        let radius = work.tool.radius();
        let index = BoundaryIndex::new(rough);
        let reach = work.cutting.allowance + LIGHT * radius;
        let near = |p| index.nearest(p).is_some_and(|(_, nearest)| nearest.distance <= reach);
        let beside = |contour: &Contour| {
            contour.path.segments().all(|s| {
                let count = (s.length() / (STEP * radius)).ceil().max(1.0) as usize;
                (0..count).all(|k| near(s.point_at(k as f64 / count as f64)))
            })
        };
        let (roughed, full) = contours.into_iter().partition(beside);
        Walls { roughed, full }
    }

    /// z of the passes along roughed walls: one, as deep as the flutes are long.
    pub(super) fn heights(work: &Work, floor: f64) -> Vec<f64> {
        let depth = work.top - floor;
        let count = (depth / work.tool.flute_length).ceil().max(1.0) as usize;
        (1..=count).map(|k| work.top - depth * (k as f64 / count as f64)).collect()
    }
}
