//! `clopen surface check IN OUT -r R`.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::{Context as _, Result};
use clap::Args;

use super::MeshLength;
use super::work::read_polygons;
use crate::check::{self, SurfaceReport};
use crate::cli::check::{FormatArg, OperationArg};
use crate::cli::{ExitStatus, output};

/// The arguments.
#[derive(Clone, Debug, Args)]
pub(super) struct SurfaceCheckArgs {
    /// The mesh that was closed or opened
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// The result to check
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// Radius of the ball: in units of the mesh, or 2% (of the diagonal of its box)
    #[arg(short, long, value_name = "RADIUS", allow_hyphen_values = true)]
    radius: MeshLength,
    /// What was done to the input
    #[arg(long, value_enum, default_value = "close")]
    op: OperationArg,
    /// The edge length that errors are told in; a sixth of the radius unless given
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    edge_length: Option<MeshLength>,
    /// Largest accepted distance from the true result, in edge lengths
    #[arg(long, value_name = "NUMBER", default_value_t = 1.0, allow_hyphen_values = true)]
    tolerance: f64,
    /// How to print the report
    #[arg(long, value_enum, default_value = "text")]
    format: FormatArg,
}

/// Runs the command.
///
/// # Errors
/// Where a mesh cannot be read or is no surface.
pub(super) fn run(args: &SurfaceCheckArgs) -> Result<ExitStatus> {
    let [input, result] = [&args.input, &args.output].map(|path| read_polygons(path).map(|mesh| mesh.triangulated()));
    let (input, result) = (input?, result?);
    let diagonal = input.diagonal();
    let radius = args.radius.on(diagonal);
    let edge = args.edge_length.map_or(radius / 6.0, |e| e.on(diagonal));
    let report = check::surface(&input, &result, radius, args.op.into(), edge)
        .with_context(|| format!("{} and {}", args.input.display(), args.output.display()))?;
    let passes = report.contact.largest_over_h <= args.tolerance
        && report.containment.output_violation_over_h <= args.tolerance
        && report.self_intersections.output_pairs <= report.self_intersections.input_pairs;
    match args.format {
        FormatArg::Text => output::print(&lines(&report, args.tolerance, passes))?,
        FormatArg::Json => output::print(&(serde_json::to_string_pretty(&report)? + "\n"))?,
    }
    Ok(if passes { ExitStatus::Done } else { ExitStatus::CheckFailed })
}

fn lines(report: &SurfaceReport, tolerance: f64, passes: bool) -> String {
    let c = &report.contact;
    let mut text = String::new();
    let _ = writeln!(
        text,
        "contact error {:.4} h in the mean, at most {:.3} h too fat and {:.3} h unfilled (tolerance {tolerance} h)",
        c.mean_over_h, c.too_fat_over_h, c.unfilled_over_h
    );
    let _ = writeln!(text, "{}", serde_json::to_string(&report.containment).unwrap_or_default());
    let _ = writeln!(text, "{}", serde_json::to_string(&report.kept).unwrap_or_default());
    let _ = writeln!(text, "{}", serde_json::to_string(&report.quality).unwrap_or_default());
    let _ = writeln!(text, "{}", serde_json::to_string(&report.curvature).unwrap_or_default());
    let _ = writeln!(text, "{}", serde_json::to_string(&report.topology).unwrap_or_default());
    let _ = writeln!(text, "self-intersecting pairs of faces: {}", report.self_intersections.output_pairs);
    text += if passes { "passed\n" } else { "FAILED\n" };
    text
}
