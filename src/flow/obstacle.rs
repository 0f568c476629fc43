//! What the flow may not do: the bound on curvature.

/// The curvatures at which a boundary stays where it is, in units of 1/r: an interval.
///
/// Curvature is positive where the solid is convex. Closing, opening, clopening and the flow without a bound differ in
/// these two numbers alone (eq. 7, 8 and Fig. 29 of the paper).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle {
    lowest: f64,
    highest: f64,
}

/// The way in which a vertex moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Away from the solid: where the boundary is too concave.
    Outward,
    /// Into the solid: where it is too convex.
    Inward,
}

impl Obstacle {
    /// Concave places may not be sharper than the disk.
    pub const CLOSING: Obstacle = Obstacle { lowest: -1.0, highest: f64::INFINITY };
    /// Convex places may not be sharper than the disk.
    pub const OPENING: Obstacle = Obstacle { lowest: f64::NEG_INFINITY, highest: 1.0 };
    /// Both.
    pub const CLOPENING: Obstacle = Obstacle { lowest: -1.0, highest: 1.0 };
    /// Nothing that is curved stays: curve shortening, for comparison.
    pub const NONE: Obstacle = Obstacle { lowest: 0.0, highest: 0.0 };

    /// Which way a vertex moves whose curvature comes to `curvature` where 1/r comes to `unit`; `None`: it stays. Differences
    /// up to `slack` are rounding.
    pub fn release(&self, curvature: f64, unit: f64, slack: f64) -> Option<Way> {
        [Way::Outward, Way::Inward].into_iter().find(|way| self.beyond(*way, curvature, unit) > slack)
    }

    /// How far `curvature` is beyond the bound at which vertices move that `way`; negative within it.
    pub fn beyond(&self, way: Way, curvature: f64, unit: f64) -> f64 {
        match way {
            Way::Outward => self.lowest * unit - curvature,
            Way::Inward => curvature - self.highest * unit,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_bound_lets_go_what_is_beyond_it() {
        let ways = |o: Obstacle| [-1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5].map(|c| o.release(c, 1.0, 1e-9));
        let (out, stay, inward) = (Some(Way::Outward), None, Some(Way::Inward));
        assert_eq!(ways(Obstacle::CLOSING), [out, stay, stay, stay, stay, stay, stay]);
        assert_eq!(ways(Obstacle::OPENING), [stay, stay, stay, stay, stay, stay, inward]);
        assert_eq!(ways(Obstacle::CLOPENING), [out, stay, stay, stay, stay, stay, inward]);
        assert_eq!(ways(Obstacle::NONE), [out, out, out, stay, inward, inward, inward]);
    }
}
