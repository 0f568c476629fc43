//! The affine map that makes a disk of an ellipse, and regions seen through it.
//!
//! Whatever a disk does in the stretched plane the ellipse does in the plane itself: an affine map keeps what is inside,
//! what touches, and which curve is a Bézier curve of which control points.

use super::{Bounds, Joint, Link, Point, Region, Ring, Vector, Vertex, VertexId};
use crate::units::Brief;

/// The map that takes an ellipse of half axes r and r / aspect, the first at an angle from the x axis, to a disk of radius
/// r: a turn that brings the first axis to x, and a stretch of y by the aspect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    aspect: f64,
    degrees: f64,
    /// Direction of the first axis.
    axis: Vector,
}

/// Why there is no such ellipse.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidStretch {
    /// Zero, negative, no number, or so far from 1 that one axis is lost in the rounding of the other.
    #[error(
        "the aspect is {}: it is the first half axis over the second, a number from {:?} to {LARGEST_ASPECT:?}",
        Brief(*.0), 1.0 / LARGEST_ASPECT
    )]
    Aspect(f64),
    /// Infinite, or no number.
    #[error("the angle is {}: it must be a finite number of degrees", Brief(*.0))]
    Angle(f64),
}

/// The most that one half axis of an ellipse may be longer than the other: beyond it the stretched plane has too few digits
/// left along one of its axes, and every outline is a needle.
pub const LARGEST_ASPECT: f64 = 1000.0;

impl Stretch {
    /// The map of an ellipse whose first half axis is `aspect` times the second, at `degrees` counterclockwise from the x
    /// axis.
    ///
    /// # Errors
    /// Where there is no such ellipse, or a useless one.
    pub fn new(aspect: f64, degrees: f64) -> Result<Stretch, InvalidStretch> {
        if !(1.0 / LARGEST_ASPECT..=LARGEST_ASPECT).contains(&aspect) {
            return Err(InvalidStretch::Aspect(aspect));
        }
        if !degrees.is_finite() {
            return Err(InvalidStretch::Angle(degrees));
        }
        // An ellipse is the same after half a turn.
        let degrees = degrees.rem_euclid(180.0);
        // Upright ones are exact.
        let axis = if degrees == 90.0 {
            Vector::y()
        } else {
            let (sin, cos) = degrees.to_radians().sin_cos();
            Vector::new(cos, sin)
        };
        Ok(Stretch { aspect, degrees, axis })
    }

    /// The first half axis over the second.
    pub fn aspect(&self) -> f64 {
        self.aspect
    }

    /// The angle of the first axis from the x axis, counterclockwise, in [0, 180).
    pub fn degrees(&self) -> f64 {
        self.degrees
    }

    /// The most by which a length grows in one of the two directions, into the frame or out of it; at least 1.
    pub fn largest_factor(&self) -> f64 {
        self.aspect.max(1.0 / self.aspect)
    }

    /// Whether the ellipse is a disk.
    pub fn is_round(&self) -> bool {
        self.aspect == 1.0
    }

    fn apply(&self, v: Vector) -> Vector {
        Vector::new(self.axis.dot(&v), self.axis.perp(&v) * self.aspect)
    }

    fn inverse(&self, v: Vector) -> Vector {
        let y = v.y / self.aspect;
        Vector::new(self.axis.x * v.x - self.axis.y * y, self.axis.y * v.x + self.axis.x * y)
    }
}

/// A region seen in the frame of a stretch, which remembers every vertex as it was.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretched {
    stretch: Stretch,
    /// What becomes the origin of the frame.
    origin: Vector,
    originals: Vec<Vertex>,
    region: Region,
    bounds: Bounds,
}

impl Stretched {
    /// `region` in the frame of `stretch`. Arcs become chords that stay within `tolerance` of them, a distance outside of
    /// the frame.
    ///
    /// `around` holds the region: parts of one drawing that are stretched with the same box have the same frame, to the last
    /// bit.
    pub fn new(region: &Region, stretch: Stretch, around: &Bounds, tolerance: f64) -> Stretched {
        let origin = around.exact_shift();
        let corners =
            [around.min, Point::new(around.max.x, around.min.y), around.max, Point::new(around.min.x, around.max.y)];
        let mut stretched =
            Stretched { stretch, origin, originals: Vec::new(), region: Region::default(), bounds: Bounds::EMPTY };
        stretched.bounds = Bounds::of_points(corners.map(|p| stretched.framed(p)));
        for ring in &region.rings {
            let mut vertices = Vec::with_capacity(ring.len());
            for (i, v) in ring.vertices.iter().enumerate() {
                vertices.push(stretched.remembered(Vertex { link: Link::Line, ..*v }));
                if v.link == Link::Line {
                    continue;
                }
                let mut chords = Vec::new();
                ring.segment(i).flatten(tolerance, |p| chords.push(p));
                chords.pop();
                let smooth = |p| Vertex { joint: Joint::Smooth, ..Vertex::corner(p) };
                vertices.extend(chords.into_iter().map(|p| stretched.remembered(smooth(p))));
            }
            stretched.region.rings.push(Ring { vertices });
        }
        stretched
    }

    /// The vertex in the frame, named by its number among those that are remembered.
    fn remembered(&mut self, original: Vertex) -> Vertex {
        let id = VertexId::from_index(self.originals.len());
        self.originals.push(original);
        Vertex { point: self.framed(original.point), id: Some(id), ..original }
    }

    /// The region in the frame. Identities of its vertices mean something here only: see [`Stretched::restored`].
    pub fn region(&self) -> &Region {
        &self.region
    }

    /// A box in the frame that holds what `around` held outside of it.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The map.
    pub fn stretch(&self) -> &Stretch {
        &self.stretch
    }

    fn framed(&self, p: Point) -> Point {
        Point::from(self.stretch.apply(p - Point::from(self.origin)))
    }

    /// A point of the frame outside of it.
    pub fn out_of_frame(&self, p: Point) -> Point {
        Point::from(self.stretch.inverse(p.coords) + self.origin)
    }

    /// What a vertex in the frame is outside of it: one of the region has the point and the identity that it had, bit for
    /// bit. Its link stays in the frame.
    pub fn restored(&self, v: &Vertex) -> Vertex {
        match v.id.and_then(|id| self.originals.get(id.index())) {
            Some(original) => Vertex { link: v.link, ..*original },
            None => Vertex { point: self.out_of_frame(v.point), id: None, ..*v },
        }
    }

    /// A region of the frame outside of it, with chords in place of its arcs, which are arcs of ellipses there: they stay
    /// within `tolerance`, a distance outside of the frame.
    pub fn flattened(&self, framed: &Region, tolerance: f64) -> Region {
        // Out of the frame lengths may grow by this.
        let inside = tolerance * self.stretch.aspect.min(1.0);
        let ring = |ring: &Ring| {
            let mut vertices = Vec::with_capacity(ring.len());
            for (i, v) in ring.vertices.iter().enumerate() {
                vertices.push(Vertex { link: Link::Line, ..self.restored(v) });
                let mut chords = Vec::new();
                ring.segment(i).flatten(inside, |p| chords.push(p));
                chords.pop();
                let smooth = |p| Vertex { joint: Joint::Smooth, ..Vertex::corner(self.out_of_frame(p)) };
                vertices.extend(chords.into_iter().map(smooth));
            }
            Ring { vertices }
        };
        Region::new(framed.rings.iter().map(ring).collect())
    }

    /// The area outside of the frame of a region in it.
    pub fn area(&self, framed: &Region) -> f64 {
        framed.area() / self.stretch.aspect
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ellipse_becomes_the_disk_and_everything_comes_back() {
        let stretch = Stretch::new(2.5, 30.0).unwrap();
        let bounds = Bounds::of_points([Point::new(-9.0, -9.0), Point::new(9.0, 9.0)]);
        let stretched = Stretched::new(&Region::default(), stretch, &bounds, 1e-3);
        let (sin, cos) = 30f64.to_radians().sin_cos();
        for k in 0..12 {
            let (s, c) = f64::from(k).sin_cos();
            // Half axes of 5 and 2, the first at 30 degrees.
            let (x, y) = (5.0 * c, 2.0 * s);
            let p = Point::new(cos * x - sin * y, sin * x + cos * y);
            let q = stretched.framed(p);
            assert!((q.coords.norm() - 5.0).abs() < 1e-14, "{q}");
            assert!((stretched.out_of_frame(q) - p).norm() < 1e-14);
        }
    }

    #[test]
    fn upright_ellipses_are_exact_and_half_a_turn_is_none() {
        let p = Vector::new(0.1, 0.3);
        let upright = Stretch::new(2.0, 90.0).unwrap();
        assert_eq!(upright.apply(p), Vector::new(0.3, -0.2));
        assert_eq!(Stretch::new(2.0, 0.0).unwrap().apply(p), Vector::new(0.1, 0.6));
        assert_eq!(Stretch::new(2.0, -90.0), Ok(upright));
        assert_eq!(Stretch::new(2.0, 540.0), Stretch::new(2.0, 0.0));
    }

    #[test]
    fn far_away_nothing_is_lost_and_arcs_are_chords() {
        let center = Point::new(3e7, -8e7);
        let circle = Region::new(vec![Ring::circle(center, 1.0)]);
        let stretch = Stretch::new(3.0, 40.0).unwrap();
        let stretched = Stretched::new(&circle, stretch, &circle.bounds(), 1e-4);
        assert!(stretched.region().segments().all(|s| s.link == Link::Line));
        assert!((stretched.area(stretched.region()) - std::f64::consts::PI).abs() < 1e-3);
        let back = stretched.flattened(stretched.region(), 1e-4);
        for v in &circle.rings[0].vertices {
            assert!(back.rings[0].vertices.iter().any(|w| w.point == v.point), "{}", v.point);
        }
    }

    #[test]
    fn useless_ellipses_are_refused() {
        for aspect in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-4, 1001.0] {
            assert!(matches!(Stretch::new(aspect, 0.0), Err(InvalidStretch::Aspect(_))), "{aspect}");
        }
        for degrees in [f64::NAN, f64::INFINITY] {
            assert!(matches!(Stretch::new(2.0, degrees), Err(InvalidStretch::Angle(_))), "{degrees}");
        }
    }
}
