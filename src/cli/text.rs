//! `clopen text "Quartz" --font F.ttf`: a line of text, closed or opened, by the rolling disk or by the flow in time.

use std::path::PathBuf;

use anyhow::Result;
use clap::{Args, ValueEnum};

use super::ExitStatus;
use super::check::FormatArg;
use super::close::TopologyArg;
use super::flow::StateArgs;
use crate::preview::DEFAULT_SIZE;
use crate::units::{FontLength, Length};

/// The arguments.
#[derive(Clone, Debug, Args)]
// Without shaping nobody reads them.
#[cfg_attr(not(feature = "text"), allow(dead_code))]
pub(super) struct TextArgs {
    /// The text, one line
    #[arg(value_name = "TEXT")]
    text: String,
    #[command(flatten)]
    style: StyleArgs,
    /// The font, TrueType or OpenType
    #[arg(long, value_name = "FILE")]
    font: PathBuf,
    /// Where the drawing goes, SVG in font units; standard output unless given
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// How large an em is on the page
    #[arg(long, value_name = "LENGTH", default_value_t = Length::Millimetres(100.0), allow_hyphen_values = true)]
    size: Length,
    /// Which font of a collection, from 0
    #[arg(long, value_name = "NUMBER")]
    index: Option<u32>,
    /// How to print the report: text goes to standard error, json to standard output
    #[arg(long, value_enum, default_value_t = FormatArg::Text)]
    format: FormatArg,
    /// Let the letters flow, and stop at this time, in squares of the radius; right corners are round by 0.3
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, help_heading = "States on the way")]
    time: Option<f64>,
    /// Pixels: the width of the contact sheet, the long side of the animated PNG
    #[arg(long, value_name = "PIXELS", default_value_t = DEFAULT_SIZE, help_heading = "States on the way")]
    pixels: u32,
    #[command(flatten)]
    states: StateArgs,
}

/// What is done to letters.
#[derive(Clone, Copy, Debug, Args)]
pub(super) struct StyleArgs {
    /// What to do to the letters
    #[arg(long, value_enum, default_value_t = StyleOp::Open)]
    pub(super) op: StyleOp,
    /// Radius of the disk: 30u or 30 (font units), 40em/1000 (thousandths of the em) or 0.04em
    #[arg(short, long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub(super) radius: FontLength,
    /// What happens where parts of a letter come near each other
    #[arg(long, value_enum, default_value_t = TopologyArg::Keep)]
    pub(super) topology: TopologyArg,
}

/// `--op`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum StyleOp {
    /// Round the corners of letters, melt their serifs
    Open,
    /// Fill the corners between strokes
    Close,
    /// Close, and open what came of it: both kinds of corners
    Clopen,
}

#[cfg(not(feature = "text"))]
pub(super) fn run(_: &TextArgs) -> Result<ExitStatus> {
    anyhow::bail!("this build sets no text: build clopen with its feature \"text\", which is on by default");
}

#[cfg(feature = "text")]
pub(super) use with_text::run;

#[cfg(feature = "text")]
mod with_text {
    use std::path::Path;

    use anyhow::{Context as _, bail};

    use super::*;
    use crate::cli::flow::{self, FlowOptions, OperationArg, OutputArgs};
    use crate::cli::{input, output};
    use crate::io::font::{self, Face, Sampling};
    use crate::io::svg::{self, Drawing, Parts};
    use crate::plane::{Region, TopologyCount};
    use crate::rolling::{self, Outcome};
    use crate::units::Radius;

    impl StyleArgs {
        /// What becomes of `region` by a disk of `radius`.
        pub(in crate::cli) fn apply(&self, region: &Region, radius: Radius) -> Outcome {
            let topology = self.topology.into();
            match self.op {
                StyleOp::Open => rolling::open(region, radius, topology),
                StyleOp::Close => rolling::close(region, radius, topology),
                StyleOp::Clopen => {
                    let closed = rolling::close(region, radius, topology);
                    let mut opened = rolling::open(&closed.region, radius, topology);
                    opened.differences.splice(0..0, closed.differences);
                    opened.contradictions += closed.contradictions;
                    opened
                }
            }
        }
    }

    impl TextArgs {
        /// What the flow is to do, where states on the way are asked for; the disk knows none.
        ///
        /// # Errors
        /// Names the option that means nothing for a flow.
        fn flow(&self) -> anyhow::Result<Option<FlowOptions>> {
            if self.time.is_none() && !self.states.is_asked_for() {
                return Ok(None);
            }
            if self.style.topology == TopologyArg::Merge {
                bail!(
                    "--topology merge is for the rolling disk, and the flow knows every outline by itself: leave it out, or \
                     --time, --frames and pictures of states"
                );
            }
            let op = match self.style.op {
                StyleOp::Open => OperationArg::Open,
                StyleOp::Close => OperationArg::Close,
                StyleOp::Clopen => OperationArg::Clopen,
            };
            let outputs = OutputArgs { output: self.output.clone(), size: self.pixels, states: self.states.clone() };
            let options = FlowOptions::new(op, self.time, outputs, self.format);
            options.check(Some(&self.font))?;
            Ok(Some(options))
        }

        /// The text as a drawing in font units, and the radius in them.
        fn set(&self, em_mm: f64) -> anyhow::Result<(Drawing, Radius, f64)> {
            let name = || self.font.display().to_string();
            let bytes = input::read_bytes(&self.font)?;
            let face = Face::parse(&bytes, self.index).with_context(name)?;
            let units = self.style.radius.to_units(face.units_per_em());
            let radius = font::check_radius(units, face.units_per_em()).context("--radius")?;
            let sampling = Sampling::new(face.units_per_em(), radius.get());
            let drawing = font::line(&face, &self.text, sampling, em_mm).with_context(name)?;
            Ok((drawing, radius, face.units_per_em()))
        }
    }

    /// What was done, for people and for programs.
    #[derive(Debug, serde::Serialize)]
    struct Report<'a> {
        text: &'a str,
        operation: StyleOp,
        radius_font_units: f64,
        units_per_em: f64,
        em_mm: f64,
        vertices_in: usize,
        vertices_kept: usize,
        vertices_out: usize,
        area_in_square_font_units: f64,
        area_out_square_font_units: f64,
        topology_in: TopologyCount,
        topology_out: TopologyCount,
        proved: bool,
    }

    /// Runs the command.
    ///
    /// # Errors
    /// Where the font cannot be read, lacks characters, or the result cannot be written.
    pub(in crate::cli) fn run(args: &TextArgs) -> Result<ExitStatus> {
        let em_mm = input::millimetres(args.size, "--size")?;
        if em_mm <= 0.0 {
            bail!("--size is {}: it must be above zero", args.size);
        }
        if let Some(options) = args.flow()? {
            let (drawing, radius, _) = args.set(em_mm)?;
            return flow::run_on(&Parts::from(drawing), &[], &options.with_radius(Length::UserUnits(radius.get())));
        }
        let to_stdout = args.output.as_deref().is_none_or(|p| p == Path::new("-"));
        if args.format == FormatArg::Json && to_stdout {
            bail!("--format json prints the report on standard output, where the drawing would go: add -o OUT.svg");
        }
        let target = args.output.clone().unwrap_or_else(|| PathBuf::from("-"));
        output::keep_input(&args.font, &target)?;
        let (drawing, radius, units_per_em) = args.set(em_mm)?;
        let outcome = args.style.apply(&drawing.region, radius);
        output::write(&target, svg::write(&drawing, &outcome.region).as_bytes())?;
        let kept = outcome.region.rings.iter().flat_map(|r| &r.vertices).filter(|v| v.id.is_some()).count();
        let report = Report {
            text: &args.text,
            operation: args.style.op,
            radius_font_units: radius.get(),
            units_per_em,
            em_mm,
            vertices_in: drawing.region.vertex_count(),
            vertices_kept: kept,
            vertices_out: outcome.region.vertex_count(),
            area_in_square_font_units: drawing.region.area(),
            area_out_square_font_units: outcome.region.area(),
            topology_in: drawing.region.topology(),
            topology_out: outcome.region.topology(),
            proved: outcome.contradictions == 0,
        };
        match args.format {
            FormatArg::Text => output::say(&report.lines()),
            FormatArg::Json => output::print(&(serde_json::to_string_pretty(&report)? + "\n"))?,
        }
        if outcome.region.is_empty() {
            output::say("clopen: nothing is left: the disk fits nowhere; try a smaller radius\n");
        }
        Ok(if report.proved { ExitStatus::Done } else { ExitStatus::CheckFailed })
    }

    impl Report<'_> {
        fn lines(&self) -> String {
            let name = match self.operation {
                StyleOp::Open => "opened",
                StyleOp::Close => "closed",
                StyleOp::Clopen => "closed and opened",
            };
            let count = |t: &TopologyCount| format!("{} + {}", t.components, t.holes);
            let mut text = format!(
                "\"{}\" {name} by {} of {} font units ({:.4} mm): {} of {} vertices kept bit for bit, area {:+.4} %, parts + \
                 holes {} -> {}\n",
                self.text,
                self.radius_font_units,
                self.units_per_em,
                self.radius_font_units / self.units_per_em * self.em_mm,
                self.vertices_kept,
                self.vertices_in,
                100.0 * (self.area_out_square_font_units / self.area_in_square_font_units - 1.0),
                count(&self.topology_in),
                count(&self.topology_out),
            );
            if !self.proved {
                text += "NOT PROVED: outlines come too near to each other to be kept apart; --topology merge has an answer\n";
            }
            text
        }
    }
}
