//! A set of the plane, bounded by rings.

use super::{Bounds, Point, Ring, Segment, Vector};

/// A solid set of the plane: outer rings counterclockwise, holes clockwise, no crossings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Region {
    /// The boundary, in no particular order.
    pub rings: Vec<Ring>,
}

/// How many pieces and how many holes a region has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct TopologyCount {
    /// Outer rings.
    pub components: usize,
    /// Inner rings.
    pub holes: usize,
}

impl Region {
    /// A region bounded by `rings`.
    pub fn new(rings: Vec<Ring>) -> Region {
        Region { rings }
    }

    /// Whether there is no boundary at all.
    pub fn is_empty(&self) -> bool {
        self.rings.iter().all(Ring::is_empty)
    }

    /// The number of vertices of all rings.
    pub fn vertex_count(&self) -> usize {
        self.rings.iter().map(Ring::len).sum()
    }

    /// All boundary elements.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        self.rings.iter().flat_map(Ring::segments)
    }

    /// Area of the solid.
    pub fn area(&self) -> f64 {
        self.rings.iter().map(Ring::area).sum()
    }

    /// Length of the boundary.
    pub fn perimeter(&self) -> f64 {
        self.rings.iter().map(Ring::length).sum()
    }

    /// The smallest axis-parallel box that holds the region.
    pub fn bounds(&self) -> Bounds {
        self.rings.iter().fold(Bounds::EMPTY, |b, r| b.union(r.bounds()))
    }

    /// The region with solid and empty exchanged: every ring reversed.
    pub fn reversed(&self) -> Region {
        Region { rings: self.rings.iter().map(Ring::reversed).collect() }
    }

    /// The region moved by `by`.
    pub fn translated(&self, by: Vector) -> Region {
        Region { rings: self.rings.iter().map(|r| r.translated(by)).collect() }
    }

    /// Whether `p` lies in the solid; unspecified on the boundary itself. Linear in the number of vertices.
    pub fn contains(&self, p: Point) -> bool {
        self.rings.iter().map(|r| r.winding_number(p)).sum::<i32>() > 0
    }

    /// Outer rings and holes, told apart by the sign of their area.
    pub fn topology(&self) -> TopologyCount {
        let components = self.rings.iter().filter(|r| r.area() > 0.0).count();
        TopologyCount { components, holes: self.rings.len() - components }
    }
}
