//! Areas carved by a cone, as deep as they are wide.

use super::{Geometry, Keep, Level, OperationError, Planned, Work};
use crate::cam::lay::{Notice, Pen};
use crate::cam::order::order;
use crate::cam::tabs::TabLine;
use crate::cam::{Contour, Entry, MoveKind, Remainder, ToolShape, VCarve, v_carve};
use crate::plane::{Point, Region};

/// Distance between the paths over a flat bottom, in tool diameters: ridges between them are lower than this by far.
const BOTTOM_STEPOVER: f64 = 0.05;

/// Rings over a flat bottom at most.
const MOST_RINGS: usize = 2000;

pub(super) fn plan(work: &Work, geometry: &Geometry, max_depth: Option<f64>) -> Result<Planned, OperationError> {
    if geometry.area.is_empty() {
        return Err(OperationError::NoArea);
    }
    let spec =
        VCarve { tool: work.tool.clone(), stock_top: work.top, max_depth, depth_per_pass: work.cutting.depth_per_pass };
    let carving = v_carve(&geometry.area, &spec).map_err(|e| OperationError::Carving(e.to_string()))?;
    work.stays_in_stock(carving.deepest)?;
    let mut moves = work.first_moves();
    moves.extend(carving.moves(work.approach(), work.setup.rig.safe_height));
    let mut count = carving.chains.len();
    let mut notices = Vec::new();
    if !carving.flat.is_empty() {
        let step = BOTTOM_STEPOVER * work.tool.diameter;
        let rings = rings(work, &carving.flat, step)?;
        let contours: Vec<Contour> = rings.iter().flat_map(|level| work.contours(level)).collect();
        let heights = heights(work, carving.deepest);
        let mut laying = work.laying(work.top, &heights, None, &[]);
        (laying.entry, laying.lead) = (Entry::Ramp, None);
        for stop in order(&contours, Point::origin()) {
            let contour = &contours[stop.contour];
            let entry = contour.entries[stop.entry];
            let mut pen = Pen { moves: &mut moves, notices: &mut notices, contour: count };
            laying.closed(entry.point, &contour.around_from(&entry), &TabLine::default(), &mut pen);
            count += 1;
        }
        notices.push(Notice::BottomCleared(step));
    }
    if moves.iter().all(|m| m.kind == MoveKind::Rapid) {
        return Err(OperationError::TooLarge { diameter: work.tool.diameter });
    }
    Ok(Planned {
        toolpath: work.toolpath(moves, count),
        keep: Some(Keep {
            part: geometry.area.clone(),
            kept: geometry.area.clone(),
            remainder: Remainder::Outside,
            distance: 0.0,
            floor: work.top - carving.deepest,
            others: geometry.others.clone(),
        }),
        notices,
        tabs: Vec::new(),
        holes: Vec::new(),
        contradictions: 0,
    })
}

/// z of the passes down to a flat bottom.
fn heights(work: &Work, deepest: f64) -> Vec<f64> {
    let count = (deepest / work.cutting.depth_per_pass - 1e-9).ceil().max(1.0) as usize;
    (1..=count).map(|k| work.top - deepest * (k as f64 / count as f64)).collect()
}

/// The rings of the tip over the bottom, beginning a step inside of its edge, along which the carving goes.
fn rings(work: &Work, flat: &Region, step: f64) -> Result<Vec<Region>, OperationError> {
    let stays = flat.reversed();
    let mut rings = Vec::new();
    let ToolShape::Cone { tip_diameter, .. } = work.tool.shape else { return Ok(rings) };
    for k in 1..MOST_RINGS {
        let level = Level::new(&stays, 0.5 * tip_diameter + k as f64 * step, 0.0, work.cutting.topology)?;
        if level.path.is_empty() {
            break;
        }
        rings.push(level.path);
    }
    Ok(rings)
}
