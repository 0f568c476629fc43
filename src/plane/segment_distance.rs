//! The distance between two boundary elements, in closed form.
//!
//! Two elements that do not cross come nearest either at an end of one of them, or where both have the same normal: on
//! the perpendicular from a centre to a line, or on the line through two centres.

use super::{Arc, Link, Nearest, Point, Segment, Vector};

/// Where two elements come nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// The place on the first element.
    pub on_first: Point,
    /// The place on the second element.
    pub on_second: Point,
    /// Their distance; 0 where the elements cross.
    pub distance: f64,
}

impl Approach {
    fn new(on_first: Point, on_second: Point) -> Approach {
        Approach { on_first, on_second, distance: (on_first - on_second).norm() }
    }

    fn swapped(self) -> Approach {
        Approach { on_first: self.on_second, on_second: self.on_first, ..self }
    }
}

impl Segment {
    /// Where this element and `other` come nearest to each other.
    pub fn approach(&self, other: &Segment) -> Approach {
        let mut best = self.ends_approach(other);
        let ends_of_other = other.ends_approach(self).swapped();
        if ends_of_other.distance < best.distance {
            best = ends_of_other;
        }
        let mut consider = |a: Point, b: Point| {
            let found = Approach::new(a, b);
            if found.distance < best.distance {
                best = found;
            }
        };
        match (self.link, other.link) {
            (Link::Line, Link::Line) => {
                if let Some(p) = crossing_of_lines(self, other) {
                    consider(p, p);
                }
            }
            (Link::Line, Link::Arc(arc)) => line_with_arc(self, other, &arc, &mut consider),
            (Link::Arc(arc), Link::Line) => line_with_arc(other, self, &arc, &mut |b, a| consider(a, b)),
            (Link::Arc(a), Link::Arc(b)) => arc_with_arc(self, &a, other, &b, &mut consider),
        }
        best
    }

    fn ends_approach(&self, other: &Segment) -> Approach {
        let at = |p: Point| {
            let Nearest { point, distance } = other.nearest(p);
            Approach { on_first: p, on_second: point, distance }
        };
        let (a, b) = (at(self.start), at(self.end));
        if a.distance <= b.distance { a } else { b }
    }

    /// Whether `p`, a point of the arc's circle, lies on the arc.
    fn sweeps(&self, arc: &Arc, p: Point) -> bool {
        arc.angle_between(self.start, p) <= self.sweep()
    }
}

fn crossing_of_lines(a: &Segment, b: &Segment) -> Option<Point> {
    let (u, v, w) = (a.end - a.start, b.end - b.start, b.start - a.start);
    let cross = u.perp(&v);
    // Parallel lines come nearest at an end.
    if cross == 0.0 {
        return None;
    }
    let (s, t) = (w.perp(&v) / cross, w.perp(&u) / cross);
    ((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t)).then(|| a.start + u * s)
}

fn line_with_arc(line: &Segment, element: &Segment, arc: &Arc, consider: &mut impl FnMut(Point, Point)) {
    let d = line.end - line.start;
    let length = d.norm();
    if length == 0.0 {
        return;
    }
    let u = d / length;
    let along = (arc.center - line.start).dot(&u);
    let foot = line.start + u * along;
    let offset = foot - arc.center;
    let distance = offset.norm();
    if distance >= arc.radius {
        let spoke = arc.center + offset * (arc.radius / distance);
        if (0.0..=length).contains(&along) && element.sweeps(arc, spoke) {
            consider(foot, spoke);
        }
        return;
    }
    let half = (arc.radius * arc.radius - distance * distance).sqrt();
    for t in [along - half, along + half] {
        let p = line.start + u * t;
        if (0.0..=length).contains(&t) && element.sweeps(arc, p) {
            consider(p, p);
        }
    }
}

fn arc_with_arc(a: &Segment, arc_a: &Arc, b: &Segment, arc_b: &Arc, consider: &mut impl FnMut(Point, Point)) {
    let between = arc_b.center - arc_a.center;
    let distance = between.norm();
    // Concentric arcs come nearest at an end, or everywhere alike.
    if distance == 0.0 {
        return;
    }
    let u: Vector = between / distance;
    for sign_a in [1.0, -1.0] {
        let p = arc_a.center + u * (sign_a * arc_a.radius);
        if !a.sweeps(arc_a, p) {
            continue;
        }
        for sign_b in [1.0, -1.0] {
            let q = arc_b.center + u * (sign_b * arc_b.radius);
            if b.sweeps(arc_b, q) {
                consider(p, q);
            }
        }
    }
    let along = 0.5 * (distance + (arc_a.radius - arc_b.radius) * (arc_a.radius + arc_b.radius) / distance);
    let squared = arc_a.radius * arc_a.radius - along * along;
    if squared < 0.0 {
        return;
    }
    let across = super::left_normal(u) * squared.sqrt();
    for side in [across, -across] {
        let p = arc_a.center + u * along + side;
        if a.sweeps(arc_a, p) && b.sweeps(arc_b, p) {
            consider(p, p);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Turn;
    use proptest::prelude::*;

    fn element(ax: f64, ay: f64, bx: f64, by: f64, bend: f64) -> Segment {
        let (start, end) = (Point::new(ax, ay), Point::new(bx, by));
        let chord = end - start;
        if bend.abs() < 0.2 || chord.norm() < 1e-3 {
            return Segment::line(start, end);
        }
        let center = start + chord * 0.5 + super::super::left_normal(chord) * (bend - bend.signum());
        let turn = if bend > 0.0 { Turn::Left } else { Turn::Right };
        Segment { start, end, link: Link::Arc(Arc { center, radius: (start - center).norm(), turn }) }
    }

    #[test]
    fn exact_cases() {
        let line = Segment::line(Point::new(-5.0, 3.0), Point::new(5.0, 3.0));
        let cap = element(1.0, 0.0, -1.0, 0.0, 1.0);
        assert_eq!(line.approach(&cap).distance, 2.0);
        assert_eq!(cap.approach(&line).on_first, Point::new(0.0, 1.0));
        let crossing = Segment::line(Point::new(0.0, 0.0), Point::new(0.0, 9.0));
        assert_eq!(line.approach(&crossing).distance, 0.0);
        let far_cap = element(11.0, 0.0, 9.0, 0.0, 1.0);
        let expected = cap.approach(&far_cap).distance;
        assert!((expected - 8.0).abs() < 1e-15, "{expected}: the ends are nearest");
    }

    proptest! {
        #[test]
        fn the_approach_is_the_least_of_many_samples(
            a in prop::array::uniform5(-2.0..2.0f64), b in prop::array::uniform5(-2.0..2.0f64)
        ) {
            const SAMPLES: usize = 400;
            let p = element(a[0], a[1], a[2], a[3], a[4]);
            let q = element(b[0], b[1], b[2], b[3], b[4]);
            let found = p.approach(&q);
            prop_assert!(p.nearest(found.on_first).distance < 1e-9 && q.nearest(found.on_second).distance < 1e-9);
            let step = p.length() / SAMPLES as f64;
            let sampled = (0..=SAMPLES)
                .map(|k| q.nearest(p.point_at(k as f64 / SAMPLES as f64)).distance)
                .fold(f64::INFINITY, f64::min);
            prop_assert!(found.distance <= sampled + 1e-9, "found {}, sampled {sampled}", found.distance);
            // Distance changes by no more than the way.
            prop_assert!(found.distance >= sampled - 0.5 * step - 1e-9, "found {}, sampled {sampled}", found.distance);
        }
    }
}
