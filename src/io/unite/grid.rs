//! The integer grid that the overlay works on.

use i_overlay::i_float::int::point::IntPoint;

use crate::plane::{Bounds, Point, Vector};

/// Cells along the larger side of the drawing. Fine enough that the vertices of a drawing stay apart; coarse enough that
/// points which differ in the last digits of a transform fall together; and crossings are exact in 128 bits.
const CELLS: f64 = (1u64 << 44) as f64;

/// A point of the grid.
pub(super) type Cell = IntPoint<i64>;

/// The grid over a drawing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    origin: Point,
    per_unit: f64,
}

impl Grid {
    /// The grid over `bounds` of a drawing whose larger side is `extent`.
    pub fn new(bounds: Bounds, extent: f64) -> Grid {
        // A power of two: scaling loses nothing.
        let per_unit = (CELLS / extent).log2().floor().exp2();
        Grid { origin: bounds.center(), per_unit }
    }

    /// The width of a cell.
    pub fn cell(&self) -> f64 {
        1.0 / self.per_unit
    }

    pub fn cell_of(&self, p: Point) -> Cell {
        let v = (p - self.origin) * self.per_unit;
        IntPoint { x: v.x.round() as i64, y: v.y.round() as i64 }
    }

    pub fn point_of(&self, cell: Cell) -> Point {
        self.origin + Vector::new(cell.x as f64, cell.y as f64) / self.per_unit
    }
}
