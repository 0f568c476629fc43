//! `clopen font IN.ttf -o OUT.ttf`: a whole font restyled.

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;

use super::ExitStatus;
use super::check::FormatArg;
use super::text::StyleArgs;
use crate::threads;
use crate::units::FontLength;

/// The arguments.
#[derive(Clone, Debug, Args)]
// Without shaping nobody reads them.
#[cfg_attr(not(feature = "text"), allow(dead_code))]
pub(super) struct FontArgs {
    /// The font, TrueType or OpenType
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Where the new font goes, TrueType
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    style: StyleArgs,
    /// Stop the flow to the new outlines at this time, in squares of the radius: serifs that have begun to melt. The exact
    /// limit unless given
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    time: Option<f64>,
    /// What the new font is called; the old name with the operation and the radius unless given
    #[arg(long, value_name = "NAME")]
    family: Option<String>,
    /// Where a specimen goes, PNG: letters before and after
    #[arg(long, value_name = "PICTURE")]
    sheet: Option<PathBuf>,
    /// How far the outlines that are written may be from the exact ones: 0.5u or 0.5em/1000
    #[arg(long, value_name = "LENGTH", default_value_t = FontLength::Mille(0.5), allow_hyphen_values = true)]
    tolerance: FontLength,
    /// Which font of a collection, from 0
    #[arg(long, value_name = "NUMBER")]
    index: Option<u32>,
    /// How to print the report: text goes to standard error, json to standard output
    #[arg(long, value_enum, default_value_t = FormatArg::Text)]
    format: FormatArg,
}

#[cfg(not(feature = "text"))]
pub(super) fn run(_: &FontArgs) -> Result<ExitStatus> {
    anyhow::bail!("this build restyles no fonts: build clopen with its feature \"text\", which is on by default");
}

#[cfg(feature = "text")]
pub(super) use with_text::run;

#[cfg(feature = "text")]
mod with_text {
    use std::path::Path;

    use anyhow::{Context as _, bail};
    use indicatif::{ProgressBar, ProgressStyle};

    use super::*;
    use crate::cli::text::StyleOp;
    use crate::cli::{input, output};
    use crate::flow::{CurveFlow, Field, Obstacle, Settings, Status};
    use crate::io::font::{self, Face, Fate, FontNames, OutlineFormat, RestyleOptions, Restyled, Sampling};
    use crate::plane::Region;
    use crate::preview::{self, SpecimenRow};
    use crate::units::Radius;

    /// So many glyphs are named in words.
    const SHOWN: usize = 8;

    /// The lines of a specimen; what the font lacks of them is left out.
    const SPECIMEN: [&str; 4] = [
        "ABCDEFGHIJKLMNOPQRSTUVWXYZ",
        "abcdefghijklmnopqrstuvwxyz",
        "0123456789 &?! fi fl \u{c4}\u{c9}\u{f1}\u{e7}\u{df}",
        "Quick wafting zephyrs vex bold Jim.",
    ];

    /// So many characters of a licence are shown.
    const LICENCE: usize = 240;

    /// What was done, for people and for programs.
    #[derive(Debug, serde::Serialize)]
    struct Report {
        operation: StyleOp,
        radius_font_units: f64,
        #[serde(skip_serializing_if = "Option::is_none")]
        time_r2: Option<f64>,
        units_per_em: f64,
        tolerance_font_units: f64,
        outlines: OutlineFormat,
        glyphs: usize,
        blank: usize,
        kept: usize,
        kept_glyphs: Vec<u16>,
        changed: usize,
        changed_by_components: usize,
        vanished: Vec<u16>,
        refused: Vec<Refused>,
        beyond_tolerance: Vec<u16>,
        largest_deviation_font_units: f64,
        largest_deviation_glyph: u16,
        dropped_tables: Vec<String>,
        before: FontNames,
        after: FontNames,
        fs_type: Option<u16>,
    }

    #[derive(Debug, serde::Serialize)]
    struct Refused {
        glyph: u16,
        reason: &'static str,
    }

    /// Runs the command.
    ///
    /// # Errors
    /// Where the font cannot be read or must not be changed, or a result cannot be written.
    pub(in crate::cli) fn run(args: &FontArgs) -> Result<ExitStatus> {
        if args.format == FormatArg::Json && args.output == Path::new("-") {
            bail!("--format json prints the report on standard output, where the font would go: name a file with -o");
        }
        output::keep_input(&args.input, &args.output)?;
        for target in [Some(&args.output), args.sheet.as_ref()].into_iter().flatten() {
            output::keep_folder(target)?;
        }
        let name = || args.input.display().to_string();
        let bytes = input::read_bytes(&args.input)?;
        let face = Face::parse(&bytes, args.index).with_context(name)?;
        let em = face.units_per_em();
        let radius = font::check_radius(args.style.radius.to_units(em), em).context("--radius")?;
        let tolerance = args.tolerance.to_units(em);
        if !(tolerance > 0.0 && tolerance < em) {
            bail!("--tolerance is {}: it must be above zero and below the em", args.tolerance);
        }
        let options =
            RestyleOptions { sampling: Sampling::new(em, radius.get()), tolerance, threads: threads::available() };
        let family = match &args.family {
            Some(family) => family.clone(),
            None => default_family(&face.names().with_context(name)?.family, args),
        };
        let bar = progress_bar(face.glyph_count());
        if let Some(time) = args.time.filter(|t| !(*t > 0.0 && t.is_finite())) {
            bail!("--time is {time}: it must be above zero; 0.1 is where serifs have begun to melt");
        }
        let operation = |region: &Region| match args.time {
            Some(time) => flowed(region, args.style.op, radius, time),
            None => {
                let outcome = args.style.apply(region, radius);
                (outcome.contradictions == 0).then_some(outcome.region)
            }
        };
        let restyled = font::restyle(&face, &family, &operation, &options, &|done| bar.set_position(done as u64));
        bar.finish_and_clear();
        let restyled = restyled.with_context(name)?;
        let mut files = vec![(args.output.as_path(), restyled.bytes.as_slice())];
        let sheet = args.sheet.as_ref().map(|_| specimen(&face, &restyled, &options)).transpose()?;
        if let (Some(path), Some(sheet)) = (&args.sheet, &sheet) {
            output::keep_input(&args.input, path)?;
            files.push((path, sheet));
        }
        output::write_together(&files)?;
        let report = Report::new(args, radius.get(), em, tolerance, restyled);
        match args.format {
            FormatArg::Text => output::say(&report.lines(&face)),
            FormatArg::Json => output::print(&(serde_json::to_string_pretty(&report)? + "\n"))?,
        }
        let failed = !report.refused.is_empty() || !report.beyond_tolerance.is_empty();
        Ok(if failed { ExitStatus::CheckFailed } else { ExitStatus::Done })
    }

    /// Glyphs flow with edges of so many radii and steps of so many squares of them, both coarser than elsewhere: a font has
    /// thousands, and steps and vertices are fewer by the third power of the edge.
    const FLOW_EDGE: f64 = 0.1;
    const FLOW_TIME_STEP: f64 = 0.1;

    /// A glyph after flowing for `time` squares of the radius; `None` where it ran into itself or stalled.
    fn flowed(region: &Region, op: StyleOp, radius: Radius, time: f64) -> Option<Region> {
        let obstacle = match op {
            StyleOp::Open => Obstacle::OPENING,
            StyleOp::Close => Obstacle::CLOSING,
            StyleOp::Clopen => Obstacle::CLOPENING,
        };
        let settings = Settings { edge: FLOW_EDGE, time_step: FLOW_TIME_STEP, ..Settings::default() };
        let mut flow = CurveFlow::new(region, obstacle, Field::constant(radius), &settings).ok()?;
        let status = flow.run(time * radius.get() * radius.get());
        let is_sound = match status {
            Status::Going => true,
            Status::Ended(end) => end.is_limit(),
        };
        (is_sound && flow.report().contacts.is_empty()).then(|| flow.rounded())
    }

    /// `DejaVu Serif Open 30`.
    fn default_family(old: &str, args: &FontArgs) -> String {
        let operation = match args.style.op {
            StyleOp::Open => "Open",
            StyleOp::Close => "Close",
            StyleOp::Clopen => "Clopen",
        };
        let time = args.time.map_or(String::new(), |time| format!(" {time}"));
        format!("{old} {operation} {}{time}", args.style.radius.number())
    }

    /// On standard error; hidden where that is no terminal.
    fn progress_bar(glyphs: usize) -> ProgressBar {
        let bar = ProgressBar::new(glyphs as u64);
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} glyphs") {
            bar.set_style(style);
        }
        bar
    }

    /// The picture of both fonts, the new one as it was read back.
    fn specimen(face: &Face, restyled: &Restyled, options: &RestyleOptions) -> Result<Vec<u8>> {
        let new = Face::parse(&restyled.bytes, None).context("the new font, read back")?;
        let line = |face: &Face, text: &str| font::line(face, text, options.sampling, 1.0).map(|d| d.region);
        let mut rows = Vec::new();
        let names = [restyled.after.family.as_str()];
        for text in names.into_iter().chain(SPECIMEN) {
            let text: String = text.chars().filter(|c| face.has_glyph(*c)).collect();
            // A line of nothing but blanks has no picture, and one whose letters have all vanished one of them.
            let Ok(before) = line(face, &text) else { continue };
            rows.push(SpecimenRow { before, after: line(&new, &text).unwrap_or_default() });
        }
        preview::specimen(&rows, face.units_per_em(), preview::DEFAULT_SIZE).context("--sheet")
    }

    impl Report {
        fn new(args: &FontArgs, radius: f64, units_per_em: f64, tolerance: f64, restyled: Restyled) -> Report {
            let numbers = |is: fn(&Fate) -> bool| -> Vec<u16> {
                restyled.fates.iter().enumerate().filter(|(_, f)| is(f)).map(|(k, _)| k as u16).collect()
            };
            let refused = restyled.fates.iter().enumerate().filter_map(|(k, fate)| match fate {
                Fate::Refused(reason) => Some(Refused { glyph: k as u16, reason }),
                _ => None,
            });
            Report {
                operation: args.style.op,
                radius_font_units: radius,
                time_r2: args.time,
                units_per_em,
                tolerance_font_units: tolerance,
                outlines: restyled.format,
                glyphs: restyled.fates.len(),
                blank: numbers(|f| *f == Fate::Blank).len(),
                kept: numbers(|f| *f == Fate::Kept).len(),
                kept_glyphs: numbers(|f| *f == Fate::Kept),
                changed: numbers(|f| *f == Fate::Changed).len(),
                changed_by_components: numbers(|f| *f == Fate::ChangedByComponents).len(),
                vanished: numbers(|f| *f == Fate::Vanished),
                refused: refused.collect(),
                beyond_tolerance: restyled.beyond,
                largest_deviation_font_units: restyled.deviation.0,
                largest_deviation_glyph: restyled.deviation.1,
                dropped_tables: restyled.dropped,
                before: restyled.before,
                after: restyled.after,
                fs_type: restyled.fs_type,
            }
        }

        fn lines(&self, face: &Face) -> String {
            let listed = |glyphs: &[u16]| listed(glyphs, face);
            let mut text = format!(
                "\"{}\" -> \"{}\" by {} of {} font units: {} glyphs: {} changed, {} by their components, {} kept, {} blank\n\
                 largest distance to the exact outlines {:.3} font units (glyph {}), tolerance {}\n",
                self.before.full,
                self.after.full,
                self.radius_font_units,
                self.units_per_em,
                self.glyphs,
                self.changed,
                self.changed_by_components,
                self.kept,
                self.blank,
                self.largest_deviation_font_units,
                face.glyph_label(self.largest_deviation_glyph),
                self.tolerance_font_units,
            );
            if !self.dropped_tables.is_empty() {
                text += &format!("dropped: {}\n", self.dropped_tables.join(" "));
            }
            if !self.vanished.is_empty() {
                text += &format!("nothing is left of {}\n", listed(&self.vanished));
            }
            if !self.beyond_tolerance.is_empty() {
                text += &format!(
                    "BEYOND TOLERANCE: {}: no places on the grid of whole font units were found that are nearer; allow more with --tolerance\n",
                    listed(&self.beyond_tolerance)
                );
            }
            for refused in self.refused.iter().take(SHOWN) {
                text += &format!("NOT CHANGED: glyph {}: {}\n", face.glyph_label(refused.glyph), refused.reason);
            }
            if self.refused.len() > SHOWN {
                text += &format!("NOT CHANGED: {} more glyphs\n", self.refused.len() - SHOWN);
            }
            text += "the licence of the original, which no program can judge, holds for the new font, too:\n";
            let fs_type = self.fs_type.map_or("none".to_owned(), |bits| format!("{bits:#06x}"));
            text += &format!("  OS/2 fsType: {fs_type}\n");
            for (what, said) in [("licence", &self.after.licence), ("licence at", &self.after.licence_url)] {
                text += &format!("  {what}: {}\n", begun(said.as_deref().unwrap_or("not said")));
            }
            text
        }
    }

    /// The beginning of a text, in one line.
    fn begun(text: &str) -> String {
        let words: Vec<&str> = text.split_whitespace().collect();
        let line = words.join(" ");
        let shown: String = line.chars().take(LICENCE).collect();
        let more = line.chars().count().saturating_sub(LICENCE);
        if more > 0 { format!("{shown}... ({more} characters more: --format json shows all)") } else { shown }
    }

    fn listed(glyphs: &[u16], face: &Face) -> String {
        let named: Vec<String> = glyphs.iter().take(SHOWN).map(|g| face.glyph_label(*g)).collect();
        let more = glyphs.len().saturating_sub(SHOWN);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        format!("{} {}{more}", if glyphs.len() == 1 { "glyph" } else { "glyphs" }, named.join(", "))
    }
}
