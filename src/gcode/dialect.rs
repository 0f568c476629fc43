//! Dialects as data: what a controller understands stands in a file, not in a branch.
//!
//! Built-in dialects are the files of `dialects/`, whose comments name the sources. A machine of one's own is a file with
//! `base = "grbl"` and only what differs.

mod code_set;
mod file;

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;

use super::header;
use super::rules::Rule;
use crate::units::nearest_name;
pub use code_set::{CodeSet, InvalidCode};
pub use file::DialectError;

/// What the machine does its work with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MachineKind {
    /// A cutter that turns.
    Router,
    /// A beam, on only while it works; the spindle speed of a step is its power.
    Laser,
    /// A pen, down only while it works; depths mean nothing.
    Pen,
}

/// The units of the numbers in a program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum Units {
    /// G21.
    #[default]
    #[serde(rename = "mm")]
    Millimetres,
    /// G20.
    #[serde(rename = "inch")]
    Inches,
}

/// How comments are marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CommentStyle {
    /// `(like this)`
    Brackets,
    /// `;like this`
    Semicolon,
}

impl CommentStyle {
    /// What opens a comment, and what closes it.
    pub fn marks(self) -> (&'static str, &'static str) {
        match self {
            CommentStyle::Brackets => ("(", ")"),
            CommentStyle::Semicolon => (";", ""),
        }
    }
}

/// What a program has to say before anything moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Statement {
    /// G20 or G21.
    Units,
    /// G17, G18 or G19.
    Plane,
    /// G90 or G91.
    DistanceMode,
    /// G93 or G94.
    FeedMode,
}

/// The unit of a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TimeUnit {
    /// Seconds.
    Seconds,
    /// Thousandths of them.
    Milliseconds,
}

impl TimeUnit {
    /// How many there are in a second.
    pub fn per_second(self) -> f64 {
        match self {
            TimeUnit::Seconds => 1.0,
            TimeUnit::Milliseconds => 1000.0,
        }
    }
}

/// What S means where it is no speed: in proportion, `word` at `rpm`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SpindleFull {
    /// Full speed, in turns a minute.
    pub rpm: f64,
    /// The S of full speed, which none may exceed.
    pub word: f64,
}

/// How far the ends of an arc may differ in their distance from its centre before the controller refuses it.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ArcMismatch {
    /// Millimetres, in programs in millimetres.
    pub mm: f64,
    /// Millimetres, in programs in inches.
    pub inch: f64,
    /// A share of the radius that is always allowed, up to a hundred times the length above.
    pub relative: f64,
}

/// What a controller understands, and how programs for it are written.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Dialect {
    /// The name by which it is asked for, and which stands in the head of programs.
    #[serde(default)]
    pub name: String,
    /// What it is, for people.
    pub title: String,
    /// What the machine does its work with.
    pub machine: MachineKind,
    /// The letters of the words that are understood, G, M and N left out. Without Z, no Z is written.
    pub letters: String,
    /// The G and M codes that are understood.
    pub codes: CodeSet,
    /// The units that programs may be in.
    pub units: Vec<Units>,
    /// How comments are marked.
    pub comments: CommentStyle,
    /// Decimals of coordinates in millimetres.
    pub decimals_mm: u8,
    /// Decimals of coordinates in inches.
    pub decimals_inch: u8,
    /// The most characters that are written on a line, without its end.
    pub longest_line: usize,
    /// The controller refuses lines with more characters than this, comments and blanks left out.
    pub refused_code_length: Option<usize>,
    /// The controller refuses lines with more characters than this, comments and blanks included.
    pub refused_line_length: Option<usize>,
    /// Whether parameters, expressions and the flow control of O words are worked out.
    #[serde(default)]
    pub expressions: bool,
    /// Whether lines carry numbers.
    pub line_numbers: bool,
    /// Whether a line holds a single G, M or T command.
    pub one_code_a_line: bool,
    /// Whether G0 to G3 hold for the lines that follow.
    pub modal_motion: bool,
    /// What has to be said before anything moves.
    pub must_state: Vec<Statement>,
    /// What is said before anything moves, behind the units: plane, absolute coordinates, feed a minute, and whatever the
    /// controller may remember from the program before.
    pub preamble: Vec<String>,
    /// How far the controller may cut corners to keep its speed, in millimetres (G64 P); where it is missing or 0 nothing
    /// is said about it.
    pub corner_tolerance: Option<f64>,
    /// The lines that end a program; where there are none, it ends with its text.
    pub program_end: Vec<String>,
    /// Turns the spindle, the beam or the pen on; `{speed}` stands for its speed or power.
    pub spindle_on: String,
    /// Turns it off.
    pub spindle_off: String,
    /// What S means where it is no speed.
    pub spindle_full: Option<SpindleFull>,
    /// Whether the program waits for the spindle.
    pub spindle_dwell: bool,
    /// The letter of the time that is written behind G4.
    pub dwell_word: char,
    /// Its decimals; it is rounded up to whole numbers where it has none.
    pub dwell_decimals: u8,
    /// What the letters behind G4 mean.
    pub dwell_units: BTreeMap<char, TimeUnit>,
    /// The lines that change to tool `{number}`; where there are none, every tool needs a program of its own.
    pub tool_change: Vec<String>,
    /// The line that takes the length of tool `{number}` into account, after the change; may be empty.
    pub tool_length_offset: String,
    /// Whether G2 and G3 are understood.
    pub arcs: bool,
    /// Whether Z may change along an arc.
    pub helical_arcs: bool,
    /// The largest radius of an arc in millimetres; beyond it arcs are written as lines.
    pub largest_arc_radius: f64,
    /// Which arcs are refused; where it is missing, none are.
    pub arc_mismatch: Option<ArcMismatch>,
    /// How much shorter than half the chord an R may be, in millimetres, before it is refused; where it is missing, none is.
    pub radius_slack: Option<f64>,
    /// The feed that is written with rapids, in millimetres a minute, where the controller needs one.
    pub rapid_feed: Option<f64>,
    /// The lines that lift a pen.
    #[serde(default)]
    pub pen_up: Vec<String>,
    /// The lines that lower a pen.
    #[serde(default)]
    pub pen_down: Vec<String>,
    /// z of a lifted pen in millimetres, where Z lifts it.
    pub pen_up_z: Option<f64>,
    /// z of a lowered pen in millimetres.
    pub pen_down_z: Option<f64>,
    /// The rules that the controller itself enforces, and how it does.
    pub refuses: BTreeMap<Rule, String>,
}

/// The built-in files, base before what is based on it.
const FILES: [(&str, &str); 10] = [
    ("grbl", include_str!("dialects/grbl.toml")),
    ("linuxcnc", include_str!("dialects/linuxcnc.toml")),
    ("grblhal", include_str!("dialects/grblhal.toml")),
    ("mach3", include_str!("dialects/mach3.toml")),
    ("marlin", include_str!("dialects/marlin.toml")),
    ("smoothieware", include_str!("dialects/smoothieware.toml")),
    ("grbl-laser", include_str!("dialects/grbl-laser.toml")),
    ("plotter", include_str!("dialects/plotter.toml")),
    ("plotter-servo", include_str!("dialects/plotter-servo.toml")),
    ("portable", include_str!("dialects/portable.toml")),
];

/// Other names of built-in dialects.
const ALIASES: [(&str, &str); 2] = [("fluidnc", "grblhal"), ("mach4", "mach3")];

// The files are part of the program, and a test reads them all.
static BUILT_IN: LazyLock<Vec<Dialect>> = LazyLock::new(|| {
    FILES.iter().map(|(name, text)| Dialect::parse(text, name).expect("a built-in dialect is valid")).collect()
});

/// GRBL 1.1 and those that follow it.
pub static GRBL: LazyLock<Dialect> = LazyLock::new(|| BUILT_IN[0].clone());

/// LinuxCNC 2.8 and later.
pub static LINUXCNC: LazyLock<Dialect> = LazyLock::new(|| BUILT_IN[1].clone());

/// What the header that clopen writes says before the name of the dialect.
pub const DIALECT_COMMENT: &str = "dialect ";

/// A name that no dialect has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("\"{name}\" is no dialect{}: there are {known}; a machine of your own is a file, my-machine.toml", .meant.map_or(String::new(), |m| format!(" (do you mean {m}?)")))]
pub struct UnknownDialect {
    /// What was asked for.
    pub name: String,
    /// All names there are.
    pub known: String,
    /// The nearest of them.
    pub meant: Option<&'static str>,
}

impl Dialect {
    /// The built-in dialects.
    pub fn built_in() -> &'static [Dialect] {
        &BUILT_IN
    }

    /// What both GRBL and LinuxCNC take.
    pub fn portable() -> &'static Dialect {
        &BUILT_IN[FILES.len() - 1]
    }

    /// The built-in dialect called `name`, in any case.
    ///
    /// # Errors
    /// Lists the names, and the nearest.
    pub fn named(name: &str) -> Result<&'static Dialect, UnknownDialect> {
        let alias = ALIASES.iter().find(|(alias, _)| alias.eq_ignore_ascii_case(name.trim()));
        let wanted = alias.map_or(name.trim(), |(_, of)| of);
        BUILT_IN.iter().find(|d| d.name.eq_ignore_ascii_case(wanted)).ok_or_else(|| {
            let names = || FILES.iter().map(|(name, _)| *name).chain(ALIASES.iter().map(|(alias, _)| *alias));
            UnknownDialect {
                name: name.to_owned(),
                known: names().collect::<Vec<_>>().join(", "),
                meant: nearest_name(name, names()),
            }
        })
    }

    /// The built-in dialect that the header of a program written by clopen names.
    pub fn of_header(text: &str) -> Option<&'static Dialect> {
        let name = Dialect::name_in_header(text)?;
        BUILT_IN.iter().find(|d| d.name == name)
    }

    /// The name of a dialect, built in or not, in the header of a program written by clopen.
    pub fn name_in_header(text: &str) -> Option<String> {
        header::comments(text).find_map(|c| Some(c.strip_prefix(DIALECT_COMMENT)?.trim().to_owned()))
    }

    /// Whether words of `letter` are understood; G, M and N always are.
    pub fn knows_letter(&self, letter: char) -> bool {
        matches!(letter, 'G' | 'M' | 'N') || self.letters.contains(letter)
    }

    /// Whether the tool's height is the program's: not where there is no Z, nor where it lifts a pen.
    pub fn has_depth(&self) -> bool {
        self.machine != MachineKind::Pen && self.letters.contains('Z')
    }
}

#[cfg(test)]
mod tests;
