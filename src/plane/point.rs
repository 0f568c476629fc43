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
    from.perp(&to).atan2(from.dot(&to))
}
