//! Where an element may stand in the drawing: every chain of exact transforms from it to the root.
//!
//! usvg says where each element is, in single precision. The file says it with all digits, but an element that is
//! referred to by `use` stands in several places. So all places are computed, and the one that agrees with usvg's is it.

use std::str::FromStr;

use svgtypes::{Align, AspectRatio};
use usvg::roxmltree::{Node, NodeId};

use super::affine::Affine;
use super::document::Source;
use super::shape::{attribute, to_pixels};

/// At most so many places are computed of one element; those beyond are taken from usvg in single precision.
const MAX_PLACES: usize = 4096;

/// At most so many references lead from an element to the root: circular ones end here.
const MAX_DEPTH: usize = 256;

/// One of the places of an element.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Placement {
    /// From the element's coordinates to those of the root (or of the clip path that it belongs to).
    pub affine: Affine,
    /// The `use` elements on the way to the root, the innermost first.
    pub uses: Vec<NodeId>,
}

/// All places of `node`.
pub(super) fn placements(source: &Source, node: Node) -> Vec<Placement> {
    let mut climber = Climber { source, uses: Vec::new(), found: Vec::new() };
    climber.climb(node, Affine::IDENTITY, 0);
    climber.found
}

struct Climber<'s, 'a, 'input> {
    source: &'s Source<'a, 'input>,
    uses: Vec<NodeId>,
    found: Vec<Placement>,
}

impl<'a, 'input> Climber<'_, 'a, 'input> {
    fn add(&mut self, affine: Affine) {
        self.found.push(Placement { affine, uses: self.uses.clone() });
    }

    /// `inside` maps the element's coordinates to those that hold within `node`, before its own transform.
    fn climb(&mut self, node: Node<'a, 'input>, inside: Affine, depth: usize) {
        let source = self.source;
        if self.found.len() >= MAX_PLACES || depth > MAX_DEPTH {
            return;
        }
        let name = node.tag_name().name();
        let is_root = node == source.document.root_element();
        if is_root {
            self.add(inside);
            return;
        }
        let Some(own) = transform(node) else { return };
        if name == "clipPath" {
            self.add(own.then_inner(&inside));
            return;
        }
        if name != "symbol"
            && let Some(parent) = node.parent_element()
        {
            let inside = if name == "svg" { viewport(node, node).map(|v| v.then_inner(&inside)) } else { Some(inside) };
            if let Some(inside) = inside {
                self.climb(parent, own.then_inner(&inside), depth + 1);
            }
        }
        for user in source.uses(node) {
            let offset =
                || Some(Affine::translation(length(user, "x")?.unwrap_or(0.0), length(user, "y")?.unwrap_or(0.0)));
            let Some(offset) = offset() else { continue };
            let within = match name {
                "symbol" => viewbox(user, node).map(|v| v.then_inner(&inside)),
                // The size may be given by the reference or by what it refers to.
                "svg" => viewport(node, if has_size(user) { user } else { node }).map(|v| v.then_inner(&inside)),
                _ => Some(inside),
            };
            if let Some(within) = within {
                let own = if name == "symbol" { Affine::IDENTITY } else { own };
                self.uses.push(user.id());
                self.climb(user, offset.then_inner(&own.then_inner(&within)), depth + 1);
                self.uses.pop();
            }
        }
    }
}

/// The element's own transform; `None` where it cannot be told from its attributes.
pub(super) fn transform(node: Node) -> Option<Affine> {
    if attribute(node, "transform-origin").is_some() {
        return None;
    }
    let name =
        if node.tag_name().name() == "clipPath" { node.attribute("transform") } else { attribute(node, "transform") };
    match name {
        None => Some(Affine::IDENTITY),
        Some(text) => svgtypes::Transform::from_str(text).ok().map(Affine::from).filter(Affine::is_finite),
    }
}

fn has_size(node: Node) -> bool {
    node.attribute("width").is_some() || node.attribute("height").is_some()
}

/// A length attribute: inner `None` where absent, outer where it needs context.
fn length(node: Node, name: &str) -> Option<Option<f64>> {
    match attribute(node, name).map(svgtypes::Length::from_str) {
        None | Some(Err(_)) => Some(None),
        Some(Ok(length)) => to_pixels(length).map(Some),
    }
}

/// From the coordinates within a nested `svg` to those around it, its size taken from `sized`.
fn viewport(svg: Node, sized: Node) -> Option<Affine> {
    let offset = Affine::translation(length(svg, "x")?.unwrap_or(0.0), length(svg, "y")?.unwrap_or(0.0));
    Some(offset.then_inner(&viewbox(sized, svg)?))
}

/// The map from `viewed`'s view box, if it has one, to the size that `sized` gives.
fn viewbox(sized: Node, viewed: Node) -> Option<Affine> {
    let Some(text) = viewed.attribute("viewBox") else { return Some(Affine::IDENTITY) };
    let view = svgtypes::ViewBox::from_str(text).ok()?;
    let either = |name| match length(sized, name)? {
        None if sized != viewed => length(viewed, name)?,
        given => given,
    };
    let (width, height) = (either("width")?, either("height")?);
    let aspect = viewed.attribute("preserveAspectRatio").and_then(|t| AspectRatio::from_str(t).ok());
    Some(fit(view, width, height, aspect.unwrap_or_default()))
}

/// The map of a view box into a viewport of the given size (SVG 2, 8.2).
pub(super) fn fit(view: svgtypes::ViewBox, width: f64, height: f64, aspect: AspectRatio) -> Affine {
    let (mut sx, mut sy) = (width / view.w, height / view.h);
    if aspect.align != Align::None {
        let s = if aspect.slice { sx.max(sy) } else { sx.min(sy) };
        (sx, sy) = (s, s);
    }
    let (spare_x, spare_y) = (width - view.w * sx, height - view.h * sy);
    let (x, y) = match aspect.align {
        Align::None | Align::XMinYMin => (0.0, 0.0),
        Align::XMidYMin => (0.5, 0.0),
        Align::XMaxYMin => (1.0, 0.0),
        Align::XMinYMid => (0.0, 0.5),
        Align::XMidYMid => (0.5, 0.5),
        Align::XMaxYMid => (1.0, 0.5),
        Align::XMinYMax => (0.0, 1.0),
        Align::XMidYMax => (0.5, 1.0),
        Align::XMaxYMax => (1.0, 1.0),
    };
    Affine { a: sx, b: 0.0, c: 0.0, d: sy, e: x * spare_x - view.x * sx, f: y * spare_y - view.y * sy }
}
