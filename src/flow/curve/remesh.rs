//! Edges about moving nodes: split and merged towards the edge length, and nowhere else.

use super::front::CurveFront;
use super::outline::{NONE, Outline};
use crate::flow::obstacle::Way;

/// Edges longer than so many edge lengths are split.
pub(super) const LONGEST: f64 = 1.5;

/// A node with an edge shorter than so many edge lengths is taken away, where the chord that bridges it gets no longer
/// than [`LONGEST_BRIDGE`]: the limit bulges from a chord by its length squared over 8 r, here 0.014 edge lengths.
const SHORTEST: f64 = 0.5;
const LONGEST_BRIDGE: f64 = 1.2;

/// Beside so short an edge a node is taken away even for a chord as long as edges may be.
const VANISHING: f64 = 0.1;

/// Nodes nearer to each other than so many edge lengths are one: between them there is no direction to go by.
const COINCIDENT: f64 = 1e-8;

/// A ring of three nodes that is shorter than so many edge lengths has closed.
const CLOSED: f64 = 3.0;

/// How far the chords of an arc that starts at a moving node may stray from it, in edge lengths: unlike the curve that
/// moves, the arc itself is to stay.
const ARC_SAGITTA: f64 = 1e-4;

impl CurveFront<'_> {
    /// Splits the edges at moving nodes that are longer than they may be, so that what moves is about an edge length
    /// long and the rest of the edge stays.
    pub(super) fn refine(&mut self) {
        for k in 0..self.moving.len() {
            let i = self.moving[k];
            self.split_near(i, i, true);
            self.split_near(self.outline.node(i).prev, i, false);
        }
    }

    /// Splits the edge that leaves `edge` near its end `i`.
    fn split_near(&mut self, edge: u32, i: u32, is_start: bool) {
        let node = self.outline.node(edge);
        let far = if is_start { node.next } else { edge };
        let h = self.edge_at(i);
        let both_move = self.way(far).is_some();
        let aim = match node.arc {
            arc if arc != NONE && !both_move => {
                h.min((8.0 * self.outline.arcs[arc as usize].radius * ARC_SAGITTA * h).sqrt())
            }
            _ => h,
        };
        let length = self.outline.edge(edge).length();
        if length <= LONGEST * aim {
            return;
        }
        // Between two moving nodes that are near each other, in the middle.
        let t = if both_move && length < (1.0 + LONGEST) * aim { 0.5 } else { aim / length };
        self.put_on(edge, if is_start { t } else { 1.0 - t });
    }

    /// Puts nodes on the edges of rings that have two alone, as a lens has: the system of a ring takes three.
    pub(super) fn split_pairs(&mut self) {
        for i in 0..self.outline.nodes.len() as u32 {
            if self.outline.loops[self.outline.node(i).ring as usize].count < 3 {
                let next = self.outline.node(i).next;
                self.put_on(i, 0.5);
                self.put_on(next, 0.5);
            }
        }
    }

    /// Samples the arcs that are sharper than the obstacle allows: their insides move, not only their ends.
    pub(super) fn sample_sharp_arcs(&mut self) {
        for i in 0..self.outline.nodes.len() as u32 {
            let node = *self.outline.node(i);
            if node.arc == NONE {
                continue;
            }
            let (arc, edge) = (self.outline.arcs[node.arc as usize], self.outline.edge(i));
            let next = self.outline.node(node.next);
            // Where pins hold the ends, the inside may move.
            let unit = arc.radius / node.field_radius.min(next.field_radius);
            if self.obstacle.release(arc.turn.sign(), unit, 0.0).is_none() {
                continue;
            }
            let h = self.edge_at(i).min(self.edge_at(node.next)).min(arc.radius);
            let pieces = (edge.length() / h).ceil() as usize;
            let mut last = i;
            for left in (2..=pieces).rev() {
                last = self.put_on(last, 1.0 / left as f64);
            }
        }
    }

    /// After a step: edges that became too short or too long, and rings that closed.
    pub(super) fn mend(&mut self) {
        for k in 0..self.moving.len() {
            let i = self.moving[k];
            let node = *self.outline.node(i);
            if node.dead {
                continue;
            }
            self.touch(i);
            let merged = self.merge(i);
            if has_closed(&self.outline, node.ring, self.edge_at(i)) || self.outline.has_turned_over(node.ring) {
                self.outline.remove_loop(node.ring);
            } else if !merged {
                self.split_stretched(i);
                self.split_stretched(node.prev);
            }
        }
    }

    /// Takes a moving node away where an edge at it is too short. Whether it did.
    fn merge(&mut self, i: u32) -> bool {
        let node = *self.outline.node(i);
        let (prev, next) = (self.outline.node(node.prev).point, self.outline.node(node.next).point);
        let (into, out) = (node.point - prev, next - node.point);
        let h = self.edge_at(i);
        let shortest = into.norm().min(out.norm());
        let longest_bridge = if shortest < VANISHING * h { LONGEST } else { LONGEST_BRIDGE };
        // The chord must lie on the side to which the node moves, or the boundary would go back.
        let goes_back = match self.way(i) {
            Some(Way::Outward) => into.perp(&out) > 0.0,
            Some(Way::Inward) => into.perp(&out) < 0.0,
            None => true,
        };
        let goes_back = goes_back && shortest >= COINCIDENT * h;
        if goes_back || shortest >= SHORTEST * h || (next - prev).norm() > longest_bridge * h {
            return false;
        }
        self.outline.remove(i);
        self.changed(node.prev);
        self.touch(node.prev);
        self.touch(node.next);
        true
    }

    /// Splits the edge that leaves `i` where it has been stretched.
    fn split_stretched(&mut self, i: u32) {
        if !self.outline.is_still(i) && self.outline.edge(i).length() > LONGEST * self.edge_at(i) {
            let new = self.put_on(i, 0.5);
            self.touch(new);
        }
    }
}

/// Whether nothing is left of a ring but a speck.
fn has_closed(outline: &Outline, ring: u32, edge_length: f64) -> bool {
    match outline.loops[ring as usize].count {
        0..=2 => true,
        3 => {
            let length: f64 = outline.walk(ring).map(|i| outline.edge(i).length()).sum();
            outline.walk(ring).all(|i| outline.node(i).moved) && length < CLOSED * edge_length
        }
        _ => false,
    }
}
