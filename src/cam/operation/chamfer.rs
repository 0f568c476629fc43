//! Edges broken by the side of a cone.

use super::{Corners, Geometry, OperationError, Planned, Work, profile};
use crate::cam::{Cutting, Side, Tool, ToolShape, chamfer_depth};

/// How far the tip hangs below the chamfer, in tool diameters, where the cone is wide enough: tips are weak and do not
/// turn fast.
const OVERHANG: f64 = 0.1;

pub(super) fn plan(work: &Work, geometry: &Geometry, side: Side, width: f64) -> Result<Planned, OperationError> {
    let cut = chamfer_depth(work.tool, width, overhang(work.tool, width))?;
    work.stays_in_stock(cut.depth)?;
    // The profile of a tool as wide as the cone is at the lower edge.
    let tool = Tool { diameter: 2.0 * cut.offset, ..work.tool.clone() };
    let cutting = Cutting { depth: work.cutting.start_depth + cut.depth, ..work.cutting.clone() };
    let narrow = Work { tool: &tool, cutting: &cutting, floor: work.top - cut.depth, ..*work };
    profile::plan(&narrow, geometry, side, Corners::Round)
}

/// As far as is good for the tip, and no farther than the cone is wide.
fn overhang(tool: &Tool, width: f64) -> f64 {
    let ToolShape::Cone { angle, tip_diameter } = tool.shape else { return 0.0 };
    let reach = (tool.radius() - 0.5 * tip_diameter - width) / (0.5 * angle).tan();
    (OVERHANG * tool.diameter).min(reach.max(0.0))
}
