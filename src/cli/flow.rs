//! `clopen flow`: the curvature-bounded flow of a drawing in time, as drawings and pictures of its states.

mod field;
mod outputs;
mod own;
mod record;
mod report;

use std::path::PathBuf;

use anyhow::{Context as _, Result, bail};
use clap::{Args, ValueEnum};

use super::ExitStatus;
use super::check::FormatArg;
use super::input::{ReadArgs, SelectionArgs, read_bytes};
use super::output;
use crate::flow::{CurveFlow, DEFAULT_EDGE, DEFAULT_TIME_STEP, DEFAULT_TOLERANCE, Obstacle, OnContact, Settings};
use crate::io::svg::Parts;
use crate::plane::Region;
use crate::units::Length;
use field::FieldArgs;
pub(super) use outputs::{OutputArgs, StateArgs};
use record::Plan;
use report::Report;

/// The arguments.
#[derive(Clone, Debug, Args)]
pub(super) struct FlowArgs {
    /// The drawing, SVG; - is standard input
    #[arg(value_name = "IN")]
    input: PathBuf,
    #[command(flatten)]
    flow: FlowOptions,
    /// An element in whose area nothing moves, by its id, painted or not (it may stand in defs); may be given more than once
    #[arg(long = "pin-id", help_heading = field::HEADING, value_name = "ID")]
    pinned: Vec<String>,
    #[command(flatten)]
    selection: SelectionArgs,
    #[command(flatten)]
    reading: ReadArgs,
}

/// Over the options that say what flows, and how far.
const HEADING: &str = "Flow";

/// What is to be done to a drawing, wherever it comes from.
#[derive(Clone, Debug, Args)]
pub(super) struct FlowOptions {
    /// Which curvatures the flow removes; not needed with --bound none
    #[arg(long, help_heading = HEADING, value_enum, required_unless_present = "bound")]
    op: Option<OperationArg>,
    #[command(flatten)]
    field: FieldArgs,
    /// Where the flow stops, in squares of the radius (of the largest, where it varies); at its limit unless given
    #[arg(long, help_heading = HEADING, value_name = "TIME", allow_hyphen_values = true)]
    time: Option<f64>,
    /// Distance of vertices where the boundary moves; a thirteenth of the (smallest) radius unless given
    #[arg(long, help_heading = HEADING, value_name = "LENGTH", allow_hyphen_values = true)]
    edge_length: Option<Length>,
    /// Step in time, in squares of the edge length
    #[arg(long, help_heading = HEADING, value_name = "NUMBER", default_value_t = DEFAULT_TIME_STEP, allow_hyphen_values = true)]
    time_step: f64,
    /// The flow has come to its limit where no vertex moves by more than this in a step, in edge lengths
    #[arg(long, help_heading = HEADING, value_name = "NUMBER", default_value_t = DEFAULT_TOLERANCE, allow_hyphen_values = true)]
    tolerance: f64,
    /// What happens where the boundary runs into itself
    #[arg(long, help_heading = HEADING, value_enum, default_value_t = OnContactArg::Report)]
    on_contact: OnContactArg,
    /// What the flow may not remove
    #[arg(long, help_heading = HEADING, value_enum, default_value_t = BoundArg::Curvature)]
    bound: BoundArg,
    #[command(flatten)]
    outputs: OutputArgs,
    /// How to print the report: text goes to standard error, json to standard output
    #[arg(long, help_heading = "Output", value_enum, default_value_t = FormatArg::Text)]
    format: FormatArg,
}

/// `--op`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum OperationArg {
    /// Concave places become no sharper than the disk
    Close,
    /// Convex places become no sharper than the disk
    Open,
    /// Both at once
    Clopen,
}

/// `--on-contact`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum OnContactArg {
    /// It goes on, and the places are told
    Report,
    /// The flow stops there
    Stop,
}

/// `--bound`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum BoundArg {
    /// What is less curved than the disk
    Curvature,
    /// Nothing: every curve shrinks to a point, for comparison
    None,
}

/// Runs the command.
///
/// # Errors
/// Where the drawing cannot be read, an argument means nothing for it, or a result cannot be written.
pub(super) fn run(args: &FlowArgs) -> Result<ExitStatus> {
    args.flow.check(Some(&args.input))?;
    let bytes = read_bytes(&args.input)?;
    let parts = args.reading.read_parts_from(&bytes, &args.input, &args.selection.selection(), None)?;
    let area = |id: &String| {
        let area = args.reading.read_area(&bytes, &args.input, id).context("--pin-id")?;
        Ok((id.clone(), area))
    };
    let pins = args.pinned.iter().map(area).collect::<Result<Vec<_>>>()?;
    run_on(&parts, &pins, &args.flow)
}

/// Lets the outlines of what is chosen of a drawing flow, but for what lies in `pins`, and writes what is asked for. The
/// options have been [checked](FlowOptions::check).
///
/// # Errors
/// As [`run`].
pub(super) fn run_on(parts: &Parts, pins: &[(String, Region)], options: &FlowOptions) -> Result<ExitStatus> {
    let drawing = parts.chosen();
    let field = options.field.resolve(parts, pins)?;
    let [smallest, largest] = field.range();
    let edge = match options.edge_length {
        Some(length) => length.to_user_units(&parts.scale()).context("--edge-length")? / smallest.get(),
        None => DEFAULT_EDGE,
    };
    let settings = Settings {
        edge,
        time_step: options.time_step,
        tolerance: options.tolerance,
        on_contact: match options.on_contact {
            OnContactArg::Report => OnContact::Report,
            OnContactArg::Stop => OnContact::Stop,
        },
    };
    let start = || CurveFlow::new(&drawing.region, options.obstacle(), field.view(), &settings);
    let square = largest.get() * largest.get();
    let plan = Plan {
        frames: options.outputs.frame_count(),
        spacing: options.outputs.spacing(),
        until: options.time.map_or(f64::INFINITY, |t| t * square),
    };
    let recording = record::record(start, plan)?;
    let frames = recording.frames(square);
    let written = options.outputs.write(parts, &frames)?;
    let report = Report::new(drawing, options, field.range(), edge, &recording, &frames, written);
    match options.format {
        FormatArg::Text => {
            output::say(&report.lines());
            if options.outputs.plays() {
                output::say(
                    "the drawing on standard output plays all states, for looking at; --stills writes them exactly\n",
                );
            }
        }
        FormatArg::Json => output::print(&(serde_json::to_string_pretty(&report)? + "\n"))?,
    }
    Ok(if report.is_good() { ExitStatus::Done } else { ExitStatus::CheckFailed })
}

#[cfg(feature = "text")]
impl FlowOptions {
    /// A flow with everything that is not named here as it is unless told otherwise; its radius is still to come.
    pub(super) fn new(op: OperationArg, time: Option<f64>, outputs: OutputArgs, format: FormatArg) -> FlowOptions {
        FlowOptions {
            op: Some(op),
            field: FieldArgs::default(),
            time,
            edge_length: None,
            time_step: DEFAULT_TIME_STEP,
            tolerance: DEFAULT_TOLERANCE,
            on_contact: OnContactArg::Report,
            bound: BoundArg::Curvature,
            outputs,
            format,
        }
    }

    /// The same with this radius everywhere.
    pub(super) fn with_radius(self, radius: Length) -> FlowOptions {
        FlowOptions { field: FieldArgs::constant(radius), ..self }
    }
}

impl FlowOptions {
    /// Refuses what means nothing on any drawing; `input` is what is read, which may not be written over.
    ///
    /// # Errors
    /// Names the option and what to do.
    pub(super) fn check(&self, input: Option<&std::path::Path>) -> Result<()> {
        if let Some(time) = self.time.filter(|t| !(t.is_finite() && *t > 0.0)) {
            bail!(
                "--time {time}: give a number above zero, in squares of the radius; without it the flow goes to its limit"
            );
        }
        if self.op.is_none() && self.bound == BoundArg::Curvature {
            bail!("say with --op what the flow is to do: close, open or clopen");
        }
        self.outputs.check(input, self.format)
    }

    fn obstacle(&self) -> Obstacle {
        match (self.bound, self.op) {
            (BoundArg::None, _) | (_, None) => Obstacle::NONE,
            (_, Some(OperationArg::Close)) => Obstacle::CLOSING,
            (_, Some(OperationArg::Open)) => Obstacle::OPENING,
            (_, Some(OperationArg::Clopen)) => Obstacle::CLOPENING,
        }
    }
}
