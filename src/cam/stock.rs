//! What is cut: a box.

use super::motion::{MotionKind, Program};
use super::tool_table::ToolTable;
use crate::plane::{Bounds, Point, Vector};

/// A box of material, in millimetres and in the program's coordinates.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Stock {
    /// Left side.
    pub min_x_mm: f64,
    /// Front side.
    pub min_y_mm: f64,
    /// Right side.
    pub max_x_mm: f64,
    /// Back side.
    pub max_y_mm: f64,
    /// Height of its upper face.
    pub top_mm: f64,
    /// Height of its lower face.
    pub bottom_mm: f64,
}

/// Stock that is made up reaches this far beyond what the tools sweep, in tool radii.
const MARGIN: f64 = 1.0;

impl Stock {
    /// Stock of `size` with its lower left corner at `corner`.
    pub fn new(corner: Point, size: [f64; 3], top: f64) -> Stock {
        Stock {
            min_x_mm: corner.x,
            min_y_mm: corner.y,
            max_x_mm: corner.x + size[0],
            max_y_mm: corner.y + size[1],
            top_mm: top,
            bottom_mm: top - size[2],
        }
    }

    /// Stock of `size` in the middle of what `program` cuts.
    pub fn around(program: &Program, tools: &ToolTable, size: [f64; 3], top: f64) -> Option<Stock> {
        let (cut, _) = cut_bounds(program, tools, top)?;
        Some(Stock::new(cut.center() - 0.5 * Vector::new(size[0], size[1]), size, top))
    }

    /// Stock that holds what `program` cuts below `top`, with a margin of a tool radius, as thick as the deepest cut; `None`
    /// where it cuts nothing.
    pub fn of_cuts(program: &Program, tools: &ToolTable, top: f64) -> Option<Stock> {
        let (cut, lowest) = cut_bounds(program, tools, top)?;
        let radius = tools.iter().map(|t| t.radius()).fold(0.0, f64::max);
        let outline = cut.inflated(MARGIN * radius);
        Some(Stock::new(outline.min, [outline.width(), outline.height(), top - lowest], top))
    }

    /// Its outline seen from above.
    pub fn outline(&self) -> Bounds {
        Bounds { min: Point::new(self.min_x_mm, self.min_y_mm), max: Point::new(self.max_x_mm, self.max_y_mm) }
    }

    /// How thick it is.
    pub fn thickness(&self) -> f64 {
        self.top_mm - self.bottom_mm
    }

    /// Whether it is a thing: all its sides longer than nothing, and all numbers finite.
    pub fn is_possible(&self) -> bool {
        let b = self.outline();
        [b.width(), b.height(), self.thickness()].iter().all(|x| x.is_finite() && *x > 0.0)
    }
}

/// What the tools sweep below `top`, and the lowest height that they reach there. Rapids cut only where there is nothing else.
fn cut_bounds(program: &Program, tools: &ToolTable, top: f64) -> Option<(Bounds, f64)> {
    let of = |with_rapids: bool| {
        let (mut bounds, mut lowest) = (Bounds::EMPTY, f64::INFINITY);
        for motion in program.motions.iter().filter(|m| m.is_in_stock(top) && (with_rapids || m.is_feed())) {
            let radius = tools.get(motion.tool).map_or(0.0, |t| t.radius());
            let start = Bounds::EMPTY.with_point(motion.from.xy()).with_point(motion.to.xy());
            let way = match motion.kind {
                MotionKind::Arc { .. } => motion.trace().fold(start, |b, s| b.union(s.bounds())),
                _ => start,
            };
            bounds = bounds.union(way.inflated(radius));
            lowest = lowest.min(motion.lowest());
        }
        (!bounds.is_empty()).then_some((bounds, lowest))
    };
    of(false).or_else(|| of(true))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::read;

    const TEXT: &str =
        "(tool diameter 4 mm)\nG21 G90 G17 G94\nG0 Z5\nG0 X50 Y50\nG0 X10 Y0\nG1 Z-3 F100\nG3 X-10 Y0 I-10 J0\n";

    fn stock(text: &str) -> Option<Stock> {
        let program = read(text).unwrap();
        Stock::of_cuts(&program, &ToolTable::gather(&[], &program), 0.0)
    }

    #[test]
    fn stock_holds_the_cuts_with_a_margin() {
        let found = stock(TEXT).unwrap();
        let b = found.outline();
        assert_eq!((b.min, found.bottom_mm), (Point::new(-14.0, -4.0), -3.0));
        assert!((b.max - Point::new(14.0, 14.0)).norm() < 1e-12, "{b:?}");
        assert_eq!(stock("G21 G90\nG0 Z5\nG0 X50\n"), None);
        assert!(found.is_possible());
    }

    #[test]
    fn stock_of_a_size_lies_in_the_middle_of_the_cuts() {
        let program = read(TEXT).unwrap();
        let tools = ToolTable::gather(&[], &program);
        let found = Stock::around(&program, &tools, [100.0, 40.0, 6.0], 0.0).unwrap();
        assert!((found.outline().min - Point::new(-50.0, -15.0)).norm() < 1e-12);
        assert_eq!((found.thickness(), found.outline().width()), (6.0, 100.0));
    }
}
