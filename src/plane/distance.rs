//! Distance from points to the boundary of a region.

use std::cell::Cell;
use std::ops::Range;

use super::{Approach, Bounds, ChainTree, Nearest, Point, Region, Ring, Segment};

/// The boundary of a region, arranged for many distance queries.
#[derive(Clone, Debug)]
pub struct BoundaryIndex {
    segments: Vec<Segment>,
    tree: ChainTree,
    /// Of every element the first one of its ring; empty unless all elements are parts of closed rings.
    ring_starts: Vec<u32>,
}

impl BoundaryIndex {
    /// The index of all boundary elements of `region`, ring after ring; rings that start near each other stand together.
    pub fn new(region: &Region) -> BoundaryIndex {
        let rings = region.order_of_place().into_iter().map(|k| &region.rings[k]);
        BoundaryIndex::of_segments(rings.flat_map(Ring::segments).collect())
    }

    /// The index of any boundary elements; best where consecutive ones are neighbours.
    pub fn of_segments(segments: Vec<Segment>) -> BoundaryIndex {
        let boxes: Vec<Bounds> = segments.iter().map(Segment::bounds).collect();
        let ring_starts = ring_starts(&segments).unwrap_or_default();
        BoundaryIndex { tree: ChainTree::new(&boxes), segments, ring_starts }
    }

    /// The elements, numbered as in the queries.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// The nearest element to `p` and its nearest point; `None` without elements.
    pub fn nearest(&self, p: Point) -> Option<(usize, Nearest)> {
        let best = Cell::new(None::<(usize, Nearest)>);
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
        let best = Cell::new((guess, element.approach(&self.segments[guess])));
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
        let winding = Cell::new(0);
        let add = |crossings: i32| winding.set(winding.get() + crossings);
        self.tree.visit_entered(
            |bounds, elements| {
                if bounds.max.x < p.x || bounds.max.y < p.y || bounds.min.y > p.y {
                    return false;
                }
                if bounds.min.x > p.x && !self.ring_starts.is_empty() {
                    add(self.level_crossings(elements, p.y));
                    return false;
                }
                true
            },
            |i| add(self.segments[i].ray_crossings(p)),
        );
        winding.get()
    }

    /// How often consecutive elements of closed rings, all of them to the right of a point, cross the ray from it to the
    /// right: ends alone tell, and of the rings only the first and the last may not be there as a whole.
    fn level_crossings(&self, elements: Range<usize>, y: f64) -> i32 {
        let is_above = |i: usize| i32::from(self.segments[i].start.y > y);
        let end_is_above = |i: usize| i32::from(self.segments[i].end.y > y);
        let (first, last) = (elements.start, elements.end - 1);
        let (ring_of_first, ring_of_last) = (self.ring_starts[first] as usize, self.ring_starts[last] as usize);
        // The first ring ends where it starts, and the last one starts with the range.
        is_above(ring_of_first) - is_above(first) + end_is_above(last) - is_above(ring_of_last)
    }

    /// Whether some element lies nearer to `p` than `limit`.
    pub fn is_nearer(&self, p: Point, limit: f64) -> bool {
        self.tree.any_near(p, limit, |i| self.segments[i].is_nearer(p, limit))
    }
}

/// Of every element the first one of its ring; `None` where some chain of elements does not end where it starts.
fn ring_starts(segments: &[Segment]) -> Option<Vec<u32>> {
    let mut starts = Vec::with_capacity(segments.len());
    let mut first = 0;
    for (i, s) in segments.iter().enumerate() {
        starts.push(first as u32);
        let goes_on = segments.get(i + 1).is_some_and(|next| next.start == s.end);
        if s.end == segments[first].start {
            first = i + 1;
        } else if !goes_on {
            return None;
        }
    }
    (first == segments.len()).then_some(starts)
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
    fn winding_numbers_of_rings_are_sums_over_their_elements() {
        let star = |x: f64, y: f64, n: u32| {
            let corner = |k: u32| {
                let (sin, cos) = (f64::from(2 * k) * 2.4).sin_cos();
                Point::new(x + cos, y + sin)
            };
            Ring::polygon((0..n).map(corner))
        };
        let mut rings = vec![star(0.0, 0.0, 41), Ring::circle(Point::new(0.5, 0.25), 1.5).reversed()];
        rings.extend((0..30).map(|k| star(f64::from(k % 6) * 0.7, f64::from(k / 6) * 0.5, 3 + k % 9)));
        let region = Region::new(rings);
        let index = BoundaryIndex::new(&region);
        assert_eq!(index.ring_starts.len(), index.segments.len());
        let open = BoundaryIndex::of_segments(region.segments().skip(1).collect());
        assert!(open.ring_starts.is_empty());
        for k in 0..4_000 {
            // Some on a level with the vertices at y = 0 and 0.25.
            let p = Point::new(f64::from(k % 80) * 0.083 - 2.0, f64::from(k / 80) * 0.125 - 2.0);
            let sum = |s: &[Segment]| s.iter().map(|s| s.ray_crossings(p)).sum::<i32>();
            assert_eq!(index.winding_number(p), sum(index.segments()), "{p}");
            assert_eq!(open.winding_number(p), sum(open.segments()), "{p}");
        }
    }

    #[test]
    fn rings_that_start_in_one_place_are_all_there() {
        let circle = Ring::circle(Point::new(1.0, 2.0), 3.0);
        let index = BoundaryIndex::new(&Region::new(vec![circle.clone(), Ring::default(), circle.clone(), circle]));
        assert_eq!(index.winding_number(Point::new(1.5, 2.0)), 3);
    }
}
