//! A closed boundary curve.

use std::num::NonZeroU32;

use super::{Bounds, Link, Point, Segment, Vector};

/// The identity of a vertex of a drawing: survives every operation that leaves the vertex where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct VertexId(NonZeroU32);

impl VertexId {
    /// The identity of the vertex that stands at `index` in the drawing's list of vertices.
    ///
    /// # Panics
    /// At more than 2³² - 2 vertices.
    pub fn from_index(index: usize) -> VertexId {
        let number = u32::try_from(index + 1).ok().and_then(NonZeroU32::new);
        VertexId(number.expect("a drawing has fewer than 2^32 - 1 vertices"))
    }

    /// The index in the drawing's list of vertices.
    pub fn index(self) -> usize {
        self.0.get() as usize - 1
    }
}

/// Whether the boundary really turns at a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Joint {
    /// A corner, or the smooth meeting of two links: the links are the boundary.
    #[default]
    Corner,
    /// A sample inside a smooth curve: the links that meet here are chords of it, and what turn there is belongs to
    /// the curve between the samples.
    Smooth,
}

/// A vertex of a ring with the link that leaves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Where it is.
    pub point: Point,
    /// How the boundary goes on to the next vertex.
    pub link: Link,
    /// Whether the turn at the vertex is real.
    pub joint: Joint,
    /// Which vertex of the drawing this is; none for a vertex that an operation made or moved.
    pub id: Option<VertexId>,
}

impl Vertex {
    /// A vertex without identity that is followed by a straight link.
    pub fn corner(point: Point) -> Vertex {
        Vertex { point, link: Link::Line, joint: Joint::Corner, id: None }
    }
}

/// A closed curve of straight links and arcs, solid on the left.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ring {
    /// The vertices in order; the last link leads back to the first vertex.
    pub vertices: Vec<Vertex>,
}

impl Ring {
    /// A ring of straight links through `points`, without identities.
    pub fn polygon(points: impl IntoIterator<Item = Point>) -> Ring {
        Ring { vertices: points.into_iter().map(Vertex::corner).collect() }
    }

    /// A whole circle of four arcs, counterclockwise.
    pub fn circle(center: Point, radius: f64) -> Ring {
        use super::{Arc, Turn};
        let link = Link::Arc(Arc { center, radius, turn: Turn::Left });
        let spokes = [Vector::x(), Vector::y(), -Vector::x(), -Vector::y()];
        Ring {
            vertices: spokes
                .map(|s| Vertex { point: center + s * radius, link, joint: Joint::Corner, id: None })
                .to_vec(),
        }
    }

    /// The number of vertices, which is the number of links.
    pub fn len(&self) -> usize {
        self.vertices.len()
    }

    /// Whether the ring has no vertex.
    pub fn is_empty(&self) -> bool {
        self.vertices.is_empty()
    }

    /// The element that leaves vertex `index`.
    #[inline]
    pub fn segment(&self, index: usize) -> Segment {
        let v = &self.vertices[index];
        let next = if index + 1 == self.vertices.len() { 0 } else { index + 1 };
        Segment { start: v.point, end: self.vertices[next].point, link: v.link }
    }

    /// All elements in order.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        (0..self.vertices.len()).map(|i| self.segment(i))
    }

    /// Signed area: positive for an outer ring, negative for a hole.
    pub fn area(&self) -> f64 {
        // Relative to the first vertex, so that a ring far from the origin keeps its digits.
        let Some(first) = self.vertices.first() else { return 0.0 };
        let origin = first.point.coords;
        let doubled: f64 = self.segments().map(|s| s.translated(-origin).doubled_area()).sum();
        0.5 * doubled
    }

    /// Total length.
    pub fn length(&self) -> f64 {
        self.segments().map(|s| s.length()).sum()
    }

    /// The smallest axis-parallel box that holds the ring.
    pub fn bounds(&self) -> Bounds {
        let mut bounds = Bounds::of_points(self.vertices.iter().map(|v| v.point));
        for (i, v) in self.vertices.iter().enumerate() {
            if v.link != Link::Line {
                bounds = bounds.union(self.segment(i).bounds());
            }
        }
        bounds
    }

    /// The same curve run the other way: solid and empty change places. Vertices keep their identities.
    pub fn reversed(&self) -> Ring {
        let n = self.vertices.len();
        let vertices = (0..n)
            .rev()
            .map(|i| {
                // The link that leaves vertex i in the reversed ring is the one that entered it.
                let link = self.vertices[(i + n - 1) % n].link.reversed();
                super::Vertex { link, ..self.vertices[i] }
            })
            .collect();
        Ring { vertices }
    }

    /// The ring moved by `by`.
    pub fn translated(&self, by: Vector) -> Ring {
        let vertices =
            self.vertices.iter().map(|v| super::Vertex { point: v.point + by, link: v.link.translated(by), ..*v });
        Ring { vertices: vertices.collect() }
    }

    /// The ring with every length multiplied by `factor`, above zero.
    pub fn scaled(&self, factor: f64) -> Ring {
        let vertices = self.vertices.iter().map(|v| super::Vertex {
            point: v.point * factor,
            link: match v.link {
                Link::Line => Link::Line,
                Link::Arc(a) => Link::Arc(super::Arc { center: a.center * factor, radius: a.radius * factor, ..a }),
            },
            ..*v
        });
        Ring { vertices: vertices.collect() }
    }

    /// How often the ring runs counterclockwise around `p`. Unspecified for a point on the ring itself.
    pub fn winding_number(&self, p: Point) -> i32 {
        self.segments().map(|s| s.ray_crossings(p)).sum()
    }

    /// The ring as a polygon whose chords stay within `tolerance` (a distance, positive) of it.
    pub fn flatten(&self, tolerance: f64) -> Vec<Point> {
        let mut points = Vec::with_capacity(self.len());
        for s in self.segments() {
            s.flatten(tolerance, |p| points.push(p));
        }
        // The last point emitted is the first vertex: bring it to the front.
        let shift = usize::from(!points.is_empty());
        points.rotate_right(shift);
        points
    }
}
