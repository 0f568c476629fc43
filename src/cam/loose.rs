//! Pieces that a program cuts loose although tabs were asked for: held against the motions, whatever the tabs were planned on.
//!
//! In the plane of the bottom of the stock all that is not swept must hang on the stock around. Where it hangs by less than
//! [`NECK`] it does not.

use super::motion::{Motion, Program};
use super::swept::{Group, paths_at_floor, swept};
use super::tool::Tool;
use crate::plane::{Point, Region, Ring, inscribed_circle};
use crate::threads;

/// What hangs by less than this, in millimetres, breaks off.
const NECK: f64 = 0.2;

/// Pieces that hold no circle of this diameter, in millimetres, are chips.
const CHIP: f64 = 0.5;

/// A piece that nothing holds.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct LoosePiece {
    /// The middle of the largest circle in it.
    pub x_mm: f64,
    /// The middle of the largest circle in it.
    pub y_mm: f64,
    /// Its area at the bottom of the stock, in square millimetres.
    pub area_mm2: f64,
}

/// The pieces that `program` cuts loose from a stock with its bottom, or what tabs stand on, at z `base`, largest first.
pub fn loose_pieces(program: &Program, tool: &Tool, base: f64) -> Vec<LoosePiece> {
    let lowest = program.motions.iter().map(Motion::lowest).fold(f64::INFINITY, f64::min);
    let radius = tool.radius_at(base - lowest);
    if radius <= 0.0 {
        return Vec::new();
    }
    let groups = Group::all(swept(&paths_at_floor(&program.motions, base), radius + 0.5 * NECK), radius);
    let found = threads::map_long(&groups, threads::available(), loose_of);
    let mut pieces: Vec<LoosePiece> = found.into_iter().flatten().collect();
    pieces.sort_by(|a, b| b.area_mm2.total_cmp(&a.area_mm2));
    pieces
}

fn loose_of(group: &Group) -> Vec<LoosePiece> {
    let mut pieces = Vec::new();
    for shape in group.left() {
        let rings: Vec<Vec<Point>> =
            shape.iter().map(|ring| ring.iter().map(|&[x, y]| Point::new(x, y)).collect()).collect();
        if rings.iter().flatten().any(|p| group.is_on_frame(*p)) {
            continue;
        }
        let region = Region::new(rings.into_iter().map(Ring::polygon).collect());
        let circle = inscribed_circle(&region);
        if 2.0 * circle.radius + NECK > CHIP {
            pieces.push(LoosePiece { x_mm: circle.center.x, y_mm: circle.center.y, area_mm2: region.area() });
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cam::ToolShape;
    use crate::gcode::read;

    const HEAD: &str = "G21 G90 G17 G94\nG0 Z5\nM3 S1000\nG4 P1\nF500\n";

    fn tool(shape: ToolShape) -> Tool {
        Tool { number: 1, name: String::new(), shape, is_drill: false, diameter: 4.0, flutes: 2, flute_length: 20.0 }
    }

    fn loose(path: &str, shape: ToolShape) -> Vec<LoosePiece> {
        loose_pieces(&read(&format!("{HEAD}{path}")).unwrap(), &tool(shape), -1.0)
    }

    #[test]
    fn a_square_without_a_tab_comes_loose_and_with_one_it_does_not() {
        let around = "G0 X0 Y0\nG1 Z-1.2\nG1 X20\nG1 Y20\nG1 X0\nG1 Y0\n";
        let [piece] = loose(around, ToolShape::Flat)[..] else { panic!() };
        // 16 mm are left between the cuts, less what does not count as hold.
        assert!((piece.area_mm2 - 15.8 * 15.8).abs() < 1e-3 && (piece.x_mm - 10.0).abs() < 0.2, "{piece:?}");
        let tab = "G0 X0 Y0\nG1 Z-1.2\nG1 X8\nG1 Z-0.5\nG1 X13\nG1 Z-1.2\nG1 X20\nG1 Y20\nG1 X0\nG1 Y0\n";
        assert_eq!(loose(tab, ToolShape::Flat), []);
        // A tab of five millimetres, of which the tool's ends leave a tenth.
        assert_eq!(loose(&tab.replace("X13", "X12.1"), ToolShape::Flat).len(), 1);
        // A ball has no width at its tip, and reaches the bottom of the stock with a part of it.
        assert_eq!(loose(&around.replace("-1.2", "-1"), ToolShape::Ball), []);
        let [piece] = loose(around, ToolShape::Ball)[..] else { panic!() };
        let width = 20.0 - 2.0 * (0.2f64 * 3.8).sqrt() - NECK;
        assert!((piece.area_mm2 - width * width).abs() < 1e-2, "{piece:?}");
    }

    #[test]
    fn a_slug_and_chips_are_told_apart_and_a_pass_above_the_bottom_frees_nothing() {
        // Two circles of 5 mm radius, and one that leaves a pin of a tenth.
        let circle = |x: f64, r: f64| format!("G0 X{} Y0\nG1 Z-1\nG3 X{} Y0 I-{r} J0\nG0 Z5\n", x + r, x + r);
        let found = loose(&(circle(0.0, 5.0) + &circle(40.0, 5.0) + &circle(80.0, 2.15)), ToolShape::Flat);
        assert_eq!(found.len(), 2);
        assert!(
            (found[0].x_mm.abs() < 0.1 || (found[0].x_mm - 40.0).abs() < 0.1) && found[0].y_mm.abs() < 0.1,
            "{found:?}"
        );
        assert_eq!(loose(&circle(0.0, 5.0).replace("Z-1", "Z-0.9"), ToolShape::Flat), []);
    }
}
