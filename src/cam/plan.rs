//! From a closed region to a toolpath.

use crate::plane::{Point, Region, Turn, Vector};

use super::lay::{APPROACH, Laying, Pen};
use super::lead::Room;
use super::order::order;
use super::tabs::TabLine;
use super::{
    Contour, Direction, InvalidJob, Job, Move, MoveKind, OffsetError, Origin, Settings, Side, Toolpath, fit_arcs,
    offset,
};

/// Why there is no toolpath.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// The job makes no sense.
    #[error(transparent)]
    Job(#[from] InvalidJob),
    /// The region is not closed by the tool's radius.
    #[error(transparent)]
    Offset(#[from] OffsetError),
    /// There is nothing to cut.
    #[error("there is nothing to cut: no outline is left after closing; is the tool larger than the drawing?")]
    Empty,
}

/// The toolpath of `job` around `closed`, which is [`super::Side::kept_material`] closed by [`Job::closing_radius`].
///
/// `part` is the drawing itself; its box says where the origin is.
///
/// # Errors
/// Where the job is invalid, nothing is left to cut, or the region has concave features tighter than the tool.
pub fn plan(job: &Job, part: &Region, closed: &Region) -> Result<Toolpath, PlanError> {
    job.validate()?;
    let path = offset(closed, job.offset_distance())?;
    let translation = translation(job.origin, part);
    // The rings have the part on their left; a spindle that turns clockwise climbs with the part on its right.
    let backwards = job.direction == Direction::Climb;
    let contours: Vec<Contour> = path
        .rings
        .iter()
        .filter_map(|ring| Some(Contour::new(fit_arcs(ring), backwards)?.translated(translation)))
        .collect();
    if contours.is_empty() {
        return Err(PlanError::Empty);
    }
    let stops = order(&contours, Point::origin());
    let mut moves = Vec::new();
    let first = stops.first().map_or(Point::origin(), |s| contours[s.contour].entries[s.entry].point);
    moves.push(Move { to: first, z: job.safe_height, kind: MoveKind::Rapid, contour: 0 });
    let heights = job.pass_heights();
    let solid = job.side.solid(&closed.translated(translation));
    let laying = Laying {
        safe_height: job.safe_height,
        approach: job.stock_top + APPROACH,
        top: job.stock_top,
        heights: &heights,
        entry: job.entry,
        tool_diameter: job.tool_diameter,
        depth_per_pass: job.depth_per_pass,
        lead: None,
        waste: if backwards { Turn::Left } else { Turn::Right },
        room: (job.side != Side::On).then_some(Room {
            solid: &solid,
            distance: job.offset_distance(),
            others: None,
            tabs: &[],
        }),
        holes: &[],
    };
    let mut notices = Vec::new();
    for (number, stop) in stops.iter().enumerate() {
        let contour = &contours[stop.contour];
        let entry = contour.entries[stop.entry];
        let mut pen = Pen { moves: &mut moves, notices: &mut notices, contour: number };
        laying.closed(entry.point, &contour.around_from(&entry), &TabLine::default(), &mut pen);
    }
    Ok(Toolpath {
        settings: Settings {
            feed: job.feed,
            plunge_feed: job.plunge_feed,
            spindle_speed: job.spindle_speed,
            dwell: job.dwell,
            safe_height: job.safe_height,
        },
        moves,
        contour_count: stops.len(),
        part_side: if backwards { Turn::Right } else { Turn::Left },
        translation,
    })
}

/// What brings the origin to where the job wants it.
pub fn translation(origin: Origin, part: &Region) -> Vector {
    let bounds = part.bounds();
    match origin {
        _ if bounds.is_empty() => Vector::zeros(),
        Origin::Corner => -bounds.min.coords,
        Origin::Center => -bounds.center().coords,
        Origin::Drawing => Vector::zeros(),
    }
}

#[cfg(test)]
mod tests;
