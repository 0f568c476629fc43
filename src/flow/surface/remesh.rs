//! Faces about moving vertices: split, merged and turned towards the edge length, and nowhere else.
//!
//! Vertices of the input that did not move are never merged or moved. A closing never loses volume by it: what is cut
//! off must be empty, except among vertices that moved, which lie on a surface that the flow mends, and there only where
//! nothing of the input is met.

use super::SurfaceFront;
use super::landing::{Approach, CAPTURE, Landing};
use crate::flow::obstacle::{Obstacle, Way};
use crate::mesh::{Hierarchy, Point, Vector};

/// Edges longer than so many edge lengths are split.
const LONGEST: f64 = 1.5;

/// Edges shorter than so many edge lengths are merged into a vertex.
const SHORTEST: f64 = 0.4;

/// Where that makes no edge longer than so many.
const LONGEST_BRIDGE: f64 = 1.4;

/// Normals of faces may turn by a quarter of a right angle or so when the mesh changes: the cosine.
const SAME_WAY: f64 = 0.9;

/// An edge is turned where the angles opposite to it are together larger than two right angles by this.
const FLIP_SLACK: f64 = 0.2;

/// Where the smallest angle at a vertex is below this, it is relaxed: 25 degrees.
const SHARP: f64 = 0.436;

/// By so much of the way to the middle of its neighbours.
const RELAXATION: f64 = 0.5;

/// What is lost of the volume by rounding, over the cube of the edge length.
const NO_VOLUME: f64 = 1e-9;

impl SurfaceFront<'_> {
    /// After a step: edges that became too short or too long, faces that became too thin.
    pub(super) fn mend(&mut self) {
        let mut moving = std::mem::take(&mut self.moving);
        for &v in &moving {
            self.merge_at(v);
        }
        for &v in &moving {
            self.cut_off_at(v);
        }
        for &v in &moving {
            self.split_stretched(v);
        }
        for &v in &moving {
            self.flip_at(v);
        }
        if self.obstacle != Obstacle::NONE {
            for &v in &moving {
                self.relax(v);
            }
        }
        moving.clear();
        self.moving = moving;
    }

    /// The side to which vertex `v` moves: 1 outward, -1 inward.
    fn side(&self, v: u32) -> f64 {
        if self.way(v) == Some(Way::Inward) { -1.0 } else { 1.0 }
    }

    /// Takes vertex `v` or a neighbour away where the edge between them is too short.
    fn merge_at(&mut self, v: u32) {
        if !self.mesh.has_vertex(v) {
            return;
        }
        let mut spokes: Vec<u32> = self.mesh.spokes(v).filter(|&h| self.mesh.length(h) < SHORTEST * self.h).collect();
        spokes.sort_by(|&g, &h| self.mesh.length(g).total_cmp(&self.mesh.length(h)).then(g.cmp(&h)));
        for h in spokes {
            if self.mesh.origin(h) != v {
                return;
            }
            let ways = [Some(h), self.mesh.twin(h)];
            if let Some(h) = ways.into_iter().flatten().find(|&h| self.may_merge(h)) {
                let (gone, stays) = (self.mesh.origin(h), self.mesh.target(h));
                self.mesh.collapse(h);
                self.change_faces(stays);
                self.touch(stays);
                if gone == v {
                    return;
                }
            }
        }
    }

    /// Whether the vertex at the origin of `h` may be merged into its target.
    fn may_merge(&mut self, h: u32) -> bool {
        let (gone, stays) = (self.mesh.origin(h), self.mesh.target(h));
        if self.is_kept(gone) || self.is_pinned(gone) || !self.mesh.can_collapse(h) {
            return false;
        }
        let (from, to) = (self.point(gone), self.point(stays));
        let side = self.side(gone);
        let mut volume = 0.0;
        let is_good = self.mesh.spokes(gone).all(|s| {
            let (b, c) = (self.mesh.target(s), self.mesh.opposite(s));
            if b == stays || c == stays {
                return true;
            }
            let (b, c) = (self.point(b), self.point(c));
            let old = (b - from).cross(&(c - from));
            let new = (b - to).cross(&(c - to));
            let longest = (b - to).norm().max((c - to).norm()).max((c - b).norm());
            let added = old.dot(&(to - from));
            volume += added;
            let loses = side * added < -NO_VOLUME * self.h.powi(3);
            let all_moved = self.has_moved(gone) && self.has_moved(stays);
            longest <= LONGEST_BRIDGE * self.h
                && (!loses || all_moved)
                && new.dot(&old) > SAME_WAY * new.norm() * old.norm()
                && new.norm() > 0.1 * longest * longest
        });
        if !is_good || side * volume < -NO_VOLUME * self.h.powi(3) {
            return false;
        }
        let faces: Vec<u32> = self.mesh.faces_at(gone).collect();
        let left = faces.iter().map(|&f| self.mesh.face(f)).filter(|corners| !corners.contains(&stays));
        let at = |w: u32| if w == gone { to } else { self.point(w) };
        let triangles: Vec<[Point; 3]> = left.map(|corners| corners.map(at)).collect();
        !self.would_cross(&triangles, &faces)
    }

    /// Splits the edges at `v` that have been stretched.
    fn split_stretched(&mut self, v: u32) {
        if !self.mesh.has_vertex(v) {
            return;
        }
        let spokes: Vec<u32> = self.mesh.spokes(v).collect();
        for h in spokes {
            // The faces about the vertex are renumbered by splits.
            if self.mesh.origin(h) != v || self.mesh.twin(h).is_none() {
                continue;
            }
            let length = self.mesh.length(h);
            let w = self.mesh.target(h);
            if length <= LONGEST * self.h || !self.is_longest_of_both(h) {
                continue;
            }
            let (p, q) = (self.point(v), self.point(w));
            let middle = Point::from(0.5 * (p.coords + q.coords));
            let new = self.split(h, middle);
            if self.has_moved(v) && self.has_moved(w) {
                self.vertices[new as usize].moved = true;
                let (m, n) = (self.normal(v), self.normal(w));
                // The surface bulges from the chord by an eighth of its length for every radian that it turns.
                let turn = (n - m).dot(&(q - p)) / length;
                let normal = (m + n).try_normalize(0.0).unwrap_or_default();
                let both = self.has_landed(v) && self.has_landed(w);
                match if both { self.landing(middle, normal, self.vertices[new as usize].radius) } else { None } {
                    Some(landing) => self.land(new, landing),
                    None => _ = self.slide(new, normal * (turn.clamp(-0.5, 0.5) * length / 8.0)),
                }
            }
            self.touch(new);
        }
    }

    fn is_longest_of_both(&self, h: u32) -> bool {
        let length = self.mesh.length(h);
        let longest = |f: u32| self.mesh.half_edges(f).iter().map(|&h| self.mesh.length(h)).fold(0.0, f64::max);
        // Thin faces have two edges that are nearly the longest.
        [Some(h), self.mesh.twin(h)].into_iter().flatten().all(|h| length > 0.8 * longest(self.mesh.face_of(h)))
    }

    /// The smallest angle at the corners of the faces about a vertex, were it at `p`.
    fn smallest_angle(&self, v: u32, p: Point) -> f64 {
        let angle = |a: Vector, b: Vector| a.cross(&b).norm().atan2(a.dot(&b));
        self.mesh.spokes(v).fold(f64::INFINITY, |least, h| {
            let (b, c) = (self.point(self.mesh.target(h)), self.point(self.mesh.opposite(h)));
            least.min(angle(b - p, c - p)).min(angle(p - b, c - b)).min(angle(p - c, b - c))
        })
    }

    /// Turns the edges of the faces at `v` that have the larger angles opposite.
    fn flip_at(&mut self, v: u32) {
        if !self.mesh.has_vertex(v) {
            return;
        }
        let edges: Vec<u32> = self.mesh.faces_at(v).flat_map(|f| self.mesh.half_edges(f)).collect();
        for h in edges {
            if self.mesh.has_face(self.mesh.face_of(h)) && self.may_flip(h) {
                let [a, b] = [self.mesh.origin(h), self.mesh.target(h)];
                self.mesh.flip(h);
                let ends = [a, b, self.mesh.origin(h), self.mesh.target(h)];
                ends.into_iter().for_each(|v| self.touch(v));
                let faces = [Some(h), self.mesh.twin(h)].map(|h| h.map(|h| self.mesh.face_of(h)));
                for f in faces.into_iter().flatten() {
                    self.change_face(f);
                }
            }
        }
    }

    fn may_flip(&mut self, h: u32) -> bool {
        let Some(t) = self.mesh.twin(h) else { return false };
        let ends = [self.mesh.origin(h), self.mesh.target(h)];
        let far = [self.mesh.opposite(h), self.mesh.opposite(t)];
        if ends.iter().all(|&v| !self.has_moved(v)) && far.iter().all(|&v| !self.has_moved(v)) {
            return false;
        }
        let [a, b, c, d] = [ends[0], ends[1], far[0], far[1]].map(|v| self.point(v));
        let angle = |p: Point| (a - p).cross(&(b - p)).norm().atan2((a - p).dot(&(b - p)));
        if angle(c) + angle(d) <= std::f64::consts::PI + FLIP_SLACK || !self.mesh.can_flip(h) {
            return false;
        }
        let old = [(b - a).cross(&(c - a)), (a - b).cross(&(d - b))];
        let new = [(c - d).cross(&(a - d)), (d - c).cross(&(b - c))];
        let sum = (old[0] + old[1]).try_normalize(0.0).unwrap_or_default();
        if new.iter().chain(&old).any(|n| n.dot(&sum) <= SAME_WAY * n.norm()) {
            return false;
        }
        // Volume between the two pairs of faces, positive where the new ones are farther out.
        let gain = old[0].dot(&(d - a)) * ends.first().map_or(1.0, |&v| self.side(v));
        let loses = gain < -NO_VOLUME * self.h.powi(3);
        let all_moved = ends.iter().chain(&far).all(|&v| self.has_moved(v));
        if loses && (!all_moved || self.ground().is_crossed(c, d)) {
            return false;
        }
        let faces = [h, t].map(|h| self.mesh.face_of(h));
        !self.would_cross(&[[d, c, a], [c, d, b]], &faces)
    }

    /// Moves a vertex among others that moved towards their middle, along the surface, where its faces are thin.
    fn relax(&mut self, v: u32) {
        if !self.mesh.has_vertex(v) || !self.has_moved(v) || self.is_pinned(v) {
            return;
        }
        let p = self.point(v);
        if self.smallest_angle(v, p) >= SHARP || !self.mesh.neighbours(v).all(|w| self.has_moved(w)) {
            return;
        }
        let normal = self.normal(v);
        let (mut sum, mut count) = (Vector::zeros(), 0.0);
        for w in self.mesh.neighbours(v) {
            sum += self.point(w) - p;
            count += 1.0;
        }
        let along = sum / count;
        let along = (along - normal * along.dot(&normal)) * RELAXATION;
        let length2 = along.norm_squared();
        if length2 == 0.0 {
            return;
        }
        // The normal curvature on the way, from the neighbours: heights over squares of distances.
        let (mut over, mut under) = (0.0, 0.0);
        for w in self.mesh.neighbours(v) {
            let e = self.point(w) - p;
            let share = e.dot(&along).powi(2) / length2;
            over += e.dot(&normal) * share;
            under += e.norm_squared() * share;
        }
        let lift = if under > 0.0 { length2 * over / under } else { 0.0 };
        let d = along + normal * lift;
        let landing = if self.has_landed(v) {
            match self.landing(p + d, normal, self.vertices[v as usize].radius) {
                Some(landing) => Some(landing),
                None => return,
            }
        } else {
            None
        };
        let q = landing.map_or(p + d, |l| l.point);
        if self.smallest_angle(v, q) > self.smallest_angle(v, p) {
            match landing {
                Some(landing) => self.land(v, landing),
                None => _ = self.slide(v, d),
            }
            self.touch(v);
        }
    }

    /// Moves a vertex that has no place of its own to where the ball touches.
    fn land(&mut self, v: u32, landing: Landing) {
        if landing.gap.abs() < CAPTURE * self.h && self.slide(v, landing.point - self.point(v)) {
            self.mesh.points[v as usize] = landing.point;
            self.vertices[v as usize].approach = Approach::Landed(landing.normal);
        }
    }

    /// Moves a vertex that has no place of its own, where no face turns over and nothing of the input is met.
    fn slide(&mut self, v: u32, d: Vector) -> bool {
        let p = self.point(v);
        let q = p + d;
        let spokes: Vec<[Point; 2]> =
            self.mesh.spokes(v).map(|h| [self.point(self.mesh.target(h)), self.point(self.mesh.opposite(h))]).collect();
        let is_same = |[a, b]: &[Point; 2]| {
            let (old, new) = ((a - p).cross(&(b - p)), (a - q).cross(&(b - q)));
            // A new vertex on an edge has faces of any shape.
            new.dot(&old) > 0.8 * new.norm() * old.norm()
        };
        if !spokes.iter().all(is_same) {
            return false;
        }
        let ground: &Hierarchy = self.ground();
        if ground.is_crossed(p, q) || spokes.iter().any(|[a, _]| ground.is_crossed(q, *a)) || self.would_cross_at(v, q)
        {
            return false;
        }
        self.place(v, q);
        self.bind(v);
        self.come_nearer(v, d.norm());
        true
    }
}
