//! What a file says, before anything of it is united.

use std::sync::Arc;

use super::affine::Affine;
use super::collect::{Collection, Collector, Item, Stroked};
use super::document::{self, Source};
use super::drawing::{Drawing, RADIUS_ATTRIBUTE, Sources};
use super::error::{ReadError, Warning, WarningKind};
use super::fill::fill;
use super::known::Known;
use super::options::ReadOptions;
use super::outline::Outline;
use super::sample::{Meetings, Sampling, rings};
use super::shapes::DrawnLine;
use super::viewport::{Page, UnitSize};
use super::{fonts, leftovers, placement};
use crate::units::MM_PER_INCH;

/// A file that was read, with its document.
pub(super) struct Gathered<'g, 'a, 'input> {
    pub source: &'g Source<'a, 'input>,
    pub collection: Collection,
    /// From the coordinates below the root to the drawing's.
    pub outer: Affine,
    /// What the root element says of place and size.
    pub page: Page,
    options: &'g ReadOptions,
    tolerance: f64,
    known: Option<Known<'g>>,
    /// Elements, and what they say of radii.
    sources: Sources,
}

/// Reads a file, by the samples of `other` where it is given, and hands what it says to `then`.
///
/// # Errors
/// Where the file is broken, or `then` fails.
pub(super) fn gather<T>(
    bytes: &[u8],
    options: &ReadOptions,
    other: Option<&Drawing>,
    then: impl FnOnce(Gathered) -> Result<T, ReadError>,
) -> Result<T, ReadError> {
    check_options(options)?;
    let text = document::decode(bytes)?;
    let plain = document::parse(text)?;
    let (named, prefix) = document::with_ids(text, &plain);
    let document = document::parse(&named)?;
    let root = document.root_element();
    let source = Source::new(&document, &prefix);
    leftovers::refuse_huge(&source)?;
    let page = Page::of_root(root);
    let (tree, replaced) = fonts::tree(&document, options)?;
    let tree = tree.map_err(|error| refusal(error, source.place(root).line))?;

    let (group, outer) = below_root(&tree, root, &page);
    let mut collection = Collector::new(&source, options.strokes).collect(group, outer)?;
    leftovers::report(&source, &mut collection)?;
    let mut warn = |kind| collection.warnings.push(Warning { place: source.place(root), kind });
    replaced.into_iter().for_each(|(asked, taken)| warn(WarningKind::FontReplaced { asked, taken }));
    if page.has_invalid_view_box() {
        warn(WarningKind::InvalidViewBox { text: page.view_box.clone().unwrap_or_default() });
    }
    if page.unit_size() == UnitSize::Uneven {
        warn(WarningKind::UnevenScale);
    }
    collection.warnings.sort_by_key(|w| w.place.line);
    let tolerance = other.map_or(options.flatten * extent(&collection), |other| other.chord_tolerance);
    let asks = |node: &usvg::roxmltree::Node| node.attribute(RADIUS_ATTRIBUTE).map(str::to_owned);
    let radii: Vec<Option<String>> =
        collection.instances.iter().map(|i| source.around(i).iter().find_map(asks)).collect();
    let elements = Arc::from(std::mem::take(&mut collection.elements));
    let sources = Sources { elements, radii: Arc::from(radii), ..Sources::default() };
    let known = other.map(Known::new);
    then(Gathered { source: &source, collection, outer, page, options, tolerance, known, sources })
}

impl Gathered<'_, '_, '_> {
    fn sampling(&self) -> Sampling<'_> {
        Sampling {
            tolerance: self.tolerance,
            curves: self.options.curves,
            meetings: Meetings::Curves,
            known: self.known.as_ref(),
        }
    }

    /// The lines of a stroked outline.
    pub fn lines(&self, stroked: &Stroked) -> Vec<DrawnLine> {
        let mut sources = self.sources.clone();
        let mut lines = Vec::new();
        for subpath in &stroked.outline.subpaths {
            let one = Outline { subpaths: vec![subpath.clone()] };
            let rings = rings(&one, &stroked.affine, self.sampling(), stroked.element, &mut sources);
            let ends_at_start = subpath.commands.last().is_some_and(|c| c.end() == subpath.start);
            let is_closed = subpath.closed || ends_at_start;
            lines.extend(rings.into_iter().map(|ring| DrawnLine { ring, is_closed }));
        }
        lines
    }

    /// The items united, as a drawing without warnings and without a scale.
    pub fn drawing(&self, items: &[Item]) -> Drawing {
        let sampling = self.sampling();
        let (region, sources) = fill(&self.collection, items, sampling, self.sources.clone());
        Drawing {
            region,
            mm_per_unit: None,
            page: self.page.clone(),
            curves: self.options.curves,
            chord_tolerance: self.tolerance,
            sources,
            warnings: Vec::new(),
        }
    }

    /// Millimetres in a user unit, where all that is filled is so wide.
    pub fn mm_per_unit(&self, width: f64) -> Option<f64> {
        match (self.options.width_mm, self.options.dpi, self.page.unit_size()) {
            (Some(width_mm), _, _) => Some(width_mm / width),
            (None, Some(dpi), _) => Some(MM_PER_INCH / dpi),
            (None, None, UnitSize::Millimetres(mm)) => Some(mm),
            (None, None, UnitSize::Unknown | UnitSize::Uneven) => None,
        }
    }

    /// The error of a drawing in which nothing is filled.
    pub fn nothing_filled(self) -> ReadError {
        ReadError::NothingFilled { found: self.collection.found, warnings: self.collection.warnings }
    }
}

fn check_options(options: &ReadOptions) -> Result<(), ReadError> {
    let given = [("flatten", Some(options.flatten)), ("--dpi", options.dpi), ("--width", options.width_mm)];
    match given.iter().find(|(_, value)| value.is_some_and(|v| !(v.is_normal() && v > 0.0))) {
        Some(&(name, Some(value))) => Err(ReadError::InvalidOption { name, value }),
        _ => Ok(()),
    }
}

fn refusal(error: usvg::Error, line: usize) -> ReadError {
    match error {
        usvg::Error::InvalidSize => ReadError::InvalidSize { line },
        // What refers to each other grows beyond every limit.
        usvg::Error::ElementsLimitReached | usvg::Error::ParsingFailed(usvg::roxmltree::Error::NodesLimitReached) => {
            ReadError::TooLarge
        }
        other => ReadError::NotSvg { found: other.to_string() },
    }
}

/// The group whose coordinates are those of the view box, and the map from them to the drawing's: the root's own
/// transform, which usvg applies outside of the view box.
fn below_root<'t>(tree: &'t usvg::Tree, root: usvg::roxmltree::Node, page: &Page) -> (&'t usvg::Group, Affine) {
    let own = placement::transform(root).unwrap_or(Affine::IDENTITY);
    let view = page.view_box().map(|[x, y, w, h]| svgtypes::ViewBox { x, y, w, h });
    let fit = view.map_or(Affine::IDENTITY, |view| {
        let (width, height) = (f64::from(tree.size().width()), f64::from(tree.size().height()));
        placement::fit(view, width, height, page.aspect())
    });
    let outer = match fit.inverse() {
        Some(inverse) if own != Affine::IDENTITY => inverse.then_inner(&own.then_inner(&fit)),
        _ => Affine::IDENTITY,
    };
    let expected = own.then_inner(&fit);
    match tree.root().children() {
        [usvg::Node::Group(group)] if group.id().is_empty() && expected != Affine::IDENTITY => {
            let is_fit = expected.mismatch(&group.transform().into()) <= 1.0;
            (if is_fit { group } else { tree.root() }, outer)
        }
        _ => (tree.root(), outer),
    }
}

/// The larger side of the largest shape.
fn extent(collection: &Collection) -> f64 {
    let areas = collection.items.iter().map(|item| item.outline.bounds(&item.affine));
    let lines = collection.lines.iter().map(|line| line.outline.bounds(&line.affine));
    areas.chain(lines).map(|bounds| bounds.width().max(bounds.height())).fold(0.0, f64::max)
}
