//! From usvg's tree to the list of what is filled, with the digits of the file.
//!
//! usvg decides what is drawn: styles, references, visibility, fill rules, text. Its numbers are `f32`, so each shape is
//! looked up in the file by its `id` and read again; usvg's transform tells which of the places of the element is meant.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use usvg::roxmltree::{Node, NodeId};

use super::affine::Affine;
use super::document::Source;
use super::error::{Found, MAX_COORDINATE, Place, ReadError, Warning, WarningKind};
use super::locate::{Locator, best};
use super::options::Strokes;
use super::outline::Outline;
use super::placement::Placement;
use super::rough::single_precision;
use super::stroke;

/// An area to be filled.
#[derive(Clone, Debug)]
pub(super) struct Item {
    /// Index in [`Collection::elements`].
    pub element: u32,
    pub outline: Rc<Outline>,
    /// From the outline to the root.
    pub affine: Affine,
    pub rule: usvg::FillRule,
    /// Indices in [`Collection::clips`]: what the area is cut down to.
    pub clips: Vec<usize>,
}

/// A line to be followed.
#[derive(Clone, Debug)]
pub(super) struct Stroked {
    /// Index in [`Collection::elements`].
    pub element: u32,
    pub outline: Rc<Outline>,
    /// From the outline to the root.
    pub affine: Affine,
}

/// What an element is painted with: red, green and blue.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Colors {
    pub fill: Option<[u8; 3]>,
    pub stroke: Option<[u8; 3]>,
}

/// A clip path at one of its places: the union of `items`, cut down to `clips`.
#[derive(Clone, Debug, Default)]
pub(super) struct Clip {
    pub items: Vec<Item>,
    pub clips: Vec<usize>,
}

/// An element at one of its places.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Instance {
    pub node: NodeId,
    /// The `use` elements that show it, the innermost first.
    pub uses: Vec<NodeId>,
}

/// All that a drawing fills.
#[derive(Debug, Default)]
pub(super) struct Collection {
    pub items: Vec<Item>,
    /// Only where strokes are lines.
    pub lines: Vec<Stroked>,
    pub colors: HashMap<u32, Colors>,
    pub clips: Vec<Clip>,
    pub elements: Vec<Place>,
    /// Where each of the elements stands in the document.
    pub instances: Vec<Instance>,
    pub warnings: Vec<Warning>,
    pub found: Found,
    /// The ids that usvg's tree has.
    pub seen: HashSet<String>,
}

pub(super) struct Collector<'a, 'input> {
    source: &'a Source<'a, 'input>,
    strokes: Strokes,
    collection: Collection,
    locator: Locator<'a, 'input>,
    elements: HashMap<Instance, u32>,
    /// Elements with a stroke beside their fill that is not taken.
    fill_alone: HashSet<NodeId>,
    warned: HashSet<(NodeId, std::mem::Discriminant<WarningKind>)>,
    /// How many dashes the strokes have so far.
    dashes: f64,
}

/// Where the walk is.
#[derive(Clone, Copy, Debug)]
struct Context<'c> {
    kind: Kind,
    /// From where `rough` leads to the root.
    outer: Affine,
    /// usvg's transform, as a product in `f64`.
    rough: Affine,
    clips: &'c [usize],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Drawing,
    Clip,
    /// Glyphs of the text with this element number: usvg's outlines are all there is.
    Text(u32),
}

impl<'a, 'input> Collector<'a, 'input> {
    pub fn new(source: &'a Source<'a, 'input>, strokes: Strokes) -> Collector<'a, 'input> {
        Collector {
            source,
            strokes,
            collection: Collection::default(),
            locator: Locator::new(source),
            elements: HashMap::new(),
            fill_alone: HashSet::new(),
            warned: HashSet::new(),
            dashes: 0.0,
        }
    }

    /// Everything below `root`, whose coordinates `outer` maps to the drawing's.
    pub fn collect(mut self, root: &usvg::Group, outer: Affine) -> Result<Collection, ReadError> {
        let context = Context { kind: Kind::Drawing, outer, rough: Affine::IDENTITY, clips: &[] };
        let mut items = Vec::new();
        self.children(root, context, &mut items)?;
        self.collection.items = items;
        if !self.fill_alone.is_empty() {
            let shapes = self.fill_alone.len();
            self.warn(self.source.document.root_element(), WarningKind::StrokeBesideFill { shapes });
        }
        Ok(self.collection)
    }

    fn children(&mut self, group: &usvg::Group, context: Context, items: &mut Vec<Item>) -> Result<(), ReadError> {
        for child in group.children() {
            match child {
                usvg::Node::Group(group) => self.group(group, context, items)?,
                usvg::Node::Path(path) => self.path(path, context, items)?,
                usvg::Node::Text(text) => self.text(text, context, items)?,
                // Images are not loaded; the file itself is asked for them.
                usvg::Node::Image(_) => {}
            }
        }
        Ok(())
    }

    fn group(&mut self, group: &usvg::Group, context: Context, items: &mut Vec<Item>) -> Result<(), ReadError> {
        let rough = context.rough.then_inner(&group.transform().into());
        if !rough.is_finite() {
            return Ok(());
        }
        for (applies, kind) in
            [(group.mask().is_some(), WarningKind::Mask), (!group.filters().is_empty(), WarningKind::Filter)]
        {
            if applies && let Some(node) = self.first_element(group) {
                self.warn(node, kind);
            }
        }
        let mut clips = context.clips.to_vec();
        if let Some(clip) = group.clip_path() {
            let outer = context.outer.then_inner(&self.locator.exact_group(&rough));
            clips.push(self.clip(clip, outer)?);
        }
        if group.opacity().get() > 0.0 {
            self.children(group, Context { rough, clips: &clips, ..context }, items)?;
        } else {
            self.mark_seen(group);
        }
        Ok(())
    }

    fn mark_seen(&mut self, group: &usvg::Group) {
        for child in group.children() {
            if let usvg::Node::Group(group) = child {
                self.mark_seen(group);
            }
            self.collection.found.hidden += usize::from(!matches!(child, usvg::Node::Group(_)));
            self.collection.seen.insert(child.id().to_owned());
        }
    }

    /// A clip path used where `outer` leads to the root; its index.
    fn clip(&mut self, clip: &usvg::ClipPath, outer: Affine) -> Result<usize, ReadError> {
        let mut clips = Vec::new();
        if let Some(nested) = clip.clip_path() {
            clips.push(self.clip(nested, outer)?);
        }
        let rough = clip.transform().into();
        let mut items = Vec::new();
        self.children(clip.root(), Context { kind: Kind::Clip, outer, rough, clips: &[] }, &mut items)?;
        self.collection.clips.push(Clip { items, clips });
        Ok(self.collection.clips.len() - 1)
    }

    fn path(&mut self, path: &usvg::Path, context: Context, items: &mut Vec<Item>) -> Result<(), ReadError> {
        if let Kind::Text(element) = context.kind {
            let outline = Rc::new(single_precision(path.data(), false));
            if path.is_visible() {
                let affine = context.outer.then_inner(&context.rough);
                self.paint(path, element, outline, affine, context, items)?;
            }
            return Ok(());
        }
        self.collection.seen.insert(path.id().to_owned());
        let Some(located) = self.locator.locate(path, &context.rough) else {
            return self.nameless(path, context, items);
        };
        let node = located.node;
        if !path.is_visible() {
            let painted = path.fill().is_some() || path.stroke().is_some();
            if context.kind == Kind::Drawing && painted {
                self.warn(node, WarningKind::Invisible);
                self.collection.found.hidden += 1;
            } else {
                self.collection.found.unpainted += 1;
            }
            return Ok(());
        }
        if let Some(at) = located.cut_at {
            self.warn(node, WarningKind::PathCutShort { at });
        }
        if !located.exact {
            self.warn(node, WarningKind::SinglePrecision);
        }
        let element = self.element(node, located.uses);
        let affine = context.outer.then_inner(&located.affine);
        self.paint(path, element, located.outline, affine, context, items)
    }

    /// A path that usvg made: the viewport of a symbol as a clip path, or a marker.
    fn nameless(&mut self, path: &usvg::Path, context: Context, items: &mut Vec<Item>) -> Result<(), ReadError> {
        if context.kind != Kind::Clip {
            let last = items.last().and_then(|i| self.collection.elements.get(i.element as usize)).cloned();
            let is_page = items.is_empty() && self.source.document.root_element().has_attribute("background-color");
            if let Some(place) = last.filter(|_| !is_page) {
                let warning = Warning { place, kind: WarningKind::Marker };
                if self.collection.warnings.last() != Some(&warning) {
                    self.collection.warnings.push(warning);
                }
            }
            return Ok(());
        }
        let element = self.element(self.source.document.root_element(), Vec::new());
        let outline = Rc::new(single_precision(path.data(), false));
        let affine = context.outer.then_inner(&context.rough);
        self.paint(path, element, outline, affine, context, items)
    }

    /// Adds what `path` fills and strokes.
    fn paint(
        &mut self,
        path: &usvg::Path,
        element: u32,
        outline: Rc<Outline>,
        affine: Affine,
        context: Context,
        items: &mut Vec<Item>,
    ) -> Result<(), ReadError> {
        self.refuse_huge(element, &outline, &affine)?;
        let clips = context.clips.to_vec();
        let bounds = outline.bounds(&affine);
        let has_area = bounds.width() > 0.0 && bounds.height() > 0.0;
        let fill = path.fill().filter(|fill| has_area && fill.opacity().get() > 0.0);
        if let Some(fill) = fill {
            let rule = fill.rule();
            if context.kind != Kind::Clip {
                self.collection.colors.entry(element).or_default().fill = color(fill.paint());
            }
            items.push(Item { element, outline: outline.clone(), affine, rule, clips: clips.clone() });
        }
        if context.kind == Kind::Clip {
            return Ok(());
        }
        let Some(stroke) = path.stroke().filter(|s| s.opacity().get() > 0.0) else {
            self.collection.found.unpainted += usize::from(fill.is_none());
            return Ok(());
        };
        if self.strokes == Strokes::Lines {
            self.collection.colors.entry(element).or_default().stroke = color(stroke.paint());
            self.collection.lines.push(Stroked { element, outline, affine });
        } else if self.strokes == Strokes::Areas {
            let (area, dashes) =
                stroke::area(&outline, stroke, stroke::MAX_DASHES - self.dashes).map_err(|dashes| {
                    let place = self.collection.elements.get(element as usize).cloned();
                    let place = place.unwrap_or_else(|| self.source.place(self.source.document.root_element()));
                    ReadError::TooManyDashes { place, dashes }
                })?;
            self.dashes += dashes;
            self.refuse_huge(element, &area, &affine)?;
            items.push(Item { element, outline: Rc::new(area), affine, rule: usvg::FillRule::NonZero, clips });
        } else if fill.is_none() {
            self.collection.found.strokes += 1;
            if let Some(place) = self.collection.elements.get(element as usize).cloned() {
                self.collection.warnings.push(Warning { place, kind: WarningKind::StrokeOnly });
            }
        } else {
            self.fill_alone.extend(self.collection.instances.get(element as usize).map(|i| i.node));
        }
        Ok(())
    }

    fn refuse_huge(&self, element: u32, outline: &Outline, affine: &Affine) -> Result<(), ReadError> {
        let named = outline.points().flat_map(|p| [p, affine.apply(p)]).flat_map(|p| [p.x, p.y]);
        match (largest(named), self.collection.elements.get(element as usize)) {
            (Some(value), Some(place)) => Err(ReadError::Huge { place: place.clone(), value }),
            _ => Ok(()),
        }
    }

    fn text(&mut self, text: &usvg::Text, context: Context, items: &mut Vec<Item>) -> Result<(), ReadError> {
        self.collection.seen.insert(text.id().to_owned());
        let source = self.source;
        let named = source.elements(text.id()).next();
        // Under a `use` without its name: the text that stands there.
        let texts = || source.document.descendants().filter(|n| n.tag_name().name() == "text");
        let node = named.or_else(|| texts().find(|n| self.placement(*n, &context.rough).is_some()));
        let Some(node) = node.or_else(|| texts().next()) else { return Ok(()) };
        let before = items.len();
        let place = self.placement(node, &context.rough);
        let Placement { affine, uses } = place.unwrap_or(Placement { affine: context.rough, uses: Vec::new() });
        let kind = if context.kind == Kind::Clip { Kind::Clip } else { Kind::Text(self.element(node, uses)) };
        let outer = context.outer.then_inner(&affine);
        let inside = Context { kind, outer, rough: Affine::IDENTITY, clips: context.clips };
        self.children(text.flattened(), inside, items)?;
        let words: String = text.chunks().iter().map(|c| c.text()).collect();
        if items.len() == before && !words.trim().is_empty() {
            self.collection.found.texts += 1;
            self.warn(node, WarningKind::TextWithoutFont { text: words.trim().to_owned() });
        }
        Ok(())
    }

    fn warn(&mut self, node: Node, kind: WarningKind) {
        if self.warned.insert((node.id(), std::mem::discriminant(&kind))) {
            self.collection.warnings.push(Warning { place: self.source.place(node), kind });
        }
    }

    /// The exact place of `node` that agrees best with a rough one.
    fn placement(&mut self, node: Node<'a, 'input>, rough: &Affine) -> Option<Placement> {
        let places = self.locator.placements(node);
        best(places.iter().map(|p| &p.affine), rough).map(|(k, _)| places[k].clone())
    }

    /// The number of the element at the place that `uses` give it.
    fn element(&mut self, node: Node, uses: Vec<NodeId>) -> u32 {
        let instance = Instance { node: node.id(), uses };
        if let Some(&number) = self.elements.get(&instance) {
            return number;
        }
        let number = self.collection.elements.len() as u32;
        self.collection.elements.push(self.source.place(node));
        self.collection.instances.push(instance.clone());
        self.elements.insert(instance, number);
        number
    }

    /// The element of the group, or of the first shape in it.
    fn first_element(&self, group: &usvg::Group) -> Option<Node<'a, 'input>> {
        if let Some(node) = self.source.elements(group.id()).next() {
            return Some(node);
        }
        group.children().iter().find_map(|child| match child {
            usvg::Node::Group(group) => self.first_element(group),
            child => self.source.elements(child.id()).next(),
        })
    }
}

/// The one colour that `paint` has.
fn color(paint: &usvg::Paint) -> Option<[u8; 3]> {
    match paint {
        usvg::Paint::Color(color) => Some([color.red, color.green, color.blue]),
        _ => None,
    }
}

/// The first coordinate beyond what is taken for meant.
pub(super) fn largest(mut values: impl Iterator<Item = f64>) -> Option<f64> {
    values.find(|v| v.is_nan() || v.abs() > MAX_COORDINATE)
}
