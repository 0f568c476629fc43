//! Round holes.

use super::{Geometry, Keep, OperationError, Planned, Work};
use crate::cam::lay::{Hole, Notice, Pen, RAMP_SLOPE};
use crate::cam::nearest_next::nearest_next;
use crate::cam::{MoveKind, Remainder};
use crate::plane::{Arc, Link, Point, Region, Ring, Segment, Turn};

/// How far a ring may be from a circle, relative to its radius, to be taken for a hole to drill: drawings write circles with
/// cubics that are off by 2.7e-4.
const ROUNDNESS: f64 = 5e-4;

/// How much wider than the tool, in millimetres, a hole may be to be drilled straight: the clearance of bolt holes is more.
const DRILLED: f64 = 0.02;

/// What is left between the tool and the bottom that it has drilled when it comes back down, in millimetres.
const PECK_CLEARANCE: f64 = 0.5;

/// The circle that a ring is, as drawings write it: its centre and diameter.
pub fn circle(ring: &Ring) -> Option<(Point, f64)> {
    let bounds = ring.bounds();
    let (center, radius) = (bounds.center(), 0.25 * (bounds.width() + bounds.height()));
    if ring.len() < 2 || radius <= 0.0 || radius.is_nan() {
        return None;
    }
    let is_on = |p: Point| ((p - center).norm() - radius).abs() <= ROUNDNESS * radius;
    let round = ring.segments().all(|s| is_on(s.start) && is_on(s.point_at(0.5)));
    round.then_some((center, 2.0 * radius))
}

pub(super) fn plan(work: &Work, geometry: &Geometry, peck: Option<f64>) -> Result<Planned, OperationError> {
    let found: Vec<(Point, f64)> = geometry.area.rings.iter().filter_map(circle).collect();
    let mut notices = Vec::new();
    // A plate whose holes are drilled has an outline that is no hole.
    let is_hole = |ring: &&Ring| geometry.area.rings.len() == 1 || !has_holes(&geometry.area, ring);
    let others = geometry.area.rings.iter().filter(|ring| circle(ring).is_none()).filter(is_hole);
    notices.extend(others.map(|ring| Notice::NotRound(ring.bounds().center())));
    if found.is_empty() {
        return Err(OperationError::NoCircles);
    }
    let diameter = work.tool.diameter;
    // A drill makes holes of its own size; what is round but larger is bored.
    if let Some(&(at, hole)) = found.iter().find(|(_, d)| *d < diameter - DRILLED) {
        return Err(OperationError::HoleTooSmall { at, hole, diameter });
    }
    // Through the stock with the full diameter: the tip comes out below.
    let tip = if work.tool.is_drill && work.floor < work.base {
        work.tool.height_at(work.tool.radius()).unwrap_or(0.0)
    } else {
        0.0
    };
    let floor = work.floor - tip;
    let mut moves = work.first_moves();
    let centers: Vec<[Point; 2]> = found.iter().map(|&(center, _)| [center, center]).collect();
    for (number, next) in nearest_next(&centers, false, Point::origin()).iter().enumerate() {
        let (center, hole) = found[next.path];
        let mut pen = Pen { moves: &mut moves, notices: &mut notices, contour: number };
        if work.tool.is_drill && hole > diameter + DRILLED {
            pen.notices.push(Notice::HoleNarrow(center, hole));
        }
        if work.tool.is_drill || hole <= diameter + DRILLED {
            drill(work, center, floor, peck, &mut pen);
        } else {
            bore(work, center, 0.5 * (hole - diameter), &mut pen);
        }
    }
    let rings = found.iter().map(|&(c, d)| Ring::circle(c, 0.5 * d.max(diameter)));
    let area = Region::new(rings.collect());
    let hole = |&(center, d): &(Point, f64)| match work.tool.is_drill {
        true => {
            let point = work.tool.height_at(work.tool.radius()).unwrap_or(0.0);
            Hole { center, diameter, bottom: floor, full_bottom: floor + point }
        }
        false => Hole { center, diameter: d, bottom: work.floor, full_bottom: work.floor },
    };
    Ok(Planned {
        toolpath: work.toolpath(moves, found.len()),
        keep: (!work.tool.is_drill).then(|| Keep {
            part: area.clone(),
            kept: area.clone(),
            remainder: Remainder::Outside,
            distance: work.tool.radius(),
            floor: work.floor,
            others: geometry.others.clone(),
        }),
        notices,
        tabs: Vec::new(),
        holes: found.iter().map(hole).collect(),
        contradictions: 0,
    })
}

/// Whether a ring lies around others.
fn has_holes(area: &Region, ring: &Ring) -> bool {
    let is_inside = |other: &Ring| other.vertices.first().is_some_and(|v| ring.winding_number(v.point) != 0);
    area.rings.iter().any(|other| !std::ptr::eq(other, ring) && is_inside(other))
}

fn drill(work: &Work, center: Point, floor: f64, peck: Option<f64>, pen: &mut Pen) {
    let safe = work.setup.rig.safe_height;
    let approach = work.approach().min(safe);
    pen.push(center, safe, MoveKind::Rapid);
    pen.push(center, approach, MoveKind::Rapid);
    let depth = work.top - floor;
    let count = peck.map_or(1.0, |p| (depth / p - 1e-9).ceil().max(1.0)) as usize;
    for k in 1..=count {
        if k > 1 {
            let bottom = work.top - depth * ((k - 1) as f64 / count as f64);
            pen.push(center, approach, MoveKind::Rapid);
            if bottom + PECK_CLEARANCE < approach {
                pen.push(center, bottom + PECK_CLEARANCE, MoveKind::Rapid);
            }
        }
        pen.push(center, work.top - depth * (k as f64 / count as f64), MoveKind::Plunge);
    }
    pen.push(center, safe, MoveKind::Rapid);
}

/// Down a helix of `radius`, around at the bottom, and, in wide holes, rings from the middle outwards on every level.
fn bore(work: &Work, center: Point, radius: f64, pen: &mut Pen) {
    let safe = work.setup.rig.safe_height;
    // Conventional and climb: what remains lies outside, on the left of a clockwise travel.
    let turn = if work.backwards() { Turn::Left } else { Turn::Right };
    let circle = |radius: f64| {
        let (right, left) = (Point::new(center.x + radius, center.y), Point::new(center.x - radius, center.y));
        let link = Link::Arc(Arc { center, radius, turn });
        [Segment { start: right, end: left, link }, Segment { start: left, end: right, link }]
    };
    // The rings are so near that nothing stays standing between them.
    let reach = 0.8 * work.tool.radius();
    let count = (radius / reach).ceil().max(1.0) as usize;
    let ring = |k: usize| radius * (k as f64 / count as f64);
    let inner = circle(ring(1));
    let start = inner[0].start;
    pen.push(start, safe, MoveKind::Rapid);
    pen.push(start, work.approach().min(safe), MoveKind::Rapid);
    pen.push(start, work.top, MoveKind::Plunge);
    let mut above = work.top;
    for height in work.cutting.pass_heights(work.stock_top) {
        let around = std::f64::consts::TAU * ring(1);
        let rounds = ((above - height) / (around * RAMP_SLOPE)).ceil().max(1.0) as usize;
        let fall = (height - above) / (2 * rounds) as f64;
        for half in 0..2 * rounds {
            let s = inner[half % 2];
            let z = if half + 1 == 2 * rounds { height } else { above + fall * (half + 1) as f64 };
            pen.push(s.end, z, MoveKind::Ramp(s.link));
        }
        for k in 1..=count {
            let halves = circle(ring(k));
            if k > 1 {
                pen.push(halves[0].start, height, MoveKind::Cut(Link::Line));
            }
            halves.iter().for_each(|s| pen.push(s.end, height, MoveKind::Cut(s.link)));
        }
        if count > 1 {
            pen.push(start, height, MoveKind::Cut(Link::Line));
        }
        above = height;
    }
    // Off the wall before going up.
    pen.push(Point::from(start.coords.lerp(&center.coords, 0.5)), above, MoveKind::Cut(Link::Line));
    let here = Point::from(start.coords.lerp(&center.coords, 0.5));
    pen.push(here, safe, MoveKind::Rapid);
}
