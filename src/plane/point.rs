//! Points and directions of the plane, and the angles between directions.

/// A place in the plane.
pub type Point = nalgebra::Point2<f64>;

/// A displacement or a direction in the plane. `a.perp(&b)` is the cross product, positive where `b` lies left of `a`.
pub type Vector = nalgebra::Vector2<f64>;

/// `v` turned a quarter turn to the right, towards the outside of a ring that runs along `v`.
#[inline]
pub fn right_normal(v: Vector) -> Vector {
    Vector::new(v.y, -v.x)
}

/// `v` turned a quarter turn to the left, towards the solid of a ring that runs along `v`.
#[inline]
pub fn left_normal(v: Vector) -> Vector {
    Vector::new(-v.y, v.x)
}

/// The angle in radians from one direction to another, in (-π, π], positive to the left.
#[inline]
pub fn turn_angle(from: Vector, to: Vector) -> f64 {
    // Below this the series of the arc tangent ends, to the last digit, with the power written here.
    const SHORT: f64 = 0.1;
    let (sine, cosine) = (from.perp(&to), from.dot(&to));
    if sine.abs() >= SHORT * cosine {
        return sine.atan2(cosine);
    }
    // Along outlines most turns are short, and the general function costs several times as much.
    let t = sine / cosine;
    let s = -t * t;
    let tail = 1.0 / 7.0 + s * (1.0 / 9.0 + s * (1.0 / 11.0 + s * (1.0 / 13.0 + s * (1.0 / 15.0))));
    t + t * s * (1.0 / 3.0 + s * (1.0 / 5.0 + s * tail))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn turns_are_right_to_the_last_digit_by_either_way() {
        for k in -4000..=4000 {
            let angle = f64::from(k) * 1e-4;
            let (sin, cos) = angle.sin_cos();
            let turn = turn_angle(Vector::x() * 3.0, Vector::new(cos, sin));
            assert!((turn - angle).abs() <= 2.0 * f64::EPSILON * angle.abs().max(f64::MIN_POSITIVE), "{angle}: {turn}");
        }
    }

    #[test]
    fn turns_of_quarters() {
        let v = Vector::new(0.0, 2.0);
        assert_eq!(turn_angle(v, v), 0.0);
        assert_eq!(turn_angle(v, -v), PI);
        assert_eq!(turn_angle(v, left_normal(v)), FRAC_PI_2);
        assert_eq!(turn_angle(v, right_normal(v)), -FRAC_PI_2);
        assert_eq!(turn_angle(v, Vector::zeros()), 0.0);
    }
}
