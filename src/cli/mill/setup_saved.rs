//! What the path radii of a job save.

use anyhow::Result;

use super::setup::{Done, Written, steps};
use crate::cam::{Geometry, Hole, Operation, OperationKind, PathRadius, Setup, TimeSaved, plan_operation};
use crate::cli::engaged::with_heights;
use crate::gcode::{self, Dialect, WriteOptions};

/// What the path radii save: every operation that can be planned with sharp inside corners planned and written so, the others as
/// they are. `None` where nothing is rounded.
pub(super) fn time_saved(
    setup: &Setup,
    dialect: &Dialect,
    options: WriteOptions,
    done: &[Done],
    written: &[Written],
    drawn: &impl Fn(&Operation, &[Hole]) -> Result<Geometry>,
) -> Option<TimeSaved> {
    let mut sharp = setup.clone();
    for operation in sharp.operations.iter_mut().filter(|o| is_rounded(o)) {
        operation.cutting.path_radius = PathRadius::Length(0.0);
    }
    if sharp.operations == setup.operations {
        return None;
    }
    let mut holes: Vec<Hole> = Vec::new();
    let mut same_outlines = true;
    let mut planned = Vec::new();
    for (operation, done) in sharp.operations.iter().zip(done) {
        let plan = match is_rounded(operation) && *operation != *done.operation {
            true => {
                let geometry = drawn(operation, &holes).ok()?;
                plan_operation(&sharp, operation, &geometry).unwrap_or_else(|_| done.planned.clone())
            }
            false => done.planned.clone(),
        };
        let is_profile = matches!(operation.kind, OperationKind::Profile { rest_of: None, .. });
        same_outlines &= !is_profile || plan.toolpath.contour_count == done.planned.toolpath.contour_count;
        holes.extend(&plan.holes);
        planned.push(plan);
    }
    let files = gcode::write_files(&steps(&sharp, &planned), &[], dialect, options).ok()?;
    let mut saved = TimeSaved { same_outlines, ..TimeSaved::default() };
    for (file, written) in files.iter().zip(written) {
        let deepest = setup.operations.iter().map(|o| o.cutting.depth).fold(0.0, f64::max);
        let program = gcode::read_as(&file.text, dialect).ok()?;
        let program = with_heights(program, dialect, setup.rig.safe_height, setup.stock.top - deepest);
        saved = saved.and(&TimeSaved::between(&written.program, &program, &setup.rig.limits, setup.stock.top));
    }
    Some(saved)
}

/// Whether the path of an operation is rounded in inside corners: along lines and holes, and over faces, there are none.
fn is_rounded(operation: &Operation) -> bool {
    matches!(
        operation.kind,
        OperationKind::Profile { .. } | OperationKind::Pocket { .. } | OperationKind::Chamfer { .. }
    )
}
