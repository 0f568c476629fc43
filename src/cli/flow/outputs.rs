//! What is written of a flow: drawings, and pictures of its states.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use clap::{Args, ValueEnum};

use super::record::Spacing;
use crate::cli::check::FormatArg;
use crate::cli::output;
use crate::io::svg::{self, Parts, Still};
use crate::plane::Region;
use crate::preview::{self, Cell, DEFAULT_SIZE, Frame, Picture, time_captions};

/// What goes where.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Output")]
pub(in crate::cli) struct OutputArgs {
    /// Where the last state goes, SVG; standard output unless this or a picture is given
    #[arg(short, long, value_name = "OUT.svg")]
    pub(in crate::cli) output: Option<PathBuf>,
    /// Pixels: the width of the contact sheet, the long side of the animated PNG
    #[arg(long, visible_alias = "pixels", value_name = "PIXELS", default_value_t = DEFAULT_SIZE)]
    pub(in crate::cli) size: u32,
    #[command(flatten)]
    pub(in crate::cli) states: StateArgs,
}

/// States on the way, and what shows them.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "States on the way")]
pub(in crate::cli) struct StateArgs {
    /// How many states, evenly spread to the end; pictures that move start with the drawing itself before them. Where nothing
    /// else is to be written, the drawing on standard output plays them
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true)]
    frames: Option<i64>,
    /// In what the states are evenly spread
    #[arg(long, value_enum, default_value_t = FramesByArg::Time)]
    frames_by: FramesByArg,
    /// Where the states go, one SVG each: OUT.svg becomes OUT-01.svg, OUT-02.svg ...; {} in the name stands for the number
    #[arg(long, value_name = "OUT.svg")]
    stills: Option<PathBuf>,
    /// Where an animation goes that plays in every browser, SVG
    #[arg(long, value_name = "OUT.svg")]
    animation: Option<PathBuf>,
    /// Where an animated PNG goes; to programs that know no animation it is the last state
    #[arg(long, value_name = "OUT.png")]
    apng: Option<PathBuf>,
    /// Where a contact sheet goes, PNG: the states side by side, what moved in colour
    #[arg(long, value_name = "OUT.png")]
    sheet: Option<PathBuf>,
    /// Columns of the contact sheet; as many as look well unless given
    #[arg(long, value_name = "NUMBER", requires = "sheet", value_parser = clap::value_parser!(u16).range(1..=100))]
    columns: Option<u16>,
}

/// `--frames-by`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FramesByArg {
    /// In time: most happens in the first of them
    Time,
    /// In the area that the boundary sweeps over: as much happens from each to the next
    Area,
}

/// States in pictures of several, unless told otherwise.
const DEFAULT_FRAMES: usize = 12;

/// Pixels of pictures.
const SMALLEST_SIZE: u32 = 64;
const LARGEST_SIZE: u32 = 16_384;

/// More are a slip: all of them are kept in memory.
const MOST_FRAMES: i64 = 1000;

/// How long things are seen in moving pictures, in seconds: the drawing before anything moves, the last state, and all states
/// in between together, each of which no shorter and no longer than the last two.
const FIRST_SECONDS: f64 = 0.8;
const LAST_SECONDS: f64 = 1.8;
const MOVING_SECONDS: f64 = 2.5;
const SHORTEST_SECONDS: f64 = 0.04;
const LONGEST_SECONDS: f64 = 0.4;

impl StateArgs {
    /// Whether states on the way are wanted.
    #[cfg(feature = "text")]
    pub(in crate::cli) fn is_asked_for(&self) -> bool {
        self.frames.is_some() || self.has_pictures()
    }

    fn has_pictures(&self) -> bool {
        self.stills.is_some() || self.animation.is_some() || self.apng.is_some() || self.sheet.is_some()
    }
}

impl OutputArgs {
    /// Refuses what cannot be meant.
    ///
    /// # Errors
    /// Names the option and what to do.
    pub(super) fn check(&self, input: Option<&Path>, format: FormatArg) -> Result<()> {
        if let Some(frames) = self.states.frames.filter(|n| !(1..=MOST_FRAMES).contains(n)) {
            bail!("--frames {frames}: give a number from 1 to {MOST_FRAMES}");
        }
        if self.states.frames.is_some() && !self.states.has_pictures() && !self.plays() {
            bail!(
                "--frames says how many states to show, and the drawing in -o is the last one alone: add --stills, \
                 --animation, --apng or --sheet, or leave -o out for a drawing that plays on standard output"
            );
        }
        let to_stdout = Path::new("-");
        if format == FormatArg::Json && self.single_files().any(|path| path == to_stdout) {
            bail!("--format json prints the report on standard output, where the drawing would go: add -o OUT.svg");
        }
        if !(SMALLEST_SIZE..=LARGEST_SIZE).contains(&self.size) {
            bail!("--size {}: give a number of pixels from {SMALLEST_SIZE} to {LARGEST_SIZE}", self.size);
        }
        let targets: Vec<PathBuf> = self.single_files().map(Path::to_owned).chain(self.still_paths()).collect();
        for (k, target) in targets.iter().enumerate() {
            if targets[..k].contains(target) {
                bail!("{}: two results cannot go to one file: give each a name of its own", target.display());
            }
            // Told before the flow has run, and not after.
            output::keep_folder(target)?;
            if let Some(input) = input {
                output::keep_input(input, target)?;
            }
        }
        Ok(())
    }

    /// Whether all states go to standard output as one drawing that plays.
    pub(super) fn plays(&self) -> bool {
        self.output.is_none() && self.states.frames.is_some() && !self.states.has_pictures()
    }

    /// How many states to record.
    pub(super) fn frame_count(&self) -> usize {
        match self.states.frames {
            Some(n) => usize::try_from(n).unwrap_or(1).max(1),
            None if self.states.has_pictures() => DEFAULT_FRAMES,
            None => 1,
        }
    }

    pub(super) fn spacing(&self) -> Spacing {
        match self.states.frames_by {
            FramesByArg::Time => Spacing::Time,
            FramesByArg::Area => Spacing::Area,
        }
    }

    /// Where the last state goes.
    fn last(&self) -> Option<&Path> {
        match &self.output {
            Some(path) => Some(path),
            None if self.plays() || self.states.has_pictures() => None,
            None => Some(Path::new("-")),
        }
    }

    /// Where the animation goes.
    fn animation(&self) -> Option<&Path> {
        if self.plays() { Some(Path::new("-")) } else { self.states.animation.as_deref() }
    }

    fn single_files(&self) -> impl Iterator<Item = &Path> {
        let pictures = [self.animation(), self.states.apng.as_deref(), self.states.sheet.as_deref()];
        self.last().into_iter().chain(pictures.into_iter().flatten())
    }

    fn still_paths(&self) -> Vec<PathBuf> {
        let n = self.frame_count();
        self.states.stills.iter().flat_map(|pattern| (1..=n).map(|k| still_path(pattern, k, n))).collect()
    }

    /// Writes all that is asked for, or nothing; `frames` are of what is chosen, and at least one. Gives the files.
    ///
    /// # Errors
    /// Names the file, or says why there is no picture.
    pub(super) fn write(&self, parts: &Parts, frames: &[Frame]) -> Result<Vec<PathBuf>> {
        let mut contents: Vec<(PathBuf, Vec<u8>)> = Vec::new();
        let mut add = |path: &Path, bytes: Vec<u8>| contents.push((path.to_owned(), bytes));
        if let (Some(path), Some(last)) = (self.last(), frames.last()) {
            add(path, svg::write_parts(parts, &last.region, None).into_bytes());
        }
        for (path, frame) in self.still_paths().iter().zip(frames) {
            add(path, svg::write_parts(parts, &frame.region, None).into_bytes());
        }
        let start = Frame { time: 0.0, region: parts.chosen().region.clone() };
        let shown: Vec<Frame> = std::iter::once(&start).chain(frames).cloned().collect();
        let seconds = seconds(shown.len());
        if let Some(path) = self.animation() {
            let still = |((frame, caption), &seconds)| Still { region: state(frame), caption, seconds };
            let stills: Vec<Still> = shown.iter().zip(time_captions(&shown)).zip(&seconds).map(still).collect();
            add(path, svg::animate_parts(parts, &stills).into_bytes());
        }
        if self.states.sheet.is_some() || self.states.apng.is_some() {
            // Pictures show what stands around as well.
            let whole: Vec<Frame> =
                shown.iter().map(|f| Frame { time: f.time, region: among(parts, &f.region) }).collect();
            // The first of them is the drawing itself.
            let before = &whole[0].region;
            if let Some(path) = &self.states.sheet {
                let captions = time_captions(frames);
                let cell = |(frame, caption)| Cell { caption, before, after: state(frame) };
                let cells: Vec<Cell> = whole[1..].iter().zip(captions).map(cell).collect();
                let columns = self.states.columns.map(usize::from);
                add(path, preview::contact_sheet(&cells, columns, self.size).context("--sheet")?);
            }
            if let Some(path) = &self.states.apng {
                let captions = time_captions(&whole);
                let picture = |((frame, caption), &seconds)| Picture { region: state(frame), caption, seconds };
                let pictures: Vec<Picture> = whole.iter().zip(captions).zip(&seconds).map(picture).collect();
                add(path, preview::animation(before, &pictures, self.size).context("--apng")?);
            }
        }
        let borrowed: Vec<output::Content> =
            contents.iter().map(|(path, bytes)| (path.as_path(), &bytes[..])).collect();
        output::write_together(&borrowed)?;
        Ok(contents.into_iter().map(|(path, _)| path).filter(|path| path != Path::new("-")).collect())
    }
}

fn state(frame: &Frame) -> &Region {
    &frame.region
}

/// A state of what is chosen with all other parts.
fn among(parts: &Parts, state: &Region) -> Region {
    let others = parts.parts.iter().enumerate().filter(|(k, _)| *k != parts.chosen);
    let others = others.flat_map(|(_, part)| &part.drawing.region.rings);
    Region::new(state.rings.iter().chain(others).cloned().collect())
}

/// For how long each of `n` states is shown, the first of which is the drawing itself.
fn seconds(n: usize) -> Vec<f64> {
    let between = (MOVING_SECONDS / n as f64).clamp(SHORTEST_SECONDS, LONGEST_SECONDS);
    let mut seconds = vec![between; n];
    if let Some(first) = seconds.first_mut() {
        *first = FIRST_SECONDS;
    }
    if let Some(last) = seconds.last_mut() {
        *last = LAST_SECONDS;
    }
    seconds
}

/// The name of still `k` of `n`.
fn still_path(pattern: &Path, k: usize, n: usize) -> PathBuf {
    let digits = n.to_string().len().max(2);
    let number = format!("{k:0digits$}");
    let name = pattern.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    if name.contains("{}") {
        return pattern.with_file_name(name.replace("{}", &number));
    }
    match name.rsplit_once('.') {
        Some((stem, extension)) if !stem.is_empty() => pattern.with_file_name(format!("{stem}-{number}.{extension}")),
        _ => pattern.with_file_name(format!("{name}-{number}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stills_are_numbered() {
        let name = |pattern: &str, k, n| still_path(Path::new(pattern), k, n).display().to_string();
        assert_eq!(name("a/word.svg", 3, 8), "a/word-03.svg");
        assert_eq!(name("word", 3, 8), "word-03");
        assert_eq!(name("a/w{}d.svg", 7, 120), "a/w007d.svg");
        assert_eq!(name(".svg", 1, 1), ".svg-01");
    }

    #[test]
    fn the_last_state_is_seen_longest() {
        let all = seconds(25);
        assert_eq!((all[0], all[1], all[24]), (FIRST_SECONDS, 0.1, LAST_SECONDS));
        assert_eq!(seconds(2), [FIRST_SECONDS, LAST_SECONDS]);
        assert_eq!(seconds(1000)[5], SHORTEST_SECONDS);
    }
}
