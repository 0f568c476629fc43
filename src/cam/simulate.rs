//! What happens when a program runs: the stock as it is cut, motion by motion, and what goes wrong on the way.
//!
//! Stages: each motion is held against the keepouts, the lower face of the stock, and, where it is a rapid, what stands in
//! its way at that moment; then its cutter takes away what it sweeps. Whether a drill moved sideways or the spindle stood
//! still matters only where that was something.

use super::event::{Event, EventKind, Events};
use super::height_map::{HeightMap, MapError};
use super::keepout::Keepout;
use super::motion::{Motion, MotionKind, Point3, Program};
use super::operation_run::{OperationRun, operation_starts};
use super::stock::Stock;
use super::sweep::Cutter;
use super::time::{Machine, ProgramTime, motion_seconds};
use super::tool::Tool;
use super::tool_table::ToolTable;

/// Further below the stock than this, in millimetres, unless told otherwise, is a finding: through cuts go a little into
/// the board below.
pub const DEFAULT_SPOIL: f64 = 0.5;

/// The outermost of the cutter does not count where rapids are held against what stands, in millimetres: a wall that the
/// same path has cut is met by no rapid along it, whatever the last decimals are.
const GRAZE: f64 = 0.02;

/// Rapids less deep in what stands than this, in millimetres, touch it: rounding of programs in inches.
const RAPID_TOUCH: f64 = 0.003;

/// Drills that move aside by less than this, in millimetres, drill.
const SIDEWAYS: f64 = 0.005;

/// Less than this, in cubic millimetres, is nothing: a cell that a path grazes.
const NOTHING: f64 = 1e-6;

/// What a program is run on.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulateOptions {
    /// What is cut.
    pub stock: Stock,
    /// Side of a cell of the height map in millimetres.
    pub cell: f64,
    /// What no tool may enter.
    pub keepouts: Vec<Keepout>,
    /// How far below the stock tools may go, in millimetres.
    pub spoil: f64,
    /// The machine whose time is told.
    pub machine: Machine,
}

/// What came of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// What stands in the end.
    pub map: HeightMap,
    /// What went wrong, in the order of the program.
    pub events: Vec<Event>,
    /// What each operation did.
    pub operations: Vec<OperationRun>,
    /// Seconds.
    pub time: ProgramTime,
    /// What was removed, in cubic millimetres.
    pub removed_mm3: f64,
}

/// Why a program cannot be run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimulateError {
    /// A tool that nothing is known of goes into the stock.
    #[error(
        "line {line}: {} goes into the stock, and nothing is known of it: say what it is with --tool \"{number}=flat 6mm\" \
         (or ball, v60, drill)",
        if *.number == 0 { "the tool that the program starts with".to_owned() } else { format!("tool {number}") }
    )]
    UnknownTool {
        /// The number of the tool; 0 for the one that the program starts with.
        number: u32,
        /// The first line where it is in the stock.
        line: usize,
    },
    /// There is no such stock, or its cells make no sense.
    #[error(transparent)]
    Map(#[from] MapError),
}

/// The first tool that goes below `top` and is not in `tools`.
///
/// # Errors
/// Names it and the line.
pub fn check_tools(program: &Program, tools: &ToolTable, top: f64) -> Result<(), SimulateError> {
    let unknown = program.motions.iter().find(|m| m.is_in_stock(top) && tools.get(m.tool).is_none());
    unknown.map_or(Ok(()), |m| Err(SimulateError::UnknownTool { number: m.tool, line: m.line }))
}

/// Runs `program`.
///
/// # Errors
/// Where a tool that cuts is not in `tools`, or the stock is no thing.
pub fn simulate(program: &Program, tools: &ToolTable, options: &SimulateOptions) -> Result<Simulation, SimulateError> {
    let stock = &options.stock;
    check_tools(program, tools, stock.top_mm)?;
    check_cell(program, tools, options)?;
    let mut run =
        Run { options, map: HeightMap::new(*stock, options.cell)?, events: Events::default(), hits: Vec::new() };
    let seconds = motion_seconds(program, &options.machine);
    let mut time = ProgramTime::default();
    let mut operations: Vec<OperationRun> = Vec::new();
    let mut starts = operation_starts(program, tools).into_iter().peekable();
    for (index, (motion, seconds)) in program.motions.iter().zip(seconds).enumerate() {
        while let Some((_, operation)) = starts.next_if(|(first, _)| *first <= index) {
            operations.push(operation);
        }
        *(match motion.kind {
            MotionKind::Dwell { .. } => &mut time.dwell_seconds,
            MotionKind::Rapid => &mut time.rapid_seconds,
            MotionKind::Feed { .. } | MotionKind::Arc { .. } => &mut time.feed_seconds,
        }) += seconds;
        let removed = tools.get(motion.tool).map_or(0.0, |tool| run.step(motion, tool));
        if let Some(operation) = operations.last_mut() {
            operation.add(motion, seconds, removed, stock.top_mm);
        }
    }
    let removed_mm3 = operations.iter().map(|o| o.removed_mm3).sum();
    operations.retain(OperationRun::is_worth_telling);
    Ok(Simulation { map: run.map, events: run.events.into_vec(), operations, time, removed_mm3 })
}

/// Whether the cells show the smallest tool that cuts.
fn check_cell(program: &Program, tools: &ToolTable, options: &SimulateOptions) -> Result<(), MapError> {
    let cutting = program.motions.iter().filter(|m| m.is_in_stock(options.stock.top_mm));
    let diameters = cutting.filter_map(|m| tools.get(m.tool)).map(|tool| tool.diameter);
    let smallest = diameters.fold(f64::INFINITY, f64::min);
    let coarsest = HeightMap::coarsest_cell(smallest);
    // Rounding of a quarter is none.
    match options.cell > coarsest * (1.0 + 1e-9) {
        true => Err(MapError::Coarse(options.cell, smallest, coarsest)),
        false => Ok(()),
    }
}

/// A run under way.
struct Run<'a> {
    options: &'a SimulateOptions,
    map: HeightMap,
    events: Events,
    hits: Vec<super::sweep::Hit>,
}

impl Run<'_> {
    /// One motion; what it removes, in cubic millimetres.
    fn step(&mut self, motion: &Motion, tool: &Tool) -> f64 {
        if matches!(motion.kind, MotionKind::Dwell { .. }) {
            return 0.0;
        }
        self.events.next_motion();
        let mut find = |kind, amount, at| self.events.find(kind, motion, amount, at);
        for (number, keepout) in self.options.keepouts.iter().enumerate() {
            if let Some((depth, at)) = keepout.entered_by(motion, tool.radius()) {
                find(EventKind::Collision { keepout: number + 1 }, depth, at);
            }
        }
        let stock = self.map.stock();
        // The point of a drill goes deeper on purpose, so that its full diameter is out.
        let point = if tool.is_drill { tool.height_at(tool.radius()).unwrap_or(0.0) } else { 0.0 };
        let below = stock.bottom_mm - motion.lowest() - point;
        if below > self.options.spoil + RAPID_TOUCH {
            let lowest = if motion.to.z <= motion.from.z { motion.to } else { motion.from };
            find(EventKind::Overrun, below, lowest);
        }
        if motion.lowest() >= stock.top_mm {
            return 0.0;
        }
        let cutter = Cutter::new(tool);
        if motion.is_rapid() {
            let met = self.map.deepest_meeting(&cutter.without(GRAZE), motion, &mut self.hits);
            if let Some((depth, at)) = met.filter(|(depth, _)| *depth > RAPID_TOUCH) {
                find(EventKind::RapidThroughStock, depth, Point3::new(at.x, at.y, motion.lowest()));
            }
        }
        let removed = self.map.cut(&cutter, motion, &mut self.hits);
        if motion.is_feed() && removed > NOTHING {
            let aside: f64 = motion.trace().map(|s| s.length()).sum();
            if tool.is_drill && aside > SIDEWAYS {
                find(EventKind::DrillSideways, aside, motion.from);
            }
            if !motion.spindle_on {
                find(EventKind::SpindleOff, removed, motion.from);
            }
        }
        removed
    }
}

#[cfg(test)]
mod tests;
