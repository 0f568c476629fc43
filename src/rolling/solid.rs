//! A region, for questions of distance.

use crate::plane::{BoundaryIndex, Point, Region};

/// Where a region is solid, and how near its boundary is.
pub(super) struct Solid {
    pub(super) index: BoundaryIndex,
    /// 1 where the plane far away is solid, as it is when an opening is computed as the closing of the empty part.
    far_winding: i32,
}

impl Solid {
    /// What a closing starts from.
    pub(super) fn closing(input: &Region) -> Solid {
        Solid::closed(input, input)
    }

    /// What became of `input` in a closing.
    pub(super) fn closed(result: &Region, input: &Region) -> Solid {
        Solid { index: BoundaryIndex::new(result), far_winding: i32::from(input.area() < 0.0) }
    }

    /// Whether `p` lies outside of the solid.
    pub(super) fn is_outside(&self, p: Point) -> bool {
        self.index.winding_number(p) + self.far_winding <= 0
    }
}
