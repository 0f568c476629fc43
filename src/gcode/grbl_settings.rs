//! What GRBL says of its machine when it is asked for `$$`.
//!
//! Lines such as `$110=2000.000`, with or without the explanations that older versions add in brackets. Settings that say
//! nothing about motion are read and left out; lines of other kinds (`ok`, `[MSG:...]`) are passed over, as a copy from a
//! terminal has them.

use crate::cam::Machine;

/// The settings that decide how a machine moves. What the text does not say is `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GrblSettings {
    /// $11, millimetres.
    pub junction_deviation: Option<f64>,
    /// $12, millimetres.
    pub arc_tolerance: Option<f64>,
    /// $30, turns a minute.
    pub spindle_max: Option<f64>,
    /// $31, turns a minute.
    pub spindle_min: Option<f64>,
    /// $32.
    pub laser_mode: Option<bool>,
    /// $110 to $112, millimetres a minute.
    pub max_rate: [Option<f64>; 3],
    /// $120 to $122, millimetres a second squared.
    pub acceleration: [Option<f64>; 3],
    /// $130 to $132, millimetres.
    pub travel: [Option<f64>; 3],
}

/// Why a text is no list of settings.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GrblSettingsError {
    /// A line that begins with `$` but is not of the form `$110=2000`.
    #[error("line {line}: \"{text}\" is no setting; expected $NUMBER=VALUE, for example $110=2000")]
    Line {
        /// The line, counted from 1.
        line: usize,
        /// What it says.
        text: String,
    },
    /// A value that no machine has.
    #[error("line {line}: ${setting} is {value}: {expected}")]
    Value {
        /// The line, counted from 1.
        line: usize,
        /// The number of the setting.
        setting: u32,
        /// Its value.
        value: f64,
        /// What it should be.
        expected: &'static str,
    },
    /// A setting that is there twice, with two values: two machines in one file.
    #[error("line {line}: ${setting} is said again, with another value: is this the list of one machine?")]
    Twice {
        /// The line, counted from 1.
        line: usize,
        /// The number of the setting.
        setting: u32,
    },
    /// No line of the text is a setting.
    #[error("there is no setting such as $110=2000 in it: save what the controller answers to $$")]
    Empty,
}

/// Reads what GRBL answers to `$$`.
///
/// # Errors
/// Names the line that is no setting, or whose value makes no sense.
pub fn read(text: &str) -> Result<GrblSettings, GrblSettingsError> {
    let mut settings = GrblSettings::default();
    let mut is_empty = true;
    for (index, row) in text.lines().enumerate() {
        let line = index + 1;
        let row = row.trim().trim_start_matches('\u{feff}');
        let Some(rest) = row.strip_prefix('$').filter(|rest| !rest.starts_with('$')) else { continue };
        let bad = || GrblSettingsError::Line { line, text: row.to_owned() };
        let (number, value) = rest.split_once('=').ok_or_else(bad)?;
        let Ok(setting) = number.trim().parse::<u32>() else {
            // grblHAL and FluidNC have settings with names, which say nothing here.
            if number.starts_with(|c: char| c.is_ascii_alphabetic() || c == '/') {
                continue;
            }
            return Err(bad());
        };
        is_empty = false;
        // Older versions explain: `$110=2000.000 (x max rate, mm/min)`.
        let value = value.split('(').next().unwrap_or("").trim().parse::<f64>();
        if setting == LASER_MODE {
            settings.laser_mode = Some(value.map_err(|_| bad())? != 0.0);
            continue;
        }
        let Some((place, expected)) = settings.place(setting) else { continue };
        let value = value.map_err(|_| bad())?;
        let is_good = match expected {
            Expected::Positive => value > 0.0 && value <= LARGEST_VALUE,
            Expected::NotNegative => (0.0..=LARGEST_VALUE).contains(&value),
            Expected::Rate => (SMALLEST_RATE..=LARGEST_VALUE).contains(&value),
            Expected::Deviation => value > 0.0 && value <= LARGEST_DEVIATION,
        };
        if !is_good {
            return Err(GrblSettingsError::Value { line, setting, value, expected: expected.words() });
        }
        if place.is_some_and(|before| before != value) {
            return Err(GrblSettingsError::Twice { line, setting });
        }
        *place = Some(value);
    }
    if is_empty { Err(GrblSettingsError::Empty) } else { Ok(settings) }
}

/// The setting that says whether S is a beam's power.
const LASER_MODE: u32 = 32;

/// More than any machine does, of any unit: mm, mm/min, mm/s², turns a minute.
const LARGEST_VALUE: f64 = 1e6;

/// Slower than this, in mm/min or mm/s², a machine stands still for all that anyone sees.
const SMALLEST_RATE: f64 = 0.1;

/// Larger than this, in millimetres, a deviation is a slip of the unit.
const LARGEST_DEVIATION: f64 = 1.0;

#[derive(Clone, Copy)]
enum Expected {
    Positive,
    NotNegative,
    Rate,
    Deviation,
}

impl Expected {
    fn words(self) -> &'static str {
        match self {
            Expected::Positive => "it must be above zero, and at most 1000000",
            Expected::NotNegative => "it must not be below zero, and at most 1000000",
            Expected::Rate => "it must be at least 0.1, and at most 1000000; values above zero move a machine",
            Expected::Deviation => "it must be above zero, and at most 1 mm",
        }
    }
}

impl GrblSettings {
    /// Where the value of a setting belongs; `None` for those that say nothing about motion.
    fn place(&mut self, setting: u32) -> Option<(&mut Option<f64>, Expected)> {
        let axis = (setting % 10) as usize;
        Some(match setting {
            11 => (&mut self.junction_deviation, Expected::Deviation),
            12 => (&mut self.arc_tolerance, Expected::Deviation),
            30 => (&mut self.spindle_max, Expected::NotNegative),
            31 => (&mut self.spindle_min, Expected::NotNegative),
            110..=112 => (&mut self.max_rate[axis], Expected::Rate),
            120..=122 => (&mut self.acceleration[axis], Expected::Rate),
            130..=132 => (&mut self.travel[axis], Expected::Positive),
            _ => return None,
        })
    }

    /// The machine, as far as the settings say; the rest is that of `below`.
    pub fn machine(&self, below: &Machine) -> Machine {
        let axes = |ours: [Option<f64>; 3], theirs: [f64; 3]| {
            let mut axes = theirs;
            axes.iter_mut().zip(ours).for_each(|(axis, value)| *axis = value.unwrap_or(*axis));
            axes
        };
        Machine {
            acceleration: axes(self.acceleration, below.acceleration),
            rapid: axes(self.max_rate, below.rapid),
            junction_deviation: self.junction_deviation.unwrap_or(below.junction_deviation),
            arc_tolerance: self.arc_tolerance.unwrap_or(below.arc_tolerance),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DUMP: &str = "\u{feff}>>> $$\n$0=10\n$1=25\n$11=0.020\n$12=0.002\n$13=0\n$30=24000\n$31=0\n$32=1\n$100=800.000\n\
        $110=2000.000 (x max rate, mm/min)\n$111=2500.000\n$112=600.000\n$120=300.000\n$121=250.000\n$122=100.000\n\
        $130=300.000\n$131=180.000\n$132=45.000\nok\n";

    #[test]
    fn a_whole_list_is_a_machine() {
        let settings = read(DUMP).unwrap();
        assert_eq!((settings.spindle_max, settings.spindle_min), (Some(24_000.0), Some(0.0)));
        assert_eq!(settings.laser_mode, Some(true));
        assert_eq!(settings.travel, [Some(300.0), Some(180.0), Some(45.0)]);
        let machine = settings.machine(&Machine::default());
        let expected = Machine {
            acceleration: [300.0, 250.0, 100.0],
            rapid: [2000.0, 2500.0, 600.0],
            junction_deviation: 0.02,
            arc_tolerance: 0.002,
        };
        assert_eq!(machine, expected);
    }

    #[test]
    fn what_is_not_said_is_left_as_it_was() {
        let machine = read("$120 = 750\n$Spindle/Type=PWM\n$N0=\n[MSG:Caution: Unlocked]").unwrap();
        let expected = Machine { acceleration: [750.0, 500.0, 500.0], ..Machine::default() };
        assert_eq!(machine.machine(&Machine::default()), expected);
        assert_eq!(machine.laser_mode, None);
    }

    #[test]
    fn a_wrong_line_is_named() {
        for (text, words) in [
            ("$11=0.01\n$110", "line 2: \"$110\" is no setting"),
            ("$110=fast", "line 1"),
            ("$110=", "line 1"),
            ("\n\n$120=-5", "line 3: $120 is -5"),
            ("$111=0", "above zero"),
            ("\n$130=0", "line 2: $130 is 0"),
            ("$120=1e308", "line 1: $120 is 1"),
            ("$110=1e-300", "at least 0.1"),
            ("$11=2", "at most 1 mm"),
            ("$12=nan", "$12 is NaN"),
            ("$-1=3", "$NUMBER=VALUE"),
            ("$110=2000\n$110=3000", "line 2: $110 is said again"),
            ("G21\nok", "there is no setting"),
            ("", "there is no setting"),
        ] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.contains(words), "{text:?}: {error}");
        }
        assert!(read("$110=2000\n$110=2000").is_ok());
    }
}
