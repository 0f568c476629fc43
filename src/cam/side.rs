//! Which side of the drawn outlines the tool runs on, and what has to be closed for it.

use super::Job;
use super::solid::{Remainder, Solid};
use crate::plane::Region;

/// Where the tool runs relative to the drawn outlines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// Outside of parts and inside of their holes: the drawn solid is what is kept.
    Outside,
    /// Inside of outlines and outside of their holes: everything but the drawn solid is kept.
    Inside,
    /// The tool's centre runs on the outline.
    On,
}

impl Side {
    /// The region whose material stays, with the solid on the left of its boundary.
    ///
    /// This is what has to be closed by [`Job::closing_radius`] before [`super::plan`]: the tool is a disk that rolls
    /// along what stays. Inside, that is the complement of the drawing, whose boundary is the drawing's run backwards.
    pub fn kept_material(self, part: &Region) -> Region {
        match self {
            Side::Outside | Side::On => part.clone(),
            Side::Inside => part.reversed(),
        }
    }
}

impl Side {
    /// What [`Side::kept_material`] was closed to, for questions of where the tool may be.
    ///
    /// Inside, what stays is all but a region, and winding numbers know regions only.
    pub(super) fn solid(self, closed: &Region) -> Solid {
        match self {
            Side::Outside | Side::On => Solid::new(closed, Remainder::Inside),
            Side::Inside => Solid::new(&closed.reversed(), Remainder::Outside),
        }
    }
}

impl Job {
    /// How far the tool's centre keeps from the material that stays, in millimetres.
    pub fn offset_distance(&self) -> f64 {
        match self.side {
            Side::Outside | Side::Inside => 0.5 * self.tool_diameter,
            Side::On => 0.0,
        }
    }

    /// The radius by which [`Side::kept_material`] is to be closed, in millimetres: [`Job::offset_distance`] plus the
    /// radius of the path. Zero, on the outline with no path radius, means that nothing is to be closed.
    ///
    /// A closing by R bounds the radius of concave features from below by R, and the offset by d then leaves R - d.
    pub fn closing_radius(&self) -> f64 {
        self.offset_distance() + self.path_radius_mm()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cam::PathRadius;
    use crate::plane::{Point, Ring};

    #[test]
    fn what_stays_lies_on_the_other_side_when_cutting_inside() {
        let square = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
        let mut part = Region::new(vec![Ring::polygon(square.map(|(x, y)| Point::new(x, y)))]);
        part.rings.push(Ring::circle(Point::new(5.0, 5.0), 2.0).reversed());
        assert_eq!(Side::Outside.kept_material(&part), part);
        let kept = Side::Inside.kept_material(&part);
        assert_eq!(kept.area(), -part.area());
        // The island in the middle stays: it is solid, and counterclockwise.
        assert!(kept.rings[1].area() > 0.0);
    }

    #[test]
    fn closing_leaves_the_path_its_radius() {
        let job = Job { tool_diameter: 4.0, path_radius: PathRadius::Length(1.5), ..Job::default() };
        assert_eq!(job.closing_radius(), 3.5);
        assert_eq!(Job { side: Side::Inside, ..job.clone() }.closing_radius(), 3.5);
        assert_eq!(Job { side: Side::On, ..job }.closing_radius(), 1.5);
    }
}
