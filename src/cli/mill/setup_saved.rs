//! What the path radii of a job save.

use super::setup::{Written, steps};
use crate::cam::{Geometry, Operation, OperationKind, PathRadius, Planned, Program, Setup, TimeSaved, plan_operation};
use crate::cli::engaged::with_heights;
use crate::gcode::{self, Dialect, WriteOptions};

/// The programs of a job with sharp inside corners.
pub(super) struct SharpPrograms {
    programs: Vec<Program>,
    same_outlines: bool,
}

/// The job with sharp inside corners; `None` where nothing is rounded.
pub(super) fn sharp_setup(setup: &Setup) -> Option<Setup> {
    let mut sharp = setup.clone();
    for operation in sharp.operations.iter_mut().filter(|o| is_rounded(o)) {
        operation.cutting.path_radius = PathRadius::Length(0.0);
    }
    (sharp.operations != setup.operations).then_some(sharp)
}

/// The plan of an operation with sharp inside corners; `None` where it has none to round or cannot be planned so.
pub(super) fn sharp_plan(setup: &Setup, sharp: &Setup, index: usize, geometry: &Geometry) -> Option<Planned> {
    let operation = &sharp.operations[index];
    (*operation != setup.operations[index]).then(|| plan_operation(sharp, operation, geometry).ok()).flatten()
}

/// The job written with those operations that could be planned with sharp inside corners, the others as they are.
pub(super) fn sharp_programs(
    setup: &Setup,
    sharp: &Setup,
    dialect: &Dialect,
    options: WriteOptions,
    rounded: &[Planned],
    sharp_plans: Vec<Option<Planned>>,
) -> Option<SharpPrograms> {
    let mut same_outlines = true;
    let mut planned = Vec::new();
    for ((operation, rounded), plan) in setup.operations.iter().zip(rounded).zip(sharp_plans) {
        let plan = plan.unwrap_or_else(|| rounded.clone());
        let is_profile = matches!(operation.kind, OperationKind::Profile { rest_of: None, .. });
        same_outlines &= !is_profile || plan.toolpath.contour_count == rounded.toolpath.contour_count;
        planned.push(plan);
    }
    let files = gcode::write_files(&steps(sharp, &planned), &[], dialect, options).ok()?;
    let deepest = setup.operations.iter().map(|o| o.cutting.depth).fold(0.0, f64::max);
    let read = |text: &str| {
        let program = gcode::read_as(text, dialect).ok()?;
        Some(with_heights(program, dialect, setup.rig.safe_height, setup.stock.top - deepest))
    };
    let programs = files.iter().map(|file| read(&file.text)).collect::<Option<Vec<Program>>>()?;
    Some(SharpPrograms { programs, same_outlines })
}

impl SharpPrograms {
    /// What the programs of the job save against these.
    pub(super) fn saves(&self, setup: &Setup, written: &[Written]) -> TimeSaved {
        let none = TimeSaved { same_outlines: self.same_outlines, ..TimeSaved::default() };
        self.programs.iter().zip(written).fold(none, |saved, (sharp, written)| {
            saved.and(&TimeSaved::between(&written.program, sharp, &setup.rig.limits, setup.stock.top))
        })
    }
}

/// Whether the path of an operation is rounded in inside corners: along lines and holes, and over faces, there are none.
fn is_rounded(operation: &Operation) -> bool {
    matches!(
        operation.kind,
        OperationKind::Profile { .. } | OperationKind::Pocket { .. } | OperationKind::Chamfer { .. }
    )
}
