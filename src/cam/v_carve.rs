//! V-carving: a cone follows the medial axis of a region, as deep as the region is wide there.
//!
//! With its tip at the depth (c - t) / tan(angle/2), c the distance from the outline and t the radius of the flat at the
//! tip, the cone is as wide at the stock's top as the largest disk there, and touches the outline in two places. Stages:
//!
//! 1. the medial axis, cut off where it is narrower than the tip or wider than the tool reaches;
//! 2. there the cone runs along the outline of what is left, at that distance from the region's edge, and what lies within
//!    is the flat bottom, which another operation clears;
//! 3. passes by depth, each over what those before have not cut to its full depth;
//! 4. in each pass long chains without a lift ([`network`]), ordered by nearness, straight stretches joined.
//!
//! Guaranteed: along the chains the cone is nowhere wider at the stock's top than the region, up to [`CARVING_TOLERANCE`],
//! and the region is cut up to its corners, but for what is narrower than the tip. Refused: tools that are no cones.

mod network;
mod stretch;

use super::{Move, MoveKind, OffsetError, Point3, Tool, ToolShape, offset};
use crate::plane::{AxisNode, Link, Point, Region, Vector, medial_axis};
use crate::rolling::{Topology, close};
use crate::units::Radius;
use network::Network;
use stretch::{clipped, simplified};

/// How far the cone may cut beyond the outline, in millimetres: finer than machines step.
pub const CARVING_TOLERANCE: f64 = 1e-3;

/// What of that the chords of the axis and of round outlines may use, in millimetres.
const CHORD_TOLERANCE: f64 = 2e-4;

/// How far a point may lie off the straight move that replaces it, in millimetres.
const STRAIGHT_TOLERANCE: f64 = 5e-4;

/// The depth of a pass beyond the allowed one that is rounding, in passes.
const PASS_ROUNDING: f64 = 1e-9;

/// More passes than this are a mistake in the units.
const LARGEST_PASS_COUNT: f64 = 1000.0;

/// How to carve. Lengths are millimetres.
#[derive(Clone, Debug, PartialEq)]
pub struct VCarve {
    /// The V bit.
    pub tool: Tool,
    /// z of the stock's top, where the region is as wide as drawn.
    pub stock_top: f64,
    /// How deep the tip goes at most; without it, as deep as the tool is wide.
    pub max_depth: Option<f64>,
    /// How deep one pass cuts.
    pub depth_per_pass: f64,
}

/// What a carving does.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VCarving {
    /// The ways of the tip while it cuts, in order; a single point is plunged to.
    pub chains: Vec<Vec<Point3>>,
    /// What the chains go around and do not clear, down to [`VCarving::deepest`]: the bottom where the region is wider than
    /// the tool reaches. Its edge is where the cone's side meets the bottom.
    pub flat: Region,
    /// How far the tip goes below the stock's top.
    pub deepest: f64,
}

/// Why there is no carving.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum VCarveError {
    /// The tool is no cone, or one without a slope.
    #[error(
        "carving needs a V bit: a tool of shape cone with an angle between 0 and 180 degrees and a tip smaller than itself"
    )]
    NotACone,
    /// A number that makes no sense.
    #[error("the {what} is {value}: it must be a finite number{}", if *.positive { " above zero" } else { "" })]
    Invalid {
        /// What it is.
        what: &'static str,
        /// What was given.
        value: f64,
        /// Whether it must be above zero.
        positive: bool,
    },
    /// The outline of the flat bottom could not be found.
    #[error(
        "the outline {distance:.4} mm inside of the region cannot be trusted: look for outlines that cross or touch"
    )]
    Unclear {
        /// How far inside.
        distance: f64,
    },
    /// The outline of the flat bottom could not be found.
    #[error(transparent)]
    Offset(#[from] OffsetError),
    /// Nothing is as wide as the tip.
    #[error("there is nothing to carve: no part of the region is wider than the flat at the tool's tip")]
    Empty,
}

/// The cone of a tool, as far as it is used.
struct Cone {
    tip_radius: f64,
    /// How much its radius grows a millimetre of height.
    slope: f64,
    /// How deep it may go.
    depth: f64,
}

impl Cone {
    fn new(spec: &VCarve) -> Result<Cone, VCarveError> {
        let ToolShape::Cone { angle, tip_diameter } = spec.tool.shape else { return Err(VCarveError::NotACone) };
        let (slope, tip_radius) = ((0.5 * angle).tan(), 0.5 * tip_diameter);
        let widens = slope.is_finite() && slope > 0.0 && tip_radius >= 0.0 && tip_radius < spec.tool.radius();
        if !widens || !spec.tool.diameter.is_finite() {
            return Err(VCarveError::NotACone);
        }
        let positive = [("depth of a pass", Some(spec.depth_per_pass)), ("largest depth", spec.max_depth)];
        for (what, value) in positive.into_iter().filter_map(|(what, v)| Some((what, v?))) {
            if !(value.is_finite() && value > 0.0) {
                return Err(VCarveError::Invalid { what, value, positive: true });
            }
        }
        if !spec.stock_top.is_finite() {
            return Err(VCarveError::Invalid { what: "height of the stock", value: spec.stock_top, positive: false });
        }
        let whole = (spec.tool.radius() - tip_radius) / slope;
        let depth = whole.min(spec.max_depth.unwrap_or(whole)).min(spec.tool.flute_length);
        if !(depth.is_finite() && depth > 0.0) {
            let value = spec.tool.flute_length;
            return Err(VCarveError::Invalid { what: "flute length", value, positive: true });
        }
        Ok(Cone { tip_radius, slope, depth })
    }

    /// The clearance at which the tip is as deep as it may go.
    fn widest(&self) -> f64 {
        self.tip_radius + self.depth * self.slope
    }

    /// How deep the tip is where the clearance is `clearance`.
    fn depth_at(&self, clearance: f64) -> f64 {
        ((clearance - self.tip_radius) / self.slope).clamp(0.0, self.depth)
    }
}

/// The carving of `region`, which is to be cut away: solid on the left of its outlines, in the machine's millimetres.
///
/// # Errors
/// Where the tool or a number makes no sense, nothing is wide enough, or the flat bottom has no trustworthy outline.
pub fn v_carve(region: &Region, spec: &VCarve) -> Result<VCarving, VCarveError> {
    let cone = Cone::new(spec)?;
    let axis = medial_axis(region, CHORD_TOLERANCE);
    let tip_at = |n: &AxisNode| Point3::new(n.point.x, n.point.y, spec.stock_top - cone.depth_at(n.clearance));
    let mut ways: Vec<Vec<Point3>> = Vec::new();
    for edge in &axis.edges {
        for stretch in clipped(&edge.nodes, cone.tip_radius, cone.widest()) {
            ways.push(stretch.iter().map(tip_at).collect());
        }
    }
    // A component that is a disk has a single node.
    let mut has_edge = vec![false; axis.nodes.len()];
    axis.edges.iter().flat_map(|e| e.ends).for_each(|k| has_edge[k] = true);
    let alone = axis.nodes.iter().zip(has_edge).filter(|(_, has_edge)| !has_edge).map(|(node, _)| node);
    let is_in_reach = |n: &&AxisNode| n.clearance >= cone.tip_radius && n.clearance <= cone.widest();
    ways.extend(alone.filter(is_in_reach).map(|n| vec![tip_at(n)]));
    let is_wide = |n: &AxisNode| n.clearance > cone.widest();
    let mut flat = Region::default();
    let mut rings = Vec::new();
    if axis.nodes.iter().chain(axis.edges.iter().flat_map(|e| &e.nodes)).any(is_wide) {
        let inner = inside(region, cone.widest())?;
        let z = spec.stock_top - cone.depth;
        for ring in &inner.rings {
            let points = ring.flatten(CHORD_TOLERANCE);
            rings.push(points.iter().map(|p| Point3::new(p.x, p.y, z)).collect::<Vec<_>>());
        }
        flat = offset(&inner, cone.tip_radius)?;
    }
    let lowest = ways.iter().chain(&rings).flatten().map(|p| p.z).fold(f64::INFINITY, f64::min);
    if !lowest.is_finite() {
        return Err(VCarveError::Empty);
    }
    let deepest = spec.stock_top - lowest;
    let network = Network::new(&ways, &rings);
    let mut chains = Vec::new();
    let mut here = Vector::zeros();
    let mut above = f64::INFINITY;
    for height in pass_heights(spec, deepest) {
        let pass = network.pass(above, height).chains(&mut here);
        chains.extend(pass.into_iter().map(|chain| simplified(&chain, STRAIGHT_TOLERANCE)));
        above = height;
    }
    Ok(VCarving { chains, flat, deepest })
}

/// What of `region` is at least `distance` from its outline: the offset of the closed complement.
fn inside(region: &Region, distance: f64) -> Result<Region, VCarveError> {
    let radius = Radius::new(distance).map_err(|_| VCarveError::Unclear { distance })?;
    let closed = close(&region.reversed(), radius, Topology::Merge);
    if closed.contradictions > 0 {
        return Err(VCarveError::Unclear { distance });
    }
    let mut inner = offset(&closed.region, distance)?.reversed();
    // A single vertex is a disk as large as the tool: the end of an axis that goes there.
    inner.rings.retain(|r| r.len() > 1);
    Ok(inner)
}

/// The heights of the passes, downward, the last one at the deepest place.
fn pass_heights(spec: &VCarve, deepest: f64) -> Vec<f64> {
    let count = (deepest / spec.depth_per_pass - PASS_ROUNDING).ceil().clamp(1.0, LARGEST_PASS_COUNT) as usize;
    (1..=count).map(|k| spec.stock_top - deepest * (k as f64 / count as f64)).collect()
}

impl VCarving {
    /// The moves of the tip: to every chain at the safe height, by rapids down to `approach` and on at a feed, along the
    /// chain, and up again. Chains are numbered as contours.
    pub fn moves(&self, approach: f64, safe_height: f64) -> Vec<Move> {
        let mut moves = Vec::new();
        for (contour, chain) in self.chains.iter().enumerate() {
            let (Some(first), Some(last)) = (chain.first(), chain.last()) else { continue };
            let mut push = |p: &Point3, z: f64, kind: MoveKind| {
                moves.push(Move { to: Point::new(p.x, p.y), z, kind, contour });
            };
            push(first, safe_height, MoveKind::Rapid);
            if approach < safe_height {
                push(first, approach, MoveKind::Rapid);
            }
            push(first, first.z, MoveKind::Plunge);
            chain.iter().skip(1).for_each(|p| push(p, p.z, MoveKind::Cut(Link::Line)));
            push(last, safe_height, MoveKind::Rapid);
        }
        moves
    }
}

#[cfg(test)]
mod tests;
