//! The area of one element, whatever the file does with it.

use usvg::roxmltree::Node;

use super::collect::Instance;
use super::drawing::Sources;
use super::error::ReadError;
use super::gather::gather;
use super::options::{Curves, ReadOptions};
use super::placement::placements;
use super::sample::{self, Meetings, Sampling};
use super::selection::known;
use super::shape::{self, SHAPES};
use crate::io::unite::{self, Rule};
use crate::plane::{Region, Ring};

/// The area inside of an element, by its `id`: that of a shape, or of a group or a `use`, which stands for everything
/// below it. In user units of the root, y up, as [`read`](super::read) gives a drawing; its vertices have no identity.
///
/// Paint does not matter: a shape that is not filled, or in a hidden layer, or in `defs`, is taken as well, inside of its
/// outline (as the nonzero rule has it). So a file can name places without drawing them. Clip paths are not applied, and
/// text has no outline.
///
/// # Errors
/// Where the file cannot be read, has no such `id` (then the nearest one is named), or has no outline below it.
pub fn read_area(bytes: &[u8], options: &ReadOptions, id: &str) -> Result<Region, ReadError> {
    gather(bytes, options, None, |gathered| {
        let source = gathered.source;
        known(source, id)?;
        let mut shown = Vec::new();
        let mut stored = Vec::new();
        for node in source.document.descendants().filter(|n| SHAPES.contains(&n.tag_name().name())) {
            for place in placements(source, node) {
                let around = source.around(&Instance { node: node.id(), uses: place.uses });
                let is_inside = around.iter().any(|n| n.attribute("id") == Some(id));
                let Some(shape) = is_inside.then(|| shape::read(node)).flatten() else { continue };
                // What defs hold is where references show it, and where it stands only if none does.
                let is_stored = around.iter().any(|n: &Node| n.tag_name().name() == "defs");
                let affine = gathered.outer.then_inner(&place.affine);
                if is_stored { &mut stored } else { &mut shown }.push((shape.outline, affine));
            }
        }
        let outlines = if shown.is_empty() { stored } else { shown };
        let extents = outlines.iter().map(|(outline, affine)| outline.bounds(affine));
        let tolerance = options.flatten * extents.map(|b| b.width().max(b.height())).fold(0.0, f64::max);
        let mut rings: Vec<Ring> = Vec::new();
        if tolerance > 0.0 {
            let sampling = Sampling { tolerance, curves: Curves::Arcs, meetings: Meetings::Curves, known: None };
            let mut sources = Sources::default();
            for (outline, affine) in &outlines {
                let drawn = sample::rings(outline, affine, sampling, 0, &mut sources);
                rings.extend(unite::resolve(drawn, Rule::NonZero));
            }
            rings = unite::resolve(rings, Rule::AtLeast(1));
        }
        for vertex in rings.iter_mut().flat_map(|r| &mut r.vertices) {
            vertex.id = None;
        }
        let region = Region::new(rings);
        if region.is_empty() { Err(ReadError::NoArea { id: id.to_owned() }) } else { Ok(region) }
    })
}
