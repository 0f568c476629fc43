//! A radius that varies over the plane.

use super::{Bounds, Point};
use crate::units::Radius;

/// The radius of the disk at every point of the plane: between the two radii it is made of, wherever the point is.
#[derive(Clone, Debug, PartialEq)]
pub enum RadiusField {
    /// The same everywhere.
    Constant(Radius),
    /// From one point to another.
    Gradient(Gradient),
    /// By the brightness of a picture.
    Map(RadiusMap),
}

impl RadiusField {
    /// The radius at `p`.
    pub fn at(&self, p: Point) -> f64 {
        match self {
            RadiusField::Constant(radius) => radius.get(),
            RadiusField::Gradient(gradient) => gradient.at(p),
            RadiusField::Map(map) => map.at(p),
        }
    }

    /// The smallest and the largest radius that the field takes.
    pub fn range(&self) -> [Radius; 2] {
        let sorted = |a: Radius, b: Radius| if b < a { [b, a] } else { [a, b] };
        match self {
            RadiusField::Constant(radius) => [*radius; 2],
            RadiusField::Gradient(g) => sorted(g.from.1, g.to.1),
            RadiusField::Map(m) => sorted(m.black, m.white),
        }
    }
}

/// A radius at each of two points: linear between them, the same along lines across, constant beyond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient {
    from: (Point, Radius),
    to: (Point, Radius),
}

impl Gradient {
    /// The gradient between two points; `None` where they are so near that they have no direction, or not finite.
    pub fn new(from: (Point, Radius), to: (Point, Radius)) -> Option<Gradient> {
        let squared = (to.0 - from.0).norm_squared();
        squared.is_normal().then_some(Gradient { from, to })
    }

    /// The radius at `p`.
    pub fn at(&self, p: Point) -> f64 {
        let way = self.to.0 - self.from.0;
        let t = (p - self.from.0).dot(&way) / way.norm_squared();
        mix(self.from.1, self.to.1, t)
    }
}

/// Brightness on a grid of cells over a box, and the radii that black and white stand for.
///
/// Each level is that of the middle of its cell; in between it is bilinear, beyond the outermost middles constant.
#[derive(Clone, Debug, PartialEq)]
pub struct RadiusMap {
    columns: usize,
    levels: Vec<f64>,
    area: Bounds,
    black: Radius,
    white: Radius,
}

impl RadiusMap {
    /// The map of `levels`, from 0 (black) to 1 (white), in rows of `columns` from the top; laid over `area`.
    ///
    /// `None` where the levels fill no rows, or the area has no width or height.
    pub fn new(columns: usize, levels: Vec<f64>, area: Bounds, black: Radius, white: Radius) -> Option<RadiusMap> {
        let fills_rows = columns > 0 && !levels.is_empty() && levels.len().is_multiple_of(columns);
        let has_area = area.width() > 0.0 && area.height() > 0.0;
        (fills_rows && has_area).then_some(RadiusMap { columns, levels, area, black, white })
    }

    /// The radius at `p`.
    pub fn at(&self, p: Point) -> f64 {
        let rows = self.levels.len() / self.columns;
        let x = (p.x - self.area.min.x) / self.area.width();
        let y = (self.area.max.y - p.y) / self.area.height();
        let (left, right, u) = neighbours(x, self.columns);
        let (top, bottom, v) = neighbours(y, rows);
        let level = |column: usize, row: usize| self.levels[row * self.columns + column];
        let along = |row: usize| level(left, row) + (level(right, row) - level(left, row)) * u;
        mix(self.black, self.white, along(top) + (along(bottom) - along(top)) * v)
    }
}

/// The two of `cells` along a side of length 1 between whose middles `x` lies, and the fraction of the way.
fn neighbours(x: f64, cells: usize) -> (usize, usize, f64) {
    let last = cells - 1;
    // What is no number is clamped by `max` as well.
    let place = (x * cells as f64 - 0.5).max(0.0).min(last as f64);
    let before = (place as usize).min(last);
    (before, (before + 1).min(last), place - before as f64)
}

/// From `a` at 0 to `b` at 1, never outside of the two.
fn mix(a: Radius, b: Radius, t: f64) -> f64 {
    // Exact at both ends; what is no number is at the first.
    match t {
        t if t >= 1.0 => b.get(),
        t if t > 0.0 => a.get() + (b.get() - a.get()) * t,
        _ => a.get(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn radius(r: f64) -> Radius {
        Radius::new(r).unwrap()
    }

    #[test]
    fn a_gradient_is_linear_between_and_constant_beyond() {
        let p = Point::new;
        let field = Gradient::new((p(10.0, 0.0), radius(1.0)), (p(90.0, 0.0), radius(6.0))).unwrap();
        for (x, y, expected) in
            [(10.0, 5.0, 1.0), (90.0, -8.0, 6.0), (50.0, 3.0, 3.5), (-1e9, 0.0, 1.0), (1e9, 0.0, 6.0), (26.0, 0.0, 2.0)]
        {
            assert_eq!(field.at(p(x, y)), expected, "({x}, {y})");
        }
        let slanted = Gradient::new((p(0.0, 0.0), radius(4.0)), (p(3.0, 4.0), radius(2.0))).unwrap();
        assert!((slanted.at(p(1.5, 2.0)) - 3.0).abs() < 1e-15);
        assert!((slanted.at(p(1.5 - 4.0, 2.0 + 3.0)) - 3.0).abs() < 1e-15, "the same across");
        assert_eq!(RadiusField::Gradient(slanted).range(), [radius(2.0), radius(4.0)]);
        assert_eq!(Gradient::new((p(1.0, 2.0), radius(1.0)), (p(1.0, 2.0), radius(2.0))), None);
        assert_eq!(Gradient::new((p(f64::NAN, 2.0), radius(1.0)), (p(1.0, 2.0), radius(2.0))), None);
    }

    #[test]
    fn a_map_is_bilinear_and_its_first_row_is_the_top() {
        let area = Bounds { min: Point::new(0.0, -20.0), max: Point::new(40.0, 0.0) };
        // Black and white above, white and black below.
        let map = RadiusMap::new(2, vec![0.0, 1.0, 1.0, 0.0], area, radius(1.0), radius(3.0)).unwrap();
        for (x, y, expected) in [
            (10.0, -5.0, 1.0),
            (30.0, -5.0, 3.0),
            (10.0, -15.0, 3.0),
            (20.0, -5.0, 2.0),
            (20.0, -10.0, 2.0),
            (15.0, -7.5, 1.75),
            (0.0, 0.0, 1.0),
            (-100.0, 100.0, 1.0),
            (100.0, -100.0, 1.0),
        ] {
            assert_eq!(map.at(Point::new(x, y)), expected, "({x}, {y})");
        }
        let point = RadiusMap::new(1, vec![0.5], area, radius(1.0), radius(3.0)).unwrap();
        assert_eq!(point.at(Point::new(7.0, -3.0)), 2.0);
    }

    #[test]
    fn maps_without_rows_or_area_are_none() {
        let area = Bounds::of_points([Point::new(0.0, 0.0), Point::new(1.0, 1.0)]);
        let map = |columns, n, area| RadiusMap::new(columns, vec![0.0; n], area, radius(1.0), radius(2.0));
        assert!(map(2, 4, area).is_some());
        assert!(map(0, 4, area).is_none() && map(3, 4, area).is_none() && map(3, 0, area).is_none());
        assert!(map(2, 4, Bounds::of_points([Point::new(0.0, 0.0), Point::new(1.0, 0.0)])).is_none());
        assert!(map(2, 4, Bounds::EMPTY).is_none());
    }
}
