//! Areas of the plane in which nothing moves.

use super::{BoundaryIndex, Bounds, Point, Region, Segment};

/// An area whose points stay where they are. Its border belongs to it.
#[derive(Clone, Debug)]
pub enum PinnedArea {
    /// An axis-parallel rectangle.
    Rectangle(Bounds),
    /// A disk.
    Disk {
        /// Its middle.
        center: Point,
        /// Its radius.
        radius: f64,
    },
    /// Any region.
    Region(PinnedRegion),
}

/// A region with its boundary arranged for queries.
#[derive(Clone, Debug)]
pub struct PinnedRegion {
    boundary: BoundaryIndex,
    /// What lies so near to the boundary lies on it.
    on_boundary: f64,
}

/// Rounding of points of a boundary, as a fraction of the size of their region and its distance from the origin: what was
/// computed on it by some operations lies within this of it.
const ROUNDING: f64 = 1e-12;

impl PinnedRegion {
    /// The solid of `region`.
    pub fn new(region: &Region) -> PinnedRegion {
        let bounds = region.bounds();
        let far = [bounds.min, bounds.max].iter().map(|p| p.coords.norm()).fold(0.0, f64::max);
        PinnedRegion { boundary: BoundaryIndex::new(region), on_boundary: ROUNDING * far }
    }

    fn contains(&self, p: Point) -> bool {
        self.boundary.winding_number(p) > 0 || self.boundary.distance(p) <= self.on_boundary
    }
}

impl PinnedArea {
    /// Whether `p` lies in the area or on its border.
    pub fn contains(&self, p: Point) -> bool {
        match self {
            PinnedArea::Rectangle(bounds) => bounds.contains(p),
            PinnedArea::Disk { center, radius } => (p - center).norm() <= *radius,
            PinnedArea::Region(region) => region.contains(p),
        }
    }

    /// The distance of `p` from the area; 0 in it.
    pub fn distance(&self, p: Point) -> f64 {
        if self.contains(p) {
            return 0.0;
        }
        match self {
            PinnedArea::Rectangle(b) => {
                let beyond = |x: f64, low: f64, high: f64| (low - x).max(x - high).max(0.0);
                beyond(p.x, b.min.x, b.max.x).hypot(beyond(p.y, b.min.y, b.max.y))
            }
            PinnedArea::Disk { center, radius } => (p - center).norm() - radius,
            PinnedArea::Region(region) => region.boundary.distance(p),
        }
    }

    /// Whether some point of the boundary `outline` lies in the area.
    pub fn touches(&self, outline: &BoundaryIndex) -> bool {
        match self {
            PinnedArea::Disk { center, radius } => outline.distance(*center) <= *radius,
            PinnedArea::Rectangle(bounds) => {
                let [a, c] = [bounds.min, bounds.max];
                let [b, d] = [Point::new(c.x, a.y), Point::new(a.x, c.y)];
                let sides = [(a, b), (b, c), (c, d), (d, a)].map(|(from, to)| Segment::line(from, to));
                self.holds_a_vertex(outline) || sides.iter().any(|side| meets(outline, side, 0.0))
            }
            PinnedArea::Region(region) => {
                let sides = region.boundary.segments();
                self.holds_a_vertex(outline) || sides.iter().any(|side| meets(outline, side, region.on_boundary))
            }
        }
    }

    fn holds_a_vertex(&self, outline: &BoundaryIndex) -> bool {
        outline.segments().iter().any(|s| self.contains(s.start))
    }
}

fn meets(outline: &BoundaryIndex, side: &Segment, tolerance: f64) -> bool {
    outline.approach(side).is_some_and(|(_, approach)| approach.distance <= tolerance)
}

/// The distance of `p` from the nearest of the areas; 0 in one of them, infinite where there are none.
pub fn pin_distance(areas: &[PinnedArea], p: Point) -> f64 {
    areas.iter().map(|area| area.distance(p)).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Ring;

    fn rectangle(x: [f64; 2], y: [f64; 2]) -> PinnedArea {
        PinnedArea::Rectangle(Bounds { min: Point::new(x[0], y[0]), max: Point::new(x[1], y[1]) })
    }

    fn ring(radius: f64) -> Region {
        Region::new(vec![Ring::circle(Point::origin(), radius), Ring::circle(Point::origin(), 0.5 * radius).reversed()])
    }

    #[test]
    fn borders_belong_to_the_areas() {
        let p = Point::new;
        let area = PinnedArea::Region(PinnedRegion::new(&ring(2.0)));
        for (area, inside, outside) in [
            (rectangle([0.0, 1.0], [0.0, 2.0]), [p(0.5, 1.0), p(1.0, 2.0)], [p(1.1, 1.0), p(0.5, -0.1)]),
            (
                PinnedArea::Disk { center: p(1.0, 0.0), radius: 1.0 },
                [p(1.0, 0.5), p(2.0, 0.0)],
                [p(2.1, 0.0), p(1.0, -1.1)],
            ),
            (area, [p(1.5, 0.2), p(0.0, 2.0)], [p(0.9, 0.0), p(2.1, 0.0)]),
        ] {
            assert!(inside.iter().all(|p| area.contains(*p)), "{area:?}");
            assert!(!outside.iter().any(|p| area.contains(*p)), "{area:?}");
            let far = rectangle([50.0, 51.0], [0.0, 1.0]);
            assert_eq!(pin_distance(&[far.clone(), area.clone()], inside[0]), 0.0);
            for p in outside {
                // What is as far away from the point as the area is touches it there.
                let distance = pin_distance(&[far.clone(), area.clone()], p);
                assert!((distance - 0.1).abs() < 1e-3, "{area:?} is {distance} from {p}");
            }
        }
        assert_eq!(pin_distance(&[], p(0.0, 0.0)), f64::INFINITY);
    }

    #[test]
    fn areas_touch_outlines_and_not_what_lies_within_them() {
        let square =
            Region::new(vec![Ring::polygon([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]].map(Point::from))]);
        let outline = BoundaryIndex::new(&square);
        let disk = |x: f64, y: f64, radius: f64| PinnedArea::Disk { center: Point::new(x, y), radius };
        let region = |x: f64, radius: f64| {
            PinnedArea::Region(PinnedRegion::new(&Region::new(vec![Ring::circle(Point::new(x, 5.0), radius)])))
        };
        for (area, expected) in [
            (rectangle([4.0, 6.0], [-1.0, 1.0]), true),
            (rectangle([-1.0, 11.0], [4.0, 6.0]), true),
            (rectangle([-1.0, 11.0], [-1.0, 11.0]), true),
            (rectangle([4.0, 6.0], [4.0, 6.0]), false),
            (rectangle([10.0, 12.0], [4.0, 6.0]), true),
            (rectangle([10.5, 12.0], [4.0, 6.0]), false),
            (disk(5.0, 5.0, 4.9), false),
            (disk(5.0, 5.0, 5.0), true),
            (disk(12.0, 5.0, 1.9), false),
            (region(5.0, 4.9), false),
            (region(5.0, 5.1), true),
            (region(5.0, 50.0), true),
            (region(15.0, 4.9), false),
        ] {
            assert_eq!(area.touches(&outline), expected, "{area:?}");
        }
        assert!(!rectangle([0.0, 1.0], [0.0, 1.0]).touches(&BoundaryIndex::new(&Region::default())));
    }
}
