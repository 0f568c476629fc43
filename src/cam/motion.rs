//! What a machine does when it runs a program: the motions, in millimetres.

use crate::plane::{Arc, Link, Point, Segment, Turn};

/// A place of the tool tip: x, y and z in millimetres, z pointing up.
pub type Point3 = nalgebra::Point3<f64>;

/// One motion of the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// The line of the program that asks for it, counted from 1.
    pub line: usize,
    /// Where it starts.
    pub from: Point3,
    /// Where it ends.
    pub to: Point3,
    /// How it gets there.
    pub kind: MotionKind,
    /// Whether the spindle turns.
    pub spindle_on: bool,
    /// Turns of the spindle a minute, as last asked for, whether or not it turns; 0 where the program has not asked yet.
    pub spindle_speed: f64,
    /// The number of the tool in the spindle; 0 where the program has not named one yet.
    pub tool: u32,
}

/// How the tool gets from one place to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MotionKind {
    /// G0: as fast as the machine can, not for cutting.
    Rapid,
    /// G1: straight at a feed in millimetres a minute.
    Feed {
        /// Feed in millimetres a minute.
        feed: f64,
    },
    /// G2 or G3: along a circle in the XY plane, z changing evenly (a helix), at a feed.
    Arc {
        /// Centre in the XY plane.
        center: Point,
        /// G2 turns right (clockwise), G3 turns left.
        turn: Turn,
        /// Feed in millimetres a minute.
        feed: f64,
    },
    /// G4: wait.
    Dwell {
        /// Seconds.
        seconds: f64,
    },
}

impl Motion {
    /// Whether the motion is a rapid.
    pub fn is_rapid(&self) -> bool {
        matches!(self.kind, MotionKind::Rapid)
    }

    /// Whether the tool moves at a feed.
    pub fn is_feed(&self) -> bool {
        matches!(self.kind, MotionKind::Feed { .. } | MotionKind::Arc { .. })
    }

    /// Feed in millimetres a minute; `None` for rapids and dwells.
    pub fn feed(&self) -> Option<f64> {
        match self.kind {
            MotionKind::Feed { feed } | MotionKind::Arc { feed, .. } => Some(feed),
            MotionKind::Rapid | MotionKind::Dwell { .. } => None,
        }
    }

    /// The lowest z that the motion reaches.
    pub fn lowest(&self) -> f64 {
        self.from.z.min(self.to.z)
    }

    /// Whether the tool tip goes below `stock_top` and the tool moves at all.
    pub fn is_in_stock(&self, stock_top: f64) -> bool {
        !matches!(self.kind, MotionKind::Dwell { .. }) && self.lowest() < stock_top
    }

    /// What the motion traces in the XY plane: nothing for a plunge or a dwell, one element for a line or an arc,
    /// two for an arc that ends in the XY where it starts, which is a full circle.
    pub fn trace(&self) -> Trace {
        let (start, end) = (self.from.xy(), self.to.xy());
        match self.kind {
            MotionKind::Dwell { .. } => Trace::default(),
            MotionKind::Rapid | MotionKind::Feed { .. } if start == end => Trace::default(),
            MotionKind::Rapid | MotionKind::Feed { .. } => {
                Trace { first: Some(Segment::line(start, end)), second: None }
            }
            MotionKind::Arc { center, turn, .. } => {
                // The end decides nothing but the angle: a centre solved after rounding leaves the two radii apart by
                // less than the machine can show, and the mean halves the error.
                let radius = 0.5 * ((start - center).norm() + (end - center).norm());
                if !(radius.is_finite() && radius > 0.0) {
                    return Trace::default();
                }
                let arc = Arc { center, radius, turn };
                if start != end {
                    return Trace { first: Some(Segment { start, end, link: Link::Arc(arc) }), second: None };
                }
                let opposite = center - (start - center);
                Trace {
                    first: Some(Segment { start, end: opposite, link: Link::Arc(arc) }),
                    second: Some(Segment { start: opposite, end, link: Link::Arc(arc) }),
                }
            }
        }
    }

    /// What of [`Motion::trace`] lies no higher than `z`.
    pub(super) fn trace_below(&self, z: f64) -> Vec<Segment> {
        let (from, to) = (self.from.z, self.to.z);
        // As fractions of the way in the plane, along which the height changes evenly.
        let crossing = ((z - from) / (to - from)).clamp(0.0, 1.0);
        let (first, last) = match () {
            () if from.max(to) <= z => (0.0, 1.0),
            () if from.min(to) > z => return Vec::new(),
            () if to < from => (crossing, 1.0),
            () => (0.0, crossing),
        };
        let whole: f64 = self.trace().map(|s| s.length()).sum();
        let mut before = 0.0;
        let parts = self.trace().filter_map(|element| {
            let share = element.length() / whole;
            let place = |t: f64| ((t - before) / share).clamp(0.0, 1.0);
            let (a, b) = (place(first), place(last));
            before += share;
            (a < b).then(|| Segment { start: element.point_at(a), end: element.point_at(b), ..element })
        });
        parts.collect()
    }

    /// Length of the way in space, in millimetres.
    pub fn length(&self) -> f64 {
        let rise = self.to.z - self.from.z;
        let flat: f64 = self.trace().map(|s| s.length()).sum();
        flat.hypot(rise)
    }
}

/// The elements that a motion traces in the XY plane, in order.
#[derive(Clone, Copy, Debug, Default)]
pub struct Trace {
    first: Option<Segment>,
    second: Option<Segment>,
}

impl Iterator for Trace {
    type Item = Segment;

    fn next(&mut self) -> Option<Segment> {
        self.first.take().or_else(|| self.second.take())
    }
}

/// The unit of the lengths in a program's text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ProgramUnit {
    /// G21.
    Millimetre,
    /// G20.
    Inch,
}

impl ProgramUnit {
    /// Millimetres in one unit.
    pub fn millimetres(self) -> f64 {
        match self {
            ProgramUnit::Millimetre => 1.0,
            ProgramUnit::Inch => crate::units::MM_PER_INCH,
        }
    }
}

/// A comment of a program, without its brackets or semicolon.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Comment {
    /// The line it stands on, counted from 1.
    pub line: usize,
    /// What it says, trimmed.
    pub text: String,
}

/// A program as a machine understands it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// The motions in order.
    pub motions: Vec<Motion>,
    /// The comments in order.
    pub comments: Vec<Comment>,
    /// The unit the text states first; `None` where it never does.
    pub unit: Option<ProgramUnit>,
    /// The line of M2 or M30; `None` where the program has no end.
    pub end_line: Option<usize>,
    /// The highest spindle speed asked for, in turns a minute; 0 where none is.
    pub spindle_speed: f64,
}

impl Program {
    /// The diameter of the tool in millimetres, where a comment tells it.
    ///
    /// Understood are `tool diameter 3.175 mm` (also with `:` or `=`), `tool 3.175 mm` and the `D=3.175` of other
    /// programs' tool lists; a number without a unit is in the unit of the program.
    pub fn tool_diameter(&self) -> Option<f64> {
        let unit = self.unit.unwrap_or(ProgramUnit::Millimetre).millimetres();
        let found = |text: &str| {
            let lower = text.to_ascii_lowercase();
            let after = ["tool diameter", "cutter diameter", "diameter", "tool", "d="]
                .iter()
                .find_map(|key| lower.find(key).map(|at| &lower[at + key.len()..]))?;
            let after = after.trim_start_matches([' ', ':', '=', ',']);
            let digits = after.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(after.len());
            let number: f64 = after[..digits].parse().ok()?;
            let rest = after[digits..].trim_start();
            let factor = match () {
                () if rest.starts_with("mm") => 1.0,
                () if rest.starts_with("in") || rest.starts_with('"') => crate::units::MM_PER_INCH,
                () => unit,
            };
            Some(number * factor).filter(|d| d.is_finite() && *d > 0.0)
        };
        self.comments.iter().find_map(|c| found(&c.text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tool_diameters_are_found_in_comments() {
        let program = |text: &str, unit| Program {
            comments: vec![Comment { line: 1, text: text.into() }],
            unit: Some(unit),
            ..Program::default()
        };
        for (text, unit, expected) in [
            ("tool diameter 3.175 mm, depth 6 mm", ProgramUnit::Millimetre, Some(3.175)),
            ("Tool: 1.5mm", ProgramUnit::Inch, Some(1.5)),
            ("T1 D=0.125 CR=0. - flat end mill", ProgramUnit::Inch, Some(3.175)),
            ("tool 0.25 in", ProgramUnit::Millimetre, Some(6.35)),
            ("a toolbox", ProgramUnit::Millimetre, None),
            ("tool 0 mm", ProgramUnit::Millimetre, None),
        ] {
            assert_eq!(program(text, unit).tool_diameter(), expected, "{text}");
        }
    }

    #[test]
    fn a_full_circle_traces_two_halves() {
        let at = Point3::new(5.0, 0.0, 0.0);
        let kind = MotionKind::Arc { center: Point::origin(), turn: Turn::Left, feed: 100.0 };
        let to = Point3::new(5.0, 0.0, -3.0);
        let motion = Motion { line: 1, from: at, to, kind, spindle_on: true, spindle_speed: 1000.0, tool: 1 };
        assert_eq!(motion.trace().count(), 2);
        let helix = (10.0 * std::f64::consts::PI).hypot(3.0);
        assert!((motion.length() - helix).abs() < 1e-12);
    }
}
