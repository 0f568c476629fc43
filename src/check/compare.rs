//! The measuring of a result against its reference.

use std::collections::HashSet;

use i_overlay::core::overlay_rule::OverlayRule;

use super::farthest::{RESOLUTION, farthest};
use super::inside::Inside;
use super::moved::{overlay, pieces};
use super::report::{Area, Containment, Distance, Kept, Report, SmallestRadius, Topology};
use crate::plane::{BoundaryIndex, Joint, Link, Point, Region, Turn, turn_angle};
use crate::reference::{Operation, Reference};
use crate::units::Radius;

/// An input vertex this near to the reference's boundary, over the radius, need not move.
const STILL: f64 = 1e-7;

/// Sagitta of flattened arcs in the symmetric difference, over the radius.
pub(super) const AREA_FLATNESS: f64 = 1e-5;

/// How far a change of topology is felt, over the radius: a disk that touches it reaches no further.
const TOPOLOGY_REACH: f64 = 2.0;

/// How much sharper than the radius a turn must be to count, over the radius: above rounding.
const RADIUS_SLACK: f64 = 1e-6;

/// Turns of straight links below this angle in radians are rounding; above [`CORNER`] they are corners; between
/// them they are chords of a curve.
const STRAIGHT: f64 = 1e-6;
const CORNER: f64 = 0.2;

/// Compares `output`, a claimed closing or opening of `input`, with a reference.
pub fn compare(input: &Region, output: &Region, reference: &Reference, radius: Radius, operation: Operation) -> Report {
    let r = radius.get();
    let truth = &reference.region;
    let (output_index, truth_index) = (BoundaryIndex::new(output), BoundaryIndex::new(truth));
    let (larger, smaller) = match operation {
        Operation::Close => (truth, input),
        Operation::Open => (input, truth),
    };
    let mut mask = Vec::new();
    for piece in pieces(input, truth, larger, smaller, r) {
        if piece.is_topological() {
            mask.push(BoundaryIndex::new(&piece.outline));
        }
    }
    let resolution = RESOLUTION * r;
    let hide = |p: Point, reach: f64| {
        let near = TOPOLOGY_REACH * r + reach;
        near > 0.0 && mask.iter().any(|index| index.is_nearer(p, near) || index.winding_number(p) > 0)
    };
    let distance = |hidden: &dyn Fn(Point, f64) -> bool| {
        let forth = farthest(output, &truth_index, resolution, |_, d| d, hidden);
        let back = farthest(truth, &output_index, resolution, |_, d| d, hidden);
        let (largest, place) = if forth.0 >= back.0 { forth } else { back };
        Distance {
            output_to_reference_units: forth.0,
            reference_to_output_units: back.0,
            largest_over_r: largest / r,
            place: place.map(Into::into),
        }
    };
    let hausdorff = distance(&|_, _| false);
    let agreeing = if mask.is_empty() { hausdorff } else { distance(&hide) };
    let (inner, outer) = match operation {
        Operation::Close => (input, output),
        Operation::Open => (output, input),
    };
    Report {
        operation,
        radius_units: r,
        reference_method: reference.method,
        reference_error_units: reference.error_bound,
        reference_radius_units: reference.radius,
        resolution_units: resolution,
        hausdorff,
        hausdorff_where_topology_agrees: agreeing,
        topological_pieces: mask.len(),
        area: areas(input, output, truth, r),
        containment: containment(inner, outer, r),
        kept: kept(input, output, &truth_index, r),
        topology: Topology { input: input.topology(), output: output.topology(), reference: truth.topology() },
        smallest_radius: smallest_radius(output, r, operation),
    }
}

fn areas(input: &Region, output: &Region, truth: &Region, r: f64) -> Area {
    let difference: f64 = overlay(output, truth, OverlayRule::Xor, AREA_FLATNESS * r).iter().map(Region::area).sum();
    let length = truth.perimeter();
    Area {
        input_units2: input.area(),
        output_units2: output.area(),
        reference_units2: truth.area(),
        symmetric_difference_units2: difference,
        mean_difference_over_r: if length > 0.0 { difference / length / r } else { 0.0 },
    }
}

fn containment(inner: &Region, outer: &Region, r: f64) -> Containment {
    let index = BoundaryIndex::new(outer);
    let inside = Inside::new(outer);
    let signed = |p: Point, d: f64| if d > 0.0 && inside.contains(p) { -d } else { d };
    let (violation, place) = farthest(inner, &index, RESOLUTION * r, signed, &|_, _| false);
    let violation = violation.max(0.0);
    Containment {
        violation_units: violation,
        violation_over_r: violation / r,
        place: place.filter(|_| violation > 0.0).map(Into::into),
    }
}

fn kept(input: &Region, output: &Region, truth: &BoundaryIndex, r: f64) -> Kept {
    let vertices = |region: &'_ Region| -> Vec<Point> {
        region.rings.iter().flat_map(|ring| ring.vertices.iter().map(|v| v.point)).collect()
    };
    let bits = |p: &Point| (p.x.to_bits(), p.y.to_bits());
    let present: HashSet<(u64, u64)> = vertices(output).iter().map(bits).collect();
    let still: Vec<Point> = vertices(input).into_iter().filter(|p| truth.is_nearer(*p, STILL * r)).collect();
    let found = still.iter().filter(|p| present.contains(&bits(p))).count();
    let fraction = if still.is_empty() { 1.0 } else { found as f64 / still.len() as f64 };
    Kept { still_vertices: still.len(), found, fraction }
}

/// The sharpest concave turn of a closing, or convex turn of an opening, that is sharper than the radius.
fn smallest_radius(output: &Region, r: f64, operation: Operation) -> Option<SmallestRadius> {
    let removed = match operation {
        Operation::Close => Turn::Right,
        Operation::Open => Turn::Left,
    };
    let mut sharpest: Option<(f64, Point)> = None;
    let mut record = |radius: f64, p: Point| {
        if radius < r * (1.0 - RADIUS_SLACK) && sharpest.is_none_or(|(s, _)| radius < s) {
            sharpest = Some((radius, p));
        }
    };
    for ring in &output.rings {
        let n = ring.len();
        for (i, s) in ring.segments().enumerate() {
            if let Link::Arc(arc) = s.link
                && arc.turn == removed
            {
                record(arc.radius, s.point_at(0.5));
            }
            let before = ring.segment((i + n - 1) % n);
            let angle = removed.sign() * turn_angle(before.end_tangent(), s.start_tangent());
            if angle <= STRAIGHT {
                continue;
            }
            let is_sampled_curve = ring.vertices[i].joint == Joint::Smooth || angle <= CORNER;
            let chord = before.length().min(s.length());
            // Two chords of a circle turn by the angle of one: chord = 2 R sin(angle / 2).
            record(if is_sampled_curve { 0.5 * chord / (0.5 * angle).sin() } else { 0.0 }, s.start);
        }
    }
    sharpest.map(|(radius, p)| SmallestRadius { radius_units: radius, radius_over_r: radius / r, place: p.into() })
}
