//! Necks: places that the disk cannot pass although both sides are closed.
//!
//! On either side of a neck the disk comes to rest, and the two resting disks overlap: their circles meet in two points,
//! which become convex corners of the closing, less than a diameter apart. The offset's arcs about these corners cross,
//! and what lies between the crossings is too near to the corner opposite. It is cut out, and the path on either side is
//! joined to itself by an arc about the centre of the resting disk, so that it turns no tighter than elsewhere.

use super::OffsetError;
use crate::plane::{
    Arc, BoundaryIndex, Bounds, ChainTree, Joint, Link, Point, Region, Ring, Segment, Turn, Vector, Vertex,
    right_normal,
};

/// Angle in radians within which a crossing counts as the end of an arc. Rounding of the resting disks is far below.
const END_ANGLE: f64 = 1e-7;

/// Arcs that sweep less than this (radians) are about samples of a curve, on which no disk rests from two sides.
const LEAST_CORNER: f64 = 1e-3;

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
    /// Whether an arc has taken its place.
    is_gone: bool,
}

/// The rings of an offset of `closed` by `distance`, with the necks cut out.
pub(super) fn cut_necks(rings: Vec<Ring>, closed: &Region, distance: f64) -> Result<Vec<Ring>, OffsetError> {
    // No concave feature is tighter than the disk that rested.
    let resting = closed.segments().filter_map(|s| concave_radius(s.link)).fold(f64::INFINITY, f64::min);
    let crossings = crossings(&rings, distance);
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
                elements.push(Element { segment: part, joint, next: None, is_gone: false });
            }
        }
        if let Some(last) = before.filter(|_| start_kept) {
            elements[last].next = Some(first);
        }
    }
    for (end, start) in join_loose_ends(&mut elements, distance)? {
        round(&mut elements, end, start, resting);
    }
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

fn concave_radius(link: Link) -> Option<f64> {
    match link {
        Link::Arc(Arc { radius, turn: Turn::Right, .. }) => Some(radius),
        _ => None,
    }
}

/// An arc of the offset about a corner of the region.
struct About {
    ring: usize,
    element: usize,
    segment: Segment,
    arc: Arc,
    sweep: f64,
    /// Unit direction from the corner to the middle of the arc.
    middle: Vector,
}

/// The crossings of arcs about corners with each other, in the order of the elements.
///
/// The corners of a neck are where new arcs of the closing meet, or corners that the drawing had: the disk rests on the
/// same two corners from either side.
fn crossings(rings: &[Ring], distance: f64) -> Vec<Crossing> {
    let mut about: Vec<About> = Vec::new();
    for (r, ring) in rings.iter().enumerate() {
        for i in 0..ring.len() {
            let segment = ring.segment(i);
            if let Link::Arc(arc) = segment.link
                && arc.turn == Turn::Left
                && arc.radius == distance
                && segment.sweep() > LEAST_CORNER
            {
                let middle = (segment.point_at(0.5) - arc.center) / distance;
                about.push(About { ring: r, element: i, sweep: segment.sweep(), segment, arc, middle });
            }
        }
    }
    // A place that counts as the end of an arc may lie beside it.
    let beside = 2.0 * END_ANGLE * distance;
    let boxes: Vec<Bounds> = about.iter().map(|a| a.segment.bounds().inflated(beside)).collect();
    let tree = ChainTree::new(&boxes);
    // Seen from its corner, a place on an arc lies within half its sweep of its middle.
    let may_hold =
        |a: &About, p: Point| (p - a.arc.center).dot(&a.middle) >= distance * ((0.5 * a.sweep).cos() - END_ANGLE);
    let mut found = Vec::new();
    for (k, a) in about.iter().enumerate() {
        let mut near = Vec::new();
        tree.visit_near_box(&boxes[k], || 0.0, |n| near.extend((n > k && boxes[n].overlaps(&boxes[k])).then_some(n)));
        for b in near.into_iter().map(|n| &about[n]) {
            let apart = b.arc.center - a.arc.center;
            let length = apart.norm();
            if length >= 2.0 * distance || length == 0.0 {
                continue;
            }
            let height = (distance * distance - 0.25 * length * length).sqrt();
            let across = right_normal(apart) * (height / length);
            let middle = nalgebra::center(&a.arc.center, &b.arc.center);
            for place in [middle + across, middle - across] {
                if may_hold(a, place)
                    && may_hold(b, place)
                    && let (Some(p), Some(q)) = (way(&a.segment, &a.arc, place), way(&b.segment, &b.arc, place))
                {
                    found.push(Crossing { ring: a.ring, element: a.element, angle: p });
                    found.push(Crossing { ring: b.ring, element: b.element, angle: q });
                }
            }
        }
    }
    found.sort_by(|x, y| (x.ring, x.element).cmp(&(y.ring, y.element)).then(x.angle.total_cmp(&y.angle)));
    found
}

/// How far along an arc a point of its circle lies, if it belongs to the arc.
fn way(segment: &Segment, arc: &Arc, p: Point) -> Option<f64> {
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

/// Leads every element without a next one to the loose start at its end; tells which were joined.
fn join_loose_ends(elements: &mut [Element], distance: f64) -> Result<Vec<(usize, usize)>, OffsetError> {
    let mut joined = Vec::new();
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
                joined.push((i, start));
            }
            None => return Err(OffsetError::NoRoom { at: end }),
        }
    }
    Ok(joined)
}

/// Rounds the corner between two arcs about the corners of a neck: between them the path follows a disk of radius `resting`
/// that touches both corners.
fn round(elements: &mut Vec<Element>, before: usize, after: usize, resting: f64) {
    let (a, b) = (elements[before].segment, elements[after].segment);
    let (Link::Arc(about_a), Link::Arc(about_b)) = (a.link, b.link) else { return };
    let radius = resting - about_a.radius;
    let middle = nalgebra::center(&about_a.center, &about_b.center);
    let half = 0.5 * (about_b.center - about_a.center).norm();
    let Some(outward) = (a.end - middle).try_normalize(END_ANGLE * resting) else { return };
    if radius <= END_ANGLE * resting || !radius.is_finite() || half >= resting {
        return;
    }
    let center = middle + outward * (resting * resting - half * half).sqrt();
    let foot = |corner: Point| corner + (center - corner) * (about_a.radius / resting);
    let (first, last) = (foot(about_a.center), foot(about_b.center));
    // Both feet lie on what is left of the two arcs, or nothing is rounded.
    let (Some(to_first), Some(to_last)) = (way(&a, &about_a, first), way(&b, &about_b, last)) else { return };
    let mut rest = Segment { start: first, end: last, link: Link::Arc(Arc { center, radius, turn: Turn::Right }) };
    elements[before].segment.end = first;
    if to_first <= END_ANGLE {
        elements[before].is_gone = true;
        rest.start = a.start;
    }
    elements[after].segment.start = last;
    elements[after].joint = Joint::Corner;
    if to_last >= b.sweep() - END_ANGLE {
        elements[after].is_gone = true;
        rest.end = b.end;
    }
    elements[before].next = Some(elements.len());
    elements.push(Element { segment: rest, joint: Joint::Corner, next: Some(after), is_gone: false });
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
            let Element { segment, joint, next, is_gone } = elements[i];
            if !is_gone {
                vertices.push(Vertex { point: segment.start, link: segment.link, joint, id: None });
            }
            at = next;
        }
        if !vertices.is_empty() {
            rings.push(Ring { vertices });
        }
    }
    rings
}
