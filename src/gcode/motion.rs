//! What a machine does when it runs a program: the motions, in millimetres.

use crate::plane::{Point, Turn};

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

/// A program as a machine understands it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// The motions in order.
    pub motions: Vec<Motion>,
}
