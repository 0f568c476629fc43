//! `clopen check IN OUT -r R`: any result against its reference.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::{Context as _, Result, bail};
use clap::{Args, ValueEnum};

use super::close::TopologyArg;
use super::input::ReadArgs;
use super::{ExitStatus, output};
use crate::check::{Report, compare};
use crate::io::svg::ReadError;
use crate::plane::Region;
use crate::reference::{self, Operation};
use crate::units::{DrawingScale, Length, Radius};

/// The default of `--tolerance`, in radii: ten times what a sampled reference shows, a thousandth of a common cutter's runout.
pub const DEFAULT_TOLERANCE: f64 = 1e-4;

/// Compares a result with the closing or opening of its input, computed independently by polygon offsetting.
#[derive(Clone, Debug, Args)]
pub struct CheckArgs {
    /// The drawing that was closed or opened
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    /// The result to check
    #[arg(value_name = "OUT")]
    pub output: PathBuf,
    /// Radius of the disk: 2mm, 0.125in, 3px, 5u (user units) or 2% (of the diagonal); a bare number is millimetres
    #[arg(short, long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub radius: Length,
    /// What was done to the input
    #[arg(long, value_enum, default_value = "close")]
    pub op: OperationArg,
    /// What the result was meant to do where components meet or holes fill: with keep, what lies within two radii of a
    /// change of topology does not count
    #[arg(long, value_enum, default_value_t = TopologyArg::Merge)]
    topology: TopologyArg,
    /// Largest accepted distance to the reference, and depth of a violated containment, in radii
    #[arg(long, value_name = "RADII", default_value_t = DEFAULT_TOLERANCE, allow_hyphen_values = true)]
    pub tolerance: f64,
    /// How to print the report
    #[arg(long, value_enum, default_value = "text")]
    pub format: FormatArg,
    #[command(flatten)]
    reading: ReadArgs,
}

/// `--op`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum OperationArg {
    /// Closing
    Close,
    /// Opening
    Open,
}

impl From<OperationArg> for Operation {
    fn from(arg: OperationArg) -> Operation {
        match arg {
            OperationArg::Close => Operation::Close,
            OperationArg::Open => Operation::Open,
        }
    }
}

/// `--format`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FormatArg {
    /// Lines of text
    Text,
    /// One JSON object with units in the names of its fields
    Json,
}

/// A report in its printed form, and whether it passes.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What goes to standard output.
    pub text: String,
    /// Whether the exit status is 0, or else 1.
    pub passes: bool,
}

/// The command. An error is exit status 2.
///
/// # Errors
/// Where a file cannot be read, the radius makes no sense for the drawing, or no reference is certified.
pub(super) fn run(args: &CheckArgs) -> Result<ExitStatus> {
    let input = args.reading.read(&args.input)?;
    let output = match args.reading.read_alike(&args.output, &input) {
        Ok(drawing) => drawing.region,
        // A result may well be empty: then nothing is what there is to check.
        Err(error) if matches!(error.downcast_ref(), Some(ReadError::NothingFilled { .. })) => Region::default(),
        Err(error) => return Err(error),
    };
    let outcome = check(args, &input.region, input.mm_per_unit, &output)?;
    output::print(&outcome.text)?;
    Ok(if outcome.passes { ExitStatus::Done } else { ExitStatus::CheckFailed })
}

/// The command after its files were read.
///
/// # Errors
/// As [`run`], but for the files.
fn check(args: &CheckArgs, input: &Region, mm_per_unit: Option<f64>, output: &Region) -> Result<Outcome> {
    if !(args.tolerance >= 0.0 && args.tolerance.is_finite()) {
        bail!("--tolerance {} is no distance: give a number of radii, for example 1e-4", args.tolerance);
    }
    let scale = DrawingScale { mm_per_unit, diagonal: input.bounds().diagonal() };
    let radius = Radius::new(args.radius.to_user_units(&scale)?).context("--radius")?;
    let operation = args.op.into();
    let reference = reference::closing(input, radius, operation)
        .with_context(|| format!("{}: no reference", args.input.display()))?;
    let report = compare(input, output, &reference, radius, operation);
    let passes = report.passes(args.tolerance, args.topology == TopologyArg::Keep);
    let text = match args.format {
        FormatArg::Text => lines(&report, args.tolerance, args.topology, passes),
        FormatArg::Json => serde_json::to_string_pretty(&report)? + "\n",
    };
    Ok(Outcome { text, passes })
}

/// The report in words.
fn lines(report: &Report, tolerance: f64, topology: TopologyArg, passes: bool) -> String {
    let mut text = String::new();
    let mut line = |label: &str, value: String| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{label:<22}{value}");
    };
    // As SVG counts and as `clopen close` names places: y down.
    let at = |place: Option<crate::check::Place>| {
        place.map_or(String::new(), |p| format!(" at ({:.6}, {:.6})", p.x, 0.0 - p.y))
    };
    let r = report.radius_units;
    line("radius", format!("{r} user units"));
    line(
        "reference",
        format!("{:?}, certified to {:.1e} r", report.reference_method, report.reference_error_units / r)
            .to_lowercase(),
    );
    if report.reference_radius_units != r {
        line("", "for a radius smaller by 1e-8: the drawing has gaps of exactly 2 r".to_owned());
    }
    let h = &report.hausdorff;
    line("distance", format!("{:.3e} r ({:.3e} user units){}", h.largest_over_r, h.largest_over_r * r, at(h.place)));
    if report.topological_pieces > 0 {
        let h = &report.hausdorff_where_topology_agrees;
        let pieces = report.topological_pieces;
        let noun = if pieces == 1 { "place changes" } else { "places change" };
        line(
            "topology",
            format!("{pieces} {noun} it; elsewhere the distance is {:.3e} r{}", h.largest_over_r, at(h.place)),
        );
    }
    line("mean difference", format!("{:.3e} r", report.area.mean_difference_over_r));
    let c = &report.containment;
    line("containment", format!("violated by {:.3e} r{}", c.violation_over_r, at(c.place)));
    let k = &report.kept;
    line("kept vertices", format!("{} of {} ({:.2} %)", k.found, k.still_vertices, 100.0 * k.fraction));
    let count = |t: crate::plane::TopologyCount| format!("{} + {}", t.components, t.holes);
    let t = &report.topology;
    line(
        "components + holes",
        format!("input {}, output {}, reference {}", count(t.input), count(t.output), count(t.reference)),
    );
    match &report.smallest_radius {
        Some(s) => line("smallest radius", format!("{:.6} r{}", s.radius_over_r, at(Some(s.place)))),
        None => line("smallest radius", "not below r".to_owned()),
    }
    if !passes && topology == TopologyArg::Merge && report.passes(tolerance, true) {
        line(
            "",
            "where topology agrees it passes: --topology keep accepts that, as clopen close does by default".to_owned(),
        );
    }
    if !passes && topology == TopologyArg::Keep && report.containment.violation_over_r <= tolerance {
        line(
            "",
            "the reference merges: where clopen close or open said that --topology merge would differ, this is meant"
                .to_owned(),
        );
    }
    let meant = if topology == TopologyArg::Keep { ", where topology agrees" } else { "" };
    let verdict = if passes { "passes" } else { "fails" };
    line("verdict", format!("{verdict} at a tolerance of {tolerance:e} r{meant}"));
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::{Point, Ring};

    fn args() -> CheckArgs {
        use clap::Parser as _;
        #[derive(clap::Parser)]
        struct Typed {
            #[command(flatten)]
            args: CheckArgs,
        }
        Typed::parse_from(["check", "in.svg", "out.svg", "-r", "1u"]).args
    }

    fn l_corner() -> Region {
        let points = [(0., 0.), (9., 0.), (9., 3.), (3., 3.), (3., 9.), (0., 9.)];
        Region::new(vec![Ring::polygon(points.map(|(x, y)| Point::new(x, y)))])
    }

    #[test]
    fn a_right_result_passes_and_an_untouched_one_fails() {
        let closed = reference::closing(&l_corner(), Radius::new(1.0).unwrap(), Operation::Close).unwrap().region;
        let right = check(&args(), &l_corner(), None, &closed).unwrap();
        assert!(right.passes, "{}", right.text);
        let untouched = check(&args(), &l_corner(), None, &l_corner()).unwrap();
        assert!(
            !untouched.passes && untouched.text.contains("smallest radius       0.000000 r at (3.000000, -3.000000)"),
            "{}",
            untouched.text
        );
    }

    #[test]
    fn json_names_its_units_and_bad_numbers_are_refused() {
        let json = CheckArgs { format: FormatArg::Json, ..args() };
        let text = check(&json, &l_corner(), None, &l_corner()).unwrap().text;
        let value: serde_json::Value = serde_json::from_str(&text).unwrap();
        let distance = value["hausdorff"]["largest_over_r"].as_f64().unwrap();
        assert!((distance - (2f64.sqrt() - 1.0)).abs() < 1e-9, "{distance}");
        let bad = CheckArgs { tolerance: f64::NAN, ..args() };
        assert!(check(&bad, &l_corner(), None, &l_corner()).is_err());
        let physical = CheckArgs { radius: Length::Millimetres(1.0), ..args() };
        assert!(check(&physical, &l_corner(), None, &l_corner()).is_err());
    }
}
