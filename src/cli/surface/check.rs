//! `clopen surface check IN OUT -r R`.

use std::path::PathBuf;

use anyhow::{Context as _, Result};
use clap::Args;

use super::MeshLength;
use super::digits::{Places, count, number};
use super::work::{keep_edge, keep_radius, keep_size, longest_edge, read_polygons};
use crate::check::{self, SurfacePlace, SurfaceReport};
use crate::cli::check::{FormatArg, OperationArg};
use crate::cli::{ExitStatus, output};
use crate::reference::Operation;

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
    /// The edge length that errors are told in; a sixth of the radius, and at most a fortieth of the diagonal, unless given
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    edge_length: Option<MeshLength>,
    /// Largest accepted distance from the true result, in edge lengths
    #[arg(long, value_name = "NUMBER", default_value = "1", value_parser = tolerance, allow_hyphen_values = true)]
    tolerance: f64,
    /// Judge only what moved. Without it, what was left undone where nothing moved counts as well: a result in which nothing was done
    /// fails. For results with pins, regions or radii that vary, where places stay on purpose. (Where the
    /// radius eases near a pin, what moved is still held against the full ball)
    #[arg(long)]
    moved_only: bool,
    /// How to print the report
    #[arg(long, value_enum, default_value = "text")]
    format: FormatArg,
}

/// `--tolerance`.
fn tolerance(text: &str) -> Result<f64, String> {
    let is_tolerance = |x: &f64| x.is_finite() && *x > 0.0;
    let found = text.trim().parse().ok().filter(is_tolerance);
    found.ok_or_else(|| "it must be a finite number above zero: 1 is an edge length".to_owned())
}

/// Runs the command.
///
/// # Errors
/// Where a mesh cannot be read or is no surface.
pub(super) fn run(args: &SurfaceCheckArgs) -> Result<ExitStatus> {
    let [input, result] = [&args.input, &args.output].map(|path| read_polygons(path).map(|mesh| mesh.triangulated()));
    let (input, result) = (input?, result?);
    let diagonal = input.diagonal();
    keep_size(&args.input, diagonal)?;
    keep_size(&args.output, result.diagonal())?;
    let radius = args.radius.on(diagonal);
    keep_radius(&args.input, radius, diagonal)?;
    let edge = args.edge_length.map_or((radius / 6.0).min(longest_edge(diagonal)), |e| e.on(diagonal));
    keep_edge(edge, radius, diagonal)?;
    let report = check::surface(&input, &result, radius, args.op.into(), edge)
        .with_context(|| format!("{} and {}", args.input.display(), args.output.display()))?;
    let failures = failures(&report, args);
    match args.format {
        FormatArg::Text => output::print(&lines(&report, args, &failures, Places::on(diagonal)))?,
        FormatArg::Json => {
            let judged = Judged { passed: failures.is_empty(), failures: &failures, report: &report };
            output::print(&(serde_json::to_string_pretty(&judged)? + "\n"))?;
        }
    }
    Ok(if failures.is_empty() { ExitStatus::Done } else { ExitStatus::CheckFailed })
}

/// The verdict and what it stands on, as JSON.
#[derive(serde::Serialize)]
struct Judged<'a> {
    passed: bool,
    failures: &'a [&'static str],
    #[serde(flatten)]
    report: &'a SurfaceReport,
}

/// Why the result does not pass.
fn failures(report: &SurfaceReport, args: &SurfaceCheckArgs) -> Vec<&'static str> {
    let SurfaceReport { contact, containment, whole, self_intersections: crossings, .. } = report;
    let (before, after) = (&report.topology.input, &report.topology.output);
    // What has borders has no inside that all of the input could lie in.
    let is_closed = before.boundary_loops == 0;
    let reasons = [
        (contact.largest_over_h > args.tolerance, "what moved is off"),
        (
            contact.in_doubt_over_h > args.tolerance,
            "where it moved a gap is too nearly as wide as the ball to tell whether it is filled",
        ),
        (
            contact.unfilled_where_kept_over_h > args.tolerance && !args.moved_only,
            "something was left undone where nothing moved (meant so, by pins or regions? --moved-only judges only what moved)",
        ),
        (
            contact.uncertain_where_kept_over_h > args.tolerance && !args.moved_only,
            "where nothing moved a gap is too nearly as wide as the ball to tell whether something was left undone",
        ),
        (containment.output_violation_over_h > args.tolerance, "containment is violated"),
        (
            containment.input_violation_over_h > args.tolerance && is_closed && whole.missing_over_h <= args.tolerance,
            "part of the input is not covered",
        ),
        (whole.missing_over_h > args.tolerance, "part of the surface that had to stay is missing"),
        (whole.inside_out, "the result is inside out"),
        (
            whole.turned_area_over_h2 > args.tolerance * args.tolerance && !whole.inside_out,
            "faces that did not move are turned over",
        ),
        (whole.new_border_edges > 0, "there are borders where the input has none"),
        (whole.doubled_faces_out > whole.doubled_faces_in, "faces are there twice"),
        (
            after.nonmanifold_edges > before.nonmanifold_edges,
            "more edges than before are not between two faces that run alike",
        ),
        (crossings.output_pairs > crossings.input_pairs, "more faces cross each other than before"),
    ];
    reasons.into_iter().filter(|(holds, _)| *holds).map(|(_, why)| why).collect()
}

/// The report for people.
fn lines(report: &SurfaceReport, args: &SurfaceCheckArgs, failures: &[&str], places: Places) -> String {
    let SurfaceReport { contact: c, containment, whole, kept, quality, curvature, .. } = report;
    let at = |place: Option<SurfacePlace>| place.map_or(String::new(), |place| format!(" at {}", places.show(place)));
    let (before, after) = (&report.topology.input, &report.topology.output);
    // An opening is measured as the closing of what is around the solid.
    let [fat, unfilled, within, without] = match report.operation {
        Operation::Close => ["too fat", "unfilled", "inside", "outside"],
        Operation::Open => ["too thin", "not removed", "outside", "inside"],
    };
    let crossings = &report.self_intersections;
    let mut lines = vec![
        format!(
            "h is {} and the radius {}; {} h are tolerated",
            number(report.edge_length_units),
            number(report.radius_units),
            args.tolerance
        ),
        format!(
            "contact error where it moved: {:.4} h in the mean, at most {:.3} h {fat}{} and {:.3} h {unfilled}{}; {:.1} % of the area moved",
            c.mean_over_h,
            c.too_fat_over_h,
            at(c.too_fat_place),
            c.unfilled_over_h,
            at(c.unfilled_place),
            100.0 * c.moved_area_share.abs()
        ) + &match c.in_doubt_place {
            Some(place) => format!("; cannot tell to {:.3} h at {}", c.in_doubt_over_h, places.show(place)),
            None => String::new(),
        },
        format!(
            "left undone where nothing moved: at most {:.3} h{}, known to {:.3} h{}",
            c.unfilled_where_kept_over_h,
            at(c.unfilled_where_kept_place),
            c.uncertain_where_kept_over_h,
            if args.moved_only { " (not judged)" } else { "" }
        ),
        format!(
            "containment: the result is at most {:.3} h {within} the input{}; the input at most {:.3} h {without} the result{}",
            containment.output_violation_over_h,
            at(containment.output_place),
            containment.input_violation_over_h,
            at(containment.input_place)
        ),
        format!(
            "what had to stay: the result is at most {:.3} h away from it{}; {} over{}, {}{}, {} twice",
            whole.missing_over_h,
            at(whole.missing_place),
            count(whole.turned_faces, "face is turned", "faces are turned"),
            at(whole.turned_place),
            count(whole.new_border_edges, "new border edge", "new border edges"),
            at(whole.new_border_place),
            count(whole.doubled_faces_out, "face is there", "faces are there")
        ),
        format!(
            "kept bit for bit: {} of {} ({} of the {} that need not move) and {} of {}",
            kept.vertices_found,
            count(kept.input_vertices, "vertex", "vertices"),
            kept.still_vertices_found,
            kept.still_vertices,
            kept.faces_found,
            count(kept.input_faces, "triangle", "triangles")
        ),
    ];
    if quality.moved_faces > 0 {
        lines.push(format!(
            "triangles that moved: {}, smallest angle {:.2} degrees{}, in the mean {:.1}; edges of {:.2} h in the mean",
            quality.moved_faces,
            quality.smallest_angle_degrees,
            at(quality.smallest_angle_place),
            quality.mean_smallest_angle_degrees,
            quality.mean_edge_over_h
        ));
    }
    if curvature.moved_vertices > 0 {
        // A closing bounds the curvature from below.
        let sign = if report.operation == Operation::Close { 1.0 } else { -1.0 };
        lines.push(format!(
            "curvature of {} that moved: {:.2} % beyond 1.1/r, {:.2} % beyond 1.5/r, the farthest {:.2}/r ({:.0}/r is the bound)",
            count(curvature.moved_vertices, "vertex", "vertices"),
            100.0 * curvature.share_below_1_1,
            100.0 * curvature.share_below_1_5,
            sign * curvature.least_times_r,
            -sign
        ));
    }
    lines.push(format!(
        "topology: {} -> {} vertices, {} -> {} triangles, {} -> {} parts, {} -> {} borders, Euler characteristic {} -> {}, \
         {} -> {} edges that are not between two faces",
        before.vertices,
        after.vertices,
        before.faces,
        after.faces,
        before.components,
        after.components,
        before.boundary_loops,
        after.boundary_loops,
        before.euler_characteristic,
        after.euler_characteristic,
        before.nonmanifold_edges,
        after.nonmanifold_edges
    ));
    lines.push(format!("self-intersecting pairs of faces: {} -> {}", crossings.input_pairs, crossings.output_pairs));
    lines.push(match failures {
        [] => "passed".to_owned(),
        _ => format!("FAILED: {}", failures.join("; ")),
    });
    lines.join("\n") + "\n"
}
