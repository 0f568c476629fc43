//! Rings that cross become one: the boundary of what is solid on the left of any of them.
//!
//! The same walks as in the merge, along the boundary itself in place of the locus: drawn back a little, so that what
//! only touches does not cross. What winding numbers say of every stretch is held against the walks.

use super::crossings::crossings;
use super::locus::{Locus, Piece, TINY};
use super::loops::{Event, Itinerary};
use super::merge::ROUNDING_STEPS;
use super::track::Track;
use crate::plane::{BoundaryIndex, Joint, Link, Point, Region, Ring, Vertex};

/// Rings meet that overlap by twice this, relative to the radius: those that only touch have not run into each other.
const MEETING: f64 = 1e-7;

/// A crossing of the links themselves lies at most this far, relative to the radius, from where they cross drawn back.
const SAME_PLACE: f64 = 1e-3;

/// A stretch shorter than this, relative to the radius, is too near to its crossings for a winding number to contradict
/// anything.
const TELLING: f64 = 1e-4;

/// The angle (radians) by which a part of an arc may exceed the arc by rounding.
const MORE: f64 = 1e-3;

/// Where the rings of a region cross each other, or themselves.
pub(super) struct Meetings<'a> {
    region: &'a Region,
    r: f64,
    locus: Locus,
    events: Vec<Event>,
}

/// A ring that crossing rings bound together.
pub(super) struct United {
    pub(super) ring: Ring,
    /// One of the rings of the region that it consists of.
    pub(super) of: usize,
}

impl<'a> Meetings<'a> {
    /// The crossings of pairs of rings (by their indices) that `counts` accepts, of boundaries that overlap by more than
    /// [`MEETING`].
    pub(super) fn new(
        region: &'a Region,
        r: f64,
        resolution: f64,
        counts: impl Fn(usize, usize) -> bool,
    ) -> Meetings<'a> {
        let noise = ROUNDING_STEPS * resolution;
        let locus = Locus::new(region, -(MEETING * r + noise), TINY * r + noise);
        let ring = |e: &Event| locus.pieces[e.piece as usize].ring as usize;
        let mut events = vec![];
        for pair in crossings(&locus, r).chunks_exact(2) {
            if counts(ring(&pair[0]), ring(&pair[1])) {
                let k = events.len() as u32;
                events.extend([Event { twin: k + 1, ..pair[0] }, Event { twin: k, ..pair[1] }]);
            }
        }
        Meetings { region, r, locus, events }
    }

    /// The two rings of every crossing, and where it is.
    pub(super) fn places(&self) -> impl Iterator<Item = (usize, usize, Point)> + '_ {
        self.events.chunks_exact(2).map(|e| (self.ring(&e[0]), self.ring(&e[1]), e[0].point))
    }

    /// What all rings that cross bound together, in a plane that winds `far` times around every place; and rings of which
    /// rounding leaves it open.
    pub(super) fn united(&self, far: i32) -> (Vec<United>, Vec<usize>) {
        let index = BoundaryIndex::new(self.region);
        let itinerary = Itinerary::new(&self.events, |p| self.locus.pieces[p as usize].ring);
        // Drawn back into its own solid, the boundary of the union lies in that of no other.
        let bounds: Vec<Option<bool>> = (0..self.events.len())
            .map(|e| {
                let (p, length) = self.sample(e, &itinerary);
                (length > TELLING * self.r).then(|| index.winding_number(p) + far == 1)
            })
            .collect();
        let mut walked = vec![false; self.events.len()];
        let mut united = vec![];
        let mut open = vec![];
        for walk in itinerary.walks(&self.events, true) {
            let says = |answer: bool| walk.iter().any(|&e| bounds[e as usize] == Some(answer));
            let of = self.ring(&self.events[walk[0] as usize]);
            if says(true) && says(false) {
                open.push(of);
            }
            if says(true) {
                walk.iter().for_each(|&e| walked[e as usize] = true);
                united.push(United { ring: self.along(&walk, &itinerary), of });
            }
        }
        let left_out = (0..self.events.len()).filter(|&e| bounds[e] == Some(true) && !walked[e]);
        open.extend(left_out.map(|e| self.ring(&self.events[e])));
        (united, open)
    }

    fn piece(&self, e: &Event) -> &Piece {
        &self.locus.pieces[e.piece as usize]
    }

    fn ring(&self, e: &Event) -> usize {
        self.piece(e).ring as usize
    }

    /// The ends of the stretch from event `e` to the next, and whether it lies on one piece.
    fn stretch(&self, e: usize, itinerary: &Itinerary) -> (&Event, &Event, bool) {
        let (from, to) = (&self.events[e], &self.events[itinerary.next[e] as usize]);
        (from, to, from.piece == to.piece && to.at > from.at)
    }

    /// The middle of the longest part of a stretch that lies on one piece, and the length of that part.
    fn sample(&self, e: usize, itinerary: &Itinerary) -> (Point, f64) {
        let (from, to, on_one_piece) = self.stretch(e, itinerary);
        let (first, last) = (self.piece(from), self.piece(to));
        let part = |p: &Piece, a: f64, b: f64| {
            let scale = if p.bend == 0.0 { 1.0 } else { p.radius };
            (p.at(0.5 * (a + b)), (b - a) * scale)
        };
        if on_one_piece {
            return part(first, from.at, to.at);
        }
        let ring = &self.locus.rings[first.ring as usize];
        let n = ring.end - ring.start;
        let between = (to.piece + n - from.piece + n - 1) % n;
        let whole = (0..between).map(|k| {
            let p = &self.locus.pieces[(ring.start + (from.piece - ring.start + 1 + k) % n) as usize];
            part(p, 0.0, p.extent())
        });
        let ends = [part(first, from.at, first.extent()), part(last, 0.0, to.at)];
        let longest = whole.chain(ends).max_by(|a, b| a.1.total_cmp(&b.1));
        longest.unwrap_or((from.point, 0.0))
    }

    /// The ring along a walk.
    fn along(&self, walk: &[u32], itinerary: &Itinerary) -> Ring {
        let mut vertices: Vec<Vertex> = vec![];
        for &e in walk {
            let (from, to, on_one_piece) = self.stretch(e as usize, itinerary);
            let ring = &self.region.rings[self.ring(from)];
            let n = ring.len();
            let (i, j) = (self.piece(from).node as usize, self.piece(to).node as usize);
            let end = self.crossing(to);
            let start = Vertex { point: self.crossing(from), joint: Joint::Corner, id: None, ..ring.vertices[i] };
            let count = if on_one_piece { 0 } else { (j + n - (i + 1) % n) % n + 1 };
            let stretch = std::iter::once(start).chain((0..count).map(|k| ring.vertices[(i + 1 + k) % n]));
            let first = vertices.len();
            vertices.extend(stretch);
            // A part of an arc that rounding has turned around is none.
            for (k, whole) in [(first, i), (vertices.len() - 1, j)] {
                let next = vertices.get(k + 1).map_or(end, |v| v.point);
                if let Link::Arc(arc) = vertices[k].link
                    && arc.angle_between(vertices[k].point, next) > ring.segment(whole).sweep() + MORE
                {
                    vertices[k].link = Link::Line;
                }
            }
        }
        Ring { vertices }
    }

    /// Where the links themselves cross that do drawn back.
    fn crossing(&self, e: &Event) -> Point {
        // The same to the last bit for both events of a crossing.
        let twin = &self.events[e.twin as usize];
        let (e, twin) = if e.twin % 2 == 1 { (e, twin) } else { (twin, e) };
        let carrier =
            |e: &Event| Track::new(self.region.rings[self.ring(e)].segment(self.piece(e).node as usize)).carrier(0.0);
        let roots = carrier(e).roots(&carrier(twin), MEETING * self.r);
        let near = |p: &Point| (p - e.point).norm() <= SAME_PLACE * self.r;
        roots.nearest(e.point).filter(near).unwrap_or(e.point)
    }
}
