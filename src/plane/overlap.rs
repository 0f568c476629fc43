//! Whether two regions have something in common.

use super::{BoundaryIndex, Point, Region, inscribed_circle};

/// Points nearer to a boundary than this, relative to the regions' size, are on it: rounding of drawings.
const ON_BOUNDARY: f64 = 1e-7;

impl Region {
    /// Whether the solids share more than pieces of their boundaries.
    ///
    /// Judged at the middle of the largest circle in each, and at the ends and middles of all elements: a corner that only
    /// just reaches into the other region between two of its own may be missed where its elements cross both times far from
    /// their middles.
    pub fn overlaps(&self, other: &Region) -> bool {
        let bounds = (self.bounds(), other.bounds());
        if self.is_empty() || other.is_empty() || !bounds.0.overlaps(&bounds.1) {
            return false;
        }
        let tolerance = ON_BOUNDARY * bounds.0.union(bounds.1).diagonal();
        reaches_into(self, other, tolerance) || reaches_into(other, self, tolerance)
    }
}

fn reaches_into(one: &Region, other: &Region, tolerance: f64) -> bool {
    let index = BoundaryIndex::new(other);
    let is_inside = |p: Point| index.winding_number(p) > 0 && !index.is_nearer(p, tolerance);
    is_inside(inscribed_circle(one).center) || one.segments().any(|s| is_inside(s.start) || is_inside(s.point_at(0.5)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::{Ring, Vector};

    fn square(at: f64, side: f64) -> Region {
        let far = at + side;
        Region::new(vec![Ring::polygon([(at, at), (far, at), (far, far), (at, far)].map(|(x, y)| Point::new(x, y)))])
    }

    #[test]
    fn equal_nested_and_crossing_regions_overlap_and_neighbours_do_not() {
        let unit = square(0.0, 1.0);
        assert!(unit.overlaps(&unit));
        assert!(unit.overlaps(&square(0.25, 0.5)) && square(0.25, 0.5).overlaps(&unit));
        assert!(unit.overlaps(&square(0.5, 1.0)));
        assert!(!unit.overlaps(&square(2.0, 1.0)));
        // An edge in common is no overlap.
        assert!(!unit.overlaps(&unit.translated(Vector::new(1.0, 0.0))));
        // Nor is what lies in a hole.
        let mut ring = square(-1.0, 3.0);
        ring.rings.extend(square(-0.5, 2.0).reversed().rings);
        assert!(!ring.overlaps(&unit));
        assert!(!unit.overlaps(&Region::default()));
    }
}
