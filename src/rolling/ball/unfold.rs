//! Faces that turn their backs on a neighbour, turned back: where a fillet begins on a coarse face slivers lie on each other.

use std::collections::BTreeMap;

use super::covering::{Covering, State, area_vector, quality};
use super::remesh::{LONGEST, SHORTEST};
use crate::mesh::{Point, Vector};

/// Two faces whose normals agree by less than this cosine lie on each other, or form the edge of a thin sheet.
const TURNED: f64 = -0.1;

/// A face agrees with its balls by this cosine, or as much as those did that it takes the place of.
const AGREES: f64 = 0.5;

/// Faces whose normals agree up to this lie in one plane.
const FLAT: f64 = 1e-12;

/// Parts of the way to the middle of its neighbours that a vertex is moved.
const PARTS: [f64; 2] = [0.5, 1.0];

/// All edges are looked at so often at most.
const TURNS: usize = 4;

/// A change to the triangles around an edge.
#[derive(Clone, Copy)]
enum Change {
    /// The edge between two faces becomes that of the other two corners.
    Flip(u32),
    /// The vertex at the start of a half-edge goes to its end.
    Collapse(u32),
}

/// What a change leads to.
struct Outcome {
    /// How many edges fewer are turned.
    gain: i64,
    /// The worst quality of the faces before and after it.
    before: f64,
    after: f64,
}

impl Covering<'_> {
    /// Flips and collapses edges where faces turn their backs on each other, as long as that leaves fewer of them.
    pub fn unfold(&mut self) {
        self.changes.mark_all();
        self.thin_out();
        for _ in 0..TURNS {
            let mut any = false;
            for h in self.turned() {
                any |= self.unfold_at(h);
            }
            if !any {
                return;
            }
        }
    }

    /// Takes away vertices that were put into flat parts of the input nearer to others than an edge should be long.
    fn thin_out(&mut self) {
        let mut edges = self.active_edges();
        edges.retain(|(length, _)| *length < SHORTEST * self.edge);
        edges.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (_, h) in edges {
            if !self.is_there(h) || self.mesh.length(h) >= SHORTEST * self.edge {
                continue;
            }
            for h in [Some(h), self.mesh.twin(h)].into_iter().flatten() {
                let is_kept = self.is_kept(self.mesh.origin(h));
                if is_kept
                    && self
                        .outcome(Change::Collapse(h))
                        .is_some_and(|outcome| outcome.gain >= 0 && outcome.after > outcome.before)
                {
                    self.make(Change::Collapse(h));
                    break;
                }
            }
        }
    }

    /// The edges at faces that changed where two faces turn their backs on each other.
    fn turned(&self) -> Vec<u32> {
        let faces = self.mesh.faces().filter(|&f| self.is_touched(f));
        let mut edges: Vec<u32> = faces
            .flat_map(|f| self.mesh.half_edges(f))
            .filter_map(|h| Some(h.min(self.mesh.twin(h)?)))
            .filter(|&h| self.is_turned(h))
            .collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    fn is_turned(&self, h: u32) -> bool {
        let normal = |h: u32| self.mesh.area_vector(self.mesh.face_of(h));
        self.mesh.twin(h).is_some_and(|t| are_turned(&normal(h), &normal(t)))
    }

    /// Makes the best of the changes around an edge, if any helps.
    fn unfold_at(&mut self, h: u32) -> bool {
        let Some(t) = self.mesh.twin(h).filter(|_| self.is_there(h) && self.is_turned(h)) else { return false };
        let mut best: Option<(Outcome, Change)> = None;
        for side in [h, t].into_iter().flat_map(|h| self.mesh.half_edges(self.mesh.face_of(h))) {
            let other = self.mesh.twin(side).map(Change::Collapse);
            for change in [Some(Change::Flip(side)), Some(Change::Collapse(side)), other].into_iter().flatten() {
                let is_better = |a: &Outcome, b: &Outcome| a.gain > b.gain || a.gain == b.gain && a.after > b.after;
                if let Some(outcome) = self.outcome(change).filter(|outcome| outcome.gain > 0)
                    && best.as_ref().is_none_or(|(least, _)| is_better(&outcome, least))
                {
                    best = Some((outcome, change));
                }
            }
        }
        if let Some((_, change)) = best {
            self.make(change);
            return true;
        }
        let corners = [h, t].map(|h| self.mesh.face(self.mesh.face_of(h)));
        corners.concat().into_iter().any(|v| self.unfold_by_moving(v))
    }

    fn make(&mut self, change: Change) {
        match change {
            Change::Flip(h) => {
                let twin = self.mesh.twin(h);
                self.mesh.flip(h);
                for x in [Some(h), twin].into_iter().flatten() {
                    self.touch(self.mesh.face_of(x));
                }
            }
            Change::Collapse(h) => {
                let (a, b) = (self.mesh.origin(h), self.mesh.target(h));
                self.mesh.collapse(h);
                self.state[a as usize] = State::Kept;
                for f in self.mesh.faces_at(b).collect::<Vec<_>>() {
                    self.touch(f);
                }
            }
        }
    }

    /// Moves a vertex of the closing towards the middle of its neighbours, if that helps.
    fn unfold_by_moving(&mut self, v: u32) -> bool {
        let Some(&rest) = self.rest(v) else { return false };
        let (x, before) = (self.point(v), self.state[v as usize]);
        let faces: Vec<u32> = self.mesh.faces_at(v).collect();
        let outside = self.outside(&faces);
        let corners: Vec<[u32; 3]> = faces.iter().map(|&f| self.mesh.face(f)).collect();
        let (was, agreement) = (self.turned_among(&corners, &outside), self.fan(v).1);
        let around: Vec<_> = self.mesh.neighbours(v).map(|w| self.point(w).coords).collect();
        let middle = Point::from(around.iter().sum::<Vector>() / around.len() as f64);
        for part in PARTS {
            let Some((p, found)) = self.reroll(x + part * (middle - x), &rest) else { continue };
            self.mesh.points[v as usize] = p;
            self.state[v as usize] = State::Moved(found);
            if self.turned_among(&corners, &outside) < was
                && self.fan(v).1 >= agreement.min(AGREES)
                && !faces.iter().any(|&f| self.dips(self.mesh.triangle(f)))
            {
                return true;
            }
            self.mesh.points[v as usize] = x;
            self.state[v as usize] = before;
        }
        false
    }

    /// The normals of the faces outside of some faces, by the half-edges inside.
    fn outside(&self, faces: &[u32]) -> BTreeMap<(u32, u32), Vector> {
        let mut outside = BTreeMap::new();
        for h in faces.iter().flat_map(|&f| self.mesh.half_edges(f)) {
            if let Some(t) = self.mesh.twin(h).filter(|&t| !faces.contains(&self.mesh.face_of(t))) {
                outside.insert((self.mesh.origin(h), self.mesh.target(h)), self.mesh.area_vector(self.mesh.face_of(t)));
            }
        }
        outside
    }

    /// What a change leads to, if it may be made.
    fn outcome(&self, change: Change) -> Option<Outcome> {
        let (faces, after) = self.faces_of(change)?;
        let before: Vec<[u32; 3]> = faces.iter().map(|&f| self.mesh.face(f)).collect();
        let outside = self.outside(&faces);
        let at = |corners: [u32; 3]| corners.map(|v| self.point(v));
        let least = |faces: &[[u32; 3]], of: &dyn Fn([u32; 3]) -> f64| faces.iter().map(|&f| of(f)).fold(1.0, f64::min);
        let agreement = |faces: &[[u32; 3]]| least(faces, &|f| self.agreement(f, &area_vector(at(f))));
        let shape = |faces: &[[u32; 3]]| least(faces, &|f| quality(at(f)));
        let longest = |faces: &[[u32; 3]]| {
            let sides = faces.iter().flat_map(|&f| [0, 1, 2].map(|k| self.point(f[k]) - self.point(f[(k + 1) % 3])));
            sides.map(|side| side.norm()).fold(0.0, f64::max)
        };
        let is_allowed = agreement(&after) >= agreement(&before).min(AGREES)
            && longest(&after) <= longest(&before).max(LONGEST * self.edge)
            && !after.iter().any(|&f| self.dips(at(f)));
        let turned = |faces: &[[u32; 3]]| self.turned_among(faces, &outside) as i64;
        is_allowed.then(|| Outcome {
            gain: turned(&before) - turned(&after),
            before: shape(&before),
            after: shape(&after),
        })
    }

    /// The faces that a change takes away and the corners of those that it makes, if it may be made.
    fn faces_of(&self, change: Change) -> Option<(Vec<u32>, Vec<[u32; 3]>)> {
        match change {
            Change::Flip(h) => {
                let t = self.mesh.twin(h)?;
                let (a, b, c, d) =
                    (self.mesh.origin(h), self.mesh.target(h), self.mesh.opposite(h), self.mesh.opposite(t));
                let is_inputs = self.is_kept(a) && self.is_kept(b) && !self.is_filled(h);
                let may = !is_inputs && self.mesh.can_flip(h);
                may.then(|| (vec![self.mesh.face_of(h), self.mesh.face_of(t)], vec![[d, c, a], [c, d, b]]))
            }
            Change::Collapse(h) => {
                let (a, b) = (self.mesh.origin(h), self.mesh.target(h));
                if !self.mesh.can_collapse(h) {
                    return None;
                }
                let faces: Vec<u32> = self.mesh.faces_at(a).collect();
                let stay = faces.iter().map(|&f| self.mesh.face(f)).filter(|corners| !corners.contains(&b));
                let after: Vec<_> = stay.map(|corners| corners.map(|v| if v == a { b } else { v })).collect();
                let may = !self.is_kept(a) || self.stays_flat(a, &faces, &after);
                may.then_some((faces, after))
            }
        }
    }

    /// Whether a vertex was put into a flat part of the input, and that is as flat without it.
    fn stays_flat(&self, a: u32, before: &[u32], after: &[[u32; 3]]) -> bool {
        let is_inputs = |corners: &[u32; 3]| corners.iter().all(|&v| self.is_kept(v));
        let normals = |faces: &mut dyn Iterator<Item = [u32; 3]>| -> Vec<Option<Vector>> {
            let inputs = faces.filter(is_inputs);
            inputs.map(|corners| area_vector(corners.map(|v| self.point(v))).try_normalize(0.0)).collect()
        };
        let is_new = (a as usize) >= self.ground.mesh.points.len();
        let mut all = normals(&mut before.iter().map(|&f| self.mesh.face(f)));
        all.extend(normals(&mut after.iter().copied()));
        let Some(&Some(first)) = all.first() else { return false };
        is_new && all.iter().all(|n| n.is_some_and(|n| n.dot(&first) > 1.0 - FLAT))
    }

    /// At how many edges of some triangles two faces are turned, with the normals of the faces outside.
    fn turned_among(&self, faces: &[[u32; 3]], outside: &BTreeMap<(u32, u32), Vector>) -> usize {
        let mut beside: BTreeMap<(u32, u32), Vector> = BTreeMap::new();
        let mut turned = 0;
        for &corners in faces {
            let normal = area_vector(corners.map(|v| self.point(v)));
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                let other = outside.get(&(a, b)).or(beside.get(&(b, a)));
                turned += usize::from(other.is_some_and(|other| are_turned(&normal, other)));
                beside.insert((a, b), normal);
            }
        }
        turned
    }

    /// Whether a half-edge is still one.
    fn is_there(&self, h: u32) -> bool {
        self.mesh.origin(h) != crate::mesh::NONE
    }
}

fn are_turned(m: &Vector, n: &Vector) -> bool {
    m.dot(n) < TURNED * m.norm() * n.norm()
}
