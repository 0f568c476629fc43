//! The loop: steps, the clock, and when to stop.

use super::step::{Displaced, Front, TREMBLING, step};
use crate::linalg::Singular;

/// A flow that moves less than this in a step, in edge lengths, has ended: a hundred thousand such steps are not a tenth
/// of an edge length.
pub const DEFAULT_TOLERANCE: f64 = TREMBLING;

/// The flow looks for contacts whenever the boundary may have moved by so many edge lengths since it last did: what
/// crosses is found before it has gone an edge length deep.
const CONTACT_STRIDE: f64 = 0.25;

/// A flow that has not become smaller by [`STALLED_SHRINKAGE`] edge lengths (or their squares) in so many steps makes no
/// progress: vertices at the bound may go on trembling by less than their tolerance.
const STALL_STEPS: u64 = 4_000;
const STALLED_SHRINKAGE: f64 = 1e-7;

/// Steps get longer by so much at once: what they meet next may need short ones.
const GROWTH: f64 = 2.0;

/// What to do where the boundary runs into itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OnContact {
    /// Go on, and tell.
    #[default]
    Report,
    /// Stop at the first one.
    Stop,
    /// Surfaces: make no move that takes the surface through itself, and go on with the others; outlines: as [`OnContact::Report`].
    Freeze,
}

/// Why a flow ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum End {
    /// Nothing is beyond the bound any more: the limit.
    Still,
    /// Everything that is beyond the bound moves by less than the tolerance in a step: the limit.
    Slow,
    /// The boundary ran into itself, and was to stop there.
    Contact,
    /// Vertices go on moving, but nothing comes of it.
    Stalled,
    /// A step could not be solved.
    Singular,
}

impl End {
    /// Whether the flow got where it was going.
    pub fn is_limit(self) -> bool {
        matches!(self, End::Still | End::Slow)
    }
}

/// Where a flow is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// There is more to come.
    Going,
    /// It has ended.
    Ended(End),
}

impl Status {
    /// Why it ended; `None` while there is more to come.
    pub fn end(self) -> Option<End> {
        match self {
            Status::Going => None,
            Status::Ended(end) => Some(end),
        }
    }
}

/// A front on its way.
#[derive(Clone, Debug)]
pub struct Advance<F, const D: usize> {
    /// The boundary.
    pub front: F,
    /// Steps so far.
    pub steps: u64,
    /// Time so far, in the square of the unit of length.
    pub time: f64,
    /// The last step.
    pub last: Displaced,
    /// What the boundary has swept over.
    pub swept: f64,
    /// Where it crossed itself.
    pub contacts: Vec<[f64; D]>,
    /// The time step in units of the shortest edge length that moves, squared.
    time_step: f64,
    /// That edge length.
    shortest_edge: f64,
    tolerance: f64,
    on_contact: OnContact,
    status: Status,
    /// The farthest any vertex may have come since contacts were looked for, in edge lengths.
    unseen: f64,
    /// Shrinkage since the step at which progress was last seen.
    shrunk: f64,
    progress_at: u64,
}

impl<F: Front<D>, const D: usize> Advance<F, D> {
    /// A flow of `front` in steps of `time_step` squares of the shortest edge length that moves, which ends where no vertex
    /// moves by more than `tolerance` edge lengths in one.
    pub fn new(front: F, time_step: f64, tolerance: f64, on_contact: OnContact) -> Advance<F, D> {
        Advance {
            shortest_edge: front.edge_length(),
            front,
            steps: 0,
            time: 0.0,
            last: Displaced::default(),
            swept: 0.0,
            contacts: Vec::new(),
            time_step,
            tolerance,
            on_contact,
            status: Status::Going,
            unseen: 0.0,
            shrunk: 0.0,
            progress_at: 0,
        }
    }

    /// Where the flow is.
    pub fn status(&self) -> Status {
        self.status
    }

    /// One step, of the full time step or what is left of it before `until`.
    pub fn step(&mut self, until: f64) -> Status {
        let left = until - self.time;
        if self.status != Status::Going || left <= 0.0 {
            return self.status;
        }
        // What rounding leaves over of the last step is part of it.
        const ROUNDING: f64 = 1e-9;
        let full = self.time_step * self.shortest_edge * self.shortest_edge;
        let tau = if left < full * (1.0 + ROUNDING) { left } else { full };
        match step(&mut self.front, tau) {
            Ok(Some(displaced)) => self.count(displaced, tau, full, until),
            Ok(None) => {
                self.last = Displaced::default();
                self.look();
                self.end(End::Still);
            }
            Err(Singular) => self.end(End::Singular),
        }
        self.status
    }

    fn count(&mut self, displaced: Displaced, tau: f64, full: f64, until: f64) {
        self.steps += 1;
        self.time = if until - self.time <= tau { until } else { self.time + tau };
        self.last = displaced;
        self.swept += displaced.swept;
        self.unseen += displaced.largest;
        if self.unseen >= CONTACT_STRIDE {
            self.look();
        }
        self.shrunk += displaced.shrunk;
        let edge_length = self.front.edge_length();
        if self.shrunk > STALLED_SHRINKAGE * edge_length.powi(D as i32 - 1) {
            (self.shrunk, self.progress_at) = (0.0, self.steps);
        }
        // A step that was cut short moves less than it would.
        if displaced.largest < self.tolerance * (tau / full) {
            self.look();
            self.end(End::Slow);
        } else if self.steps - self.progress_at > STALL_STEPS {
            self.look();
            self.end(End::Stalled);
        }
        // Where everything trembles there is no reason for other steps.
        if displaced.shortest_edge.is_finite() {
            self.shortest_edge =
                displaced.shortest_edge.clamp(edge_length, GROWTH * self.shortest_edge.max(edge_length));
        }
    }

    fn look(&mut self) {
        self.unseen = 0.0;
        self.contacts.extend(self.front.contacts());
        if self.on_contact == OnContact::Stop && !self.contacts.is_empty() {
            self.end(End::Contact);
        }
    }

    /// The first reason to end is the reason.
    fn end(&mut self, end: End) {
        if self.status == Status::Going {
            self.status = Status::Ended(end);
        }
    }
}

#[cfg(test)]
mod tests;
