//! The front of a curve: which nodes move and how far they may.
//!
//! Everything here looks at nodes that moved and their neighbours only, so a step costs what its moving set costs.

use super::Field;
use super::contact::Contacts;
use super::outline::{Node, Outline};
use super::runs::{self, Runs};
use super::turn::{turning, unit_turn};
use crate::flow::obstacle::{Obstacle, Way};
use crate::flow::step::{Displaced, Front, System, TREMBLING};
use crate::linalg::Closure;
use crate::plane::{Point, Vector, turn_angle};

/// An outline on its way.
pub struct CurveFront<'a> {
    pub(super) outline: Outline,
    pub(super) obstacle: Obstacle,
    pub(super) field: Field<'a>,
    /// Edge length in units of the local radius, and the shortest there is.
    edge: f64,
    shortest_edge: f64,
    /// Nodes whose turn may have changed since it was last looked at.
    candidates: Vec<u32>,
    /// The moving set, run after run.
    pub(super) moving: Vec<u32>,
    /// What is known of each node.
    marks: Vec<Mark>,
    round: u32,
    contacts: Contacts,
}

/// Near a pin the radius is no more than so many times the distance from it: then a boundary may turn on its way to the pin
/// as far as it has to, since the turns 1 / (2 d) of all its lengths at distances d have no finite sum, and meets it
/// in no corner; farther away than half the radius nothing is different.
const EASE: f64 = 2.0;

/// Edges near pins are shorter than elsewhere, by as much as the radius is less there, but by no more than this.
const FINEST_GRAIN: f64 = 0.25;

/// Gives a node what holds at its place, where the field has this radius.
fn bind(node: &mut Node, radius: f64, field: &Field, obstacle: Obstacle) {
    let distance = (field.pin_distance)(node.point);
    node.pinned = distance <= 0.0;
    // Without a bound there is none that could be eased.
    node.radius = if obstacle == Obstacle::NONE { radius } else { radius.min(EASE * distance) };
    node.field_radius = radius;
}

/// The radius that edges at a node are measured by.
fn grain(node: &Node) -> f64 {
    node.radius.max(FINEST_GRAIN * node.field_radius)
}

/// In which steps (counted from 1) a node was last looked at, let go and put into a run.
#[derive(Clone, Copy, Default)]
struct Mark {
    seen: u32,
    moving: u32,
    taken: u32,
    /// Its row in the system of the step.
    slot: u32,
    way: Option<Way>,
}

impl<'a> CurveFront<'a> {
    /// The front of `outline` with edges of `edge` radii.
    pub(super) fn new(mut outline: Outline, obstacle: Obstacle, field: Field<'a>, edge: f64) -> CurveFront<'a> {
        let mut smallest = f64::INFINITY;
        for node in &mut outline.nodes {
            bind(node, (field.radius)(node.point, node.origin), &field, obstacle);
            smallest = smallest.min(grain(node));
        }
        let mut front = CurveFront {
            contacts: Contacts::default(),
            outline,
            obstacle,
            field,
            edge,
            shortest_edge: edge * smallest,
            candidates: Vec::new(),
            moving: Vec::new(),
            marks: Vec::new(),
            round: 0,
        };
        front.sample_sharp_arcs();
        front.split_pairs();
        front.candidates = (0..front.outline.nodes.len() as u32).collect();
        front
    }

    /// The edge length aimed at about node `i`.
    pub(super) fn edge_at(&self, i: u32) -> f64 {
        self.edge * grain(self.outline.node(i))
    }

    /// Which way node `i` goes in the step that is being taken; `None`: it stays.
    pub(super) fn way(&self, i: u32) -> Option<Way> {
        self.marks.get(i as usize).filter(|m| m.moving == self.round).and_then(|m| m.way)
    }

    /// Has the node and its neighbours looked at in the next step.
    pub(super) fn touch(&mut self, i: u32) {
        let node = self.outline.node(i);
        self.candidates.extend([node.prev, i, node.next]);
    }

    /// Puts a node on the edge that leaves `i`, at the part `t` of its length; its number.
    pub(super) fn put_on(&mut self, i: u32, t: f64) -> u32 {
        let new = self.outline.insert(i, t);
        if let Some(mark) = self.marks.get_mut(new as usize) {
            *mark = Mark::default();
        }
        self.find_radius(new);
        self.changed(i);
        self.changed(new);
        new
    }

    /// Remembers that the edge that leaves `i` is not what it was.
    pub(super) fn changed(&mut self, i: u32) {
        self.contacts.note(i);
    }

    /// Gives a node the radius of its place. The field was asked at all vertices of the drawing; what it says elsewhere
    /// that is no radius changes nothing.
    fn find_radius(&mut self, i: u32) {
        let node = self.outline.node_mut(i);
        let radius = (self.field.radius)(node.point, node.origin);
        if radius.is_normal() && radius > 0.0 {
            bind(node, radius, &self.field, self.obstacle);
        }
    }

    /// Fills the moving set from the candidates, in their order.
    fn find_moving(&mut self) {
        self.round += 1;
        self.marks.resize(self.outline.nodes.len(), Mark::default());
        self.moving.clear();
        for i in std::mem::take(&mut self.candidates) {
            let node = self.outline.node(i);
            let seen = std::mem::replace(&mut self.marks[i as usize].seen, self.round);
            if node.dead || node.pinned || seen == self.round {
                continue;
            }
            let t = turning(&self.outline, i, self.edge_at(i));
            let way = self.obstacle.release(t.turn, t.unit, t.slack);
            if way.is_some() {
                let mark = &mut self.marks[i as usize];
                (mark.moving, mark.way) = (self.round, way);
                self.moving.push(i);
            }
        }
    }

    /// Sorts the moving set into runs of neighbours: where each ends, and whether it is a whole ring.
    fn find_runs(&mut self) -> Vec<(usize, Closure)> {
        let round = self.round;
        let found = std::mem::take(&mut self.moving);
        let mut ends = Vec::new();
        // What is left without a start is rings.
        for closure in [Closure::Open, Closure::Ring] {
            for &first in &found {
                let is_start = closure == Closure::Ring || self.way(self.outline.node(first).prev).is_none();
                if !is_start || self.marks[first as usize].taken == round {
                    continue;
                }
                let mut i = first;
                while self.way(i).is_some() && self.marks[i as usize].taken != round {
                    let mark = &mut self.marks[i as usize];
                    (mark.taken, mark.slot) = (round, self.moving.len() as u32);
                    self.moving.push(i);
                    i = self.outline.node(i).next;
                }
                ends.push((self.moving.len(), closure));
            }
        }
        ends
    }

    /// What of the displacement `d` node `i` may take: nothing that leads back over the edges at it.
    ///
    /// Both ends of every edge then come to lie on the side to which it moves, so that a closing contains what it was
    /// made from, and an opening is contained in it.
    fn allowed(&self, i: u32, d: Vector) -> Vector {
        let sign = match self.way(i) {
            Some(Way::Outward) => 1.0,
            Some(Way::Inward) => -1.0,
            None => return Vector::zeros(),
        };
        let node = self.outline.node(i);
        let into = node.point - self.outline.node(node.prev).point;
        let out = self.outline.node(node.next).point - node.point;
        let leads_back = |edge: Vector, d: Vector| sign * edge.perp(&d) > 0.0;
        let along = |edge: Vector, d: Vector| edge * (d.dot(&edge) / edge.norm_squared());
        match (leads_back(into, d), leads_back(out, d)) {
            (false, false) => d,
            (true, true) => Vector::zeros(),
            (true, false) => Some(along(into, d)).filter(|d| !leads_back(out, *d)).unwrap_or_default(),
            (false, true) => Some(along(out, d)).filter(|d| !leads_back(into, *d)).unwrap_or_default(),
        }
    }

    /// Total length of the edges at the moving nodes, and twice the signed area between them and their first node's
    /// place in `origin`.
    fn measure(&self, ends: &[usize], origins: &[Point]) -> (f64, f64) {
        let (mut length, mut doubled_area, mut start) = (0.0, 0.0, 0);
        for (&end, origin) in ends.iter().zip(origins) {
            let mut add = |from: u32| {
                let (a, b) = (self.outline.node(from).point, self.outline.node(self.outline.node(from).next).point);
                length += (b - a).norm();
                doubled_area += (a - origin).perp(&(b - origin));
            };
            let before = self.outline.node(self.moving[start]).prev;
            if self.way(before).is_none() {
                add(before);
            }
            self.moving[start..end].iter().copied().for_each(&mut add);
            start = end;
        }
        (length, doubled_area)
    }
}

impl Front<2> for CurveFront<'_> {
    type Stiffness = Runs;

    fn release(&mut self) -> Option<System<Runs, 2>> {
        self.find_moving();
        self.refine();
        let ends = self.find_runs();
        if self.moving.is_empty() {
            return None;
        }
        let beyond = self.moving.iter().map(|&i| {
            let t = turning(&self.outline, i, self.edge_at(i));
            self.obstacle.beyond(self.way(i).unwrap_or(Way::Outward), t.turn, t.unit).max(t.slack)
        });
        let beyond = beyond.collect();
        Some(runs::system(&self.outline, &self.moving, ends, beyond))
    }

    fn beyond(&self, displacements: &[[f64; 2]]) -> Vec<f64> {
        let after = |&i: &u32| {
            let node = self.outline.node(i);
            let [before, here, next] = [node.prev, i, node.next].map(|j| match self.marks.get(j as usize) {
                Some(mark) if mark.moving == self.round => {
                    self.outline.node(j).point + Vector::from(displacements[mark.slot as usize])
                }
                _ => self.outline.node(j).point,
            });
            let (into, out) = (here - before, next - here);
            let unit = unit_turn(into.norm(), out.norm(), node.radius);
            self.obstacle.beyond(self.way(i).unwrap_or(Way::Outward), turn_angle(into, out), unit)
        };
        self.moving.iter().map(after).collect()
    }

    fn displace(&mut self, displacements: &[[f64; 2]]) -> Displaced {
        let allowed: Vec<Vector> =
            self.moving.iter().zip(displacements).map(|(&i, &d)| self.allowed(i, d.into())).collect();
        // Runs as stretches of neighbours.
        let ends: Vec<usize> = (1..=self.moving.len())
            .filter(|&k| self.moving.get(k).is_none_or(|&i| self.outline.node(i).prev != self.moving[k - 1]))
            .collect();
        let starts = std::iter::once(0).chain(ends.iter().copied());
        let origins: Vec<Point> = starts.take(ends.len()).map(|k| self.outline.node(self.moving[k]).point).collect();
        let (length, doubled_area) = self.measure(&ends, &origins);
        let (mut largest, mut shortest_edge): (f64, f64) = (0.0, f64::INFINITY);
        for (&i, d) in self.moving.iter().zip(&allowed) {
            let h = self.edge_at(i);
            let distance = d.norm() / h;
            largest = largest.max(distance);
            if distance > TREMBLING {
                shortest_edge = shortest_edge.min(h);
            }
            if distance > 0.0 {
                self.outline.displace(i, *d);
            }
        }
        let (new_length, new_doubled_area) = self.measure(&ends, &origins);
        for k in 0..self.moving.len() {
            let i = self.moving[k];
            self.find_radius(i);
            self.changed(i);
            self.changed(self.outline.node(i).prev);
        }
        let displaced = Displaced {
            moving: self.moving.len(),
            largest,
            shortest_edge,
            shrunk: length - new_length,
            swept: 0.5 * (new_doubled_area - doubled_area).abs(),
        };
        self.mend();
        displaced
    }

    fn contacts(&mut self) -> Vec<[f64; 2]> {
        self.contacts.look(&self.outline).into_iter().map(Into::into).collect()
    }

    fn edge_length(&self) -> f64 {
        self.shortest_edge
    }
}
