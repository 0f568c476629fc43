//! Rings that touch themselves along a tangent, taken apart.
//!
//! Where a circle lies in another one and touches it from inside, what is between them ends in two horns. Read as one
//! ring, it turns straight back at the tip of each, and its locus runs along itself there and nowhere crosses: no
//! rounding tells which stretch bounds the free space. As two rings, each of which runs straight on through the touch,
//! the same solid has a locus that is smooth.

use std::collections::HashMap;

use crate::plane::{Link, Region, Ring, Vector};

/// Directions that differ by less than this from straight on, or from straight back, do so by rounding (radians, nearly).
const TANGENT: f64 = 1e-6;

/// The region with every ring taken apart that runs straight on where it passes one place twice; `None` if there is
/// none, as in any region of polygons.
pub(super) fn taken_apart(region: &Region) -> Option<Region> {
    if !region.rings.iter().any(|ring| horns(ring).len() > 1) {
        return None;
    }
    let mut rings = Vec::with_capacity(region.rings.len() + 1);
    let mut waiting: Vec<Ring> = region.rings.iter().rev().cloned().collect();
    while let Some(ring) = waiting.pop() {
        match apart(&ring) {
            // Each has fewer vertices: this ends.
            Some((first, second)) => waiting.extend([second, first]),
            None => rings.push(ring),
        }
    }
    Some(Region::new(rings))
}

/// A vertex with a curve on at least one side, at which the ring turns straight back.
struct Horn {
    at: usize,
    arriving: Vector,
    leaving: Vector,
}

fn horns(ring: &Ring) -> Vec<Horn> {
    let n = ring.len();
    let is_arc = |i: usize| ring.vertices[i].link != Link::Line;
    let turns_back = |at: usize| {
        let before = (at + n - 1) % n;
        if !(is_arc(at) || is_arc(before)) {
            return None;
        }
        let (arriving, leaving) = (ring.segment(before).end_tangent(), ring.segment(at).start_tangent());
        is_straight_on(arriving, -leaving).then_some(Horn { at, arriving, leaving })
    };
    (0..n).filter_map(turns_back).collect()
}

/// The two rings that a ring consists of which passes a place twice, turning back both times, and would run straight on
/// from either arrival if it left as it does the other time.
fn apart(ring: &Ring) -> Option<(Ring, Ring)> {
    let mut at_place: HashMap<[u64; 2], Vec<Horn>> = HashMap::new();
    for horn in horns(ring) {
        let p = ring.vertices[horn.at].point;
        let earlier = at_place.entry([p.x.to_bits(), p.y.to_bits()]).or_default();
        if let Some(other) = earlier.iter().find(|other| runs_on(other, &horn) && runs_on(&horn, other)) {
            let (i, j) = (other.at, horn.at);
            let vertices = &ring.vertices;
            let first = Ring { vertices: vertices[i..j].to_vec() };
            let second = Ring { vertices: vertices[j..].iter().chain(&vertices[..i]).copied().collect() };
            return (first.len() > 1 && second.len() > 1).then_some((first, second));
        }
        earlier.push(horn);
    }
    None
}

/// Whether the ring would run straight on from where it arrives at one horn if it left as at the other.
fn runs_on(arriving: &Horn, leaving: &Horn) -> bool {
    is_straight_on(arriving.arriving, leaving.leaving)
}

fn is_straight_on(from: Vector, to: Vector) -> bool {
    let along = from.dot(&to);
    along > 0.0 && from.perp(&to).abs() < TANGENT * along
}
