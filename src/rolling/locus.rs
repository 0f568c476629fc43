//! The locus: the path of the disk's centre while the disk rolls along every ring.
//!
//! The boundary of the input dilated by the disk lies on it. Each vertex gives an arc about itself, each straight link
//! a parallel line, each arc a concentric arc; where the boundary turns away from the disk (a concave vertex) the path
//! runs backwards. Consecutive pieces share their end points bit for bit.

use std::f64::consts::{PI, TAU};

use super::carrier::Carrier;
use super::samples::{STUCK, is_followed};
use crate::plane::turn_angle;
use crate::plane::{Arc, Bounds, Link, Point, Region, Ring, Segment, Turn, Vector, left_normal, right_normal};

/// Pieces shorter than this, relative to the radius, are left out: they have no direction worth the name.
pub(super) const TINY: f64 = 2e-9;

/// A turn this near to half a turn to the right is one to the left: the tip of a spike, not the end of a slit.
const TIP: f64 = 1e-7;

/// Rings that touch at a vertex would share a piece of the locus, and what coincides does not cross. So each ring has a
/// radius of its own, smaller by up to this much, relative to it.
pub(super) const RING_SPREAD: f64 = 1e-9;

/// What of the boundary the disk touches along a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Touch {
    /// A vertex.
    Vertex,
    /// The link that leaves a vertex.
    Link,
    /// The whole of an arc of the disk's own radius.
    Stuck,
}

/// A piece of the locus: straight where `bend` is 0, else an arc.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) start: Point,
    pub(super) end: Point,
    /// Centre and radius of an arc.
    pub(super) center: Point,
    pub(super) radius: f64,
    /// +1 counterclockwise, -1 clockwise, 0 straight.
    pub(super) bend: f64,
    /// Angle swept (radians), not negative.
    pub(super) sweep: f64,
    /// Absolute turn between the previous piece's end and this one's start.
    pub(super) joint: f64,
    pub(super) ring: u32,
    /// The vertex touched, or from which the touched link leaves.
    pub(super) node: u32,
    pub(super) touch: Touch,
}

impl Piece {
    /// Length, or angle for an arc: the range of the parameter.
    pub(super) fn extent(&self) -> f64 {
        if self.bend == 0.0 { (self.end - self.start).norm() } else { self.sweep }
    }

    /// Arc length.
    pub(super) fn length(&self) -> f64 {
        if self.bend == 0.0 { (self.end - self.start).norm() } else { self.sweep * self.radius }
    }

    /// The point at a parameter (a length, or an angle for an arc).
    pub(super) fn at(&self, parameter: f64) -> Point {
        if self.bend == 0.0 {
            return self.start + self.tangent_line() * parameter;
        }
        let spoke = (self.start - self.center).normalize();
        let (sin, cos) = (self.bend * parameter).sin_cos();
        self.center + Vector::new(cos * spoke.x - sin * spoke.y, sin * spoke.x + cos * spoke.y) * self.radius
    }

    fn tangent_line(&self) -> Vector {
        (self.end - self.start).try_normalize(0.0).unwrap_or(Vector::x())
    }

    /// Direction of travel at a point of the piece; not normalised on an arc.
    #[inline]
    pub(super) fn tangent(&self, p: Point) -> Vector {
        if self.bend == 0.0 { self.end - self.start } else { left_normal(p - self.center) * self.bend }
    }

    pub(super) fn bounds(&self) -> Bounds {
        let ends = Bounds::of_points([self.start, self.end]);
        if self.bend == 0.0 {
            return ends;
        }
        if self.sweep < 1.0 {
            // A short arc stays within its sagitta of the chord: r (1 - cos φ/2), at most r φ²/8.
            return ends.inflated(self.radius * self.sweep * self.sweep * 0.125);
        }
        let turn = if self.bend > 0.0 { Turn::Left } else { Turn::Right };
        let arc = Arc { center: self.center, radius: self.radius, turn };
        Segment { start: self.start, end: self.end, link: Link::Arc(arc) }.bounds()
    }
}

/// All pieces; those of one ring stand together, in order, and near those of rings that start near it.
#[derive(Clone, Debug, Default)]
pub(super) struct Locus {
    pub(super) pieces: Vec<Piece>,
    /// The range of pieces of each ring.
    pub(super) rings: Vec<std::ops::Range<u32>>,
}

impl Locus {
    /// The locus of a disk of radius `r` on the right side of all rings of `region`; lengths below `tiny` mean nothing. At a
    /// tiny negative radius it is the boundary itself, drawn back a little.
    pub(super) fn new(region: &Region, r: f64, tiny: f64) -> Locus {
        let rings = vec![0..0; region.rings.len()];
        let mut locus = Locus { pieces: Vec::with_capacity(2 * region.vertex_count()), rings };
        for index in region.order_of_place() {
            // The golden ratio keeps all rings apart.
            let place = (index as f64 * 0.618_033_988_749_895).fract();
            locus.add_ring(&region.rings[index], index as u32, r * (1.0 - RING_SPREAD * place), tiny);
        }
        locus
    }

    fn add_ring(&mut self, ring: &Ring, index: u32, r: f64, tiny: f64) {
        let first = self.pieces.len();
        let n = ring.len();
        if n >= 2 {
            let mut path = Path { pieces: &mut self.pieces, ring: index, tiny, last: None, rough: false };
            let mut link = Directed::new(ring.segment(0));
            let mut passage = Passage::new(ring, 0, &Directed::new(ring.segment(n - 1)), &link, r);
            for i in 0..n {
                path.vertex(&passage, link.segment.start, i as u32, r);
                let j = if i + 1 == n { 0 } else { i + 1 };
                let next = Directed::new(ring.segment(j));
                passage = Passage::new(ring, j, &link, &next, r);
                path.link(&link.segment, passage.arrive, i as u32, r);
                link = next;
            }
        }
        // A locus of one piece is a point: nothing can cross it.
        if self.pieces.len() - first < 2 {
            self.pieces.truncate(first);
        } else {
            let last = self.pieces.len() - 1;
            self.pieces[last].end = self.pieces[first].start;
            let (tail, head) = (self.pieces[last], self.pieces[first]);
            self.pieces[first].joint = turn_angle(tail.tangent(tail.end), head.tangent(head.start)).abs();
        }
        self.rings[index as usize] = first as u32..self.pieces.len() as u32;
    }

    /// Where the centre of a disk of radius `r` runs that touches what `piece` touches, at exactly `r`.
    pub(super) fn carrier(piece: &Piece, region: &Region, r: f64) -> Carrier {
        let ring = &region.rings[piece.ring as usize];
        let node = piece.node as usize;
        match piece.touch {
            Touch::Vertex => Carrier::Circle(ring.vertices[node].point, r),
            Touch::Link | Touch::Stuck => super::track::Track::new(ring.segment(node)).carrier(r),
        }
    }
}

/// A link with its directions: both are asked for at both of its ends, and cost a root each.
struct Directed {
    segment: Segment,
    at_start: Vector,
    at_end: Vector,
}

impl Directed {
    #[inline]
    fn new(segment: Segment) -> Directed {
        let at_start = segment.start_tangent();
        let at_end = if segment.link == Link::Line { at_start } else { segment.end_tangent() };
        Directed { segment, at_start, at_end }
    }
}

/// How the centre passes a vertex.
struct Passage {
    /// Where it arrives from the incoming link.
    arrive: Point,
    /// Where it leaves along the outgoing link.
    leave: Point,
    /// The turn between, positive to the left.
    turn: f64,
}

impl Passage {
    #[inline]
    fn new(ring: &Ring, vertex: usize, incoming: &Directed, outgoing: &Directed, r: f64) -> Passage {
        let (u, v) = (incoming.at_end, outgoing.at_start);
        let p = outgoing.segment.start;
        let mut turn = if u == v { 0.0 } else { turn_angle(u, v) };
        if turn < -PI + TIP {
            turn += TAU;
        }
        if turn < 0.0 && is_followed(ring, vertex, r) {
            // The two parallels meet: the disk passes on the curve that the chords stand for.
            let bisector = right_normal(u) + right_normal(v);
            let meet = p + bisector * (2.0 * r / bisector.norm_squared());
            return Passage { arrive: meet, leave: meet, turn: 0.0 };
        }
        Passage { arrive: p + right_normal(u) * r, leave: p + right_normal(v) * r, turn }
    }
}

/// The pieces of one ring while they are laid down.
struct Path<'a> {
    pieces: &'a mut Vec<Piece>,
    ring: u32,
    tiny: f64,
    /// End of the last piece.
    last: Option<Point>,
    /// Whether the direction may have jumped since the last piece.
    rough: bool,
}

impl Path<'_> {
    fn push(&mut self, piece: Piece) {
        self.last = Some(piece.end);
        self.pieces.push(piece);
        let n = self.pieces.len();
        if n >= 2 && self.pieces[n - 2].ring == self.ring {
            let before = self.pieces[n - 2];
            let after = &mut self.pieces[n - 1];
            // Pieces that run forwards follow each other along one tangent: only the others need the angle.
            if self.rough {
                after.joint = turn_angle(before.tangent(before.end), after.tangent(after.start)).abs();
            }
        }
        self.rough = false;
    }

    fn vertex(&mut self, passage: &Passage, p: Point, node: u32, r: f64) {
        let start = *self.last.get_or_insert(passage.arrive);
        let sweep = passage.turn.abs();
        if sweep * r <= self.tiny {
            // A mitred joint turns without an arc.
            self.rough = true;
            return;
        }
        let bend = passage.turn.signum();
        self.rough |= bend < 0.0;
        self.push(Piece {
            start,
            end: passage.leave,
            center: p,
            radius: r,
            bend,
            sweep,
            joint: 0.0,
            ring: self.ring,
            node,
            touch: Touch::Vertex,
        });
        self.rough |= bend < 0.0;
    }

    fn link(&mut self, segment: &Segment, end: Point, node: u32, r: f64) {
        let start = self.last.unwrap_or(end);
        let mut piece = Piece {
            start,
            end,
            center: start,
            radius: 0.0,
            bend: 0.0,
            sweep: 0.0,
            joint: 0.0,
            ring: self.ring,
            node,
            touch: Touch::Link,
        };
        if let Link::Arc(arc) = segment.link {
            let offset = arc.radius + arc.turn.sign() * r;
            if offset.abs() <= STUCK * r {
                piece.touch = Touch::Stuck;
                self.rough = true;
            } else {
                piece.center = arc.center;
                piece.radius = offset.abs();
                piece.bend = arc.turn.sign();
                piece.sweep = segment.sweep();
                // A concave arc below the radius is run through backwards.
                self.rough |= offset < 0.0;
            }
        }
        if piece.length() <= self.tiny {
            self.rough = true;
            return;
        }
        let backwards = piece.touch == Touch::Stuck || (piece.bend < 0.0 && self.rough);
        self.push(piece);
        self.rough |= backwards;
    }
}
