//! What a round tool sweeps along a path: rings for a union with the non-zero rule.
//!
//! A stroke is the sum of the rectangles along its lines and the sectors at its joints, all counterclockwise. On the
//! inside of a turn the outline therefore passes through the joint itself: then the winding number is at least 1
//! exactly where the tool passes, however tight the turn.

use crate::plane::{Point, Vector, left_normal, turn_angle};

/// A ring or a path of points for the overlay.
pub(super) type Polygon = Vec<[f64; 2]>;

/// A path of points, stroked with a disk.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    /// Radius of the disk.
    pub(super) radius: f64,
    /// Largest distance between the arcs of the outline and their chords.
    pub(super) tolerance: f64,
}

impl Stroke {
    /// The rings of the area swept along `path`; closed paths begin and end in the same point.
    pub(super) fn rings(&self, path: &[Point]) -> Vec<Polygon> {
        let mut path = path.to_vec();
        path.dedup();
        match path.as_slice() {
            [] => Vec::new(),
            [p] => vec![self.disk(*p)],
            [first, .., last] if first == last && path.len() > 3 => {
                path.pop();
                let reversed: Vec<Point> = path.iter().rev().copied().collect();
                vec![self.closed_side(&path), self.closed_side(&reversed)]
            }
            _ => vec![self.open(&path)],
        }
    }

    fn disk(&self, center: Point) -> Polygon {
        let mut ring = Polygon::new();
        self.arc(center, Vector::x(), std::f64::consts::TAU, &mut ring);
        ring
    }

    /// Points of the circle around `center` from the direction `from` (a unit vector) over `angle`, ends included.
    fn arc(&self, center: Point, from: Vector, angle: f64, ring: &mut Polygon) {
        let step = 2.0 * (1.0 - (self.tolerance / self.radius).min(0.5)).acos();
        let count = (angle.abs() / step).ceil().max(1.0) as usize;
        for k in 0..=count {
            let (sin, cos) = (angle * k as f64 / count as f64).sin_cos();
            let spoke = Vector::new(cos * from.x - sin * from.y, sin * from.x + cos * from.y);
            let p = center + spoke * self.radius;
            ring.push([p.x, p.y]);
        }
    }

    /// The joint at `p` on the right side of a path that comes along `before` and leaves along `after`.
    fn right_joint(&self, p: Point, before: Vector, after: Vector, ring: &mut Polygon) {
        let turn = turn_angle(before, after);
        let from = -left_normal(before);
        if turn > 0.0 {
            self.arc(p, from, turn, ring);
            return;
        }
        let (a, b) = (p + from * self.radius, p - left_normal(after) * self.radius);
        ring.extend([[a.x, a.y], [p.x, p.y], [b.x, b.y]]);
    }

    fn closed_side(&self, path: &[Point]) -> Polygon {
        let n = path.len();
        let mut ring = Polygon::new();
        for i in 0..n {
            let (before, p, after) = (path[(i + n - 1) % n], path[i], path[(i + 1) % n]);
            self.right_joint(p, direction(before, p), direction(p, after), &mut ring);
        }
        ring
    }

    fn open(&self, path: &[Point]) -> Polygon {
        let mut ring = Polygon::new();
        let n = path.len();
        let there_and_back: Vec<Point> = path.iter().chain(path[1..n - 1].iter().rev()).copied().collect();
        let m = there_and_back.len();
        for i in 0..m {
            let (before, p, after) = (there_and_back[(i + m - 1) % m], there_and_back[i], there_and_back[(i + 1) % m]);
            if i == 0 || i == n - 1 {
                // The ends: half a disk.
                self.arc(p, -left_normal(direction(before, p)), std::f64::consts::PI, &mut ring);
            } else {
                self.right_joint(p, direction(before, p), direction(p, after), &mut ring);
            }
        }
        ring
    }
}

fn direction(from: Point, to: Point) -> Vector {
    (to - from).try_normalize(0.0).unwrap_or(Vector::x())
}

#[cfg(test)]
mod tests {
    use super::*;
    use i_overlay::core::fill_rule::FillRule;
    use i_overlay::float::simplify::SimplifyShape;

    fn area(path: &[[f64; 2]]) -> f64 {
        let stroke = Stroke { radius: 1.0, tolerance: 1e-6 };
        let points: Vec<Point> = path.iter().map(|p| Point::new(p[0], p[1])).collect();
        let shapes = stroke.rings(&points).simplify_shape_as::<i64>(FillRule::NonZero);
        let ring_area = |ring: &Polygon| {
            let n = ring.len();
            (0..n).map(|i| ring[i][0] * ring[(i + 1) % n][1] - ring[i][1] * ring[(i + 1) % n][0]).sum::<f64>() / 2.0
        };
        shapes.iter().flatten().map(ring_area).sum()
    }

    #[test]
    fn strokes_have_the_area_that_the_disk_sweeps() {
        use std::f64::consts::PI;
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-4, "{a} against {b}");
        close(area(&[[0.0, 0.0]]), PI);
        close(area(&[[0.0, 0.0], [5.0, 0.0]]), 10.0 + PI);
        close(area(&[[0.0, 0.0], [5.0, 0.0], [5.0, 5.0]]), 20.0 - 1.0 + PI + PI / 4.0 - 0.0);
        // There and back again.
        close(area(&[[0.0, 0.0], [5.0, 0.0], [1.0, 0.0]]), 10.0 + PI);
        let square = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0], [0.0, 0.0]];
        close(area(&square), 36.0 + PI + 81.0 - 49.0);
        // Steps much shorter than the disk, turning back into what is swept.
        let zigzag: Vec<[f64; 2]> = (0..=40).map(|k| [0.1 * k as f64, 0.1 * (k % 2) as f64]).collect();
        let swept = area(&zigzag);
        assert!(swept > 8.0 + PI && swept < 8.0 + PI + 0.6, "{swept}");
    }
}
