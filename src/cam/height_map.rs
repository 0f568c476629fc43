//! How high the material stands: one height for each cell of a grid over the stock.
//!
//! Guaranteed: a height is that of the material at the middle of its cell, up to what [`CHORD_TOLERANCE`] says of helices of
//! tools that are not flat. What lies between the middles of cells is not known: walls are told to half a cell.

use super::motion::Motion;
use super::stock::Stock;
use super::sweep::{Cutter, Hit};
use crate::plane::Point;

pub use super::sweep::CHORD_TOLERANCE;

/// Cells over the diameter of the smallest tool, unless told otherwise.
const CELLS_OVER_TOOL: f64 = 40.0;

/// Fewest cells over the diameter of the smallest tool: with fewer, volume and depth of what it cuts are those of the grid.
const LEAST_CELLS_OVER_TOOL: f64 = 4.0;

/// Most cells of a map, unless told otherwise: 32 megabytes, and as sharp as a picture can show.
const MOST_CELLS_BY_DEFAULT: f64 = 4e6;

/// Most cells of a map at all: 512 megabytes.
const MOST_CELLS: f64 = 6.4e7;

/// Why there is no height map.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MapError {
    /// The stock is no thing.
    #[error("the stock is {0} x {1} x {2} mm: all three must be above zero")]
    Stock(f64, f64, f64),
    /// The cells are too small or too large.
    #[error(
        "cells of {0} mm: the stock of {1:.1} x {2:.1} mm would have more than {MOST_CELLS} of them; choose another --cell, or \
         the part of the stock that matters (--stock 100x60x6mm --stock-at 0,0)"
    )]
    Cells(f64, f64, f64),
    /// The cells are too large.
    #[error("cells of {0} mm do not show what a tool of {1} mm does: --cell must be at most a quarter of it, {2} mm")]
    Coarse(f64, f64, f64),
}

/// Where the cells are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    pub(super) corner: Point,
    /// Width and height of a cell.
    pub(super) cell: [f64; 2],
    pub(super) columns: usize,
    pub(super) rows: usize,
}

impl Grid {
    pub(super) fn center(&self, column: usize, row: usize) -> Point {
        Point::new(
            self.corner.x + (column as f64 + 0.5) * self.cell[0],
            self.corner.y + (row as f64 + 0.5) * self.cell[1],
        )
    }

    /// The columns whose middles lie from `min` to `max`, as a range that may be empty.
    #[inline]
    pub(super) fn columns_between(&self, min: f64, max: f64) -> std::ops::Range<usize> {
        between(min - self.corner.x, max - self.corner.x, self.cell[0], self.columns)
    }

    /// The rows whose middles lie from `min` to `max`.
    #[inline]
    pub(super) fn rows_between(&self, min: f64, max: f64) -> std::ops::Range<usize> {
        between(min - self.corner.y, max - self.corner.y, self.cell[1], self.rows)
    }
}

#[inline]
fn between(min: f64, max: f64, cell: f64, count: usize) -> std::ops::Range<usize> {
    // Casts saturate; what is no number becomes 0.
    let first = (min / cell - 0.5).ceil().max(0.0) as usize;
    let end = (max / cell - 0.5).floor() + 1.0;
    first..(end.max(0.0) as usize).clamp(first.min(count), count).max(first)
}

/// The heights of what stands in the stock.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightMap {
    pub(super) grid: Grid,
    /// Row after row from the front, each from the left.
    pub(super) heights: Vec<f64>,
    stock: Stock,
}

impl HeightMap {
    /// Whole stock, in cells not much larger than `cell`, so that a whole number of them fits each side.
    ///
    /// # Errors
    /// Where the stock is no thing, or the cells are too many.
    pub fn new(stock: Stock, cell: f64) -> Result<HeightMap, MapError> {
        let size = stock.outline();
        let (width, height) = (size.width(), size.height());
        if !stock.is_possible() {
            return Err(MapError::Stock(width, height, stock.thickness()));
        }
        let counts = [width, height].map(|side| (side / cell).round().max(1.0));
        let total = counts[0] * counts[1];
        if !(cell > 0.0 && total <= MOST_CELLS) {
            return Err(MapError::Cells(cell, width, height));
        }
        let [columns, rows] = counts.map(|count| count as usize);
        let cell = [width / counts[0], height / counts[1]];
        let grid = Grid { corner: size.min, cell, columns, rows };
        Ok(HeightMap { grid, heights: vec![stock.top_mm; columns * rows], stock })
    }

    /// The size of cells that shows what tools of `smallest_diameter` do: a fortieth of it, or as many as are four million, but
    /// never more than a quarter of it.
    pub fn default_cell(stock: &Stock, smallest_diameter: f64) -> f64 {
        let size = stock.outline();
        let least = (size.width() * size.height() / MOST_CELLS_BY_DEFAULT).sqrt();
        least.max(smallest_diameter / CELLS_OVER_TOOL).min(HeightMap::coarsest_cell(smallest_diameter))
    }

    /// The largest cells that still show what tools of `smallest_diameter` do.
    pub fn coarsest_cell(smallest_diameter: f64) -> f64 {
        smallest_diameter / LEAST_CELLS_OVER_TOOL
    }

    /// What it was cut from.
    pub fn stock(&self) -> &Stock {
        &self.stock
    }

    /// How many cells stand side by side.
    pub fn columns(&self) -> usize {
        self.grid.columns
    }

    /// How many rows of cells there are.
    pub fn rows(&self) -> usize {
        self.grid.rows
    }

    /// Width and height of a cell in millimetres.
    pub fn cell(&self) -> [f64; 2] {
        self.grid.cell
    }

    /// The middle of a cell.
    pub fn center(&self, column: usize, row: usize) -> Point {
        self.grid.center(column, row)
    }

    /// The height of what stands at a cell, no lower than the lower face of the stock.
    pub fn height(&self, column: usize, row: usize) -> f64 {
        self.heights[row * self.grid.columns + column].max(self.stock.bottom_mm)
    }

    /// The height at the cell that holds `p`; `None` outside of the stock.
    pub fn height_at(&self, p: Point) -> Option<f64> {
        let place = |x: f64, corner: f64, cell: f64, count: usize| {
            let index = ((x - corner) / cell).floor();
            (index >= 0.0 && index < count as f64).then_some(index as usize)
        };
        let column = place(p.x, self.grid.corner.x, self.grid.cell[0], self.grid.columns)?;
        let row = place(p.y, self.grid.corner.y, self.grid.cell[1], self.grid.rows)?;
        Some(self.height(column, row))
    }

    /// What is gone of the stock, in cubic millimetres.
    pub fn removed(&self) -> f64 {
        let Stock { top_mm, bottom_mm, .. } = self.stock;
        let sum: f64 = self.heights.iter().map(|h| top_mm - h.max(bottom_mm)).sum();
        sum * self.grid.cell[0] * self.grid.cell[1]
    }

    /// Takes away what `cutter` sweeps along `motion`; what it was, in cubic millimetres. `hits` is room for work.
    pub(super) fn cut(&mut self, cutter: &Cutter, motion: &Motion, hits: &mut Vec<Hit>) -> f64 {
        let bottom = self.stock.bottom_mm;
        let mut removed = 0.0;
        for element in cutter.elements(motion) {
            hits.clear();
            cutter.gather(self, &element, hits);
            for hit in hits.iter() {
                let height = &mut self.heights[hit.cell];
                removed += (height.max(bottom) - hit.z.max(bottom)).max(0.0);
                *height = height.min(hit.z);
            }
        }
        removed * self.grid.cell[0] * self.grid.cell[1]
    }

    /// The place where `cutter` is deepest in what stands on its way along `motion`, and how deep; `None` where it meets
    /// nothing.
    pub(super) fn deepest_meeting(
        &self,
        cutter: &Cutter,
        motion: &Motion,
        hits: &mut Vec<Hit>,
    ) -> Option<(f64, Point)> {
        let bottom = self.stock.bottom_mm;
        let mut deepest: Option<(f64, usize)> = None;
        for element in cutter.elements(motion) {
            hits.clear();
            cutter.gather(self, &element, hits);
            for hit in hits.iter() {
                let depth = self.heights[hit.cell].max(bottom) - hit.z.max(bottom);
                if deepest.is_none_or(|(known, _)| depth > known) {
                    deepest = Some((depth, hit.cell));
                }
            }
        }
        let columns = self.grid.columns;
        deepest.filter(|(d, _)| *d > 0.0).map(|(d, cell)| (d, self.center(cell % columns, cell / columns)))
    }
}

#[cfg(test)]
mod tests;
