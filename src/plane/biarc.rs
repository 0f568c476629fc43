//! Two arcs that leave a point in one direction, arrive at another in another, and meet without a corner.

use super::{Arc, Link, Point, Segment, Turn, Vector, left_normal, right_normal};

/// Sine of the angle between tangent and chord below which an arc is written as a line: its sagitta is then below a
/// billionth of its length.
const STRAIGHT_SINE: f64 = 4e-9;

/// A point of a curve with the unit direction of travel there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Where it is.
    pub point: Point,
    /// The direction, of length one.
    pub tangent: Vector,
}

/// The two arcs and the line across the curve where they meet.
#[derive(Clone, Copy, Debug)]
pub struct Biarc {
    /// From the start to where they meet.
    pub first: Segment,
    /// From there to the end.
    pub second: Segment,
    joint: Place,
}

impl Biarc {
    /// The biarc from `a` to `b` whose control polygon has sides of equal length at both ends.
    ///
    /// `None` where the two places are one, or face each other so that no such curve is shorter than a detour.
    pub fn between(a: Place, b: Place) -> Option<Biarc> {
        let chord = b.point - a.point;
        let along = chord.dot(&(a.tangent + b.tangent));
        let length_squared = chord.norm_squared();
        if !(along > 0.0 && length_squared > 0.0) {
            return None;
        }
        // |P - Q| = 2k for P = a + k t_a and Q = b - k t_b: 2 (1 - t_a·t_b) k² + 2 along k - |chord|² = 0, by the form of
        // its root that does not divide by the first coefficient, which vanishes for parallel tangents.
        let curving = 2.0 * (1.0 - a.tangent.dot(&b.tangent));
        let k = length_squared / (along + (along * along + curving * length_squared).sqrt());
        let (p, q) = (a.point + a.tangent * k, b.point - b.tangent * k);
        let tangent = (q - p).try_normalize(0.0)?;
        let joint = Place { point: nalgebra::center(&p, &q), tangent };
        // The second arc is found from its end, backwards.
        let backward = Place { point: b.point, tangent: -b.tangent };
        Some(Biarc { first: arc_from(a, joint.point), second: arc_from(backward, joint.point).reversed(), joint })
    }

    /// How far `p` lies right of the curve, negative to the left. For points near the curve.
    pub fn offside(&self, p: Point) -> f64 {
        offside(self.arc_at(p), p)
    }

    /// The points inside `element` where its distance from the curve may be greatest or least: where it runs parallel to
    /// one of the arcs.
    pub fn extremes(&self, element: &Segment) -> [Option<Point>; 4] {
        let [a, b] = [&self.first, &self.second].map(|own| {
            let points = match (own.link, element.link) {
                (Link::Line, Link::Line) => [None; 2],
                (Link::Arc(own), Link::Line) => [Some(element.nearest(own.center).point), None],
                (Link::Line, Link::Arc(arc)) => across(&arc, right_normal(own.start_tangent())),
                (Link::Arc(own), Link::Arc(arc)) => across(&arc, arc.center - own.center),
            };
            points.map(|p| p.filter(|p| is_inside(element, *p)))
        });
        [a[0], a[1], b[0], b[1]]
    }

    /// The arc that `p` belongs to.
    fn arc_at(&self, p: Point) -> &Segment {
        if (p - self.joint.point).dot(&self.joint.tangent) < 0.0 { &self.first } else { &self.second }
    }
}

/// The arc, or line, that leaves `from` in its direction and ends at `to`.
fn arc_from(from: Place, to: Point) -> Segment {
    let chord = to - from.point;
    let (length, side) = (chord.norm(), from.tangent.perp(&chord));
    if side.abs() <= STRAIGHT_SINE * length {
        return Segment::line(from.point, to);
    }
    let radius = 0.5 * length * length / side;
    let turn = if radius > 0.0 { Turn::Left } else { Turn::Right };
    let center = from.point + left_normal(from.tangent) * radius;
    Segment { start: from.point, end: to, link: Link::Arc(Arc { center, radius: radius.abs(), turn }) }
}

/// The two points of a circle on the diameter along `direction`.
fn across(arc: &Arc, direction: Vector) -> [Option<Point>; 2] {
    let spoke = direction.try_normalize(0.0).map(|d| d * arc.radius);
    [spoke.map(|s| arc.center + s), spoke.map(|s| arc.center - s)]
}

/// Whether a point of the line or circle that `element` runs on belongs to the element.
fn is_inside(element: &Segment, p: Point) -> bool {
    match element.link {
        // The nearest point of a straight element is always its own.
        Link::Line => true,
        Link::Arc(arc) => arc.angle_between(element.start, p) <= element.sweep(),
    }
}

/// How far `p` lies right of the line or circle that `segment` runs on.
fn offside(segment: &Segment, p: Point) -> f64 {
    match segment.link {
        Link::Line => (p - segment.start).dot(&right_normal(segment.start_tangent())),
        Link::Arc(arc) => arc.turn.sign() * ((p - arc.center).norm() - arc.radius),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(x: f64, y: f64, degrees: f64) -> Place {
        let a = degrees.to_radians();
        Place { point: Point::new(x, y), tangent: Vector::new(a.cos(), a.sin()) }
    }

    #[test]
    fn a_circle_gives_its_own_arcs() {
        let biarc = Biarc::between(place(3.0, 0.0, 90.0), place(0.0, 3.0, 180.0)).unwrap();
        for part in [biarc.first, biarc.second] {
            let Link::Arc(arc) = part.link else { panic!("{part:?} is no arc") };
            assert!((arc.center - Point::origin()).norm() < 1e-12);
            assert!((arc.radius - 3.0).abs() < 1e-12);
            assert!((part.sweep() - std::f64::consts::FRAC_PI_4).abs() < 1e-12);
        }
        assert!((biarc.offside(Point::new(2.0, 3.0)) - (13f64.sqrt() - 3.0)).abs() < 1e-12);
    }

    #[test]
    fn it_leaves_and_arrives_as_asked_and_has_no_corner() {
        for (a, b) in [
            (place(0.0, 0.0, 10.0), place(5.0, 1.0, -20.0)),
            (place(1.0, 2.0, 100.0), place(-3.0, 4.0, 160.0)),
            (place(0.0, 0.0, 30.0), place(4.0, 0.0, 30.0)),
            (place(0.0, 0.0, 0.0), place(4.0, 0.0, 0.0)),
        ] {
            let biarc = Biarc::between(a, b).unwrap();
            assert!((biarc.first.start_tangent() - a.tangent).norm() < 1e-9);
            assert!((biarc.first.end_tangent() - biarc.second.start_tangent()).norm() < 1e-7);
            assert!((biarc.second.end_tangent() - b.tangent).norm() < 1e-9);
        }
        assert!(Biarc::between(place(0.0, 0.0, 0.0), place(-4.0, 0.0, 0.0)).is_none());
    }
}
