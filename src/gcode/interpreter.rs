//! What a program's lines make a machine do.
//!
//! The modal state starts unknown. What a machine would take from its memory is assumed (millimetres, absolute, XY
//! plane, units per minute), and that it had to be assumed is a finding. Reading never stops: a line that cannot be
//! understood is a finding too, and whether the program's meaning is lost is said by its rule.

mod arc;
mod cycle;
mod feed;
mod places;
mod words;

use std::collections::{BTreeMap, BTreeSet};

use self::cycle::{Cycle, CycleWords};
use self::places::Places;
use super::block::Block;
use super::codes;
use super::rules::Rule;
use super::{Dialect, Finding, MachineKind, Statement};
use crate::cam::{Comment, Motion, MotionKind, Point3, Program, ProgramUnit};
use crate::plane::Turn;
use crate::units::Brief;

/// A program and what was found while reading it.
#[derive(Clone, Debug, Default)]
pub(super) struct Interpretation {
    pub(super) program: Program,
    pub(super) findings: Vec<Finding>,
    /// How many motions there were before each tool change.
    pub(super) tool_changes: Vec<usize>,
    /// Motions to or from places that only the machine knows: the line, and the lowest z on the way.
    pub(super) unknown_ways: Vec<(usize, f64)>,
}

/// A rule is reported so often on one line: more says nothing new, and a line can be as long as its file.
const MOST_ALIKE: usize = 8;

#[derive(Clone, Copy, PartialEq, Eq)]
enum MotionMode {
    Rapid,
    Feed,
    Arc(Turn),
    Cycle(Cycle),
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum FeedMode {
    PerMinute,
    InverseTime,
    PerTurn,
}

/// Axes as indices into a [`Point3`]: the two of the plane and the one across.
pub(super) type PlaneAxes = [usize; 3];
const XY: PlaneAxes = [0, 1, 2];
const ZX: PlaneAxes = [2, 0, 1];
const YZ: PlaneAxes = [1, 2, 0];

#[derive(Default)]
struct Interpreter<'a> {
    dialect: Option<&'a Dialect>,
    out: Interpretation,
    line: usize,
    motion: Option<MotionMode>,
    plane: Option<PlaneAxes>,
    unit: Option<ProgramUnit>,
    is_incremental: Option<bool>,
    arc_centers_are_absolute: bool,
    feed_mode: Option<FeedMode>,
    /// In the unit of the feed mode, with millimetres.
    feed: Option<f64>,
    /// Whether the feed in force was said with a rapid.
    feed_is_of_rapid: bool,
    /// Whether the feed in force was said before the tool was changed.
    feed_is_of_tool_before: bool,
    spindle_on: bool,
    spindle_speed: f64,
    /// The number of the last T word.
    chosen_tool: u32,
    /// The tool that the last M6 has put into the spindle; `None` before the first.
    loaded_tool: Option<u32>,
    position: Point3,
    places: Places,
    cycle: CycleWords,
    z_is_known: bool,
    highest: f64,
    said: BTreeSet<Rule>,
    /// How often each rule was broken on the line with this number.
    found: (usize, BTreeMap<Rule, usize>),
}

/// Runs `text`, a whole program, on a controller of `dialect`.
pub(super) fn interpret(text: &str, dialect: &Dialect) -> Interpretation {
    let mut machine = Interpreter {
        dialect: Some(dialect),
        position: Point3::origin(),
        highest: f64::NEG_INFINITY,
        // A machine without Z has nothing to lift.
        z_is_known: !dialect.knows_letter('Z'),
        ..Interpreter::default()
    };
    for (index, line) in text.lines().enumerate() {
        machine.line = index + 1;
        if machine.out.program.end_line.is_none() {
            machine.run(line);
        } else if Block::parse(line).has_code() {
            machine.find_once(Rule::AfterEnd, "");
        }
    }
    machine.out.program.unit = machine.out.program.unit.or(machine.unit);
    machine.out
}

impl<'a> Interpreter<'a> {
    fn dialect(&self) -> &'a Dialect {
        self.dialect.unwrap_or(Dialect::portable())
    }

    fn find(&mut self, rule: Rule, detail: impl Into<String>) {
        if self.found.0 != self.line {
            self.found = (self.line, BTreeMap::new());
        }
        let count = self.found.1.entry(rule).or_insert(0);
        *count += 1;
        if *count <= MOST_ALIKE {
            self.out.findings.push(Finding::new(self.line, rule, detail));
        }
    }

    /// For findings that would repeat on every line.
    fn find_once(&mut self, rule: Rule, detail: &str) {
        if self.said.insert(rule) {
            self.find(rule, detail);
        }
    }

    fn run(&mut self, line: &str) {
        let block = Block::parse(line);
        self.check_text(line, &block);
        let comments = block.comments.iter().filter(|c| !c.is_empty());
        self.out.program.comments.extend(comments.map(|c| Comment { line: self.line, text: c.clone() }));
        self.check_words(&block);
        self.execute(&block);
    }

    /// In the order in which controllers act: settings first, then dwell, then motion, then the end.
    fn execute(&mut self, block: &Block) {
        let mut dwell = false;
        let (mut homing, mut origin) = (None, None);
        let mut end = false;
        let mut takes_axes = false;
        let mut takes_offsets = false;
        let (mut spindle, mut tool_stop) = (None, false);
        for word in &block.words {
            let Some(tenths) = codes::tenths(word.value) else { continue };
            match (word.letter, tenths) {
                ('G', 0) => self.set_motion(Some(MotionMode::Rapid)),
                ('G', 10) => self.set_motion(Some(MotionMode::Feed)),
                ('G', 20) => self.set_motion(Some(MotionMode::Arc(Turn::Right))),
                ('G', 30) => self.set_motion(Some(MotionMode::Arc(Turn::Left))),
                ('G', 800) => self.set_motion(None),
                ('G', t) if Cycle::of(t).is_some() => self.set_motion(Cycle::of(t).map(MotionMode::Cycle)),
                ('G', 980) => self.cycle.returns_to_r = false,
                ('G', 990) => self.cycle.returns_to_r = true,
                ('G', 40) => dwell = true,
                ('G', 170) => self.plane = Some(XY),
                ('G', 180) => self.plane = Some(ZX),
                ('G', 190) => self.plane = Some(YZ),
                ('G', 200) => self.set_unit(ProgramUnit::Inch),
                ('G', 210) => self.set_unit(ProgramUnit::Millimetre),
                ('G', 900) => self.is_incremental = Some(false),
                ('G', 910) => self.is_incremental = Some(true),
                ('G', 901) => self.arc_centers_are_absolute = true,
                ('G', 911) => self.arc_centers_are_absolute = false,
                ('G', 930) => self.set_feed_mode(FeedMode::InverseTime),
                ('G', 940) => self.set_feed_mode(FeedMode::PerMinute),
                ('G', 950) => self.set_feed_mode(FeedMode::PerTurn),
                ('G', 280 | 300 | 530) => homing = Some(tenths),
                ('G', 281 | 301) => {}
                // The length of the tool in the spindle: with it, positions are those of the tip, as they are read.
                ('G', 430) => takes_offsets = true,
                ('G', 520 | 920..=923) => {
                    takes_axes |= matches!(tenths, 520 | 920);
                    origin = Some(tenths);
                    self.find_once(Rule::SetOrigin, &format!("G{}", Brief(word.value)));
                }
                ('G', 540..=593) => self.choose_system(tenths),
                ('G', 100 | 431 | 432) => {
                    takes_axes |= matches!(tenths, 100 | 431);
                    takes_offsets = true;
                    self.find_once(Rule::ShiftedOrigin, &format!("G{}", Brief(word.value)));
                }
                ('G', t) if codes::is_not_followed(t) => {
                    (takes_axes, takes_offsets) = (true, true);
                    self.find(Rule::NotFollowed, format!("G{}", Brief(word.value)));
                }
                ('G', 640) => takes_offsets = true,
                ('M', 30 | 40) => spindle = Some(true),
                ('M', 50) => spindle = Some(false),
                ('M', 60) => tool_stop = true,
                ('M', 20 | 300) => end = true,
                ('M', 980 | 990) => self.find(Rule::NotFollowed, format!("M{}", Brief(word.value))),
                ('M', t) if t >= 600 => takes_offsets = true,
                _ => {}
            }
        }
        if let Some(f) = block.value('F') {
            let unit = if self.feed_mode == Some(FeedMode::InverseTime) { 1.0 } else { self.millimetres() };
            self.feed = Some(f * unit);
        }
        let dialect = self.dialect();
        let is_time = |letter| dwell && dialect.dwell_units.contains_key(&letter);
        if let Some(s) = block.value('S').filter(|_| !is_time('S')) {
            if dialect.spindle_full.is_some_and(|full| s > full.word) {
                self.find(Rule::SpeedOutOfRange, format!("S{}", Brief(s)));
            }
            self.spindle_speed = s;
            self.out.program.spindle_speed = self.out.program.spindle_speed.max(s);
        }
        if let Some(number) = block.value('T').filter(|t| (0.0..=f64::from(u32::MAX)).contains(t)) {
            self.chosen_tool = number as u32;
        }
        if tool_stop {
            self.change_tool();
        }
        if let Some(on) = spindle {
            self.spindle_on = on;
            if on && self.spindle_speed <= 0.0 && dialect.machine == MachineKind::Router {
                self.find(Rule::NoSpindleSpeed, "");
            }
        }
        if dwell {
            let mut times = dialect.dwell_units.iter();
            match times.find_map(|(letter, unit)| Some(block.value(*letter)? / unit.per_second())) {
                Some(seconds) => self.push(self.position, MotionKind::Dwell { seconds: seconds.max(0.0) }),
                None => self.find(Rule::DwellWithoutTime, ""),
            }
        }
        let axes = ['X', 'Y', 'Z'].map(|letter| block.value(letter));
        let has_axes = axes.iter().any(Option::is_some);
        if let Some(code) = origin {
            self.set_origin(code, axes);
        }
        if let Some(code) = homing {
            self.home(code, axes);
        } else if !takes_axes {
            self.move_axes(block, axes, has_axes);
        }
        let is_arc = matches!(self.motion, Some(MotionMode::Arc(_)));
        takes_offsets |= matches!(self.motion, Some(MotionMode::Cycle(_)));
        let offsets = ['I', 'J', 'K', 'R'].into_iter().find(|&l| block.value(l).is_some());
        if let Some(letter) = offsets.filter(|_| !is_arc && !takes_offsets) {
            self.find(Rule::UnusedWord, letter);
        }
        if block.value('P').is_some() && !(dwell || is_arc || takes_offsets) {
            self.find(Rule::UnusedWord, 'P');
        }
        if end {
            self.out.program.end_line = Some(self.line);
            self.find_end();
        }
    }

    fn find_end(&mut self) {
        // LinuxCNC and GRBL stop the spindle at M2 and M30, senders and other controllers may not.
        if self.spindle_on && self.dialect().machine != MachineKind::Pen {
            self.find(Rule::SpindleLeftOn, "");
        }
    }

    /// M6. Whoever changes a tool may have moved the machine, and the new tool is of another length.
    fn change_tool(&mut self) {
        if self.spindle_on {
            self.find(Rule::SpindleOnAtToolChange, "");
        }
        self.spindle_on = false;
        self.z_is_known = !self.dialect().knows_letter('Z');
        self.feed_is_of_tool_before = self.feed.is_some();
        self.out.tool_changes.push(self.out.program.motions.len());
        // Before the first change T alone names no tool in the spindle: it only makes one ready.
        if self.loaded_tool.is_none() {
            self.out.program.motions.iter_mut().for_each(|m| m.tool = 0);
        }
        self.loaded_tool = Some(self.chosen_tool);
    }

    fn set_unit(&mut self, unit: ProgramUnit) {
        self.unit = Some(unit);
        self.out.program.unit.get_or_insert(unit);
    }

    fn set_feed_mode(&mut self, mode: FeedMode) {
        // A feed of the one mode means nothing in the other: both controllers forget it.
        if self.feed_mode.is_some_and(|before| before != mode) {
            self.feed = None;
        }
        self.feed_mode = Some(mode);
    }

    fn millimetres(&self) -> f64 {
        self.unit.unwrap_or(ProgramUnit::Millimetre).millimetres()
    }

    fn push(&mut self, to: Point3, kind: MotionKind) {
        let motion = Motion {
            line: self.line,
            from: self.position,
            to,
            kind,
            spindle_on: self.spindle_on,
            spindle_speed: self.spindle_speed,
            tool: self.loaded_tool.unwrap_or(self.chosen_tool),
        };
        self.out.program.motions.push(motion);
        self.position = to;
        self.highest = self.highest.max(to.z);
    }

    fn move_axes(&mut self, block: &Block, axes: [Option<f64>; 3], has_axes: bool) {
        let mode = self.motion;
        let is_arc = matches!(mode, Some(MotionMode::Arc(_)));
        let has_center = ['I', 'J', 'K', 'R'].iter().any(|&l| block.value(l).is_some());
        let is_motion = has_axes || (is_arc && has_center);
        if !is_motion {
            return;
        }
        self.find_missing(mode);
        self.follow_feed(mode, block);
        if let Some(MotionMode::Cycle(cycle)) = mode {
            return self.drill(cycle, block, axes);
        }
        let to = self.target(axes);
        if (axes[0].is_some() || axes[1].is_some()) && !self.z_is_known {
            self.find_once(Rule::TravelBeforeLift, "");
        }
        self.take_z(axes, to);
        self.note_unknown_way(mode, axes, to);
        match mode {
            None | Some(MotionMode::Rapid) => self.push(to, MotionKind::Rapid),
            Some(MotionMode::Feed) => {
                let feed = self.feed_for((to - self.position).norm(), block);
                self.push(to, MotionKind::Feed { feed });
            }
            Some(MotionMode::Arc(turn)) => self.move_arc(block, turn, axes, to),
            // Made above.
            Some(MotionMode::Cycle(_)) => {}
        }
    }

    /// What the motion about to be made had to be guessed.
    fn find_missing(&mut self, mode: Option<MotionMode>) {
        let must_state = |statement| self.dialect().must_state.contains(&statement);
        let [units, plane, distance, feed_mode] =
            [Statement::Units, Statement::Plane, Statement::DistanceMode, Statement::FeedMode].map(must_state);
        if units && self.unit.is_none() {
            self.find_once(Rule::MissingUnits, "");
        }
        if plane && self.plane.is_none() {
            self.find_once(Rule::MissingPlane, "");
        }
        if distance && self.is_incremental.is_none() {
            self.find_once(Rule::MissingDistanceMode, "");
        }
        match mode {
            None => self.find_once(Rule::MissingMotionMode, ""),
            Some(MotionMode::Feed | MotionMode::Arc(_) | MotionMode::Cycle(_))
                if feed_mode && self.feed_mode.is_none() =>
            {
                self.find_once(Rule::MissingFeedMode, "");
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests;
