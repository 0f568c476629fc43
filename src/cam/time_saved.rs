//! What rounding a path saves: the same work with sharp inside corners, on the same planner.

use super::certificate::statistics;
use super::motion::Program;
use super::time::{Machine, ProgramTime, estimate};

/// Two programs for the same work, one with the chosen path radius and one with sharp inside corners.
///
/// Compared is the time at a feed: travel and waiting for the spindle have nothing to do with corners. A part of what is saved
/// is the shorter path, hence both lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct TimeSaved {
    /// Time of the rounded path.
    pub rounded: ProgramTime,
    /// Time of the sharp path.
    pub sharp: ProgramTime,
    /// Way of the rounded path at a feed below the top of the stock, in millimetres.
    pub rounded_length_mm: f64,
    /// Way of the sharp path at a feed below the top of the stock, in millimetres.
    pub sharp_length_mm: f64,
    /// Whether both go around equally many outlines: where rounding loses a hole, it does not save its time.
    pub same_outlines: bool,
}

impl TimeSaved {
    /// Both programs on `machine`, the top of the stock at `stock_top`.
    pub fn between(rounded: &Program, sharp: &Program, machine: &Machine, stock_top: f64) -> TimeSaved {
        TimeSaved {
            rounded: estimate(rounded, machine),
            sharp: estimate(sharp, machine),
            rounded_length_mm: statistics(rounded, stock_top).cut_length_mm,
            sharp_length_mm: statistics(sharp, stock_top).cut_length_mm,
            same_outlines: true,
        }
    }

    /// Both together, one after the other.
    pub fn and(&self, other: &TimeSaved) -> TimeSaved {
        TimeSaved {
            rounded: self.rounded.and(&other.rounded),
            sharp: self.sharp.and(&other.sharp),
            rounded_length_mm: self.rounded_length_mm + other.rounded_length_mm,
            sharp_length_mm: self.sharp_length_mm + other.sharp_length_mm,
            same_outlines: self.same_outlines && other.same_outlines,
        }
    }

    /// Seconds at a feed that are saved; below zero where rounding costs some.
    pub fn seconds(&self) -> f64 {
        self.sharp.feed_seconds - self.rounded.feed_seconds
    }

    /// What is saved of the sharp path's seconds at a feed, in per cent.
    pub fn percent(&self) -> f64 {
        if self.sharp.feed_seconds > 0.0 { 100.0 * self.seconds() / self.sharp.feed_seconds } else { 0.0 }
    }

    /// What is saved of the sharp path's length, in per cent.
    pub fn length_percent(&self) -> f64 {
        let shorter = self.sharp_length_mm - self.rounded_length_mm;
        if self.sharp_length_mm > 0.0 { 100.0 * shorter / self.sharp_length_mm } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::read;

    /// An inside corner of a right angle, sharp and on an arc of 3 mm, at 33 mm/s.
    #[test]
    fn a_rounded_corner_is_shorter_and_faster() {
        let program = |corner: &str| {
            read(&format!("G21 G90 G17 G94\nM3 S1000\nG0 X0 Y0\nG0 Z-1\nG1 X27 F2000\n{corner}G1 X30 Y30\n")).unwrap()
        };
        let (rounded, sharp) = (program("G3 X30 Y3 I0 J3\n"), program("G1 X30 Y0\n"));
        let saved = TimeSaved::between(&rounded, &sharp, &Machine::default(), 0.0);
        assert_eq!(saved.sharp_length_mm, 60.0);
        let shorter = 6.0 - 1.5 * std::f64::consts::PI;
        assert!((saved.sharp_length_mm - saved.rounded_length_mm - shorter).abs() < 1e-9);
        assert!((saved.length_percent() - 100.0 * shorter / 60.0).abs() < 1e-9);
        // The arc needs v²/a = 2.2 mm for the full feed: it has it. Stopping and starting again costs about v/a.
        let crawl = 2000.0 / 60.0 / 500.0;
        let feed = shorter * 60.0 / 2000.0;
        assert!(saved.seconds() > 0.8 * (crawl + feed) && saved.seconds() < crawl + feed, "{saved:?}");
        assert!((saved.percent() - 100.0 * saved.seconds() / saved.sharp.feed_seconds).abs() < 1e-12);
        let twice = saved.and(&saved);
        assert_eq!(twice.seconds(), 2.0 * saved.seconds());
        assert_eq!(TimeSaved::default().percent(), 0.0);
    }
}
