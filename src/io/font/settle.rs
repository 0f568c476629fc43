//! Contours in whole units brought within the tolerance.
//!
//! Rounding each point by itself may add up where points go the same way. Where a contour is too far from the outline, or the
//! outline from it, the stretch around the worst place is worked on (see [`Window`]), then the next worst, until none is
//! left or none gets better.

use super::deviation;
use super::grid::{Placed, Rounded};
use super::stroke::strokes;
use super::window::Window;
use crate::plane::{BoundaryIndex, Point, Region, Segment};

/// Points of a stretch before and after the worst place.
const HALF_LENGTH: usize = 5;

/// At most so many stretches of a glyph are worked on.
const MOST_STRETCHES: usize = 60;

/// A place is worked on again where what it exceeded the limit by fell below this part.
const WORTH_GOING_ON: f64 = 0.8;

/// A glyph is given up after so many places where next to nothing was found: one such place is enough for it to be beyond the
/// tolerance, and the search must end where the tolerance is too small for the grid.
const FRUITLESS: usize = 4;

/// How far around a stretch the exact outline is looked at, in units and in tolerances: no move leads farther.
const MARGIN: f64 = 4.0;

/// Distances that exceed the limit by less than this part are rounding.
const ROUNDING: f64 = 1e-9;

/// A place where the written and the exact outline are too far apart: the contour, its point, the distance.
type Spot = (usize, usize, f64);

/// Moves points of `contours` until they are within `limit` of `exact`, both ways; whether they are.
pub(super) fn settle(
    contours: &mut [Rounded],
    exact: &Region,
    index: &BoundaryIndex,
    limit: f64,
    units_per_em: f64,
) -> bool {
    let limit = limit * (1.0 + ROUNDING);
    let samples: Vec<Point> = deviation::points(exact, units_per_em).collect();
    // Points at which nothing was found.
    let mut tried: Vec<(usize, Point)> = Vec::new();
    for _ in 0..MOST_STRETCHES {
        let (spots, owners) = spots(contours, &samples, index, limit);
        let is_new = |s: &&Spot| !tried.contains(&(s.0, contours[s.0].points[s.1].point));
        let Some(&(c, j, _)) = spots.iter().filter(is_new).reduce(|a, b| if b.2 > a.2 { b } else { a }) else {
            return spots.is_empty();
        };
        if tried.len() >= FRUITLESS {
            return false;
        }
        let spot = contours[c].points[j].point;
        let n = contours[c].points.len();
        let closed = n <= 2 * HALF_LENGTH + 1;
        let first = if closed { 0 } else { (j + n - HALF_LENGTH) % n };
        let length = if closed { n } else { 2 * HALF_LENGTH + 1 };
        let mut points = contours[c].points.clone();
        points.rotate_left(first);
        let chain: Vec<Placed> = points[..length].to_vec();
        // Strokes that lie in the stretch as a whole.
        let inner: Vec<usize> = strokes(&chain, closed).map(|(k, _)| (first + k) % n).collect();
        let own = samples.iter().zip(&owners).filter(|(_, owner)| owner.0 == c && inner.contains(&owner.1));
        let near = around(&chain, index, MARGIN * limit.max(1.0));
        let mut window = Window::new(near, own.map(|(p, _)| *p).collect(), limit, closed);
        let (better, before, after) = window.improved(chain);
        // Small gains are taken, and are no reason to go on there.
        if Window::exceeds(after) && after > WORTH_GOING_ON * before {
            tried.push((c, spot));
        }
        if after >= before {
            continue;
        }
        points.splice(..length, better);
        let m = points.len();
        // Back to where the contour began, as near as its new number of points allows.
        points.rotate_right(first.min(m));
        contours[c].points = points;
        contours[c].drop_repetition();
    }
    false
}

/// All places that are too far apart, and for each sample of the exact outline the point of the nearest stroke.
fn spots(
    contours: &[Rounded],
    samples: &[Point],
    index: &BoundaryIndex,
    limit: f64,
) -> (Vec<Spot>, Vec<(usize, usize)>) {
    let mut spots = Vec::new();
    let mut chords = Vec::new();
    let mut owner_of_chord = Vec::new();
    for (c, contour) in contours.iter().enumerate() {
        for (j, stroke) in strokes(&contour.points, true) {
            let count = stroke.chord_count(limit);
            let mut from = stroke.start;
            for k in 0..count {
                if !index.is_nearer(from, limit) {
                    spots.push((c, j, index.distance(from)));
                }
                let to = stroke.point_at((k + 1) as f64 / count as f64);
                chords.push(Segment::line(from, to));
                owner_of_chord.push((c, j));
                from = to;
            }
        }
    }
    let written = BoundaryIndex::of_segments(chords);
    let owners = samples.iter().map(|p| {
        let Some((k, nearest)) = written.nearest(*p) else { return (usize::MAX, 0) };
        let (c, j) = owner_of_chord[k];
        if nearest.distance > limit {
            spots.push((c, j, nearest.distance));
        }
        (c, j)
    });
    let owners = owners.collect();
    (spots, owners)
}

/// The exact outline within `margin` of the box of a chain.
fn around(chain: &[Placed], index: &BoundaryIndex, margin: f64) -> BoundaryIndex {
    let low = chain.iter().fold(Point::new(f64::INFINITY, f64::INFINITY), |m, p| m.inf(&p.point));
    let high = chain.iter().fold(Point::new(f64::NEG_INFINITY, f64::NEG_INFINITY), |m, p| m.sup(&p.point));
    let meets = |s: &&Segment| {
        let b = s.bounds();
        b.min.x <= high.x + margin
            && b.max.x >= low.x - margin
            && b.min.y <= high.y + margin
            && b.max.y >= low.y - margin
    };
    BoundaryIndex::of_segments(index.segments().iter().filter(meets).copied().collect())
}

#[cfg(test)]
mod tests {
    use super::super::deviation::deviation;
    use super::super::fill::{Filled, Sampling};
    use super::super::grid::{self, Rounded};
    use super::super::quadratics::Knot;
    use super::*;
    use crate::plane::Ring;

    const EM: f64 = 1000.0;

    fn knots(points: &[(f64, f64)]) -> Vec<Knot> {
        points.iter().map(|&(x, y)| Knot { point: Point::new(x, y), controls: Vec::new() }).collect()
    }

    fn exact(points: &[(f64, f64)]) -> Region {
        Region::new(vec![Ring::polygon(points.iter().map(|&(x, y)| Point::new(x, y)))])
    }

    /// How far contours are from an outline, as fonts are judged.
    fn off(contours: &[Rounded], exact: &Region) -> f64 {
        let contours: Vec<_> = contours.iter().map(Rounded::contour).collect();
        let drawn = Filled::lines_of_contours(&contours, Sampling::new(EM, 30.0));
        deviation((&drawn, &BoundaryIndex::new(&drawn)), (exact, &BoundaryIndex::new(exact)), EM)
    }

    fn settled(points: &[(f64, f64)], limit: f64) -> (Vec<Rounded>, Region) {
        let exact = exact(points);
        let index = BoundaryIndex::new(&exact);
        let mut contours = vec![grid::contour(&knots(points), &index)];
        settle(&mut contours, &exact, &index, limit, EM);
        (contours, exact)
    }

    #[test]
    fn corners_on_half_units_are_half_a_unit_off() {
        let (contours, exact) = settled(&[(0.5, 0.5), (100.5, 0.5), (100.5, 80.5), (0.5, 80.5)], 0.5);
        assert_eq!(off(&contours, &exact), 0.5);
    }

    #[test]
    fn a_tip_between_the_places_of_the_grid_is_kept() {
        // No place of the grid is within half a unit of the tip and of both sides: (473, -3) is 0.55 from it, (472, -4) and
        // (472, -3) are farther.
        let tip = Point::new(472.6, -3.38);
        let points = [(372.6, -28.28), (tip.x, tip.y), (402.6, -49.9)];
        let exact = exact(&points);
        let index = BoundaryIndex::new(&exact);
        let mut contours = vec![grid::contour(&knots(&points), &index)];
        assert!(off(&contours, &exact) > 0.5);
        settle(&mut contours, &exact, &index, 0.5, EM);
        assert!(off(&contours, &exact) <= 0.5, "{}", off(&contours, &exact));
        // The tip is implied, on half units.
        assert!(contours[0].points.windows(2).any(|p| !p[0].on_curve && !p[1].on_curve), "{contours:?}");
    }

    #[test]
    fn smooth_knots_slide_along_the_outline() {
        // The joint of two lines that turn by a degree: as rounded it is 0.7 off, two units on it is on the outline.
        let points = [(0.0, 0.0), (50.5, 0.0), (101.0, 1.0), (101.0, 100.0), (0.0, 100.0)];
        let exact = exact(&points);
        let index = BoundaryIndex::new(&exact);
        let placed = |x: f64, y: f64, is_free: bool| Placed {
            point: Point::new(x, y),
            on_curve: true,
            is_smooth: is_free,
            is_free,
        };
        let mut contours = vec![Rounded {
            points: vec![
                placed(0.0, 0.0, false),
                placed(50.0, 1.0, true),
                placed(101.0, 1.0, false),
                placed(101.0, 100.0, false),
                placed(0.0, 100.0, false),
            ],
        }];
        assert!(off(&contours, &exact) > 0.9);
        settle(&mut contours, &exact, &index, 0.1, EM);
        assert!(off(&contours, &exact) <= 0.1, "{contours:?}");
        // What is not free stays.
        let corners: Vec<Point> = contours[0].points.iter().filter(|p| !p.is_free).map(|p| p.point).collect();
        assert_eq!(corners, [(0.0, 0.0), (101.0, 1.0), (101.0, 100.0), (0.0, 100.0)].map(|(x, y)| Point::new(x, y)));
    }

    #[test]
    fn what_is_within_the_limit_stays_as_it_is() {
        let points = [(0.4, 0.0), (100.2, 0.3), (100.0, 80.0), (0.0, 80.4)];
        let exact = exact(&points);
        let index = BoundaryIndex::new(&exact);
        let before = grid::contour(&knots(&points), &index);
        let mut contours = vec![before.clone()];
        settle(&mut contours, &exact, &index, 0.5, EM);
        assert_eq!(contours[0].points, before.points);
    }
}
