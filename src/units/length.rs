//! Lengths with a unit: `2mm`, `0.125in`, `1/8in`, `3px`, `5u`, `2%`.

use std::fmt;
use std::str::FromStr;

use super::{Brief, MM_PER_INCH, PX_PER_INCH};

/// A length as it was typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Length {
    /// Millimetres; also a bare number.
    Millimetres(f64),
    /// Inches.
    Inches(f64),
    /// CSS pixels, 96 to the inch.
    Pixels(f64),
    /// User units of the drawing's root element.
    UserUnits(f64),
    /// Per cent of the diagonal of the drawing's bounding box.
    Percent(f64),
}

/// What a length needs to know of the drawing it is meant for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawingScale {
    /// Millimetres in a user unit; `None` where the drawing has no physical size.
    pub mm_per_unit: Option<f64>,
    /// Diagonal of the bounding box of the filled region, in user units.
    pub diagonal: f64,
}

/// Why a text is not a length.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "\"{text}\" is no length: write a number with mm, in, px, u or %, for example 2mm or 1/8in; a bare number is \
     millimetres, and a fraction needs its unit"
)]
pub struct ParseLengthError {
    text: String,
}

/// Why a length has no meaning for a drawing.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ResolveLengthError {
    /// A physical length on a drawing without physical size.
    #[error(
        "{0} means nothing on a drawing without a physical size: give the length in user units (5u) or per cent (2%), \
         or say how large the drawing is with --dpi or --width"
    )]
    NoPhysicalSize(Length),
}

impl Length {
    /// The length in user units of the drawing.
    ///
    /// # Errors
    /// Where the length is physical and the drawing has no physical size.
    pub fn to_user_units(self, scale: &DrawingScale) -> Result<f64, ResolveLengthError> {
        let physical = |mm: f64| match scale.mm_per_unit {
            Some(mm_per_unit) => Ok(mm / mm_per_unit),
            None => Err(ResolveLengthError::NoPhysicalSize(self)),
        };
        match self {
            Length::Millimetres(mm) => physical(mm),
            Length::Inches(inch) => physical(inch * MM_PER_INCH),
            Length::Pixels(px) => physical(px * MM_PER_INCH / PX_PER_INCH),
            Length::UserUnits(units) => Ok(units),
            Length::Percent(percent) => Ok(percent / 100.0 * scale.diagonal),
        }
    }

    /// The length in millimetres.
    ///
    /// # Errors
    /// Where the length is relative to a drawing without physical size.
    pub fn to_millimetres(self, scale: &DrawingScale) -> Result<f64, ResolveLengthError> {
        let relative = |units: f64| match scale.mm_per_unit {
            Some(mm_per_unit) => Ok(units * mm_per_unit),
            None => Err(ResolveLengthError::NoPhysicalSize(self)),
        };
        match self {
            Length::Millimetres(mm) => Ok(mm),
            Length::Inches(inch) => Ok(inch * MM_PER_INCH),
            Length::Pixels(px) => Ok(px * MM_PER_INCH / PX_PER_INCH),
            Length::UserUnits(units) => relative(units),
            Length::Percent(percent) => relative(percent / 100.0 * scale.diagonal),
        }
    }
}

impl FromStr for Length {
    type Err = ParseLengthError;

    fn from_str(text: &str) -> Result<Length, ParseLengthError> {
        let error = || ParseLengthError { text: text.to_owned() };
        let trimmed = text.trim();
        let digits = trimmed.trim_end_matches(|c: char| c.is_ascii_alphabetic() || c == '%' || c == '"');
        let unit = trimmed[digits.len()..].to_ascii_lowercase();
        let number = parse_number(digits.trim()).ok_or_else(error)?;
        match unit.as_str() {
            // Who writes 1/8 and no unit means inches more often than an eighth of a millimetre: nobody guesses.
            "" if digits.contains('/') => Err(error()),
            "" | "mm" => Ok(Length::Millimetres(number)),
            "cm" => Ok(Length::Millimetres(number * 10.0)),
            "in" | "\"" => Ok(Length::Inches(number)),
            "px" => Ok(Length::Pixels(number)),
            "u" => Ok(Length::UserUnits(number)),
            "%" => Ok(Length::Percent(number)),
            _ => Err(error()),
        }
    }
}

/// A finite decimal number, a fraction (`1/8`) or a whole number and a fraction (`1 1/8`).
fn parse_number(text: &str) -> Option<f64> {
    let Some((above, below)) = text.split_once('/') else {
        return text.parse().ok().filter(|x: &f64| x.is_finite());
    };
    let (whole, above) = above.trim().rsplit_once(char::is_whitespace).unwrap_or(("0", above.trim()));
    let whole: f64 = whole.trim().parse().ok()?;
    let above: f64 = above.parse().ok()?;
    let below: f64 = below.trim().parse().ok()?;
    Some(whole + above / below).filter(|x| x.is_finite())
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Length::Millimetres(x) => write!(f, "{}mm", Brief(*x)),
            Length::Inches(x) => write!(f, "{}in", Brief(*x)),
            Length::Pixels(x) => write!(f, "{}px", Brief(*x)),
            Length::UserUnits(x) => write!(f, "{}u", Brief(*x)),
            Length::Percent(x) => write!(f, "{}%", Brief(*x)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_read_with_their_units() {
        for (text, expected) in [
            ("2mm", Length::Millimetres(2.0)),
            (" 2 ", Length::Millimetres(2.0)),
            ("1.5cm", Length::Millimetres(15.0)),
            ("0.125in", Length::Inches(0.125)),
            ("1/8in", Length::Inches(0.125)),
            ("1 1/8 in", Length::Inches(1.125)),
            ("1/4\"", Length::Inches(0.25)),
            ("3px", Length::Pixels(3.0)),
            ("5u", Length::UserUnits(5.0)),
            ("2%", Length::Percent(2.0)),
            ("-1MM", Length::Millimetres(-1.0)),
            ("1e-3mm", Length::Millimetres(1e-3)),
        ] {
            assert_eq!(text.parse(), Ok(expected), "{text}");
        }
        for text in ["", "mm", "2 metres", "1/0in", "nan", "inf", "1/2/3", "1/8", "2mm mm", "1e999"] {
            assert!(text.parse::<Length>().is_err(), "{text} should be refused");
        }
    }

    #[test]
    fn lengths_resolve_against_the_drawing() {
        let inch_drawing = DrawingScale { mm_per_unit: Some(0.254), diagonal: 200.0 };
        assert_eq!(Length::Inches(1.0).to_user_units(&inch_drawing), Ok(100.0));
        assert_eq!(Length::Percent(1.0).to_user_units(&inch_drawing), Ok(2.0));
        assert_eq!(Length::UserUnits(100.0).to_millimetres(&inch_drawing), Ok(25.4));
        let unsized_drawing = DrawingScale { mm_per_unit: None, diagonal: 200.0 };
        assert_eq!(Length::UserUnits(3.0).to_user_units(&unsized_drawing), Ok(3.0));
        assert!(Length::Pixels(3.0).to_user_units(&unsized_drawing).is_err());
        assert!(Length::Percent(3.0).to_millimetres(&unsized_drawing).is_err());
    }
}
