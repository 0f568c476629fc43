//! What a program cuts at each of its depths, exactly in the plane.
//!
//! Stages: the heights of level cuts and of the ends of plunges are the levels; from the deepest up, what is swept at or below
//! each is united with what was cut below it, and clipped to the stock. Flat tools count with all their motions, of slopes
//! the part below the level; other tools with their level motions and plunges alone, as wide as they are at the level.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

use super::motion::{Motion, MotionKind, Program};
use super::stock::Stock;
use super::stroke::{Polygon, Stroke, joined_lines};
use super::tool::{Tool, ToolShape};
use super::tool_table::ToolTable;
use crate::plane::{Point, Segment};

/// Heights closer than this are one level, in millimetres.
const SAME_LEVEL: f64 = 0.01;

/// Where a ramp goes on down behind it, a level with less of the way than this share of the longest one's is none: rounding
/// makes small parts of ramps level.
const LEAST_WAY: f64 = 0.005;

/// Most levels: with more, a program carves, and its depths are no levels.
const MOST_LEVELS: usize = 99;

/// Chord error of the outlines as a fraction of the tool's radius.
const RELATIVE_FLATTENING: f64 = 1e-4;

/// Lines whose ends are this near to one line are taken as one, in millimetres: half of what three decimals round away.
const STRAIGHTNESS: f64 = 5e-4;

/// What is cut at one depth.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct CutLevel {
    /// The height.
    pub z_mm: f64,
    /// The area in square millimetres.
    pub area_mm2: f64,
    /// Its outlines; outer ones run counterclockwise, holes clockwise.
    #[serde(skip)]
    pub outlines: Vec<Vec<Point>>,
}

/// Why there are no levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LevelError {
    /// More depths than anyone looks at.
    #[error(
        "the program cuts at {0} depths, more than {MOST_LEVELS}: it carves, and the height map (-o) shows what it does"
    )]
    TooMany(usize),
}

/// What `program` cuts of `stock` at each of its depths, from the top down.
///
/// # Errors
/// Where there are too many depths.
pub fn cut_levels(program: &Program, tools: &ToolTable, stock: &Stock) -> Result<Vec<CutLevel>, LevelError> {
    let heights = heights(program, stock.top_mm);
    if heights.len() > MOST_LEVELS {
        return Err(LevelError::TooMany(heights.len()));
    }
    let b = stock.outline();
    let frame = vec![vec![[b.min.x, b.min.y], [b.max.x, b.min.y], [b.max.x, b.max.y], [b.min.x, b.max.y]]];
    let mut levels: Vec<CutLevel> = Vec::new();
    let mut below: Vec<Polygon> = Vec::new();
    let mut floor = f64::NEG_INFINITY;
    for z in heights {
        let mut cut = std::mem::take(&mut below);
        sweep(program, tools, (floor, z + SAME_LEVEL), &mut cut);
        let shapes = cut.overlay_as::<i64>(&frame, OverlayRule::Intersect, FillRule::NonZero);
        below = shapes.into_iter().flatten().collect();
        let outlines: Vec<Vec<Point>> =
            below.iter().map(|ring| ring.iter().map(|&[x, y]| Point::new(x, y)).collect()).collect();
        // The tip of a drill is below the stock, or as good as a point: no level.
        if !below.is_empty() {
            levels.push(CutLevel { z_mm: z, area_mm2: outlines.iter().map(|ring| area(ring)).sum(), outlines });
        }
        floor = z + SAME_LEVEL;
    }
    levels.reverse();
    Ok(levels)
}

/// The levels, from the deepest up.
fn heights(program: &Program, stock_top: f64) -> Vec<f64> {
    let motions: Vec<&Motion> =
        program.motions.iter().filter(|m| !matches!(m.kind, MotionKind::Dwell { .. })).collect();
    let is_way = |m: &Motion| m.is_feed() && m.trace().next().is_some();
    let is_ramp = |m: Option<&&Motion>| m.is_some_and(|m| is_way(m) && m.to.z < m.from.z);
    // Heights, the way along them, and whether it may be a part of a ramp.
    let mut levels: Vec<(f64, f64, bool)> = Vec::new();
    let mut index = 0usize;
    for run in motions.chunk_by(|a, b| is_way(a) && is_way(b) && a.from.z == a.to.z && b.from.z == b.to.z) {
        let before = index.checked_sub(1).and_then(|i| motions.get(i));
        index += run.len();
        let Some(first) = run.first().filter(|m| m.is_feed() && m.is_in_stock(stock_top)) else { continue };
        let next = motions.get(index);
        if is_way(first) && first.from.z == first.to.z {
            let way = run.iter().map(|m| m.length()).sum();
            levels.push((first.to.z, way, is_ramp(before) && is_ramp(next)));
        }
        // A plunge is a level where it ends, unless it goes on downward, or on along the level.
        let goes_on = next.is_some_and(|next| next.to.z <= first.to.z && next.is_feed());
        if !is_way(first) && first.to.z < first.from.z && !goes_on {
            levels.push((first.to.z, first.length(), false));
        }
    }
    levels.sort_by(|a, b| a.0.total_cmp(&b.0));
    levels.dedup_by(|a, b| {
        let same = (a.0 - b.0).abs() < SAME_LEVEL;
        if same {
            (b.1, b.2) = (b.1 + a.1, b.2 && a.2);
        }
        same
    });
    let longest = levels.iter().map(|l| l.1).fold(0.0, f64::max);
    levels.into_iter().filter(|(_, way, is_of_ramp)| !is_of_ramp || *way > LEAST_WAY * longest).map(|l| l.0).collect()
}

/// What is swept between two heights: the lower one excluded, below which flat tools have been counted.
fn sweep(program: &Program, tools: &ToolTable, (floor, z): (f64, f64), cut: &mut Vec<Polygon>) {
    let mut path: Vec<Segment> = Vec::new();
    let mut radius = 0.0;
    let flush = |path: &mut Vec<Segment>, radius: f64, cut: &mut Vec<Polygon>| {
        let stroke = Stroke { radius, tolerance: radius * RELATIVE_FLATTENING };
        match path.as_slice() {
            [] => {}
            [point] if point.start == point.end => cut.push(stroke.disk(point.start)),
            _ => cut.extend(stroke.rings(&joined_lines(path, STRAIGHTNESS))),
        }
        path.clear();
    };
    for motion in &program.motions {
        if matches!(motion.kind, MotionKind::Dwell { .. }) {
            continue;
        }
        let part = tools.get(motion.tool).and_then(|tool| part_below(motion, tool, floor, z));
        let Some((elements, own_radius)) = part else {
            flush(&mut path, radius, cut);
            continue;
        };
        let follows = path.last().zip(elements.first()).is_some_and(|(a, b)| a.end == b.start);
        if !follows || own_radius != radius {
            flush(&mut path, radius, cut);
            radius = own_radius;
        }
        let is_point = |s: &Segment| s.start == s.end;
        // A plunge adds nothing to a path that starts or ends there.
        if path.first().is_some_and(is_point) && !elements.iter().all(is_point) {
            path.clear();
        }
        path.extend(elements.into_iter().filter(|s| !(is_point(s) && follows)));
    }
    flush(&mut path, radius, cut);
}

/// The elements of a motion that cut at a level, and how wide.
fn part_below(motion: &Motion, tool: &Tool, floor: f64, z: f64) -> Option<(Vec<Segment>, f64)> {
    let (from, to) = (motion.from.z, motion.to.z);
    let is_flat = tool.shape == ToolShape::Flat;
    if motion.lowest() > z || (is_flat && from.max(to) <= floor) {
        return None;
    }
    let radius = tool.radius_at(z - SAME_LEVEL - motion.lowest().min(z - SAME_LEVEL));
    if radius <= 0.0 {
        return None;
    }
    let at = motion.to.xy();
    if motion.trace().next().is_none() {
        return Some((vec![Segment::line(at, at)], radius));
    }
    if from == to {
        return Some((motion.trace().collect(), radius));
    }
    if !is_flat {
        return None;
    }
    let parts = motion.trace_below(z);
    (!parts.is_empty()).then_some((parts, radius))
}

fn area(ring: &[Point]) -> f64 {
    let Some(first) = ring.first() else { return 0.0 };
    let pairs = ring.windows(2);
    0.5 * pairs.map(|w| (w[0] - first).perp(&(w[1] - first))).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::read;
    use std::f64::consts::PI;

    const HEAD: &str = "G21 G90 G17 G94\nT1\nG0 Z5\nM3 S1000\nG4 P1\nF500\n";

    fn levels(tool: &str, path: &str) -> Vec<CutLevel> {
        let program = read(&format!("{HEAD}{path}")).unwrap();
        let tools = ToolTable::gather(&[tool.parse().unwrap()], &program);
        let stock = Stock::new(Point::new(-50.0, -50.0), [100.0, 100.0, 5.0], 0.0);
        cut_levels(&program, &tools, &stock).unwrap()
    }

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() < 2e-3, "{a} against {b}");
    }

    #[test]
    fn each_level_holds_what_is_cut_at_it_and_below() {
        // A slot in two passes, the second one shorter.
        let found = levels("T1=flat 4mm", "G0 X0 Y0\nG1 Z-1\nG1 X20\nG1 Z-2\nG1 X10\nG0 Z5");
        assert_eq!(found.iter().map(|l| l.z_mm).collect::<Vec<_>>(), [-1.0, -2.0]);
        close(found[0].area_mm2, 80.0 + 4.0 * PI);
        close(found[1].area_mm2, 40.0 + 4.0 * PI);
        // Around a square: a hole stays in the middle.
        let around = levels("T1=flat 4mm", "G0 X0 Y0\nG1 Z-1\nG1 X20\nG1 Y20\nG1 X0\nG1 Y0\nG0 Z5");
        assert_eq!(around[0].outlines.len(), 2);
        close(around[0].area_mm2, 400.0 + 80.0 * 2.0 + 4.0 * PI - 256.0);
    }

    #[test]
    fn ramps_cut_a_level_with_their_lower_part() {
        // Down to -2 over 20, then back at -2 over the second half only; a level at -1 somewhere else.
        let found = levels("T1=flat 4mm", "G0 X0 Y0\nG1 Z0\nG1 X20 Z-2\nG1 X16\nG0 Z5\nG0 X-30\nG1 Z-1\nG1 Y20\nG0 Z5");
        close(found[1].area_mm2, 16.0 + 4.0 * PI);
        // What is below -1 of the ramp: from 10 to 20, a little more for the tolerance of a level.
        let at_1 = 40.0 + 4.0 * PI + 80.0 + 4.0 * PI;
        assert!((found[0].area_mm2 - at_1).abs() < 4.0 * 10.0 * SAME_LEVEL + 2e-3, "{} {at_1}", found[0].area_mm2);
    }

    #[test]
    fn small_deep_cuts_are_levels_and_level_bits_of_ramps_are_none() {
        let mut face = "G0 X-40 Y-40\nG1 Z-1\n".to_owned();
        for row in 0..40 {
            face += &format!("G1 X{}\nG1 Y{}\n", if row % 2 == 0 { 40 } else { -40 }, 2 * row - 38);
        }
        let deep = "G0 Z5\nG0 X0 Y0\nG1 Z-3\nG1 X3\nG0 Z5\nG0 X20\nG1 Z-4\nG0 Z5\n";
        let z = |path: &str| levels("T1=flat 4mm", path).iter().map(|l| l.z_mm).collect::<Vec<_>>();
        assert_eq!(z(&format!("{face}{deep}")), [-1.0, -3.0, -4.0]);
        // A ramp whose rounding has made a millimetre of it level, in two pieces.
        let ramp = "G0 Z5\nG0 X0 Y0\nG1 Z-1\nG1 X10 Z-2\nG1 X10.5\nG1 X11\nG1 X20 Z-3\nG1 X0\nG0 Z5\n";
        assert_eq!(z(&format!("{face}{ramp}")), [-1.0, -3.0]);
    }

    #[test]
    fn stock_ends_where_it_ends_and_v_bits_have_their_width() {
        let off = levels("T1=flat 4mm", "G0 X50 Y0\nG1 Z-1\nG1 Y20\nG0 Z5");
        close(off[0].area_mm2, 40.0 + 2.0 * PI);
        let plunge = levels("T1=flat 4mm", "G0 X0 Y0\nG1 Z-1\nG1 Z-3\nG0 Z5");
        assert_eq!(plunge.iter().map(|l| l.z_mm).collect::<Vec<_>>(), [-3.0]);
        close(plunge[0].area_mm2, 4.0 * PI);
        let v = levels("T1=v90 20mm", "G0 X0 Y0\nG1 Z-3\nG1 X20\nG0 Z5\nG0 X0 Y40\nG1 Z-1\nG1 X20\nG0 Z5");
        assert_eq!(v.iter().map(|l| l.z_mm).collect::<Vec<_>>(), [-1.0], "a tip alone is no level");
        close(v[0].area_mm2, 20.0 * 4.0 + 4.0 * PI);
    }
}
