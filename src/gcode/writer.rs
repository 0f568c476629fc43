//! Toolpaths as text.
//!
//! Guaranteed: units, plane, absolute coordinates and feed mode are stated before anything moves; z rises first, alone,
//! and again after every change of tool; the spindle runs and has been waited for before anything is cut; every change of
//! feed is written with the first motion that has it; arcs are incremental I and J, solved after rounding; no arc begins and
//! ends at one place; the program ends with z up, spindle off and the program's end. Places are rounded by at most half of
//! the last decimal. A beam is on, and a pen down, only along cuts and ramps.

mod steps;
mod tool;

use std::fmt::Write as _;

use super::grid::{Decimal, Grid};
use super::round_arc::{LARGEST_MISMATCH, LARGEST_SWEEP, Rounded, lines_for_arc, round_arc};
use super::{Dialect, Units};
use crate::cam::{Move, MoveKind, Point3};
use crate::plane::{Arc, Link, Point, Segment, Turn};
use crate::units::MM_PER_INCH;
pub use steps::{ProgramFile, write, write_files, write_steps};

/// How far lines may be from the arc that they stand for, in millimetres, rounding of their ends included.
pub const LINES_FOR_ARC_TOLERANCE: f64 = 0.001;

/// The least that is left of [`LINES_FOR_ARC_TOLERANCE`] once the rounding is taken off, as a share.
const LEAST_TOLERANCE: f64 = 0.25;

/// Decimals of feeds, spindle speeds and seconds.
const RATE_DECIMALS: u8 = 3;

/// How arcs are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Arcs {
    /// As G2 and G3, where the dialect has them.
    #[default]
    Arcs,
    /// As lines within [`LINES_FOR_ARC_TOLERANCE`] that never cut into the part.
    Lines,
}

/// What may be chosen about the text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// Millimetres or inches.
    pub units: Units,
    /// Arcs or lines.
    pub arcs: Arcs,
}

/// Why a toolpath cannot be written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WriteError {
    /// A coordinate is not a number, or larger than any machine.
    #[error(
        "contour {contour} goes to ({x:.3}, {y:.3}, {z:.3}), which is no place on a machine: is the drawing's scale right?"
    )]
    Place {
        /// The contour, counted from 1.
        contour: usize,
        /// x in millimetres.
        x: f64,
        /// y in millimetres.
        y: f64,
        /// z in millimetres.
        z: f64,
    },
    /// A feed, spindle speed or dwell that cannot be written.
    #[error("{what} is {value}, which cannot be written with the decimals that controllers read: is the unit right?")]
    Rate {
        /// Which.
        what: &'static str,
        /// Its value in the program's units.
        value: f64,
    },
    /// The controller does not understand these units.
    #[error(
        "programs for {dialect} cannot be in {unit}: choose the other unit, or name it under units in a dialect file"
    )]
    Units {
        /// The name of the dialect.
        dialect: String,
        /// The unit asked for.
        unit: &'static str,
    },
    /// The spindle of the dialect does not turn so fast.
    #[error(
        "the spindle speed is {speed}, and {dialect} knows none above {most}: see spindle-full in the dialect file"
    )]
    Speed {
        /// The name of the dialect.
        dialect: String,
        /// The speed asked for.
        speed: f64,
        /// Its full speed.
        most: f64,
    },
    /// Several tools in one program, for a controller that cannot change them.
    #[error("programs for {dialect} cannot change tools, and this one has {count}: write one program for each tool")]
    NoToolChange {
        /// The name of the dialect.
        dialect: String,
        /// How many tools there are.
        count: usize,
    },
    /// No step at all.
    #[error("there is nothing to write: the job has no step")]
    Empty,
}

/// The state of the machine as far as the text has told it.
struct Writer<'a> {
    dialect: &'a Dialect,
    grid: Grid,
    /// Millimetres in the program's unit.
    unit: f64,
    arcs: Arcs,
    part_side: Turn,
    cut_feed: f64,
    plunge_feed: f64,
    text: String,
    line_count: usize,
    /// Where the tool is, in multiples of the grid; unknown at the start.
    at: [Option<i64>; 3],
    /// Where the exact path is.
    exact: Point,
    exact_z: f64,
    feed: Option<String>,
    /// The spindle speed or power of the step, as it is written.
    speed: String,
    /// Whether the motion that is being written does the work, so that a beam is on and a pen down.
    is_work: bool,
    /// Whether the beam is on or the pen down; unknown at the start.
    is_engaged: Option<bool>,
}

impl<'a> Writer<'a> {
    fn new(dialect: &'a Dialect, options: WriteOptions) -> Writer<'a> {
        let (unit, decimals) = match options.units {
            Units::Millimetres => (1.0, dialect.decimals_mm),
            Units::Inches => (MM_PER_INCH, dialect.decimals_inch),
        };
        Writer {
            dialect,
            grid: Grid::new(decimals, unit),
            unit,
            arcs: if dialect.arcs { options.arcs } else { Arcs::Lines },
            part_side: Turn::Right,
            cut_feed: 0.0,
            plunge_feed: 0.0,
            text: String::new(),
            line_count: 0,
            // Where depth means nothing it is always where it should be.
            at: [None, None, if dialect.has_depth() { None } else { Some(0) }],
            exact: Point::origin(),
            exact_z: 0.0,
            feed: None,
            speed: String::new(),
            is_work: false,
            is_engaged: None,
        }
    }

    fn line(&mut self, words: &str) {
        self.line_count += 1;
        let is_comment = words.starts_with(self.dialect.comments.marks().0);
        if self.dialect.line_numbers && !is_comment {
            // Infallible: writing to a string.
            let _ = write!(self.text, "N{} ", self.line_count);
        }
        self.text.push_str(words);
        self.text.push('\n');
    }

    fn rapid_z(&mut self, z: f64, contour: usize) -> Result<(), WriteError> {
        if !self.dialect.has_depth() {
            return Ok(());
        }
        let no_place = WriteError::Place { contour, x: self.exact.x, y: self.exact.y, z };
        let multiple = self.grid.round(z).ok_or(no_place)?;
        if self.at[2] != Some(multiple) {
            self.is_work = false;
            self.feed_line(format!("G0 Z{}", self.grid.text(multiple)), None)?;
        }
        self.at[2] = Some(multiple);
        self.exact_z = z;
        Ok(())
    }

    fn motion(&mut self, motion: &Move) -> Result<(), WriteError> {
        let flat = Move { z: 0.0, ..*motion };
        let motion = if self.dialect.has_depth() { motion } else { &flat };
        self.is_work = matches!(motion.kind, MoveKind::Ramp(_) | MoveKind::Cut(_));
        match motion.kind {
            MoveKind::Rapid => {
                // Even where nothing moves in the plane: a beam must not burn on while the program goes on.
                self.engage(false)?;
                if motion.z != self.exact_z {
                    self.rapid_z(motion.z, motion.contour + 1)?;
                }
                self.straight("G0", motion.to, motion.z, motion.contour, None)?;
            }
            MoveKind::Plunge => self.straight("G1", motion.to, motion.z, motion.contour, Some(self.plunge_feed))?,
            // On a machine without depth a ramp is a cut like others: left out, a part of the path might never be cut.
            MoveKind::Ramp(link) if self.dialect.has_depth() => self.along(link, motion, self.plunge_feed)?,
            MoveKind::Ramp(link) => self.along(link, motion, self.cut_feed)?,
            MoveKind::Cut(link) => self.along(link, motion, self.cut_feed)?,
        }
        self.exact = motion.to;
        self.exact_z = motion.z;
        Ok(())
    }

    fn along(&mut self, link: Link, motion: &Move, feed: f64) -> Result<(), WriteError> {
        match link {
            Link::Line => self.straight("G1", motion.to, motion.z, motion.contour, Some(feed)),
            Link::Arc(arc) => {
                let exact = Segment { start: self.exact, end: motion.to, link };
                let parts = if exact.sweep() > LARGEST_SWEEP { 2 } else { 1 };
                for k in 0..parts {
                    let share = |k: usize| k as f64 / parts as f64;
                    let part = Segment { start: exact.point_at(share(k)), end: exact.point_at(share(k + 1)), link };
                    let z = self.exact_z + (motion.z - self.exact_z) * share(k + 1);
                    let z0 = self.exact_z + (motion.z - self.exact_z) * share(k);
                    self.arc(&part, &arc, [z0, z], motion.contour, feed)?;
                }
                Ok(())
            }
        }
    }

    fn arc(&mut self, exact: &Segment, arc: &Arc, z: [f64; 2], contour: usize, feed: f64) -> Result<(), WriteError> {
        let is_helix = z[0] != z[1];
        let lines = self.arcs == Arcs::Lines
            || arc.radius > self.dialect.largest_arc_radius
            || (is_helix && !self.dialect.helical_arcs);
        let end = self.place(exact.end, z[1], contour)?;
        let [Some(x), Some(y), _] = self.at else {
            // Not known where it starts, which no plan leaves open: a line is always right about its end.
            return self.straight("G1", exact.end, z[1], contour, Some(feed));
        };
        // Everything in multiples of the grid, relative to the start's, so that far away is as exact as near.
        let step = self.grid.step();
        let origin = Point::new(self.grid.mm(x), self.grid.mm(y));
        let scaled = |p: Point| Point::from((p - origin) / step);
        let center = scaled(arc.center);
        let scaled_arc = Arc { center, radius: arc.radius / step, ..*arc };
        let scaled_exact = Segment { start: scaled(exact.start), end: scaled(exact.end), link: Link::Arc(scaled_arc) };
        let rounded = round_arc(&scaled_exact, &scaled_arc, [0, 0], [end[0] - x, end[1] - y]);
        match rounded {
            Rounded::Line => self.straight("G1", exact.end, z[1], contour, Some(feed)),
            Rounded::Arc { i, j } if !lines && self.mismatch([i, j], [end[0] - x, end[1] - y]) <= LARGEST_MISMATCH => {
                let word = if arc.turn == Turn::Right { "G2" } else { "G3" };
                let mut words = format!("{word} X{} Y{}", self.grid.text(end[0]), self.grid.text(end[1]));
                if self.at[2] != Some(end[2]) {
                    let _ = write!(words, " Z{}", self.grid.text(end[2]));
                }
                let _ = write!(words, " I{} J{}", self.grid.text(i), self.grid.text(j));
                self.at = end.map(Some);
                self.feed_line(words, Some(feed))
            }
            _ => {
                let rounding = step * std::f64::consts::FRAC_1_SQRT_2;
                let tolerance = (LINES_FOR_ARC_TOLERANCE - rounding).max(LEAST_TOLERANCE * LINES_FOR_ARC_TOLERANCE);
                let points = lines_for_arc(exact, arc, self.part_side, tolerance);
                let count = points.len();
                for (k, p) in points.into_iter().enumerate() {
                    let height = z[0] + (z[1] - z[0]) * ((k + 1) as f64 / count as f64);
                    self.straight("G1", p, height, contour, Some(feed))?;
                }
                Ok(())
            }
        }
    }

    /// The difference of the radii at the ends of a rounded arc from the origin, in millimetres.
    fn mismatch(&self, center: [i64; 2], end: [i64; 2]) -> f64 {
        let length = |x: i64, y: i64| (x as f64).hypot(y as f64);
        (length(center[0], center[1]) - length(end[0] - center[0], end[1] - center[1])).abs() * self.grid.step()
    }

    /// G0 or G1. Nothing is written where the rounded place is where the tool is.
    fn straight(&mut self, word: &str, to: Point, z: f64, contour: usize, feed: Option<f64>) -> Result<(), WriteError> {
        let place = self.place(to, z, contour)?;
        let mut words = word.to_owned();
        for (axis, (now, then)) in ["X", "Y", "Z"].iter().zip(self.at.iter_mut().zip(place)) {
            if *now != Some(then) {
                let _ = write!(words, " {axis}{}", self.grid.text(then));
                *now = Some(then);
            }
        }
        if words.len() == word.len() { Ok(()) } else { self.feed_line(words, feed) }
    }

    /// A line of motion, with the feed where it is new; beam and pen are made ready for it.
    fn feed_line(&mut self, mut words: String, feed: Option<f64>) -> Result<(), WriteError> {
        self.engage(self.is_work)?;
        if let Some(feed) = feed.or(self.dialect.rapid_feed) {
            self.add_feed(&mut words, feed)?;
        }
        self.line(&words);
        Ok(())
    }

    /// The feed, in millimetres a minute, at the end of `words`, where it is new.
    fn add_feed(&mut self, words: &mut String, feed: f64) -> Result<(), WriteError> {
        let text = rate("feed", feed / self.unit)?;
        if self.feed.as_ref() != Some(&text) {
            let _ = write!(words, " F{text}");
            self.feed = Some(text);
        }
        Ok(())
    }

    fn place(&self, p: Point, z: f64, contour: usize) -> Result<[i64; 3], WriteError> {
        let place = Point3::new(p.x, p.y, z);
        let round = |v: f64| self.grid.round(v);
        match (round(place.x), round(place.y), round(place.z)) {
            (Some(x), Some(y), Some(z)) => Ok([x, y, z]),
            _ => Err(WriteError::Place { contour: contour + 1, x: place.x, y: place.y, z: place.z }),
        }
    }
}

/// A rate as text; above zero stays above zero.
fn rate(what: &'static str, value: f64) -> Result<String, WriteError> {
    let text = Decimal::of(value, RATE_DECIMALS).ok_or(WriteError::Rate { what, value })?.to_string();
    if value > 0.0 && text == "0" { Err(WriteError::Rate { what, value }) } else { Ok(text) }
}

#[cfg(test)]
mod step_tests;
#[cfg(test)]
mod tests;
