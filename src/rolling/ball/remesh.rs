//! Triangles of one size and good shape where the surface moved, on the closing itself: every vertex that is put in or moved
//! is where a ball at rest touches.

use super::changes::Refused;
use super::contact::{Rest, UNTOUCHED};
use super::covering::{Covering, State, area_vector, quality};
use crate::mesh::{NONE, Point, Vector};
use crate::threads;

/// Edges shorter and longer than so many edge lengths are merged and split.
pub(super) const SHORTEST: f64 = 0.4;
pub(super) const LONGEST: f64 = 1.5;

/// A split is worth it where both halves are within these parts of the edge.
const HALVES: [f64; 2] = [0.2, 0.95];

/// Triangles of a quality below this are bad.
const BAD: f64 = 0.2;

/// Faces and balls that agree by less than this cosine do not agree.
const DISAGREES: f64 = 0.5;

/// Parts of a face that is cut may agree this little with their balls, or as little as the whole does.
const TURNS: f64 = 0.2;

/// The same for edges longer than [`LONG`] edge lengths in a bold try: they may fold, to unfold when they are split on.
const BOLD_TURNS: f64 = -0.5;
const LONG: f64 = 2.0;

/// Vertices of triangles that are worse than this, or agree less with their balls, are relaxed.
const RELAXED: f64 = 0.6;

impl Covering<'_> {
    /// So many rounds of merging, splitting, turning and relaxing.
    pub fn remesh(&mut self, rounds: usize) {
        for _ in 0..rounds {
            self.merge_short();
            self.split_long();
            self.sharpen();
            for _ in 0..3 {
                if !self.turn_edges() {
                    break;
                }
            }
            self.relax();
        }
    }

    fn merge_short(&mut self) {
        let mut edges = self.active_edges();
        edges.retain(|(length, _)| *length < SHORTEST * self.edge);
        edges.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (_, h) in edges {
            if self.mesh.origin(h) == NONE || self.mesh.length(h) >= SHORTEST * self.edge {
                continue;
            }
            let (a, b) = (self.mesh.origin(h), self.mesh.target(h));
            let around = self.mesh.neighbours(a).chain(self.mesh.neighbours(b));
            if self.refusals.merge.at(h).is_some_and(|time| self.changes.none_since(time, around)) {
                continue;
            }
            let both = [self.mesh.twin(h), Some(h)];
            let Some(h) = both.into_iter().flatten().find(|&h| self.may_merge(h)) else {
                self.refusals.merge.mark(h, self.changes.now());
                continue;
            };
            let (a, b) = (self.mesh.origin(h), self.mesh.target(h));
            let far: Vec<u32> = self.mesh.neighbours(a).collect();
            self.mesh.collapse(h);
            self.state[a as usize] = State::Kept;
            for f in self.mesh.faces_at(b).collect::<Vec<_>>() {
                self.touch(f);
            }
            far.into_iter().chain([a, b]).for_each(|v| self.changes.mark(v));
        }
    }

    /// Whether the vertex at the start of `h` may go into the one at its end.
    fn may_merge(&self, h: u32) -> bool {
        let (a, b) = (self.mesh.origin(h), self.mesh.target(h));
        let is_ridge = |v: u32| matches!(self.state[v as usize], State::Ridge(..));
        if self.is_kept(a) || (is_ridge(a) && !is_ridge(b)) || !self.mesh.can_collapse(h) {
            return false;
        }
        let target = self.point(b);
        self.mesh.faces_at(a).all(|f| {
            let corners = self.mesh.face(f);
            if corners.contains(&b) {
                return true;
            }
            let before = self.mesh.triangle(f);
            let moved = corners.map(|v| if v == a { b } else { v });
            let after = moved.map(|v| self.point(v));
            let (n0, n1) = (area_vector(before), area_vector(after));
            let (s0, s1) = (self.agreement(corners, &n0), self.agreement(moved, &n1));
            let (q0, q1) = (quality(before), quality(after));
            let folds = n0.dot(&n1) < 0.7 * n0.norm() * n1.norm() && s0 > 0.3;
            let reaches = |v: u32| {
                let length = (self.point(v) - target).norm();
                length > LONGEST * self.edge && length > (self.point(v) - self.point(a)).norm()
            };
            let is_worse = (q1 < BAD && q1 < q0) || (s1 < DISAGREES && s1 < s0);
            !is_worse && !folds && !corners.iter().any(|&v| v != a && reaches(v)) && !self.dips(after)
        })
    }

    fn split_long(&mut self) {
        let mut edges = self.active_edges();
        edges.retain(|(length, _)| *length > LONGEST * self.edge);
        edges.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let middles = self.foreseen(&edges, |covering, &(_, h)| {
            let is_refused = covering.bold.is_none() && covering.is_refused(&covering.refusals.split, h);
            if is_refused { None } else { covering.middle(h) }
        });
        let start = self.changes.now();
        for (&(_, h), middle) in edges.iter().zip(middles) {
            let is_as_foreseen = self.changes.none_since(start, self.quad(h));
            let middle = if is_as_foreseen { middle } else { self.middle(h) };
            if let Some((p, state)) = middle.filter(|(p, state)| self.may_split(h, *p, state)) {
                self.split(h, p, state);
            } else {
                self.refusals.split.mark(h, self.changes.now());
            }
        }
    }

    /// `f` of every item, as things are now.
    fn foreseen<T: Sync, R: Send>(&self, items: &[T], f: impl Fn(&Self, &T) -> R + Sync) -> Vec<R> {
        threads::map(items, self.threads, |item| f(self, item))
    }

    /// The ends of an edge and the corners opposite.
    fn quad(&self, h: u32) -> [u32; 4] {
        let far = self.mesh.opposite(self.mesh.twin(h).unwrap_or(h));
        [self.mesh.origin(h), self.mesh.target(h), self.mesh.opposite(h), far]
    }

    /// Whether what was refused of an edge is as it was, with the faces beside it.
    fn is_refused(&self, refused: &Refused, h: u32) -> bool {
        refused.at(h).is_some_and(|time| self.changes.none_since(time, self.quad(h)))
    }

    /// Whether the faces at an edge stay as they should be when it is cut at a point: none of their parts turns its back on a
    /// ball more than they do.
    pub fn may_split(&self, h: u32, p: Point, state: &State) -> bool {
        let new = |unit: &Vector| match state {
            State::Moved(a) => a.normal.dot(unit),
            State::Ridge(a, b) => a.normal.dot(unit).max(b.normal.dot(unit)),
            _ => 1.0,
        };
        let is_bold = self.bold.is_some_and(|most| self.state.len() < most) && self.mesh.length(h) > LONG * self.edge;
        let turns = if is_bold { BOLD_TURNS } else { TURNS };
        [Some(h), self.mesh.twin(h)].into_iter().flatten().all(|h| {
            let (a, b, c) = (self.mesh.origin(h), self.mesh.target(h), self.mesh.opposite(h));
            let before = self.agreement([a, b, c], &area_vector([a, b, c].map(|v| self.point(v))));
            let part = |u: u32, v: u32, triangle: [Point; 3]| {
                let unit = area_vector(triangle).try_normalize(0.0);
                unit.map_or(-1.0, |unit| self.agrees(u, &unit).min(self.agrees(v, &unit)).min(new(&unit)))
            };
            let (x, y, z) = (self.point(a), self.point(b), self.point(c));
            part(a, c, [x, p, z]).min(part(b, c, [p, y, z])) >= before.min(turns)
        })
    }

    /// Where the ball touches that comes to the middle of an edge, if that is well between its ends.
    fn middle(&self, h: u32) -> Option<(Point, State)> {
        let (a, b) = (self.mesh.origin(h), self.mesh.target(h));
        let (p, q) = (self.point(a), self.point(b));
        if let (State::Ridge(s, other), State::Ridge(t, _)) = (&self.state[a as usize], &self.state[b as usize])
            && (s.center - t.center).norm() < self.edge + s.radius
            && let Some((x, s, t)) = self.ridge(nalgebra::center(&p, &q), s, other)
            && (x - p).norm().max((x - q).norm()) < HALVES[1] * (q - p).norm()
        {
            return Some((x, State::Ridge(s, t)));
        }
        let mut from = match self.rest(a).or(self.rest(b)) {
            Some(rest) => *rest,
            None if self.is_filled(h) => {
                let faces = [Some(h), self.mesh.twin(h)].into_iter().flatten();
                let sum: Vector = faces.map(|x| self.mesh.area_vector(self.mesh.face_of(x))).sum();
                let (normal, radius) = (sum.try_normalize(0.0)?, self.radius(p));
                let center = nalgebra::center(&p, &q) + normal * radius;
                Rest { center, radius, normal, contacts: UNTOUCHED }
            }
            None => return None,
        };
        if let (Some(s), Some(t)) = (self.rest(a), self.rest(b)) {
            from.center = nalgebra::center(&s.center, &t.center);
            from.contacts = UNTOUCHED;
        }
        let x = nalgebra::center(&p, &q);
        let rest = self.ground.rest(x, from.center, self.radius(x), from.contacts)?;
        let found = rest.point();
        let length = (q - p).norm();
        let parts = [(found - p).norm() / length, (found - q).norm() / length];
        parts.iter().all(|part| (HALVES[0]..HALVES[1]).contains(part)).then_some((found, State::Moved(rest)))
    }

    /// Turns edges where that makes better triangles; whether any did.
    fn turn_edges(&mut self) -> bool {
        let mut any = false;
        let edges = self.edges();
        let may_turn = self
            .foreseen(&edges, |covering, &h| !covering.is_refused(&covering.refusals.turn, h) && covering.may_turn(h));
        let start = self.changes.now();
        for (&h, may_turn) in edges.iter().zip(may_turn) {
            let is_as_foreseen = self.changes.none_since(start, self.quad(h));
            if !if is_as_foreseen { may_turn } else { self.may_turn(h) } {
                self.refusals.turn.mark(h, self.changes.now());
                continue;
            }
            let t = self.mesh.twin(h);
            self.mesh.flip(h);
            for x in [Some(h), t].into_iter().flatten() {
                self.touch(self.mesh.face_of(x));
                self.changes.mark(self.mesh.origin(x));
                self.changes.mark(self.mesh.opposite(x));
            }
            any = true;
        }
        any
    }

    fn may_turn(&self, h: u32) -> bool {
        let Some(t) = self.mesh.twin(h) else { return false };
        let (a, b, c, d) = (self.mesh.origin(h), self.mesh.target(h), self.mesh.opposite(h), self.mesh.opposite(t));
        if self.is_kept(a) && self.is_kept(b) && !self.is_filled(h) {
            return false;
        }
        let at = |corners: [u32; 3]| corners.map(|v| self.point(v));
        let is_ridge = |v: u32| matches!(self.state[v as usize], State::Ridge(..));
        if is_ridge(a) && is_ridge(b) && self.crosses_ridge(c, d) {
            return false;
        }
        let (before, after) = ([[a, b, c], [b, a, d]], [[d, c, a], [c, d, b]]);
        let least = |faces: [[u32; 3]; 2], of: &dyn Fn([u32; 3]) -> f64| of(faces[0]).min(of(faces[1]));
        let shape = |f: [u32; 3]| quality(at(f));
        let agreement = |f: [u32; 3]| self.agreement(f, &area_vector(at(f)));
        let (q0, q1) = (least(before, &shape), least(after, &shape));
        let uncrosses = is_ridge(c) && is_ridge(d) && !is_ridge(a) && !is_ridge(b) && self.crosses_ridge(a, b);
        if if uncrosses { q1 < 0.02 } else { q1 < 1.05 * q0 + 0.01 } {
            return false;
        }
        let (s0, s1) = (least(before, &agreement), least(after, &agreement));
        if s1 < 0.2 || (s1 < s0 - 0.02 && s1 < 0.8) {
            return false;
        }
        // What is flat stays flat: the two faces turn no more than the ball does over three edges.
        let flat = (3.0 * self.edge / self.radius(self.point(a))).min(1.0).cos();
        let bend = |faces: [[u32; 3]; 2]| {
            let [m, n] = faces.map(|f| area_vector(at(f)));
            m.dot(&n) / (m.norm() * n.norm())
        };
        if !uncrosses && s0 > 0.2 && (bend(before) < flat || bend(after) < flat) {
            return false;
        }
        self.mesh.can_flip(h) && !self.dips(at(after[0])) && !self.dips(at(after[1]))
    }

    /// Moves vertices of bad triangles to the middle of their faces, along the closing.
    fn relax(&mut self) {
        let mut bad: Vec<u32> = Vec::new();
        for f in self.active_faces() {
            let (corners, triangle) = (self.mesh.face(f), self.mesh.triangle(f));
            if quality(triangle) < RELAXED || self.agreement(corners, &area_vector(triangle)) < RELAXED {
                bad.extend(corners.iter().filter(|&&v| self.rest(v).is_some()));
            }
        }
        bad.sort_unstable();
        bad.dedup();
        let proposals = self.foreseen(&bad, |covering, &v| {
            let time = covering.refusals.relax.at(v);
            let is_refused = time.is_some_and(|time| covering.is_quiet(v, time));
            if is_refused { None } else { covering.relaxed(v) }
        });
        let start = self.changes.now();
        for (v, proposal) in bad.into_iter().zip(proposals) {
            let proposal = if self.is_quiet(v, start) { proposal } else { self.relaxed(v) };
            if !proposal.is_some_and(|(p, state)| self.relax_one(v, p, state)) {
                self.refusals.relax.mark(v, self.changes.now());
            }
        }
    }

    /// Whether a vertex and its neighbours are as they were.
    fn is_quiet(&self, v: u32, since: u64) -> bool {
        self.changes.none_since(since, self.mesh.neighbours(v).chain([v]))
    }

    /// Where a vertex would go that is moved to the middle of its faces.
    fn relaxed(&self, v: u32) -> Option<(Point, State)> {
        let rest = self.rest(v)?;
        let x = self.point(v);
        let (mut middle, mut weight) = (nalgebra::Vector3::zeros(), 0.0);
        for f in self.mesh.faces_at(v) {
            let [a, b, c] = self.mesh.triangle(f);
            let area = area_vector([a, b, c]).norm();
            middle += (a.coords + b.coords + c.coords) * (area / 3.0);
            weight += area;
        }
        if weight <= 0.0 {
            return None;
        }
        let (_, s0) = self.fan(v);
        let towards = middle / weight - x.coords;
        let along = if s0 < 0.2 { towards } else { towards - rest.normal * towards.dot(&rest.normal) };
        if let State::Ridge(a, b) = &self.state[v as usize] {
            let (p, a, b) = self.ridge(x + towards, a, b)?;
            Some((p, State::Ridge(a, b)))
        } else {
            let (p, found) = self.reroll(x + along, rest)?;
            Some((p, State::Moved(found)))
        }
    }

    /// Moves a vertex if that makes its faces better. Whether it does.
    fn relax_one(&mut self, v: u32, p: Point, state: State) -> bool {
        let (x, before) = (self.point(v), self.state[v as usize]);
        let (q0, s0) = self.fan(v);
        self.mesh.points[v as usize] = p;
        self.state[v as usize] = state;
        let (q1, s1) = self.fan(v);
        let is_better = (s0 < 0.2 && s1 > s0) || (s1 >= s0.min(RELAXED) - 0.01 && q1 > q0);
        if !is_better || self.mesh.faces_at(v).any(|f| self.dips(self.mesh.triangle(f))) {
            self.mesh.points[v as usize] = x;
            self.state[v as usize] = before;
            return false;
        }
        self.changes.mark(v);
        true
    }

    /// The worst quality and agreement of the faces at a vertex.
    pub fn fan(&self, v: u32) -> (f64, f64) {
        self.mesh.faces_at(v).fold((1.0, 1.0), |(q, s), f| {
            let triangle = self.mesh.triangle(f);
            let agreement = self.agreement(self.mesh.face(f), &area_vector(triangle));
            (f64::min(q, quality(triangle)), f64::min(s, agreement))
        })
    }
}
