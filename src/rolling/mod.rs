//! The limit of the flow, directly: a disk rolls on the outline.
//!
//! The flow of the paper (eq. 7) ends where every curvature is at least -1/r. For a curve that state is known in closed
//! form: untouched pieces of the input, joined by arcs of radius r. So no time step, no edge length and no remeshing
//! are needed: what does not move is the input, bit for bit; what moves is exact arcs.
//!
//! Two meanings ([`Topology`]): *keep* is the limit of the flow, which sees distance along the curve; *merge* is the
//! morphological closing, which sees distance in the plane. Where the locus of the disk's centre does not cross itself
//! the two agree ([`Outcome::differences`] is empty).

mod ball;
mod carrier;
mod crossings;
mod excess;
mod horns;
mod keep;
mod locus;
mod loops;
mod merge;
mod samples;
mod scan;
mod solid;
mod track;
mod trim;
mod unite;

pub use ball::{ClosedSurface, Conflict, Roller, SurfaceOptions, Survey, Touch, Trouble, close_surface, land_surface};

use std::f64::consts::PI;

use crate::plane::{BoundaryIndex, Bounds, Link, Point, Region, Segment, Vector, Vertex};
use crate::units::Radius;
use keep::Kept;
use solid::Solid;

/// What closing means where components come near each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Topology {
    /// The morphological closing, as a cutter sees it: components merge, holes fill, narrow inlets close.
    Merge,
    /// The flow's own limit: every ring by itself, measured along the curve. Rings that run into each other, or one into
    /// itself, become one where they do, and the disk rolls on along that.
    Keep,
}

/// A closed or opened region, with what is known of it.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The result. Vertices that did not move have the point and the identity that they had.
    pub region: Region,
    /// Places (centres of the disk) where the locus crosses itself: there the two meanings of [`Topology`] may differ.
    /// Empty: they agree, proved by the absence of crossings.
    pub differences: Vec<Point>,
    /// Places where distances contradict the combinatorics of a merge, and input links that lie outside of the result:
    /// zero for a result that stands.
    pub contradictions: usize,
}

/// The closing of `region` by a disk of radius `radius`, in the units of the region.
pub fn close(region: &Region, radius: Radius, topology: Topology) -> Outcome {
    closed(region, radius, topology, region.bounds())
}

/// The closing of `region`, which is part of a drawing in the box `around`: parts of one drawing are computed alike, so
/// that an outline that two of them share stays shared to the last bit, when one is closed and the other opened.
///
/// For that the rings of the result begin elsewhere than those of the region, and come in another order.
pub fn close_within(region: &Region, radius: Radius, topology: Topology, around: &Bounds) -> Outcome {
    closed(&in_order(region), radius, topology, region.bounds().union(*around))
}

fn closed(region: &Region, radius: Radius, topology: Topology, bounds: Bounds) -> Outcome {
    let r = radius.get();
    // Far from the origin coordinates have few digits left for a small radius. The shift is exact both ways for every
    // vertex that stays.
    let shift = bounds.exact_shift();
    let farthest = bounds.min.coords.abs().max().max(bounds.max.coords.abs().max());
    let resolution = if farthest.is_finite() { f64::EPSILON * farthest } else { 0.0 };
    let run = |region: &Region| match topology {
        Topology::Merge => close_merged(region, r, resolution),
        Topology::Keep => close_along(region, r, resolution),
    };
    if shift == Vector::zeros() {
        return run(region);
    }
    let mut outcome = run(&region.translated(-shift));
    outcome.region = moved_back(&outcome.region, shift);
    outcome.differences.iter_mut().for_each(|p| *p += shift);
    outcome
}

/// The region with rings that begin at their lowest vertex of those farthest left, in the order of these vertices: where a
/// file begins them must not show in the last digits of a result, or parts that fit would not fit any more.
fn in_order(region: &Region) -> Region {
    let before = |a: &Vertex, b: &Vertex| a.point.x.total_cmp(&b.point.x).then(a.point.y.total_cmp(&b.point.y));
    let mut rings = region.rings.clone();
    for ring in &mut rings {
        let first = (0..ring.len()).min_by(|&i, &j| before(&ring.vertices[i], &ring.vertices[j]));
        ring.vertices.rotate_left(first.unwrap_or(0));
    }
    rings.sort_by(|a, b| match (a.vertices.first(), b.vertices.first()) {
        (Some(a), Some(b)) => before(a, b),
        (a, b) => a.is_some().cmp(&b.is_some()),
    });
    Region::new(rings)
}

/// The region moved by `shift`. Where that rounds the ends of a short arc past each other, which would make it a whole
/// circle, they are joined by a line.
fn moved_back(region: &Region, shift: Vector) -> Region {
    let mut moved = region.translated(shift);
    for (from, to) in region.rings.iter().zip(&mut moved.rings) {
        for i in 0..to.len() {
            if let Link::Arc(_) = to.vertices[i].link
                && (to.segment(i).sweep() - from.segment(i).sweep()).abs() > PI
            {
                to.vertices[i].link = Link::Line;
            }
        }
    }
    moved
}

/// The opening of `region`: the closing of what is empty.
pub fn open(region: &Region, radius: Radius, topology: Topology) -> Outcome {
    reversed(close(&region.reversed(), radius, topology))
}

fn reversed(outcome: Outcome) -> Outcome {
    Outcome { region: outcome.region.reversed(), ..outcome }
}

/// The opening of `region`, which is part of a drawing in the box `around`; see [`close_within`].
pub fn open_within(region: &Region, radius: Radius, topology: Topology, around: &Bounds) -> Outcome {
    reversed(close_within(&region.reversed(), radius, topology, around))
}

fn close_merged(region: &Region, r: f64, resolution: f64) -> Outcome {
    let apart = horns::taken_apart(region);
    let region = apart.as_ref().unwrap_or(region);
    // What an unfinished scan leaves undone the merge does.
    let mut prepared = Scanned::default();
    for ring in &region.rings {
        prepared.extend(scan::scan(ring, r, scan::Mode::Safe, resolution));
    }
    let merged = merge::merge(&prepared, region, r, resolution);
    let mut contradictions = merged.contradictions;
    // So far from the origin that directions are uncertain, the result is looked at once more.
    const COARSE: f64 = 1e-11;
    if resolution > COARSE * r {
        contradictions += poking_out(region, &merged.region, r, resolution);
    }
    Outcome { region: merged.region, differences: merged.bridges, contradictions }
}

fn close_along(input: &Region, r: f64, resolution: f64) -> Outcome {
    let outcome = kept(input, r, resolution, keep::ROUNDS);
    // What is united has no proof but its result.
    if outcome.contradictions == 0 { outcome } else { kept(input, r, resolution, 0) }
}

/// Every ring by itself; those that have run into each other are united, in so many rounds.
fn kept(input: &Region, r: f64, resolution: f64, rounds: usize) -> Outcome {
    let mut kept = Kept::new(input, r, resolution);
    let mut differences = merge::differences(&kept.region(), input, r, resolution);
    // Rings that cross have a locus that does.
    if !differences.is_empty() || !kept.is_finished() {
        kept.unite(rounds);
    }
    differences.append(&mut kept.places);
    let (region, absorbed) = without_absorbed(kept.region(), input.area() < 0.0);
    differences.extend(absorbed);
    if differences.is_empty() {
        // The two meanings agree, and the merge has its distances to prove it by.
        return close_merged(input, r, resolution);
    }
    // Where a curve comes near itself the scan has no proof: it must at least not have cut into the input.
    let contradictions = kept.contradictions + poking_out(input, &region, r, resolution);
    Outcome { region, differences, contradictions }
}

/// How many links of `input` start or pass outside of `result`, which should contain it.
fn poking_out(input: &Region, result: &Region, r: f64, resolution: f64) -> usize {
    const CONTAINED: f64 = 1e-9;
    const MOST_SAMPLES: f64 = 256.0;
    let slack = CONTAINED * r + merge::ROUNDING_STEPS * resolution;
    let solid = Solid::closed(result, input);
    let is_out = |p: Point| solid.is_outside(p) && !solid.index.is_nearer(p, slack);
    // A cut into a link is of the size of the disk, or its end is out.
    let samples = |s: &Segment| (16.0 * s.length() / r).ceil().clamp(2.0, MOST_SAMPLES) as usize;
    input.segments().filter(|s| (0..samples(s)).any(|k| is_out(s.point_at(k as f64 / samples(s) as f64)))).count()
}

/// Drops the rings that other rings have swallowed: an island in a hole that filled, a part that a hole closed in on. Tells
/// a point of each.
fn without_absorbed(scanned: Region, far_is_solid: bool) -> (Region, Vec<Point>) {
    if scanned.rings.len() < 2 && !far_is_solid {
        return (scanned, vec![]);
    }
    let index = BoundaryIndex::new(&scanned);
    let mut absorbed = vec![];
    let mut kept = vec![];
    for ring in &scanned.rings {
        let Some(first) = ring.vertices.first() else { continue };
        let is_outer = ring.area() > 0.0;
        // What the other rings make of the place: an outer ring belongs in empty space, a hole in solid.
        let belongs = |v: &Vertex| {
            let around = index.winding_number(v.point) - ring.winding_number(v.point) + i32::from(far_is_solid);
            if is_outer { around <= 0 } else { around > 0 }
        };
        // A ring that is swallowed in part only still bounds something.
        if ring.vertices.iter().any(belongs) { kept.push(ring.clone()) } else { absorbed.push(first.point) }
    }
    (Region::new(kept), absorbed)
}

/// The rings of a region after the scan.
#[derive(Default)]
struct Scanned {
    region: Region,
    /// Of every ring, which vertices are vertices of the input, unmoved.
    still: Vec<Vec<bool>>,
}

impl Scanned {
    /// Adds a scanned ring; nothing of a hole that is filled.
    fn extend(&mut self, scan: scan::Scan) {
        if !scan.ring.is_empty() {
            self.region.rings.push(scan.ring);
            self.still.push(scan.still);
        }
    }
}
