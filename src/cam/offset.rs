//! The exact offset of a closed region: where the centre of a disk runs that rolls around it.
//!
//! Local: after a closing by R every point of the boundary, corners aside, is touched by a disk of radius R that lies
//! outside of the region, so that an offset by d <= R can cross itself only at arcs about corners. Stages:
//!
//! 1. links shorter than [`TINY_LINK`] are dropped, because their direction is noise;
//! 2. lines shift, convex arcs grow, concave arcs shrink, to a point when they are as tight as the disk;
//! 3. at every vertex the pieces meet: an arc about a convex corner, a common point at a tangent joint, a mitre at a
//!    sample of a smooth concave curve. A true concave corner is an error;
//! 4. pieces without length, and those that run backwards (chords of a concave curve as tight as the disk), are taken
//!    out, their neighbours meet at their intersection, and that place is measured against the region;
//! 5. where the disk cannot pass between two corners, the arcs about them cross and are cut ([`necks`]).

use crate::plane::{
    Arc, BoundaryIndex, Joint, Link, Point, Region, Ring, Segment, Turn, Vertex, right_normal, turn_angle,
};

use carrier::{Carrier, meet};

mod carrier;
mod necks;

/// Turn in radians up to which a joint counts as tangent. The joint's point is wrong by the distance times an eighth of
/// its square: a billionth of the distance.
const TANGENT_TURN: f64 = 1e-4;

/// Largest turn in radians of a concave corner that is taken for rounding noise, and mitred: 0.06 degrees.
const NOISE_TURN: f64 = 1e-3;

/// Difference of radius and distance, relative to the distance, up to which a concave arc counts as tight as the disk
/// and shrinks to a point. Rounding of drawings and of the closing is well below.
const VANISHING: f64 = 1e-9;

/// Links shorter than this, relative to the distance, are dropped: their direction is noise.
const TINY_LINK: f64 = 1e-9;

/// The same relative to the size of the coordinates, whose last digits are noise.
const TINY_COORDINATE: f64 = 1e-11;

/// How much nearer than the distance a repaired place may come to the region, in millimetres: half of the gouge that a
/// program may have. Chords bulge out of the curve that they stand for, by their sagitta, and a curve that is just wide
/// enough for the disk is too narrow by that much.
const REPAIR_TOLERANCE: f64 = 1e-3;

/// Why a region has no local offset.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum OffsetError {
    /// The distance is negative or not a number.
    #[error("the offset distance is {0}: it must be zero or more")]
    InvalidDistance(f64),
    /// A concave corner: the region is not closed.
    #[error(
        "there is a concave corner of {:.3} degrees at ({:.4}, {:.4}): close the region by the tool's radius first",
        turn.to_degrees(), at.x, at.y
    )]
    ConcaveCorner {
        /// Where.
        at: Point,
        /// How far it turns, in radians, positive.
        turn: f64,
    },
    /// A concave arc that the disk does not fit into.
    #[error(
        "a concave arc of radius {radius} at ({:.4}, {:.4}) is tighter than {distance}: close the region by the \
         tool's radius first", at.x, at.y
    )]
    TooTight {
        /// Where.
        at: Point,
        /// Radius of the arc.
        radius: f64,
        /// Distance asked for.
        distance: f64,
    },
    /// A place where the disk does not fit between neighbouring links.
    #[error("the tool does not fit at ({:.4}, {:.4}): close the region by the tool's radius first", at.x, at.y)]
    NoRoom {
        /// Where.
        at: Point,
    },
}

/// The boundary at `distance` outside of `closed`.
///
/// Rings keep their sense of travel: solid on the left. A ring of a single vertex is a place to drill: a hole exactly as
/// large as the disk. Chords of smooth curves keep [`Joint::Smooth`] between them.
///
/// # Errors
/// Where a concave feature is tighter than `distance`, naming the place.
pub fn offset(closed: &Region, distance: f64) -> Result<Region, OffsetError> {
    if !(distance.is_finite() && distance >= 0.0) {
        return Err(OffsetError::InvalidDistance(distance));
    }
    if distance == 0.0 {
        return Ok(closed.clone());
    }
    let mut repaired = Vec::new();
    let mut rings = Vec::with_capacity(closed.rings.len());
    for ring in closed.rings.iter().filter(|r| !r.is_empty()) {
        rings.push(offset_ring(ring, distance, &mut repaired)?);
    }
    if !repaired.is_empty() {
        let index = BoundaryIndex::new(closed);
        let limit = distance - REPAIR_TOLERANCE;
        if let Some(&at) = repaired.iter().find(|p| index.is_nearer(**p, limit)) {
            return Err(OffsetError::NoRoom { at });
        }
    }
    Ok(Region::new(necks::cut_necks(rings, closed, distance)?))
}

/// A piece of the offset and the joint where it starts.
#[derive(Clone, Copy)]
struct Piece {
    start: Point,
    joint: Joint,
    carrier: Carrier,
    /// What it sweeps if nothing is cut off; tells a short way round from a backward one.
    expected_sweep: f64,
}

fn offset_ring(ring: &Ring, distance: f64, repaired: &mut Vec<Point>) -> Result<Ring, OffsetError> {
    let (segments, joints) = without_tiny_links(ring, distance);
    if segments.is_empty() {
        return Ok(Ring::default());
    }
    let pieces = raw_pieces(&segments, &joints, distance)?;
    Ok(match without_backward(pieces, TINY_LINK * distance, distance, repaired)? {
        Err(point) => {
            repaired.push(point);
            Ring { vertices: vec![Vertex::corner(point)] }
        }
        Ok(pieces) => {
            let vertices = pieces
                .iter()
                .map(|p| Vertex { point: p.start, link: p.carrier.link(), joint: p.joint, id: None })
                .collect();
            Ring { vertices }
        }
    })
}

/// The elements of a ring long enough to have a direction, and the joint at the start of each.
fn without_tiny_links(ring: &Ring, distance: f64) -> (Vec<Segment>, Vec<Joint>) {
    let magnitude = ring.vertices.iter().map(|v| v.point.coords.amax()).fold(0.0, f64::max);
    let tiny = TINY_LINK * distance + TINY_COORDINATE * magnitude;
    let mut kept: Vec<usize> = Vec::with_capacity(ring.len());
    let mut joints: Vec<Joint> = Vec::with_capacity(ring.len());
    let mut pending = None;
    for (i, vertex) in ring.vertices.iter().enumerate() {
        // A dropped link makes one joint of its two ends: a corner if either is one.
        let joint = if pending == Some(Joint::Corner) { Joint::Corner } else { vertex.joint };
        if ring.segment(i).length() <= tiny {
            pending = Some(joint);
        } else {
            pending = None;
            kept.push(i);
            joints.push(joint);
        }
    }
    if let (Some(Joint::Corner), Some(first)) = (pending, joints.first_mut()) {
        *first = Joint::Corner;
    }
    let starts: Vec<Point> = kept.iter().map(|&i| ring.vertices[i].point).collect();
    let segments = (0..kept.len())
        .map(|k| Segment { start: starts[k], end: starts[(k + 1) % kept.len()], link: ring.vertices[kept[k]].link })
        .collect();
    (segments, joints)
}

/// Stages 2 and 3.
fn raw_pieces(segments: &[Segment], joints: &[Joint], distance: f64) -> Result<Vec<Piece>, OffsetError> {
    let n = segments.len();
    let mut pieces = Vec::with_capacity(2 * n);
    let carriers = segments.iter().map(|s| shifted(s, distance)).collect::<Result<Vec<_>, _>>()?;
    for (i, segment) in segments.iter().enumerate() {
        let before = (i + n - 1) % n;
        let vertex = segment.start;
        let (t_in, t_out) = (segments[before].end_tangent(), segment.start_tangent());
        let mut turn = turn_angle(t_in, t_out);
        // The tip of a needle turns by π up to rounding, to whichever side; a slit of no width would be closed.
        if turn < NOISE_TURN - std::f64::consts::PI {
            turn += std::f64::consts::TAU;
        }
        let chords = joints[i] == Joint::Smooth && segments[before].link == Link::Line && segment.link == Link::Line;
        let joint = if chords { Joint::Smooth } else { Joint::Corner };
        let carrier = carriers[i];
        let mut start = vertex + right_normal(t_out) * distance;
        if turn > TANGENT_TURN {
            let about = Arc { center: vertex, radius: distance, turn: Turn::Left };
            pieces.push(Piece {
                start: vertex + right_normal(t_in) * distance,
                joint,
                carrier: Carrier::Circle(about),
                expected_sweep: turn,
            });
        } else {
            let mitred = turn < -TANGENT_TURN;
            if mitred && joints[i] == Joint::Corner && turn < -NOISE_TURN {
                return Err(OffsetError::ConcaveCorner { at: vertex, turn: -turn });
            }
            // The sum of two unit vectors that make the angle `turn` has the length 2 cos(turn/2).
            let bisector = right_normal(t_in + t_out) * (2.0 * distance / (t_in + t_out).norm_squared());
            start = vertex + bisector;
            if mitred && joint == Joint::Corner {
                start = meet(&carriers[before], &carrier, start, distance).unwrap_or(start);
            }
        }
        pieces.push(Piece { start, joint, carrier, expected_sweep: segment.sweep() });
    }
    Ok(pieces)
}

/// Where a boundary element runs after the offset; a concave arc as tight as the disk on a circle without radius.
fn shifted(segment: &Segment, distance: f64) -> Result<Carrier, OffsetError> {
    Ok(match segment.link {
        Link::Line => {
            let direction = segment.start_tangent();
            Carrier::Line { through: segment.start + right_normal(direction) * distance, direction }
        }
        Link::Arc(arc) => {
            let radius = arc.radius + arc.turn.sign() * distance;
            if radius < -VANISHING * distance {
                return Err(OffsetError::TooTight { at: segment.point_at(0.5), radius: arc.radius, distance });
            }
            Carrier::Circle(Arc { radius: radius.max(0.0), ..arc })
        }
    })
}

/// Stage 4. `Ok(Err(point))` where the whole ring shrinks to a point.
fn without_backward(
    mut pieces: Vec<Piece>,
    tiny: f64,
    distance: f64,
    repaired: &mut Vec<Point>,
) -> Result<Result<Vec<Piece>, Point>, OffsetError> {
    let mut next: Vec<usize> = (1..pieces.len()).chain([0]).collect();
    let mut before: Vec<usize> = std::iter::once(pieces.len() - 1).chain(0..pieces.len() - 1).collect();
    let mut alive = vec![true; pieces.len()];
    let mut left = pieces.len();
    let mut waiting: Vec<usize> = (0..pieces.len()).rev().collect();
    while let Some(i) = waiting.pop() {
        if !alive[i] {
            continue;
        }
        let (a, b) = (pieces[i].start, pieces[next[i]].start);
        if pieces[i].carrier.travelled(a, b, pieces[i].expected_sweep) > tiny {
            continue;
        }
        if left <= 2 {
            return Ok(Err(nalgebra::center(&a, &b)));
        }
        let (p, n) = (before[i], next[i]);
        let middle = nalgebra::center(&a, &b);
        let apart = (b - a).norm();
        let start = if apart <= 2.0 * tiny {
            middle
        } else {
            repaired.push(middle);
            let start = meet(&pieces[p].carrier, &pieces[n].carrier, middle, distance);
            match start {
                Some(start) => start,
                None if apart <= REPAIR_TOLERANCE => middle,
                None => return Err(OffsetError::NoRoom { at: middle }),
            }
        };
        if apart > 2.0 * tiny {
            *repaired.last_mut().expect("a place was pushed above") = start;
        }
        alive[i] = false;
        left -= 1;
        let joint = if pieces[i].joint == Joint::Smooth { pieces[n].joint } else { Joint::Corner };
        pieces[n].start = start;
        pieces[n].joint = joint;
        next[p] = n;
        before[n] = p;
        waiting.push(n);
        waiting.push(p);
    }
    let mut keep = alive.iter();
    pieces.retain(|_| *keep.next().expect("one flag a piece"));
    Ok(Ok(pieces))
}

#[cfg(test)]
mod tests;
