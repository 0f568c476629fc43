//! Coarse faces near what moves are cut in their planes.
//!
//! Always at the longest edge of a face and of the one beyond it (Rivara, 1984): so no angle gets smaller than half of the
//! smallest that was there, and the parts get larger and larger away from what moves.

use super::SurfaceFront;
use super::curvature::COARSE;
use super::direction::dihedral;
use super::front::Vertex;
use crate::flow::obstacle::Way;
use crate::mesh::Point;

/// One edge must be longer than another by this part of it, or they are equally long.
const LONGER: f64 = 1e-9;

/// No more cuts than so many for a face at once: halving so often comes to an end of all numbers.
const CUTS: usize = 200;

impl SurfaceFront<'_> {
    /// Cuts the edges that turn beyond the bound and are so long that no moving vertex would be seen on them.
    pub(super) fn cut_sharp_edges(&mut self) {
        let mut sharp = Vec::new();
        for h in 0..3 * self.mesh.face_count() as u32 {
            if !self.mesh.is_edge(h) || self.mesh.twin(h).is_none() || self.mesh.length(h) <= COARSE * self.h {
                continue;
            }
            let ends = [self.mesh.origin(h), self.mesh.target(h)];
            let radius = ends.iter().map(|&v| self.vertices[v as usize].radius).fold(0.0, f64::max);
            let turn = dihedral(&self.mesh, h);
            let slack = 0.5 * self.h / radius;
            if [Way::Outward, Way::Inward].iter().any(|w| self.obstacle.beyond(*w, turn, self.h / radius) > slack) {
                sharp.push(ends);
            }
        }
        // Halves of halves, until none is coarse.
        while let Some([a, b]) = sharp.pop() {
            let mut cuts = 0;
            while let Some(h) = self.mesh.half_edge(a, b).filter(|&h| self.mesh.length(h) > COARSE * self.h) {
                self.cut_longest(self.mesh.face_of(h));
                cuts += 1;
                if cuts > CUTS {
                    break;
                }
            }
            if cuts > 0 && self.mesh.half_edge(a, b).is_none() {
                // The last cut was that of the edge itself.
                let middle = self.mesh.points.len() as u32 - 1;
                sharp.extend([[a, middle], [middle, b]]);
            }
        }
    }

    /// Cuts the coarse faces at moving vertices; the vertices of those that were cut.
    pub(super) fn refine(&mut self) -> Vec<u32> {
        let mut near = Vec::new();
        for f in self.active_faces() {
            for _ in 0..CUTS {
                let h = self.longest(f);
                if self.mesh.length(h) <= COARSE * self.h {
                    break;
                }
                near.extend(self.cut_longest(f));
            }
        }
        near
    }

    /// The longest half-edge of a face; of equally long ones the one between the lowest vertices.
    fn longest(&self, f: u32) -> u32 {
        let [a, b, c] = self.mesh.half_edges(f);
        let longer = |g: u32, h: u32| if self.mesh.length(h) > self.mesh.length(g) * (1.0 + LONGER) { h } else { g };
        longer(longer(a, b), c)
    }

    /// Cuts the longest edge on the way that leads from face `f` to longer and longer ones; its corners.
    fn cut_longest(&mut self, f: u32) -> [u32; 4] {
        let mut h = self.longest(f);
        while let Some(t) = self.mesh.twin(h) {
            let longer = self.longest(self.mesh.face_of(t));
            if self.mesh.length(longer) <= self.mesh.length(h) * (1.0 + LONGER) {
                break;
            }
            h = longer;
        }
        let (a, b, c) = (self.mesh.origin(h), self.mesh.target(h), self.mesh.opposite(h));
        let d = self.mesh.twin(h).map_or(c, |t| self.mesh.opposite(t));
        let middle = Point::from(0.5 * (self.point(a).coords + self.point(b).coords));
        self.split(h, middle);
        [a, b, c, d]
    }

    /// Puts a vertex on an edge; its number.
    pub(super) fn split(&mut self, h: u32, p: Point) -> u32 {
        // Where the field says nothing, what holds at the ends.
        let radius = self.vertices[self.mesh.origin(h) as usize].radius;
        let missed = [self.mesh.origin(h), self.mesh.target(h)].map(|v| self.vertices[v as usize].missed);
        let v = self.mesh.split(h, p);
        self.vertices.push(Vertex::new(radius, missed[0].max(missed[1])));
        self.bind(v);
        self.change_faces(v);
        v
    }
}
