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

    /// The indices of the rings along a curve that fills the plane (Morton's), by the places where they start.
    ///
    /// In the order in which many small rings happen to come, the boxes of a tree over all of them would overlap.
    pub fn order_of_place(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.rings.len()).collect();
        // Two are near each other in any order.
        if order.len() > 2 {
            let start = |ring: &Ring| ring.vertices.first().map(|v| v.point);
            let bounds = Bounds::of_points(self.rings.iter().filter_map(start));
            order.sort_by_cached_key(|&k| start(&self.rings[k]).map(|p| place_along_curve(p, &bounds)));
        }
        order
    }

    /// The region with solid and empty exchanged: every ring reversed.
    pub fn reversed(&self) -> Region {
        Region { rings: self.rings.iter().map(Ring::reversed).collect() }
    }

    /// The region moved by `by`.
    pub fn translated(&self, by: Vector) -> Region {
        Region { rings: self.rings.iter().map(|r| r.translated(by)).collect() }
    }

    /// The region with every length multiplied by `factor`, above zero; by 1 exactly itself.
    pub fn scaled(&self, factor: f64) -> Region {
        Region { rings: self.rings.iter().map(|r| r.scaled(factor)).collect() }
    }

    /// Whether `p` lies in the solid; unspecified on the boundary itself. Linear in the number of vertices.
    pub fn contains(&self, p: Point) -> bool {
        self.rings.iter().map(|r| r.winding_number(p)).sum::<i32>() > 0
    }

    /// For each ring the index of the outer ring that it belongs to: its own for an outer ring, the smallest around it for a
    /// hole, and its own again where there is none. Boxes are compared for every pair of a hole and an outer ring, no more.
    pub fn owners(&self) -> Vec<usize> {
        let areas: Vec<f64> = self.rings.iter().map(Ring::area).collect();
        let outer: Vec<(usize, Bounds)> =
            (0..areas.len()).filter(|&k| areas[k] > 0.0).map(|k| (k, self.rings[k].bounds())).collect();
        let owner = |k: usize| {
            let Some(place) = self.rings[k].vertices.first().map(|v| v.point).filter(|_| areas[k] <= 0.0) else {
                return k;
            };
            let is_around = |(j, bounds): &&(usize, Bounds)| {
                areas[*j] >= -areas[k] && bounds.contains(place) && self.rings[*j].winding_number(place) != 0
            };
            let smallest = outer.iter().filter(is_around).min_by(|a, b| areas[a.0].total_cmp(&areas[b.0]));
            smallest.map_or(k, |(j, _)| *j)
        };
        (0..areas.len()).map(owner).collect()
    }

    /// Every connected piece with its holes.
    pub fn components(&self) -> Vec<Region> {
        let owners = self.owners();
        let mut pieces: Vec<(usize, Region)> = Vec::new();
        for (k, ring) in self.rings.iter().enumerate().filter(|(_, ring)| ring.area() > 0.0) {
            pieces.push((k, Region::new(vec![ring.clone()])));
        }
        for (k, ring) in self.rings.iter().enumerate().filter(|(k, _)| owners[*k] != *k) {
            if let Ok(piece) = pieces.binary_search_by_key(&owners[k], |(j, _)| *j) {
                pieces[piece].1.rings.push(ring.clone());
            }
        }
        pieces.into_iter().map(|(_, piece)| piece).collect()
    }

    /// Outer rings and holes, told apart by the sign of their area.
    pub fn topology(&self) -> TopologyCount {
        let components = self.rings.iter().filter(|r| r.area() > 0.0).count();
        TopologyCount { components, holes: self.rings.len() - components }
    }
}

/// The number of the cell of `p` when `bounds` are quartered sixteen times, along a curve that fills the plane (Morton's).
pub fn place_along_curve(p: Point, bounds: &Bounds) -> u32 {
    const CELLS: f64 = 65_536.0;
    // The cast saturates, and takes what is no number, as in a box without extent, for zero.
    let cell = |x: f64, min: f64, max: f64| ((x - min) / (max - min) * CELLS) as u16;
    let (x, y) = (cell(p.x, bounds.min.x, bounds.max.x), cell(p.y, bounds.min.y, bounds.max.y));
    let bit_of = |cell: u16, bit: u32| u32::from(cell >> bit & 1);
    (0..16).fold(0, |key, bit| key | bit_of(x, bit) << (2 * bit) | bit_of(y, bit) << (2 * bit + 1))
}
