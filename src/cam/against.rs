//! What a program of several tools does to a part: gouges and leftovers in the plane.

use super::gouge::{Gouge, deepest_cut};
use super::leftover::{Leftover, Reach, leftovers};
use super::motion::Program;
use super::removal::{Run, Uncut, uncut_by};
use super::solid::Remainder;
use super::tool::{Tool, ToolShape};
use super::tool_table::ToolTable;
use crate::plane::Region;

/// What is held against a part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AgainstOptions {
    /// Which side of the outlines must remain; `None` where the tool's centre runs on them.
    pub remainder: Option<Remainder>,
    /// Where the top of the stock lies, z in millimetres.
    pub stock_top: f64,
    /// Where the cut must reach, z in millimetres.
    pub floor: f64,
}

/// What a program does to a part.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Against {
    /// The deepest place that is cut of what must remain; `None` where nothing is cut. On the outline, how far the centre
    /// gets inside of it.
    pub gouge: Option<Gouge>,
    /// What is left standing beside the part; `None` on the outline.
    pub uncut: Option<Uncut>,
    /// The stretches of the outlines that were to be cut and are not.
    pub left: Vec<Leftover>,
    /// The tools that were not judged: the width of V bits is not that of their cut.
    pub tools_left_out: Vec<u32>,
}

/// What `program` does to `part`, in millimetres and in the program's coordinates.
///
/// Flat tools count at all depths, and so do balls and drills, whose tips are narrower: below the floor they must go by as much.
pub fn against(program: &Program, tools: &ToolTable, part: &Region, options: &AgainstOptions) -> Against {
    let AgainstOptions { remainder, stock_top, floor } = *options;
    let is_judged = |tool: &Tool| tool.is_drill || !matches!(tool.shape, ToolShape::Cone { .. });
    let mut found = Against::default();
    let mut runs: Vec<Run> = Vec::new();
    let mut reaches: Vec<Reach> = Vec::new();
    for motions in program.motions.chunk_by(|a, b| a.tool == b.tool) {
        let Some(tool) = motions.first().and_then(|m| tools.get(m.tool)) else { continue };
        if !motions.iter().any(|m| m.is_in_stock(stock_top)) {
            continue;
        }
        reaches.push(Reach { motions, radius: tool.radius() });
        if !is_judged(tool) {
            if !found.tools_left_out.contains(&tool.number) {
                found.tools_left_out.push(tool.number);
            }
            continue;
        }
        let radius = if remainder.is_some() { tool.radius() } else { 0.0 };
        let alone = Program { motions: motions.to_vec(), ..Program::default() };
        let gouge = deepest_cut(&alone, part, remainder.unwrap_or(Remainder::Inside), radius, stock_top);
        if gouge.is_some_and(|g| found.gouge.is_none_or(|known| g.depth_mm > known.depth_mm)) {
            found.gouge = gouge;
        }
        runs.push(Run { motions, tool_radius: radius });
    }
    found.left = leftovers(&reaches, &part.rings, floor, stock_top);
    found.uncut = remainder.map(|remainder| uncut_by(&runs, part, remainder, floor));
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::read;
    use crate::plane::{Point, Ring};

    const HEAD: &str = "G21 G90 G17 G94\nG0 Z5\nM3 S1000\nG4 P1\nF500\n";

    fn pocket() -> Region {
        let corners = [[0.0, 0.0], [20.0, 0.0], [20.0, 10.0], [0.0, 10.0]];
        Region::new(vec![Ring::polygon(corners.map(|p| Point::new(p[0], p[1])))])
    }

    fn found(path: &str) -> Against {
        let program = read(&format!("{HEAD}{path}")).unwrap();
        let given = ["1=flat 4mm", "2=flat 2mm", "3=v90 6mm"].map(|t| t.parse().unwrap());
        let tools = ToolTable::gather(&given, &program);
        let options = AgainstOptions { remainder: Some(Remainder::Outside), stock_top: 0.0, floor: -1.0 };
        against(&program, &tools, &pocket(), &options)
    }

    const ROUGH: &str = "T1\nG0 X2 Y2\nG1 Z-1\nG1 X18\nG1 Y8\nG1 X2\nG1 Y2\nG1 Y5\nG1 X18\nG0 Z5\n";
    const FINE: &str = "T2\nG0 X1 Y1\nG1 Z-1\nG1 X19\nG1 Y9\nG1 X1\nG1 Y1\nG0 Z5\n";

    #[test]
    fn a_second_tool_takes_what_the_first_has_left() {
        let corners = |r: f64| 4.0 * r * r * (1.0 - std::f64::consts::PI / 4.0);
        let one = found(ROUGH).uncut.unwrap();
        assert!((one.area_mm2 / corners(2.0) - 1.0).abs() < 1e-3);
        let both = found(&format!("{ROUGH}{FINE}"));
        let uncut = both.uncut.unwrap();
        assert!((uncut.area_mm2 / corners(1.0) - 1.0).abs() < 1e-3, "{uncut:?}");
        assert!(both.gouge.unwrap().depth_mm.abs() < 1e-9);
    }

    #[test]
    fn the_tool_that_gouges_is_found_and_v_bits_are_left_out() {
        let deep = found(&format!("{ROUGH}{FINE}T2\nG0 X0.5 Y5\nG1 Z-1\nG0 Z5\n")).gouge.unwrap();
        assert!((deep.depth_mm - 0.5).abs() < 1e-9 && deep.line == 26, "{deep:?}");
        let left_out = found(&format!("{ROUGH}T3\nG0 X0 Y5\nG1 Z-1\nG0 Z5\n"));
        assert_eq!(left_out.tools_left_out, [3]);
        assert!(left_out.gouge.unwrap().depth_mm.abs() < 1e-9);
    }
}
