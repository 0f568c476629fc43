//! Reading a dialect from its file.

use super::{Dialect, FILES, MachineKind};
use crate::units::nearest_name;

/// The fewest and the most decimals of coordinates: fewer are felt on the part, more than single precision holds.
const DECIMALS_MM: std::ops::RangeInclusive<u8> = 2..=6;
/// The same in inches.
const DECIMALS_INCH: std::ops::RangeInclusive<u8> = 3..=6;
/// A line is at least as long as an arc with all its words in a small program; shorter limits cannot be kept.
const SHORTEST_LINE: usize = 60;
/// More decimals of a time than controllers count.
const MOST_DWELL_DECIMALS: u8 = 3;

/// Why a text is no dialect.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DialectError {
    /// The text is no TOML, or a key is missing, unknown or of the wrong type.
    #[error(transparent)]
    Toml(#[from] toml::de::Error),
    /// The key `base` names no built-in dialect.
    #[error("base: \"{name}\" is no built-in dialect{}: there are {known}", .meant.map_or(String::new(), |m| format!(" (do you mean {m}?)")))]
    Base {
        /// What it names.
        name: String,
        /// The built-in ones.
        known: String,
        /// The nearest of them.
        meant: Option<&'static str>,
    },
    /// A value that makes no sense.
    #[error("{key}: {problem}")]
    Value {
        /// The key.
        key: &'static str,
        /// What is wrong with its value, and what would be right.
        problem: String,
    },
}

impl Dialect {
    /// The dialect that `text` describes; it is called `name` unless it says otherwise.
    ///
    /// # Errors
    /// Names the key that is wrong.
    pub fn parse(text: &str, name: &str) -> Result<Dialect, DialectError> {
        let table = with_base(toml::from_str(text)?)?;
        let mut dialect: Dialect = table.try_into()?;
        if dialect.name.is_empty() {
            name.clone_into(&mut dialect.name);
        }
        dialect.validate()?;
        Ok(dialect)
    }

    fn validate(&self) -> Result<(), DialectError> {
        let wrong = |key, problem: &str| Err(DialectError::Value { key, problem: problem.to_owned() });
        let positive = |value: f64| value.is_finite() && value > 0.0;
        if self.name.trim() != self.name || self.name.is_empty() || !self.name.chars().all(|c| c.is_ascii_graphic()) {
            return wrong("name", "a name is one word of plain letters, digits and signs");
        }
        if !self.letters.chars().all(|c| c.is_ascii_uppercase()) || !"XY".chars().all(|c| self.letters.contains(c)) {
            return wrong("letters", "these are upper-case letters, X and Y among them");
        }
        if self.units.is_empty() {
            return wrong("units", "needs \"mm\", \"inch\" or both");
        }
        if !DECIMALS_MM.contains(&self.decimals_mm) {
            return wrong("decimals-mm", "from 2 to 6 are possible; three or more are sensible");
        }
        if !DECIMALS_INCH.contains(&self.decimals_inch) {
            return wrong("decimals-inch", "from 3 to 6 are possible; four or more are sensible");
        }
        if self.longest_line < SHORTEST_LINE {
            return wrong("longest-line", "arcs need lines of at least 60 characters");
        }
        if self.dwell_decimals > MOST_DWELL_DECIMALS {
            return wrong("dwell-decimals", "from 0 to 3 are possible");
        }
        if !self.dwell_units.contains_key(&self.dwell_word) {
            return wrong("dwell-word", "dwell-units does not say what this letter means");
        }
        if !positive(self.largest_arc_radius) {
            return wrong("largest-arc-radius", "must be a length above zero, in millimetres");
        }
        if self.corner_tolerance.is_some_and(|t| !(t.is_finite() && t >= 0.0)) {
            return wrong("corner-tolerance", "must be a length in millimetres, or 0");
        }
        if self.radius_slack.is_some_and(|s| !(s.is_finite() && s >= 0.0)) {
            return wrong("radius-slack", "must be a length in millimetres, or 0");
        }
        if self.rapid_feed.is_some_and(|f| !positive(f)) {
            return wrong("rapid-feed", "must be above zero, in millimetres a minute");
        }
        if self.spindle_full.is_some_and(|f| !positive(f.rpm) || !positive(f.word)) {
            return wrong("spindle-full", "rpm and word must be above zero");
        }
        if self.arc_mismatch.is_some_and(|m| ![m.mm, m.inch, m.relative].iter().all(|v| v.is_finite() && *v >= 0.0)) {
            return wrong("arc-mismatch", "lengths in millimetres and a share of the radius, none below zero");
        }
        if !self.spindle_on.contains("{speed}") && self.machine != MachineKind::Pen {
            return wrong("spindle-on", "{speed} is missing, for example \"M3 S{speed}\"");
        }
        if self.machine == MachineKind::Pen {
            match (self.pen_up_z, self.pen_down_z) {
                (Some(up), Some(down)) if !self.letters.contains('Z') || !up.is_finite() || !down.is_finite() => {
                    return wrong("pen-up-z", "lifting a pen by Z needs Z among the letters, and heights");
                }
                (Some(up), Some(down)) if up <= down => return wrong("pen-up-z", "must be above pen-down-z"),
                (Some(_), Some(_)) => {}
                (None, None) if !self.pen_up.is_empty() && !self.pen_down.is_empty() => {}
                _ => {
                    let both = "a pen needs pen-up and pen-down lines, or pen-up-z and pen-down-z";
                    return wrong("pen-up", both);
                }
            }
        }
        self.validate_lines()
    }

    /// Whatever is written as it stands must be text that fits a line.
    fn validate_lines(&self) -> Result<(), DialectError> {
        let lines: [(&'static str, &[String], Option<&str>); 9] = [
            ("preamble", &self.preamble, None),
            ("program-end", &self.program_end, None),
            ("spindle-on", std::slice::from_ref(&self.spindle_on), Some("{speed}")),
            ("spindle-off", std::slice::from_ref(&self.spindle_off), None),
            ("tool-change", &self.tool_change, Some("{number}")),
            ("tool-length-offset", std::slice::from_ref(&self.tool_length_offset), Some("{number}")),
            ("pen-up", &self.pen_up, None),
            ("pen-down", &self.pen_down, None),
            ("title", std::slice::from_ref(&self.title), None),
        ];
        for (key, texts, placeholder) in lines {
            for text in texts {
                let plain = placeholder.map_or_else(|| text.clone(), |p| text.replace(p, ""));
                let problem = match () {
                    () if plain.contains(['{', '}']) => match placeholder {
                        Some(p) => format!("only {p} is filled in here: \"{text}\""),
                        None => format!("nothing is filled in here: \"{text}\""),
                    },
                    () if !text.chars().all(|c| c.is_ascii_graphic() || c == ' ') => {
                        format!("a line holds plain ASCII text: {text:?}")
                    }
                    () if text.len() > self.longest_line => format!("longer than longest-line: \"{text}\""),
                    () => continue,
                };
                return Err(DialectError::Value { key, problem });
            }
        }
        Ok(())
    }
}

/// The table with what its base says and it does not, down to the last base.
fn with_base(mut table: toml::Table) -> Result<toml::Table, DialectError> {
    let Some(base) = table.remove("base") else { return Ok(table) };
    let wanted = base.as_str().unwrap_or("(no text)").to_owned();
    let Some((_, text)) = FILES.iter().find(|(name, _)| *name == wanted) else {
        let names = || FILES.iter().map(|(name, _)| *name);
        return Err(DialectError::Base {
            known: names().collect::<Vec<_>>().join(", "),
            meant: nearest_name(&wanted, names()),
            name: wanted,
        });
    };
    // Built-in files are based on files without a loop, so this ends.
    Ok(merged(with_base(toml::from_str(text)?)?, table))
}

/// `over` on top of `below`; tables are merged key by key, everything else is replaced.
fn merged(mut below: toml::Table, over: toml::Table) -> toml::Table {
    for (key, value) in over {
        match (below.remove(&key), value) {
            // What the letters behind G4 mean is said as a whole.
            (Some(toml::Value::Table(a)), toml::Value::Table(b)) if key != "dwell-units" => {
                below.insert(key, toml::Value::Table(merged(a, b)));
            }
            (_, value) => {
                below.insert(key, value);
            }
        }
    }
    below
}
