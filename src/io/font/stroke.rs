//! The lines and curves of a chain of points in whole units.

use super::grid::Placed;
use crate::plane::Point;

/// Chords of written curves stray from them by no more than this part of the limit, or than this in units: finer ones cost
/// time where the limit is below what the grid can hold.
const CHORD: f64 = 0.01;
const FINEST_CHORD: f64 = 2e-3;

/// At most so many chords of one curve.
const MOST_CHORDS: f64 = 64.0;

/// The longest chord, in units: exact outlines bend under long lines, too.
const LONGEST_CHORD: f64 = 4.0;

/// One curve or line of a chain of points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    pub start: Point,
    pub control: Option<Point>,
    pub end: Point,
}

impl Stroke {
    pub fn point_at(&self, t: f64) -> Point {
        let Some(c) = self.control else { return self.start + (self.end - self.start) * t };
        let s = 1.0 - t;
        Point::from(self.start.coords * (s * s) + c.coords * (2.0 * s * t) + self.end.coords * (t * t))
    }

    /// Coordinates in half units, on which all of them lie.
    pub fn key(&self) -> [i64; 6] {
        let halves = |p: Point| [p.x, p.y].map(|x| (2.0 * x) as i64);
        let ([a, b], [c, d], [e, f]) =
            (halves(self.start), self.control.map_or([i64::MIN; 2], halves), halves(self.end));
        [a, b, c, d, e, f]
    }

    /// How many chords are fine enough for a limit, and give points enough to measure at.
    pub fn chord_count(&self, limit: f64) -> usize {
        let accuracy = (CHORD * limit).max(FINEST_CHORD);
        const FEWEST: f64 = 4.0;
        let bend = self.control.map_or(0.0, |c| (self.start.coords - c.coords * 2.0 + self.end.coords).norm());
        let by_length = (self.end - self.start).norm() / LONGEST_CHORD;
        (0.5 * (bend / accuracy).sqrt()).max(by_length).ceil().clamp(FEWEST, MOST_CHORDS) as usize
    }
}

/// The strokes of a chain, each with the number of its point: that off the curve, or the start of a line. Of an open chain
/// points at the ends have none.
pub(super) fn strokes(chain: &[Placed], closed: bool) -> impl Iterator<Item = (usize, Stroke)> + '_ {
    let n = chain.len();
    (0..n).filter_map(move |j| {
        let point = chain[j];
        let after = chain.get(j + 1).or(chain.first().filter(|_| closed))?;
        if point.on_curve {
            let line = Stroke { start: point.point, control: None, end: after.point };
            return after.on_curve.then_some((j, line));
        }
        let before = if j > 0 { chain.get(j - 1) } else { chain.last().filter(|_| closed) }?;
        let end = |p: &Placed| if p.on_curve { p.point } else { nalgebra::center(&p.point, &point.point) };
        Some((j, Stroke { start: end(before), control: Some(point.point), end: end(after) }))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(x: f64, y: f64, on_curve: bool) -> Placed {
        Placed { point: Point::new(x, y), on_curve, is_smooth: true, is_free: true }
    }

    #[test]
    fn strokes_end_on_half_units_where_the_knot_is_implied() {
        let chain =
            [placed(0.0, 0.0, true), placed(10.0, 0.0, false), placed(13.0, 3.0, false), placed(13.0, 9.0, true)];
        let strokes: Vec<(usize, Stroke)> = strokes(&chain, false).collect();
        assert_eq!(strokes.iter().map(|s| s.0).collect::<Vec<_>>(), [1, 2]);
        assert_eq!((strokes[0].1.end, strokes[1].1.start), (Point::new(11.5, 1.5), Point::new(11.5, 1.5)));
        // Closed there is a line back to the start, too.
        assert_eq!(super::strokes(&chain, true).map(|s| s.0).collect::<Vec<_>>(), [1, 2, 3]);
    }
}
