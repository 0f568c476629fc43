//! A drawing in parts: what is chosen of it, united, and every other element by itself.

use std::collections::HashMap;

use usvg::roxmltree::{Node, NodeId};

use super::collect::Item;
use super::document::Source;
use super::drawing::Drawing;
use super::error::ReadError;
use super::gather::{Gathered, gather};
use super::options::ReadOptions;
use super::selection::Selection;
use crate::plane::Bounds;
use crate::units::DrawingScale;

/// A drawing in parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    /// The parts in the order of the document. What is chosen stands in the innermost group that holds all of it, where its
    /// first element was.
    pub parts: Vec<Part>,
    /// Which of them is what is chosen. Its drawing has the warnings of the whole file.
    pub chosen: usize,
}

/// Elements that are united, and with nothing else.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The `id`s of the groups and references around it, the outermost first.
    pub groups: Vec<String>,
    /// The `id` of its element, where it is one.
    pub id: Option<String>,
    /// What it fills. Page, scale and chord tolerance are the same in all parts of a file.
    pub drawing: Drawing,
}

impl Parts {
    /// What is chosen.
    pub fn chosen(&self) -> &Drawing {
        &self.parts[self.chosen].drawing
    }

    /// The smallest box that holds all parts.
    pub fn bounds(&self) -> Bounds {
        self.parts.iter().fold(Bounds::EMPTY, |b, part| b.union(part.drawing.region.bounds()))
    }

    /// What lengths typed for the drawing are measured by: all of it, whatever is chosen.
    pub fn scale(&self) -> DrawingScale {
        DrawingScale { mm_per_unit: self.chosen().mm_per_unit, diagonal: self.bounds().diagonal() }
    }
}

impl From<Drawing> for Parts {
    fn from(drawing: Drawing) -> Parts {
        Parts { parts: vec![Part { groups: Vec::new(), id: None, drawing }], chosen: 0 }
    }
}

/// Reads an SVG file in parts: all elements that `selection` means are one part, every other element is one by itself.
///
/// Parts may overlap and touch each other: none is united with another.
///
/// # Errors
/// As [`read`](super::read), and where the selection names what is not in the file, or leaves nothing that is filled.
pub fn read_parts(bytes: &[u8], options: &ReadOptions, selection: &Selection) -> Result<Parts, ReadError> {
    gather(bytes, options, None, |gathered| {
        let chosen = selection.choose(&gathered)?;
        let parts = divide(&gathered, &chosen);
        if parts.parts.iter().all(|part| part.drawing.region.is_empty()) {
            return Err(gathered.nothing_filled());
        }
        if parts.chosen().region.is_empty() {
            return Err(ReadError::NothingChosen { id: None });
        }
        let mm_per_unit = gathered.mm_per_unit(parts.bounds().width());
        let Parts { mut parts, chosen } = parts;
        parts.iter_mut().for_each(|part| part.drawing.mm_per_unit = mm_per_unit);
        parts[chosen].drawing.warnings = gathered.collection.warnings;
        Ok(Parts { parts, chosen })
    })
}

/// A part on its way: its place in the document, from the root down, and what it fills.
struct Piece<'a, 'input> {
    way: Vec<Node<'a, 'input>>,
    items: Vec<Item>,
}

fn divide(gathered: &Gathered, chosen: &[bool]) -> Parts {
    let way = |element: u32| -> Vec<Node> {
        let mut way = gathered.collection.instances.get(element as usize).map_or(vec![], |i| gathered.source.around(i));
        way.reverse();
        way
    };
    let mut whole: Option<Piece> = None;
    // Where the first chosen element stood among the others, and its way.
    let mut first: (usize, Vec<NodeId>) = (0, Vec::new());
    let mut others: Vec<Piece> = Vec::new();
    let mut piece_of: HashMap<u32, usize> = HashMap::new();
    for item in &gathered.collection.items {
        if !chosen.get(item.element as usize).copied().unwrap_or(true) {
            let piece = *piece_of.entry(item.element).or_insert_with(|| {
                others.push(Piece { way: way(item.element), items: Vec::new() });
                others.len() - 1
            });
            others[piece].items.push(item.clone());
            continue;
        }
        let way = way(item.element);
        match &mut whole {
            Some(whole) => {
                let shared = whole.way.iter().zip(&way).take_while(|(a, b)| a == b).count();
                whole.way.truncate(shared);
                whole.items.push(item.clone());
            }
            None => {
                first = (others.len(), way.iter().map(Node::id).collect());
                whole = Some(Piece { way, items: vec![item.clone()] });
            }
        }
    }
    let whole = whole.unwrap_or(Piece { way: Vec::new(), items: Vec::new() });
    // No group is torn: what is chosen goes before whatever shares with its first element more than with all of it.
    let depth = (whole.way.len() + 1).min(first.1.len());
    let shares = |piece: &Piece| {
        depth > whole.way.len() && piece.way.len() >= depth && (0..depth).all(|k| piece.way[k].id() == first.1[k])
    };
    let before = others[..first.0].iter().position(shares).unwrap_or(first.0);
    let part = |piece: Piece| {
        let (groups, id) = names(gathered.source, &piece.way);
        Part { groups, id, drawing: gathered.drawing(&piece.items) }
    };
    let mut parts: Vec<Part> = Vec::with_capacity(others.len() + 1);
    let mut at = 0;
    let mut whole = Some(whole);
    for (k, piece) in others.into_iter().enumerate() {
        if k == before {
            at = parts.len();
            parts.extend(whole.take().map(part));
        }
        let part = part(piece);
        if !part.drawing.region.is_empty() {
            parts.push(part);
        }
    }
    if let Some(whole) = whole {
        at = parts.len();
        parts.push(part(whole));
    }
    Parts { parts, chosen: at }
}

/// The names of what is around a part, and its own, where the way to it ends in what is drawn. What a `use` shows may be
/// shown by another one, too, so that its names cannot be given twice.
fn names(source: &Source, way: &[Node]) -> (Vec<String>, Option<String>) {
    let named = way.iter().position(|n| n.tag_name().name() == "use").map_or(way.len(), |at| at + 1);
    let mut groups = Vec::new();
    let mut own = None;
    for (k, node) in way[..named].iter().enumerate().skip(1) {
        let Some(id) = source.place(*node).id else { continue };
        if k + 1 == way.len() && !matches!(node.tag_name().name(), "g" | "svg" | "use" | "a" | "switch" | "symbol") {
            own = Some(id);
        } else {
            groups.push(id);
        }
    }
    (groups, own)
}
