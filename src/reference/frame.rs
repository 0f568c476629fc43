//! The coordinates in which references are computed: the box centre is the origin and the radius is 1.

use crate::plane::{Arc, Bounds, Link, Point, Region, Ring, Vertex};

/// The map between a drawing and the coordinates of its reference.
///
/// Far from the origin an offset loses the digits it needs, and every tolerance of a polygon clipper is absolute: in
/// these coordinates neither matters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    center: Point,
    radius: f64,
}

impl Frame {
    pub(super) fn new(bounds: Bounds, radius: f64) -> Frame {
        Frame { center: bounds.center(), radius }
    }

    /// `p` in units of the radius.
    pub(super) fn point_to_unit(self, p: Point) -> Point {
        Point::from((p - self.center) / self.radius)
    }

    /// `p`, given in units of the radius, in the drawing.
    pub(super) fn point_to_drawing(self, p: Point) -> Point {
        self.center + p.coords * self.radius
    }

    /// `region` in units of the radius, without links of no length and rings of no area.
    pub(super) fn to_unit(self, region: &Region) -> Region {
        Region::new(
            region
                .rings
                .iter()
                .filter_map(|ring| cleaned(mapped(ring, |p| self.point_to_unit(p), 1.0 / self.radius)))
                .collect(),
        )
    }

    /// The way back.
    pub(super) fn to_drawing(self, region: &Region) -> Region {
        Region::new(region.rings.iter().map(|ring| mapped(ring, |p| self.point_to_drawing(p), self.radius)).collect())
    }
}

fn mapped(ring: &Ring, map: impl Fn(Point) -> Point, scale: f64) -> Ring {
    let vertices = ring.vertices.iter().map(|v| {
        let link = match v.link {
            Link::Line => Link::Line,
            Link::Arc(arc) => Link::Arc(Arc { center: map(arc.center), radius: arc.radius * scale, ..arc }),
        };
        Vertex { point: map(v.point), link, ..*v }
    });
    Ring { vertices: vertices.collect() }
}

/// The ring without links of no length; `None` where nothing of it encloses anything.
fn cleaned(ring: Ring) -> Option<Ring> {
    let n = ring.len();
    let kept = (0..n).filter(|&i| ring.vertices[i].point != ring.vertices[(i + 1) % n].point);
    let ring = Ring { vertices: kept.map(|i| ring.vertices[i]).collect() };
    (ring.len() >= 2 && ring.area() != 0.0).then_some(ring)
}
