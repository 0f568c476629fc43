//! Numbers as a program writes them: whole multiples of the last decimal.
//!
//! Everything that depends on written places is computed from the multiples, so that what the machine reads is what was
//! checked. There is no -0, no exponent, no NaN: the integer has none.

use std::fmt;

/// The largest place that is written, in millimetres: 100 m. With four decimals five such numbers and a feed fit a line of 79.
const LARGEST_PLACE: f64 = 1e5;

/// The largest feed, speed or time that is written: beyond any machine.
const LARGEST_VALUE: f64 = 1e6;

/// The places that can be written: multiples of `step` millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    /// Decimals of the written number.
    decimals: u8,
    /// Millimetres in a multiple.
    step: f64,
}

impl Grid {
    /// Numbers of `decimals` decimals in a unit of `unit_mm` millimetres.
    pub(super) fn new(decimals: u8, unit_mm: f64) -> Grid {
        Grid { decimals, step: unit_mm / 10f64.powi(i32::from(decimals)) }
    }

    /// Millimetres between neighbouring numbers.
    pub(super) fn step(&self) -> f64 {
        self.step
    }

    /// The nearest multiple; `None` for what cannot be written.
    pub(super) fn round(&self, mm: f64) -> Option<i64> {
        (mm.abs() <= LARGEST_PLACE).then(|| (mm / self.step).round() as i64)
    }

    /// The millimetres of a multiple.
    pub(super) fn mm(&self, multiple: i64) -> f64 {
        multiple as f64 * self.step
    }

    /// A multiple as text.
    pub(super) fn text(&self, multiple: i64) -> Decimal {
        Decimal { multiple, decimals: self.decimals }
    }
}

/// A decimal number without superfluous zeros.
#[derive(Clone, Copy, Debug)]
pub(super) struct Decimal {
    multiple: i64,
    decimals: u8,
}

impl Decimal {
    /// `value` to at most `decimals` decimals; `None` for what cannot be written.
    pub(super) fn of(value: f64, decimals: u8) -> Option<Decimal> {
        let multiple = (value * 10f64.powi(i32::from(decimals))).round();
        (value.abs() <= LARGEST_VALUE).then_some(Decimal { multiple: multiple as i64, decimals })
    }
}

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scale = 10u64.pow(u32::from(self.decimals));
        let magnitude = self.multiple.unsigned_abs();
        let (whole, mut part) = (magnitude / scale, magnitude % scale);
        let sign = if self.multiple < 0 { "-" } else { "" };
        if part == 0 {
            return write!(f, "{sign}{whole}");
        }
        let mut width = usize::from(self.decimals);
        while part % 10 == 0 {
            part /= 10;
            width -= 1;
        }
        write!(f, "{sign}{whole}.{part:0width$}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_plain() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (-0.00004, "0"),
            (-0.00006, "-0.0001"),
            (1.5, "1.5"),
            (-12.0305, "-12.0305"),
            (100.0, "100"),
            (99_999.999_96, "100000"),
            (1e-20, "0"),
        ] {
            assert_eq!(Decimal::of(value, 4).unwrap().to_string(), text);
        }
        for value in [f64::NAN, f64::INFINITY, 1e7] {
            assert!(Decimal::of(value, 4).is_none(), "{value}");
        }
        assert_eq!(Decimal::of(2.4, 0).unwrap().to_string(), "2");
        assert_eq!(Decimal::of(1_200.123_456, 6).unwrap().to_string(), "1200.123456");
        assert_eq!(Decimal::of(-100_000.0, 6).unwrap().to_string(), "-100000");
    }

    #[test]
    fn an_inch_grid_counts_in_millimetres() {
        let grid = Grid::new(5, 25.4);
        let half = grid.round(12.7).unwrap();
        assert_eq!(grid.text(half).to_string(), "0.5");
        assert!((grid.mm(half) - 12.7).abs() < 1e-12);
    }
}
