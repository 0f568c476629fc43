//! What the file has and usvg's tree does not: hidden layers, references to nothing, images, text without a font.

use std::collections::HashSet;

use usvg::roxmltree::{Node, NodeId};

use super::collect::{Collection, largest};
use super::document::{Source, reference};
use super::error::{ReadError, Warning, WarningKind};
use super::shape::{self, SHAPES, attribute};

/// What is drawn only where something refers to it, or never.
const TEMPLATES: [&str; 10] =
    ["defs", "symbol", "clipPath", "mask", "marker", "pattern", "linearGradient", "radialGradient", "filter", "switch"];

/// Names what was left out.
pub(super) fn report(source: &Source, collection: &mut Collection) -> Result<(), ReadError> {
    let mut shown = HashSet::new();
    let mut missing = Vec::new();
    visit(source, source.document.root_element(), &mut |node| {
        if node.attribute("id").is_some_and(|id| collection.seen.contains(id)) {
            // All around a shown shape is shown.
            for around in node.ancestors() {
                if !shown.insert(around.id()) {
                    break;
                }
            }
        } else {
            missing.push(node);
        }
    });
    let mut layers: Vec<(NodeId, usize)> = Vec::new();
    for node in missing {
        let place = || source.place(node);
        let mut warn = |kind| collection.warnings.push(Warning { place: place(), kind });
        let off = node.ancestors().any(|n| n.is_element() && attribute(n, "display") == Some("none"));
        match node.tag_name().name() {
            "use" => {
                let href = reference(node).unwrap_or_default();
                let target = href.strip_prefix('#').and_then(|id| source.elements(id).next());
                match target {
                    None => warn(WarningKind::UnresolvedUse { href: href.to_owned() }),
                    Some(target) if is_circular(source, node, target) => {
                        warn(WarningKind::EmptyUse { href: href.to_owned() });
                    }
                    Some(_) => {}
                }
            }
            "image" if !off => {
                collection.found.images += 1;
                warn(WarningKind::Image);
            }
            "text" if !off => {
                let text: String = node.descendants().filter(|n| n.is_text()).filter_map(|n| n.text()).collect();
                let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
                if !text.is_empty() {
                    collection.found.texts += 1;
                    warn(WarningKind::TextWithoutFont { text });
                }
            }
            _ => {
                let shape = shape::read(node);
                if let Some(shape) = &shape {
                    let values = shape.outline.points().flat_map(|p| [p.x, p.y]);
                    if let Some(value) = largest(values) {
                        return Err(ReadError::Huge { place: place(), value });
                    }
                    if let Some(at) = shape.cut_at {
                        warn(WarningKind::PathCutShort { at });
                    }
                    if shape.outline.subpaths.iter().all(|s| s.commands.is_empty()) {
                        collection.found.unpainted += 1;
                        continue;
                    }
                }
                collection.found.hidden += 1;
                // The outermost group that shows nothing is the hidden layer.
                let root = source.document.root_element();
                let layer = node.ancestors().take_while(|n| *n != root && !shown.contains(&n.id())).last();
                let layer = layer.unwrap_or(node).id();
                match layers.iter_mut().find(|(id, _)| *id == layer) {
                    Some((_, count)) => *count += 1,
                    None => layers.push((layer, 1)),
                }
            }
        }
    }
    for (layer, shapes) in layers {
        if let Some(node) = source.document.get_node(layer) {
            collection.warnings.push(Warning { place: source.place(node), kind: WarningKind::Hidden { shapes } });
        }
    }
    Ok(())
}

/// Calls `found` with every shape, text, image and reference that is not part of a template.
fn visit<'a, 'input>(source: &Source<'a, 'input>, root: Node<'a, 'input>, found: &mut impl FnMut(Node<'a, 'input>)) {
    let mut stack = vec![root];
    while let Some(node) = stack.pop() {
        let name = node.tag_name().name();
        if TEMPLATES.contains(&name) && !source.document.root_element().eq(&node) {
            continue;
        }
        if SHAPES.contains(&name) || matches!(name, "text" | "image" | "use") {
            found(node);
        } else {
            stack.extend(node.children().filter(Node::is_element).rev());
        }
    }
}

/// Whether `node` stands in what it refers to, directly or by way of other references.
fn is_circular(source: &Source, node: Node, target: Node) -> bool {
    let mut visited = HashSet::new();
    let mut stack = vec![target];
    while let Some(at) = stack.pop() {
        if !visited.insert(at.id()) {
            continue;
        }
        for inside in at.descendants() {
            if inside == node {
                return true;
            }
            if inside.tag_name().name() == "use" {
                let id = reference(inside).and_then(|href| href.strip_prefix('#'));
                stack.extend(id.and_then(|id| source.elements(id).next()));
            }
        }
    }
    false
}

/// Refuses shapes with coordinates that nobody means, before anything is computed from them: curves through such places
/// would be divided without end.
///
/// # Errors
/// Names the first such shape.
pub(super) fn refuse_huge(source: &Source) -> Result<(), ReadError> {
    let suspects = source.document.descendants().filter(|n| n.attributes().any(|a| may_be_huge(a.value())));
    for node in suspects {
        let Some(shape) = shape::read(node) else { continue };
        if let Some(value) = largest(shape.outline.points().flat_map(|p| [p.x, p.y])) {
            return Err(ReadError::Huge { place: source.place(node), value });
        }
    }
    Ok(())
}

/// Whether some number in `text` has an exponent, or as many digits before its point as the largest coordinate: few
/// attributes do, and only those are read twice.
fn may_be_huge(text: &str) -> bool {
    const DIGITS: usize = 9;
    let (mut digits, mut after_point) = (0, false);
    for b in text.bytes() {
        match b {
            b'0'..=b'9' => digits += usize::from(!after_point),
            b'e' | b'E' if digits > 0 || after_point => return true,
            b'.' => after_point = true,
            _ => (digits, after_point) = (0, false),
        }
        if digits > DIGITS {
            return true;
        }
    }
    false
}
