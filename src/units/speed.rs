//! Feeds: `1200mm/min`, `47in/min`, `20mm/s`.

use std::fmt;
use std::str::FromStr;

use super::{Brief, MM_PER_INCH};

/// A speed in millimetres a minute, above zero.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Speed(f64);

/// Why a text is not a speed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("\"{text}\" is no feed: write a number above zero with mm/min, mm/s or in/min, for example 1200mm/min")]
pub struct ParseSpeedError {
    text: String,
}

impl Speed {
    /// A speed from millimetres a minute, `None` unless finite and above zero.
    pub fn from_mm_per_min(value: f64) -> Option<Speed> {
        (value.is_finite() && value > 0.0).then_some(Speed(value))
    }

    /// Millimetres a minute.
    pub fn mm_per_min(self) -> f64 {
        self.0
    }

    /// Millimetres a second.
    pub fn mm_per_s(self) -> f64 {
        self.0 / 60.0
    }
}

impl FromStr for Speed {
    type Err = ParseSpeedError;

    fn from_str(text: &str) -> Result<Speed, ParseSpeedError> {
        let error = || ParseSpeedError { text: text.to_owned() };
        let lower = text.trim().to_ascii_lowercase();
        let units = [("mm/min", 1.0), ("mm/s", 60.0), ("in/min", MM_PER_INCH), ("ipm", MM_PER_INCH), ("", 1.0)];
        let (digits, factor) =
            units.iter().find_map(|(unit, factor)| Some((lower.strip_suffix(unit)?, factor))).ok_or_else(error)?;
        let number: f64 = digits.trim().parse().map_err(|_| error())?;
        Speed::from_mm_per_min(number * factor).ok_or_else(error)
    }
}

impl fmt::Display for Speed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}mm/min", Brief(self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn feeds_are_read_with_their_units() {
        for (text, expected) in [("1200", 1200.0), ("1200 mm/min", 1200.0), ("20mm/s", 1200.0), ("10ipm", 254.0)] {
            let speed: Speed = text.parse().unwrap();
            assert!((speed.mm_per_min() - expected).abs() < 1e-9, "{text}");
        }
        for text in ["0", "-3", "fast", "nan", "3mm"] {
            assert!(text.parse::<Speed>().is_err(), "{text} should be refused");
        }
    }
}
