//! What is unusual about a job, though it can be done.

use super::{Operation, OperationKind, Setup};
use crate::cam::{Tool, ToolShape};
use crate::units::Speed;

impl Setup {
    /// What is unusual about feeds and speeds, in sentences: chips too thin or too thick, cutting edges too fast.
    pub fn cutting_warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        for operation in &self.operations {
            let tool = self.tool_of(operation);
            let cutting = &operation.cutting;
            let chip = chip_load(cutting.feed, cutting.spindle_speed, tool.flutes);
            let share = chip / tool.diameter;
            let label = &operation.label;
            if cutting.spindle_speed > 0.0 && !tool.is_drill {
                if share > THICKEST_CHIP {
                    warnings.push(format!(
                        "operation \"{label}\": {chip:.3} mm a tooth is {:.1} % of the tool's diameter, more than most \
                         end mills bear: lower the feed or raise the spindle speed",
                        100.0 * share
                    ));
                } else if chip < THINNEST_CHIP {
                    warnings.push(format!(
                        "operation \"{label}\": {chip:.4} mm a tooth rubs rather than cuts, and dulls the edge: raise the \
                         feed or lower the spindle speed"
                    ));
                }
            }
            let speed = surface_speed(tool.diameter, cutting.spindle_speed);
            if speed > FASTEST_EDGE {
                warnings.push(format!(
                    "operation \"{label}\": the cutting edge runs at {speed:.0} m/min, faster than any common material bears"
                ));
            }
            if let Some(reach) = cut_depth(operation).filter(|depth| *depth > tool.flute_length) {
                warnings.push(format!(
                    "operation \"{label}\": it cuts {reach:.3} mm deep in all, and the flutes of tool {} are {} mm long: the shank \
                     rubs where it is as wide as the tool",
                    tool.number, tool.flute_length
                ));
            }
            warnings.extend(ball_warning(operation, tool).map(|words| format!("operation \"{label}\": {words}")));
        }
        warnings
    }
}

/// How deep an operation cuts into what it has not cut, where that is asked for and does not follow from the shape.
fn cut_depth(operation: &Operation) -> Option<f64> {
    match operation.kind {
        OperationKind::VCarve { .. } | OperationKind::Chamfer { .. } => None,
        _ => Some(operation.cutting.depth - operation.cutting.start_depth),
    }
}

/// What a ball end mill leaves where people expect a flat floor and a sharp foot of the wall.
fn ball_warning(operation: &Operation, tool: &Tool) -> Option<String> {
    if tool.shape != ToolShape::Ball {
        return None;
    }
    let radius = tool.radius();
    let ridge = |stepover: f64| tool.height_at(0.5 * stepover).unwrap_or(radius);
    match operation.kind {
        OperationKind::Pocket { stepover, .. } => Some(format!(
            "a ball end mill leaves ridges {:.3} mm high on the floor, and a fillet of {radius} mm at the foot of the walls",
            ridge(stepover)
        )),
        OperationKind::Facing { stepover } => {
            Some(format!("a ball end mill leaves ridges {:.3} mm high on the face", ridge(stepover)))
        }
        OperationKind::Profile { .. } => Some(format!(
            "a ball end mill leaves a fillet of {radius} mm at the foot of the wall: a flat one, or a cut {radius} mm deeper, leaves none"
        )),
        _ => None,
    }
}

/// Chips thicker than this share of the tool's diameter break small end mills.
const THICKEST_CHIP: f64 = 0.05;

/// Chips thinner than this, in millimetres, are less than the radius of the cutting edge: it rubs.
const THINNEST_CHIP: f64 = 0.002;

/// Faster than this, in metres a minute, no common hobby material is cut: aluminium and wood bear about 1000.
const FASTEST_EDGE: f64 = 3000.0;

/// Millimetres that each tooth cuts: feed / (speed × flutes).
pub fn chip_load(feed: Speed, spindle_speed: f64, flutes: u32) -> f64 {
    feed.mm_per_min() / (spindle_speed * f64::from(flutes.max(1)))
}

/// The speed of the cutting edge in metres a minute.
pub fn surface_speed(diameter: f64, spindle_speed: f64) -> f64 {
    std::f64::consts::PI * diameter * spindle_speed / 1000.0
}
