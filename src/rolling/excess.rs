//! How far a boundary turns away from the disk at a vertex, measured without an inverse tangent.
//!
//! The scan only compares turns. So it measures them on the square |x| + |y| = 1 in place of the circle: the measure
//! grows with the angle, costs one division, and near 0 and near half a turn differs from it (in radians) in the second
//! order only.

use crate::plane::Vector;

/// The measure of half a turn.
pub(super) const HALF_TURN: f64 = 2.0;

/// The measure of a whole turn.
pub(super) const WHOLE_TURN: f64 = 4.0;

/// The turn to the right from one direction (of any length) to another, in [-2, 2): 1 for a right angle. Straight back
/// is a turn to the left, the tip of a spike.
#[inline]
pub(super) fn excess(from: Vector, to: Vector) -> f64 {
    let (sine, cosine) = (-from.perp(&to), from.dot(&to));
    let size = sine.abs() + cosine.abs();
    if size == 0.0 {
        return 0.0;
    }
    let part = sine / size;
    if cosine >= 0.0 {
        part
    } else if sine > 0.0 {
        HALF_TURN - part
    } else {
        -HALF_TURN - part
    }
}

/// tan(e/2) for the right turn e from one direction to another: sin e / (1 + cos e).
pub(super) fn half_turn_tangent(from: Vector, to: Vector) -> f64 {
    let (sine, cosine) = (-from.perp(&to), from.dot(&to));
    sine / ((sine * sine + cosine * cosine).sqrt() + cosine)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn the_measure_grows_with_the_angle_and_tells_quarters_of_a_turn() {
        let direction = |angle: f64| Vector::new(angle.cos(), angle.sin());
        let from = direction(0.3) * 7.0;
        let measure = |angle: f64| excess(from, direction(0.3 - angle) * 0.2);
        for (angle, expected) in [(0.0, 0.0), (0.5, 1.0), (-0.5, -1.0), (0.25, 0.5), (0.75, 1.5), (-0.75, -1.5)] {
            assert!((measure(angle * PI) - expected).abs() < 1e-15, "{angle}");
        }
        let turns: Vec<f64> = (-999..1000).map(|k| measure(f64::from(k) * PI / 1000.0)).collect();
        assert!(turns.is_sorted());
        for small in [1e-9, -1e-9] {
            assert!((measure(small) - small).abs() < 1e-15);
        }
    }

    #[test]
    fn straight_back_is_a_tip_whatever_the_sign_of_zero() {
        for (u, v) in [
            (Vector::x(), -Vector::x()),
            (-Vector::x(), Vector::x()),
            (Vector::y(), -Vector::y()),
            (-Vector::y(), Vector::y()),
        ] {
            assert_eq!(excess(u, v), -HALF_TURN);
        }
        assert_eq!(excess(Vector::zeros(), Vector::x()), 0.0);
    }

    #[test]
    fn half_of_a_turn_has_the_tangent_of_half_the_angle() {
        for angle in [1e-6_f64, 0.3, 1.2, 3.0] {
            let to = Vector::new(angle.cos(), -angle.sin()) * 3.0;
            assert!((half_turn_tangent(Vector::x() * 0.1, to) / (0.5 * angle).tan() - 1.0).abs() < 1e-14);
        }
    }
}
