//! What a round tool sweeps along a path: rings for a union with the non-zero rule.
//!
//! The swept area is the union of what the elements sweep on both sides of themselves (rectangles, and sectors of rings
//! or, where an arc is tighter than the tool, whole sectors) and of the sectors at corners, all counterclockwise: any
//! point of it has a nearest point on the path, inside of an element or at a corner. The outline is the sum of theirs,
//! so that its winding number is at least 1 exactly where the tool passes.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::plane::{Arc, Link, Point, Segment, Turn, Vector, right_normal, turn_angle};

/// A ring or a path of points for the overlay.
pub(super) type Polygon = Vec<[f64; 2]>;

/// A disk that is moved along paths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    /// Radius of the disk.
    pub(super) radius: f64,
    /// Largest distance between the arcs of the outline and their chords.
    pub(super) tolerance: f64,
}

/// Turns smaller than this, in radians, leave no sector.
const NO_TURN: f64 = 1e-9;

impl Stroke {
    /// The area swept while standing at `center`.
    pub(super) fn disk(&self, center: Point) -> Polygon {
        let mut ring = Polygon::new();
        self.arc(center, self.radius, Vector::x(), TAU, &mut ring);
        ring
    }

    /// The rings of the area swept along `path`, elements of which each starts where the one before it ends.
    pub(super) fn rings(&self, path: &[Segment]) -> Vec<Polygon> {
        let path: Vec<Segment> = path.iter().copied().filter(|s| s.length() > 0.0).collect();
        let (Some(first), Some(last)) = (path.first(), path.last()) else { return Vec::new() };
        let back: Vec<Segment> = path.iter().rev().map(Segment::reversed).collect();
        if first.start == last.end && path.len() > 1 {
            return vec![self.closed_side(&path), self.closed_side(&back)];
        }
        let mut ring = Polygon::new();
        for side in [&path, &back] {
            self.right_side(side, &mut ring);
            if let Some(end) = side.last() {
                self.arc(end.end, self.radius, right_normal(end.end_tangent()), PI, &mut ring);
            }
        }
        vec![ring]
    }

    /// A closed path moved to its right by the radius: around a solid on its left, the solid and what is swept outside of
    /// it.
    pub(super) fn closed_side(&self, path: &[Segment]) -> Polygon {
        let mut ring = Polygon::new();
        self.right_side(path, &mut ring);
        if let (Some(first), Some(last)) = (path.first(), path.last()) {
            self.right_joint(last, first, &mut ring);
        }
        ring
    }

    fn right_side(&self, path: &[Segment], ring: &mut Polygon) {
        for (i, element) in path.iter().enumerate() {
            if i > 0 {
                self.right_joint(&path[i - 1], element, ring);
            }
            self.right_of(element, ring);
        }
    }

    /// The right edge of what an element sweeps.
    fn right_of(&self, element: &Segment, ring: &mut Polygon) {
        match element.link {
            Link::Line => {
                let by = right_normal(element.start_tangent()) * self.radius;
                ring.extend([element.start + by, element.end + by].map(|p| [p.x, p.y]));
            }
            Link::Arc(arc) => {
                let spoke = (element.start - arc.center) / arc.radius;
                let sweep = arc.turn.sign() * element.sweep();
                match arc.turn {
                    Turn::Left => self.arc(arc.center, arc.radius + self.radius, spoke, sweep, ring),
                    Turn::Right if self.collapses(&arc) => ring.push([arc.center.x, arc.center.y]),
                    Turn::Right => self.arc(arc.center, arc.radius - self.radius, spoke, sweep, ring),
                }
            }
        }
    }

    /// Whether the tool reaches over the centre of an arc.
    fn collapses(&self, arc: &Arc) -> bool {
        arc.radius <= self.radius
    }

    /// What stands between the right edges of two elements that follow each other.
    fn right_joint(&self, before: &Segment, after: &Segment, ring: &mut Polygon) {
        let p = after.start;
        let turn = turn_angle(before.end_tangent(), after.start_tangent());
        if turn > NO_TURN {
            self.arc(p, self.radius, right_normal(before.end_tangent()), turn, ring);
            return;
        }
        // On the inside of a turn both elements sweep the triangle between the joint and the two edges, if they are long
        // enough: then it may be cut off. Otherwise the edges meet through the joint.
        let is_collapsed = |s: &Segment| match s.link {
            Link::Arc(arc) => arc.turn == Turn::Right && self.collapses(&arc),
            Link::Line => false,
        };
        let overlap = 2.0 * self.radius * turn.abs().sin();
        let is_long = |s: &Segment| s.length() >= overlap && !is_collapsed(s);
        if turn.abs() > FRAC_PI_2 || !is_long(before) || !is_long(after) {
            ring.push([p.x, p.y]);
        }
    }

    /// Points of a circle from the direction `from` (a unit vector) over `angle`, ends included.
    fn arc(&self, center: Point, radius: f64, from: Vector, angle: f64, ring: &mut Polygon) {
        /// Guard against absurd radii.
        const MOST: f64 = 1e5;
        let step = 2.0 * (1.0 - (self.tolerance / radius).min(0.5)).acos();
        let count = (angle.abs() / step).ceil().clamp(1.0, MOST) as usize;
        for k in 0..=count {
            let (sin, cos) = (angle * k as f64 / count as f64).sin_cos();
            let spoke = Vector::new(cos * from.x - sin * from.y, sin * from.x + cos * from.y);
            let p = center + spoke * radius;
            ring.push([p.x, p.y]);
        }
    }
}

/// Lines that follow each other joined into one where all their ends stay within `tolerance` of it.
pub(super) fn joined_lines(path: &[Segment], tolerance: f64) -> Vec<Segment> {
    /// Looks no further than this, so that the time grows linearly.
    const MOST: usize = 64;
    let mut joined: Vec<Segment> = Vec::with_capacity(path.len());
    let mut i = 0;
    while i < path.len() {
        let start = path[i].start;
        let mut end = i;
        while path[i].link == Link::Line && end + 1 < path.len() && end + 1 < i + MOST {
            let next = &path[end + 1];
            let chord = Segment::line(start, next.end);
            let is_straight = next.link == Link::Line
                && path[i..=end].iter().all(|s| chord.nearest(s.end).distance <= tolerance)
                // A path that turns back would hide its turning point.
                && chord.start_tangent().dot(&next.start_tangent()) > 0.0;
            if !is_straight {
                break;
            }
            end += 1;
        }
        joined.push(Segment { end: path[end].end, ..path[i] });
        i = end + 1;
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;
    use i_overlay::core::fill_rule::FillRule;
    use i_overlay::float::simplify::SimplifyShape;

    fn area_of(path: &[Segment]) -> f64 {
        let stroke = Stroke { radius: 1.0, tolerance: 1e-6 };
        let shapes = stroke.rings(path).simplify_shape_as::<i64>(FillRule::NonZero);
        let ring_area = |ring: &Polygon| {
            let n = ring.len();
            (0..n).map(|i| ring[i][0] * ring[(i + 1) % n][1] - ring[i][1] * ring[(i + 1) % n][0]).sum::<f64>() / 2.0
        };
        shapes.iter().flatten().map(ring_area).sum()
    }

    fn lines(path: &[[f64; 2]]) -> Vec<Segment> {
        path.windows(2).map(|w| Segment::line(Point::new(w[0][0], w[0][1]), Point::new(w[1][0], w[1][1]))).collect()
    }

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-4, "{a} against {b}");
    }

    #[test]
    fn strokes_of_lines_have_the_area_that_the_disk_sweeps() {
        let area = |path: &[[f64; 2]]| area_of(&lines(path));
        close(area(&[[0.0, 0.0], [5.0, 0.0]]), 10.0 + PI);
        close(area(&[[0.0, 0.0], [5.0, 0.0], [5.0, 5.0]]), 20.0 - 1.0 + PI + PI / 4.0);
        // There and back again.
        close(area(&[[0.0, 0.0], [5.0, 0.0], [1.0, 0.0]]), 10.0 + PI);
        let square = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0], [0.0, 0.0]];
        close(area(&square), 36.0 + PI + 81.0 - 49.0);
        // Steps much shorter than the disk, turning back into what is swept.
        let zigzag: Vec<[f64; 2]> = (0..=40).map(|k| [0.1 * k as f64, 0.1 * (k % 2) as f64]).collect();
        let swept = area(&zigzag);
        assert!(swept > 8.0 + PI && swept < 8.0 + PI + 0.6, "{swept}");
        // A wide bend of short steps is as good as its arc.
        let bend: Vec<[f64; 2]> =
            (0..=400).map(|k| (PI * k as f64 / 400.0).sin_cos()).map(|(s, c)| [3.0 * c, 3.0 * s]).collect();
        assert!((area(&bend) - (0.5 * PI * (16.0 - 4.0) + PI)).abs() < 1e-3);
    }

    #[test]
    fn strokes_of_arcs_have_the_area_that_the_disk_sweeps() {
        for turn in [Turn::Left, Turn::Right] {
            let half = |radius: f64| Segment {
                start: Point::new(radius, 0.0),
                end: Point::new(-radius, 0.0),
                link: Link::Arc(Arc { center: Point::origin(), radius, turn }),
            };
            close(area_of(&[half(3.0)]), 0.5 * PI * (16.0 - 4.0) + PI);
            // Tighter than the disk: half a disk of the sum, and on the other side what the two end disks cover.
            let r = 0.5f64;
            let ends = PI / 2.0 + (r * (1.0 - r * r).sqrt() + r.asin());
            close(area_of(&[half(r)]), 0.5 * PI * (1.0 + r).powi(2) + ends);
            // All around: a ring, a disk.
            let around = |radius: f64| {
                let a = half(radius);
                area_of(&[a, Segment { start: a.end, end: a.start, link: a.link }])
            };
            close(around(3.0), PI * (16.0 - 4.0));
            close(around(0.5), PI * 2.25);
            close(around(1.0), PI * 4.0);
        }
    }

    #[test]
    fn a_rounded_path_leaves_no_holes() {
        // Out along a line, around a corner at the disk's own radius, and back: no sliver at the tangent points.
        let p = Point::new;
        let arc = |x: f64, y: f64| Link::Arc(Arc { center: p(x, y), radius: 1.0, turn: Turn::Left });
        let path = [
            Segment::line(p(0.0, -1.0), p(4.0, -1.0)),
            Segment { start: p(4.0, -1.0), end: p(5.0, 0.0), link: arc(4.0, 0.0) },
            Segment::line(p(5.0, 0.0), p(5.0, 4.0)),
        ];
        let rings = Stroke { radius: 1.0, tolerance: 1e-6 }.rings(&path);
        let shapes = rings.simplify_shape_as::<i64>(FillRule::NonZero);
        assert_eq!(shapes.len(), 1);
        close(area_of(&path), 16.0 + PI + 0.25 * PI * 4.0);
    }

    #[test]
    fn straight_runs_are_joined_and_turns_are_not() {
        let path = lines(&[[0.0, 0.0], [1.0, 0.0001], [2.0, 0.0], [3.0, 0.0], [3.0, 1.0], [3.0, 0.5]]);
        let joined = joined_lines(&path, 0.001);
        assert_eq!(joined.iter().map(|s| s.end.y).collect::<Vec<_>>(), [0.0, 1.0, 0.5]);
    }
}
