//! Necks: places that the disk cannot pass although both sides are closed.
//!
//! On either side of a neck the disk comes to rest, and the two resting disks overlap: their circles meet in two points,
//! which become convex corners of the closing, less than a diameter apart. The offset's arcs about these corners cross,
//! and what lies between the crossings is too near to the corner opposite. It is cut out, and the path on either side is
//! joined to itself.

use std::collections::BTreeSet;

use super::OffsetError;
use crate::plane::{Arc, BoundaryIndex, Joint, Link, Point, Region, Ring, Segment, Turn, Vertex, right_normal};

/// Angle in radians within which a crossing counts as the end of an arc. Rounding of the resting disks is far below.
const END_ANGLE: f64 = 1e-7;

/// How much too near, relative to the distance, a stretch has to be to be cut out.
const BLOCKED: f64 = 1e-7;

/// How far apart, relative to the distance, two loose ends may be that are joined.
const LOOSE_END: f64 = 1e-6;

/// An element of the path with the one that follows it.
#[derive(Clone, Copy)]
struct Element {
    segment: Segment,
    joint: Joint,
    next: Option<usize>,
}

/// The rings of an offset of `closed` by `distance`, with the necks cut out.
pub(super) fn cut_necks(rings: Vec<Ring>, closed: &Region, distance: f64) -> Result<Vec<Ring>, OffsetError> {
    let crossings = crossings(&rings, closed, distance);
    if crossings.is_empty() {
        return Ok(rings);
    }
    let index = BoundaryIndex::new(closed);
    let limit = distance * (1.0 - BLOCKED);
    let mut elements: Vec<Element> = Vec::new();
    let mut out: Vec<Ring> = Vec::new();
    let mut crossing = crossings.iter().peekable();
    for (r, ring) in rings.iter().enumerate() {
        if ring.len() < 2 {
            out.push(ring.clone());
            continue;
        }
        let first = elements.len();
        let mut start_kept = false;
        let mut before: Option<usize> = None;
        for i in 0..ring.len() {
            let segment = ring.segment(i);
            let mut angles = Vec::new();
            let mut crossed = false;
            while let Some(c) = crossing.next_if(|c| (c.ring, c.element) == (r, i)) {
                crossed = true;
                angles.push(c.angle);
            }
            let parts = if crossed { split(&segment, &angles) } else { vec![segment] };
            for (k, part) in parts.into_iter().enumerate() {
                if crossed && index.is_nearer(part.point_at(0.5), limit) {
                    before = None;
                    continue;
                }
                if let Some(b) = before {
                    elements[b].next = Some(elements.len());
                }
                start_kept |= i == 0 && k == 0;
                before = Some(elements.len());
                let joint = if k == 0 { ring.vertices[i].joint } else { Joint::Corner };
                elements.push(Element { segment: part, joint, next: None });
            }
        }
        if let Some(last) = before.filter(|_| start_kept) {
            elements[last].next = Some(first);
        }
    }
    join_loose_ends(&mut elements, distance)?;
    out.extend(trace(&elements));
    Ok(out)
}

/// A place where an arc about a corner crosses another.
#[derive(Clone, Copy)]
struct Crossing {
    ring: usize,
    element: usize,
    /// Way along the arc, in radians.
    angle: f64,
}

/// The crossings of arcs about corners of necks with other arcs about corners, in the order of the elements.
fn crossings(rings: &[Ring], closed: &Region, distance: f64) -> Vec<Crossing> {
    let bits = |p: Point| (p.x.to_bits(), p.y.to_bits());
    // Corners between two concave arcs: one of the two corners of a neck always is such.
    let concave = |l: Link| matches!(l, Link::Arc(a) if a.turn == Turn::Right);
    let corners: BTreeSet<(u64, u64)> = closed
        .rings
        .iter()
        .flat_map(|r| (0..r.len()).map(move |i| (r.vertices[i], r.vertices[(i + r.len() - 1) % r.len()].link)))
        .filter(|(v, before)| concave(v.link) && concave(*before))
        .map(|(v, _)| bits(v.point))
        .collect();
    if corners.is_empty() {
        return Vec::new();
    }
    let mut about: Vec<(usize, usize, Segment, Arc)> = Vec::new();
    for (r, ring) in rings.iter().enumerate() {
        for i in 0..ring.len() {
            if let Link::Arc(arc) = ring.vertices[i].link
                && arc.turn == Turn::Left
                && arc.radius == distance
            {
                about.push((r, i, ring.segment(i), arc));
            }
        }
    }
    let mut found = Vec::new();
    for (a, at) in about.iter().enumerate().filter(|(_, at)| corners.contains(&bits(at.3.center))) {
        for (b, other) in about.iter().enumerate() {
            let apart = other.3.center - at.3.center;
            let length = apart.norm();
            if a == b || length >= 2.0 * distance || length == 0.0 {
                continue;
            }
            let height = (distance * distance - 0.25 * length * length).sqrt();
            let across = right_normal(apart) * (height / length);
            let middle = nalgebra::center(&at.3.center, &other.3.center);
            for place in [middle + across, middle - across] {
                if let (Some(p), Some(q)) = (way(at, place), way(other, place)) {
                    found.push(Crossing { ring: at.0, element: at.1, angle: p });
                    found.push(Crossing { ring: other.0, element: other.1, angle: q });
                }
            }
        }
    }
    found.sort_by(|x, y| (x.ring, x.element).cmp(&(y.ring, y.element)).then(x.angle.total_cmp(&y.angle)));
    found
}

/// How far along an arc a point of its circle lies, if it belongs to the arc.
fn way((_, _, segment, arc): &(usize, usize, Segment, Arc), p: Point) -> Option<f64> {
    let (angle, sweep) = (arc.angle_between(segment.start, p), segment.sweep());
    if angle > std::f64::consts::TAU - END_ANGLE {
        return Some(0.0);
    }
    (angle <= sweep + END_ANGLE).then_some(angle.min(sweep))
}

/// An arc cut at angles, those at its ends left aside.
fn split(segment: &Segment, angles: &[f64]) -> Vec<Segment> {
    let Link::Arc(arc) = segment.link else { return vec![*segment] };
    let sweep = segment.sweep();
    let mut parts = Vec::new();
    let (mut start, mut gone) = (segment.start, 0.0);
    for &angle in angles {
        if angle - gone > END_ANGLE && sweep - angle > END_ANGLE {
            let end = arc.travel(segment.start, angle);
            parts.push(Segment { start, end, link: segment.link });
            (start, gone) = (end, angle);
        }
    }
    parts.push(Segment { start, ..*segment });
    parts
}

/// Leads every element without a next one to the loose start at its end.
fn join_loose_ends(elements: &mut [Element], distance: f64) -> Result<(), OffsetError> {
    let mut has_before = vec![false; elements.len()];
    elements.iter().filter_map(|e| e.next).for_each(|n| has_before[n] = true);
    let mut loose: Vec<usize> = (0..elements.len()).filter(|&i| !has_before[i]).collect();
    for i in 0..elements.len() {
        if elements[i].next.is_some() {
            continue;
        }
        let end = elements[i].segment.end;
        let off = |s: usize| (elements[s].segment.start - end).norm();
        let nearest = (0..loose.len()).min_by(|&a, &b| off(loose[a]).total_cmp(&off(loose[b])));
        match nearest.filter(|&slot| off(loose[slot]) <= LOOSE_END * distance) {
            Some(slot) => {
                let start = loose.remove(slot);
                elements[i].next = Some(start);
                elements[start].joint = Joint::Corner;
            }
            None => return Err(OffsetError::NoRoom { at: end }),
        }
    }
    Ok(())
}

/// The rings that the elements make, each beginning at its first element.
fn trace(elements: &[Element]) -> Vec<Ring> {
    let mut seen = vec![false; elements.len()];
    let mut rings = Vec::new();
    for first in 0..elements.len() {
        let mut vertices = Vec::new();
        let mut at = Some(first);
        while let Some(i) = at.filter(|&i| !seen[i]) {
            seen[i] = true;
            let Element { segment, joint, next } = elements[i];
            vertices.push(Vertex { point: segment.start, link: segment.link, joint, id: None });
            at = next;
        }
        if !vertices.is_empty() {
            rings.push(Ring { vertices });
        }
    }
    rings
}
