//! The local half of the closing: a disk rolls along one ring and cuts every corner it does not fit into.
//!
//! Stages: every vertex becomes a node of a doubly linked ring; nodes where the boundary turns away from the disk by
//! more than it can follow (the *excess* is positive) wait in a queue; each is replaced by an arc of the disk, which
//! can only raise the excess of its neighbours. Every operation moves the boundary outward, so the end state is a least
//! fixed point and does not depend on the order.
//!
//! [`Mode::Safe`] refuses every operation that could fill more than the morphological closing does; what it leaves
//! undone the merge finishes. [`Mode::Geodesic`] measures distance along the curve, as the
//! flow of the paper does (eq. 7): its end state is the limit of that flow.
//!
//! Tolerances, all relative to the radius: [`MIN_LINK`] along the boundary, [`HIDDEN`] across it; turns are measured by
//! [`excess`].

mod change;
mod nodes;
mod step;

use std::collections::VecDeque;

use super::carrier::center_of_chord;
use super::excess::{HALF_TURN, WHOLE_TURN, excess};
use super::merge::{ROUNDING_STEPS, SHRINK};
use super::samples::is_followed;
use crate::plane::{Joint, Link, Ring, Vector, Vertex};
use change::Step;
use nodes::{LinkKind, Node};

/// A contact nearer than this to the end of a link, relative to the radius, is at the end. An error of this size along
/// a tangent moves the boundary by half its square: 1e-14 r.
const MIN_LINK: f64 = 1e-7;

/// Vertices nearer to each other than this, relative to the radius, are one where the disk cannot follow: their link
/// has no direction. It bounds the only inward error of the scan.
const COINCIDENT: f64 = 1e-11;

/// Turns below this (radians, nearly) are rounding: an arc of the disk this short moves the boundary by 1e-19 r.
const MIN_EXCESS: f64 = 1e-9;

/// A node may vanish under a new arc only where the disk is at least this near to holding no part of it, relative to
/// the radius. It bounds the containment error.
const HIDDEN: f64 = 1e-10;

/// A disk is clear of a link that it overlaps by less than this, relative to the radius: rounding of flat crossings.
const CLEAR: f64 = 1e-9;

/// A concave turn below this (radians, nearly) at the end of a scan is what is left of tangents known to 1e-8.
const UNSETTLED: f64 = 1e-6;

/// The excess above which a pocket winds back on itself so far that a local operation may be wrong: 3.1 radians.
const SAFE_EXCESS: f64 = 1.96;

/// The excess of a node that stays in place never falls; a fall by more than this is a turn that passed half a turn.
const WRAPPED: f64 = 0.6;

/// Operations allowed: measured, 1.2 to 1.5 a vertex even where nearly all move.
const OPERATIONS_PER_VERTEX: usize = 200;

/// Visits without a change after which none will come, over the nodes that are left: nodes that refuse wake each other.
const IDLE_ROUNDS: usize = 4;

/// What the scan may take for granted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// Fill only what the morphological closing fills.
    Safe,
    /// Fill what the flow fills, which sees distance along the curve only.
    Geodesic,
}

/// The scanned ring.
#[derive(Clone, Debug)]
pub(super) struct Scan {
    /// The ring with its new arcs; empty where the disk fits nowhere in a hole.
    pub(super) ring: Ring,
    /// Which vertices of the ring are vertices of the input, unmoved.
    pub(super) still: Vec<bool>,
    /// Whether the scan came to its end; operations that [`Mode::Safe`] left undone do not count.
    pub(super) finished: bool,
}

/// Rolls a disk of radius `r` along the right side of `ring`, whose coordinates are known to `resolution`.
pub(super) fn scan(ring: &Ring, r: f64, mode: Mode, resolution: f64) -> Scan {
    if ring.len() < 2 {
        return Scan { ring: Ring::default(), still: vec![], finished: true };
    }
    let mut roller = Roller::new(ring, r, mode, resolution);
    roller.run();
    let scan = roller.finish();
    if scan.ring.is_empty() && ring.area() > 0.0 {
        // Material never vanishes in a closing.
        return Scan { ring: ring.clone(), still: vec![true; ring.len()], ..scan };
    }
    scan
}

struct Roller<'a> {
    input: &'a Ring,
    r: f64,
    mode: Mode,
    /// [`MIN_EXCESS`], or what the rounding of coordinates does to the direction of an arc of the disk.
    min_excess: f64,
    /// A disk is clear of what is not nearer to its centre than this: [`CLEAR`], or the rounding of coordinates.
    clear: f64,
    nodes: Vec<Node>,
    queue: VecDeque<u32>,
    alive: usize,
    head: u32,
    exhausted: bool,
}

impl<'a> Roller<'a> {
    fn new(input: &'a Ring, r: f64, mode: Mode, resolution: f64) -> Roller<'a> {
        let n = input.len();
        let mut nodes: Vec<Node> = Vec::with_capacity(n + n / 4 + 16);
        for (i, v) in input.vertices.iter().enumerate() {
            let link = match v.link {
                Link::Line => LinkKind::Line,
                Link::Arc(_) => LinkKind::Input(i as u32),
            };
            nodes.push(Node {
                point: v.point,
                prev: if i == 0 { n as u32 - 1 } else { i as u32 - 1 },
                next: if i + 1 == n { 0 } else { i as u32 + 1 },
                link,
                source: Some(i as u32),
                excess: None,
                alive: true,
                queued: false,
            });
        }
        let min_excess = MIN_EXCESS + ROUNDING_STEPS * resolution / r;
        let clear = r * (1.0 - CLEAR) - ROUNDING_STEPS * resolution;
        Roller { input, r, mode, min_excess, clear, nodes, queue: VecDeque::new(), alive: n, head: 0, exhausted: false }
    }

    fn enqueue(&mut self, i: u32) {
        let node = self.node_mut(i);
        if !node.queued {
            node.queued = true;
            self.queue.push_back(i);
        }
    }

    fn run(&mut self) {
        self.activate();
        let mut idle = 0;
        let mut budget = OPERATIONS_PER_VERTEX * self.input.len() + 10_000;
        while let Some(b) = self.queue.pop_front() {
            self.node_mut(b).queued = false;
            if !self.node(b).alive {
                continue;
            }
            if self.is_filled() {
                self.alive = 0;
                return;
            }
            if budget == 0 || idle > IDLE_ROUNDS * (self.alive + 1) {
                self.exhausted = true;
                return;
            }
            budget -= 1;
            idle = if self.visit(b) { 0 } else { idle + 1 };
        }
        if self.is_filled() {
            self.alive = 0;
        }
    }

    /// Queues every vertex that the disk cannot follow.
    fn activate(&mut self) {
        let n = self.input.len();
        for i in 0..n as u32 {
            if let LinkKind::Input(_) = self.node(i).link
                && !self.track(i).fits(self.r * (1.0 - SHRINK))
            {
                // A concave arc below the radius: the disk spans it from end to end.
                let next = self.node(i).next;
                let center = center_of_chord(self.node(i).point, self.node(next).point, self.r);
                self.node_mut(i).link = LinkKind::Rolling(center);
                self.enqueue(i);
                self.enqueue(next);
            }
        }
        // Lines are the common case: the sign of the turn costs no angle.
        let mut incoming = if n > 0 { self.input.segment(n - 1) } else { return };
        for i in 0..n {
            let outgoing = self.input.segment(i);
            let (u, v) = match (incoming.link, outgoing.link) {
                (Link::Line, Link::Line) => (incoming.end - incoming.start, outgoing.end - outgoing.start),
                _ => (incoming.end_tangent(), outgoing.start_tangent()),
            };
            // Sine and cosine times the lengths: most vertices need no angle.
            let (cross, dot) = (u.perp(&v), u.dot(&v));
            if dot < 0.0 && self.is_horn_of_empty(i as u32, u, v) {
                self.enqueue(i as u32);
            } else if cross < 0.0
                && (dot < 0.0 || -cross > self.min_excess * dot)
                && !is_followed(self.input, i, self.r)
            {
                self.node_mut(i as u32).excess = Some(excess(u, v));
                self.enqueue(i as u32);
            }
            incoming = outgoing;
        }
    }

    /// The excess the input had at vertex `i`, before anything moved.
    fn original_excess(&self, i: u32) -> f64 {
        let n = self.input.len();
        let i = i as usize;
        let incoming = self.input.segment(if i == 0 { n - 1 } else { i - 1 });
        excess(incoming.end_tangent(), self.input.segment(i).start_tangent())
    }

    /// Whether the input turns straight back at node `b`, and what lies between its two curves there is empty: where it is
    /// solid, the same directions are those of the tip of a spike. Their curvatures tell, positive to the left.
    fn is_horn_of_empty(&self, b: u32, arriving: Vector, leaving: Vector) -> bool {
        let a = self.node(b).prev;
        let is_straight_back = |sine: f64, cosine: f64| cosine < 0.0 && sine.abs() <= MIN_LINK * -cosine;
        if self.is_rolling(a)
            || self.is_rolling(b)
            || !is_straight_back(arriving.perp(&leaving), arriving.dot(&leaving))
        {
            return false;
        }
        let curvature = |i: u32| match self.link(i) {
            Link::Line => 0.0,
            Link::Arc(arc) => arc.turn.sign() / arc.radius,
        };
        curvature(a) + curvature(b) > 0.0
    }

    /// Does what there is to do at node `b`, and tells whether anything was.
    fn visit(&mut self, b: u32) -> bool {
        let a = self.node(b).prev;
        let c = self.node(b).next;
        let min_link = COINCIDENT * self.r;
        // A link without length has no direction: its end is its start.
        if (self.node(b).point - self.node(a).point).norm_squared() <= min_link * min_link {
            self.absorb(a, b, c);
            return true;
        }
        let (arriving, leaving) = (self.tangent(a, false), self.tangent(b, true));
        let mut excess =
            if self.is_horn_of_empty(b, arriving, leaving) { HALF_TURN } else { excess(arriving, leaving) };
        let before = match (self.node(b).excess, self.node(b).source) {
            (Some(stored), _) => stored,
            (None, Some(i)) => self.original_excess(i),
            (None, None) => 0.0,
        };
        match self.mode {
            Mode::Geodesic if excess < before - WRAPPED => excess += WHOLE_TURN,
            Mode::Safe if excess < before - WRAPPED || excess > SAFE_EXCESS => {
                self.node_mut(b).excess = Some(excess);
                return false;
            }
            _ => {}
        }
        self.node_mut(b).excess = Some(excess);
        if excess <= self.min_excess {
            return false;
        }
        let step = self.decide(a, b, c, excess);
        let changes = !matches!(step, Step::Refuse);
        self.apply(step, a, b, c);
        changes
    }

    /// Whether no node is left that the disk cannot follow.
    fn is_settled(&self) -> bool {
        let mut i = self.head;
        for _ in 0..self.alive {
            let (u, v) = (self.tangent(self.node(i).prev, false), self.tangent(i, true));
            if excess(u, v) > UNSETTLED {
                // The input tells of the curve: an arc of the disk may have taken a part of the chord since.
                let are_chords = !self.is_rolling(self.node(i).prev) && !self.is_rolling(i);
                let is_sample = |s: u32| is_followed(self.input, s as usize, self.r);
                if !(are_chords && self.node(i).source.is_some_and(is_sample)) {
                    return false;
                }
            }
            i = self.node(i).next;
        }
        true
    }

    fn finish(self) -> Scan {
        let finished = !self.exhausted && (self.mode == Mode::Safe || self.is_settled());
        let mut vertices = Vec::with_capacity(self.alive);
        let mut still = Vec::with_capacity(self.alive);
        if self.alive > 0 {
            let mut i = self.head;
            loop {
                let node = self.node(i);
                let original = node.source.map(|s| &self.input.vertices[s as usize]);
                vertices.push(Vertex {
                    point: node.point,
                    link: self.link(i),
                    joint: original.map_or(Joint::Corner, |v| v.joint),
                    id: original.and_then(|v| v.id),
                });
                still.push(original.is_some());
                i = node.next;
                if i == self.head {
                    break;
                }
            }
        }
        Scan { ring: Ring { vertices }, still, finished }
    }
}
