//! Whether two regions have something in common.

use super::{BoundaryIndex, Point, Region, inscribed_circle};

/// Points nearer to a boundary than this, relative to the regions' size, are on it: rounding of drawings.
const ON_BOUNDARY: f64 = 1e-7;

impl Region {
    /// Whether the solids share more than pieces of their boundaries.
    ///
    /// Judged at the ends and middles of all elements, and, for regions whose boundaries agree, at the middle of the largest
    /// circle in the simpler one: a corner that only just reaches into the other region between two of its own may be missed
    /// where its elements cross both times far from their middles.
    pub fn overlaps(&self, other: &Region) -> bool {
        let bounds = (self.bounds(), other.bounds());
        if self.is_empty() || other.is_empty() || !bounds.0.overlaps(&bounds.1) {
            return false;
        }
        if self == other {
            return true;
        }
        let tolerance = ON_BOUNDARY * bounds.0.union(bounds.1).diagonal();
        let (simple, rich) = if self.vertex_count() <= other.vertex_count() { (self, other) } else { (other, self) };
        let index = BoundaryIndex::new(rich);
        let is_inside = |p: Point| index.winding_number(p) > 0 && !index.is_nearer(p, tolerance);
        reaches_into(simple, is_inside) || is_inside(inscribed_circle(simple).center) || {
            let index = BoundaryIndex::new(simple);
            reaches_into(rich, |p| index.winding_number(p) > 0 && !index.is_nearer(p, tolerance))
        }
    }
}

impl Region {
    /// Whether the solid of `other` lies in the solid of this one, judged as in [`overlaps`](Region::overlaps).
    pub fn covers(&self, other: &Region) -> bool {
        if self.is_empty() || other.is_empty() {
            return other.is_empty();
        }
        let index = BoundaryIndex::new(self);
        let tolerance = ON_BOUNDARY * self.bounds().union(other.bounds()).diagonal();
        let is_in = |p: Point| index.winding_number(p) > 0 || index.is_nearer(p, tolerance);
        let others = BoundaryIndex::new(other);
        // A hole of this one in the middle of the other is seen from its own boundary.
        let is_in_other = |p: Point| others.winding_number(p) > 0 && !others.is_nearer(p, tolerance);
        is_in(inscribed_circle(other).center)
            && other.segments().all(|s| is_in(s.start) && is_in(s.point_at(0.5)))
            && !self.segments().any(|s| is_in_other(s.start) || is_in_other(s.point_at(0.5)))
    }
}

fn reaches_into(one: &Region, is_inside: impl Fn(Point) -> bool) -> bool {
    one.segments().any(|s| is_inside(s.start) || is_inside(s.point_at(0.5)))
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
        assert!(!ring.covers(&unit) && !unit.covers(&ring));
        assert!(unit.covers(&unit) && square(-1.0, 3.0).covers(&ring) && !ring.covers(&square(-1.0, 3.0)));
        assert!(!unit.overlaps(&Region::default()));
    }
}
