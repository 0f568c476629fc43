//! Where a vertex may go: outward of its faces, and no farther than they can follow.

use super::SurfaceFront;
use crate::flow::obstacle::{Obstacle, Way};
use crate::mesh::Vector;

/// A vertex goes no farther in a step than so many edge lengths; farther where contact tells where to stop.
const STRIDE: f64 = 0.25;
const GUIDED_STRIDE: f64 = 0.5;

/// A face may become no smaller in a step, seen along its old normal, than this part of it.
const LEAST_LEFT: f64 = 0.2;

/// A step is tried at most at so many halves of its length.
const HALVINGS: usize = 4;

/// What would cross is tried at so many halves.
const FREEINGS: usize = 2;

impl SurfaceFront<'_> {
    /// The direction in which vertex `v` moves: of unit length, outward of all its faces if there is such a one.
    pub(super) fn normal(&self, v: u32) -> Vector {
        let center = self.point(v);
        let (mut faces, mut normal) = (Vec::new(), Vector::zeros());
        for h in self.mesh.spokes(v) {
            // Faces without area have no direction.
            let Some(n) = self.mesh.area_vector(self.mesh.face_of(h)).try_normalize(0.0) else { continue };
            let (a, b) = (self.point(self.mesh.target(h)) - center, self.point(self.mesh.opposite(h)) - center);
            normal += n * a.cross(&b).norm().atan2(a.dot(&b));
            faces.push(n);
        }
        // Towards the worst one, a few times: smaller and smaller steps.
        for k in 1..=8 {
            normal = normal.try_normalize(0.0).unwrap_or_default();
            let Some(worst) = faces.iter().min_by(|a, b| a.dot(&normal).total_cmp(&b.dot(&normal))) else { break };
            if worst.dot(&normal) > 0.1 {
                break;
            }
            normal += worst / f64::from(k);
        }
        normal.try_normalize(0.0).unwrap_or_default()
    }

    /// What of the displacement `d` vertex `v` takes: along its normal, to the side to which it moves, and no farther than its
    /// faces can follow.
    ///
    /// So the volume between the old and the new faces at it is empty before and solid after, or the other way round.
    pub(super) fn allowed(&self, v: u32, d: Vector) -> Vector {
        let d = if self.obstacle == Obstacle::NONE {
            d
        } else {
            let normal = self.normal(v);
            let along = match self.way(v) {
                Some(Way::Outward) => d.dot(&normal).max(0.0),
                Some(Way::Inward) => d.dot(&normal).min(0.0),
                None => 0.0,
            };
            let leads_back = self.mesh.faces_at(v).any(|f| self.mesh.area_vector(f).dot(&normal) < 0.0);
            if leads_back { Vector::zeros() } else { normal * along }
        };
        self.followed(v, d)
    }

    /// What of the displacement `d` the faces at vertex `v` can follow.
    pub(super) fn followed(&self, v: u32, mut d: Vector) -> Vector {
        let length = d.norm();
        let stride = if self.is_guided() { GUIDED_STRIDE } else { STRIDE } * self.h;
        if length > stride {
            d *= stride / length;
        }
        for _ in 0..HALVINGS {
            let place = self.point(v) + d;
            let follows = |h: u32| {
                let (a, b) = (self.point(self.mesh.target(h)), self.point(self.mesh.opposite(h)));
                let old = self.mesh.area_vector(self.mesh.face_of(h));
                (a - place).cross(&(b - place)).dot(&old) >= LEAST_LEFT * old.norm_squared()
            };
            if self.mesh.spokes(v).all(follows) {
                return d;
            }
            d *= 0.5;
        }
        if self.obstacle == Obstacle::NONE || self.is_guarded { Vector::zeros() } else { d }
    }

    /// What of the displacement `d` vertex `v` takes without the surface passing through itself.
    pub(super) fn free(&mut self, v: u32, mut d: Vector) -> Vector {
        if !self.is_guarded || d == Vector::zeros() {
            return d;
        }
        for _ in 0..=FREEINGS {
            if !self.would_cross_at(v, self.point(v) + d) {
                self.vertices[v as usize].blocked = false;
                return d;
            }
            d *= 0.5;
        }
        self.vertices[v as usize].blocked = true;
        Vector::zeros()
    }
}
