//! States on the way of a flow, evenly spread.
//!
//! Where the end is not known beforehand the flow runs twice: once to find it, once to stop on the way. So no more states
//! are ever kept than are asked for, however many steps there are.

use std::cell::Cell;

use indicatif::{ProgressBar, ProgressStyle};

use crate::flow::{CurveFlow, FlowError, Report, Status};
use crate::plane::Region;
use crate::preview::Frame;

/// What is even between frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Spacing {
    /// Time.
    Time,
    /// The area that the boundary sweeps over.
    Area,
}

/// How a flow is recorded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    /// How many states, the last of them at the end; above zero.
    pub(super) frames: usize,
    pub(super) spacing: Spacing,
    /// The time at which it ends if it has not before, in squares of the drawing's unit; may be infinite.
    pub(super) until: f64,
}

/// What a flow came to.
pub(super) struct Recording {
    /// Times in squares of the drawing's unit, and states.
    states: Vec<(f64, Region)>,
    /// About the whole flow.
    pub(super) report: Report,
}

impl Recording {
    /// The states with their times in units of `square`.
    pub(super) fn frames(&self, square: f64) -> Vec<Frame> {
        let frame = |(time, region): &(f64, Region)| Frame { time: time / square, region: region.clone() };
        self.states.iter().map(frame).collect()
    }
}

/// Lets the flow run that `start` makes, the same each time.
///
/// # Errors
/// Where the flow cannot start.
pub(super) fn record<'a>(
    start: impl Fn() -> Result<CurveFlow<'a>, FlowError>,
    plan: Plan,
) -> Result<Recording, FlowError> {
    let bar = Progress::new();
    let mut flow = start()?;
    let mut states = Vec::new();
    // Times on the way to a known end are known as well.
    if plan.spacing == Spacing::Time && plan.until.is_finite() {
        for k in 1..plan.frames {
            run(&mut flow, part(plan.until, k, plan.frames), f64::INFINITY, plan.until, &bar);
            states.push((flow.time(), flow.rounded()));
        }
    }
    run(&mut flow, plan.until, f64::INFINITY, plan.until, &bar);
    let (end, swept) = (flow.time(), flow.swept());
    let was_caught = states.len() + 1 == plan.frames && end >= plan.until;
    if !was_caught && plan.frames > 1 {
        states.clear();
        let mut again = start()?;
        for k in 1..plan.frames {
            match plan.spacing {
                Spacing::Time => run(&mut again, part(end, k, plan.frames), f64::INFINITY, end, &bar),
                Spacing::Area => run(&mut again, end, part(swept, k, plan.frames), end, &bar),
            }
            states.push((again.time(), again.rounded()));
        }
    }
    states.push((end, flow.rounded()));
    Ok(Recording { states, report: flow.report() })
}

fn part(whole: f64, k: usize, n: usize) -> f64 {
    whole * k as f64 / n as f64
}

/// Runs up to a time or to so much swept area, whichever comes first; `end` is where all of it ends, as far as known.
fn run(flow: &mut CurveFlow, time: f64, swept: f64, end: f64, bar: &Progress) {
    while flow.time() < time && flow.swept() < swept && flow.step(time) == Status::Going {
        bar.tell(flow, end);
    }
}

/// A bar on standard error, where that is a terminal.
struct Progress {
    bar: ProgressBar,
    steps: Cell<u64>,
}

/// The parts of a full bar.
const PARTS: u64 = 1000;

/// Between two of so many steps nobody needs to be told.
const SILENT_STEPS: u64 = 32;

impl Progress {
    fn new() -> Progress {
        let bar = ProgressBar::new(PARTS);
        if let Ok(style) = ProgressStyle::with_template("{spinner} [{bar:30}] {elapsed} {msg}") {
            bar.set_style(style.progress_chars("=> "));
        }
        Progress { bar, steps: Cell::new(0) }
    }

    fn tell(&self, flow: &CurveFlow, end: f64) {
        let steps = self.steps.get() + 1;
        self.steps.set(steps);
        if self.bar.is_hidden() || !steps.is_multiple_of(SILENT_STEPS) {
            return;
        }
        if end.is_finite() && end > 0.0 {
            self.bar.set_position((flow.time() / end * PARTS as f64) as u64);
        }
        let (moving, largest) = flow.last_step();
        self.bar.set_message(format!("{moving} vertices moving, by {largest:.1e} edge lengths at most"));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
