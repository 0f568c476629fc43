//! The surface on its way to the closing.

use std::collections::BTreeSet;

use super::changes::{Changes, Refused};
use super::contact::{Ground, Rest, UNTOUCHED};
use super::remesh::LONGEST;
use crate::mesh::{HalfEdgeMesh, Point, Vector};

/// What is known of a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum State {
    /// It is where it was, or on a face of the input.
    Kept,
    /// The ball at rest touches it.
    Moved(Rest),
    /// Two balls touch it: it is on a ridge of the closing.
    Ridge(Rest, Rest),
    /// No ball was found to touch it.
    Lost,
}

/// A surface with a state for each vertex. What never moves is never touched.
#[derive(Clone)]
pub(super) struct Covering<'a> {
    pub ground: &'a Ground,
    pub mesh: HalfEdgeMesh,
    pub state: Vec<State>,
    /// Whether each face is other than it was in the input.
    pub touched: Vec<bool>,
    /// The face of the input that each face is a part of, or took the place of.
    pub parent: Vec<u32>,
    /// Faces that fill gaps: they may move though none of their corners does.
    pub filled: BTreeSet<u32>,
    /// The corners of the coarse faces of the input in which there is nothing that the whole ball cannot touch.
    pub clear: Vec<Option<[u32; 3]>>,
    /// The part of its radius that the ball has now.
    pub part: f64,
    /// Its radius at a place.
    pub field: &'a (dyn Fn(Point) -> f64 + Sync),
    /// The edge length aimed at.
    pub edge: f64,
    /// How many threads work.
    pub threads: usize,
    /// Up to how many vertices long edges are split boldly, if at all.
    pub bold: Option<usize>,
    /// When its vertices changed.
    pub changes: Changes,
    pub refusals: Refusals,
}

/// What remeshing refused, by half-edges and by vertices.
#[derive(Clone, Default)]
pub(super) struct Refusals {
    pub merge: Refused,
    pub split: Refused,
    pub turn: Refused,
    pub relax: Refused,
}

impl Covering<'_> {
    pub fn rest(&self, v: u32) -> Option<&Rest> {
        match &self.state[v as usize] {
            State::Moved(rest) | State::Ridge(rest, _) => Some(rest),
            _ => None,
        }
    }

    /// The radius of the ball at a place.
    pub fn radius(&self, p: Point) -> f64 {
        self.part * (self.field)(p)
    }

    pub fn is_kept(&self, v: u32) -> bool {
        matches!(self.state[v as usize], State::Kept)
    }

    pub fn point(&self, v: u32) -> Point {
        self.mesh.points[v as usize]
    }

    /// Whether any face of the input is at one of its vertices.
    pub fn has_been_used(&self, v: u32) -> bool {
        self.ground.mesh.has_vertex(v)
    }

    /// The faces at vertices that are not kept and those that fill gaps, in order.
    pub fn active_faces(&self) -> Vec<u32> {
        let is_active = self.is_active();
        self.mesh.faces().filter(|&f| is_active[f as usize]).collect()
    }

    /// Whether each face is at a vertex that is not kept, or fills a gap.
    fn is_active(&self) -> Vec<bool> {
        let is_moved: Vec<bool> = self.state.iter().map(|state| !matches!(state, State::Kept)).collect();
        let at_moved = |f: u32| self.mesh.has_face(f) && self.mesh.face(f).iter().any(|&v| is_moved[v as usize]);
        let mut is_active: Vec<bool> = (0..self.mesh.face_count() as u32).map(at_moved).collect();
        self.filled.iter().filter(|&&f| self.mesh.has_face(f)).for_each(|&f| is_active[f as usize] = true);
        is_active
    }

    /// A place where the surface has crumpled, if the active faces have more area than this: one that turns its back on its balls.
    pub fn crumpled(&self, most_area: f64) -> Option<Point> {
        let faces = self.active_faces();
        let area: f64 = faces.iter().map(|&f| 0.5 * self.mesh.area_vector(f).norm()).sum();
        if area <= most_area {
            return None;
        }
        let folded = faces.iter().find(|&&f| self.agreement(self.mesh.face(f), &self.mesh.area_vector(f)) < 0.0);
        let [a, b, c] = self.mesh.triangle(*folded.or(faces.first())?);
        Some(Point::from((a.coords + b.coords + c.coords) / 3.0))
    }

    /// The edges of the active faces with their lengths, by one half-edge each.
    pub fn active_edges(&self) -> Vec<(f64, u32)> {
        self.edges().into_iter().map(|h| (self.mesh.length(h), h)).collect()
    }

    /// The same without their lengths.
    pub fn edges(&self) -> Vec<u32> {
        let is_active = self.is_active();
        let has_active = |h: u32| {
            let faces = [Some(h), self.mesh.twin(h)].into_iter().flatten().map(|x| self.mesh.face_of(x));
            faces.into_iter().any(|f| is_active[f as usize])
        };
        (0..3 * self.mesh.face_count() as u32).filter(|&h| self.mesh.is_edge(h) && has_active(h)).collect()
    }

    /// Whether a face has sides longer than what is aimed at.
    pub fn is_coarse(&self, f: u32) -> bool {
        self.mesh.half_edges(f).iter().any(|&h| self.mesh.length(h) > LONGEST * self.edge)
    }

    /// Whether a face was looked into when the ball was whole, and nothing was found. Vertices that are kept never move.
    pub fn is_clear(&self, f: u32) -> bool {
        self.clear.get(f as usize).is_some_and(|corners| *corners == Some(self.mesh.face(f)))
    }

    pub fn touch(&mut self, f: u32) {
        if self.touched.len() < self.mesh.face_count() {
            self.touched.resize(self.mesh.face_count(), true);
        }
        self.touched[f as usize] = true;
    }

    /// Whether a face is other than it was in the input.
    pub fn is_touched(&self, f: u32) -> bool {
        self.touched.get(f as usize).is_none_or(|touched| *touched)
    }

    /// Whether both faces at an edge fill gaps.
    pub fn is_filled(&self, h: u32) -> bool {
        let fills = |h: u32| self.filled.contains(&self.mesh.face_of(h));
        fills(h) && self.mesh.twin(h).is_some_and(fills)
    }

    /// Puts a vertex on an edge.
    pub fn split(&mut self, h: u32, p: Point, state: State) -> u32 {
        let twin = self.mesh.twin(h);
        let w = self.mesh.split(h, p);
        self.state.push(state);
        for x in [Some(h), twin].into_iter().flatten() {
            if self.filled.contains(&self.mesh.face_of(x)) {
                self.filled.insert(self.parent.len() as u32);
            }
            self.parent.push(self.parent[self.mesh.face_of(x) as usize]);
        }
        // All corners of the faces that there are now.
        let around: Vec<u32> = self.mesh.neighbours(w).chain([w]).collect();
        around.into_iter().for_each(|v| self.changes.mark(v));
        for x in [Some(h), twin].into_iter().flatten() {
            self.touch(self.mesh.face_of(x));
        }
        w
    }

    /// Puts a vertex of the input into a face of it.
    pub fn put_in_face(&mut self, f: u32, [a, b, c]: [u32; 3], p: Point) -> Option<u32> {
        let parent = self.parent[f as usize];
        let w = self.mesh.add_vertex(p);
        self.state.push(State::Kept);
        [a, b, c, w].into_iter().for_each(|v| self.changes.mark(v));
        self.mesh.replace(&[f], &[[a, b, w], [b, c, w], [c, a, w]]).ok()?;
        self.touch(f);
        self.parent.extend([parent; 3]);
        for g in self.parent.len() - 3..self.parent.len() {
            self.touch(g as u32);
        }
        Some(w)
    }

    /// Of the unit normal of a triangle and those of the balls that touch its moved corners the smallest cosine.
    pub fn agreement(&self, corners: [u32; 3], normal: &Vector) -> f64 {
        let Some(unit) = normal.try_normalize(0.0) else { return -1.0 };
        corners.iter().map(|&v| self.agrees(v, &unit)).fold(1.0, f64::min)
    }

    /// Whether a triangle dips into the input, or lies on it upside down, as far as its centre and the middles of its sides tell.
    pub fn dips(&self, [a, b, c]: [Point; 3]) -> bool {
        let center = Point::from((a.coords + b.coords + c.coords) / 3.0);
        let deepest = DIP * self.edge;
        if let Some(hit) = self.ground.hierarchy.nearest(center, self.edge) {
            let is_on_it = hit.distance <= deepest;
            let below = self.ground.pseudo_normal(hit.face, hit.feature).dot(&area_vector([a, b, c])) < 0.0;
            if is_on_it && below || !is_on_it && self.ground.is_inside(center, &hit) {
                return true;
            }
        }
        let middle = |p: &Point, q: &Point| nalgebra::center(p, q);
        [middle(&a, &b), middle(&b, &c), middle(&c, &a)].into_iter().any(|p| self.ground.depth(p, self.edge) > deepest)
    }

    /// Rolls the ball to the vertex from where it lies along `normal`.
    pub fn roll(&self, x: Point, normal: Vector) -> Option<Rest> {
        let r = self.radius(x);
        self.ground.rest(x, x + normal * r, r, UNTOUCHED)
    }

    /// Rolls the ball from one place where it rests to that of a point nearby.
    pub fn reroll(&self, x: Point, from: &Rest) -> Option<(Point, Rest)> {
        let rest = self.ground.rest(x, from.center, self.radius(x), from.contacts)?;
        let p = rest.point();
        let near = (p - x).norm() < self.edge && (rest.center - from.center).norm() < 0.7 * rest.radius + self.edge;
        near.then_some((p, rest))
    }
}

/// Triangles may dip into the input by this part of an edge length: rounding.
const DIP: f64 = 1e-7;

/// Twice the area of a triangle, as a vector along its normal.
pub(super) fn area_vector([a, b, c]: [Point; 3]) -> Vector {
    (b - a).cross(&(c - a))
}

/// The quality of a triangle: 1 where it is equilateral, 0 where it is flat.
pub(super) fn quality([a, b, c]: [Point; 3]) -> f64 {
    let sum = (b - a).norm_squared() + (c - b).norm_squared() + (a - c).norm_squared();
    if sum > 0.0 { 2.0 * 3f64.sqrt() * area_vector([a, b, c]).norm() / sum } else { 0.0 }
}
