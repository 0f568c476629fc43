//! Many questions whether a point lies in a region.

use crate::plane::{Point, Region, Segment};

/// The boundary of a region in horizontal bands, so that a ray meets only the elements of its own band.
pub(super) struct Inside {
    bands: Vec<Vec<Segment>>,
    bottom: f64,
    per_height: f64,
}

impl Inside {
    pub(super) fn new(region: &Region) -> Inside {
        let bounds = region.bounds();
        let count = region.vertex_count().clamp(1, 1 << 14);
        let height = bounds.height();
        let per_height = if height > 0.0 { count as f64 / height } else { 0.0 };
        let mut inside = Inside { bands: vec![Vec::new(); count], bottom: bounds.min.y, per_height };
        for s in region.segments() {
            let b = s.bounds();
            for k in inside.band(b.min.y)..=inside.band(b.max.y) {
                inside.bands[k].push(s);
            }
        }
        inside
    }

    fn band(&self, y: f64) -> usize {
        // The cast saturates: whatever lies beyond either end belongs to the last band there.
        (((y - self.bottom) * self.per_height) as usize).min(self.bands.len() - 1)
    }

    /// Whether `p` lies in the solid; unspecified on the boundary itself.
    pub(super) fn contains(&self, p: Point) -> bool {
        self.bands[self.band(p.y)].iter().map(|s| s.ray_crossings(p)).sum::<i32>() > 0
    }
}
