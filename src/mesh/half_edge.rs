//! Triangles that know their neighbours, and can be cut, merged and turned one by one.
//!
//! Half-edge 3 f + k runs from corner k of face f to the next one. Faces and vertices keep their numbers for ever: what goes
//! is marked, what comes is appended, so that a face nobody touched is the face of the file.

use super::{Point, Vector};

/// No half-edge, no vertex.
pub const NONE: u32 = u32::MAX;

/// Why triangles make no surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotManifold {
    /// More than two faces, or two of opposite orientation, meet at the edge between these vertices.
    #[error(
        "the edge between vertices {0} and {1} belongs to more than two faces, or to two that are oriented against each other"
    )]
    Edge(u32, u32),
    /// The faces at this vertex are no single fan.
    #[error("the faces at vertex {0} do not form a single fan")]
    Vertex(u32),
    /// This face has a corner twice, or one that does not exist.
    #[error("face {0} has a corner twice or one that does not exist")]
    Face(u32),
}

/// A surface of triangles with their neighbours.
#[derive(Clone, Debug, Default)]
pub struct HalfEdgeMesh {
    /// The vertices, also those that are gone.
    pub points: Vec<Point>,
    /// Where each half-edge starts; [`NONE`] in faces that are gone.
    origin: Vec<u32>,
    /// The half-edge that runs the other way in the neighbour; [`NONE`] at a boundary.
    twin: Vec<u32>,
    /// A half-edge that leaves each vertex, on a boundary the one without a twin; [`NONE`] where no face is left.
    outgoing: Vec<u32>,
}

/// The half-edge after `h` in its face.
fn after(h: u32) -> u32 {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

/// The half-edge before `h` in its face.
fn before(h: u32) -> u32 {
    if h.is_multiple_of(3) { h + 2 } else { h - 1 }
}

impl HalfEdgeMesh {
    /// The surface of `faces`.
    ///
    /// # Errors
    /// Names an edge or a vertex at which they make no surface.
    pub fn new(points: Vec<Point>, faces: &[[u32; 3]]) -> Result<HalfEdgeMesh, NotManifold> {
        let origin: Vec<u32> = faces.as_flattened().to_vec();
        for (f, &[a, b, c]) in faces.iter().enumerate() {
            let exists = [a, b, c].iter().all(|&v| (v as usize) < points.len());
            if !exists || a == b || b == c || c == a {
                return Err(NotManifold::Face(f as u32));
            }
        }
        let mut edges: Vec<(u64, u32)> = (0..origin.len() as u32)
            .map(|h| {
                let (a, b) = (origin[h as usize], origin[after(h) as usize]);
                (u64::from(a.min(b)) << 32 | u64::from(a.max(b)), h)
            })
            .collect();
        edges.sort_unstable();
        let mut twin = vec![NONE; origin.len()];
        for same in edges.chunk_by(|a, b| a.0 == b.0) {
            match *same {
                [_] => {}
                [(_, g), (_, h)] if origin[g as usize] != origin[h as usize] => {
                    (twin[g as usize], twin[h as usize]) = (h, g);
                }
                _ => {
                    let h = same[0].1;
                    return Err(NotManifold::Edge(origin[h as usize], origin[after(h) as usize]));
                }
            }
        }
        let mut outgoing = vec![NONE; points.len()];
        let mut spokes = vec![0u32; points.len()];
        for (h, &v) in origin.iter().enumerate() {
            spokes[v as usize] += 1;
            if outgoing[v as usize] == NONE || twin[h] == NONE {
                outgoing[v as usize] = h as u32;
            }
        }
        let mesh = HalfEdgeMesh { points, origin, twin, outgoing };
        let is_fan = |v: u32| mesh.spokes(v).count() == spokes[v as usize] as usize;
        match (0..mesh.points.len() as u32).find(|&v| !is_fan(v)) {
            Some(v) => Err(NotManifold::Vertex(v)),
            None => Ok(mesh),
        }
    }

    /// How many faces there are, those that are gone included.
    pub fn face_count(&self) -> usize {
        self.origin.len() / 3
    }

    /// Whether face `f` is still there.
    pub fn has_face(&self, f: u32) -> bool {
        self.origin[3 * f as usize] != NONE
    }

    /// Whether some face is at vertex `v`.
    pub fn has_vertex(&self, v: u32) -> bool {
        self.outgoing[v as usize] != NONE
    }

    /// The corners of a face.
    pub fn face(&self, f: u32) -> [u32; 3] {
        [0, 1, 2].map(|k| self.origin[3 * f as usize + k])
    }

    /// The faces that are there.
    pub fn faces(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.face_count() as u32).filter(|&f| self.has_face(f))
    }

    /// The places of the corners of a face.
    pub fn triangle(&self, f: u32) -> [Point; 3] {
        self.face(f).map(|v| self.points[v as usize])
    }

    /// Twice the area of a face, as a vector that points outward.
    pub fn area_vector(&self, f: u32) -> Vector {
        let [a, b, c] = self.triangle(f);
        (b - a).cross(&(c - a))
    }

    /// The half-edges of a face.
    pub fn half_edges(&self, f: u32) -> [u32; 3] {
        [3 * f, 3 * f + 1, 3 * f + 2]
    }

    /// The face of a half-edge.
    pub fn face_of(&self, h: u32) -> u32 {
        h / 3
    }

    /// Where a half-edge starts.
    pub fn origin(&self, h: u32) -> u32 {
        self.origin[h as usize]
    }

    /// Where a half-edge ends.
    pub fn target(&self, h: u32) -> u32 {
        self.origin[after(h) as usize]
    }

    /// The corner opposite to a half-edge.
    pub fn opposite(&self, h: u32) -> u32 {
        self.origin[before(h) as usize]
    }

    /// The half-edge that runs the other way; `None` at a boundary.
    pub fn twin(&self, h: u32) -> Option<u32> {
        Some(self.twin[h as usize]).filter(|&t| t != NONE)
    }

    /// The length of an edge.
    pub fn length(&self, h: u32) -> f64 {
        (self.points[self.target(h) as usize] - self.points[self.origin(h) as usize]).norm()
    }

    /// Whether half-edge `h` is the one of its edge that stands for it: each edge once.
    pub fn is_edge(&self, h: u32) -> bool {
        self.origin[h as usize] != NONE && (self.twin[h as usize] == NONE || h < self.twin[h as usize])
    }

    /// The half-edges that leave `v`, counterclockwise; on a boundary from the one along it.
    pub fn spokes(&self, v: u32) -> impl Iterator<Item = u32> + '_ {
        let first = self.outgoing[v as usize];
        let next = move |&h: &u32| Some(self.twin[before(h) as usize]).filter(|&s| s != NONE && s != first);
        std::iter::successors(Some(first).filter(|&h| h != NONE), next)
    }

    /// The neighbours of `v`, counterclockwise.
    pub fn neighbours(&self, v: u32) -> impl Iterator<Item = u32> + '_ {
        // Along a boundary the last face has one that no half-edge from here leads to.
        let last = self.spokes(v).last().map(before).filter(|&h| self.twin[h as usize] == NONE);
        self.spokes(v).map(|h| self.target(h)).chain(last.map(|h| self.origin(h)))
    }

    /// The faces at `v`.
    pub fn faces_at(&self, v: u32) -> impl Iterator<Item = u32> + '_ {
        self.spokes(v).map(|h| h / 3)
    }

    /// Whether `v` lies on a boundary.
    pub fn is_boundary(&self, v: u32) -> bool {
        let h = self.outgoing[v as usize];
        h != NONE && self.twin[h as usize] == NONE
    }

    /// The half-edge from `a` to `b`, where there is one.
    pub fn half_edge(&self, a: u32, b: u32) -> Option<u32> {
        self.spokes(a).find(|&h| self.target(h) == b)
    }

    /// A new vertex without faces.
    pub fn add_vertex(&mut self, p: Point) -> u32 {
        self.points.push(p);
        self.outgoing.push(NONE);
        self.points.len() as u32 - 1
    }

    fn add_face(&mut self, corners: [u32; 3]) -> u32 {
        self.origin.extend(corners);
        self.twin.extend([NONE; 3]);
        self.origin.len() as u32 - 3
    }

    /// Makes two half-edges twins; one of them may be none.
    fn pair(&mut self, g: u32, h: u32) {
        if g != NONE {
            self.twin[g as usize] = h;
        }
        if h != NONE {
            self.twin[h as usize] = g;
        }
    }

    /// Makes `h`, which leaves `v`, its outgoing half-edge, turned to the boundary where there is one.
    fn settle(&mut self, v: u32, h: u32) {
        let mut at = h;
        while self.twin[at as usize] != NONE {
            at = after(self.twin[at as usize]);
            if at == h {
                break;
            }
        }
        self.outgoing[v as usize] = at;
    }

    /// Puts a vertex on an edge: both faces are cut in two. Its number; the faces keep theirs for the parts at the origin
    /// of `h`, the other parts are appended.
    pub fn split(&mut self, h: u32, p: Point) -> u32 {
        let (hn, hp) = (after(h), before(h));
        let (a, b, c) = (self.origin(h), self.origin(hn), self.origin(hp));
        let t = self.twin[h as usize];
        let w = self.add_vertex(p);
        // Face a b c becomes a w c, and w b c is new.
        let beyond = self.twin[hn as usize];
        let f = self.add_face([w, b, c]);
        self.origin[hn as usize] = w;
        self.pair(f + 1, beyond);
        self.pair(f + 2, hn);
        if t == NONE {
            self.outgoing[w as usize] = f;
        } else {
            // Face b a d becomes w a d, and b w d is new.
            let tp = before(t);
            let d = self.origin(tp);
            let beyond = self.twin[tp as usize];
            let g = self.add_face([b, w, d]);
            self.origin[t as usize] = w;
            self.pair(g + 2, beyond);
            self.pair(g + 1, tp);
            self.pair(f, g);
            self.outgoing[w as usize] = f;
            self.settle(d, g + 2);
        }
        // What left b by a half-edge that starts at w now, or along a boundary.
        self.settle(b, f + 1);
        self.settle(c, hp);
        self.settle(a, h);
        w
    }

    /// Whether an edge can be turned: it has two faces, and their far corners are not yet neighbours.
    pub fn can_flip(&self, h: u32) -> bool {
        let Some(t) = self.twin(h) else { return false };
        let (c, d) = (self.opposite(h), self.opposite(t));
        // Three faces are left at an inner vertex of four.
        let enough = |v: u32| self.spokes(v).nth(3).is_some() || self.is_boundary(v);
        c != d && enough(self.origin(h)) && enough(self.target(h)) && self.neighbours(c).all(|v| v != d)
    }

    /// Turns an edge to the other diagonal of its two faces; [`HalfEdgeMesh::can_flip`] says whether it may be.
    pub fn flip(&mut self, h: u32) {
        let t = self.twin[h as usize];
        if t == NONE {
            return;
        }
        let (hn, hp, tn, tp) = (after(h), before(h), after(t), before(t));
        let (a, b, c, d) = (self.origin(h), self.origin(t), self.origin(hp), self.origin(tp));
        let [beyond_hn, beyond_hp, beyond_tn, beyond_tp] = [hn, hp, tn, tp].map(|x| self.twin[x as usize]);
        // a b c and b a d become d c a and c d b.
        for (x, v) in [(h, d), (hn, c), (hp, a), (t, c), (tn, d), (tp, b)] {
            self.origin[x as usize] = v;
        }
        self.pair(hn, beyond_hp);
        self.pair(hp, beyond_tn);
        self.pair(tn, beyond_tp);
        self.pair(tp, beyond_hn);
        for (v, x) in [(a, hp), (b, tp), (c, hn), (d, tn)] {
            self.settle(v, x);
        }
    }

    /// Whether the vertex at the origin of `h` can be merged into its target without tearing or folding the surface: the
    /// link condition.
    pub fn can_collapse(&self, h: u32) -> bool {
        let (a, b) = (self.origin(h), self.target(h));
        let t = self.twin(h);
        if self.is_boundary(a) && (t.is_some() || !self.is_boundary(b)) {
            return false;
        }
        let shared = |v: &u32| self.neighbours(b).any(|u| u == *v);
        let common = self.neighbours(a).filter(shared).count();
        if common != 1 + usize::from(t.is_some()) {
            return false;
        }
        // The corners opposite lose an edge each.
        let far = [Some(self.opposite(h)), t.map(|t| self.opposite(t))];
        let enough = |v: u32| self.is_boundary(v) || self.spokes(v).nth(3).is_some();
        far.into_iter().flatten().all(enough) && self.neighbours(a).nth(2).is_some()
    }

    /// Merges the vertex at the origin of `h` into its target, which stays where it is;
    /// [`HalfEdgeMesh::can_collapse`] says whether it may be. The faces at the edge are gone.
    pub fn collapse(&mut self, h: u32) {
        let (a, b, c) = (self.origin(h), self.target(h), self.opposite(h));
        let t = self.twin[h as usize];
        let spokes: Vec<u32> = self.spokes(a).collect();
        for s in spokes {
            self.origin[s as usize] = b;
        }
        // Across the faces that go, those beyond them become neighbours.
        let mut seams = vec![(c, self.close_face(h))];
        if t != NONE {
            seams.push((self.opposite(t), self.close_face(t)));
        }
        self.outgoing[a as usize] = NONE;
        let leaving = |mesh: &HalfEdgeMesh, v: u32, [x, y]: [u32; 2]| {
            [x, y].into_iter().filter(|&x| x != NONE).flat_map(|x| [x, after(x)]).find(|&x| mesh.origin(x) == v)
        };
        for gone in [h, t].into_iter().filter(|&x| x != NONE) {
            for x in [gone, after(gone), before(gone)] {
                self.origin[x as usize] = NONE;
            }
        }
        let at_b = seams.iter().find_map(|(_, seam)| leaving(self, b, *seam));
        let ends: Vec<(u32, Option<u32>)> = seams.iter().map(|(v, seam)| (*v, leaving(self, *v, *seam))).collect();
        for (v, x) in ends.into_iter().chain([(b, at_b)]) {
            match x {
                Some(x) => self.settle(v, x),
                None => self.outgoing[v as usize] = NONE,
            }
        }
    }

    /// Makes the neighbours of a face across its two other edges neighbours of each other.
    fn close_face(&mut self, h: u32) -> [u32; 2] {
        let seam = [after(h), before(h)].map(|x| self.twin[x as usize]);
        self.pair(seam[0], seam[1]);
        seam
    }
}

mod replace;
#[cfg(test)]
mod tests;
