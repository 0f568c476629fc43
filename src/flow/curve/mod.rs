//! The flow of outlines.
//!
//! The outline is taken as it is: nothing is resampled but the edges at moving vertices, where vertices are put on them
//! an edge length apart. What never moves comes out bit for bit, arcs and identities included.

mod contact;
mod front;
mod outline;
mod remesh;
mod rounded;
mod runs;
#[cfg(test)]
mod tests;
mod turn;

pub use front::CurveFront;
pub use runs::Runs;

use std::ops::RangeInclusive;

use super::advance::{Advance, DEFAULT_TOLERANCE, End, OnContact, Status};
use super::obstacle::Obstacle;
use crate::plane::{Point, Region, VertexId};
use crate::units::Radius;
use outline::Outline;

/// The edge length h in units of r: a fillet of a right angle gets twenty edges.
pub const DEFAULT_EDGE: f64 = 1.0 / 13.0;

/// The time step tau in units of h².
pub const DEFAULT_TIME_STEP: f64 = 0.05;

/// Edge lengths that make sense, in units of r: longer ones cannot follow the disk, shorter ones take for ever.
const EDGES: RangeInclusive<f64> = 1e-3..=0.5;

/// Time steps that make sense, in units of h²: in longer ones vertices pass over each other.
const TIME_STEPS: RangeInclusive<f64> = 1e-4..=1.0;

/// What the bound depends on in the plane.
pub struct Field<'a> {
    /// The radius of the disk at a place, and the vertex of the drawing that stands there or that the edge there leaves.
    pub radius: Box<dyn Fn(Point, Option<VertexId>) -> f64 + 'a>,
    /// How far a place is from what is pinned; 0 there, where everything stays whatever its curvature.
    ///
    /// Nearer to a pin than half the radius, twice this distance is the radius: on its way to the pin a boundary may turn as
    /// far as it has to, but in no corner.
    pub pin_distance: Box<dyn Fn(Point) -> f64 + 'a>,
}

impl Field<'_> {
    /// The same radius everywhere, and no pins.
    pub fn constant(radius: Radius) -> Field<'static> {
        let r = radius.get();
        Field { radius: Box::new(move |_, _| r), pin_distance: Box::new(|_| f64::INFINITY) }
    }
}

/// How finely, and how far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The edge length h in units of the radius at the place.
    pub edge: f64,
    /// The time step tau in units of the shortest h where something moves, squared.
    pub time_step: f64,
    /// The flow ends where no vertex moves by more than so many edge lengths in a step.
    pub tolerance: f64,
    /// What to do where the boundary runs into itself.
    pub on_contact: OnContact,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            edge: DEFAULT_EDGE,
            time_step: DEFAULT_TIME_STEP,
            tolerance: DEFAULT_TOLERANCE,
            on_contact: OnContact::Report,
        }
    }
}

/// Why a flow cannot start.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FlowError {
    /// The edge length is not between nothing and the radius.
    #[error("an edge length of {0} radii: it must be from {low} to {high}; 0.08 is the rule", low = EDGES.start(), high = EDGES.end())]
    EdgeLength(f64),
    /// The time step is no positive number.
    #[error("a time step of {0} squares of the edge length: it must be from {low} to {high}; 0.05 is the rule", low = TIME_STEPS.start(), high = TIME_STEPS.end())]
    TimeStep(f64),
    /// The tolerance is no positive number.
    #[error("a tolerance of {0} edge lengths: it must be above 0 and at most 1")]
    Tolerance(f64),
    /// The field gives no radius at a vertex.
    #[error("the radius at ({x}, {y}) is {radius}: it must be a finite number above zero everywhere on the outline")]
    Radius {
        /// Where, with y up.
        x: f64,
        /// Where, with y up.
        y: f64,
        /// What it is there.
        radius: f64,
    },
    /// Coordinates are no numbers.
    #[error("the outline has coordinates that are no numbers")]
    Coordinates,
}

/// What is known of a flow.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Steps so far.
    pub steps: u64,
    /// Time so far, in the square of the region's unit.
    pub time: f64,
    /// Why it ended; `None` while it goes on.
    pub end: Option<End>,
    /// Vertices that moved in the last step.
    pub moving: usize,
    /// The largest displacement of the last step, in edge lengths.
    pub largest: f64,
    /// The area that the boundary has swept over.
    pub swept: f64,
    /// Vertices of the input that are where they were, and all of them.
    pub kept: usize,
    /// See `kept`.
    pub vertices: usize,
    /// The part of the length of the boundary that has moved.
    pub moved_fraction: f64,
    /// Places where the boundary crossed itself.
    pub contacts: Vec<Point>,
}

/// A flow of an outline.
pub struct CurveFlow<'a> {
    advance: Advance<CurveFront<'a>, 2>,
    /// It closes what is empty, which is opening: so an outline and its counterpart stay alike to the last bit.
    mirrored: bool,
    vertices: usize,
}

impl<'a> CurveFlow<'a> {
    /// The flow of `region` against `obstacle`.
    ///
    /// # Errors
    /// Where a setting is out of range, or the field gives no radius at a vertex.
    pub fn new(
        region: &Region,
        obstacle: Obstacle,
        field: Field<'a>,
        settings: &Settings,
    ) -> Result<CurveFlow<'a>, FlowError> {
        let Settings { edge, time_step, tolerance, on_contact } = *settings;
        if !EDGES.contains(&edge) {
            return Err(FlowError::EdgeLength(edge));
        }
        if !TIME_STEPS.contains(&time_step) {
            return Err(FlowError::TimeStep(time_step));
        }
        if !(tolerance > 0.0 && tolerance <= 1.0) {
            return Err(FlowError::Tolerance(tolerance));
        }
        for v in region.rings.iter().flat_map(|r| &r.vertices) {
            let (p, radius) = (v.point, (field.radius)(v.point, v.id));
            if !(p.x.is_finite() && p.y.is_finite()) {
                return Err(FlowError::Coordinates);
            }
            if Radius::new(radius).is_err() {
                return Err(FlowError::Radius { x: p.x, y: p.y, radius });
            }
        }
        let mirrored = obstacle == Obstacle::OPENING;
        let front = if mirrored {
            CurveFront::new(Outline::new(&region.reversed()), Obstacle::CLOSING, field, edge)
        } else {
            CurveFront::new(Outline::new(region), obstacle, field, edge)
        };
        Ok(CurveFlow {
            advance: Advance::new(front, time_step, tolerance, on_contact),
            mirrored,
            vertices: region.vertex_count(),
        })
    }

    /// One step, which ends at the time `until` at the latest.
    pub fn step(&mut self, until: f64) -> Status {
        self.advance.step(until)
    }

    /// Steps up to the time `until` (infinity: to the end) or the end.
    pub fn run(&mut self, until: f64) -> Status {
        while self.step(until) == Status::Going && self.time() < until {}
        self.status()
    }

    /// Where the flow is.
    pub fn status(&self) -> Status {
        self.advance.status()
    }

    /// Time so far, in the square of the region's unit.
    pub fn time(&self) -> f64 {
        self.advance.time
    }

    /// The area swept over so far.
    pub fn swept(&self) -> f64 {
        self.advance.swept
    }

    /// Vertices that moved in the last step, and the farthest that one did, in edge lengths.
    pub fn last_step(&self) -> (usize, f64) {
        (self.advance.last.moving, self.advance.last.largest)
    }

    /// The outline as it is now, with arcs in place of the chords where it moved: a smooth curve through the vertices, from
    /// which they are at most a two-hundredth of an edge length away.
    pub fn rounded(&self) -> Region {
        self.turned(rounded::rounded(&self.advance.front))
    }

    /// The outline as it is now, with chords where it moved.
    pub fn region(&self) -> Region {
        self.turned(self.advance.front.outline.region())
    }

    fn turned(&self, region: Region) -> Region {
        if self.mirrored { region.reversed() } else { region }
    }

    /// What is known so far.
    pub fn report(&self) -> Report {
        let outline = &self.advance.front.outline;
        let alive = || (0..outline.nodes.len() as u32).filter(|&i| !outline.node(i).dead);
        let (mut length, mut moved) = (0.0, 0.0);
        for i in alive() {
            let edge = outline.edge(i).length();
            length += edge;
            moved += if outline.is_still(i) { 0.0 } else { edge };
        }
        let kept = alive().filter(|&i| !outline.node(i).born && !outline.node(i).moved).count();
        Report {
            steps: self.advance.steps,
            time: self.advance.time,
            end: self.status().end(),
            moving: self.advance.last.moving,
            largest: self.advance.last.largest,
            swept: self.advance.swept,
            kept,
            vertices: self.vertices,
            moved_fraction: if length > 0.0 { moved / length } else { 0.0 },
            contacts: self.advance.contacts.iter().map(|&c| c.into()).collect(),
        }
    }
}
