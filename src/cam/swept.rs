//! What a round tool sweeps at the floor of a cut, and what stands between.

use std::collections::HashSet;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

use super::motion::{Motion, MotionKind};
use super::removal::SKIN;
use super::stroke::{Polygon, Stroke, joined_lines};
use crate::plane::{Bounds, Point, Segment, groups_apart};

/// Chord error of the overlay in millimetres: hairs of it stay within the skin.
pub(super) const FLATTENING: f64 = 0.1 * SKIN;

/// Lines whose ends are this near to one line are taken as one, in millimetres: half of what three decimals round away.
const STRAIGHTNESS: f64 = 5e-4;

/// Motions this much above the floor, in millimetres, still reach it.
pub(super) const FLOOR_ROUNDING: f64 = 0.005;

/// The paths of all motions at the floor, joined where they follow each other; each trace once. A plunge is a line
/// without length.
pub(super) fn paths_at_floor(motions: &[Motion], floor: f64) -> Vec<Vec<Segment>> {
    let mut seen = HashSet::new();
    let mut paths: Vec<Vec<Segment>> = Vec::new();
    let mut is_open = false;
    for motion in motions {
        if matches!(motion.kind, MotionKind::Dwell { .. }) {
            continue;
        }
        let plunge = motion.trace().next().is_none().then(|| Segment::line(motion.to.xy(), motion.to.xy()));
        let lowest_that_counts = if plunge.is_some() { motion.to.z } else { motion.from.z.max(motion.to.z) };
        if lowest_that_counts > floor + FLOOR_ROUNDING {
            is_open = false;
            continue;
        }
        for element in motion.trace().chain(plunge) {
            let key = [element.start.x, element.start.y, element.end.x, element.end.y, element.sweep()];
            if !seen.insert(key.map(f64::to_bits)) {
                is_open = false;
                continue;
            }
            match paths.last_mut().filter(|_| is_open) {
                Some(path) => path.push(element),
                None => paths.push(vec![element]),
            }
            is_open = true;
        }
    }
    paths
}

/// Rings of what a disk of `radius` sweeps along paths.
pub(super) fn swept(paths: &[Vec<Segment>], radius: f64) -> Vec<Polygon> {
    let stroke = Stroke { radius, tolerance: FLATTENING };
    let mut rings = Vec::new();
    for path in paths {
        match path.as_slice() {
            // A plunge.
            [point] if point.start == point.end => rings.push(stroke.disk(point.start)),
            _ => rings.extend(stroke.rings(&joined_lines(path, STRAIGHTNESS))),
        }
    }
    rings
}

/// Rings that lie away from all others, in a frame.
pub(super) struct Group {
    frame: Bounds,
    cut: Vec<Polygon>,
}

impl Group {
    /// The groups of some rings, their frames so far outside of them. What lies around all groups hangs together: nothing that
    /// stands alone is shared by two of them.
    pub(super) fn all(mut cut: Vec<Polygon>, margin: f64) -> Vec<Group> {
        let around: Vec<Bounds> =
            cut.iter().map(|ring| Bounds::of_points(ring.iter().map(|&[x, y]| Point::new(x, y)))).collect();
        let group = |members: Vec<usize>| Group {
            frame: members.iter().fold(Bounds::EMPTY, |b, &k| b.union(around[k])).inflated(margin),
            cut: members.into_iter().map(|k| std::mem::take(&mut cut[k])).collect(),
        };
        groups_apart(&around).into_iter().map(group).collect()
    }

    /// Adds the frame to the rings: what is cut are holes in it.
    pub(super) fn surround(&mut self) {
        self.cut.push(rectangle(self.frame));
    }

    /// What the rings leave of the frame: shapes of an outer ring and holes.
    pub(super) fn left(&self) -> Vec<Vec<Polygon>> {
        let stock = vec![rectangle(self.frame)];
        stock.overlay_as::<i64>(&self.cut, OverlayRule::Difference, FillRule::NonZero)
    }

    pub(super) fn is_on_frame(&self, p: Point) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() < SKIN;
        let frame = &self.frame;
        near(p.x, frame.min.x) || near(p.x, frame.max.x) || near(p.y, frame.min.y) || near(p.y, frame.max.y)
    }
}

fn rectangle(b: Bounds) -> Polygon {
    vec![[b.min.x, b.min.y], [b.max.x, b.min.y], [b.max.x, b.max.y], [b.min.x, b.max.y]]
}
