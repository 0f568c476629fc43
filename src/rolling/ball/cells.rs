//! Where balls come to rest, by small cells, with what of the input is near each: the centres of the balls that fill a gap lie on a few
//! curves, so that most of them have others in the same cell.

use std::sync::Arc;

use super::memo::Memo;
use crate::mesh::{Hierarchy, Nearest, Neighbourhood, Point};

/// The side of a cell, in parts of the radius.
const SIDE: f64 = 0.1;

/// What is gathered reaches farther than the corners of a cell by this part, for rounding.
const ROUNDING: f64 = 1e-9;

/// So many cells are remembered.
const PLACES: usize = 1 << 13;

/// Where more triangles are near a cell, the hierarchy is asked: that keeps the memory small that is needed.
const MOST: usize = 512;

/// A cell: the bits of the radius, and its numbers along the axes.
type Name = (u64, [i64; 3]);

/// Cells with what is near them, as far as balls have been there.
#[derive(Clone, Debug)]
pub(super) struct Cells {
    known: Memo<Name, Arc<Neighbourhood>>,
}

impl Cells {
    /// Nothing is known yet.
    pub fn new() -> Cells {
        Cells { known: Memo::new(PLACES) }
    }

    /// What [`Hierarchy::nearest`] finds, faster where it was asked for something near with the same distance.
    pub fn nearest(&self, hierarchy: &Hierarchy, p: Point, within: f64) -> Option<Nearest> {
        let side = SIDE * within;
        let cell = [p.x, p.y, p.z].map(|x| (x / side).floor());
        let around = self.known.get_or((within.to_bits(), cell.map(|x| x as i64)), || {
            let center = Point::from(cell.map(|x| (x + 0.5) * side));
            let reach = within + 0.5 * 3f64.sqrt() * side;
            Arc::new(Neighbourhood::gather(hierarchy, center, reach * (1.0 + ROUNDING), MOST))
        });
        if around.covers(p, within) { around.nearest(hierarchy, p, within) } else { hierarchy.nearest(p, within) }
    }
}
