//! The offset curves of the elements and corners of a boundary, at distance 1.

use super::Side;
use crate::plane::{Arc, Link, Point, Region, Segment, Turn, Vector, left_normal, right_normal, turn_angle};

/// A part of a boundary that a point can be nearest to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Feature {
    /// The inside of the element of this number.
    Element(usize),
    /// The vertex where the element of this number starts.
    Corner(usize),
}

/// Below this radius an offset arc is a point: the rounding of an arc of radius 1 offset by 1, with room.
pub(super) const POINT_RADIUS: f64 = 1e-9;

/// The elements of a region in order, with their neighbours.
pub(super) struct Features {
    pub(super) elements: Vec<Segment>,
    previous: Vec<usize>,
    next: Vec<usize>,
    side: Side,
}

impl Features {
    pub(super) fn new(region: &Region, side: Side) -> Features {
        let mut elements = Vec::with_capacity(region.vertex_count());
        let mut previous = Vec::with_capacity(region.vertex_count());
        let mut next = Vec::with_capacity(region.vertex_count());
        for ring in &region.rings {
            let (first, n) = (elements.len(), ring.len());
            elements.extend(ring.segments());
            previous.extend((0..n).map(|i| first + (i + n - 1) % n));
            next.extend((0..n).map(|i| first + (i + 1) % n));
        }
        Features { elements, previous, next, side }
    }

    /// The element after element `i` on its ring.
    pub(super) fn next(&self, i: usize) -> usize {
        self.next[i]
    }

    /// The unit normal towards the side of the offset, for a direction of travel.
    pub(super) fn normal(&self, tangent: Vector) -> Vector {
        match self.side {
            Side::Outward => right_normal(tangent),
            Side::Inward => left_normal(tangent),
        }
    }

    /// The radius of the offset of an arc; negative where the arc is narrower than the disk.
    pub(super) fn offset_radius(&self, arc: &Arc) -> f64 {
        let grows = (arc.turn == Turn::Left) == (self.side == Side::Outward);
        if grows { arc.radius + 1.0 } else { arc.radius - 1.0 }
    }

    /// Where the offset of element `i` starts.
    pub(super) fn offset_start(&self, i: usize) -> Point {
        let s = &self.elements[i];
        s.start + self.normal(s.start_tangent())
    }

    /// Where the offset of element `i` ends.
    pub(super) fn offset_end(&self, i: usize) -> Point {
        let s = &self.elements[i];
        s.end + self.normal(s.end_tangent())
    }

    /// The offset curve of element `i`: an arc whose offset has shrunk to a point gives a segment of no length; `None`
    /// where the disk does not fit into the arc.
    pub(super) fn element_curve(&self, i: usize) -> Option<Segment> {
        let link = match self.elements[i].link {
            Link::Line => Link::Line,
            Link::Arc(arc) => {
                let radius = self.offset_radius(&arc);
                if radius < -POINT_RADIUS {
                    return None;
                }
                if radius <= POINT_RADIUS {
                    return Some(Segment::line(arc.center, arc.center));
                }
                Link::Arc(Arc { radius, ..arc })
            }
        };
        Some(Segment { start: self.offset_start(i), end: self.offset_end(i), link })
    }

    /// The angle in radians by which the offset turns about the vertex before element `i`; positive where it has an arc
    /// there, as at convex corners when growing.
    pub(super) fn corner_angle(&self, i: usize) -> f64 {
        let angle = turn_angle(self.elements[self.previous[i]].end_tangent(), self.elements[i].start_tangent());
        match self.side {
            Side::Outward => angle,
            Side::Inward if angle == std::f64::consts::PI => angle,
            Side::Inward => -angle,
        }
    }

    /// The offset curve about the vertex before element `i`; `None` where the offsets of its two elements cross.
    pub(super) fn corner_curve(&self, i: usize) -> Option<Segment> {
        let turn = match self.side {
            Side::Outward => Turn::Left,
            Side::Inward => Turn::Right,
        };
        let (start, end) = (self.offset_end(self.previous[i]), self.offset_start(i));
        let center = self.elements[i].start;
        (self.corner_angle(i) > 0.0 && start != end)
            .then_some(Segment { start, end, link: Link::Arc(Arc { center, radius: 1.0, turn }) })
            // Two directions that are equal but for rounding may look like a whole turn.
            .filter(|s| s.sweep() < 1.5 * std::f64::consts::PI)
    }

    /// The offset curve of a feature.
    pub(super) fn curve(&self, feature: Feature) -> Option<Segment> {
        match feature {
            Feature::Element(i) => self.element_curve(i),
            Feature::Corner(i) => self.corner_curve(i),
        }
    }

    /// All offset curves.
    pub(super) fn curves(&self) -> impl Iterator<Item = Segment> + '_ {
        (0..self.elements.len()).flat_map(|i| [self.corner_curve(i), self.element_curve(i)]).flatten()
    }
}
