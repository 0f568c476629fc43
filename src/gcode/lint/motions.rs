//! What a machine should not do, whatever its controller takes.

use std::collections::BTreeMap;

use super::{Finding, HEIGHT_ROUNDING, LOW_TRAVEL, LintOptions};
use crate::cam::{Motion, MotionKind, Program};
use crate::gcode::MachineKind;
use crate::gcode::rules::Rule;
use crate::plane::Point;

/// Places in XY nearer to each other than this, in millimetres, are one hole: half of what a machine repeats.
const SAME_PLACE: f64 = 5e-3;

/// How deep the tool that is in the spindle has been, place by place.
#[derive(Default)]
struct Holes(BTreeMap<[i64; 2], f64>);

impl Holes {
    fn key(p: Point) -> [i64; 2] {
        [p.x, p.y].map(|v| (v / SAME_PLACE).round() as i64)
    }

    fn cut(&mut self, p: Point, z: f64) {
        let depth = self.0.entry(Holes::key(p)).or_insert(z);
        *depth = depth.min(z);
    }

    /// Whether z was reached at the place before.
    fn is_open(&self, p: Point, z: f64) -> bool {
        self.0.get(&Holes::key(p)).is_some_and(|depth| *depth <= z + HEIGHT_ROUNDING)
    }
}

/// What is known on the way.
#[derive(Default)]
struct State {
    holes: Holes,
    /// Feed of cutting sideways of the tool in the spindle.
    side_feed: f64,
    spindle_was_on: bool,
    has_dwelt: bool,
    said_off: bool,
    said_beam: bool,
    said_fast: bool,
}

/// Looks at all motions; `tool_changes` are the numbers of motions before each change.
pub(super) fn check(program: &Program, tool_changes: &[usize], options: &LintOptions, findings: &mut Vec<Finding>) {
    let motions = program.motions.as_slice();
    let mut state = State { side_feed: side_feed(motions, tool_changes, 0, options.stock_top), ..State::default() };
    for (index, motion) in motions.iter().enumerate() {
        if tool_changes.binary_search(&index).is_ok() {
            // Another tool has another width: what was open for the one before need not be for it.
            state.holes = Holes::default();
            state.side_feed = side_feed(motions, tool_changes, index, options.stock_top);
            state.said_fast = false;
        }
        state.look(motions, index, motion, options, findings);
    }
}

impl State {
    fn look(
        &mut self,
        motions: &[Motion],
        index: usize,
        motion: &Motion,
        options: &LintOptions,
        findings: &mut Vec<Finding>,
    ) {
        let mut find = |rule, detail: String| findings.push(Finding::new(motion.line, rule, detail));
        let stock_top = options.stock_top;
        let top = stock_top - HEIGHT_ROUNDING;
        if motion.spindle_on != self.spindle_was_on {
            (self.spindle_was_on, self.has_dwelt, self.said_off) = (motion.spindle_on, false, false);
        }
        let moves_in_plane = motion.from.xy() != motion.to.xy();
        match motion.kind {
            MotionKind::Dwell { seconds } => self.has_dwelt |= motion.spindle_on && seconds > 0.0,
            MotionKind::Rapid if options.dialect.machine == MachineKind::Laser => {
                if moves_in_plane && motion.spindle_on && !std::mem::replace(&mut self.said_beam, true) {
                    find(Rule::BeamOnTravel, String::new());
                }
            }
            // Without Z nothing is known about heights.
            MotionKind::Rapid if !options.dialect.knows_letter('Z') => {}
            MotionKind::Rapid => {
                // A rapid that goes nowhere is the first to say how high the tool is: nobody knows what it comes down from.
                let comes_down = motion.to.z < motion.from.z || motion.to == motion.from;
                if motion.to.z < top && comes_down {
                    if moves_in_plane || !self.holes.is_open(motion.to.xy(), motion.to.z) {
                        find(Rule::RapidPlunge, format!("to z {:.3}", motion.to.z));
                    }
                } else if moves_in_plane && motion.lowest() < top {
                    find(Rule::RapidThroughMaterial, format!("at z {:.3}", motion.lowest()));
                } else if moves_in_plane && motion.lowest() < stock_top + LOW_TRAVEL {
                    find(Rule::LowTravel, format!("at z {:.3}", motion.lowest()));
                }
            }
            MotionKind::Feed { .. } | MotionKind::Arc { .. } => {
                if options.dialect.machine == MachineKind::Router && motion.lowest() < top {
                    if !motion.spindle_on && !self.said_off {
                        find(Rule::SpindleOff, String::new());
                        self.said_off = true;
                    }
                    if motion.spindle_on && !self.has_dwelt {
                        find(Rule::NoDwell, String::new());
                        self.has_dwelt = true;
                    }
                    self.look_at_plunge(motion, moves_in_plane, find);
                }
                if is_circle_in_path(motions, index) {
                    findings.push(Finding::new(motion.line, Rule::ArcEndEqualsStart, String::new()));
                }
                self.holes.cut(motion.from.xy(), motion.from.z);
                self.holes.cut(motion.to.xy(), motion.to.z);
            }
        }
    }

    fn look_at_plunge(&mut self, motion: &Motion, moves_in_plane: bool, mut find: impl FnMut(Rule, String)) {
        let Some(feed) = motion.feed() else { return };
        let is_down = !moves_in_plane && motion.to.z < motion.from.z;
        let is_fast = self.side_feed > 0.0 && feed >= self.side_feed;
        if is_down && is_fast && !self.said_fast && !self.holes.is_open(motion.to.xy(), motion.to.z) {
            self.said_fast = true;
            find(Rule::FastPlunge, format!("{feed:.0} mm/min"));
        }
    }
}

/// The highest feed at which the tool that comes into the spindle before motion `first` cuts sideways at one height.
fn side_feed(motions: &[Motion], tool_changes: &[usize], first: usize, stock_top: f64) -> f64 {
    let end = tool_changes.get(tool_changes.partition_point(|c| *c <= first)).copied().unwrap_or(motions.len());
    let cuts = motions[first..end].iter().filter(|m| m.from.z == m.to.z && m.from.xy() != m.to.xy());
    let feeds = cuts.filter(|m| m.to.z < stock_top).filter_map(Motion::feed);
    feeds.fold(0.0, f64::max)
}

/// Whether the motion is a full circle between other motions of one path. A circle that is meant is entered and left
/// by Z, or follows another one.
fn is_circle_in_path(motions: &[Motion], index: usize) -> bool {
    let is_circle = |m: &Motion| matches!(m.kind, MotionKind::Arc { .. }) && m.from.xy() == m.to.xy();
    let is_path = |m: Option<&Motion>| m.is_some_and(|m| m.is_feed() && m.from.xy() != m.to.xy());
    is_circle(&motions[index])
        && is_path(index.checked_sub(1).and_then(|before| motions.get(before)))
        && is_path(motions.get(index + 1))
}
