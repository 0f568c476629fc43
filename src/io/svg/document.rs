//! The XML of a drawing, with a name for every shape and a place for every message.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};

use usvg::roxmltree::{self, Document, Node, NodeId, ParsingOptions};

use super::collect::Instance;
use super::error::{Place, ReadError};
use super::shape::SHAPES;

/// How many elements are read, references expanded or not; usvg's own limit.
const MAX_NODES: u32 = 1_000_000;

const XLINK: &str = "http://www.w3.org/1999/xlink";

/// The text of the file as UTF-8, without byte order mark.
pub(super) fn decode(bytes: &[u8]) -> Result<&str, ReadError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let text = std::str::from_utf8(bytes).map_err(|e| ReadError::NotText { offset: e.valid_up_to() })?;
    if text.trim().is_empty() { Err(ReadError::Empty) } else { Ok(text) }
}

pub(super) fn parse(text: &str) -> Result<Document<'_>, ReadError> {
    let options = ParsingOptions { allow_dtd: true, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).map_err(|e| explain(&e, text))?;
    let root = document.root_element();
    let is_svg = root.tag_name().name() == "svg"
        && matches!(root.tag_name().namespace(), None | Some("http://www.w3.org/2000/svg"));
    if !is_svg {
        return Err(ReadError::NotSvg { found: format!("its root element is <{}>", root.tag_name().name()) });
    }
    Ok(document)
}

fn explain(error: &roxmltree::Error, text: &str) -> ReadError {
    use roxmltree::Error;
    let lines = text.lines().count() as u32;
    let pos = error.pos();
    match error {
        Error::NodesLimitReached | Error::AttributesLimitReached | Error::NamespacesLimitReached => ReadError::TooLarge,
        Error::UnclosedRootNode | Error::UnexpectedEndOfStream => ReadError::CutOff { line: lines },
        Error::NoRootNode => ReadError::NotSvg { found: "it has no element".to_owned() },
        _ if !text.trim_start().starts_with('<') => ReadError::NotSvg { found: "it does not begin with <".to_owned() },
        _ => {
            // An error in the very last tag, when that tag does not end, is the end of the file.
            let unfinished = text.rfind('<').is_some_and(|at| !text[at..].contains('>'));
            if unfinished && pos.row >= lines {
                return ReadError::CutOff { line: lines };
            }
            let reason = error.to_string();
            let reason = reason.split(" at ").next().unwrap_or_default().to_owned();
            ReadError::Malformed { line: pos.row, column: pos.col, reason }
        }
    }
}

/// The text with an `id` on every shape, text and image that had none, and the prefix of those that were made.
pub(super) fn with_ids<'a>(text: &'a str, document: &Document) -> (Cow<'a, str>, String) {
    let mut prefix = "clopen-".to_owned();
    while text.contains(&prefix) {
        prefix.push('-');
    }
    // Ordered by place in the text; an entity's content has one place however often it is used.
    let mut insertions = BTreeMap::new();
    for (index, node) in document.descendants().enumerate() {
        let name = node.tag_name().name();
        if !(SHAPES.contains(&name) || matches!(name, "text" | "image")) {
            continue;
        }
        match node.attribute_node("id") {
            Some(id) if id.value().is_empty() => {
                insertions.insert(id.range_value().start, format!("{prefix}{index}"));
            }
            Some(_) => {}
            None => {
                let start = node.range().start;
                let Some(tag) = text.get(start..).filter(|t| t.starts_with('<')) else { continue };
                let Some(end) = tag.find(|c: char| c.is_whitespace() || c == '/' || c == '>') else { continue };
                insertions.insert(start + end, format!(" id=\"{prefix}{index}\""));
            }
        }
    }
    if insertions.is_empty() {
        return (Cow::Borrowed(text), prefix);
    }
    let mut named = String::with_capacity(text.len() + 32 * insertions.len());
    let mut copied = 0;
    for (at, insertion) in insertions {
        named.push_str(&text[copied..at]);
        named.push_str(&insertion);
        copied = at;
    }
    named.push_str(&text[copied..]);
    (Cow::Owned(named), prefix)
}

/// The named document, arranged for looking up.
pub(super) struct Source<'a, 'input> {
    pub document: &'a Document<'input>,
    prefix: &'a str,
    by_id: HashMap<&'a str, Vec<NodeId>>,
    used_by: HashMap<&'a str, Vec<NodeId>>,
    line_starts: Vec<usize>,
}

impl<'a, 'input> Source<'a, 'input> {
    pub fn new(document: &'a Document<'input>, prefix: &'a str) -> Source<'a, 'input> {
        let mut by_id: HashMap<&str, Vec<NodeId>> = HashMap::new();
        let mut used_by: HashMap<&str, Vec<NodeId>> = HashMap::new();
        for node in document.descendants().filter(Node::is_element) {
            if let Some(id) = node.attribute("id") {
                by_id.entry(id).or_default().push(node.id());
            }
            if node.tag_name().name() == "use"
                && let Some(target) = reference(node).and_then(|href| href.strip_prefix('#'))
            {
                used_by.entry(target).or_default().push(node.id());
            }
        }
        let text = document.input_text();
        let line_starts = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Source { document, prefix, by_id, used_by, line_starts }
    }

    /// All elements with this `id`: one in a well-formed file.
    pub fn elements(&self, id: &str) -> impl Iterator<Item = Node<'a, 'input>> + '_ {
        self.by_id.get(id).into_iter().flatten().filter_map(|&n| self.document.get_node(n))
    }

    /// The `use` elements that refer to `node`.
    pub fn uses(&self, node: Node) -> impl Iterator<Item = Node<'a, 'input>> + '_ {
        let uses = node.attribute("id").and_then(|id| self.used_by.get(id));
        uses.into_iter().flatten().filter_map(|&n| self.document.get_node(n))
    }

    /// All that is named in the file, in order.
    pub fn ids(&self) -> Vec<&'a str> {
        let named = self.document.descendants().filter_map(|n| n.attribute("id"));
        named.filter(|id| !id.is_empty() && !id.starts_with(self.prefix)).collect()
    }

    /// An element and what is around it at its place, up to the root: where a reference shows it, around the reference.
    pub fn around(&self, instance: &Instance) -> Vec<Node<'a, 'input>> {
        let mut uses = instance.uses.iter().filter_map(|&user| self.document.get_node(user)).peekable();
        let mut way = Vec::new();
        let mut at = self.document.get_node(instance.node);
        while let Some(node) = at.filter(Node::is_element) {
            way.push(node);
            let user = uses.next_if(|user| self.uses(node).any(|other| other == *user));
            at = user.or_else(|| node.parent_element());
        }
        way
    }

    pub fn place(&self, node: Node) -> Place {
        let id = node.attribute("id").filter(|id| !id.is_empty() && !id.starts_with(self.prefix));
        Place {
            element: node.tag_name().name().to_owned(),
            id: id.map(str::to_owned),
            line: self.line_starts.partition_point(|&start| start <= node.range().start),
        }
    }
}

/// What a `use` refers to: `href`, or else `xlink:href`.
pub(super) fn reference<'a>(node: Node<'a, '_>) -> Option<&'a str> {
    let plain = node.attributes().find(|a| a.name() == "href" && a.namespace().is_none());
    let value = plain.map(|a| a.value()).or_else(|| node.attribute((XLINK, "href")));
    value.map(str::trim)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_get_names_and_keep_their_lines() {
        let text = "<svg>\n<path/><rect id='r'/>\n<svg:circle xmlns:svg='http://www.w3.org/2000/svg'\n r='1'/></svg>";
        let (named, prefix) = with_ids(text, &Document::parse(text).unwrap());
        let document = Document::parse(&named).unwrap();
        let source = Source::new(&document, &prefix);
        let shapes = document.descendants().filter(|n| SHAPES.contains(&n.tag_name().name()));
        let places: Vec<String> = shapes.map(|n| source.place(n).to_string()).collect();
        assert_eq!(places, ["<path> on line 2", "<rect id=\"r\"> on line 2", "<circle> on line 3"]);
        assert_eq!(source.by_id.len(), 3);
    }

    #[test]
    fn broken_files_are_told_apart() {
        let error = |text: &str| match decode(text.as_bytes()).and_then(|t| parse(t).map(|_| ())) {
            Ok(()) => String::new(),
            Err(e) => e.to_string(),
        };
        assert!(error(" \n").contains("empty"));
        assert!(error("<svg>\n<path d='M0").contains("breaks off on line 2"));
        assert!(error("<svg>\n<g>").contains("breaks off"));
        assert!(error("<html/>").contains("<html>"));
        assert!(error("G1 X3").contains("no SVG"));
        assert!(error("<svg>\n<a></b></svg>").contains("line 2"));
        assert_eq!(error("<svg/>"), "");
        assert!(decode(b"\x1f\x8b\x08").is_err());
    }
}
