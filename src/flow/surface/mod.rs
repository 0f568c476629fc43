//! The flow of surfaces.
//!
//! The surface is taken as it is: faces are cut only at moving vertices, so what never moves comes out bit for bit. Vertices on a
//! boundary stay.

mod contact;
mod crowd;
mod curvature;
mod direction;
mod front;
mod landing;
mod motion;
mod operators;
mod refine;
mod release;
mod remesh;
mod result;
mod spikes;
#[cfg(test)]
mod tests;

pub use front::SurfaceFront;
pub use landing::{Contact, Landing};
pub use result::FlownSurface;

use super::advance::{Advance, End, OnContact, Status};
use super::obstacle::Obstacle;
use crate::mesh::{HalfEdgeMesh, NotManifold, Point, TriangleMesh, Vector};

/// The time step tau in units of h².
pub const DEFAULT_SURFACE_TIME_STEP: f64 = 2.0;

/// A flow that moves less than this in a step, in edge lengths, has ended.
pub const DEFAULT_SURFACE_TOLERANCE: f64 = 1e-4;

/// What the bound depends on in space.
pub struct SurfaceField<'a> {
    /// The radius of the ball at a place.
    pub radius: Box<dyn Fn(Point) -> f64 + 'a>,
    /// How far a place is from what is pinned; 0 there, where everything stays whatever its curvature.
    ///
    /// Near a pin, seven tenths of this distance are the radius: a surface meets what is pinned smoothly.
    pub pin_distance: Box<dyn Fn(Point) -> f64 + 'a>,
    /// Where the ball touches, for a flow that is to land there; `None` for one that ends at the bound on curvature. Only closing
    /// asks for it, and opening, which closes what is empty: there it is the ball that rolls inside.
    pub contact: Option<Contact<'a>>,
    /// What the radius is multiplied by where the outward unit normal is this one; nothing: it is the same whichever way the
    /// surface faces. The normal is the one that the surface has at the time.
    pub facing: Option<Box<dyn Fn(Vector) -> f64 + 'a>>,
}

impl SurfaceField<'_> {
    /// The same radius everywhere, and no pins.
    pub fn constant(radius: f64) -> SurfaceField<'static> {
        SurfaceField {
            radius: Box::new(move |_| radius),
            pin_distance: Box::new(|_| f64::INFINITY),
            contact: None,
            facing: None,
        }
    }
}

/// What a surface is driven by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// Its minimum curvature, in the direction of it; opening: its maximum curvature.
    #[default]
    Minimum,
    /// Its mean curvature, for comparison: it rounds what it should leave alone.
    Mean,
}

/// How finely, and how far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceSettings {
    /// The edge length h, in the unit of the surface.
    pub edge: f64,
    /// The time step tau in units of h².
    pub time_step: f64,
    /// The flow ends where no vertex moves by more than so many edge lengths in a step.
    pub tolerance: f64,
    /// What to do where the surface runs into itself.
    pub on_contact: OnContact,
    /// What it is driven by.
    pub kind: Kind,
}

impl SurfaceSettings {
    /// The defaults with edges of this length.
    pub fn new(edge: f64) -> SurfaceSettings {
        SurfaceSettings {
            edge,
            time_step: DEFAULT_SURFACE_TIME_STEP,
            tolerance: DEFAULT_SURFACE_TOLERANCE,
            on_contact: OnContact::Report,
            kind: Kind::Minimum,
        }
    }
}

/// Why the flow of a surface cannot start.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceFlowError {
    /// The edge length is no positive number.
    #[error("an edge length of {0}: it must be a finite number above zero; an eighth of the radius is the rule")]
    EdgeLength(f64),
    /// The time step is no positive number.
    #[error("a time step of {0} squares of the edge length: it must be above 0 and at most 100; 2 is the rule")]
    TimeStep(f64),
    /// The tolerance is no positive number.
    #[error("a tolerance of {0} edge lengths: it must be above 0 and at most 1")]
    Tolerance(f64),
    /// The field gives no radius at a vertex.
    #[error(
        "the radius at vertex {vertex} is {radius}: it must be a finite number above zero everywhere on the surface"
    )]
    Radius {
        /// The vertex.
        vertex: u32,
        /// What it is there.
        radius: f64,
    },
    /// A coordinate is no number.
    #[error("vertex {0} has coordinates that are no numbers")]
    Coordinates(u32),
    /// The faces are no surface.
    #[error("{0}; repair the surface first")]
    NotManifold(#[from] NotManifold),
}

/// What is known of the flow of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceReport {
    /// Steps so far.
    pub steps: u64,
    /// Time so far, in the square of the unit of length.
    pub time: f64,
    /// Why it ended; `None` while it goes on.
    pub end: Option<End>,
    /// Vertices that moved in the last step.
    pub moving: usize,
    /// The largest displacement of the last step, in edge lengths.
    pub largest: f64,
    /// The volume that the surface has swept over.
    pub swept: f64,
    /// Vertices of the input that are where they were, and all of them.
    pub kept: usize,
    /// See `kept`.
    pub vertices: usize,
    /// Places where the surface passed through itself.
    pub contacts: Vec<Point>,
}

/// A flow of a surface.
pub struct SurfaceFlow<'a> {
    advance: Advance<SurfaceFront<'a>, 3>,
    /// It closes what is empty, which is opening: so a surface and its counterpart stay alike to the last bit.
    mirrored: bool,
}

impl<'a> SurfaceFlow<'a> {
    /// The flow of `surface` against `obstacle`.
    ///
    /// # Errors
    /// Where a setting is out of range, the faces are no surface, or the field gives no radius at a vertex.
    pub fn new(
        surface: &TriangleMesh,
        obstacle: Obstacle,
        field: SurfaceField<'a>,
        settings: &SurfaceSettings,
    ) -> Result<SurfaceFlow<'a>, SurfaceFlowError> {
        let SurfaceSettings { edge, time_step, tolerance, on_contact, kind } = *settings;
        if !(edge.is_normal() && edge > 0.0) {
            return Err(SurfaceFlowError::EdgeLength(edge));
        }
        if !(time_step > 0.0 && time_step <= 100.0) {
            return Err(SurfaceFlowError::TimeStep(time_step));
        }
        if !(tolerance > 0.0 && tolerance <= 1.0) {
            return Err(SurfaceFlowError::Tolerance(tolerance));
        }
        for (vertex, &p) in (0u32..).zip(&surface.points) {
            if !p.iter().all(|x| x.is_finite()) {
                return Err(SurfaceFlowError::Coordinates(vertex));
            }
            let radius = (field.radius)(p);
            if !(radius.is_normal() && radius > 0.0) {
                return Err(SurfaceFlowError::Radius { vertex, radius });
            }
        }
        let mirrored = obstacle == Obstacle::OPENING;
        let (input, obstacle) =
            if mirrored { (surface.reversed(), Obstacle::CLOSING) } else { (surface.clone(), obstacle) };
        let mesh = HalfEdgeMesh::new(input.points.clone(), &input.faces)?;
        let mut field = if obstacle == Obstacle::CLOSING && kind == Kind::Minimum {
            field
        } else {
            SurfaceField { contact: None, ..field }
        };
        if mirrored {
            field.facing = field.facing.map(|facing| Box::new(move |n: Vector| facing(-n)) as Box<_>);
        }
        let freeze = on_contact == OnContact::Freeze;
        let front = SurfaceFront::new(input, mesh, field, obstacle, kind, edge, freeze);
        Ok(SurfaceFlow { advance: Advance::new(front, time_step, tolerance, on_contact), mirrored })
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

    /// Time so far, in the square of the unit of length.
    pub fn time(&self) -> f64 {
        self.advance.time
    }

    /// Vertices that moved in the last step, and the farthest that one did, in edge lengths.
    pub fn last_step(&self) -> (usize, f64) {
        (self.advance.last.moving, self.advance.last.largest)
    }

    /// The surface as it is now.
    pub fn result(&self) -> FlownSurface {
        self.advance.front.result(self.mirrored)
    }

    /// What is known so far.
    pub fn report(&self) -> SurfaceReport {
        let front = &self.advance.front;
        let vertices = front.input.points.len();
        SurfaceReport {
            steps: self.advance.steps,
            time: self.advance.time,
            end: self.status().end(),
            moving: self.advance.last.moving,
            largest: self.advance.last.largest,
            swept: self.advance.swept,
            kept: (0..vertices as u32).filter(|&v| front.is_kept(v)).count(),
            vertices,
            contacts: self.advance.contacts.iter().map(|&c| c.into()).chain(front.blocked()).collect(),
        }
    }
}
