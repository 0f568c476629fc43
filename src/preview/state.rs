//! One state of a drawing against what it was made from: what is there is solid, what came or went is coloured.

use tiny_skia::Path;

use super::canvas::{Canvas, View};
use super::outline::SAME_BOUNDARY;
use super::palette;
use crate::plane::{BoundaryIndex, Bounds, Region, Segment};

/// What states are compared with, arranged once for many of them.
pub(super) struct Before<'a> {
    region: &'a Region,
    index: BoundaryIndex,
    tolerance: f64,
}

/// What of a state differs from what it was made from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Changes {
    pub(super) added: bool,
    pub(super) removed: bool,
}

impl<'a> Before<'a> {
    pub(super) fn new(region: &'a Region) -> Before<'a> {
        let tolerance = SAME_BOUNDARY * region.bounds().diagonal();
        Before { region, index: BoundaryIndex::new(region), tolerance }
    }

    pub(super) fn bounds(&self) -> Bounds {
        self.region.bounds()
    }

    /// What `after` adds and takes away: told by the sides on which its moved elements, and the elements of the old boundary
    /// that it left, lie.
    pub(super) fn changes(&self, after: &Region) -> Changes {
        let (_, moved) = self.split(after);
        let now = Before { region: after, index: BoundaryIndex::new(after), tolerance: self.tolerance };
        let (_, left) = now.split(self.region);
        let is_in = |of: &Before, element: &Segment| of.index.winding_number(element.point_at(0.5)) > 0;
        // A moved element in the old solid has left solid behind; one outside of it has made some.
        Changes {
            added: moved.iter().any(|s| !is_in(self, s)) || left.iter().any(|s| is_in(&now, s)),
            removed: moved.iter().any(|s| is_in(self, s)) || left.iter().any(|s| !is_in(&now, s)),
        }
    }

    /// The elements of `region` that lie on the boundary, and those that do not.
    fn split(&self, region: &Region) -> (Vec<Segment>, Vec<Segment>) {
        region.segments().partition(|s| self.index.is_nearer(s.point_at(0.5), self.tolerance))
    }

    /// Draws `after`; lines of ordinary width take `weight` pixels.
    pub(super) fn draw(&self, after: &Region, canvas: &mut Canvas, view: &View, weight: f64) {
        let (new, old): (Option<Path>, Option<Path>) = (view.region(after), view.region(self.region));
        canvas.fill(new.as_ref(), palette::ADDED, None);
        canvas.fill(old.as_ref(), palette::REMOVED, None);
        if let Some(mask) = canvas.mask(new.as_ref()) {
            canvas.fill(old.as_ref(), palette::SOLID, Some(&mask));
        }
        let (kept, moved) = self.split(after);
        // What is still there of the old boundary is drawn over.
        canvas.stroke(&view.elements(self.region.segments()), palette::BEFORE, weight, None);
        canvas.stroke(&view.elements(kept), palette::SOLID, weight, None);
        canvas.stroke(&view.elements(moved), palette::MOVED, 1.5 * weight, None);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::{Point, Ring};

    fn square(side: f64) -> Region {
        let p = Point::new;
        Region::new(vec![Ring::polygon([p(0.0, 0.0), p(side, 0.0), p(side, side), p(0.0, side)])])
    }

    #[test]
    fn what_is_added_is_told_from_what_is_removed() {
        let (small, large) = (square(1.0), square(2.0));
        let changes = |before: &Region, after: &Region| Before::new(before).changes(after);
        assert_eq!(changes(&small, &large), Changes { added: true, removed: false });
        assert_eq!(changes(&large, &small), Changes { added: false, removed: true });
        assert_eq!(changes(&large, &large), Changes::default());
        assert_eq!(changes(&large, &Region::default()), Changes { added: false, removed: true });
        let holed = Region::new(vec![square(2.0).rings.remove(0), Ring::circle(Point::new(1.0, 1.0), 0.2).reversed()]);
        assert_eq!(changes(&holed, &large), Changes { added: true, removed: false });
        assert_eq!(changes(&large, &holed), Changes { added: false, removed: true });
    }
}
