//! What was typed, on the command line or in a job file, before defaults and units are applied.

use std::fmt;
use std::str::FromStr;

use serde::Deserialize;

use super::{DEFAULT_SAFE_CLEARANCE, Direction, Entry, InvalidJob, Job, JobProblem, Origin, PathRadius, Side};
use crate::rolling::Topology;
use crate::units::{DrawingScale, Length, ParseLengthError, ResolveLengthError, Speed};

/// The values that somebody typed; what was not typed is `None`.
///
/// In TOML the keys are those of the command line. Lengths and feeds are texts with a unit (`"1/8in"`, `"20mm/s"`) or bare
/// numbers, which are millimetres and millimetres a minute. Unknown keys are refused.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct JobFile {
    /// Diameter of the tool.
    #[serde(deserialize_with = "typed")]
    pub tool_diameter: Option<Length>,
    /// Depth of the cut.
    #[serde(deserialize_with = "typed")]
    pub depth: Option<Length>,
    /// Most that a pass may go deeper than the one before.
    #[serde(deserialize_with = "typed")]
    pub depth_per_pass: Option<Length>,
    /// Feed along the path.
    #[serde(deserialize_with = "typed")]
    pub feed: Option<Speed>,
    /// Feed of ramps and plunges.
    #[serde(deserialize_with = "typed")]
    pub plunge_feed: Option<Speed>,
    /// Spindle speed in revolutions a minute.
    pub spindle_speed: Option<f64>,
    /// Seconds to wait for the spindle.
    pub dwell: Option<f64>,
    /// z of travel; by default it follows the top of the stock.
    #[serde(deserialize_with = "typed")]
    pub safe_height: Option<Length>,
    /// z of the top of the stock.
    #[serde(deserialize_with = "typed")]
    pub stock_top: Option<Length>,
    /// `corner`, `center` or `drawing`.
    #[serde(deserialize_with = "typed")]
    pub origin: Option<Origin>,
    /// `climb` or `conventional`.
    #[serde(deserialize_with = "typed")]
    pub direction: Option<Direction>,
    /// `outside`, `inside` or `on`.
    #[serde(deserialize_with = "typed")]
    pub side: Option<Side>,
    /// A length or `auto`.
    #[serde(deserialize_with = "typed")]
    pub path_radius: Option<TypedPathRadius>,
    /// Acceleration of the machine in mm/s².
    pub acceleration: Option<f64>,
    /// `ramp` or `plunge`.
    #[serde(deserialize_with = "typed")]
    pub entry: Option<Entry>,
    /// `merge` or `keep`: what happens where parts come nearer to each other than the tool.
    #[serde(deserialize_with = "typed")]
    pub topology: Option<Topology>,
    /// The name or file of a dialect.
    pub dialect: Option<String>,
    /// Lines instead of arcs.
    pub no_arcs: Option<bool>,
    /// Inches instead of millimetres.
    pub inches: Option<bool>,
}

/// A path radius as it was typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TypedPathRadius {
    /// From feed and acceleration.
    Auto,
    /// A length.
    Length(Length),
}

/// Why a text is no job file: the place and the reason, as the TOML reader gives them.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the job file cannot be read: {0}")]
pub struct ParseJobError(toml::de::Error);

/// A word that is none of the choices.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("\"{text}\" is none of {choices}")]
pub struct UnknownChoice {
    text: String,
    choices: String,
}

impl FromStr for JobFile {
    type Err = ParseJobError;

    fn from_str(text: &str) -> Result<JobFile, ParseJobError> {
        toml::from_str(text).map_err(ParseJobError)
    }
}

impl JobFile {
    /// These values, and those of `below` where there are none: flags over the file.
    #[must_use]
    pub fn over(self, below: JobFile) -> JobFile {
        JobFile {
            tool_diameter: self.tool_diameter.or(below.tool_diameter),
            depth: self.depth.or(below.depth),
            depth_per_pass: self.depth_per_pass.or(below.depth_per_pass),
            feed: self.feed.or(below.feed),
            plunge_feed: self.plunge_feed.or(below.plunge_feed),
            spindle_speed: self.spindle_speed.or(below.spindle_speed),
            dwell: self.dwell.or(below.dwell),
            safe_height: self.safe_height.or(below.safe_height),
            stock_top: self.stock_top.or(below.stock_top),
            origin: self.origin.or(below.origin),
            direction: self.direction.or(below.direction),
            side: self.side.or(below.side),
            path_radius: self.path_radius.or(below.path_radius),
            acceleration: self.acceleration.or(below.acceleration),
            entry: self.entry.or(below.entry),
            topology: self.topology.or(below.topology),
            dialect: self.dialect.or(below.dialect),
            no_arcs: self.no_arcs.or(below.no_arcs),
            inches: self.inches.or(below.inches),
        }
    }

    /// The job: these values over the defaults, in millimetres, and known to make sense.
    ///
    /// # Errors
    /// Lists every value that makes no sense, or means nothing for a drawing of this scale.
    pub fn resolve(&self, scale: &DrawingScale) -> Result<Job, InvalidJob> {
        let mut problems = Vec::new();
        let mut mm = |field, typed: Option<Length>, default: f64| match typed.map(|l| l.to_millimetres(scale)) {
            None => default,
            Some(Ok(value)) => value,
            Some(Err(source @ ResolveLengthError::NoPhysicalSize(_))) => {
                problems.push(JobProblem::Length { field, source });
                default
            }
        };
        let default = Job::default();
        let stock_top = mm("stock-top", self.stock_top, default.stock_top);
        let job = Job {
            tool_diameter: mm("tool-diameter", self.tool_diameter, default.tool_diameter),
            depth: mm("depth", self.depth, default.depth),
            depth_per_pass: mm("depth-per-pass", self.depth_per_pass, default.depth_per_pass),
            feed: self.feed.unwrap_or(default.feed),
            plunge_feed: self.plunge_feed.unwrap_or(default.plunge_feed),
            spindle_speed: self.spindle_speed.unwrap_or(default.spindle_speed),
            dwell: self.dwell.unwrap_or(default.dwell),
            safe_height: mm("safe-height", self.safe_height, stock_top + DEFAULT_SAFE_CLEARANCE),
            stock_top,
            origin: self.origin.unwrap_or(default.origin),
            direction: self.direction.unwrap_or(default.direction),
            side: self.side.unwrap_or(default.side),
            path_radius: match self.path_radius {
                None => default.path_radius,
                Some(TypedPathRadius::Auto) => PathRadius::Auto,
                Some(TypedPathRadius::Length(length)) => PathRadius::Length(mm("path-radius", Some(length), 0.0)),
            },
            acceleration: self.acceleration.unwrap_or(default.acceleration),
            entry: self.entry.unwrap_or(default.entry),
        };
        if let Err(invalid) = job.validate() {
            problems.extend(invalid.problems);
        }
        if problems.is_empty() { Ok(job) } else { Err(InvalidJob { problems }) }
    }
}

/// The choice that `text` names.
fn choose<T: Copy>(text: &str, choices: &[(&str, T)]) -> Result<T, UnknownChoice> {
    let word = text.trim().to_ascii_lowercase();
    choices.iter().find(|(name, _)| *name == word).map(|(_, choice)| *choice).ok_or_else(|| UnknownChoice {
        text: text.to_owned(),
        choices: choices.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", "),
    })
}

impl FromStr for Origin {
    type Err = UnknownChoice;

    fn from_str(text: &str) -> Result<Origin, UnknownChoice> {
        choose(text, &[("corner", Origin::Corner), ("center", Origin::Center), ("drawing", Origin::Drawing)])
    }
}

impl FromStr for Direction {
    type Err = UnknownChoice;

    fn from_str(text: &str) -> Result<Direction, UnknownChoice> {
        choose(text, &[("climb", Direction::Climb), ("conventional", Direction::Conventional)])
    }
}

impl FromStr for Side {
    type Err = UnknownChoice;

    fn from_str(text: &str) -> Result<Side, UnknownChoice> {
        choose(text, &[("outside", Side::Outside), ("inside", Side::Inside), ("on", Side::On)])
    }
}

impl FromStr for Entry {
    type Err = UnknownChoice;

    fn from_str(text: &str) -> Result<Entry, UnknownChoice> {
        let choices = [
            ("ramp", Entry::Ramp),
            ("helix", Entry::Helix),
            ("plunge", Entry::Plunge),
            ("predrilled", Entry::Predrilled),
        ];
        choose(text, &choices)
    }
}

impl FromStr for Topology {
    type Err = UnknownChoice;

    fn from_str(text: &str) -> Result<Topology, UnknownChoice> {
        choose(text, &[("merge", Topology::Merge), ("keep", Topology::Keep)])
    }
}

impl FromStr for TypedPathRadius {
    type Err = ParseLengthError;

    fn from_str(text: &str) -> Result<TypedPathRadius, ParseLengthError> {
        if text.trim().eq_ignore_ascii_case("auto") {
            return Ok(TypedPathRadius::Auto);
        }
        text.parse().map(TypedPathRadius::Length)
    }
}

/// Reads a text or a bare number by the type's own rules: what a job file accepts is what the command line accepts.
pub(super) fn typed<'de, D, T>(deserializer: D) -> Result<Option<T>, D::Error>
where
    D: serde::Deserializer<'de>,
    T: FromStr,
    T::Err: fmt::Display,
{
    struct Typed<T>(std::marker::PhantomData<T>);

    impl<T> serde::de::Visitor<'_> for Typed<T>
    where
        T: FromStr,
        T::Err: fmt::Display,
    {
        type Value = T;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a text or a number")
        }

        fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<T, E> {
            text.parse().map_err(E::custom)
        }

        fn visit_f64<E: serde::de::Error>(self, number: f64) -> Result<T, E> {
            self.visit_str(&number.to_string())
        }

        fn visit_i64<E: serde::de::Error>(self, number: i64) -> Result<T, E> {
            self.visit_str(&number.to_string())
        }
    }

    deserializer.deserialize_any(Typed(std::marker::PhantomData)).map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCALE: DrawingScale = DrawingScale { mm_per_unit: Some(0.5), diagonal: 200.0 };

    #[test]
    fn flags_beat_the_file_and_the_file_beats_defaults() {
        let file: JobFile = "tool-diameter = \"1/8in\"\ndepth = 6\nfeed = \"20mm/s\"\nside = \"inside\"\n\
                             path-radius = \"auto\"\nstock-top = 18.5\nspindle-speed = 12000\nentry = \"plunge\""
            .parse()
            .unwrap();
        let flags = JobFile { depth: Some(Length::UserUnits(8.0)), ..JobFile::default() };
        let job = flags.over(file).resolve(&SCALE).unwrap();
        let expected = Job {
            tool_diameter: 3.175,
            depth: 4.0,
            feed: Speed::from_mm_per_min(1200.0).unwrap(),
            side: Side::Inside,
            stock_top: 18.5,
            // Not typed: it follows the stock.
            safe_height: 23.5,
            spindle_speed: 12_000.0,
            entry: Entry::Plunge,
            ..Job::default()
        };
        assert_eq!(job, expected);
        assert_eq!(JobFile::default().resolve(&SCALE), Ok(Job::default()));
    }

    #[test]
    fn bad_files_are_refused_with_the_place() {
        for (text, word) in [
            ("dept = 3", "unknown field"),
            ("depth = \"3 furlongs\"", "is no length"),
            ("depth = nan", "is no length"),
            ("feed = 0", "is no feed"),
            ("side = \"left\"", "outside, inside, on"),
            ("origin = 3", "corner, center, drawing"),
            ("depth = 3\ndepth = 4", "duplicate key"),
            ("dwell = \"long\"", "line 1"),
            ("depth = [3]", "a text or a number"),
            ("=", "line 1"),
        ] {
            let error = text.parse::<JobFile>().expect_err(text).to_string();
            assert!(error.contains(word), "{text}: {error}");
        }
    }

    #[test]
    fn all_problems_are_reported_together() {
        let bare = DrawingScale { mm_per_unit: None, diagonal: 200.0 };
        let file: JobFile = "depth = \"2%\"\ntool-diameter = -1\nsafe-height = -3".parse().unwrap();
        let invalid = file.resolve(&bare).unwrap_err();
        assert_eq!(invalid.problems.len(), 3, "{invalid}");
        assert!(matches!(invalid.problems[0], JobProblem::Length { field: "depth", .. }));
    }
}
