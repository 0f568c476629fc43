//! SVG drawings: read to a region that keeps the digits of the file, written back with the commands that did not change.
//!
//! What is read: every filled shape (paths, basic shapes, text), wherever transforms, nested `svg`, `use` and `symbol` put
//! it, by its own fill rule, cut down to its clip paths, all united into one [`Region`]; strokes as areas on request.
//! [`read`] guarantees:
//!
//! - a point under no transform has exactly the coordinates of the file, y negated; under transforms those of the exact
//!   chain of matrices in `f64`;
//! - the rings of the region do not cross, and outlines that meet no other are passed through vertex by vertex;
//! - circles and circular arcs are true arcs;
//! - whatever is not in the region is named in a [`Warning`] or in the [`ReadError`].
//!
//! Colours and opacity (other than none) do not matter: a white shape is as solid as a black one, and does not cut a hole
//! into what lies below it (subtract it in the drawing program). Masks, filters, images and markers are not applied.

pub(super) mod affine;
mod animate;
mod collect;
mod document;
mod drawing;
mod elliptic;
mod error;
mod fonts;
mod known;
mod leftovers;
mod locate;
mod options;
pub(super) mod outline;
mod part;
mod placement;
mod rough;
pub(super) mod sample;
mod shape;
mod stroke;
mod thin;
mod viewport;
mod write;

use std::collections::HashMap;

pub use animate::{Still, animate};
pub use drawing::{Curve, CurveKind, Drawing, Sources, VertexSource};
pub use error::{Found, MAX_COORDINATE, Place, ReadError, Warning, WarningKind};
pub use options::{Curves, DEFAULT_FLATTEN, ReadOptions, Strokes};
pub use viewport::Page;
pub use write::write;

use crate::plane::{Region, Ring};
use crate::units::MM_PER_INCH;

use super::unite::{self, Rule};
use affine::Affine;
use collect::{Collection, Collector, Item};
use document::Source;
use known::Known;
use sample::{Meetings, Sampling};
use viewport::UnitSize;

/// Reads an SVG file.
///
/// # Errors
/// Where the file is broken or holds no filled shape; the error says where and what to try.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<Drawing, ReadError> {
    read_with(bytes, options, None)
}

/// Reads an SVG file that was made from `other`, to be compared with it: with the chord tolerance of `other` in place of
/// that of the options, and with the samples of `other` on its curves and on parts of them. So whatever of a curve was
/// kept has the same vertices in both drawings.
///
/// # Errors
/// As [`read`].
pub fn read_alike(bytes: &[u8], options: &ReadOptions, other: &Drawing) -> Result<Drawing, ReadError> {
    read_with(bytes, options, Some(other))
}

fn read_with(bytes: &[u8], options: &ReadOptions, other: Option<&Drawing>) -> Result<Drawing, ReadError> {
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
    let known = other.map(Known::new);
    let tolerance = other.map_or(options.flatten * extent(&collection), |other| other.chord_tolerance);
    let sampling = Sampling { tolerance, curves: options.curves, meetings: Meetings::Curves, known: known.as_ref() };
    let (region, sources) = fill(&mut collection, sampling);
    if region.is_empty() {
        return Err(ReadError::NothingFilled { found: collection.found, warnings: collection.warnings });
    }
    let mut warnings = collection.warnings;
    let mut warn = |kind| warnings.push(Warning { place: source.place(root), kind });
    replaced.into_iter().for_each(|(asked, taken)| warn(WarningKind::FontReplaced { asked, taken }));
    if page.has_invalid_view_box() {
        warn(WarningKind::InvalidViewBox { text: page.view_box.clone().unwrap_or_default() });
    }
    let unit = page.unit_size();
    if unit == UnitSize::Uneven {
        warn(WarningKind::UnevenScale);
    }
    warnings.sort_by_key(|w| w.place.line);
    let mm_per_unit = match (options.width_mm, options.dpi, unit) {
        (Some(width), _, _) => Some(width / region.bounds().width()),
        (None, Some(dpi), _) => Some(MM_PER_INCH / dpi),
        (None, None, UnitSize::Millimetres(mm)) => Some(mm),
        (None, None, UnitSize::Unknown | UnitSize::Uneven) => None,
    };
    Ok(Drawing { region, mm_per_unit, page, curves: options.curves, chord_tolerance: tolerance, sources, warnings })
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
    let extents = collection.items.iter().map(|item| {
        let bounds = item.outline.bounds(&item.affine);
        bounds.width().max(bounds.height())
    });
    extents.fold(0.0, f64::max)
}

/// All items united.
fn fill(collection: &mut Collection, sampling: Sampling) -> (Region, Sources) {
    let sources = Sources { elements: std::mem::take(&mut collection.elements), ..Sources::default() };
    let mut filler = Filler { collection, sampling, sources, clips: HashMap::new() };
    if sampling.tolerance <= 0.0 {
        return (Region::default(), filler.sources);
    }
    let items = &filler.collection.items;
    let rings = filler.union(items);
    (Region::new(rings), filler.sources)
}

struct Filler<'a> {
    collection: &'a Collection,
    sampling: Sampling<'a>,
    sources: Sources,
    clips: HashMap<usize, Vec<Ring>>,
}

impl Filler<'_> {
    fn union(&mut self, items: &[Item]) -> Vec<Ring> {
        // What is cut down to the same clip paths is cut at once.
        let mut first_of: HashMap<&[usize], usize> = HashMap::new();
        let mut groups: Vec<(&[usize], Vec<Vec<Ring>>)> = Vec::new();
        for item in items {
            let area = self.area(item);
            let clips = item.clips.as_slice();
            let at = *first_of.entry(clips).or_insert_with(|| {
                groups.push((clips, Vec::new()));
                groups.len() - 1
            });
            if !area.is_empty() {
                groups[at].1.push(area);
            }
        }
        let mut areas: Vec<Vec<Ring>> = Vec::new();
        for (clips, group) in groups {
            if clips.is_empty() {
                areas.extend(group);
            } else {
                let area = united(group);
                areas.push(self.within(area, clips));
            }
        }
        areas.retain(|area| !area.is_empty());
        united(areas)
    }

    /// What one item fills, clip paths aside.
    fn area(&mut self, item: &Item) -> Vec<Ring> {
        let rings = sample::rings(&item.outline, &item.affine, self.sampling, item.element, &mut self.sources);
        let rule = match item.rule {
            usvg::FillRule::NonZero => Rule::NonZero,
            usvg::FillRule::EvenOdd => Rule::EvenOdd,
        };
        unite::resolve(rings, rule)
    }

    fn within(&mut self, mut area: Vec<Ring>, clips: &[usize]) -> Vec<Ring> {
        for &clip in clips {
            if area.is_empty() {
                break;
            }
            area.extend(self.clip(clip));
            area = unite::resolve(area, Rule::AtLeast(2));
        }
        area
    }

    fn clip(&mut self, index: usize) -> Vec<Ring> {
        if let Some(rings) = self.clips.get(&index) {
            return rings.clone();
        }
        let collection = self.collection;
        let clip = &collection.clips[index];
        let union = self.union(&clip.items);
        let rings = self.within(union, &clip.clips);
        self.clips.insert(index, rings.clone());
        rings
    }
}

fn united(mut areas: Vec<Vec<Ring>>) -> Vec<Ring> {
    match areas.len() {
        0 => Vec::new(),
        1 => areas.remove(0),
        _ => unite::resolve(areas.concat(), Rule::AtLeast(1)),
    }
}
