//! What the path radius of a program saves.

use super::{Plan, Settings, machine, shape};
use crate::cam::{Job, PathRadius, Program, TimeSaved};
use crate::cli::engaged::with_heights;
use crate::gcode;
use crate::plane::Region;

/// The same work planned and written with sharp inside corners.
pub(super) struct SharpPath {
    program: Program,
    contour_count: usize,
}

/// The path with sharp inside corners. `None` where the path is sharp as it is, or the sharp one cannot be planned.
pub(super) fn sharp_path(settings: &Settings, part: &Region) -> Option<SharpPath> {
    let job = &settings.job;
    if job.path_radius_mm() == 0.0 {
        return None;
    }
    let sharp = Job { path_radius: PathRadius::Length(0.0), ..job.clone() };
    let sharp = Settings { job: sharp, dialect: settings.dialect.clone(), ..*settings };
    let toolpath = shape(&sharp, part).ok()?.toolpath;
    let text = gcode::write(&toolpath, &[], &settings.dialect, settings.options).ok()?;
    let program = gcode::read_as(&text, &settings.dialect).ok()?;
    let program = with_heights(program, &settings.dialect, job.safe_height, job.stock_top - job.depth);
    Some(SharpPath { program, contour_count: toolpath.contour_count })
}

impl SharpPath {
    /// What `program`, written of `plan`, saves against it.
    pub(super) fn saves(&self, job: &Job, plan: &Plan, program: &Program) -> TimeSaved {
        let saved = TimeSaved::between(program, &self.program, &machine(job), job.stock_top);
        TimeSaved { same_outlines: self.contour_count == plan.toolpath.contour_count, ..saved }
    }
}
