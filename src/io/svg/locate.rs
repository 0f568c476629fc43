//! Where usvg's shapes and groups stand in the file: usvg knows all numbers roughly, the file has their digits.

use std::collections::HashMap;
use std::rc::Rc;

use usvg::roxmltree::{Node, NodeId};

use super::affine::Affine;
use super::document::Source;
use super::outline::Outline;
use super::placement::{Placement, placements};
use super::rough::{looks_like, single_precision};
use super::shape::{self, Shape, attribute};

/// Finds elements and their exact maps.
pub(super) struct Locator<'a, 'input> {
    source: &'a Source<'a, 'input>,
    shapes: HashMap<NodeId, Option<Rc<Shape>>>,
    placements: HashMap<NodeId, Rc<Vec<Placement>>>,
    /// The exact maps of elements that can have a clip path.
    clipped: Option<Rc<Vec<Affine>>>,
    reusable: Option<Rc<Vec<Node<'a, 'input>>>>,
}

/// The element that a path of usvg stands for.
pub(super) struct Located<'a, 'input> {
    pub node: Node<'a, 'input>,
    /// The references that show it, the innermost first.
    pub uses: Vec<NodeId>,
    pub outline: Rc<Outline>,
    pub affine: Affine,
    /// Whether outline and map are those of the file.
    pub exact: bool,
    pub cut_at: Option<usize>,
}

impl<'a, 'input> Locator<'a, 'input> {
    pub fn new(source: &'a Source<'a, 'input>) -> Locator<'a, 'input> {
        Locator { source, shapes: HashMap::new(), placements: HashMap::new(), clipped: None, reusable: None }
    }

    /// All exact places of the element: one, or one for each `use`.
    pub fn placements(&mut self, node: Node<'a, 'input>) -> Rc<Vec<Placement>> {
        let source = self.source;
        self.placements.entry(node.id()).or_insert_with(|| Rc::new(placements(source, node))).clone()
    }

    /// The exact map of a group that usvg knows roughly; the rough one where there is none.
    pub fn exact_group(&mut self, rough: &Affine) -> Affine {
        if *rough == Affine::IDENTITY {
            return *rough;
        }
        let candidates = match &self.clipped {
            Some(candidates) => candidates.clone(),
            None => {
                let can_clip =
                    |n: &Node| matches!(n.tag_name().name(), "use" | "svg") || attribute(*n, "clip-path").is_some();
                let nodes = self.source.document.descendants().filter(|n| n.is_element()).filter(can_clip);
                /// A drawing with more clipped groups than this gets the rough maps.
                const MAX_GROUPS: usize = 4096;
                let places = nodes.take(MAX_GROUPS).flat_map(|n| placements(self.source, n)).take(MAX_GROUPS);
                let all: Rc<Vec<Affine>> = Rc::new(places.map(|p| p.affine).collect());
                self.clipped = Some(all.clone());
                all
            }
        };
        best(candidates.iter(), rough).map_or(*rough, |(k, _)| candidates[k])
    }

    /// The shapes that `use` can bring in.
    fn reusable(&mut self) -> Rc<Vec<Node<'a, 'input>>> {
        let source = self.source;
        let find = || {
            let shapes = source.document.descendants().filter(|n| shape::SHAPES.contains(&n.tag_name().name()));
            Rc::new(shapes.filter(|n| n.ancestors().any(|a| source.uses(a).next().is_some())).collect())
        };
        self.reusable.get_or_insert_with(find).clone()
    }

    fn shape(&mut self, node: Node) -> Option<Rc<Shape>> {
        self.shapes.entry(node.id()).or_insert_with(|| shape::read(node).map(Rc::new)).clone()
    }

    /// The element that `path` stands for, read from the file.
    pub fn locate(&mut self, path: &usvg::Path, rough: &Affine) -> Option<Located<'a, 'input>> {
        let source = self.source;
        let named = source.elements(path.id()).filter(|n| shape::SHAPES.contains(&n.tag_name().name()));
        let mut nodes: Vec<Node> = named.collect();
        // usvg takes the names away from what `use` brings in; and a name may be given twice: then the first that looks
        // right and stands at the right place.
        if path.id().is_empty() {
            nodes = self.reusable().to_vec();
        }
        if nodes.len() > 1 || path.id().is_empty() {
            nodes.retain(|node| self.shape(*node).is_none_or(|s| looks_like(&s.outline, path.data())));
        }
        let mut chosen: Option<(Node, Placement, f64)> = None;
        for node in &nodes {
            let places = self.placements(*node);
            if let Some((k, mismatch)) = best(places.iter().map(|p| &p.affine), rough)
                && chosen.as_ref().is_none_or(|c| mismatch < c.2)
            {
                chosen = Some((*node, places[k].clone(), mismatch));
            }
        }
        let node = chosen.as_ref().map(|c| c.0).or_else(|| source.elements(path.id()).next())?;
        let shape = self.shape(node);
        let is_round = matches!(node.tag_name().name(), "circle" | "ellipse");
        let exact = shape.is_some() && chosen.is_some();
        let cut_at = shape.as_ref().and_then(|s| s.cut_at);
        let outline = match shape {
            Some(shape) => shape.outline.clone(),
            None => Rc::new(single_precision(path.data(), is_round)),
        };
        let place = chosen.map_or(Placement { affine: *rough, uses: Vec::new() }, |c| c.1);
        Some(Located { node, uses: place.uses, outline, affine: place.affine, exact, cut_at })
    }
}

/// Which of the exact maps agrees best with the rough one, and how well; `None` where none agrees.
pub(super) fn best<'m>(candidates: impl Iterator<Item = &'m Affine>, rough: &Affine) -> Option<(usize, f64)> {
    let rated = candidates.map(|c| c.mismatch(rough)).enumerate().filter(|c| c.1 <= 1.0);
    rated.reduce(|a, b| if b.1 < a.1 { b } else { a })
}
