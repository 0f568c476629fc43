//! `clopen close` and `clopen open`: exact 2D morphology, SVG to SVG.

mod report;
mod work;

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::{Args, ValueEnum};

use super::check::FormatArg;
use super::input::{ReadArgs, SelectionArgs};
use super::{ExitStatus, output};
use crate::plane::Region;
use crate::rolling::Topology;
use crate::units::Length;
pub(super) use report::{Done, Operation, Report, spread};
pub(super) use work::{Work, refuse_absurd};

/// The arguments of `close`, `open` and, with some more, of `clopen`.
#[derive(Clone, Debug, Args)]
pub(super) struct CloseArgs {
    /// The drawing, SVG; - is standard input
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Radius of the disk: 2mm, 0.125in, 3px, 5u (user units) or 2% (of the diagonal); a bare number is millimetres
    #[arg(short, long, value_name = "LENGTH", allow_hyphen_values = true)]
    radius: Length,
    /// Roll an ellipse in place of the disk: its half axis along --angle is the radius, the other one is the radius
    /// divided by this number
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true)]
    aspect: Option<f64>,
    /// Direction of the ellipse's half axis of the given radius, in degrees counterclockwise from the x axis as seen on
    /// the page [default: 0]
    #[arg(long, value_name = "DEGREES", requires = "aspect", allow_hyphen_values = true)]
    angle: Option<f64>,
    /// Where the result goes, SVG; standard output unless given
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// What happens where parts come near each other
    #[arg(long, value_enum, default_value_t = TopologyArg::Keep)]
    topology: TopologyArg,
    /// How to print the report: text goes to standard error, json to standard output
    #[arg(long, value_enum, default_value_t = FormatArg::Text)]
    format: FormatArg,
    #[command(flatten)]
    selection: SelectionArgs,
    #[command(flatten)]
    reading: ReadArgs,
}

/// `--topology`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum TopologyArg {
    /// The morphological result, as a cutter sees it: parts merge, holes fill, necks break
    Merge,
    /// Every outline by itself, measured along the curve: the limit of the curvature flow
    Keep,
}

impl From<TopologyArg> for Topology {
    fn from(arg: TopologyArg) -> Topology {
        match arg {
            TopologyArg::Merge => Topology::Merge,
            TopologyArg::Keep => Topology::Keep,
        }
    }
}

/// Runs `close` or `open`.
///
/// # Errors
/// Where the drawing cannot be read, the radius means nothing for it, or the result cannot be written.
pub(super) fn run(args: &CloseArgs, operation: Operation) -> Result<ExitStatus> {
    args.run(|work| {
        let done = Done::from(work.apply(operation, work.region()));
        let report = Report::new(operation, work, &done);
        Ok((done.region, report))
    })
}

impl CloseArgs {
    /// Reads the drawing, has the work done, writes its result and prints its report.
    pub(super) fn run(&self, work: impl FnOnce(&Work) -> Result<(Region, Report)>) -> Result<ExitStatus> {
        let to_stdout = self.output.as_deref().is_none_or(|p| p == Path::new("-"));
        if self.format == FormatArg::Json && to_stdout {
            bail!("--format json prints the report on standard output, where the drawing would go: add -o OUT.svg");
        }
        let target = self.output.clone().unwrap_or_else(|| PathBuf::from("-"));
        output::keep_input(&self.input, &target)?;
        let prepared = Work::new(self)?;
        let (region, report) = work(&prepared)?;
        output::write(&target, prepared.svg(&region).as_bytes())?;
        match self.format {
            FormatArg::Text => output::say(&report.lines()),
            FormatArg::Json => output::print(&(serde_json::to_string_pretty(&report)? + "\n"))?,
        }
        if region.is_empty() {
            output::say("clopen: nothing is left: the disk fits nowhere; try a smaller radius\n");
        }
        Ok(if report.proved { ExitStatus::Done } else { ExitStatus::CheckFailed })
    }
}
