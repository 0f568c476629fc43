//! Where the surface lands: on the ball itself, where something tells where it is.
//!
//! Curvature on a mesh says when a vertex is at the bound to a few per cent. Contact says where the bound is: a vertex that has
//! come near goes exactly there, and what has landed stays. Far from it the flow goes on as it would, and as nothing comes nearer
//! to the ball than it moves, contact is asked only where a vertex may have come near.

use super::SurfaceFront;
use super::spikes::MISSED;
use crate::mesh::{Point, Vector};
use crate::threads;

/// Where a ball comes to rest nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing {
    /// The point that it touches.
    pub point: Point,
    /// How far that is outward of the point that was asked about; negative where that one is farther out.
    pub gap: f64,
    /// The unit normal of the surface there, outward.
    pub normal: Vector,
}

/// Tells where a ball comes to rest: nearest to a point, looked for from the side of a unit normal, of a radius.
pub type Contact<'a> = Box<dyn Fn(Point, Vector, f64) -> Option<Landing> + Sync + 'a>;

/// A vertex that is nearer than so many edge lengths lands, once its curvature lets it go or a neighbour has moved. Where nothing
/// moves any more, vertices land from twice as far, and so on up to the last: by then what is short of the ball is so for the way
/// that the faces lie there, and not as there would be more to flow.
pub(super) const CAPTURE: f64 = 0.5;
const LAST_CAPTURE: f64 = 4.0;

/// A vertex that moved so often and has not landed is left where it is; moves that were to land count for more.
pub(super) const TRIES: u8 = 128;
pub(super) const LANDING_COST: u8 = 8;

/// Less than this, in edge lengths, is no motion while vertices could land from farther away.
const STUCK: f64 = 1e-3;

/// A vertex that moved has landed where it is this near, in edge lengths.
const LANDED: f64 = 1e-7;

/// A vertex of the input that would move by less than this many sagittas of its edges stays, and by less than so many edge
/// lengths: the samples of a surface that the ball fits are on it, not their chords.
const SAGITTAS: f64 = 2.0;
const DEAD_BAND: f64 = 0.05;

/// What contact says of a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Approach {
    /// It may be anywhere.
    #[default]
    Unknown,
    /// The ball is at least so far away.
    Far(f64),
    /// It lands there in this step.
    Near(Landing),
    /// It is where the ball touches.
    Landed(Vector),
}

impl SurfaceFront<'_> {
    /// Whether contact tells where the surface lands.
    pub(super) fn is_guided(&self) -> bool {
        self.field.contact.is_some()
    }

    /// The landing nearest to a place.
    pub(super) fn landing(&self, p: Point, normal: Vector, radius: f64) -> Option<Landing> {
        self.field.contact.as_ref().and_then(|contact| contact(p, normal, radius))
    }

    /// What contact says of vertex `v`, which is asked only if it may be near.
    pub(super) fn approach(&mut self, v: u32) -> Approach {
        if self.is_known(v) {
            return self.vertices[v as usize].approach;
        }
        let landing = self.landing(self.point(v), self.normal(v), self.vertices[v as usize].radius);
        self.note_landing(v, landing)
    }

    /// Whether what contact said of a vertex still holds.
    fn is_known(&self, v: u32) -> bool {
        match self.vertices[v as usize].approach {
            Approach::Unknown => false,
            Approach::Far(gap) => gap > self.capture * self.h,
            Approach::Near(_) | Approach::Landed(_) => true,
        }
    }

    /// Asks contact about those of some vertices of which it has to say something new, on several threads.
    pub(super) fn ask(&mut self, vertices: &[u32]) {
        let Some(contact) = &self.field.contact else { return };
        let asked: Vec<u32> = vertices.iter().copied().filter(|&v| !self.is_known(v)).collect();
        let places: Vec<(Point, Vector, f64)> =
            asked.iter().map(|&v| (self.point(v), self.normal(v), self.vertices[v as usize].radius)).collect();
        // Each answer depends on its place alone, whatever the thread.
        let landings = threads::map(&places, threads::available(), |&(p, normal, radius)| contact(p, normal, radius));
        for (v, landing) in asked.into_iter().zip(landings) {
            self.note_landing(v, landing);
        }
    }

    fn note_landing(&mut self, v: u32, landing: Option<Landing>) -> Approach {
        let approach = match landing {
            None => Approach::Unknown,
            Some(landing) if self.rests(v, landing.gap) => Approach::Landed(landing.normal),
            Some(landing) if landing.gap <= self.capture * self.h => Approach::Near(landing),
            Some(landing) => Approach::Far(landing.gap),
        };
        self.vertices[v as usize].approach = approach;
        approach
    }

    /// Whether a vertex rests that is so far inside of where the ball touches.
    fn rests(&self, v: u32, gap: f64) -> bool {
        if self.has_moved(v) {
            return gap.abs() <= LANDED * self.h;
        }
        let around: Vec<f64> = self.mesh.spokes(v).map(|h| self.mesh.length(h)).collect();
        let mean = around.iter().sum::<f64>() / around.len().max(1) as f64;
        gap <= (SAGITTAS * mean * mean / (8.0 * self.vertices[v as usize].radius)).min(DEAD_BAND * self.h)
    }

    /// Whether a vertex is where the ball touches.
    pub(super) fn has_landed(&self, v: u32) -> bool {
        matches!(self.vertices[v as usize].approach, Approach::Landed(_))
    }

    /// Notes that a vertex moved by `distance`.
    pub(super) fn come_nearer(&mut self, v: u32, distance: f64) {
        let approach = &mut self.vertices[v as usize].approach;
        *approach = match *approach {
            Approach::Far(gap) => Approach::Far(gap - distance),
            _ => Approach::Unknown,
        };
    }

    /// Lets vertices land from farther away where a step came to `largest` edge lengths; whether there is something left to do.
    pub(super) fn reach_farther(&mut self, largest: f64) -> bool {
        if !self.is_guided() || largest >= STUCK || self.capture >= LAST_CAPTURE {
            return false;
        }
        self.capture *= 2.0;
        let open = |v: &u32| self.has_moved(*v) && self.mesh.has_vertex(*v) && !self.has_landed(*v);
        let open: Vec<u32> = (0..self.vertices.len() as u32).filter(open).collect();
        for &v in &open {
            let missed = &mut self.vertices[v as usize].missed;
            *missed = (*missed).min(MISSED);
            self.touch(v);
        }
        !open.is_empty()
    }
}
