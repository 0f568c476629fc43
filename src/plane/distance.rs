//! Distance from points to the boundary of a region.

use super::{Approach, Bounds, ChainTree, Nearest, Point, Region, Segment};

/// The boundary of a region, arranged for many distance queries.
#[derive(Clone, Debug)]
pub struct BoundaryIndex {
    segments: Vec<Segment>,
    tree: ChainTree,
}

impl BoundaryIndex {
    /// The index of all boundary elements of `region`.
    pub fn new(region: &Region) -> BoundaryIndex {
        BoundaryIndex::of_segments(region.segments().collect())
    }

    /// The index of any boundary elements; best where consecutive ones are neighbours.
    pub fn of_segments(segments: Vec<Segment>) -> BoundaryIndex {
        let boxes: Vec<Bounds> = segments.iter().map(Segment::bounds).collect();
        BoundaryIndex { tree: ChainTree::new(&boxes), segments }
    }

    /// The elements, numbered as in the queries.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// The nearest element to `p` and its nearest point; `None` without elements.
    pub fn nearest(&self, p: Point) -> Option<(usize, Nearest)> {
        let best = std::cell::Cell::new(None::<(usize, Nearest)>);
        self.tree.visit_near(
            p,
            || best.get().map_or(f64::INFINITY, |(_, n)| n.distance),
            |i| {
                let n = self.segments[i].nearest(p);
                if best.get().is_none_or(|(_, b)| n.distance < b.distance) {
                    best.set(Some((i, n)));
                }
            },
        );
        best.get()
    }

    /// Distance from `p` to the boundary; infinite without elements.
    pub fn distance(&self, p: Point) -> f64 {
        self.nearest(p).map_or(f64::INFINITY, |(_, n)| n.distance)
    }

    /// The element that comes nearest to `element`, and where; `None` without elements.
    pub fn approach(&self, element: &Segment) -> Option<(usize, Approach)> {
        // A first guess keeps the search from testing all elements near the box of a long one.
        let (guess, _) = self.nearest(element.point_at(0.5))?;
        let best = std::cell::Cell::new((guess, element.approach(&self.segments[guess])));
        self.tree.visit_near_box(
            &element.bounds(),
            || best.get().1.distance,
            |i| {
                let found = element.approach(&self.segments[i]);
                if found.distance < best.get().1.distance {
                    best.set((i, found));
                }
            },
        );
        Some(best.get())
    }

    /// How often the elements, taken as closed rings, run counterclockwise around `p`.
    pub fn winding_number(&self, p: Point) -> i32 {
        let ray = Bounds { min: p, max: Point::new(f64::INFINITY, p.y) };
        let mut winding = 0;
        self.tree.visit_near_box(&ray, || 0.0, |i| winding += self.segments[i].ray_crossings(p));
        winding
    }

    /// Whether some element lies nearer to `p` than `limit`.
    pub fn is_nearer(&self, p: Point, limit: f64) -> bool {
        self.tree.any_near(p, limit, |i| self.segments[i].is_nearer(p, limit))
    }
}
