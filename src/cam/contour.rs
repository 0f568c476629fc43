//! One closed cut: a path with the places where the tool may enter.

use crate::plane::{Joint, Point, Ring, Segment};

use super::entry::{self, EntryPlace};

/// Paths shorter than this, in millimetres, are places to drill: their loop is smaller than the last decimal written.
const SHORTEST_LOOP: f64 = 1e-4;

/// A closed cut, in the direction in which the tool travels it.
#[derive(Clone, Debug)]
pub struct Contour {
    /// The path; a single vertex is a place to drill.
    pub path: Ring,
    /// Where the tool may enter, best first; never empty.
    pub entries: Vec<EntryPlace>,
}

impl Contour {
    /// The contour of a path that has the part on its left, travelled as it is or backwards.
    pub(super) fn new(path: Ring, backwards: bool) -> Option<Contour> {
        let path = if path.len() > 1 && path.length() < SHORTEST_LOOP {
            Ring { vertices: path.vertices[..1].to_vec() }
        } else {
            path
        };
        let entries = entry::places(&path)?;
        if !backwards || path.len() < 2 {
            return Some(Contour { path, entries });
        }
        let n = path.len();
        // Element i of the path is element n - 2 - i of the reversed path, cyclically.
        let turned = |e: EntryPlace| EntryPlace { element: (2 * n - 2 - e.element) % n, ..e };
        Some(Contour { entries: entries.into_iter().map(turned).collect(), path: path.reversed() })
    }

    /// Whether there is nothing to travel along.
    pub fn is_point(&self) -> bool {
        self.path.len() < 2
    }

    /// The elements from an entry around to it again; none for a place to drill.
    pub(super) fn around_from(&self, entry: &EntryPlace) -> Vec<Segment> {
        if self.is_point() {
            return Vec::new();
        }
        let n = self.path.len();
        let cut = self.path.segment(entry.element);
        let parts = std::iter::once(Segment { start: entry.point, ..cut })
            .chain((1..n).map(|k| self.path.segment((entry.element + k) % n)))
            .chain([Segment { end: entry.point, ..cut }]);
        parts.filter(|s| s.start != s.end).collect()
    }

    /// The place of the path that is nearest to `here`; none of a place to drill.
    pub(super) fn nearest_entry(&self, here: Point) -> Option<EntryPlace> {
        if self.is_point() {
            return None;
        }
        let near = self.path.segments().enumerate().map(|(element, s)| (element, s.nearest(here)));
        let (element, nearest) = near.min_by(|a, b| a.1.distance.total_cmp(&b.1.distance))?;
        Some(EntryPlace { element, point: nearest.point })
    }

    /// Whether the two rings are nested so, judged at one point of `inner`. Rings must not cross.
    pub(super) fn encloses(&self, inner: &Contour) -> bool {
        let Some(vertex) = inner.path.vertices.first() else { return false };
        !self.is_point() && self.path.winding_number(vertex.point) != 0
    }

    /// The enclosed area, whichever way it is travelled.
    pub(super) fn area(&self) -> f64 {
        self.path.area().abs()
    }

    /// The path moved so that everything lies `by` further.
    pub(super) fn translated(mut self, by: crate::plane::Vector) -> Contour {
        let n = self.path.len();
        for i in 0..n {
            let moved = self.path.segment(i).translated(by);
            self.path.vertices[i].link = moved.link;
        }
        self.path.vertices.iter_mut().for_each(|v| (v.point, v.joint) = (v.point + by, Joint::Corner));
        self.entries.iter_mut().for_each(|e| e.point += by);
        self
    }
}

/// The point in the middle of an element.
pub(super) fn middle(segment: &Segment) -> Point {
    segment.point_at(0.5)
}
