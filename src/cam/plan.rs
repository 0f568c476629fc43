//! From a closed region to a toolpath.

use crate::plane::{Point, Region, Segment, Turn, Vector};

use super::order::{Stop, order};
use super::walk::Walk;
use super::{
    Contour, Direction, Entry, InvalidJob, Job, Move, MoveKind, OffsetError, Origin, Settings, Toolpath, fit_arcs,
    offset,
};

/// Fall of a ramp over its length: 5.7 degrees, gentle for end mills that do not cut at their centre.
const RAMP_SLOPE: f64 = 0.1;

/// The shortest path that is ramped along, in tool diameters: on shorter ones the tool turns on the spot, and a straight
/// plunge loads it no more.
const SHORTEST_RAMPED: f64 = 0.5;

/// The most rounds that a ramp makes; where a pass would take more, the tool plunges.
const LARGEST_RAMP_ROUNDS: f64 = 50.0;

/// How high above the stock the tool goes from rapid to plunge, in millimetres: sheets are rarely flatter.
const APPROACH: f64 = 1.0;

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
    for (number, stop) in stops.iter().enumerate() {
        cut(job, &contours, stop, number, &mut moves);
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

/// The length of the shortest path that is ramped along.
fn shortest_ramped(job: &Job) -> f64 {
    let ramp = job.depth_per_pass.min(job.depth) / RAMP_SLOPE;
    (SHORTEST_RAMPED * job.tool_diameter).max(ramp / LARGEST_RAMP_ROUNDS)
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

/// All passes of one contour, from the safe height back to it.
fn cut(job: &Job, contours: &[Contour], stop: &Stop, number: usize, moves: &mut Vec<Move>) {
    let contour = &contours[stop.contour];
    let entry = contour.entries[stop.entry];
    let mut push = |to: Point, z: f64, kind: MoveKind| moves.push(Move { to, z, kind, contour: number });
    push(entry.point, job.safe_height, MoveKind::Rapid);
    let approach = job.stock_top + APPROACH;
    if approach < job.safe_height {
        push(entry.point, approach, MoveKind::Rapid);
    }
    let walk = (!contour.is_point()).then(|| Walk::new(contour.around_from(&entry)));
    let ramped = walk.as_ref().filter(|w| job.entry == Entry::Ramp && w.length() >= shortest_ramped(job));
    let mut here = entry.point;
    if ramped.is_some() {
        push(here, job.stock_top, MoveKind::Plunge);
    }
    let mut way = 0.0;
    let mut above = job.stock_top;
    for height in job.pass_heights() {
        match ramped {
            Some(walk) => {
                let length = (above - height) / RAMP_SLOPE;
                let mut gone = 0.0;
                let stretch = walk.stretch(way, length);
                let whole: f64 = stretch.iter().map(Segment::length).sum();
                for (i, s) in stretch.iter().enumerate() {
                    gone += s.length();
                    let last = i + 1 == stretch.len();
                    let z = if last { height } else { above + (height - above) * (gone / whole) };
                    push(s.end, z, MoveKind::Ramp(s.link));
                    here = s.end;
                }
                way = (way + length) % walk.length();
            }
            None => push(here, height, MoveKind::Plunge),
        }
        for s in walk.iter().flat_map(|w| w.stretch(way, w.length())) {
            push(s.end, height, MoveKind::Cut(s.link));
        }
        above = height;
    }
    push(here, job.safe_height, MoveKind::Rapid);
}

#[cfg(test)]
mod tests;
