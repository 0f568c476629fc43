//! The medial axis of a region: the centres of the disks in it that no other disk in it holds.
//!
//! Such a disk touches the boundary in two or more places, or along an arc. Stages:
//!
//! 1. the boundary becomes a list of lines, arcs and concave vertices, which are what a disk can touch;
//! 2. maximal disks cut the region until every part is a strip between two pieces of its boundary, or the end of a branch
//!    in a corner or an arc ([`domain`]): each disk by growing it at a place of the boundary, in closed form, until it
//!    touches what stops it ([`site`]). A branch point is found by halving a piece of boundary to the last digit;
//! 3. every strip has one edge, points equidistant from its two pieces, as many as the tolerance needs ([`trace`]);
//! 4. branches that lead to samples of smooth curves are dropped, and edges joined ([`prune`]).
//!
//! Guaranteed: the axis of every component hangs together and has as many cycles as the component has holes; nodes are
//! equidistant from their two or three nearest elements to rounding; the clearance of a node is its distance from the
//! boundary. Refused is nothing: what is too degenerate for numbers is dropped.

mod domain;
mod outline;
mod prune;
mod site;
mod trace;

use super::{BoundaryIndex, Point, Region};
use domain::{Cutter, Graph};
use outline::Outline;

/// The share of the tolerance that goes to chords: along a chord place and clearance may both be off, and the clearance at
/// a place changes with the place at most one to one, so that this keeps the sum within the tolerance.
const CHORD_SHARE: f64 = 0.5;

/// Distances below this, relative to the size of the region, are none: the rounding of some dozen operations.
const TINY: f64 = 1e-11;

/// Nodes nearer to each other than this along an edge, relative to the size of the region, are one: four elements that one
/// disk touches make two branch points that differ by rounding, magnified where the elements are almost parallel.
const ONE_NODE: f64 = 1e-9;

/// A centre of a maximal disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisNode {
    /// Where it is.
    pub point: Point,
    /// Its distance from the boundary: the disk's radius; 0 in a corner.
    pub clearance: f64,
}

/// A stretch of the axis between branch points, corners and other ends.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisEdge {
    /// The numbers of the nodes at its ends; twice the same one for a loop.
    pub ends: [usize; 2],
    /// Its nodes in order, those at its ends included. Between them it is straight, and clearance changes evenly.
    pub nodes: Vec<AxisNode>,
}

/// The axis of a region: of every component a connected graph with a cycle around every hole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MedialAxis {
    /// Branch points, ends, and one place of each loop without a branch; alone where the component is a disk.
    pub nodes: Vec<AxisNode>,
    /// The stretches between them.
    pub edges: Vec<AxisEdge>,
}

/// What a node was found as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NodeKind {
    /// The centre of a disk.
    Inner,
    /// A convex corner.
    Corner,
    /// A sample of a smooth convex curve, or a corner that is noise.
    Sample,
}

/// What tracing needs to know.
struct Tracing {
    /// How far a chord may stray.
    tolerance: f64,
    /// Distance below which two places are one.
    tiny: f64,
}

impl AxisNode {
    /// Distance from the chord between two nodes, in the space of place and clearance.
    fn distance_to_chord(&self, from: &AxisNode, to: &AxisNode) -> f64 {
        let space = |n: &AxisNode| nalgebra::Vector3::new(n.point.x, n.point.y, n.clearance);
        let (a, b, p) = (space(from), space(to), space(self));
        let along = b - a;
        let t = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        if t.is_finite() { (p - a - along * t).norm() } else { (p - a).norm() }
    }
}

/// The medial axis of `region`, inside of the solid.
///
/// `tolerance` is the largest distance, above zero, in the unit of the region: of a chord from the axis, in place and
/// clearance together; and of the disks of branches that were dropped from those of the axis. Branches end in every convex
/// corner, with clearance 0; not so in samples of smooth curves ([`super::Joint::Smooth`]).
pub fn medial_axis(region: &Region, tolerance: f64) -> MedialAxis {
    let bounds = region.bounds();
    let size = bounds.diagonal();
    if !(size.is_finite() && size > 0.0) {
        return MedialAxis::default();
    }
    // Near the origin coordinates have more digits.
    let shift = bounds.exact_shift();
    let region = region.translated(-shift);
    let (mut outline, mut graph) = (Outline::default(), Graph::default());
    let tiny = TINY * size;
    let lists = (0..region.rings.len())
        .map(|ring| outline.add(&region, ring, tiny, &mut graph).unwrap_or_default())
        .collect::<Vec<_>>();
    let is_hole: Vec<bool> = region.rings.iter().map(|r| r.area() < 0.0).collect();
    let mut cutter = Cutter { outline: &outline, tiny, graph: &mut graph, waiting: vec![] };
    cutter.join_holes(lists, |ring| is_hole[ring]);
    let tracing = Tracing { tolerance: CHORD_SHARE * tolerance, tiny };
    cutter.run(|graph, strip| trace::trace(&outline, graph, strip, &tracing));
    let mut axis = prune::prune(graph, tolerance, ONE_NODE * size);
    // The last word has the boundary itself, as it is.
    let index = BoundaryIndex::new(&region);
    let ends = axis.nodes.iter_mut();
    for node in ends.chain(axis.edges.iter_mut().flat_map(|e| &mut e.nodes)) {
        node.clearance = node.clearance.min(index.distance(node.point));
        node.point += shift;
    }
    axis
}

#[cfg(test)]
mod tests;
