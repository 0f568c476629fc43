//! SVG's elliptical arc: from the end points that the file gives to centre and angles.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::plane::{Bounds, Point, Vector};

use super::affine::Affine;

/// Part of an ellipse. Angles are those of the parameter (eccentric), in SVG's sense (positive turns x towards y).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::io) struct EllipticArc {
    pub center: Point,
    /// Radii along the axes of the ellipse, positive.
    pub rx: f64,
    pub ry: f64,
    /// Direction of the first axis in degrees, as the file has it.
    pub degrees: f64,
    /// Parameter at the start.
    pub start: f64,
    /// Parameter travelled, signed, at most a full turn.
    pub sweep: f64,
    /// The end point as the file has it.
    pub to: Point,
}

/// How near a half turn the chord of an arc must be to the diameter, in units of rounding, to be taken for it: the
/// centre is the root of that difference, so noise in the last digit would move it by 1e-8 of the radius.
const HALF_TURN_ULPS: f64 = 16.0;

/// An arc that bulges by less than this part of its chord is a straight line: a thousandth of what chords may stray from
/// curves, and its centre would be beyond all coordinates.
const FLAT_BULGE: f64 = 1e-9;

/// How unequal the radii of the image of an arc may be, relative, for it to be a circle.
const CIRCLE_TOLERANCE: f64 = 1e-12;

impl EllipticArc {
    /// The quarter of an unrotated ellipse that starts `quarter` quarter turns from the x axis and ends at `to`.
    pub fn quarter(center: Point, rx: f64, ry: f64, quarter: usize, to: Point) -> EllipticArc {
        EllipticArc { center, rx, ry, degrees: 0.0, start: quarter as f64 * FRAC_PI_2, sweep: FRAC_PI_2, to }
    }

    /// The arc of SVG's `A` command (SVG 2, implementation notes B.2.4); `None` where it is a straight line or nothing.
    pub fn from_svg(
        from: Point,
        (rx, ry): (f64, f64),
        rotation_degrees: f64,
        large_arc: bool,
        sweep: bool,
        to: Point,
    ) -> Option<EllipticArc> {
        let (mut rx, mut ry) = (rx.abs(), ry.abs());
        if from == to || !rx.is_normal() || !ry.is_normal() {
            return None;
        }
        let degrees = if rx == ry { 0.0 } else { rotation_degrees % 360.0 };
        let (sin, cos) = degrees.to_radians().sin_cos();
        let half = (from - to) / 2.0;
        // The half chord in the frame where the ellipse is the unit circle.
        let u = Vector::new((cos * half.x + sin * half.y) / rx, (cos * half.y - sin * half.x) / ry);
        let length_squared = u.norm_squared();
        // In that frame the bulge is half the squared half chord, and the chord twice that half.
        if !large_arc && length_squared.sqrt() / 4.0 < FLAT_BULGE * (rx.min(ry) / rx.max(ry)) {
            return None;
        }
        let size = from.coords.amax().max(to.coords.amax());
        let noise = HALF_TURN_ULPS * f64::EPSILON * (1.0 + size / rx.min(ry));
        let middle = Point::from((from.coords + to.coords) / 2.0);
        let (center, w) = if length_squared >= 1.0 - noise {
            // Half a turn; radii that are too small grow until they reach.
            if length_squared > 1.0 + noise {
                let grow = length_squared.sqrt();
                rx *= grow;
                ry *= grow;
            }
            (middle, Vector::zeros())
        } else {
            let side = if large_arc == sweep { -1.0 } else { 1.0 };
            let w = Vector::new(u.y, -u.x) * (side * ((1.0 - length_squared) / length_squared).sqrt());
            let offset = Vector::new(cos * w.x * rx - sin * w.y * ry, sin * w.x * rx + cos * w.y * ry);
            (middle + offset, w)
        };
        let (a, b) = (u - w, -u - w);
        let start = a.y.atan2(a.x);
        let mut angle = a.perp(&b).atan2(a.dot(&b));
        if w == Vector::zeros() {
            angle = PI;
        }
        if sweep && angle < 0.0 {
            angle += TAU;
        } else if !sweep && angle > 0.0 {
            angle -= TAU;
        }
        Some(EllipticArc { center, rx, ry, degrees, start, sweep: angle, to })
    }

    /// The image of the two half axes, so that a point is centre + first cos t + second sin t, y up.
    fn axes(&self, affine: &Affine) -> (Vector, Vector) {
        let (sin, cos) = self.degrees.to_radians().sin_cos();
        let first = affine.apply_vector(Vector::new(cos, sin) * self.rx);
        let second = affine.apply_vector(Vector::new(-sin, cos) * self.ry);
        (Vector::new(first.x, -first.y), Vector::new(second.x, -second.y))
    }

    /// The image of the point at parameter `t`, y up.
    pub fn point(&self, affine: &Affine, t: f64) -> Point {
        let (first, second) = self.axes(affine);
        let (sin, cos) = t.sin_cos();
        affine.apply_y_up(self.center) + first * cos + second * sin
    }

    /// The image of the direction of travel at parameter `t`, y up, not normalised.
    pub fn tangent(&self, affine: &Affine, t: f64) -> Vector {
        let (first, second) = self.axes(affine);
        let (sin, cos) = t.sin_cos();
        (second * cos - first * sin) * self.sweep.signum()
    }

    /// The radius of the image, where it is a circle.
    pub fn circle_radius(&self, affine: &Affine) -> Option<f64> {
        if self.rx == self.ry
            && let Some(scale) = affine.similarity_scale()
        {
            return Some(self.rx * scale);
        }
        let ImageAxes { first, second, .. } = self.image_axes(affine);
        let largest = first.max(second);
        ((first - second).abs() <= CIRCLE_TOLERANCE * largest && largest > 0.0).then_some((first + second) / 2.0)
    }

    /// Half axes of the image and the direction of the first one in degrees, y down as SVG writes it.
    pub fn image_axes(&self, affine: &Affine) -> ImageAxes {
        if *affine == Affine::IDENTITY {
            return ImageAxes { first: self.rx, second: self.ry, degrees: self.degrees };
        }
        // Rytz: the parameter at which the half axes of the image are reached.
        let (u, v) = self.axes(affine);
        let t = 0.5 * (2.0 * u.dot(&v)).atan2(u.norm_squared() - v.norm_squared());
        let (sin, cos) = t.sin_cos();
        let (p, q) = (u * cos + v * sin, v * cos - u * sin);
        let (p, q) = if p.norm_squared() >= q.norm_squared() { (p, q) } else { (q, p) };
        ImageAxes { first: p.norm(), second: q.norm(), degrees: (-p.y).atan2(p.x).to_degrees() }
    }

    /// The smallest box around the image, y up.
    pub fn bounds(&self, affine: &Affine) -> Bounds {
        let (u, v) = self.axes(affine);
        let center = affine.apply_y_up(self.center);
        let mut bounds = Bounds::of_points([self.point(affine, self.start), affine.apply_y_up(self.to)]);
        // x is stationary where tan t = v.x / u.x, and y likewise, twice a turn.
        for t in [v.x.atan2(u.x), v.y.atan2(u.y)] {
            for t in [t, t + PI] {
                let travelled = ((t - self.start) * self.sweep.signum()).rem_euclid(TAU);
                if travelled <= self.sweep.abs() {
                    let (sin, cos) = t.sin_cos();
                    bounds = bounds.with_point(center + u * cos + v * sin);
                }
            }
        }
        bounds
    }
}

/// The half axes of an ellipse in root units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::io) struct ImageAxes {
    pub first: f64,
    pub second: f64,
    /// Direction of the first.
    pub degrees: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arc(from: (f64, f64), r: (f64, f64), large: bool, sweep: bool, to: (f64, f64)) -> EllipticArc {
        EllipticArc::from_svg(Point::new(from.0, from.1), r, 0.0, large, sweep, Point::new(to.0, to.1)).unwrap()
    }

    #[test]
    fn a_half_turn_has_its_centre_exactly_between_the_ends() {
        let a = arc((16.0, 20.0), (4.0, 4.0), true, false, (24.0, 20.0));
        assert_eq!((a.center, a.rx, a.sweep), (Point::new(20.0, 20.0), 4.0, -PI));
        // Decimals that differ from the diameter in the last digit only.
        let a = arc((45.1, 17.5), (2.6, 2.6), false, true, (45.1, 22.7));
        assert_eq!((a.rx, a.sweep), (2.6, PI));
    }

    #[test]
    fn a_quarter_turn_is_found_on_all_four_flags() {
        let ends = ((1.0, 0.0), (0.0, 1.0));
        for (large, sweep, center, angle) in [
            (false, true, (0.0, 0.0), FRAC_PI_2),
            (true, true, (1.0, 1.0), 3.0 * FRAC_PI_2),
            (false, false, (1.0, 1.0), -FRAC_PI_2),
            (true, false, (0.0, 0.0), -3.0 * FRAC_PI_2),
        ] {
            let a = arc(ends.0, (1.0, 1.0), large, sweep, ends.1);
            assert!((a.center - Point::new(center.0, center.1)).norm() < 1e-15, "{large} {sweep} {a:?}");
            assert!((a.sweep - angle).abs() < 1e-14, "{large} {sweep} {a:?}");
            let end = a.point(&Affine::IDENTITY, a.start + a.sweep);
            assert!((end - Point::new(0.0, -1.0)).norm() < 1e-15);
        }
    }

    #[test]
    fn radii_too_small_grow() {
        let a = arc((0.0, 0.0), (1.0, 2.0), false, true, (8.0, 0.0));
        assert_eq!((a.rx, a.ry, a.center), (4.0, 8.0, Point::new(4.0, 0.0)));
    }

    #[test]
    fn an_ellipse_squeezed_to_a_circle_is_one() {
        let a = arc((3.0, 0.0), (3.0, 1.0), false, true, (0.0, 1.0));
        let squeeze = Affine { a: 1.0 / 3.0, ..Affine::IDENTITY };
        assert!((a.circle_radius(&squeeze).unwrap() - 1.0).abs() < 1e-12);
        assert_eq!(a.circle_radius(&Affine::IDENTITY), None);
    }

    #[test]
    fn bounds_touch_the_extremes() {
        let a = arc((1.0, 0.0), (1.0, 1.0), true, true, (0.0, -1.0));
        let b = a.bounds(&Affine::IDENTITY);
        let expected = [-1.0, -1.0, 1.0, 1.0];
        let found = [b.min.x, b.min.y, b.max.x, b.max.y];
        assert!(found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-15), "{b:?}");
    }
}
