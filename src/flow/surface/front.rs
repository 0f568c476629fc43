//! The front of a surface: which vertices move, and how far they may.
//!
//! Everything here looks at vertices that moved and their neighbours only, so a step costs what its moving set costs.

use super::contact::Contacts;
use super::crowd::Crowd;
use super::landing::{Approach, CAPTURE, LANDING_COST};
use super::operators::{self, Pull};
use super::{Kind, SurfaceField};
use crate::flow::obstacle::{Obstacle, Way};
use crate::flow::step::{Displaced, Front, SparseStiffness, System, TREMBLING};
use crate::mesh::{HalfEdgeMesh, NONE, Point, TriangleMesh, Vector};

/// Near a pin the radius is no more than so many times the distance from it: then a surface may turn on its way to the pin as far
/// as it has to, and meets it smoothly. With 1 it would be a cone that turns the same at every scale.
const EASE: f64 = 0.7;

/// Rounds of refining before a step: each halves the edges.
const REFINEMENTS: usize = 40;

/// What is known of a vertex.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Vertex {
    /// 1 over the bound.
    pub radius: f64,
    /// It stays, whatever its curvature.
    pub pinned: bool,
    /// The last time that it was to move, the surface would have crossed itself.
    pub blocked: bool,
    /// It is not where it was.
    pub moved: bool,
    /// How often it was to land and did not.
    pub missed: u8,
    /// What contact says of it.
    pub approach: Approach,
    /// The steps (counted from 1) in which it was last looked at and let go.
    seen: u32,
    moving: u32,
    /// Its row in the system of that step.
    slot: u32,
    way: Option<Way>,
}

impl Vertex {
    /// One that has not been looked at.
    pub fn new(radius: f64, missed: u8) -> Vertex {
        Vertex { radius, missed, ..Vertex::default() }
    }
}

/// A surface on its way.
pub struct SurfaceFront<'a> {
    pub(super) mesh: HalfEdgeMesh,
    pub(super) input: TriangleMesh,
    pub(super) vertices: Vec<Vertex>,
    /// Faces that are not what they were in the input.
    pub(super) touched: Vec<bool>,
    pub(super) field: SurfaceField<'a>,
    pub(super) obstacle: Obstacle,
    pub(super) kind: Kind,
    /// The edge length.
    pub(super) h: f64,
    /// Vertices whose curvature may have changed since it was last looked at.
    candidates: Vec<u32>,
    /// The moving set.
    pub(super) moving: Vec<u32>,
    round: u32,
    pub(super) contacts: Contacts,
    /// No move takes the surface through itself: what would is not made.
    pub(super) is_guarded: bool,
    pub(super) crowd: Crowd,
    /// Vertices that are nearer to the ball than so many edge lengths land.
    pub(super) capture: f64,
}

impl<'a> SurfaceFront<'a> {
    pub(super) fn new(
        input: TriangleMesh,
        mesh: HalfEdgeMesh,
        field: SurfaceField<'a>,
        obstacle: Obstacle,
        kind: Kind,
        h: f64,
        freeze: bool,
    ) -> SurfaceFront<'a> {
        let mut front = SurfaceFront {
            vertices: vec![Vertex::default(); mesh.points.len()],
            touched: vec![false; mesh.face_count()],
            candidates: (0..mesh.points.len() as u32).collect(),
            contacts: Contacts::default(),
            is_guarded: freeze,
            crowd: Crowd::new(h, mesh.face_count()),
            capture: CAPTURE,
            moving: Vec::new(),
            round: 0,
            input,
            mesh,
            field,
            obstacle,
            kind,
            h,
        };
        front.candidates.retain(|&v| front.mesh.has_vertex(v));
        for v in 0..front.vertices.len() as u32 {
            front.bind(v);
        }
        let from = front.mesh.points.len() as u32;
        front.cut_sharp_edges();
        front.candidates.extend(from..front.mesh.points.len() as u32);
        front
    }

    pub(super) fn point(&self, v: u32) -> Point {
        self.mesh.points[v as usize]
    }

    /// Gives a vertex what holds at its place. The field was asked at all vertices of the input; what it says elsewhere that is
    /// no radius changes nothing.
    pub(super) fn bind(&mut self, v: u32) {
        let p = self.point(v);
        let facing = self.field.facing.as_ref().map_or(1.0, |facing| facing(self.normal(v)));
        let radius = (self.field.radius)(p) * facing;
        let distance = (self.field.pin_distance)(p);
        let vertex = &mut self.vertices[v as usize];
        if radius.is_normal() && radius > 0.0 {
            // Without a bound there is none that could be eased.
            vertex.radius = if self.obstacle == Obstacle::NONE { radius } else { radius.min(EASE * distance) };
        }
        vertex.pinned |= distance <= 0.0 || self.mesh.is_boundary(v);
    }

    /// Whether vertex `v` is one of the input at its place.
    pub(super) fn is_kept(&self, v: u32) -> bool {
        (v as usize) < self.input.points.len() && !self.vertices[v as usize].moved
    }

    pub(super) fn is_pinned(&self, v: u32) -> bool {
        self.vertices[v as usize].pinned
    }

    pub(super) fn has_moved(&self, v: u32) -> bool {
        self.vertices[v as usize].moved
    }

    /// Has the vertex and its neighbours looked at in the next step.
    pub(super) fn touch(&mut self, v: u32) {
        self.candidates.push(v);
        for w in self.mesh.neighbours(v) {
            self.candidates.push(w);
            self.candidates.extend(self.mesh.neighbours(w));
        }
    }

    /// Which way vertex `v` goes in the step that is being taken; `None`: it stays.
    pub(super) fn way(&self, v: u32) -> Option<Way> {
        self.vertices.get(v as usize).filter(|m| m.moving == self.round).and_then(|m| m.way)
    }

    /// Fills the moving set from the candidates, in their order; how far beyond the bound each is.
    fn find_moving(&mut self, candidates: &[u32]) -> Vec<f64> {
        self.ask_ahead(candidates, self.round == 0);
        self.round += 1;
        self.moving.clear();
        let (mut all_beyond, mut around) = (Vec::new(), Vec::new());
        for &v in candidates {
            let seen = std::mem::replace(&mut self.vertices[v as usize].seen, self.round);
            if seen == self.round || !self.mesh.has_vertex(v) || self.vertices[v as usize].pinned {
                continue;
            }
            if self.field.facing.is_some() {
                // Its neighbours may have turned it.
                self.bind(v);
            }
            if let Some((way, beyond)) = self.let_go(v, &mut around) {
                let (round, slot) = (self.round, self.moving.len() as u32);
                let vertex = &mut self.vertices[v as usize];
                (vertex.moving, vertex.slot, vertex.way) = (round, slot, Some(way));
                self.moving.push(v);
                all_beyond.push(beyond);
            }
        }
        all_beyond
    }

    /// The faces at the moving set, each once, in order.
    pub(super) fn active_faces(&self) -> Vec<u32> {
        let mut faces: Vec<u32> = self.moving.iter().flat_map(|&v| self.mesh.faces_at(v)).collect();
        faces.sort_unstable();
        faces.dedup();
        faces
    }

    fn row(&self, v: u32) -> Option<usize> {
        let vertex = &self.vertices[v as usize];
        (vertex.moving == self.round).then_some(vertex.slot as usize)
    }

    /// Puts a vertex elsewhere.
    pub(super) fn place(&mut self, v: u32, p: Point) {
        self.mesh.points[v as usize] = p;
        self.vertices[v as usize].moved = true;
        self.change_faces(v);
    }

    /// Marks the faces at `v` as changed.
    pub(super) fn change_faces(&mut self, v: u32) {
        self.touched.resize(self.mesh.face_count(), true);
        let faces: Vec<u32> = self.mesh.faces_at(v).collect();
        for f in faces {
            self.change_face(f);
        }
    }

    /// Marks a face as changed.
    pub(super) fn change_face(&mut self, f: u32) {
        self.touched[f as usize] = true;
        if self.is_guarded {
            self.crowd.file(f, self.mesh.triangle(f));
        } else {
            self.contacts.note(f);
        }
    }

    fn area(&self, faces: &[u32]) -> f64 {
        faces.iter().map(|&f| 0.5 * self.mesh.area_vector(f).norm()).sum()
    }
}

impl Front<3> for SurfaceFront<'_> {
    type Stiffness = SparseStiffness;

    fn release(&mut self) -> Option<System<SparseStiffness, 3>> {
        let mut candidates = std::mem::take(&mut self.candidates);
        let mut beyond = self.find_moving(&candidates);
        for _ in 0..REFINEMENTS {
            let from = self.mesh.points.len() as u32;
            let cut = self.refine();
            if cut.is_empty() {
                break;
            }
            candidates.extend(from..self.mesh.points.len() as u32);
            candidates.extend(cut);
            beyond = self.find_moving(&candidates);
        }
        if self.moving.is_empty() {
            return None;
        }
        let n = self.moving.len();
        let mut mass = vec![0.0; n];
        let mut force = vec![[0.0; 3]; n];
        let mut entries = Vec::with_capacity(12 * n);
        for f in self.active_faces() {
            let corners = self.mesh.face(f);
            let rows = corners.map(|v| self.row(v));
            let third = self.mesh.area_vector(f).norm() / 6.0;
            rows.iter().flatten().for_each(|&row| mass[row] += third);
            let inward = corners.iter().find_map(|&v| self.way(v)) == Some(Way::Inward);
            let pull = match (self.kind, inward && self.obstacle != Obstacle::NONE) {
                (Kind::Mean, _) => Pull::Every,
                (Kind::Minimum, false) => Pull::Least,
                (Kind::Minimum, true) => Pull::Most,
            };
            operators::add(&self.mesh, f, pull, rows, &mut entries, &mut force);
        }
        if self.obstacle != Obstacle::NONE {
            // What pulls along the surface does not move it.
            for (&v, force) in self.moving.iter().zip(&mut force) {
                let normal = self.normal(v);
                *force = (normal * normal.dot(&Vector::from(*force))).into();
            }
        }
        Some(System { mass, stiffness: SparseStiffness(entries), force, beyond })
    }

    fn beyond(&self, displacements: &[[f64; 3]]) -> Vec<f64> {
        // Without a bound nothing passes it, and contact is where the others land.
        if self.obstacle == Obstacle::NONE || self.is_guided() {
            return vec![0.0; self.moving.len()];
        }
        let place = |v: u32| match self.row(v) {
            Some(row) => self.point(v) + Vector::from(displacements[row]),
            None => self.point(v),
        };
        let mut around = Vec::new();
        let after = |&v: &u32| {
            let way = self.way(v).unwrap_or(Way::Outward);
            let c = self.curved(v, way, place, &mut around);
            self.obstacle.beyond(way, c.curvature, c.unit)
        };
        self.moving.iter().map(after).collect()
    }

    fn displace(&mut self, displacements: &[[f64; 3]]) -> Displaced {
        let faces = self.active_faces();
        let area = self.area(&faces);
        let mut displaced =
            Displaced { moving: self.moving.len(), shortest_edge: f64::INFINITY, ..Displaced::default() };
        for (k, &d) in displacements.iter().enumerate() {
            let v = self.moving[k];
            let landing = match self.vertices[v as usize].approach {
                Approach::Near(landing) => Some(landing),
                _ => None,
            };
            let d = match landing {
                Some(landing) => self.followed(v, landing.point - self.point(v)),
                None => self.allowed(v, d.into()),
            };
            let d = self.free(v, d);
            let missed = &mut self.vertices[v as usize].missed;
            *missed = missed.saturating_add(if landing.is_some() { LANDING_COST } else { 1 });
            let distance = d.norm() / self.h;
            if distance == 0.0 || !distance.is_finite() {
                continue;
            }
            displaced.largest = displaced.largest.max(distance);
            if distance > TREMBLING {
                displaced.shortest_edge = self.h;
            }
            let swept: Vector = self.mesh.faces_at(v).map(|f| self.mesh.area_vector(f) / 6.0).sum();
            displaced.swept += swept.dot(&d).abs();
            match landing.filter(|l| l.point - self.point(v) == d) {
                Some(landing) => {
                    self.place(v, landing.point);
                    self.vertices[v as usize].approach = Approach::Landed(landing.normal);
                }
                None => {
                    self.place(v, self.point(v) + d);
                    self.come_nearer(v, d.norm());
                }
            }
        }
        displaced.shrunk = area - self.area(&faces);
        for k in 0..self.moving.len() {
            self.bind(self.moving[k]);
            self.touch(self.moving[k]);
        }
        self.mend();
        if self.reach_farther(displaced.largest) {
            displaced.largest = displaced.largest.max(1.0);
        }
        displaced
    }

    fn contacts(&mut self) -> Vec<[f64; 3]> {
        // Where nothing crosses, what was blocked is told in the end.
        if self.is_guarded { Vec::new() } else { self.find_contacts().into_iter().map(Into::into).collect() }
    }

    fn edge_length(&self) -> f64 {
        self.h
    }
}

/// A face whose corners are no more.
pub(super) fn is_gone(mesh: &HalfEdgeMesh, f: u32) -> bool {
    f == NONE || !mesh.has_face(f)
}
