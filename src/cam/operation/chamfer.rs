//! Edges broken by the side of a cone.

use super::{Corners, Geometry, OperationError, Planned, Work, profile};
use crate::cam::{Cutting, Side, Tool, ToolShape};

/// How far the tip hangs below the chamfer, as a share of the tool's diameter: tips are weak and do not turn fast.
const OVERHANG: f64 = 0.1;

/// Where a cone runs that cuts a chamfer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ChamferCut {
    /// Distance of the axis from the edge below the chamfer.
    pub distance: f64,
    /// Depth of the tip below the upper edge.
    pub depth: f64,
}

impl ChamferCut {
    /// The cut of a chamfer that is `width` wide, seen from above.
    ///
    /// The side of the cone goes through both edges of the chamfer: at depth h = width / tan(angle / 2), the lower one, its
    /// radius is the distance; at the top it is wider by the width.
    ///
    /// # Errors
    /// Where the cone's side is too narrow.
    pub(super) fn new(tool: &Tool, width: f64) -> Result<ChamferCut, OperationError> {
        let ToolShape::Cone { angle, tip_diameter } = tool.shape else {
            return Err(OperationError::ChamferTooWide { width, reach: 0.0 });
        };
        let slope = (0.5 * angle).tan();
        let reach = tool.radius() - 0.5 * tip_diameter;
        if width > reach {
            return Err(OperationError::ChamferTooWide { width, reach });
        }
        let overhang = (OVERHANG * tool.diameter).min((reach - width) / slope);
        Ok(ChamferCut { distance: 0.5 * tip_diameter + overhang * slope, depth: width / slope + overhang })
    }
}

pub(super) fn plan(work: &Work, geometry: &Geometry, side: Side, width: f64) -> Result<Planned, OperationError> {
    let cut = ChamferCut::new(work.tool, width)?;
    // The profile of a tool as wide as the cone is at the lower edge.
    let tool = Tool { diameter: 2.0 * cut.distance, ..work.tool.clone() };
    let cutting = Cutting { depth: work.cutting.start_depth + cut.depth, ..work.cutting.clone() };
    let narrow = Work { tool: &tool, cutting: &cutting, floor: work.top - cut.depth, ..*work };
    profile::plan(&narrow, geometry, side, Corners::Round)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_edges_of_a_chamfer_lie_on_the_cone() {
        let shape = ToolShape::Cone { angle: std::f64::consts::FRAC_PI_2, tip_diameter: 0.4 };
        let tool = Tool { shape, ..Tool::flat(1, 10.0) };
        let cut = ChamferCut::new(&tool, 1.5).unwrap();
        // 45 degrees: as deep as it is wide; the tip a tenth of the diameter deeper.
        assert!((cut.depth - 2.5).abs() < 1e-12);
        assert!((tool.radius_at(cut.depth) - (cut.distance + 1.5)).abs() < 1e-12);
        assert!((tool.radius_at(cut.depth - 1.5) - cut.distance).abs() < 1e-12);
        assert!(matches!(ChamferCut::new(&tool, 5.0), Err(OperationError::ChamferTooWide { .. })));
        assert!(ChamferCut::new(&Tool::flat(1, 10.0), 1.0).is_err());
    }
}
