//! Radii that elements of a drawing ask for themselves.

use std::collections::HashMap;

use anyhow::{Context as _, Result};

use super::field::resolve_radius;
use crate::io::svg::{Parts, Place, RADIUS_ATTRIBUTE};
use crate::plane::{BoundaryIndex, Point, Region, VertexId};
use crate::units::{Length, Radius};

/// The radii of the elements that ask for one.
pub(super) struct OwnRadii {
    /// By the number of the vertex.
    of_vertices: Vec<Option<Radius>>,
    /// The outline with the radius of each of its edges, where it has vertices of no element: outlines of two cross there.
    of_edges: Option<(BoundaryIndex, Vec<Option<Radius>>)>,
    range: [Radius; 2],
    /// An element that asks for none.
    without: Option<Place>,
}

impl OwnRadii {
    /// The radii that the elements of what is chosen ask for; none where no element does.
    ///
    /// # Errors
    /// Names the element whose radius means nothing.
    pub(super) fn read(parts: &Parts) -> Result<Option<OwnRadii>> {
        let drawing = parts.chosen();
        let sources = &drawing.sources;
        let (scale, diagonal) = (parts.scale(), parts.bounds().diagonal());
        let mut known: HashMap<&str, Radius> = HashMap::new();
        let mut of_vertices = vec![None; sources.vertices.len()];
        let mut range: Option<[Radius; 2]> = None;
        let mut without = None;
        for id in drawing.region.rings.iter().flat_map(|r| &r.vertices).filter_map(|v| v.id) {
            let Some(text) = sources.radius(id) else {
                without = without.or_else(|| sources.place(id));
                continue;
            };
            let radius = match known.get(text) {
                Some(radius) => *radius,
                None => {
                    let place = sources.place(id).map_or_else(String::new, |place| format!(" of {place}"));
                    let name = format!("{RADIUS_ATTRIBUTE}{place}");
                    let length: Length = text.parse().with_context(|| name.clone())?;
                    resolve_radius(length, &name, &scale, diagonal)?
                }
            };
            known.insert(text, radius);
            range = Some(range.map_or([radius; 2], |[low, high]| {
                [if radius < low { radius } else { low }, if radius > high { radius } else { high }]
            }));
            if let Some(of_vertex) = of_vertices.get_mut(id.index()) {
                *of_vertex = Some(radius);
            }
        }
        let Some(range) = range else { return Ok(None) };
        // Whoever consists of crossings alone has the smallest radius, unless there is one for the rest.
        let otherwise = if without.is_none() { Some(range[0]) } else { None };
        let of_edges = edges(&drawing.region, &of_vertices, otherwise);
        Ok(Some(OwnRadii { of_vertices, of_edges, range, without: without.cloned() }))
    }

    /// The radius that is asked for at `p`, by the vertex there or the one whose edge leads there.
    pub(super) fn at(&self, p: Point, vertex: Option<VertexId>) -> Option<Radius> {
        match vertex {
            Some(id) => self.of_vertices.get(id.index()).copied().flatten(),
            None => {
                let (outline, radii) = self.of_edges.as_ref()?;
                radii.get(outline.nearest(p)?.0).copied().flatten()
            }
        }
    }

    /// The smallest and the largest.
    pub(super) fn range(&self) -> [Radius; 2] {
        self.range
    }

    /// An element that asks for no radius, if there is one.
    pub(super) fn without(&self) -> Option<&Place> {
        self.without.as_ref()
    }
}

/// The radii of all edges; none where every vertex knows its own.
fn edges(
    region: &Region,
    of_vertices: &[Option<Radius>],
    otherwise: Option<Radius>,
) -> Option<(BoundaryIndex, Vec<Option<Radius>>)> {
    if region.rings.iter().flat_map(|r| &r.vertices).all(|v| v.id.is_some()) {
        return None;
    }
    let (mut segments, mut radii) = (Vec::new(), Vec::new());
    for ring in &region.rings {
        let first = radii.len();
        let n = ring.len();
        // The edge that leaves a crossing is of the element whose vertex it leads to: from the end, once around and again.
        let mut next = otherwise;
        for k in (0..2 * n).rev() {
            if let Some(id) = ring.vertices[k % n].id {
                next = of_vertices.get(id.index()).copied().flatten();
            }
            if k >= n {
                continue;
            }
            radii.push(next);
        }
        radii[first..].reverse();
        segments.extend((0..n).map(|k| ring.segment(k)));
    }
    Some((BoundaryIndex::of_segments(segments), radii))
}
