//! Cutters: what a tool's shape is, and what it may be asked to do.

/// The shape of a cutter below its shank.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ToolShape {
    /// A square end mill.
    Flat,
    /// A ball end mill: a half sphere under a cylinder.
    Ball,
    /// A cone, as V bits, engravers and drills are.
    Cone {
        /// The angle between opposite sides, in radians, above 0 and below pi.
        angle: f64,
        /// Diameter of the flat at the tip in millimetres; 0 for a sharp one.
        tip_diameter: f64,
    },
}

/// A tool of a job. Lengths are millimetres.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Tool {
    /// Its number in the machine's tool table (T word), 1 or more.
    pub number: u32,
    /// What people call it.
    pub name: String,
    /// Its shape.
    pub shape: ToolShape,
    /// Whether it is a drill: it cuts only along its axis.
    pub is_drill: bool,
    /// Diameter at its widest.
    pub diameter: f64,
    /// How many cutting edges it has.
    pub flutes: u32,
    /// Length of the cutting edges: it may cut no deeper in one pass. Infinite where it is not known.
    pub flute_length: f64,
}

impl Tool {
    /// A square end mill of two flutes, known by its number.
    pub fn flat(number: u32, diameter: f64) -> Tool {
        let name = format!("tool {number}");
        let shape = ToolShape::Flat;
        Tool { number, name, shape, is_drill: false, diameter, flutes: 2, flute_length: f64::INFINITY }
    }

    /// Half of the diameter.
    pub fn radius(&self) -> f64 {
        0.5 * self.diameter
    }

    /// How far above the tip the cutter's surface is at `distance` from the axis; `None` beyond its radius.
    pub fn height_at(&self, distance: f64) -> Option<f64> {
        let radius = self.radius();
        if !(0.0..=radius).contains(&distance) {
            return None;
        }
        Some(match self.shape {
            ToolShape::Flat => 0.0,
            ToolShape::Ball => radius - (radius * radius - distance * distance).max(0.0).sqrt(),
            ToolShape::Cone { angle, tip_diameter } => (distance - 0.5 * tip_diameter).max(0.0) / (0.5 * angle).tan(),
        })
    }

    /// The radius of the cut that the tool leaves in a plane `depth` above its tip; 0 below it.
    pub fn radius_at(&self, depth: f64) -> f64 {
        let radius = self.radius();
        match self.shape {
            _ if depth < 0.0 => 0.0,
            ToolShape::Flat => radius,
            ToolShape::Ball if depth >= radius => radius,
            ToolShape::Ball => (depth * (2.0 * radius - depth)).sqrt(),
            ToolShape::Cone { angle, tip_diameter } => radius.min(0.5 * tip_diameter + depth * (0.5 * angle).tan()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tool(shape: ToolShape) -> Tool {
        Tool { number: 1, name: String::new(), shape, is_drill: false, diameter: 6.0, flutes: 2, flute_length: 20.0 }
    }

    #[test]
    fn height_and_radius_are_inverse_on_the_sloping_part() {
        let right_angle = std::f64::consts::FRAC_PI_2;
        for shape in [ToolShape::Ball, ToolShape::Cone { angle: right_angle, tip_diameter: 0.5 }] {
            let tool = tool(shape);
            for depth in [0.1, 0.5, 1.0, 2.0, 2.7] {
                let radius = tool.radius_at(depth);
                assert!((tool.height_at(radius).unwrap() - depth).abs() < 1e-12, "{shape:?} at {depth}");
            }
        }
    }

    #[test]
    fn shapes_have_their_own_bottoms() {
        assert_eq!(tool(ToolShape::Flat).height_at(3.0), Some(0.0));
        assert_eq!(tool(ToolShape::Flat).height_at(3.1), None);
        assert_eq!(tool(ToolShape::Ball).height_at(3.0), Some(3.0));
        let cone = tool(ToolShape::Cone { angle: std::f64::consts::FRAC_PI_2, tip_diameter: 1.0 });
        assert_eq!(cone.height_at(0.5), Some(0.0));
        assert!((cone.height_at(2.0).unwrap() - 1.5).abs() < 1e-12);
        assert_eq!(cone.radius_at(100.0), 3.0);
        assert_eq!(cone.radius_at(-1.0), 0.0);
    }
}
