//! What of the input no ball can touch: its vertices, and what lies between those of coarse faces.

use super::contact::{Ground, UNTOUCHED};
use super::{BESIDE, TOUCHING};
use crate::mesh::{Point, Vector};

/// What would move by less than this many edge lengths stays: samples of a surface that the ball fits are on it, not their
/// chords.
pub(super) const DEAD_BAND: f64 = 0.05;

/// Faces are looked at in parts that are no larger than so many edge lengths.
const PART: f64 = 0.75;

/// What rises above the plane of a face by less than this part of an edge length does not: rounding.
const FLAT: f64 = 1e-6;

/// Radii grow by no more than this for every unit of way: what pins them does so.
const SLOPE: f64 = 1.0;

impl Ground {
    /// Whether the ball cannot touch a point of the surface with a unit normal, by more than rounding and chords do.
    pub fn is_hidden(&self, x: Point, normal: Vector, r: f64, edge: f64) -> bool {
        if r <= 0.0 || !self.hierarchy.is_nearer(x + normal * r, r * (1.0 - TOUCHING)) {
            return false;
        }
        let Some(rest) = self.rest(x, x + normal * r, r, UNTOUCHED) else { return true };
        let way = rest.center - x;
        way.norm() - r > DEAD_BAND * edge || self.hierarchy.is_crossed(x + way * BESIDE, rest.center)
    }

    /// A point in a triangle of the surface that the ball cannot touch, if there is one farther than about an edge length from
    /// all that it can.
    ///
    /// Parts of the triangle above which nothing is within reach of the ball are not looked into.
    pub fn hidden_between(&self, triangle: [Point; 3], radius: &dyn Fn(Point) -> f64, edge: f64) -> Option<Point> {
        let [a, b, c] = triangle;
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
        let corner = a;
        let mut open = vec![triangle];
        while let Some([a, b, c]) = open.pop() {
            let middle = Point::from((a.coords + b.coords + c.coords) / 3.0);
            let reach = [a, b, c].iter().map(|p| (p - middle).norm()).fold(0.0, f64::max);
            let r = radius(middle);
            if reach <= PART * edge {
                if self.is_hidden(middle, normal, r, edge) {
                    return Some(middle);
                }
                continue;
            }
            let largest = r + SLOPE * reach;
            let center = middle + normal * r;
            // Balls that touch this part have their centres within this from the one that touches its middle.
            let within = largest + reach * (1.0 + SLOPE);
            if !self.hierarchy.is_nearer_above(center, within, corner, normal, FLAT * edge) {
                continue;
            }
            // The longest side is cut.
            let sides = [(b - a).norm_squared(), (c - b).norm_squared(), (a - c).norm_squared()];
            let [a, b, c] = match sides {
                [x, y, z] if x >= y && x >= z => [a, b, c],
                [_, y, z] if y >= z => [b, c, a],
                _ => [c, a, b],
            };
            let half = nalgebra::center(&a, &b);
            open.extend([[a, half, c], [half, b, c]]);
        }
        None
    }
}
