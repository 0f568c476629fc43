//! Outlines as chains of nodes that can be cut into and mended in one place at a time.

use crate::plane::{Arc, Joint, Link, Point, Region, Ring, Segment, Vector, Vertex, VertexId};

/// No node, no arc.
pub(super) const NONE: u32 = u32::MAX;

/// A vertex, with the edge that leaves it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub point: Point,
    /// Radius of the disk here: that of the field, and near a pin no more than twice the distance from it.
    pub radius: f64,
    /// That of the field, pins aside.
    pub field_radius: f64,
    pub prev: u32,
    pub next: u32,
    pub ring: u32,
    /// The arc that the edge follows; [`NONE`] where it is straight.
    pub arc: u32,
    /// The vertex of the drawing that this is or that the edge it was put on starts at.
    pub origin: Option<VertexId>,
    pub joint: Joint,
    /// It never moves.
    pub pinned: bool,
    /// It was put on an edge: no vertex of the drawing.
    pub born: bool,
    /// It is not where it was.
    pub moved: bool,
    /// The edge bridges vertices that were taken away.
    pub bridge: bool,
    /// The edge is one of the drawing, all of it.
    pub whole: bool,
    pub dead: bool,
}

/// A closed chain.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loop {
    /// One of its nodes; [`NONE`] once it is gone.
    pub first: u32,
    pub count: u32,
    /// Twice the signed area of the polygon of its chords.
    doubled_area: f64,
    /// The sign of the area that it had at the start.
    sign: f64,
}

/// All rings of a region. The nodes of the drawing's vertices come first, in its order, but for those without an edge.
#[derive(Clone, Debug, Default)]
pub(super) struct Outline {
    pub nodes: Vec<Node>,
    pub arcs: Vec<Arc>,
    pub loops: Vec<Loop>,
    free: Vec<u32>,
}

impl Outline {
    /// The outline of `region`; radius and pins are for the caller to fill in.
    pub fn new(region: &Region) -> Outline {
        let mut outline = Outline::default();
        for ring in &region.rings {
            let mut vertices = ring.vertices.clone();
            // An edge without length has no direction.
            let points: Vec<Point> = vertices.iter().map(|v| v.point).collect();
            let mut k = 0;
            vertices.retain(|v| {
                k += 1;
                v.link != Link::Line || v.point != points[k % points.len()]
            });
            if vertices.len() < 2 {
                continue;
            }
            outline.push_loop(&vertices);
        }
        outline
    }

    fn push_loop(&mut self, vertices: &[Vertex]) {
        let (first, count) = (self.nodes.len() as u32, vertices.len() as u32);
        let ring = self.loops.len() as u32;
        for (k, v) in (0..).zip(vertices) {
            let arc = match v.link {
                Link::Line => NONE,
                Link::Arc(arc) => {
                    self.arcs.push(arc);
                    self.arcs.len() as u32 - 1
                }
            };
            self.nodes.push(Node {
                point: v.point,
                radius: 0.0,
                field_radius: 0.0,
                prev: first + (k + count - 1) % count,
                next: first + (k + 1) % count,
                ring,
                arc,
                origin: v.id,
                joint: v.joint,
                pinned: false,
                born: false,
                moved: false,
                bridge: false,
                whole: true,
                dead: false,
            });
        }
        let start = vertices[0].point;
        let corners = vertices.iter().map(|v| v.point - start);
        let doubled_area = corners.clone().zip(corners.skip(1)).map(|(a, b)| a.perp(&b)).sum();
        let sign = Ring { vertices: vertices.to_vec() }.area().signum();
        self.loops.push(Loop { first, count, doubled_area, sign });
    }

    #[inline]
    pub fn node(&self, i: u32) -> &Node {
        &self.nodes[i as usize]
    }

    #[inline]
    pub fn node_mut(&mut self, i: u32) -> &mut Node {
        &mut self.nodes[i as usize]
    }

    /// The edge that leaves `i`.
    pub fn edge(&self, i: u32) -> Segment {
        let node = self.node(i);
        let link = if node.arc == NONE { Link::Line } else { Link::Arc(self.arcs[node.arc as usize]) };
        Segment { start: node.point, end: self.node(node.next).point, link }
    }

    /// Whether the edge that leaves `i` is part of the drawing's own.
    pub fn is_still(&self, i: u32) -> bool {
        let node = self.node(i);
        !node.bridge && !node.moved && !self.node(node.next).moved
    }

    /// Puts a node on the edge that leaves `i`, at the part `t` of its length; its number.
    pub fn insert(&mut self, i: u32, t: f64) -> u32 {
        let (edge, still) = (self.edge(i), self.is_still(i));
        let next = self.node(i).next;
        let node = self.node_mut(i);
        node.whole = false;
        // A chord between moved vertices is no part of the drawing, and neither is what is put on it.
        let new = Node { point: edge.point_at(t), prev: i, next, born: true, moved: !still, pinned: false, ..*node };
        let slot = match self.free.pop() {
            Some(slot) => slot,
            None => {
                self.nodes.push(new);
                self.nodes.len() as u32 - 1
            }
        };
        *self.node_mut(slot) = new;
        self.loops[new.ring as usize].doubled_area += (new.point - edge.start).perp(&(edge.end - edge.start));
        self.node_mut(i).next = slot;
        self.node_mut(next).prev = slot;
        self.loops[new.ring as usize].count += 1;
        slot
    }

    /// Moves a node; its edges become chords.
    pub fn displace(&mut self, i: u32, by: Vector) {
        let Node { prev, next, ring, .. } = *self.node(i);
        let across = self.node(next).point - self.node(prev).point;
        self.loops[ring as usize].doubled_area += by.perp(&across);
        let node = self.node_mut(i);
        node.point += by;
        (node.moved, node.arc, node.whole) = (true, NONE, false);
        let before = self.node_mut(prev);
        (before.arc, before.whole) = (NONE, false);
    }

    /// Takes a node away; a straight edge bridges it.
    pub fn remove(&mut self, i: u32) {
        let Node { prev, next, ring, point, .. } = *self.node(i);
        let start = self.node(prev).point;
        let ear = (point - start).perp(&(self.node(next).point - start));
        let before = self.node_mut(prev);
        (before.next, before.arc, before.bridge, before.whole) = (next, NONE, true, false);
        self.node_mut(next).prev = prev;
        self.node_mut(i).dead = true;
        self.free.push(i);
        let ring = &mut self.loops[ring as usize];
        ring.doubled_area -= ear;
        ring.count -= 1;
        if ring.first == i {
            ring.first = next;
        }
    }

    /// Takes a whole ring away.
    pub fn remove_loop(&mut self, ring: u32) {
        for i in self.walk(ring).collect::<Vec<_>>() {
            self.node_mut(i).dead = true;
            self.free.push(i);
        }
        let gone = &mut self.loops[ring as usize];
        (gone.first, gone.count) = (NONE, 0);
    }

    /// Whether a ring runs around its area the other way than at the start: it has shrunk to nothing, and what is left of it
    /// are vertices that had no reason to move, with chords across.
    pub fn has_turned_over(&self, ring: u32) -> bool {
        let Loop { doubled_area, sign, .. } = self.loops[ring as usize];
        // Arcs count only where the chords alone, which cost nothing to follow, say so.
        doubled_area * sign < 0.0 && {
            let origin = self.walk(ring).next().map_or(Vector::zeros(), |i| self.node(i).point.coords);
            let area: f64 = self.walk(ring).map(|i| self.edge(i).translated(-origin).doubled_area()).sum();
            area * sign < 0.0 && !self.walk(ring).any(|i| self.node(i).pinned)
        }
    }

    /// The nodes of a ring in order.
    pub fn walk(&self, ring: u32) -> impl Iterator<Item = u32> + '_ {
        let Loop { first, count, .. } = self.loops[ring as usize];
        std::iter::successors((first != NONE).then_some(first), |i| Some(self.node(*i).next)).take(count as usize)
    }

    /// The nodes of a ring that a region needs, in order: those that were put on an edge are left out where the edge is still
    /// all there.
    pub fn needed(&self, ring: u32) -> impl Iterator<Item = u32> + '_ {
        self.walk(ring).filter(|&i| {
            let node = self.node(i);
            !node.born || !self.is_still(i) || !self.is_still(node.prev)
        })
    }

    /// A node as a vertex of a region, with the edge that leaves it. What did not move has the link and the identity that
    /// it had.
    pub fn vertex(&self, i: u32) -> Vertex {
        let node = self.node(i);
        let in_place = !node.born && !node.moved;
        Vertex {
            point: node.point,
            link: self.edge(i).link,
            joint: if in_place { node.joint } else { Joint::Corner },
            id: node.origin.filter(|_| in_place),
        }
    }

    /// The region as it is now, with chords where it moved.
    pub fn region(&self) -> Region {
        let ring = |ring| Ring { vertices: self.needed(ring).map(|i| self.vertex(i)).collect() };
        let rings = (0..self.loops.len() as u32).map(ring);
        Region::new(rings.filter(|r| r.len() > 1).collect())
    }
}
