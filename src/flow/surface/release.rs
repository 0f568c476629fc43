//! Which vertices are let go: by curvature, and by contact where there is something to land on.

use super::curvature::{Curved, Measure, curved};
use super::landing::{Approach, TRIES};
use super::{Kind, SurfaceFront};
use crate::flow::obstacle::{Obstacle, Way};
use crate::mesh::Point;

/// A vertex is let go where it is beyond the bound by more than this part of it, and by [`FITTING`] (h / r)²: what the curvature of
/// samples of a cylinder of radius r is beyond it, by less than 0.0002 more or less, on faces of any shape.
const DEAD_BAND: f64 = 0.003;
const FITTING: f64 = 0.25;

/// Where contact tells where to land, vertices at the edge of what moved are let go that are short of the bound by this part of it.
const DRIVEN: f64 = 0.5;

/// Without a bound, curvatures below this part of 1 / r are none.
const UNBOUND_BAND: f64 = 1e-9;

/// A vertex with no more edges than this has its curvature from the vertices beyond its faces as well: five fit a quadratic
/// function whatever they are, four leave it open.
const FEW: usize = 5;

/// Unless they are farther away, in edge lengths, than this.
const FAR: f64 = 3.0;

impl SurfaceFront<'_> {
    /// What a vertex that goes one way is driven by.
    fn measure(&self, way: Way) -> Measure {
        match (self.kind, way) {
            (Kind::Mean, _) => Measure::Mean,
            (Kind::Minimum, Way::Inward) if self.obstacle != Obstacle::NONE => Measure::Maximum,
            (Kind::Minimum, _) => Measure::Minimum,
        }
    }

    /// The curvature at `v`, with vertices at the places that `place` tells.
    pub(super) fn curved(&self, v: u32, way: Way, place: impl Fn(u32) -> Point, around: &mut Vec<Point>) -> Curved {
        around.clear();
        around.extend(self.mesh.neighbours(v).map(&place));
        let ring = around.len();
        if ring <= FEW {
            let beyond = |h: u32| {
                let link = 3 * (h / 3) + (h % 3 + 1) % 3;
                self.mesh
                    .twin(link)
                    .map(|t| place(self.mesh.opposite(t)))
                    .filter(|p| (p - place(v)).norm() < FAR * self.h)
            };
            around.extend(self.mesh.spokes(v).filter_map(beyond));
        }
        curved(place(v), around, ring, self.measure(way), self.vertices[v as usize].radius, self.h)
    }

    /// How far beyond the bound a vertex may rest.
    fn band(&self, v: u32) -> f64 {
        let radius = self.vertices[v as usize].radius;
        if self.obstacle == Obstacle::NONE {
            return UNBOUND_BAND / radius;
        }
        let part = (self.h / radius).min(1.0);
        (DEAD_BAND + FITTING * part * part) / radius
    }

    /// Which way vertex `v` is let go that is beyond the bound by more than `band`, and how far beyond it is.
    fn released(&self, v: u32, band: f64, around: &mut Vec<Point>) -> Option<(Way, f64)> {
        [Way::Outward, Way::Inward].into_iter().find_map(|way| {
            // Of bounds that are not there none is passed.
            if self.obstacle.beyond(way, 0.0, 1.0) == f64::NEG_INFINITY {
                return None;
            }
            let c = self.curved(v, way, |v| self.point(v), around);
            let beyond = self.obstacle.beyond(way, c.curvature, c.unit);
            (beyond > band && beyond.is_finite()).then_some((way, beyond))
        })
    }

    /// Whether a vertex or a neighbour has moved.
    fn is_reached(&self, v: u32) -> bool {
        self.has_moved(v) || self.mesh.neighbours(v).any(|w| self.has_moved(w))
    }

    /// Asks contact about the candidates that are to hear from it, all at once.
    pub(super) fn ask_ahead(&mut self, candidates: &[u32], is_first: bool) {
        if !self.is_guided() {
            return;
        }
        let mut around = Vec::new();
        let mut asked: Vec<u32> = candidates.to_vec();
        asked.sort_unstable();
        asked.dedup();
        asked.retain(|&v| {
            let vertex = &self.vertices[v as usize];
            self.mesh.has_vertex(v)
                && !vertex.pinned
                && vertex.missed <= TRIES
                && (self.is_reached(v) || is_first && self.released(v, self.band(v), &mut around).is_some())
        });
        self.ask(&asked);
    }

    /// Which way vertex `v` is let go, by curvature and by contact, and how far beyond the bound it is.
    pub(super) fn let_go(&mut self, v: u32, around: &mut Vec<Point>) -> Option<(Way, f64)> {
        if !self.is_guided() {
            return self.released(v, self.band(v), around);
        }
        if self.has_landed(v) || self.vertices[v as usize].missed > TRIES {
            return None;
        }
        // Contact tells of vertices at the edge of what moved, curvature of all others.
        let released = if self.is_reached(v) { None } else { Some(self.released(v, self.band(v), around)?) };
        match self.approach(v) {
            Approach::Landed(_) => None,
            Approach::Near(_) => Some((Way::Outward, f64::MIN_POSITIVE)),
            Approach::Unknown if self.has_moved(v) => None,
            Approach::Far(_) | Approach::Unknown => {
                let (way, beyond) =
                    released.or_else(|| self.released(v, -DRIVEN / self.vertices[v as usize].radius, around))?;
                Some((way, beyond.max(f64::MIN_POSITIVE)))
            }
        }
    }
}
