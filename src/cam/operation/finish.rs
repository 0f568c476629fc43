//! Which walls are cut again at full depth, and which need all passes: the roughing does not come everywhere.

use super::Work;
use crate::cam::contour::Contour;
use crate::plane::{BoundaryIndex, Point, Segment};

/// How much more than the allowance, in tool radii, a cut at full depth may take: in corners sharper than about 25 degrees
/// the roughing keeps farther away than that.
const LIGHT: f64 = 0.5;

/// Places of a path are looked at in such steps, in tool radii.
const STEP: f64 = 0.25;

/// Where the tool has been before the walls are cut again.
pub(super) struct Roughing {
    index: BoundaryIndex,
    /// The contour of every segment of the index.
    owners: Vec<usize>,
    /// The most that the path along a wall may be away.
    reach: f64,
    step: f64,
}

impl Roughing {
    /// Of a tool that has been along `contours`.
    pub(super) fn new(work: &Work, contours: &[Contour]) -> Roughing {
        let all = || contours.iter().enumerate().flat_map(|(k, c)| c.path.segments().map(move |s| (k, s)));
        let radius = work.tool.radius();
        Roughing {
            index: BoundaryIndex::of_segments(all().map(|(_, s)| s).collect()),
            owners: all().map(|(k, _)| k).collect(),
            reach: Roughing::reach(work),
            step: STEP * radius,
        }
    }

    /// The most that the path along a wall may be away from the roughing.
    pub(super) fn reach(work: &Work) -> f64 {
        work.cutting.allowance + LIGHT * work.tool.radius()
    }

    /// The contours that the path from `start` lies beside, so that no more than the allowance is left of its wall; none where
    /// at some place the tool would stand in the full material.
    pub(super) fn beside(&self, start: Point, path: &[Segment]) -> Option<Vec<usize>> {
        let steps = path.iter().flat_map(|s| {
            let count = (s.length() / self.step).ceil().max(1.0) as usize;
            (0..count).map(move |k| s.point_at(k as f64 / count as f64))
        });
        let owner = |p: Point| {
            let (segment, nearest) = self.index.nearest(p)?;
            (nearest.distance <= self.reach).then(|| self.owners[segment])
        };
        let mut owners = [start].into_iter().chain(steps).map(owner).collect::<Option<Vec<usize>>>()?;
        owners.sort_unstable();
        owners.dedup();
        Some(owners)
    }
}
