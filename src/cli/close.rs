//! `clopen close` and `clopen open`: exact 2D morphology, SVG to SVG.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use clap::{Args, ValueEnum};

use super::ExitStatus;
use super::check::FormatArg;
use super::input::ReadArgs;
use super::output;
use crate::io::svg;
use crate::plane::{Point, Region, TopologyCount};
use crate::rolling::{self, Outcome, Topology};
use crate::units::{Length, Radius};

/// The arguments of both commands.
#[derive(Clone, Debug, Args)]
pub(super) struct CloseArgs {
    /// The drawing, SVG; - is standard input
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Radius of the disk: 2mm, 0.125in, 3px, 5u (user units) or 2% (of the diagonal); a bare number is millimetres
    #[arg(short, long, value_name = "LENGTH", allow_hyphen_values = true)]
    radius: Length,
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

/// Which of the two.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Operation {
    Close,
    Open,
}

/// What was done, for people and for programs. Lengths are user units of the drawing.
#[derive(Debug, serde::Serialize)]
struct Report {
    operation: Operation,
    topology: Topology,
    radius_units: f64,
    radius_mm: Option<f64>,
    vertices_in: usize,
    vertices_kept: usize,
    vertices_out: usize,
    area_in_square_units: f64,
    area_out_square_units: f64,
    topology_in: TopologyCount,
    topology_out: TopologyCount,
    /// Places where keeping and merging differ (keep), or where parts were bridged (merge); x right, y down as in SVG.
    places_units: Vec<[f64; 2]>,
    proved: bool,
}

/// Runs either command.
///
/// # Errors
/// Where the drawing cannot be read, the radius means nothing for it, or the result cannot be written.
pub(super) fn run(args: &CloseArgs, operation: Operation) -> Result<ExitStatus> {
    let to_stdout = args.output.as_deref().is_none_or(|p| p == Path::new("-"));
    if args.format == FormatArg::Json && to_stdout {
        bail!("--format json prints the report on standard output, where the drawing would go: add -o OUT.svg");
    }
    let target = args.output.clone().unwrap_or_else(|| PathBuf::from("-"));
    output::keep_input(&args.input, &target)?;
    let drawing = args.reading.read(&args.input)?;
    let units = args.radius.to_user_units(&drawing.scale()).context("--radius")?;
    let radius = Radius::new(units).context("--radius")?;
    refuse_absurd(radius, args.radius, "--radius", drawing.region.bounds().diagonal())?;
    let topology = args.topology.into();
    let outcome = match operation {
        Operation::Close => rolling::close(&drawing.region, radius, topology),
        Operation::Open => rolling::open(&drawing.region, radius, topology),
    };
    let text = svg::write(&drawing, &outcome.region);
    output::write(&target, text.as_bytes())?;
    let report = Report::new(operation, topology, radius, drawing.mm_per_unit, &drawing.region, &outcome);
    match args.format {
        FormatArg::Text => output::say(&report.lines()),
        FormatArg::Json => output::print(&(serde_json::to_string_pretty(&report)? + "\n"))?,
    }
    if outcome.region.is_empty() {
        output::say("clopen: nothing is left: the disk fits nowhere; try a smaller radius\n");
    }
    Ok(if report.proved { ExitStatus::Done } else { ExitStatus::CheckFailed })
}

/// Refuses radii that are slips of the unit: beyond them coordinates do not tell the disk from a point or a line.
///
/// # Errors
/// Names the option.
pub(super) fn refuse_absurd(radius: Radius, typed: Length, option: &str, diagonal: f64) -> Result<()> {
    const SMALLEST: f64 = 1e-6;
    const LARGEST: f64 = 1e3;
    let relative = radius.get() / diagonal;
    if !(SMALLEST..=LARGEST).contains(&relative) {
        bail!(
            "{option} {typed} is {relative:.1e} of the drawing's diagonal ({diagonal:.4} user units): is the unit right? \
             2% means two hundredths of the diagonal"
        );
    }
    Ok(())
}

impl Report {
    fn new(
        operation: Operation,
        topology: Topology,
        radius: Radius,
        mm_per_unit: Option<f64>,
        input: &Region,
        outcome: &Outcome,
    ) -> Report {
        let kept = outcome.region.rings.iter().flat_map(|r| &r.vertices).filter(|v| v.id.is_some()).count();
        Report {
            operation,
            topology,
            radius_units: radius.get(),
            radius_mm: mm_per_unit.map(|mm| mm * radius.get()),
            vertices_in: input.vertex_count(),
            vertices_kept: kept,
            vertices_out: outcome.region.vertex_count(),
            area_in_square_units: input.area(),
            area_out_square_units: outcome.region.area(),
            topology_in: input.topology(),
            topology_out: outcome.region.topology(),
            places_units: spread(&outcome.differences, 2.0 * radius.get()).iter().map(|p| [p.x, -p.y]).collect(),
            proved: outcome.contradictions == 0,
        }
    }

    fn lines(&self) -> String {
        let name = match self.operation {
            Operation::Close => "closed",
            Operation::Open => "opened",
        };
        let mm = self.radius_mm.map_or(String::new(), |mm| format!(" ({mm:.4} mm)"));
        let count = |t: &TopologyCount| format!("{} + {}", t.components, t.holes);
        let mut text = format!(
            "{name} by {:.6} user units{mm}: {} of {} vertices kept bit for bit, area {:+.4} %, parts + holes {} -> {}\n",
            self.radius_units,
            self.vertices_kept,
            self.vertices_in,
            100.0 * (self.area_out_square_units / self.area_in_square_units - 1.0),
            count(&self.topology_in),
            count(&self.topology_out),
        );
        if !self.places_units.is_empty() {
            const SHOWN: usize = 5;
            let places: Vec<String> =
                self.places_units.iter().take(SHOWN).map(|[x, y]| format!("({x:.2}, {y:.2})")).collect();
            let more = self.places_units.len().saturating_sub(SHOWN);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            let what = match self.topology {
                Topology::Keep => "--topology merge would differ near",
                Topology::Merge => "the disk bridges distant boundary (where --topology keep may differ) near",
            };
            text += &format!("{what} {}{more}\n", places.join(" "));
        }
        if !self.proved {
            text += match self.topology {
                Topology::Keep => {
                    "NOT PROVED: outlines come too near to each other to be kept apart; --topology merge has an answer\n"
                }
                Topology::Merge => {
                    "NOT PROVED: rounding left contradictions; compare with clopen check, or change the radius slightly\n"
                }
            };
        }
        text
    }
}

/// Places at least `apart` from each other that stand for all of them.
pub(super) fn spread(places: &[Point], apart: f64) -> Vec<Point> {
    let mut kept: Vec<Point> = vec![];
    // Those that are kept, by squares of that side: only the nine about a place can hold one that is near it.
    let mut squares: HashMap<(i64, i64), Vec<Point>> = HashMap::new();
    for p in places {
        let (x, y) = ((p.x / apart).floor() as i64, (p.y / apart).floor() as i64);
        let about = (-1..=1).flat_map(|i| (-1..=1).map(move |j| (x.saturating_add(i), y.saturating_add(j))));
        if about.filter_map(|square| squares.get(&square)).flatten().all(|q| (p - q).norm() >= apart) {
            kept.push(*p);
            squares.entry((x, y)).or_default().push(*p);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_that_are_kept_stand_for_all() {
        let places: Vec<Point> =
            (0..5_000).map(|k| f64::from(k) * 2.399_963).map(|a| Point::new(a.cos(), a.sin()) * a.sqrt()).collect();
        let kept = spread(&places, 7.0);
        assert!(kept.len() > 50);
        for (i, p) in kept.iter().enumerate() {
            assert!(kept[..i].iter().all(|q| (p - q).norm() >= 7.0));
        }
        for p in &places {
            assert!(kept.iter().any(|q| (p - q).norm() < 7.0), "{p}");
        }
    }
}
