//! Distance from points to the boundary of a region.

use super::{Approach, Bounds, ChainTree, Nearest, Point, Region, Ring, Segment};

/// The boundary of a region, arranged for many distance queries.
#[derive(Clone, Debug)]
pub struct BoundaryIndex {
    segments: Vec<Segment>,
    tree: ChainTree,
}

impl BoundaryIndex {
    /// The index of all boundary elements of `region`, ring after ring; rings that start near each other stand together.
    pub fn new(region: &Region) -> BoundaryIndex {
        BoundaryIndex::of_segments(in_order_of_place(region).into_iter().flat_map(Ring::segments).collect())
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

/// The rings of `region` along a curve that fills the plane (Morton's), by the places where they start: in the order in
/// which they happen to come the boxes of a tree over many small rings would all overlap.
fn in_order_of_place(region: &Region) -> Vec<&Ring> {
    let mut rings: Vec<&Ring> = region.rings.iter().filter(|ring| !ring.is_empty()).collect();
    if rings.len() > 2 {
        let bounds = Bounds::of_points(rings.iter().map(|ring| ring.vertices[0].point));
        rings.sort_by_cached_key(|ring| place_along_curve(ring.vertices[0].point, &bounds));
    }
    rings
}

/// The number of the cell of `p` when `bounds` are quartered sixteen times.
fn place_along_curve(p: Point, bounds: &Bounds) -> u32 {
    const CELLS: f64 = 65_536.0;
    // The cast saturates, and takes what is no number, as in a box without extent, for zero.
    let cell = |x: f64, min: f64, max: f64| ((x - min) / (max - min) * CELLS) as u16;
    let (x, y) = (cell(p.x, bounds.min.x, bounds.max.x), cell(p.y, bounds.min.y, bounds.max.y));
    (0..16)
        .fold(0, |key, bit| key | (u32::from(x >> bit & 1) << (2 * bit)) | (u32::from(y >> bit & 1) << (2 * bit + 1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_in_any_order_are_looked_through_in_order_of_place() {
        const SIDE: u64 = 64;
        let square = |k: u64| {
            let (x, y) = ((k % SIDE) as f64, (k / SIDE) as f64);
            Ring::polygon([(0.0, 0.0), (0.5, 0.0), (0.5, 0.5), (0.0, 0.5)].map(|(a, b)| Point::new(x + a, y + b)))
        };
        // 1 657 has no factor in common with 4 096: every square once, none next to the one before.
        let shuffled: Vec<Ring> = (0..SIDE * SIDE).map(|k| square(k * 1_657 % (SIDE * SIDE))).collect();
        let index = BoundaryIndex::new(&Region::new(shuffled.clone()));
        let step = |s: &[Segment]| (s[1].start - s[0].start).norm();
        let way: f64 = index.segments().windows(2).map(step).sum();
        assert!(way < 4.0 * (SIDE * SIDE) as f64, "the way from ring to ring is {way} long");
        assert_eq!(index.segments().len(), 4 * shuffled.len());
        assert_eq!((index.winding_number(Point::new(7.2, 9.3)), index.winding_number(Point::new(7.7, 9.3))), (1, 0));
    }

    #[test]
    fn rings_that_start_in_one_place_are_all_there() {
        let circle = Ring::circle(Point::new(1.0, 2.0), 3.0);
        let index = BoundaryIndex::new(&Region::new(vec![circle.clone(), Ring::default(), circle.clone(), circle]));
        assert_eq!(index.winding_number(Point::new(1.5, 2.0)), 3);
    }
}
