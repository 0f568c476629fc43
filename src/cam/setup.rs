//! A whole job: the stock, the machine, its tools, and the operations in their order. Lengths are millimetres.

mod amount;
mod file;
mod locate;
mod plain_words;
mod problem;
mod resolve;
mod rest;
mod sample;
mod warnings;

use super::{Direction, Entry, Keepout, Machine, Origin, PathRadius, Side, Tool};
use crate::rolling::Topology;
use crate::units::Speed;
pub use amount::{AmountError, check_amount};
pub use file::{SelectFile, SetupFile, Words};
pub use problem::{InvalidSetup, SetupProblem};
pub use sample::{SampleShape, commented_sample};
pub use warnings::{chip_load, surface_speed};

/// The version of job files with operations that this program reads.
pub const SETUP_VERSION: i64 = 1;

/// What is cut.
#[derive(Clone, Debug, PartialEq)]
pub struct Workpiece {
    /// Extent along x and y, where it is known.
    pub size: Option<[f64; 2]>,
    /// What of it, or of the drawing, is x = 0, y = 0.
    pub zero: Origin,
    /// Thickness, where it is known.
    pub thickness: Option<f64>,
    /// z of its top.
    pub top: f64,
    /// What it is made of: chooses the feeds of the tools.
    pub material: Option<String>,
}

/// How the machine is told what to do, and what it can.
#[derive(Clone, Debug, PartialEq)]
pub struct Rig {
    /// The name or file of its dialect.
    pub dialect: String,
    /// Whether programs are in inches.
    pub inches: bool,
    /// Whether arcs are written as arcs.
    pub arcs: bool,
    /// Accelerations and speeds.
    pub limits: Machine,
    /// The most that x, y and z may travel, where it is known.
    pub travel: Option<[f64; 3]>,
    /// z of travel.
    pub safe_height: f64,
    /// Seconds to wait for the spindle.
    pub dwell: f64,
    /// The fastest that the spindle turns, where it is known.
    pub largest_spindle_speed: Option<f64>,
}

/// A whole job.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// What is cut.
    pub stock: Workpiece,
    /// The machine.
    pub rig: Rig,
    /// The tools, as the operations refer to them.
    pub tools: Vec<Tool>,
    /// Where the tool must not go.
    pub keepouts: Vec<Keepout>,
    /// What is done, in order.
    pub operations: Vec<Operation>,
}

/// Which tool does what to which shapes.
#[derive(Clone, Debug, PartialEq)]
pub struct Operation {
    /// What it is called; never empty.
    pub label: String,
    /// The line of the job file where it starts.
    pub line: usize,
    /// What is done.
    pub kind: OperationKind,
    /// Index of its tool.
    pub tool: usize,
    /// The shapes it is done to.
    pub select: SelectFile,
    /// How.
    pub cutting: Cutting,
}

/// What is done.
#[derive(Clone, Debug, PartialEq)]
pub enum OperationKind {
    /// Along outlines.
    Profile {
        /// Which side of them.
        side: Side,
        /// How corners that the tool cannot reach are treated.
        corners: Corners,
        /// The diameter of a larger tool that has cut the same outlines before: only what it left is cut.
        rest_of: Option<f64>,
    },
    /// All that areas hold, down to a floor.
    Pocket {
        /// Along the outlines, or to and fro.
        pattern: Pattern,
        /// Distance between neighbouring paths.
        stepover: f64,
        /// As in a profile.
        corners: Corners,
        /// As in a profile.
        rest_of: Option<f64>,
    },
    /// Round holes: drilled, or bored along a helix where they are larger than the tool.
    Drill {
        /// How deep the tool goes before it is drawn out, where it is.
        peck: Option<f64>,
    },
    /// Along lines and outlines.
    Engrave,
    /// Areas, by a cone as deep as they are wide.
    VCarve {
        /// The deepest it may go.
        max_depth: Option<f64>,
    },
    /// The top of the stock made flat.
    Facing {
        /// Distance between neighbouring paths.
        stepover: f64,
    },
    /// Edges broken by a cone.
    Chamfer {
        /// Which side of the outlines the waste is on.
        side: Side,
        /// Width of the chamfer, seen from above.
        width: f64,
    },
}

impl OperationKind {
    /// The diameter of the larger tool whose rest is cut, where it is only that.
    pub fn rest_of(&self) -> Option<f64> {
        match self {
            OperationKind::Profile { rest_of, .. } | OperationKind::Pocket { rest_of, .. } => *rest_of,
            _ => None,
        }
    }
}

/// What happens to inside corners that a round tool leaves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Corners {
    /// They stay round.
    #[default]
    Round,
    /// They are cut away along their bisector, so that a square part fits.
    Dogbone,
    /// They are cut away along their longer wall.
    TBone,
}

/// How a pocket is cleared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pattern {
    /// Along its outline, ring inside ring.
    #[default]
    Rings,
    /// To and fro along x.
    Raster,
}

/// How passes get deeper.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Steps {
    /// In equal steps.
    #[default]
    Even,
    /// In the largest steps, and a smaller last one.
    Stepped,
}

/// The most tabs of an outline: more hold no part better, and are a slip of the unit.
const MOST_TABS: usize = 1000;

/// Pieces that hold a part.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabs {
    /// Where they are.
    pub places: TabPlaces,
    /// Length of what is left, along the path.
    pub width: f64,
    /// Height of what is left above the floor.
    pub height: f64,
}

/// Where tabs are.
#[derive(Clone, Debug, PartialEq)]
pub enum TabPlaces {
    /// So many on every outline.
    Count(usize),
    /// One every so many millimetres, two at least.
    Spacing(f64),
    /// Where the outline is nearest to these places of the machine.
    At(Vec<[f64; 2]>),
}

/// How an operation cuts.
#[derive(Clone, Debug, PartialEq)]
pub struct Cutting {
    /// How far below the top of the stock it starts.
    pub start_depth: f64,
    /// How far below the top of the stock it ends.
    pub depth: f64,
    /// Most that a pass may go deeper than the one before.
    pub depth_per_pass: f64,
    /// How passes get deeper.
    pub steps: Steps,
    /// Thickness of the last pass, where it is chosen.
    pub final_pass: Option<f64>,
    /// Feed along the path.
    pub feed: Speed,
    /// Feed of ramps and plunges.
    pub plunge_feed: Speed,
    /// Spindle speed in revolutions a minute; the power of a laser.
    pub spindle_speed: f64,
    /// Climb or conventional.
    pub direction: Direction,
    /// Smallest radius of the path in inside corners.
    pub path_radius: PathRadius,
    /// What happens where parts come nearer to each other than the tool.
    pub topology: Topology,
    /// How the tool enters the stock.
    pub entry: Entry,
    /// Radius of the arcs on which the tool comes to outlines and leaves them, where it does.
    pub lead: Option<f64>,
    /// What holds the part.
    pub tabs: Option<Tabs>,
    /// Thickness of what is left at the floor until all else of the operation is cut.
    pub onion_skin: Option<f64>,
    /// What is left at the walls for a finishing pass.
    pub allowance: f64,
    /// Whether the walls are cut again, at full depth and without the allowance.
    pub finish: bool,
}

impl Cutting {
    /// The path radius in millimetres on a machine of this acceleration in mm/s².
    pub fn path_radius_mm(&self, acceleration: f64) -> f64 {
        match self.path_radius {
            PathRadius::Auto => self.feed.mm_per_s().powi(2) / acceleration,
            PathRadius::Length(length) => length,
        }
    }

    /// z of what tabs and skins stand on: the floor of the cut, or the bottom of the stock where the cut goes through it.
    pub fn base(&self, stock: &Workpiece) -> f64 {
        let floor = stock.top - self.depth;
        stock.thickness.map_or(floor, |thickness| floor.max(stock.top - thickness))
    }

    /// z of every pass from the top down, for a stock with its top at `stock_top`.
    pub fn pass_heights(&self, stock_top: f64) -> Vec<f64> {
        let floor = self.depth;
        let last = self.final_pass.filter(|last| *last < floor - self.start_depth);
        let rough = floor - last.unwrap_or(0.0) - self.start_depth;
        let count = (rough / self.depth_per_pass - PASS_ROUNDING).ceil().clamp(1.0, LARGEST_PASS_COUNT) as usize;
        let depth = |k: usize| match self.steps {
            _ if k == count => self.start_depth + rough,
            Steps::Even => self.start_depth + rough * (k as f64 / count as f64),
            Steps::Stepped => self.start_depth + self.depth_per_pass * k as f64,
        };
        let mut heights: Vec<f64> = (1..=count).map(|k| stock_top - depth(k)).collect();
        if last.is_some() {
            heights.push(stock_top - floor);
        }
        heights
    }
}

/// How much of a pass may be missing before another is made: rounding of depth over depth per pass.
const PASS_ROUNDING: f64 = 1e-9;

/// Largest number of passes: more is a slip of the unit.
const LARGEST_PASS_COUNT: f64 = 1000.0;

impl Setup {
    /// The tool of an operation.
    pub fn tool_of(&self, operation: &Operation) -> &Tool {
        &self.tools[operation.tool]
    }
}
