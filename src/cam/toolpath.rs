//! What the tool does, in millimetres and in the machine's coordinates.

use super::Tool;
use crate::plane::{Link, Point, Turn, Vector};
use crate::units::Speed;

/// How the machine runs while it follows a toolpath.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Feed of [`MoveKind::Cut`].
    pub feed: Speed,
    /// Feed of [`MoveKind::Plunge`] and [`MoveKind::Ramp`].
    pub plunge_feed: Speed,
    /// Revolutions a minute, clockwise seen from above.
    pub spindle_speed: f64,
    /// Seconds to wait for the spindle.
    pub dwell: f64,
    /// z of travel; the program goes there first, alone.
    pub safe_height: f64,
}

/// How the tool gets to the end of a move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MoveKind {
    /// As fast as the machine can, clear of the stock; either z alone or x and y at the safe height.
    Rapid,
    /// Straight down at the plunge feed.
    Plunge,
    /// Along the link at the plunge feed, z falling evenly with the way.
    Ramp(Link),
    /// Along the link at the feed, z changing evenly with the way: tabs, carving; mostly it does not change.
    Cut(Link),
}

/// A move of the tool's tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move {
    /// Where it ends, in x and y. It starts where the move before ended.
    pub to: Point,
    /// z where it ends.
    pub z: f64,
    /// How it gets there.
    pub kind: MoveKind,
    /// The contour it belongs to, counted from 0 in the order of cutting.
    pub contour: usize,
}

impl Move {
    /// The link that the tool follows; `None` for rapids and plunges.
    pub fn link(&self) -> Option<Link> {
        match self.kind {
            MoveKind::Rapid | MoveKind::Plunge => None,
            MoveKind::Ramp(link) | MoveKind::Cut(link) => Some(link),
        }
    }
}

/// What the tool does.
///
/// The first move is a rapid to the safe height at an unknown place, and its x and y mean nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Toolpath {
    /// How the machine runs.
    pub settings: Settings,
    /// The moves in order.
    pub moves: Vec<Move>,
    /// How many contours there are.
    pub contour_count: usize,
    /// The side of the travel on which the part lies: arcs that turn to it are convex on the part.
    pub part_side: Turn,
    /// What was added to the drawing's coordinates to get the machine's.
    pub translation: Vector,
}

/// What one tool does for one operation of a job: programs are made of such steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// What the operation is called.
    pub label: String,
    /// The tool it is done with.
    pub tool: Tool,
    /// What the tool does.
    pub toolpath: Toolpath,
}
