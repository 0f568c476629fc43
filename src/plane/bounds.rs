//! Axis-parallel bounding boxes.

use super::{Point, Vector};

/// An axis-parallel box; empty where `min` exceeds `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower left corner.
    pub min: Point,
    /// Upper right corner.
    pub max: Point,
}

impl Bounds {
    /// The box that holds nothing: the neutral element of [`Bounds::union`].
    pub const EMPTY: Bounds =
        Bounds { min: Point::new(f64::INFINITY, f64::INFINITY), max: Point::new(f64::NEG_INFINITY, f64::NEG_INFINITY) };

    /// The smallest box that holds `points`.
    pub fn of_points(points: impl IntoIterator<Item = Point>) -> Bounds {
        points.into_iter().fold(Bounds::EMPTY, Bounds::with_point)
    }

    /// This box grown to hold `p`.
    #[inline]
    pub fn with_point(self, p: Point) -> Bounds {
        Bounds {
            min: Point::new(smaller(self.min.x, p.x), smaller(self.min.y, p.y)),
            max: Point::new(larger(self.max.x, p.x), larger(self.max.y, p.y)),
        }
    }

    /// The smallest box that holds both.
    #[inline]
    pub fn union(self, other: Bounds) -> Bounds {
        Bounds {
            min: Point::new(smaller(self.min.x, other.min.x), smaller(self.min.y, other.min.y)),
            max: Point::new(larger(self.max.x, other.max.x), larger(self.max.y, other.max.y)),
        }
    }

    /// This box with every side moved outward by `margin`.
    #[inline]
    pub fn inflated(self, margin: f64) -> Bounds {
        Bounds {
            min: Point::new(self.min.x - margin, self.min.y - margin),
            max: Point::new(self.max.x + margin, self.max.y + margin),
        }
    }

    /// Whether the two boxes share a point, borders included.
    #[inline]
    pub fn overlaps(&self, other: &Bounds) -> bool {
        self.min.x <= other.max.x && other.min.x <= self.max.x && self.min.y <= other.max.y && other.min.y <= self.max.y
    }

    /// Whether `p` lies in the box, borders included.
    #[inline]
    pub fn contains(&self, p: Point) -> bool {
        self.min.x <= p.x && p.x <= self.max.x && self.min.y <= p.y && p.y <= self.max.y
    }

    /// Squared distance from `p` to the nearest point of the box; 0 inside.
    #[inline]
    pub fn distance_squared(&self, p: Point) -> f64 {
        let dx = larger(larger(0.0, self.min.x - p.x), p.x - self.max.x);
        let dy = larger(larger(0.0, self.min.y - p.y), p.y - self.max.y);
        dx * dx + dy * dy
    }

    /// Squared distance from any point of `other` to the nearest point of the box; 0 where they overlap.
    #[inline]
    pub fn gap_squared(&self, other: &Bounds) -> f64 {
        let dx = larger(larger(0.0, self.min.x - other.max.x), other.min.x - self.max.x);
        let dy = larger(larger(0.0, self.min.y - other.max.y), other.min.y - self.max.y);
        dx * dx + dy * dy
    }

    /// Whether the box holds no point.
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y)
    }

    /// Width, 0 for an empty box.
    pub fn width(&self) -> f64 {
        (self.max.x - self.min.x).max(0.0)
    }

    /// Height, 0 for an empty box.
    pub fn height(&self) -> f64 {
        (self.max.y - self.min.y).max(0.0)
    }

    /// Length of the diagonal, 0 for an empty box.
    pub fn diagonal(&self) -> f64 {
        self.width().hypot(self.height())
    }

    /// The displacement from the origin to a place near the box, so that taking it off rounds no coordinate of a point in
    /// the box; zero for a box that is near enough to the origin.
    pub fn exact_shift(&self) -> Vector {
        if self.is_empty() {
            return Vector::zeros();
        }
        let axis = |min: f64, max: f64| {
            let (center, extent) = (0.5 * (min + max), max - min);
            // From here on every coordinate keeps its last digit when a multiple of a large power of two is taken off.
            // A flat drawing has no extent to round to.
            if center.abs() < 4.0 * extent || !center.is_finite() || extent <= 0.0 {
                return 0.0;
            }
            let grain = extent.max(f64::MIN_POSITIVE).log2().ceil().exp2();
            (center / grain).round() * grain
        };
        Vector::new(axis(self.min.x, self.max.x), axis(self.min.y, self.max.y))
    }

    /// The middle of the box.
    pub fn center(&self) -> Point {
        nalgebra::center(&self.min, &self.max)
    }
}

/// The smaller number; `a` where `b` is none. One instruction, where `f64::min` has to ask after both.
#[inline]
fn smaller(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The larger number; `a` where `b` is none.
#[inline]
fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}
