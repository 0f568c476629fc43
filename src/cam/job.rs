//! What to cut and how: every value typed, in millimetres.

mod problem;

use super::Side;
use crate::units::Speed;
pub use problem::{InvalidJob, JobProblem};

/// Default tool diameter in millimetres: 1/8 inch, the shank of the collets that small routers come with.
pub const DEFAULT_TOOL_DIAMETER: f64 = 3.175;
/// Default total depth in millimetres: the sheet of plywood or acrylic glass that is cut most often.
pub const DEFAULT_DEPTH: f64 = 3.0;
/// Default depth per pass in millimetres: a third of the default tool's diameter, what a light machine bears in wood.
pub const DEFAULT_DEPTH_PER_PASS: f64 = 1.0;
/// Default feed in millimetres a minute: 0.028 mm a tooth for two flutes at the default spindle speed.
pub const DEFAULT_FEED: f64 = 1000.0;
/// Default plunge feed in millimetres a minute: about a third of the feed, as end mills cut badly at their tip.
pub const DEFAULT_PLUNGE_FEED: f64 = 300.0;
/// Default spindle speed in revolutions a minute.
pub const DEFAULT_SPINDLE_SPEED: f64 = 18_000.0;
/// Default wait for the spindle in seconds.
pub const DEFAULT_DWELL: f64 = 3.0;
/// Default top of the stock in millimetres: the tool is set to zero on it.
pub const DEFAULT_STOCK_TOP: f64 = 0.0;
/// Default height of travel above the top of the stock, in millimetres: clears most clamps.
pub const DEFAULT_SAFE_CLEARANCE: f64 = 5.0;
/// Default acceleration of the machine in mm/s²: a belt or screw driven hobby router.
pub const DEFAULT_ACCELERATION: f64 = 500.0;
/// Default origin.
pub const DEFAULT_ORIGIN: Origin = Origin::Corner;
/// Default direction: climb leaves the better edge in wood and plastics.
pub const DEFAULT_DIRECTION: Direction = Direction::Climb;
/// Default side.
pub const DEFAULT_SIDE: Side = Side::Outside;
/// Default path radius: what the feed can be kept up on.
pub const DEFAULT_PATH_RADIUS: PathRadius = PathRadius::Auto;
/// Default entry.
pub const DEFAULT_ENTRY: Entry = Entry::Ramp;

/// Largest length a job may name, in millimetres: beyond any machine, and what the writer's columns hold.
const LARGEST_LENGTH: f64 = 10_000.0;
/// Smallest tool and depth of a job, in millimetres: a few times what a machine resolves.
const SMALLEST_LENGTH: f64 = 0.01;
/// Smallest rate of any kind, in mm/min, turns a minute or mm/s²: below it times lose their meaning.
const SMALLEST_RATE: f64 = 0.1;
/// Largest number of passes: more is a slip of the unit.
const LARGEST_PASS_COUNT: f64 = 1000.0;
/// Largest spindle speed in revolutions a minute, feed in mm/min, acceleration in mm/s², and dwell in seconds.
const LARGEST_RATE: f64 = 1e6;
/// How much of a pass may be missing before another is made: rounding of depth over depth per pass.
const PASS_ROUNDING: f64 = 1e-9;

/// The place of the drawing that becomes x = 0, y = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// The lower left corner of the part's bounding box.
    Corner,
    /// The centre of the part's bounding box.
    Center,
    /// The origin that the region has already.
    Drawing,
}

/// How the cutter's teeth meet the part, for a spindle that turns clockwise seen from above (M3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Direction {
    /// The part on the right of the travel: clockwise around parts, counterclockwise in holes.
    Climb,
    /// The part on the left of the travel: counterclockwise around parts, clockwise in holes.
    Conventional,
}

/// The smallest radius that concave stretches of the path should have.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PathRadius {
    /// v²/a: the smallest on which the machine can keep up the feed v at its acceleration a.
    Auto,
    /// Millimetres, zero or more.
    Length(f64),
}

/// How the tool gets down to the next pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Entry {
    /// Descending along the path; a straight plunge where the path is too short for it.
    Ramp,
    /// Round and down beside the path, and onto it; a ramp where there is no room for that.
    Helix,
    /// Straight down.
    Plunge,
    /// Straight down in a hole that was drilled before, and from there to the path; a ramp where there is none near.
    Predrilled,
}

/// What to cut and how. Lengths are millimetres, z points up.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// Diameter of the tool.
    pub tool_diameter: f64,
    /// Depth of the cut below the top of the stock, positive.
    pub depth: f64,
    /// Most that a pass may go deeper than the one before.
    pub depth_per_pass: f64,
    /// Feed along the path.
    pub feed: Speed,
    /// Feed of ramps and plunges.
    pub plunge_feed: Speed,
    /// Spindle speed in revolutions a minute.
    pub spindle_speed: f64,
    /// Seconds between starting the spindle and moving on.
    pub dwell: f64,
    /// z at which the tool travels.
    pub safe_height: f64,
    /// z of the top of the stock.
    pub stock_top: f64,
    /// What becomes x = 0, y = 0.
    pub origin: Origin,
    /// Climb or conventional.
    pub direction: Direction,
    /// Outside or inside of the outline, or on it.
    pub side: Side,
    /// Smallest radius of concave stretches of the path.
    pub path_radius: PathRadius,
    /// Acceleration of the machine in mm/s²; only [`PathRadius::Auto`] uses it.
    pub acceleration: f64,
    /// How the tool enters the stock.
    pub entry: Entry,
}

impl Default for Job {
    fn default() -> Job {
        let speed = |mm_per_min| Speed::from_mm_per_min(mm_per_min).expect("the default feeds are above zero");
        Job {
            tool_diameter: DEFAULT_TOOL_DIAMETER,
            depth: DEFAULT_DEPTH,
            depth_per_pass: DEFAULT_DEPTH_PER_PASS,
            feed: speed(DEFAULT_FEED),
            plunge_feed: speed(DEFAULT_PLUNGE_FEED),
            spindle_speed: DEFAULT_SPINDLE_SPEED,
            dwell: DEFAULT_DWELL,
            safe_height: DEFAULT_STOCK_TOP + DEFAULT_SAFE_CLEARANCE,
            stock_top: DEFAULT_STOCK_TOP,
            origin: DEFAULT_ORIGIN,
            direction: DEFAULT_DIRECTION,
            side: DEFAULT_SIDE,
            path_radius: DEFAULT_PATH_RADIUS,
            acceleration: DEFAULT_ACCELERATION,
            entry: DEFAULT_ENTRY,
        }
    }
}

impl Job {
    /// The path radius in millimetres.
    pub fn path_radius_mm(&self) -> f64 {
        match self.path_radius {
            PathRadius::Auto => self.feed.mm_per_s().powi(2) / self.acceleration,
            PathRadius::Length(length) => length,
        }
    }

    /// z of every pass, from the top down: as many equal steps as [`Job::depth_per_pass`] asks for.
    pub fn pass_heights(&self) -> Vec<f64> {
        let count = (self.depth / self.depth_per_pass - PASS_ROUNDING).ceil().clamp(1.0, LARGEST_PASS_COUNT) as usize;
        (1..=count).map(|k| self.stock_top - self.depth * (k as f64 / count as f64)).collect()
    }

    /// Looks for values that make no sense.
    ///
    /// # Errors
    /// Lists every problem.
    pub fn validate(&self) -> Result<(), InvalidJob> {
        let mut problems = Vec::new();
        let mut above_zero = |field, value: f64, limit: f64| {
            if !(value.is_finite() && value > 0.0) {
                problems.push(JobProblem::NotPositive { field, value });
            } else if value > limit {
                problems.push(JobProblem::TooLarge { field, value, limit });
            }
        };
        above_zero("tool-diameter", self.tool_diameter, LARGEST_LENGTH);
        above_zero("depth", self.depth, LARGEST_LENGTH);
        above_zero("depth-per-pass", self.depth_per_pass, LARGEST_LENGTH);
        for (field, value) in [("tool-diameter", self.tool_diameter), ("depth", self.depth)] {
            if value > 0.0 && value < SMALLEST_LENGTH {
                problems.push(JobProblem::TooSmall { field, value, limit: SMALLEST_LENGTH });
            }
        }
        let mut above_zero = |field, value: f64, limit: f64| {
            if !(value.is_finite() && value > 0.0) {
                problems.push(JobProblem::NotPositive { field, value });
            } else if value > limit {
                problems.push(JobProblem::TooLarge { field, value, limit });
            }
        };
        above_zero("feed", self.feed.mm_per_min(), LARGEST_RATE);
        above_zero("plunge-feed", self.plunge_feed.mm_per_min(), LARGEST_RATE);
        above_zero("spindle-speed", self.spindle_speed, LARGEST_RATE);
        above_zero("acceleration", self.acceleration, LARGEST_RATE);
        for (field, value) in [
            ("feed", self.feed.mm_per_min()),
            ("plunge-feed", self.plunge_feed.mm_per_min()),
            ("spindle-speed", self.spindle_speed),
            ("acceleration", self.acceleration),
        ] {
            if value > 0.0 && value < SMALLEST_RATE {
                problems.push(JobProblem::TooSlow { field, value, limit: SMALLEST_RATE });
            }
        }
        let mut zero_or_more = |field, value: f64, limit: f64| {
            if !(value.is_finite() && value >= 0.0) {
                problems.push(JobProblem::Negative { field, value });
            } else if value > limit {
                problems.push(JobProblem::TooLarge { field, value, limit });
            }
        };
        zero_or_more("dwell", self.dwell, LARGEST_RATE);
        // An automatic radius is judged only where what it is made of makes sense: one slip, one problem.
        if !(self.path_radius == PathRadius::Auto && !(self.acceleration.is_finite() && self.acceleration > 0.0)) {
            zero_or_more("path-radius", self.path_radius_mm(), LARGEST_LENGTH);
        }
        for (field, value) in [("safe-height", self.safe_height), ("stock-top", self.stock_top)] {
            if !value.is_finite() {
                problems.push(JobProblem::NotFinite { field, value });
            } else if value.abs() > LARGEST_LENGTH {
                problems.push(JobProblem::TooLarge { field, value, limit: LARGEST_LENGTH });
            }
        }
        if self.safe_height <= self.stock_top {
            problems.push(JobProblem::SafeHeightTooLow { safe_height: self.safe_height, stock_top: self.stock_top });
        }
        if self.depth > 0.0 && self.depth_per_pass > 0.0 && self.depth / self.depth_per_pass > LARGEST_PASS_COUNT {
            problems.push(JobProblem::TooManyPasses { depth: self.depth, depth_per_pass: self.depth_per_pass });
        }
        if problems.is_empty() { Ok(()) } else { Err(InvalidJob { problems }) }
    }

    /// The settings in words, one a line, for the head of a program.
    pub fn summary(&self) -> Vec<String> {
        let lower = |words: String| words.to_ascii_lowercase();
        let radius = match self.path_radius {
            PathRadius::Auto => "auto: feed squared over acceleration",
            PathRadius::Length(_) => "as asked",
        };
        vec![
            format!("tool diameter {} mm", self.tool_diameter),
            format!(
                "depth {} mm, at most {} mm a pass, {} passes",
                self.depth,
                self.depth_per_pass,
                self.pass_heights().len()
            ),
            format!("feed {} mm/min, plunge feed {} mm/min", self.feed.mm_per_min(), self.plunge_feed.mm_per_min()),
            format!("spindle {} rpm, dwell {} s", self.spindle_speed, self.dwell),
            format!("safe height {} mm, stock top {} mm", self.safe_height, self.stock_top),
            lower(format!(
                "side {:?}, direction {:?}, origin {:?}, entry {:?}",
                self.side, self.direction, self.origin, self.entry
            )),
            format!("path radius {:.4} mm, {radius}", self.path_radius_mm()),
            format!("acceleration {} mm/s2", self.acceleration),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_make_sense() {
        let job = Job::default();
        assert_eq!(job.validate(), Ok(()));
        assert_eq!(job.pass_heights(), [-1.0, -2.0, -3.0]);
        // (1000/60)² / 500
        assert!((job.path_radius_mm() - 0.555_555_555_555).abs() < 1e-9);
    }

    #[test]
    fn passes_are_equal_and_end_at_the_depth() {
        let job = Job { depth: 6.35, depth_per_pass: 2.0, stock_top: 10.0, ..Job::default() };
        let heights = job.pass_heights();
        assert_eq!(heights.len(), 4);
        assert_eq!(heights[3], 10.0 - 6.35);
        // 0.3 / 0.1 is a little more than 3.
        assert_eq!(Job { depth: 0.3, depth_per_pass: 0.1, ..Job::default() }.pass_heights().len(), 3);
    }

    #[test]
    fn all_problems_are_reported_with_their_fields() {
        let job = Job {
            tool_diameter: f64::NAN,
            depth: -1.0,
            depth_per_pass: 0.0,
            spindle_speed: f64::INFINITY,
            dwell: -0.5,
            safe_height: -1.0,
            acceleration: 0.0,
            ..Job::default()
        };
        let text = job.validate().unwrap_err().to_string();
        for field in [
            "tool-diameter is NaN",
            "depth is -1",
            "depth-per-pass is 0",
            "spindle-speed",
            "dwell",
            "safe-height",
            "acceleration",
        ] {
            assert!(text.contains(field), "{field} is missing in: {text}");
        }
        assert!(!text.contains("path-radius"), "{text}");
        let slip = Job { depth_per_pass: 1e-6, ..Job::default() };
        assert!(matches!(slip.validate().unwrap_err().problems[..], [JobProblem::TooManyPasses { .. }]));
        let slow = Job { acceleration: 1e-300, path_radius: PathRadius::Length(0.0), ..Job::default() };
        assert!(matches!(
            slow.validate().unwrap_err().problems[..],
            [JobProblem::TooSlow { field: "acceleration", .. }]
        ));
        let radius = Job { path_radius: PathRadius::Length(-1.0), ..Job::default() };
        assert!(radius.validate().unwrap_err().to_string().contains("path-radius is -1"));
    }
}
