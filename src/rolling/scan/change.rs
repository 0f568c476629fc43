//! What is done at a node, once it is decided.

use super::nodes::{LinkKind, Node};
use super::{Mode, Roller};
use crate::plane::Point;
use crate::rolling::carrier::center_of_chord;

/// An arc of the disk to come.
#[derive(Clone, Copy)]
pub(super) struct NewArc {
    pub(super) start: Point,
    pub(super) end: Point,
    pub(super) center: Point,
}

/// What to do at a node, decided before anything is changed.
pub(super) enum Step {
    /// Take the node away; its neighbours are joined by an arc of the disk.
    Kill,
    /// Replace the corner between two links by an arc from contact to contact.
    Corner { first: u32, last: u32, arc: NewArc },
    /// Split the node in two with an arc between them.
    Cut(NewArc),
    /// Move the node along its outgoing link to the end of the arc; the incoming link becomes the arc.
    Forward(NewArc, Meets),
    /// Move the node back along its incoming link to the start of the arc; the outgoing link becomes the arc.
    Back(NewArc, Meets),
    /// Leave it.
    Refuse,
}

/// How a new arc meets the link on which its node moved.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Meets {
    /// Tangentially: the node is done.
    Tangent,
    /// At an angle: the node has to be looked at again.
    Angle,
}

impl Roller<'_> {
    /// Joins `b` to `a` where they are one point.
    pub(super) fn absorb(&mut self, a: u32, b: u32, c: u32) {
        if a == b || a == c {
            return;
        }
        let (link, excess) = (self.node(b).link, self.node(b).excess);
        self.node_mut(b).alive = false;
        self.alive -= 1;
        if self.head == b {
            self.head = a;
        }
        let node = self.node_mut(a);
        node.next = c;
        node.link = link;
        // Two turns at one place: neither stored value speaks for their sum.
        node.excess = match (node.excess, excess) {
            (Some(x), Some(y)) => Some(x.max(y)),
            _ => Some(0.0),
        };
        self.node_mut(c).prev = a;
        self.enqueue(a);
        self.enqueue(c);
    }

    pub(super) fn apply(&mut self, step: Step, a: u32, b: u32, c: u32) {
        match step {
            Step::Refuse => {
                if self.mode == Mode::Geodesic {
                    // The neighbour is the one that has to give way first.
                    let neighbour = if self.is_rolling(a) { a } else { c };
                    self.enqueue(neighbour);
                }
            }
            Step::Kill => {
                self.node_mut(b).alive = false;
                self.alive -= 1;
                if self.head == b {
                    self.head = a;
                }
                let center = center_of_chord(self.node(a).point, self.node(c).point, self.r);
                self.node_mut(a).next = c;
                self.node_mut(a).link = LinkKind::Rolling(center);
                self.node_mut(c).prev = a;
                self.enqueue(c);
                self.enqueue(a);
            }
            Step::Corner { first, last, arc } => {
                self.move_to(first, arc.start);
                self.move_to(last, arc.end);
                self.node_mut(first).link = LinkKind::Rolling(arc.center);
            }
            Step::Cut(arc) => {
                let link = self.node(b).link;
                let made = self.nodes.len() as u32;
                self.move_to(b, arc.start);
                let node = self.node_mut(b);
                node.link = LinkKind::Rolling(arc.center);
                node.next = made;
                self.nodes.push(Node {
                    point: arc.end,
                    prev: b,
                    next: c,
                    link,
                    source: None,
                    excess: Some(0.0),
                    alive: true,
                    queued: false,
                });
                self.node_mut(c).prev = made;
                self.alive += 1;
            }
            Step::Forward(arc, meets) => {
                self.move_to(b, arc.end);
                self.node_mut(a).link = LinkKind::Rolling(arc.center);
                if meets == Meets::Angle {
                    self.enqueue(b);
                }
                self.enqueue(a);
            }
            Step::Back(arc, meets) => {
                self.move_to(b, arc.start);
                self.node_mut(b).link = LinkKind::Rolling(arc.center);
                if meets == Meets::Angle {
                    self.enqueue(b);
                }
                self.enqueue(c);
            }
        }
    }

    fn move_to(&mut self, i: u32, p: Point) {
        let node = self.node_mut(i);
        node.point = p;
        node.source = None;
        node.excess = Some(0.0);
    }
}
