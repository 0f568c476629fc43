//! Spikes: vertices that were left behind as all around them went on.
//!
//! Their faces stand on edge, so no normal says where they could go, and the mesh around them is no better for splitting or
//! turning edges. They are cut off: merged into a neighbour, where that closes what they leave open.

use super::SurfaceFront;
use super::landing::LANDING_COST;
use crate::mesh::{Point, Vector};

/// A vertex is looked at that missed its landing so often.
pub(super) const MISSED: u8 = 2 * LANDING_COST;

/// A spike is cut off where its faces keep less than this part of their area.
const AREA_LEFT: f64 = 0.8;

/// Nor may an edge get longer than so many edge lengths by it.
const LONGEST_BRIDGE: f64 = 1.5;

impl SurfaceFront<'_> {
    /// Merges vertex `v` into a neighbour if it is a spike.
    pub(super) fn cut_off_at(&mut self, v: u32) {
        let is_open = self.is_guided()
            && self.mesh.has_vertex(v)
            && self.has_moved(v)
            && !self.is_pinned(v)
            && !self.has_landed(v)
            && self.vertices[v as usize].missed >= MISSED;
        if !is_open {
            return;
        }
        let mut spokes: Vec<u32> = self.mesh.spokes(v).collect();
        spokes.sort_by(|&g, &h| self.mesh.length(g).total_cmp(&self.mesh.length(h)).then(g.cmp(&h)));
        for h in spokes {
            if self.may_cut_off(h) {
                let stays = self.mesh.target(h);
                self.mesh.collapse(h);
                self.change_faces(stays);
                self.touch(stays);
                return;
            }
        }
    }

    /// Whether the vertex at the origin of `h` may go into its target: the faces get smaller, what they enclose does not, and they
    /// pass through nothing.
    fn may_cut_off(&mut self, h: u32) -> bool {
        if !self.mesh.can_collapse(h) {
            return false;
        }
        let (gone, stays) = (self.mesh.origin(h), self.mesh.target(h));
        let (from, to) = (self.point(gone), self.point(stays));
        let faces: Vec<u32> = self.mesh.faces_at(gone).collect();
        let area = |[a, b, c]: [Point; 3]| -> Vector { (b - a).cross(&(c - a)) };
        let (mut before, mut after, mut volume, mut left) = (0.0, 0.0, 0.0, Vec::new());
        for &f in &faces {
            let old = self.mesh.triangle(f);
            before += area(old).norm();
            volume += area(old).dot(&(to - from));
            let corners = self.mesh.face(f);
            if corners.contains(&stays) {
                continue;
            }
            let new = corners.map(|w| if w == gone { to } else { self.point(w) });
            after += area(new).norm();
            left.push(new);
        }
        let is_long = |w: u32| (self.point(w) - to).norm() > LONGEST_BRIDGE * self.h;
        if after > AREA_LEFT * before || volume < 0.0 || self.mesh.neighbours(gone).any(is_long) {
            return false;
        }
        let around: Vec<Point> = self.mesh.neighbours(gone).map(|w| self.point(w)).collect();
        let ground = self.ground();
        !around.iter().any(|p| ground.is_crossed(to, *p)) && !self.would_cross(&left, &faces)
    }
}
