//! Coarse faces of the input cut where the ball cannot touch them, so that there are vertices to move.

use super::covering::{Covering, State};
use super::remesh;
use super::roll::Roll;
use crate::mesh::{Point, Vector};
use crate::threads;

/// Faces are looked into so often at most; each time, what was found is cut down to the edge length.
const LOOKS: usize = 64;

/// Edges longer than so many edge lengths are cut with the longest around first, lest slivers spread over the whole of a wide
/// face; shorter ones are cut all at once, which leaves the faces around as they are.
const WIDE: f64 = 8.0;

/// A hidden point nearer to a side of its face than this part of its height goes to that side.
const BESIDE_A_SIDE: f64 = 0.02;

impl Roll {
    /// Puts vertices where the ball cannot touch coarse faces, and cuts what is around them down to the edge length. They join
    /// those that may move.
    pub fn reveal(&mut self, covering: &mut Covering, moving: &mut Vec<u32>) {
        let mut is_hidden: Vec<bool> = vec![false; covering.state.len()];
        let at_coarse: Vec<u32> =
            moving.iter().copied().filter(|&v| covering.mesh.faces_at(v).any(|f| covering.is_coarse(f))).collect();
        self.look(covering, &at_coarse, &mut is_hidden);
        let mut fresh = at_coarse;
        // The corners of faces that were looked into in vain, or of what was left of them then.
        let mut is_clear: Vec<Option<[u32; 3]>> = Vec::new();
        for _ in 0..LOOKS {
            self.refine(covering, moving, &mut is_hidden, fresh);
            is_clear.resize(covering.mesh.face_count(), None);
            covering.clear.resize(covering.mesh.face_count(), None);
            let faces: Vec<u32> = covering
                .mesh
                .faces()
                .filter(|&f| covering.is_coarse(f) && !covering.mesh.face(f).iter().any(|&v| is_hidden[v as usize]))
                .filter(|&f| is_clear[f as usize] != Some(covering.mesh.face(f)))
                .collect();
            let looked_at: Vec<[u32; 3]> = faces.iter().map(|&f| covering.mesh.face(f)).collect();
            let found = threads::map(&faces, covering.threads, |&f| {
                covering.ground.hidden_between(covering.mesh.triangle(f), &|p| covering.radius(p), covering.edge)
            });
            fresh = Vec::new();
            for ((f, before), p) in faces.into_iter().zip(looked_at).zip(found) {
                let corners = covering.mesh.has_face(f).then(|| covering.mesh.face(f));
                let Some(p) = p else {
                    is_clear[f as usize] = corners;
                    covering.clear[f as usize] = corners.filter(|corners| *corners == before);
                    continue;
                };
                if let Some(w) = self.put(covering, f, p) {
                    moving.push(w);
                    fresh.push(w);
                }
            }
            if fresh.is_empty() {
                return;
            }
            is_hidden.resize(covering.state.len(), false);
            self.look(covering, &fresh, &mut is_hidden);
        }
    }

    /// Asks of some vertices whether the ball can touch them.
    fn look(&self, covering: &Covering, vertices: &[u32], is_hidden: &mut [bool]) {
        let found = threads::map(vertices, covering.threads, |&v| {
            let x = covering.point(v);
            covering.ground.is_hidden(x, self.normals[v as usize], covering.radius(x), covering.edge)
        });
        for (&v, found) in vertices.iter().zip(found) {
            is_hidden[v as usize] = found;
        }
    }

    /// Cuts the long edges of faces at hidden vertices, beginning with those of some vertices.
    fn refine(&mut self, covering: &mut Covering, moving: &mut Vec<u32>, is_hidden: &mut Vec<bool>, from: Vec<u32>) {
        let mut around = from;
        loop {
            let new = self.cut_long(covering, &around, |v| is_hidden[v as usize]);
            if new.is_empty() {
                return;
            }
            is_hidden.resize(covering.state.len(), false);
            self.look(covering, &new, is_hidden);
            moving.extend(&new);
            // Faces at old vertices have new sides, which are those of new vertices, too.
            let mut next: Vec<u32> = new.iter().flat_map(|&v| covering.mesh.neighbours(v).chain([v])).collect();
            next.sort_unstable();
            next.dedup();
            around = next;
        }
    }

    /// Cuts the edges longer than what is aimed at of faces at some vertices where both ends are the input's; the new
    /// vertices.
    pub fn cut_long(&mut self, covering: &mut Covering, around: &[u32], at: impl Fn(u32) -> bool) -> Vec<u32> {
        let mut faces: Vec<u32> = around.iter().filter(|&&v| at(v)).flat_map(|&v| covering.mesh.faces_at(v)).collect();
        faces.sort_unstable();
        faces.dedup();
        let mut new = Vec::new();
        for &f in &faces {
            while covering.is_coarse(f) {
                let Some(h) = longest_around(covering, f) else { break };
                let Some(w) = self.halve(covering, h) else { break };
                new.push(w);
            }
        }
        let mesh = &covering.mesh;
        let mut edges: Vec<u32> = around
            .iter()
            .filter(|&&v| at(v))
            .flat_map(|&v| mesh.faces_at(v))
            .flat_map(|f| mesh.half_edges(f))
            .map(|h| mesh.twin(h).map_or(h, |t| h.min(t)))
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let mut long: Vec<(f64, u32)> = edges
            .into_iter()
            .filter(|&h| covering.is_kept(mesh.origin(h)) && covering.is_kept(mesh.target(h)))
            .map(|h| (mesh.length(h), h))
            .filter(|(length, _)| *length > remesh::LONGEST * covering.edge)
            .collect();
        long.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        for (_, h) in long {
            new.extend(self.halve(covering, h));
        }
        new
    }

    /// Puts a vertex of the input into the middle of an edge. Very far from the origin there is nothing between.
    fn halve(&mut self, covering: &mut Covering, h: u32) -> Option<u32> {
        let (p, q) = (covering.point(covering.mesh.origin(h)), covering.point(covering.mesh.target(h)));
        let middle = nalgebra::center(&p, &q);
        (middle != p && middle != q).then(|| self.cut_edge(covering, h, middle))
    }

    /// Puts a vertex of the input on an edge.
    fn cut_edge(&mut self, covering: &mut Covering, h: u32, p: Point) -> u32 {
        let mesh = &covering.mesh;
        let faces = [Some(h), mesh.twin(h)].into_iter().flatten().map(|x| mesh.area_vector(mesh.face_of(x)));
        let normal: Vector = faces.filter_map(|n| n.try_normalize(0.0)).sum();
        let w = covering.split(h, p, State::Kept);
        self.normals.resize(covering.state.len(), Vector::zeros());
        self.normals[w as usize] = normal.try_normalize(0.0).unwrap_or_default();
        w
    }

    /// Puts a vertex of the input into a face, or on its side where it would be too near to that.
    fn put(&mut self, covering: &mut Covering, f: u32, p: Point) -> Option<u32> {
        let mesh = &covering.mesh;
        let normal = mesh.area_vector(f).try_normalize(0.0)?;
        let corners = mesh.face(f);
        for h in mesh.half_edges(f) {
            let (a, b, c) = (
                mesh.points[mesh.origin(h) as usize],
                mesh.points[mesh.target(h) as usize],
                mesh.points[mesh.opposite(h) as usize],
            );
            let along = (b - a).try_normalize(0.0)?;
            let inward = normal.cross(&along);
            if inward.dot(&(p - a)) < BESIDE_A_SIDE * inward.dot(&(c - a)) {
                let t = along.dot(&(p - a)).clamp(0.25 * (b - a).norm(), 0.75 * (b - a).norm());
                return Some(self.cut_edge(covering, h, a + along * t));
            }
        }
        let w = covering.put_in_face(f, corners, p)?;
        self.normals.resize(covering.state.len(), Vector::zeros());
        self.normals[w as usize] = normal;
        Some(w)
    }
}

/// The edge of the input that is to be cut first so that a face gets smaller: the longest of the face, or that of the face
/// beside it, if that is longer, and so on (Rivara, longest-edge propagation path). Faces stay as they are in shape, and grow
/// with the way from what is cut.
fn longest_around(covering: &Covering, f: u32) -> Option<u32> {
    let mesh = &covering.mesh;
    let may_be_cut = |h: &u32| covering.is_kept(mesh.origin(*h)) && covering.is_kept(mesh.target(*h));
    let longest = |f: u32| {
        let edges = mesh.half_edges(f).into_iter().filter(may_be_cut);
        edges.map(|h| (mesh.length(h), h)).max_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
    };
    let (mut length, mut h) = longest(f)?;
    if length <= WIDE * covering.edge {
        return None;
    }
    while let Some((longer, next)) = mesh.twin(h).and_then(|t| longest(mesh.face_of(t))) {
        if longer <= length {
            break;
        }
        (length, h) = (longer, next);
    }
    Some(h)
}
