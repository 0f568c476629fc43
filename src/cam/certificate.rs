//! What a program does to a part: computed from the program as it was read back, not from what was meant.

use super::gouge::{Gouge, deepest_cut};
use super::motion::{MotionKind, Program};
use super::path_radius::{TightestTurns, tightest_turns};
use super::removal::{Uncut, uncut};
use super::solid::Remainder;
use super::time::{Machine, ProgramTime, estimate};
use crate::plane::{Bounds, Region};
use crate::threads::both;

/// What a program is held against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CertifyOptions {
    /// Radius of the tool in millimetres.
    pub tool_radius: f64,
    /// Which side of the outlines must remain.
    pub remainder: Remainder,
    /// Where the top of the stock lies, z in millimetres.
    pub stock_top: f64,
    /// Where the cut must reach, z in millimetres; `None`: the lowest place of the program.
    pub floor: Option<f64>,
    /// The machine whose time is told.
    pub machine: Machine,
}

impl CertifyOptions {
    /// Around a part, stock top at 0, as deep as the program goes, on the default machine.
    pub fn new(tool_radius: f64) -> CertifyOptions {
        CertifyOptions {
            tool_radius,
            remainder: Remainder::Inside,
            stock_top: 0.0,
            floor: None,
            machine: Machine::default(),
        }
    }
}

/// What a program does to a part.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Certificate {
    /// The deepest cut into the part; `None` where nothing is cut at all.
    pub gouge: Option<Gouge>,
    /// The deepest cut beyond the intended boundary of what remains: how exact the program is.
    pub overcut: Option<Gouge>,
    /// What is left standing next to the part.
    pub uncut: Uncut,
    /// The tightest turns of the path.
    pub path_radius: TightestTurns,
    /// Lengths and counts.
    pub statistics: ProgramStatistics,
    /// Seconds.
    pub time: ProgramTime,
}

/// Lengths and counts of a program.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct ProgramStatistics {
    /// Way at a feed below the top of the stock, in millimetres.
    pub cut_length_mm: f64,
    /// Way at a feed above it, in millimetres.
    pub air_length_mm: f64,
    /// Way of rapids, in millimetres.
    pub rapid_length_mm: f64,
    /// How far below the top of the stock the tool goes, in millimetres.
    pub depth_mm: f64,
    /// Levels below the top of the stock along which the tool cuts.
    pub passes: usize,
    /// Straight motions at a feed.
    pub lines: usize,
    /// Arcs.
    pub arcs: usize,
    /// Times the tool goes down into the stock.
    pub entries: usize,
    /// Where the tool's centre is while it cuts; `None` where nothing is cut.
    pub cut_box: Option<CutBox>,
}

/// A box in the program's coordinates.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct CutBox {
    /// Left side, in millimetres.
    pub min_x_mm: f64,
    /// Front side, in millimetres.
    pub min_y_mm: f64,
    /// Right side, in millimetres.
    pub max_x_mm: f64,
    /// Back side, in millimetres.
    pub max_y_mm: f64,
}

/// Levels closer than this are one pass, in millimetres.
const SAME_LEVEL: f64 = 0.01;

/// A level with less of the way than this share of the longest one's is no pass: rounding makes small parts of a ramp level.
const LEAST_PASS: f64 = 0.01;

/// The lengths and counts of `program`.
pub fn statistics(program: &Program, stock_top: f64) -> ProgramStatistics {
    let mut s = ProgramStatistics::default();
    // Heights and the way along them.
    let mut levels: Vec<(f64, f64)> = Vec::new();
    let mut bounds = Bounds::EMPTY;
    for motion in &program.motions {
        let length = motion.length();
        match motion.kind {
            MotionKind::Dwell { .. } => continue,
            MotionKind::Rapid => s.rapid_length_mm += length,
            MotionKind::Feed { .. } => s.lines += 1,
            MotionKind::Arc { .. } => s.arcs += 1,
        }
        if motion.is_feed() {
            *(if motion.is_in_stock(stock_top) { &mut s.cut_length_mm } else { &mut s.air_length_mm }) += length;
        }
        if motion.is_in_stock(stock_top) {
            bounds = motion.trace().fold(bounds.with_point(motion.to.xy()), |b, s| b.union(s.bounds()));
        }
        s.depth_mm = s.depth_mm.max(stock_top - motion.lowest());
        if motion.from.z >= stock_top && motion.to.z < stock_top {
            s.entries += 1;
        }
        let is_level = motion.from.z == motion.to.z && motion.trace().next().is_some();
        if is_level && motion.is_feed() && motion.is_in_stock(stock_top) {
            levels.push((motion.to.z, length));
        }
    }
    levels.sort_by(|a, b| a.0.total_cmp(&b.0));
    levels.dedup_by(|a, b| {
        let same = (a.0 - b.0).abs() < SAME_LEVEL;
        b.1 += if same { a.1 } else { 0.0 };
        same
    });
    let longest = levels.iter().map(|l| l.1).fold(0.0, f64::max);
    s.passes = levels.iter().filter(|l| l.1 > LEAST_PASS * longest).count();
    s.cut_box = (!bounds.is_empty()).then_some(CutBox {
        min_x_mm: bounds.min.x,
        min_y_mm: bounds.min.y,
        max_x_mm: bounds.max.x,
        max_y_mm: bounds.max.y,
    });
    s
}

/// What `program` does to `part`, which must remain, where `kept` is the intended boundary of what remains: the part
/// with what the tool or the rounding cannot reach. Both in millimetres, in the program's coordinates.
pub fn certify(program: &Program, part: &Region, kept: &Region, options: &CertifyOptions) -> Certificate {
    let CertifyOptions { tool_radius, remainder, stock_top, floor, machine } = *options;
    let statistics = statistics(program, stock_top);
    let floor = floor.unwrap_or(stock_top - statistics.depth_mm);
    let deepest = |solid: &Region| deepest_cut(program, solid, remainder, tool_radius, stock_top);
    let (uncut, ([gouge, overcut], path_radius, time)) = both(
        || uncut(program, part, remainder, tool_radius, floor),
        || {
            let turns = tightest_turns(program, kept, remainder, stock_top);
            ([part, kept].map(deepest), turns, estimate(program, &machine))
        },
    );
    Certificate { gouge, overcut, uncut, path_radius, statistics, time }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::read;
    use crate::plane::{Point, Ring};

    const PROGRAM: &str = "G21 G90 G17 G94\nG0 Z5\nM3 S1000\nG4 P2\nG0 X-2 Y0\nG1 Z-1 F100\n\
        G1 Y10 F600\nG2 X0 Y12 I2 J0\nG1 X10\nG2 X12 Y10 I0 J-2\nG1 Y0\nG2 X10 Y-2 I-2 J0\nG1 X0\nG2 X-2 Y0 I0 J2\n\
        G1 Z-2 F100\n\
        G1 Y10 F600\nG2 X0 Y12 I2 J0\nG1 X10\nG2 X12 Y10 I0 J-2\nG1 Y0\nG2 X10 Y-2 I-2 J0\nG1 X0\nG2 X-2 Y0 I0 J2\n\
        G0 Z5\nM5\nM2\n";

    #[test]
    fn a_square_is_cut_exactly() {
        let program = read(PROGRAM).unwrap();
        let part = Region::new(vec![Ring::polygon(
            [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]].map(|p| Point::new(p[0], p[1])),
        )]);
        let found = certify(&program, &part, &part, &CertifyOptions::new(2.0));
        assert!(found.gouge.unwrap().depth_mm.abs() < 1e-12);
        assert!(found.uncut.places.is_empty() && found.uncut.is_cut_free, "{:?}", found.uncut);
        assert_eq!(found.path_radius.smallest_mm, Some(2.0));
        assert_eq!(found.path_radius.smallest_concave_mm, None);
        let s = found.statistics;
        assert_eq!((s.passes, s.lines, s.arcs, s.entries, s.depth_mm), (2, 10, 8, 1, 2.0));
        let around = 40.0 + 4.0 * std::f64::consts::PI;
        assert!((s.cut_length_mm - (2.0 * around + 6.0 + 1.0)).abs() < 1e-9, "{s:?}");
        assert_eq!(s.rapid_length_mm, 2.0 + 7.0);
        let around = CutBox { min_x_mm: -2.0, min_y_mm: -2.0, max_x_mm: 12.0, max_y_mm: 12.0 };
        assert_eq!(s.cut_box, Some(around), "the tool's radius outside of the square");
        assert_eq!(found.time.dwell_seconds, 2.0);
        let json = serde_json::to_value(&found).unwrap();
        assert_eq!(json["statistics"]["depth_mm"], 2.0);
    }

    #[test]
    fn level_pieces_of_a_ramp_are_no_passes() {
        // The second motion is too short to fall by a last decimal.
        let ramped =
            "G21 G90 G17 G94\nG0 Z5\nG1 Z0 F100\nG1 X5 Z-0.5\nG1 X5.004\nG1 X10 Z-1\nG1 Y10\nG1 X0\nG1 Y0\nG1 X10\n";
        let s = statistics(&read(ramped).unwrap(), 0.0);
        assert_eq!((s.passes, s.depth_mm), (1, 1.0));
    }

    #[test]
    fn a_program_that_cuts_nothing_is_no_panic() {
        let nothing = certify(&Program::default(), &Region::default(), &Region::default(), &CertifyOptions::new(1.0));
        assert_eq!((nothing.gouge, nothing.statistics.cut_box), (None, None));
        assert!(!nothing.uncut.is_cut_free);
    }
}
