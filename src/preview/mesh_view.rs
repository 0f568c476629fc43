//! From where a surface is looked at: parallel rays, as in an isometric drawing.

use crate::mesh::{Point, Vector};

/// How far above the horizon the eye is, in degrees.
const ELEVATION: f64 = 28.0;

/// Where the eye stands around the upright axis: between the first two axes as in an isometric drawing, but not on their
/// bisector, where the two sides of a box would look alike; then a quarter turn on, and so forth. In degrees.
const AZIMUTHS: [f64; 4] = [-55.0, 35.0, 125.0, 215.0];

/// How many views there are to choose from.
pub(super) const VIEWS: usize = AZIMUTHS.len();

/// Left free around the surface, as a fraction of the longer side of the picture.
const MARGIN: f64 = 0.04;

/// Directions of the picture in space.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    right: Vector,
    up: Vector,
    /// Towards the eye.
    near: Vector,
}

impl View {
    /// View number `k` of what lies between the corners of a box.
    pub(super) fn new([low, high]: [Point; 2], k: usize) -> View {
        let axis = upright(high - low);
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (sin, cos) = AZIMUTHS[k % VIEWS].to_radians().sin_cos();
        let (rise, reach) = ELEVATION.to_radians().sin_cos();
        let (mut near, mut up) = (Vector::zeros(), Vector::zeros());
        (near[u], near[v], near[axis]) = (reach * cos, reach * sin, rise);
        (up[u], up[v], up[axis]) = (-rise * cos, -rise * sin, reach);
        View { right: up.cross(&near), up, near }
    }

    /// A direction in the picture: to the right, up, and towards the eye.
    pub(super) fn direction(&self, v: &Vector) -> Vector {
        Vector::new(self.right.dot(v), self.up.dot(v), self.near.dot(v))
    }
}

/// The axis that stands upright: of y (as in drawings for films) and z (as in those for machines) the one along which the
/// box differs most from the two others, towers and plates alike; z where neither does.
fn upright(extent: Vector) -> usize {
    let contrast = |axis: usize| {
        let [a, b, c] = [axis, (axis + 1) % 3, (axis + 2) % 3].map(|k| extent[k].max(1e-300).ln());
        (a - 0.5 * (b + c)).abs()
    };
    // A hundredth: equal but for rounding.
    if contrast(1) > contrast(2) + 0.01 { 1 } else { 2 }
}

/// Where the points of space are in a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    pub(super) view: View,
    /// The middle of what is seen, in directions of the view.
    middle: Vector,
    /// Pixels in a unit of length.
    scale: f64,
    /// Pixels.
    pub(super) width: u32,
    pub(super) height: u32,
}

impl Camera {
    /// The camera that sees all `points`, in a picture whose longer side has `size` pixels.
    pub(super) fn fit<'a>(view: View, points: impl Iterator<Item = &'a Point>, size: u32) -> Camera {
        let far = Vector::repeat(f64::INFINITY);
        let (mut low, mut high) = (far, -far);
        for p in points {
            let q = view.direction(&p.coords);
            (low, high) = (low.inf(&q), high.sup(&q));
        }
        let extent = high - low;
        let longer = extent.x.max(extent.y).max(f64::MIN_POSITIVE);
        let scale = f64::from(size) * (1.0 - 2.0 * MARGIN) / longer;
        let side =
            |length: f64| ((length / longer + 2.0 * MARGIN / (1.0 - 2.0 * MARGIN)) * scale * longer).ceil() as u32;
        let [width, height] = [extent.x, extent.y].map(|x| side(x).clamp(1, size));
        Camera { view, middle: (low + high) / 2.0, scale, width, height }
    }

    /// Pixels to the right and down from the upper left corner, and how far behind the middle.
    pub(super) fn pixel(&self, p: &Point) -> Vector {
        let q = (self.view.direction(&p.coords) - self.middle) * self.scale;
        Vector::new(0.5 * f64::from(self.width) + q.x, 0.5 * f64::from(self.height) - q.y, -q.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn towers_and_plates_stand_upright() {
        assert_eq!(upright(Vector::new(1.0, 4.0, 1.0)), 1);
        assert_eq!(upright(Vector::new(1.0, 0.1, 1.0)), 1);
        assert_eq!(upright(Vector::new(1.0, 1.0, 0.1)), 2);
        assert_eq!(upright(Vector::new(1.0, 1.0, 1.0)), 2);
    }

    #[test]
    fn views_are_right_handed_and_everything_is_in_the_picture() {
        let bounds = [Point::new(-1.0, 2.0, 0.0), Point::new(3.0, 3.0, 1.0)];
        for k in 0..VIEWS {
            let view = View::new(bounds, k);
            assert!((view.right.cross(&view.up) - view.near).norm() < 1e-12);
            assert!(view.near.z.abs() > 0.4 || view.near.y.abs() > 0.4, "from above");
            let camera = Camera::fit(view, bounds.iter(), 200);
            assert_eq!(camera.width.max(camera.height), 200);
            for p in &bounds {
                let q = camera.pixel(p);
                let inside = |x: f64, side: u32| x > 7.0 && x < f64::from(side) - 7.0;
                assert!(inside(q.x, camera.width) && inside(q.y, camera.height), "{q:?}");
            }
        }
    }
}
