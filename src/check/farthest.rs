//! The point of one boundary that is farthest from another, without sampling what cannot be it.
//!
//! A distance changes no faster than its place, so that a stretch of length l whose ends are at distances a and b holds
//! nothing beyond (a + b + l) / 2. Stretches are halved until that is no more than the best point found, or shorter than the
//! resolution; but most of what is compared runs along one element of the other boundary, where the ends say it all.

use std::collections::HashSet;

use crate::plane::{BoundaryIndex, Link, Point, Region, Segment};

/// How much farther than the point found another one may be, over the radius, where the boundaries do not run along each
/// other.
pub(super) const RESOLUTION: f64 = 1e-6;

/// What is above the best by less than this part of the resolution is rounding.
const NOISE: f64 = 1e-4;

/// Rounding of the end of an arc, over the length that is looked at.
const ROUNDING: f64 = 1e-9;

/// Stretches are looked into at most so often for each element, and 10 000 times more in all: beyond, the best point so far
/// has to do. Only boundaries that are everywhere apart by the same distance, along curves of different kinds, come near it.
const MOST_LOOKS: usize = 1 << 10;

/// A stretch of an element, with its ends.
#[derive(Clone, Copy)]
struct Stretch<'a> {
    element: &'a Segment,
    from: (f64, Sight),
    to: (f64, Sight),
}

/// What is seen from a point.
#[derive(Clone, Copy)]
struct Sight {
    place: Point,
    /// The distance, or less than zero where it does not count.
    height: f64,
    nearest: Option<usize>,
}

/// The largest height of a point of `region`, and where: the distance from `other`, as `height` takes it (the same, or
/// negative). A point `p` does not count where `hidden(p, 0)`; `hidden(p, -d)` says that nothing within d of it counts.
/// Zero where nothing counts.
pub(super) fn farthest(
    region: &Region,
    other: &BoundaryIndex,
    resolution: f64,
    height: impl Fn(Point, f64) -> f64,
    hidden: &dyn Fn(Point, f64) -> bool,
) -> (f64, Option<Point>) {
    let look = |place: Point| match other.nearest(place) {
        Some((i, near)) => Sight { place, height: height(place, near.distance), nearest: Some(i) },
        None => Sight { place, height: f64::INFINITY, nearest: None },
    };
    let present: HashSet<[u64; 8]> = other.segments().iter().map(bits).collect();
    let mut best = (0.0, None);
    let mut consider = |sight: &Sight| {
        if (sight.height > best.0 || best.1.is_none()) && !hidden(sight.place, 0.0) {
            best = (sight.height.max(0.0), Some(sight.place));
        }
        best.0
    };
    let mut stack: Vec<Stretch> = Vec::new();
    let elements: Vec<Segment> = region.segments().collect();
    for element in &elements {
        let (from, to) = (look(element.start), look(element.end));
        consider(&from);
        if present.contains(&bits(element)) || present.contains(&bits(&element.reversed())) {
            continue;
        }
        // Two stretches: an element that begins and ends at one distance is nowhere flat for that.
        let middle = look(element.point_at(0.5));
        consider(&middle);
        stack.push(Stretch { element, from: (0.0, from), to: (0.5, middle) });
        stack.push(Stretch { element, from: (0.5, middle), to: (1.0, to) });
    }
    let mut looks = MOST_LOOKS * (elements.len() + 10_000);
    while let Some(stretch) = stack.pop() {
        let length = (stretch.to.0 - stretch.from.0) * stretch.element.length();
        let so_far = consider(&stretch.from.1);
        if so_far.is_infinite() {
            break;
        }
        if length <= resolution || looks == 0 || stretch.most(other, length) <= so_far + resolution * NOISE {
            continue;
        }
        let t = 0.5 * (stretch.from.0 + stretch.to.0);
        let middle = look(stretch.element.point_at(t));
        consider(&middle);
        looks -= 1;
        if hidden(middle.place, -0.5 * length) {
            continue;
        }
        stack.push(Stretch { to: (t, middle), ..stretch });
        stack.push(Stretch { from: (t, middle), ..stretch });
    }
    best
}

impl Stretch<'_> {
    /// No point of the stretch is higher than this.
    fn most(&self, other: &BoundaryIndex, length: f64) -> f64 {
        let (a, b) = (&self.from.1, &self.to.1);
        let by_slope = 0.5 * (a.height + b.height + length);
        let (Some(i), Some(j)) = (a.nearest, b.nearest) else { return by_slope };
        let along = |k: usize| {
            let other = other.segments()[k];
            let highest = other.nearest(a.place).distance.max(other.nearest(b.place).distance);
            match (self.element.link, other.link) {
                // The distance from a straight line is convex along a straight line.
                (Link::Line, Link::Line) => highest,
                // Both ends lie beside the arc or at its end, and so does what is between them.
                (Link::Arc(own), Link::Arc(arc)) => {
                    let apart = (own.radius - arc.radius).abs() + (own.center - arc.center).norm();
                    if highest <= apart + ROUNDING * length { 2.0 * apart + ROUNDING * length } else { f64::INFINITY }
                }
                _ => f64::INFINITY,
            }
        };
        // Where elements meet, either may be the nearest.
        by_slope.min(along(i)).min(if i == j { f64::INFINITY } else { along(j) })
    }
}

/// What tells an element from others: two with the same bits are the same.
fn bits(s: &Segment) -> [u64; 8] {
    let [cx, cy, radius, turn] = match s.link {
        Link::Line => [0.0; 4],
        Link::Arc(arc) => [arc.center.x, arc.center.y, arc.radius, arc.turn.sign()],
    };
    [s.start.x, s.start.y, s.end.x, s.end.y, cx, cy, radius, turn].map(f64::to_bits)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Ring;

    fn index(ring: Ring) -> BoundaryIndex {
        BoundaryIndex::new(&Region::new(vec![ring]))
    }

    fn all(region: &Region, other: &BoundaryIndex) -> f64 {
        farthest(region, other, 1e-6, |_, d| d, &|_, _| false).0
    }

    #[test]
    fn maxima_inside_of_elements_are_found() {
        let p = Point::new;
        let square = |a: f64| Ring::polygon([p(-a, -a), p(a, -a), p(a, a), p(-a, a)]);
        let circle = Region::new(vec![Ring::circle(p(0.0, 0.0), 1.0)]);
        // The circle is farthest from a small square half way to its corners, and from a large one at the diagonal.
        assert!((all(&circle, &index(square(1.0))) - (1.0 - 0.5f64.sqrt())).abs() < 1e-6);
        let turned = Ring { vertices: [1, 2, 3, 0].map(|k| Ring::circle(p(0.0, 0.0), 1.0).vertices[k]).to_vec() };
        assert_eq!(all(&circle, &index(turned)), 0.0);
        // A dent of the other boundary under the middle of a long line.
        let dented = Ring::polygon([p(-9.0, 0.0), p(-0.1, 0.0), p(0.3, 0.5), p(0.5, 0.0), p(9.0, 0.0), p(0.0, 9.0)]);
        let plain = Region::new(vec![Ring::polygon([p(-9.0, 0.0), p(9.0, 0.0), p(0.0, 9.0)])]);
        let found = all(&plain, &index(dented.clone()));
        let sampled = (0..=100_000).map(|k| index_distance(&dented, p(-9.0 + f64::from(k) * 18e-5, 0.0)));
        assert!((found - sampled.fold(0.0, f64::max)).abs() < 2e-4, "{found}");
        assert_eq!(all(&plain, &BoundaryIndex::of_segments(Vec::new())), f64::INFINITY);
        assert_eq!(all(&Region::default(), &index(dented)), 0.0);
    }

    fn index_distance(ring: &Ring, q: Point) -> f64 {
        ring.segments().map(|s| s.nearest(q).distance).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn what_is_hidden_does_not_count() {
        let p = Point::new;
        let line =
            |y: f64| Region::new(vec![Ring::polygon([p(0.0, y), p(10.0, y), p(10.0, y - 1.0), p(0.0, y - 3.0)])]);
        let other = BoundaryIndex::new(&line(0.0));
        let hidden = |q: Point, reach: f64| q.x + reach > 4.0;
        let (far, place) = farthest(&line(1.0), &other, 1e-6, |_, d| d, &hidden);
        assert!((far - 1.0).abs() < 1e-5 && place.unwrap().x <= 4.0, "{far} {place:?}");
    }
}
