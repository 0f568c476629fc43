//! Lengths in a font: `30u`, `40em/1000`, `0.04em`.

use std::fmt;
use std::str::FromStr;

use super::Brief;

/// A length in the measure of a font, as it was typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FontLength {
    /// Font units; also a bare number.
    Units(f64),
    /// Parts of the em.
    Ems(f64),
    /// Thousandths of the em.
    Mille(f64),
}

/// Why a text is not a length in a font.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "\"{text}\" is no length in a font: write a number with u (font units), em or em/1000, for example 30u or 40em/1000; a \
     bare number is font units"
)]
pub struct ParseFontLengthError {
    text: String,
}

impl FontLength {
    /// The length in units of a font that has `units_per_em`.
    pub fn to_units(self, units_per_em: f64) -> f64 {
        match self {
            FontLength::Units(units) => units,
            FontLength::Ems(ems) => ems * units_per_em,
            FontLength::Mille(mille) => mille * units_per_em / 1000.0,
        }
    }

    /// The number that was typed, without its unit.
    pub fn number(self) -> f64 {
        match self {
            FontLength::Units(x) | FontLength::Ems(x) | FontLength::Mille(x) => x,
        }
    }
}

impl FromStr for FontLength {
    type Err = ParseFontLengthError;

    fn from_str(text: &str) -> Result<FontLength, ParseFontLengthError> {
        let error = || ParseFontLengthError { text: text.to_owned() };
        let lower = text.trim().to_ascii_lowercase();
        let unit = ["em/1000", "em", "u"].into_iter().find(|unit| lower.ends_with(unit)).unwrap_or("");
        let digits = lower[..lower.len() - unit.len()].trim();
        let number = digits.parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(error)?;
        Ok(match unit {
            "em/1000" => FontLength::Mille(number),
            "em" => FontLength::Ems(number),
            _ => FontLength::Units(number),
        })
    }
}

impl fmt::Display for FontLength {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = match self {
            FontLength::Units(_) => "u",
            FontLength::Ems(_) => "em",
            FontLength::Mille(_) => "em/1000",
        };
        write!(f, "{}{unit}", Brief(self.number()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_of_fonts_are_read_with_their_units() {
        for (text, units) in [("30u", 30.0), ("30", 30.0), (" 40em/1000 ", 81.92), ("0.5 EM", 1024.0), ("-1u", -1.0)] {
            assert_eq!(text.parse::<FontLength>().unwrap().to_units(2048.0), units, "{text}");
        }
        for text in ["", "u", "3mm", "2%", "1em/100", "nan", "inf", "1e999u"] {
            assert!(text.parse::<FontLength>().is_err(), "{text} should be refused");
        }
    }

    #[test]
    fn what_is_shown_is_read_again() {
        for length in [FontLength::Units(30.0), FontLength::Ems(0.04), FontLength::Mille(40.5)] {
            assert_eq!(length.to_string().parse(), Ok(length));
        }
    }
}
