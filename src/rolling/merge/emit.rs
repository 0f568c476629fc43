//! From a walk of centres back to the boundary that the disk touches on its way.

use super::Attempt;
use crate::plane::{Arc, Link, Point, Ring, Turn, Vertex, VertexId};
use crate::rolling::carrier::Carrier;
use crate::rolling::locus::{Locus, Touch};
use crate::rolling::track::Track;
use crate::rolling::trim::Knot;

/// A centre solved at the exact radius lies at most this far, relative to it, from the crossing: sqrt(2 SHRINK) for
/// carriers that touch, with room.
const SAME_CENTER: f64 = 1e-3;

/// A foot this near to the end of its link, relative to the radius, is the end: the arc then misses its tangent by half
/// the square of it.
const SNAP: f64 = 1e-7;

impl Attempt<'_> {
    /// The centre of the disk at the crossing of `e`, at the exact radius.
    fn center(&mut self, e: u32) -> Point {
        if let Some(center) = self.centers[e as usize] {
            return center;
        }
        let event = self.events[e as usize];
        let carrier = |e: u32| -> Carrier { Locus::carrier(self.piece(e), self.region, self.r) };
        let roots = carrier(e).roots(&carrier(event.twin), SAME_CENTER * self.r);
        let near = |c: &Point| (c - event.point).norm() <= SAME_CENTER * self.r;
        let center = roots.nearest(event.point).filter(near).unwrap_or(event.point);
        self.centers[e as usize] = Some(center);
        self.centers[event.twin as usize] = Some(center);
        center
    }

    /// The boundary that belongs to a walk of centres.
    pub(super) fn emit(&mut self, walk: &[u32], bridges: &mut Vec<Point>) -> Vec<Knot> {
        let mut knots: Vec<Knot> = vec![];
        for &e in walk {
            let f = self.next(e);
            let (start, end) = (self.center(e), self.center(f));
            bridges.push(end);
            let (first, last) = (*self.piece(e), *self.piece(f));
            let ring = &self.region.rings[first.ring as usize];
            let n = ring.len();
            let same = self.on_one_piece(e);
            let (i, j) = (first.node as usize, last.node as usize);
            if first.touch == Touch::Link {
                let (point, id) = self.foot(ring, i, start);
                if same || point != ring.vertices[(i + 1) % n].point {
                    let vertex = Vertex { point, id, ..ring.vertices[i] };
                    knots.push(Knot { vertex, born: None });
                }
            }
            let from = if first.touch == Touch::Vertex { i } else { (i + 1) % n };
            let count = match (same, first.touch, last.touch) {
                (true, Touch::Vertex, _) => 1,
                (true, _, _) => 0,
                // Back to the vertex where it began: the whole ring lies between.
                (false, Touch::Vertex, Touch::Vertex) if i == j => n + 1,
                _ => (j + n - from) % n + 1,
            };
            for k in 0..count {
                knots.push(Knot { vertex: ring.vertices[(from + k) % n], born: None });
            }
            let arc = Link::Arc(Arc { center: end, radius: self.r, turn: Turn::Right });
            if last.touch == Touch::Link {
                let (point, id) = self.foot(ring, j, end);
                if knots.last().is_none_or(|k| k.vertex.point != point) {
                    knots.push(Knot { vertex: Vertex { id, ..Vertex::corner(point) }, born: None });
                }
            }
            if let Some(knot) = knots.last_mut() {
                knot.vertex.link = arc;
                knot.born = Some(f);
            }
        }
        knots
    }

    /// Where the disk about `center` touches the link that leaves vertex `i`; an end of the link keeps its identity.
    fn foot(&self, ring: &Ring, i: usize, center: Point) -> (Point, Option<VertexId>) {
        let track = Track::new(ring.segment(i));
        let contact = track.contact(center);
        let snap = SNAP * self.r;
        let end = |v: &Vertex| (v.point, v.id);
        if contact.at <= snap {
            end(&ring.vertices[i])
        } else if contact.at >= track.length - snap {
            end(&ring.vertices[(i + 1) % ring.len()])
        } else {
            (contact.point, None)
        }
    }
}
