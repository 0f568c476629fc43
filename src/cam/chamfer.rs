//! How a V bit breaks an edge.

use super::{Tool, ToolShape};

/// Where the tip of a V bit runs to cut a chamfer.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Chamfer {
    /// How far the axis keeps from the wall below the edge, in millimetres.
    pub offset: f64,
    /// How far the tip is below the top of the part, in millimetres.
    pub depth: f64,
}

/// Why a chamfer cannot be cut.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ChamferError {
    /// The tool has no slope.
    #[error("a chamfer is cut with the side of a cone: use a V bit (shape cone, with its angle)")]
    NotACone,
    /// A width or an overhang that is none.
    #[error("the {what} is {value}: it must be a finite number of millimetres, {least}")]
    InvalidLength {
        /// What it is.
        what: &'static str,
        /// What was given.
        value: f64,
        /// What it must be.
        least: &'static str,
    },
    /// The cone is too small.
    #[error(
        "the chamfer needs a tool {needed:.3} mm wide, and this one has {diameter:.3} mm: use a larger one, or a smaller \
         width or overhang"
    )]
    TooWide {
        /// The diameter needed.
        needed: f64,
        /// The tool's.
        diameter: f64,
    },
}

/// How a V bit runs along a wall to cut a chamfer that is `width` wide, seen from above, with its side alone: the tip hangs
/// `overhang` below the lower end of the chamfer, so that neither the tip nor its flat ever touches the part. Millimetres.
///
/// The cone is wider by tan(angle/2) a millimetre of height. At the lower end of the chamfer, `overhang` above the tip, it
/// has to be as wide as the wall is far, and at the top of the part wider by the width of the chamfer.
///
/// # Errors
/// Where the tool is no cone, a length is none, or the cone is not wide enough.
pub fn chamfer_depth(tool: &Tool, width: f64, overhang: f64) -> Result<Chamfer, ChamferError> {
    let ToolShape::Cone { angle, tip_diameter } = tool.shape else { return Err(ChamferError::NotACone) };
    let slope = (0.5 * angle).tan();
    if !(slope.is_finite() && slope > 0.0) {
        return Err(ChamferError::NotACone);
    }
    if !(width.is_finite() && width > 0.0) {
        return Err(ChamferError::InvalidLength { what: "width of the chamfer", value: width, least: "above zero" });
    }
    if !(overhang.is_finite() && overhang >= 0.0) {
        return Err(ChamferError::InvalidLength { what: "overhang", value: overhang, least: "zero or more" });
    }
    let offset = 0.5 * tip_diameter + overhang * slope;
    let needed = 2.0 * (offset + width);
    if needed > tool.diameter {
        return Err(ChamferError::TooWide { needed, diameter: tool.diameter });
    }
    Ok(Chamfer { offset, depth: width / slope + overhang })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn v_bit(degrees: f64, tip_diameter: f64) -> Tool {
        let shape = ToolShape::Cone { angle: f64::to_radians(degrees), tip_diameter };
        Tool { number: 1, name: String::new(), shape, is_drill: false, diameter: 12.0, flutes: 2, flute_length: 10.0 }
    }

    #[test]
    fn a_right_angle_cuts_as_deep_as_wide() {
        let chamfer = chamfer_depth(&v_bit(90.0, 0.0), 1.0, 0.5).unwrap();
        assert!((chamfer.depth - 1.5).abs() < 1e-12 && (chamfer.offset - 0.5).abs() < 1e-12);
    }

    #[test]
    fn the_side_meets_the_wall_below_the_chamfer_and_the_top_beside_it() {
        for (degrees, tip, width, overhang) in [(60.0, 0.0, 0.5, 0.2), (90.0, 0.4, 2.0, 0.0), (120.0, 0.1, 1.0, 1.0)] {
            let tool = v_bit(degrees, tip);
            let chamfer = chamfer_depth(&tool, width, overhang).unwrap();
            assert!((tool.radius_at(chamfer.depth) - (chamfer.offset + width)).abs() < 1e-12);
            assert!((tool.radius_at(overhang) - chamfer.offset).abs() < 1e-12);
            // The flat of the tip is beside the wall, not under it.
            assert!(0.5 * tip <= chamfer.offset);
        }
    }

    #[test]
    fn what_cannot_be_cut_is_refused() {
        let bit = v_bit(90.0, 0.0);
        assert_eq!(chamfer_depth(&bit, 5.0, 2.0), Err(ChamferError::TooWide { needed: 14.0, diameter: 12.0 }));
        assert!(matches!(chamfer_depth(&bit, 0.0, 1.0), Err(ChamferError::InvalidLength { .. })));
        assert!(matches!(chamfer_depth(&bit, 1.0, f64::NAN), Err(ChamferError::InvalidLength { .. })));
        let flat = Tool { shape: ToolShape::Flat, ..bit };
        assert_eq!(chamfer_depth(&flat, 1.0, 0.1), Err(ChamferError::NotACone));
    }
}
