//! Affine maps of the plane in `f64`, in SVG's notation.

use crate::plane::{Point, Vector};

/// x' = a x + c y + e, y' = b x + d y + f.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::io) struct Affine {
    pub a: f64,
    pub b: f64,
    pub c: f64,
    pub d: f64,
    pub e: f64,
    pub f: f64,
}

/// How unequal the axes of a map may be, relative to their length, to still count as a similarity: rounding of the
/// products of a few rotations stays far below, a visible ellipse far above.
const SIMILARITY_TOLERANCE: f64 = 1e-12;

impl Affine {
    pub const IDENTITY: Affine = Affine { a: 1.0, b: 0.0, c: 0.0, d: 1.0, e: 0.0, f: 0.0 };

    pub fn translation(x: f64, y: f64) -> Affine {
        Affine { e: x, f: y, ..Affine::IDENTITY }
    }

    /// First `inner`, then `self`.
    pub fn then_inner(&self, inner: &Affine) -> Affine {
        // The identity passes every digit of the other map through.
        if *self == Affine::IDENTITY {
            return *inner;
        }
        if *inner == Affine::IDENTITY {
            return *self;
        }
        Affine {
            a: self.a * inner.a + self.c * inner.b,
            b: self.b * inner.a + self.d * inner.b,
            c: self.a * inner.c + self.c * inner.d,
            d: self.b * inner.c + self.d * inner.d,
            e: self.a * inner.e + self.c * inner.f + self.e,
            f: self.b * inner.e + self.d * inner.f + self.f,
        }
    }

    /// The image of a point. The identity returns the point itself, bit for bit (but never -0).
    #[inline]
    pub fn apply(&self, p: Point) -> Point {
        Point::new(self.a * p.x + self.c * p.y + self.e, self.b * p.x + self.d * p.y + self.f)
    }

    /// The image of a displacement.
    #[inline]
    pub fn apply_vector(&self, v: Vector) -> Vector {
        Vector::new(self.a * v.x + self.c * v.y, self.b * v.x + self.d * v.y)
    }

    /// The image of a point of the drawing in the plane of regions, where y points up.
    #[inline]
    pub fn apply_y_up(&self, p: Point) -> Point {
        let q = self.apply(p);
        // Adding zero turns -0 into 0.
        Point::new(q.x, 0.0 - q.y)
    }

    pub fn determinant(&self) -> f64 {
        self.a * self.d - self.b * self.c
    }

    /// `None` where the map flattens the plane.
    pub fn inverse(&self) -> Option<Affine> {
        let det = self.determinant();
        if !det.is_normal() {
            return None;
        }
        let (a, b, c, d) = (self.d / det, -self.b / det, -self.c / det, self.a / det);
        Some(Affine { a, b, c, d, e: -(a * self.e + c * self.f), f: -(b * self.e + d * self.f) })
    }

    /// The factor by which the map scales all lengths, where it is a similarity.
    pub fn similarity_scale(&self) -> Option<f64> {
        let (u, v) = (Vector::new(self.a, self.b), Vector::new(self.c, self.d));
        let (uu, vv) = (u.norm_squared(), v.norm_squared());
        let limit = SIMILARITY_TOLERANCE * uu.max(vv);
        let similar = (uu - vv).abs() <= limit && u.dot(&v).abs() <= limit && uu > 0.0;
        // An unrotated map has its scale in one entry: no root, no rounding.
        similar.then(|| if self.b == 0.0 { self.a.abs() } else { self.determinant().abs().sqrt() })
    }

    pub fn is_finite(&self) -> bool {
        [self.a, self.b, self.c, self.d, self.e, self.f].iter().all(|x| x.is_finite())
    }

    /// How far `self`, exact, is from `rough`, known in single precision: 0 is equal, above 1 is another map.
    pub fn mismatch(&self, rough: &Affine) -> f64 {
        /// Single precision has 6e-8; a chain of a dozen maps loses a few digits.
        const LINEAR: f64 = 1e-5;
        let scale = [rough.a, rough.b, rough.c, rough.d].iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let linear = [self.a - rough.a, self.b - rough.b, self.c - rough.c, self.d - rough.d];
        let linear = linear.iter().fold(0.0f64, |m, x| m.max(x.abs())) / (LINEAR * scale);
        // Offsets may be small differences of large terms: the size of a drawing in the map's own units stands for them.
        let offset = (self.e - rough.e).abs().max((self.f - rough.f).abs());
        let reach = rough.e.abs().max(rough.f.abs()).max(10.0 * scale);
        let mismatch = linear.max(offset / (LINEAR * reach));
        if mismatch.is_nan() { f64::INFINITY } else { mismatch }
    }
}

impl From<svgtypes::Transform> for Affine {
    fn from(t: svgtypes::Transform) -> Affine {
        Affine { a: t.a, b: t.b, c: t.c, d: t.d, e: t.e, f: t.f }
    }
}

impl From<usvg::Transform> for Affine {
    fn from(t: usvg::Transform) -> Affine {
        Affine {
            a: f64::from(t.sx),
            b: f64::from(t.ky),
            c: f64::from(t.kx),
            d: f64::from(t.sy),
            e: f64::from(t.tx),
            f: f64::from(t.ty),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_identity_keeps_every_bit() {
        let p = Point::new(0.1 + 0.2, 1e-17);
        let q = Affine::IDENTITY.apply_y_up(p);
        assert_eq!((q.x.to_bits(), q.y.to_bits()), (p.x.to_bits(), (-p.y).to_bits()));
        let zero = Affine::IDENTITY.apply_y_up(Point::origin());
        assert_eq!((zero.x.to_bits(), zero.y.to_bits()), (0, 0));
    }

    #[test]
    fn an_inverse_undoes() {
        let m = Affine { a: 2.0, b: 1.0, c: -3.0, d: 0.5, e: 7.0, f: -1.0 };
        let id = m.inverse().unwrap().then_inner(&m);
        assert!(id.mismatch(&Affine::IDENTITY) < 1e-9);
        assert!(Affine { a: 1.0, b: 2.0, c: 2.0, d: 4.0, e: 0.0, f: 0.0 }.inverse().is_none());
    }

    #[test]
    fn similarities_are_told_from_stretches() {
        let (sin, cos) = 0.7f64.sin_cos();
        let turn = Affine { a: 3.0 * cos, b: 3.0 * sin, c: 3.0 * sin, d: -3.0 * cos, e: 1.0, f: 2.0 };
        assert!((turn.similarity_scale().unwrap() - 3.0).abs() < 1e-14);
        assert_eq!(Affine { a: 2.0, d: 2.000001, ..Affine::IDENTITY }.similarity_scale(), None);
        assert_eq!(Affine { a: 0.1, d: -0.1, ..Affine::IDENTITY }.similarity_scale(), Some(0.1));
    }
}
