//! Numbers in messages.

use std::fmt;

/// A number as people read it: in full where that is short, with an exponent where it would be a row of zeros.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brief(pub f64);

/// Below and above these, numbers are written with an exponent.
const SMALLEST: f64 = 1e-6;
const LARGEST: f64 = 1e15;

impl fmt::Display for Brief {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Brief(x) = *self;
        if x == 0.0 || !x.is_finite() || (SMALLEST..LARGEST).contains(&x.abs()) {
            write!(f, "{x}")
        } else {
            write!(f, "{x:e}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Brief;

    #[test]
    fn no_number_is_a_row_of_zeros() {
        for (x, text) in [
            (0.0, "0"),
            (2.0, "2"),
            (-0.125, "-0.125"),
            (1e300, "1e300"),
            (-2.5e20, "-2.5e20"),
            (3e-9, "3e-9"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(Brief(x).to_string(), text);
        }
        assert!(Brief(f64::MAX).to_string().len() < 25 && Brief(f64::MIN_POSITIVE).to_string().len() < 25);
    }
}
