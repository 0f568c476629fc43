//! Many overlapping outlines to one region without crossings.
//!
//! Stages: (1) find which rings meet themselves or others ([`meet`]); (2) a ring that meets nothing passes through as it
//! is, turned round or dropped as the winding numbers on its two sides say; (3) rings that meet go through an overlay on
//! an integer grid ([`overlay`]), whose result is brought back to the vertices and arcs that it was made of ([`restore`]).
//!
//! Tolerances: `TOUCH` in stage 1 and the grid of stage 3 (both near the resolution of the numbers), the sampling of arcs
//! in stage 3 (cut points are solved again afterwards), and [`SPECK`], the area below which a ring is dirt.

mod grid;
mod loops;
mod meet;
mod nearby;
mod overlay;
mod restore;

use crate::plane::{Bounds, Ring, any_meet};

use nearby::Surroundings;

/// Rings of less area than this, in parts of the square of the larger side of everything, are left out: rounding makes
/// slivers of 1e-13, and nothing that anyone draws is a millionth of the drawing wide and long.
const SPECK: f64 = 1e-12;

/// Which winding numbers are solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// All but zero.
    NonZero,
    /// The odd ones.
    EvenOdd,
    /// Those from this number on: 1 unites regions, n intersects n of them.
    AtLeast(i32),
}

impl Rule {
    fn is_solid(self, winding: i32) -> bool {
        match self {
            Rule::NonZero => winding != 0,
            Rule::EvenOdd => winding % 2 != 0,
            Rule::AtLeast(least) => winding >= least,
        }
    }
}

/// The union of areas, each of rings that neither cross nor touch along a line. Where no boxes meet it is all of them.
pub(super) fn united(mut areas: Vec<Vec<Ring>>) -> Vec<Ring> {
    areas.retain(|area| !area.is_empty());
    if areas.len() < 2 {
        return areas.pop().unwrap_or_default();
    }
    let around = |area: &Vec<Ring>| area.iter().fold(Bounds::EMPTY, |b, ring| b.union(ring.bounds()));
    let boxes: Vec<Bounds> = areas.iter().map(around).collect();
    let all = boxes.iter().copied().fold(Bounds::EMPTY, Bounds::union);
    let extent = all.width().max(all.height());
    let mut rings = areas.concat();
    let nearby: Vec<Bounds> = boxes.iter().map(|b| b.inflated(meet::TOUCH * extent)).collect();
    if !extent.is_finite() || any_meet(&nearby) {
        return resolve(rings, Rule::AtLeast(1));
    }
    rings.retain(|ring| ring.area().abs() > SPECK * extent * extent);
    rings
}

/// The boundary of what is solid: rings that neither cross nor touch along a line, solid on the left.
pub(super) fn resolve(rings: Vec<Ring>, rule: Rule) -> Vec<Ring> {
    let boxes: Vec<Bounds> = rings.iter().map(Ring::bounds).collect();
    let all = boxes.iter().copied().fold(Bounds::EMPTY, Bounds::union);
    let extent = all.width().max(all.height());
    if !(extent > 0.0 && extent.is_finite()) {
        return Vec::new();
    }
    let groups = meet::groups(&rings, extent);
    let mut group_of = vec![usize::MAX; rings.len()];
    for (number, group) in groups.iter().enumerate() {
        group.rings.iter().for_each(|&i| group_of[i] = number);
    }
    let surroundings = Surroundings::new(&rings, &boxes);
    let mut resolved = Vec::new();
    for (number, group) in groups.iter().enumerate() {
        // How often all other rings run around the group's first vertex, and so around all of it.
        let first = rings[group.rings[0]].vertices[0].point;
        let outside = surroundings.winding_number(first, |i| group_of[i] != number);
        if group.meets {
            let members: Vec<&Ring> = group.rings.iter().map(|&i| &rings[i]).collect();
            resolved.extend(overlay::resolve(&members, rule, outside, extent));
            continue;
        }
        let ring = &rings[group.rings[0]];
        let area = ring.area();
        let inside = outside + if area > 0.0 { 1 } else { -1 };
        let (inside, outside) = (rule.is_solid(inside), rule.is_solid(outside));
        if inside != outside && area.abs() > SPECK * extent * extent {
            resolved.push(if inside == (area > 0.0) { ring.clone() } else { ring.reversed() });
        }
    }
    resolved
}

#[cfg(test)]
mod tests;
