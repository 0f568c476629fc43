//! The second trim: new arcs that cross each other.
//!
//! Where a neck is filled from both sides and the disks on the two sides overlap, their arcs cross, and the filled part
//! falls into pieces between. Old boundary is never crossed by a new arc: no free disk holds a point of it. So only new
//! arcs are held against each other. The rule of the first pass is mirrored: the boundary enters a crossing along the
//! piece by which it left there.

use std::collections::HashMap;

use super::carrier::circle_circle;
use super::loops::{Event, Itinerary};
use crate::plane::{Arc, Joint, Link, Point, Ring, Turn, Vertex};

/// A vertex on its way through the merge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knot {
    pub(super) vertex: Vertex,
    /// The crossing of the locus whose centre the link that leaves here turns about, where that link is new.
    pub(super) born: Option<u32>,
}

/// A vertex at which one new arc leaves and another arrives, facing each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tip {
    /// The arc born at this crossing leaves the vertex.
    pub(super) leaving: u32,
    /// The arc born at this crossing arrives at it.
    pub(super) arriving: u32,
}

/// Rings without crossings.
pub(super) struct Trimmed {
    pub(super) rings: Vec<Ring>,
    /// Stretches of new arcs whose place contradicts what was made of them.
    pub(super) contradictions: usize,
}

/// A crossing nearer than this to an end of both arcs, relative to the radius, is their common end.
const COMMON_END: f64 = 1e-7;

/// A sample of an arc deeper than this in a free disk, relative to the radius, is not on the boundary.
const INSIDE: f64 = 1e-6;

/// Stretches shorter than this, relative to the radius, are too near to their crossings to contradict anything.
const TELLING: f64 = 1e-3;

/// An arc that seems to run around almost all of the circle has no length: a new arc sweeps less than half a turn.
const ALL_AROUND: f64 = 1.5 * std::f64::consts::PI;

/// A new arc with its place in the rings.
struct NewArc {
    ring: usize,
    index: usize,
    arc: Arc,
    start: Point,
    end: Point,
    sweep: f64,
}

/// Takes away what lies inside the free disks of other new arcs.
pub(super) fn trim(rings: Vec<Vec<Knot>>, tips: &[Tip], r: f64) -> Trimmed {
    let arcs = new_arcs(&rings);
    let by_x = sorted_by_x(&arcs);
    let mut events = arc_crossings(&arcs, &by_x, r);
    meet_at_tips(&rings, &arcs, tips, &mut events);
    if events.is_empty() {
        return Trimmed { rings: rings.into_iter().filter_map(finish).collect(), contradictions: 0 };
    }
    let itinerary = Itinerary::new(&events, |k| arcs[k as usize].ring as u32);
    let walks = itinerary.walks(&events, false);
    let mut crossed = vec![false; rings.len()];
    for e in &events {
        crossed[arcs[e.piece as usize].ring] = true;
    }
    let covered = |p: Point| in_free_disk(p, &arcs, &by_x, r);
    let mut out = vec![];
    let mut kept = vec![false; events.len()];
    for walk in &walks {
        let mut knots = vec![];
        let mut old = false;
        for &e in walk {
            old |= stretch(&rings, &arcs, &events, &itinerary, e, &mut knots);
        }
        // Arcs alone can bound a space between free disks, or one inside them.
        let free = old || !covered(middle(&arcs, &events, &itinerary, walk[0]).0);
        if free {
            walk.iter().for_each(|&e| kept[e as usize] = true);
            out.push(knots);
        }
    }
    let mut contradictions = 0;
    for e in 0..events.len() as u32 {
        let (p, length) = middle(&arcs, &events, &itinerary, e);
        if length > TELLING * r && covered(p) == kept[e as usize] {
            contradictions += 1;
        }
    }
    out.extend(rings.into_iter().zip(crossed).filter(|(_, crossed)| !crossed).map(|(knots, _)| knots));
    Trimmed { rings: out.into_iter().filter_map(finish).collect(), contradictions }
}

fn new_arcs(rings: &[Vec<Knot>]) -> Vec<NewArc> {
    let mut arcs = vec![];
    for (ring, knots) in rings.iter().enumerate() {
        for (index, knot) in knots.iter().enumerate() {
            if let (Some(_), Link::Arc(arc)) = (knot.born, knot.vertex.link) {
                let (start, end) = (knot.vertex.point, knots[(index + 1) % knots.len()].vertex.point);
                let sweep = arc.angle_between(start, end);
                let sweep = if sweep > ALL_AROUND { 0.0 } else { sweep };
                arcs.push(NewArc { ring, index, arc, start, end, sweep });
            }
        }
    }
    arcs
}

fn sorted_by_x(arcs: &[NewArc]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..arcs.len()).collect();
    order.sort_by(|&a, &b| arcs[a].arc.center.x.total_cmp(&arcs[b].arc.center.x));
    order
}

fn arc_crossings(arcs: &[NewArc], by_x: &[usize], r: f64) -> Vec<Event> {
    let mut events = vec![];
    for (k, &i) in by_x.iter().enumerate() {
        for &j in &by_x[k + 1..] {
            let (a, b) = (&arcs[i], &arcs[j]);
            let d = b.arc.center - a.arc.center;
            if d.x >= 2.0 * r {
                break;
            }
            // Two arcs about one centre do not cross.
            if d.norm_squared() < (COMMON_END * r * 1e-2).powi(2) {
                continue;
            }
            let roots = circle_circle(a.arc.center, r, b.arc.center, r, 0.0);
            // Disks that touch do not cross, and no sign tells by which of two arcs the boundary would go on.
            let mut points = roots.iter();
            if let (Some(x), Some(y)) = (points.next(), points.next())
                && (x - y).norm() <= COMMON_END * r
            {
                continue;
            }
            for x in roots.iter() {
                let (s, t) = (a.arc.angle_between(a.start, x), b.arc.angle_between(b.start, x));
                if s >= a.sweep || t >= b.sweep {
                    continue;
                }
                let at_end = |arc: &NewArc| (x - arc.start).norm().min((x - arc.end).norm()) < COMMON_END * r;
                if at_end(a) && at_end(b) {
                    continue;
                }
                let leaves = a.arc.tangent_at(x).perp(&b.arc.tangent_at(x)) > 0.0;
                let k = events.len() as u32;
                events.push(Event { piece: i as u32, at: s, point: x, twin: k + 1, leaves });
                events.push(Event { piece: j as u32, at: t, point: x, twin: k, leaves: !leaves });
            }
        }
    }
    events
}

/// At facing tips the walk goes over from the arriving arc to the leaving one's other side.
fn meet_at_tips(rings: &[Vec<Knot>], arcs: &[NewArc], tips: &[Tip], events: &mut Vec<Event>) {
    if tips.is_empty() {
        return;
    }
    let by_birth: HashMap<u32, usize> =
        arcs.iter().enumerate().filter_map(|(k, a)| Some((rings[a.ring][a.index].born?, k))).collect();
    for tip in tips {
        if let (Some(&i), Some(&j)) = (by_birth.get(&tip.leaving), by_birth.get(&tip.arriving)) {
            let k = events.len() as u32;
            events.push(Event { piece: i as u32, at: 0.0, point: arcs[i].start, twin: k + 1, leaves: true });
            let (at, point) = (arcs[j].sweep, arcs[j].end);
            events.push(Event { piece: j as u32, at, point, twin: k, leaves: false });
        }
    }
}

/// Appends the knots from event `e` to the next one; tells whether old boundary is among them.
fn stretch(
    rings: &[Vec<Knot>],
    arcs: &[NewArc],
    events: &[Event],
    itinerary: &Itinerary,
    e: u32,
    knots: &mut Vec<Knot>,
) -> bool {
    let (from, to) = (&events[e as usize], &events[itinerary.next[e as usize] as usize]);
    let (first, last) = (&arcs[from.piece as usize], &arcs[to.piece as usize]);
    if from.at < first.sweep {
        let vertex = Vertex { point: from.point, link: Link::Arc(first.arc), joint: Joint::Corner, id: None };
        knots.push(Knot { vertex, born: None });
    }
    if from.piece == to.piece && to.at > from.at {
        return false;
    }
    let ring = &rings[first.ring];
    let n = ring.len();
    let start = (first.index + 1) % n;
    let count = (last.index + n - start) % n + 1;
    knots.extend((0..count).map(|k| ring[(start + k) % n]));
    if to.at == 0.0 {
        knots.pop();
    }
    true
}

/// The middle of the longest arc part of a stretch, and the length of that part.
fn middle(arcs: &[NewArc], events: &[Event], itinerary: &Itinerary, e: u32) -> (Point, f64) {
    let (from, to) = (&events[e as usize], &events[itinerary.next[e as usize] as usize]);
    let (first, last) = (&arcs[from.piece as usize], &arcs[to.piece as usize]);
    let at = |a: &NewArc, s: f64, t: f64| (a.arc.travel(a.start, 0.5 * (s + t)), (t - s) * a.arc.radius);
    if from.piece == to.piece && to.at > from.at {
        return at(first, from.at, to.at);
    }
    let (head, tail) = (at(first, from.at, first.sweep), at(last, 0.0, to.at));
    if head.1 >= tail.1 { head } else { tail }
}

fn in_free_disk(p: Point, arcs: &[NewArc], by_x: &[usize], r: f64) -> bool {
    let first = by_x.partition_point(|&k| arcs[k].arc.center.x < p.x - r);
    by_x[first..]
        .iter()
        .take_while(|&&k| arcs[k].arc.center.x <= p.x + r)
        .any(|&k| (arcs[k].arc.center - p).norm() < r * (1.0 - INSIDE))
}

/// A ring of the knots without links of no length.
fn finish(knots: Vec<Knot>) -> Option<Ring> {
    let mut vertices: Vec<Vertex> = Vec::with_capacity(knots.len());
    let n = knots.len();
    for (i, knot) in knots.iter().enumerate() {
        let mut vertex = knot.vertex;
        let next = knots[(i + 1) % n].vertex.point;
        if let (Some(_), Link::Arc(arc)) = (knot.born, vertex.link)
            && arc.turn == Turn::Right
            && arc.angle_between(vertex.point, next) > ALL_AROUND
        {
            vertex.link = Link::Line;
        }
        if let Some(before) = vertices.last_mut()
            && before.point == vertex.point
        {
            // The link between has no length; the one that goes on is the later one.
            *before = Vertex { id: before.id.or(vertex.id), ..vertex };
            continue;
        }
        vertices.push(vertex);
    }
    while vertices.len() > 1 && vertices[0].point == vertices[vertices.len() - 1].point {
        let last = vertices.pop()?;
        vertices[0].id = vertices[0].id.or(last.id);
    }
    (vertices.len() > 1).then_some(Ring { vertices })
}
