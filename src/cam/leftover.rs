//! Which stretches of a drawing's outlines no cut has followed down to the floor.
//!
//! Stages: places are taken along every outline; a place is cut where a tool passes at the floor no farther than its radius,
//! or over a tab between two cuts at the floor. What is not cut between two places that are is the corner that a round tool
//! leaves, where it is no deeper than that between the two directions of the outline there; else it is left over. An
//! outline without any such place was never cut.

use super::motion::{Motion, MotionKind};
use super::swept::{FLOOR_ROUNDING, paths_at_floor};
use crate::plane::{BoundaryIndex, Link, Point, Ring, Segment, Vector};

/// Outlines nearer to the cut than this, in millimetres, are cut: programs of others follow curves by lines, and offset them in
/// steps.
pub const LEAST_LEFTOVER: f64 = 0.05;

/// Places along an outline over the radius of the smallest tool: shorter stretches are not seen.
const PLACES_OVER_RADIUS: f64 = 16.0;

/// Most places along one outline.
const MOST_PLACES: f64 = 50_000.0;

/// Paths may round corners by so many radii of their tool, to keep their speed.
const MOST_ROUNDING: f64 = 4.0;

/// What is left in a corner may be deeper than between straight sides by this factor: curved sides make it narrower.
const CURVED_SIDES: f64 = 1.5;

/// Corners sharper than this, in radians, are told: what they keep is as long as a slot.
const SHARPEST_CORNER: f64 = std::f64::consts::FRAC_PI_6;

/// A stretch of an outline that was to be cut and is not.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Leftover {
    /// The place of it that is farthest from the cut; of a whole outline its middle.
    pub x_mm: f64,
    /// As for x.
    pub y_mm: f64,
    /// How long it is along the outline, in millimetres.
    pub length_mm: f64,
    /// How far it gets from the cut, in millimetres; `None` where nothing is cut at the floor at all.
    pub depth_mm: Option<f64>,
    /// Whether nothing of the outline was cut.
    pub is_whole_outline: bool,
}

/// Motions of one tool and how far from its centre it cuts, in millimetres.
pub(super) struct Reach<'a> {
    pub(super) motions: &'a [Motion],
    pub(super) radius: f64,
}

/// What is left over of `outlines`, cut by `reaches` down to `floor`; tabs stand below `stock_top`.
pub(super) fn leftovers(reaches: &[Reach], outlines: &[Ring], floor: f64, stock_top: f64) -> Vec<Leftover> {
    let cuts: Vec<Cut> = reaches.iter().filter_map(|reach| Cut::new(reach, floor, stock_top)).collect();
    let smallest = reaches.iter().map(|r| r.radius).filter(|r| *r > 0.0).fold(f64::INFINITY, f64::min);
    outlines.iter().flat_map(|ring| along(ring, &cuts, smallest / PLACES_OVER_RADIUS)).collect()
}

/// Where one tool cuts.
struct Cut {
    at_floor: BoundaryIndex,
    over_tabs: BoundaryIndex,
    radius: f64,
}

impl Cut {
    fn new(reach: &Reach, floor: f64, stock_top: f64) -> Option<Cut> {
        let paths: Vec<Segment> = paths_at_floor(reach.motions, floor).into_iter().flatten().collect();
        let over_tabs = BoundaryIndex::of_segments(ways_over_tabs(reach.motions, floor, stock_top));
        let at_floor = BoundaryIndex::of_segments(paths);
        (!at_floor.segments().is_empty()).then_some(Cut { at_floor, over_tabs, radius: reach.radius })
    }

    fn takes(&self, p: Point) -> bool {
        let reach = self.radius + LEAST_LEFTOVER;
        self.at_floor.is_nearer(p, reach) || self.over_tabs.is_nearer(p, reach)
    }
}

/// What is traced above the floor between two cuts at the floor, without leaving the stock.
fn ways_over_tabs(motions: &[Motion], floor: f64, stock_top: f64) -> Vec<Segment> {
    let (mut ways, mut pending) = (Vec::new(), Vec::new());
    let mut follows_floor = false;
    for motion in motions.iter().filter(|m| !matches!(m.kind, MotionKind::Dwell { .. })) {
        let highest = motion.from.z.max(motion.to.z);
        if motion.is_rapid() || highest >= stock_top {
            follows_floor = false;
            pending.clear();
        } else if highest <= floor + FLOOR_ROUNDING {
            ways.append(&mut pending);
            follows_floor = true;
        } else if follows_floor {
            pending.extend(motion.trace());
        }
    }
    ways
}

/// A place on an outline, and whether it is cut.
struct Place {
    point: Point,
    /// Which way the outline goes there.
    direction: Vector,
    is_cut: bool,
}

/// What is left over along one outline.
fn along(ring: &Ring, cuts: &[Cut], spacing: f64) -> Vec<Leftover> {
    let length = ring.length();
    let whole = |depth_mm| {
        let middle = ring.bounds().center();
        Leftover { x_mm: middle.x, y_mm: middle.y, length_mm: length, depth_mm, is_whole_outline: true }
    };
    if length <= 0.0 || !length.is_finite() {
        return Vec::new();
    }
    let spacing = spacing.clamp(length / MOST_PLACES, length);
    let mut places: Vec<Place> = Vec::new();
    for segment in ring.segments().filter(|s| s.length() > 0.0) {
        // No more than the bound above and one for each element.
        let count = (segment.length() / spacing).ceil().max(1.0);
        for k in 0..count as usize {
            let point = segment.point_at(k as f64 / count);
            let direction = match segment.link {
                Link::Line => segment.end - segment.start,
                Link::Arc(arc) => arc.tangent_at(point),
            };
            places.push(Place { point, direction, is_cut: cuts.iter().any(|cut| cut.takes(point)) });
        }
    }
    let depth = |p: Point| cuts.iter().map(|c| c.at_floor.distance(p) - c.radius).fold(f64::INFINITY, f64::min);
    let Some(first_cut) = places.iter().position(|p| p.is_cut) else {
        let depth_mm = places.first().map(|p| depth(p.point)).filter(|d| d.is_finite());
        return vec![whole(depth_mm)];
    };
    places.rotate_left(first_cut);
    let step = length / places.len() as f64;
    // Runs of cut and uncut places take turns, and the first is cut: behind the last one stands it again.
    let runs: Vec<&[Place]> = places.chunk_by(|a, b| a.is_cut == b.is_cut).collect();
    let mut left = Vec::new();
    for (index, run) in runs.iter().enumerate().skip(1).step_by(2) {
        let before = runs[index - 1].last();
        let after = runs.get(index + 1).copied().unwrap_or(&places).first();
        let (Some(before), Some(after)) = (before, after) else { continue };
        let deepest = run.iter().map(|p| (depth(p.point), p.point)).max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((depth_mm, at)) = deepest else { continue };
        if depth_mm > corner(before, after, cuts) + LEAST_LEFTOVER {
            let length_mm = step * run.len() as f64;
            left.push(Leftover {
                x_mm: at.x,
                y_mm: at.y,
                length_mm,
                depth_mm: Some(depth_mm),
                is_whole_outline: false,
            });
        }
    }
    left
}

/// How deep a corner is that a round tool leaves which follows the outline before it up to `a` and behind it from `b` on.
fn corner(a: &Place, b: &Place, cuts: &[Cut]) -> f64 {
    let nearest = |p: &Place| {
        let apart = |cut: &Cut| cut.at_floor.distance(p.point) - cut.radius;
        cuts.iter().min_by(|m, n| apart(m).total_cmp(&apart(n))).map_or(0.0, |cut| cut.radius)
    };
    let turn = a.direction.angle(&b.direction);
    if !(turn > 0.0 && turn < std::f64::consts::PI - SHARPEST_CORNER) {
        return 0.0;
    }
    let half = 0.5 * turn;
    // The rounding that is tangent to both sides, at least the tool's.
    let tool = nearest(a).max(nearest(b));
    let radius = ((b.point - a.point).norm() / (2.0 * half.sin())).clamp(tool, MOST_ROUNDING * tool);
    CURVED_SIDES * radius * (1.0 / half.cos() - 1.0)
}

#[cfg(test)]
mod tests;
