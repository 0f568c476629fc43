//! The largest circle in a region.

use std::collections::BinaryHeap;

use super::{BoundaryIndex, Point, Region, Vector};

/// Accuracy of inscribed circles, over the size of the piece.
const INSCRIBED_ACCURACY: f64 = 1e-3;

/// The most cells that the search for an inscribed circle looks at.
const INSCRIBED_CELLS: usize = 400;

/// A circle inside of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InscribedCircle {
    /// Its centre.
    pub center: Point,
    /// Its radius.
    pub radius: f64,
    /// No circle in the region has a larger radius than this: the one that was found, and what the search leaves open.
    pub at_most: f64,
}

/// A square of the search for the inscribed circle, ordered by the largest circle that it could hold.
struct Cell {
    best_possible: f64,
    center: Point,
    half: f64,
}

impl PartialEq for Cell {
    fn eq(&self, other: &Cell) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Cell {}
impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Cell) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Cell {
    fn cmp(&self, other: &Cell) -> std::cmp::Ordering {
        self.best_possible.total_cmp(&other.best_possible)
    }
}

/// The largest circle in a region, within about a thousandth of its size, by dividing squares that could still hold a larger
/// one. Radius zero where there is no area.
pub fn inscribed_circle(outline: &Region) -> InscribedCircle {
    let index = BoundaryIndex::new(outline);
    let signed = |p: Point| index.distance(p) * if outline.contains(p) { 1.0 } else { -1.0 };
    let bounds = outline.bounds();
    let half = 0.5 * bounds.width().min(bounds.height());
    let mut best = (bounds.center(), signed(bounds.center()));
    if half <= 0.0 {
        return InscribedCircle { center: best.0, radius: best.1.max(0.0), at_most: best.1.max(0.0) };
    }
    let mut cells = BinaryHeap::new();
    let add = |center: Point, half: f64, cells: &mut BinaryHeap<Cell>, best: &mut (Point, f64)| {
        let d = signed(center);
        if d > best.1 {
            *best = (center, d);
        }
        cells.push(Cell { best_possible: d + half * std::f64::consts::SQRT_2, center, half });
    };
    // At most a few dozen squares across a long piece: larger ones where it is longer.
    let half = half.max(bounds.diagonal() / 48.0);
    let (columns, rows) =
        ((bounds.width() / (2.0 * half)).ceil() as usize, (bounds.height() / (2.0 * half)).ceil() as usize);
    for k in 0..columns.max(1) * rows.max(1) {
        let step = Vector::new((k % columns.max(1)) as f64, (k / columns.max(1)) as f64) * (2.0 * half);
        add(bounds.min + Vector::new(half, half) + step, half, &mut cells, &mut best);
    }
    let accuracy = INSCRIBED_ACCURACY * half;
    for _ in 0..INSCRIBED_CELLS {
        if cells.peek().is_none_or(|c| c.best_possible <= best.1 + accuracy) {
            break;
        }
        let Some(cell) = cells.pop() else { break };
        let h = 0.5 * cell.half;
        for (sx, sy) in [(-h, -h), (h, -h), (-h, h), (h, h)] {
            add(cell.center + Vector::new(sx, sy), h, &mut cells, &mut best);
        }
    }
    let left_open = cells.peek().map_or(0.0, |cell| cell.best_possible);
    InscribedCircle { center: best.0, radius: best.1.max(0.0), at_most: left_open.max(best.1).max(0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Ring;

    #[test]
    fn a_triangle_has_its_incircle() {
        let p = Point::new;
        let triangle = Region::new(vec![Ring::polygon([p(20.0, 20.0), p(22.0, 14.0), p(24.0, 20.0)])]);
        let found = inscribed_circle(&triangle);
        // Twice the area over the perimeter.
        let radius = 24.0 / (4.0 + 2.0 * 40f64.sqrt());
        assert!((found.radius - radius).abs() < 0.02 * radius, "{found:?}");
        assert!((found.center - p(22.0, 20.0 - radius)).norm() < 0.1, "{found:?}");
        assert!(found.at_most >= radius && found.at_most < 1.02 * radius, "{found:?}");
        assert_eq!(inscribed_circle(&Region::default()).radius, 0.0);
    }
}
