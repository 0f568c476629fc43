//! The ring of nodes that the disk rolls along: a doubly linked list in a vector.

use super::Roller;
use crate::plane::{Arc, Link, Point, Segment, Turn, Vector, right_normal};
use crate::rolling::track::Track;

/// The outgoing link of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LinkKind {
    Line,
    /// A minor arc of the disk about this centre on the right. It is the centre of the disk that touched: that of a circle
    /// through the ends of a short arc is uncertain, and with it the directions at the ends.
    Rolling(Point),
    /// (Part of) the input arc that leaves this vertex of the ring.
    Input(u32),
}

#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) point: Point,
    pub(super) prev: u32,
    pub(super) next: u32,
    pub(super) link: LinkKind,
    /// The input vertex that stands here unmoved.
    pub(super) source: Option<u32>,
    /// Stored excess; `None` until first computed.
    pub(super) excess: Option<f64>,
    pub(super) alive: bool,
    pub(super) queued: bool,
}

impl Roller<'_> {
    pub(super) fn node(&self, i: u32) -> &Node {
        &self.nodes[i as usize]
    }

    pub(super) fn node_mut(&mut self, i: u32) -> &mut Node {
        &mut self.nodes[i as usize]
    }

    /// Whether nothing of the ring is left but arcs of the disk and at most one straight link: no disk fits.
    pub(super) fn is_filled(&self) -> bool {
        if self.alive > 2 {
            return false;
        }
        let head = self.node(self.head);
        let is_input = |k: LinkKind| matches!(k, LinkKind::Input(_));
        self.alive < 2 || !(is_input(head.link) || is_input(self.node(head.next).link))
    }

    pub(super) fn link(&self, a: u32) -> Link {
        let node = self.node(a);
        match node.link {
            LinkKind::Line => Link::Line,
            LinkKind::Input(i) => self.input.vertices[i as usize].link,
            LinkKind::Rolling(center) => self.rolling_link(node.point, self.node(node.next).point, center),
        }
    }

    pub(super) fn segment(&self, a: u32) -> Segment {
        let node = self.node(a);
        Segment { start: node.point, end: self.node(node.next).point, link: self.link(a) }
    }

    /// The minor arc about `center`, or a line where the ends are so near to each other that rounding has exchanged them.
    pub(super) fn rolling_link(&self, start: Point, end: Point, center: Point) -> Link {
        let (from, to) = (start - center, end - center);
        if from.perp(&to) >= 0.0 && from.dot(&to) > 0.0 {
            return Link::Line;
        }
        Link::Arc(Arc { center, radius: self.r, turn: Turn::Right })
    }

    pub(super) fn track(&self, a: u32) -> Track {
        Track::new(self.segment(a))
    }

    pub(super) fn is_rolling(&self, a: u32) -> bool {
        matches!(self.node(a).link, LinkKind::Rolling(_))
    }

    /// Direction of the link from `a` at its start (`at_start`) or end, of any length.
    pub(super) fn tangent(&self, a: u32, at_start: bool) -> Vector {
        let node = self.node(a);
        let (from, to) = (node.point, self.node(node.next).point);
        match node.link {
            LinkKind::Line => to - from,
            LinkKind::Input(_) => {
                let s = self.segment(a);
                if at_start { s.start_tangent() } else { s.end_tangent() }
            }
            LinkKind::Rolling(center) => right_normal(if at_start { from } else { to } - center),
        }
    }
}
