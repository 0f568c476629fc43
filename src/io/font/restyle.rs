//! Every glyph of a font through an operation.
//!
//! Stages, glyphs in the order of what they are made of: (1) the outline becomes a region, overlapping contours united; (2) the
//! operation; (3) a result that is the outline itself keeps the glyph's bytes; (4) another is written as quadratic curves in
//! whole units and measured against the exact result; (5) a composite stays one where what its components give now is
//! within the tolerance of the operation on its own outline, and gets contours of its own where not.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::compose::composed;
use super::contour::Contour;
use super::deviation::deviation;
use super::face::{Face, Source};
use super::fill::{Filled, Sampling};
use super::glyf::{self, Composite, Glyph};
use super::grid::{self, Rounded};
use super::{polish, quadratics, settle, trace};
use crate::plane::{BoundaryIndex, Region};
use crate::threads;

/// A result nearer to the outline than this part of the tolerance is the outline: nothing moved.
const UNMOVED: f64 = 0.1;

/// Parts of the tolerance within which curves are laid before they are rounded: the second is tried where the first and
/// rounding together exceed it.
const ACCURACIES: [f64; 2] = [0.2, 0.05];

/// Parts of the tolerance that are aimed at, in turn: what is measured in the end lies between the points that are moved by.
const LIMITS: [f64; 2] = [1.0, 0.97];

/// What to do to an outline; `None` where the result cannot be vouched for: then the glyph stays as it is.
pub type Operation<'a> = dyn Fn(&Region) -> Option<Region> + Sync + 'a;

/// How to restyle.
#[derive(Clone, Copy, Debug)]
pub struct RestyleOptions {
    /// How outlines are sampled.
    pub sampling: Sampling,
    /// The largest distance between what is written and the exact result that is aimed at, in font units.
    pub tolerance: f64,
    /// How many threads work; the result does not depend on it.
    pub threads: usize,
}

/// What became of a glyph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// A blank.
    Blank,
    /// The operation moves nothing: its bytes are what they were, without instructions.
    Kept,
    /// It has a new outline.
    Changed,
    /// It has a new outline by way of its components.
    ChangedByComponents,
    /// Nothing of it is left.
    Vanished,
    /// It stays as it was, for a reason.
    Refused(&'static str),
}

/// A glyph, done.
#[derive(Clone, Debug)]
pub(super) struct Done {
    pub fate: Fate,
    /// What goes into the table `glyf`.
    pub data: Vec<u8>,
    /// The contours that the data draws.
    pub written: Vec<Contour>,
    /// Those that the font had: of TrueType outlines, for the composites made of them.
    original: Vec<Contour>,
    /// The box of the outline that the font had, where there was one.
    pub old_box: Option<[i16; 4]>,
    /// The largest distance between what is written and the exact result, in font units.
    pub deviation: f64,
    /// Of a composite that stays one, how many components and how deep.
    pub nesting: Option<(usize, usize)>,
}

impl Done {
    fn new(fate: Fate, data: Vec<u8>) -> Done {
        Done { fate, data, written: vec![], original: vec![], old_box: None, deviation: 0.0, nesting: None }
    }

    fn refused(reason: &'static str) -> Done {
        Done::new(Fate::Refused(reason), Vec::new())
    }
}

/// Restyles all glyphs; `progress` is told how many are done.
pub(super) fn glyphs(
    face: &Face,
    operation: &Operation,
    options: &RestyleOptions,
    progress: &(dyn Fn(usize) + Sync),
) -> Vec<Done> {
    let count = face.glyph_count();
    let mut done: Vec<Option<Done>> = vec![None; count];
    let mut composites: BTreeMap<u16, Composite> = BTreeMap::new();
    let mut ready: Vec<Job> = Vec::new();
    for glyph in 0..face.glyph_count {
        match face.source(glyph) {
            Ok(Source::TrueType(Glyph::Composite(composite))) => {
                composites.insert(glyph, composite);
            }
            source => ready.push(Job { glyph, source }),
        }
    }
    let worker = Worker { face, operation, options };
    let finished = AtomicUsize::new(0);
    let report = || progress(finished.fetch_add(1, Ordering::Relaxed) + 1);
    let simple = threads::map_long(&ready, options.threads, |job| {
        let done = worker.simple(job);
        report();
        done
    });
    for (job, result) in ready.iter().zip(simple) {
        done[usize::from(job.glyph)] = Some(result);
    }
    // Composites whose components are all done, again and again.
    loop {
        let is_done = |g: u16| done.get(usize::from(g)).is_some_and(Option::is_some);
        let next: Vec<(u16, Composite)> = composites
            .iter()
            .filter(|(_, c)| c.components.iter().all(|c| is_done(c.glyph)))
            .map(|(g, c)| (*g, c.clone()))
            .collect();
        if next.is_empty() {
            break;
        }
        let results = threads::map_long(&next, options.threads, |(_, composite)| {
            let result = worker.composite(composite, &done);
            report();
            result
        });
        for ((glyph, _), result) in next.iter().zip(results) {
            composites.remove(glyph);
            done[usize::from(*glyph)] = Some(result);
        }
    }
    let stuck = || Done::refused("its components are missing, or it is one of its own components");
    done.into_iter().map(|d| d.unwrap_or_else(stuck)).collect()
}

struct Job {
    glyph: u16,
    source: Result<Source, &'static str>,
}

struct Worker<'a> {
    face: &'a Face<'a>,
    operation: &'a Operation<'a>,
    options: &'a RestyleOptions,
}

/// What the operation makes of an outline.
enum Outcome {
    Unmoved,
    Moved(Region, BoundaryIndex),
}

impl Worker<'_> {
    fn simple(&self, job: &Job) -> Done {
        let (filled, original, kept) = match &job.source {
            Err(reason) => return Done::refused(reason),
            Ok(Source::TrueType(Glyph::Simple(simple))) => {
                let filled = Filled::of_contours(&simple.contours, self.options.sampling);
                (filled, simple.contours.clone(), Some(&simple.stripped))
            }
            Ok(Source::Cff(outline)) => (Filled::of_outline(outline, self.options.sampling), Vec::new(), None),
            Ok(Source::TrueType(Glyph::Empty | Glyph::Composite(_))) => return Done::new(Fate::Blank, Vec::new()),
        };
        if filled.region.is_empty() && kept.is_none() {
            return Done::new(Fate::Blank, Vec::new());
        }
        let old_box = match kept {
            Some(_) => Some(glyf::whole_box(&original)),
            None => Some(region_box(&filled.region)),
        };
        let outcome = self.outcome(&filled.region);
        let kept_as = |fate| Done {
            written: original.clone(),
            original: original.clone(),
            old_box,
            ..Done::new(fate, kept.cloned().unwrap_or_default())
        };
        match (outcome, kept) {
            (Ok(Outcome::Unmoved), Some(_)) => kept_as(Fate::Kept),
            (Err(reason), Some(_)) => kept_as(Fate::Refused(reason)),
            (Err(reason), None) => {
                // A cubic outline cannot be kept: it is written as it was.
                let done = self.written(&filled, &filled.region, &BoundaryIndex::new(&filled.region));
                done.map_or_else(Done::refused, |d| Done { fate: Fate::Refused(reason), old_box, ..d })
            }
            (Ok(Outcome::Unmoved), None) => {
                let done = self.written(&filled, &filled.region, &BoundaryIndex::new(&filled.region));
                done.map_or_else(Done::refused, |d| Done { fate: Fate::Kept, old_box, ..d })
            }
            (Ok(Outcome::Moved(region, index)), _) => match self.written(&filled, &region, &index) {
                Ok(done) => Done { original, old_box, ..done },
                Err(reason) => kept_as(Fate::Refused(reason)),
            },
        }
    }

    fn composite(&self, composite: &Composite, done: &[Option<Done>]) -> Done {
        let result = |g: u16| done.get(usize::from(g)).and_then(Option::as_ref).ok_or("a component is missing");
        let original = composed(composite, |g| Ok(result(g)?.original.clone()));
        let assembled = composed(composite, |g| Ok(result(g)?.written.clone()));
        let original = match original {
            Ok(original) => original,
            Err(reason) => return Done::refused(reason),
        };
        let depth = |g: u16| result(g).ok().and_then(|d| d.nesting).map_or(1, |(_, depth)| depth + 1);
        let nesting =
            (composite.components.len(), composite.components.iter().map(|c| depth(c.glyph)).max().unwrap_or(1));
        let components = || composite.components.iter();
        let is_as_it_was = components()
            .all(|c| result(c.glyph).is_ok_and(|d| matches!(d.fate, Fate::Blank | Fate::Kept | Fate::Refused(_))));
        let old_box = Some(glyf::whole_box(&original));
        let kept_as = |fate, written: Vec<Contour>, deviation| {
            let mut data = composite.stripped.clone();
            if fate == Fate::ChangedByComponents {
                glyf::put_box(&mut data, glyf::whole_box(&written));
            }
            let original = original.clone();
            Done { written, original, old_box, deviation, nesting: Some(nesting), ..Done::new(fate, data) }
        };
        let filled = Filled::of_contours(&original, self.options.sampling);
        let outcome = self.outcome(&filled.region);
        let mut refused = None;
        let (region, index) = match outcome {
            Ok(Outcome::Unmoved) if is_as_it_was => return kept_as(Fate::Kept, original.clone(), 0.0),
            Err(reason) if is_as_it_was => return kept_as(Fate::Refused(reason), original.clone(), 0.0),
            Ok(Outcome::Moved(region, index)) => (region, index),
            // Its components change, and it must not.
            not_moved => {
                refused = not_moved.err().map(Fate::Refused);
                (filled.region.clone(), BoundaryIndex::new(&filled.region))
            }
        };
        let hangs_on_numbers = components().any(|c| c.is_anchored()) && !is_as_it_was;
        if let Ok(assembled) = assembled
            && !hangs_on_numbers
        {
            let drawn = Filled::of_contours(&assembled, self.options.sampling).region;
            let off = self.off(drawn, &region, &index);
            if off <= self.options.tolerance {
                return kept_as(Fate::ChangedByComponents, assembled, off);
            }
        }
        match self.written(&filled, &region, &index) {
            Ok(done) => Done { original, old_box, fate: refused.unwrap_or(done.fate), ..done },
            Err(reason) => Done { original, old_box, ..Done::refused(reason) },
        }
    }

    /// Whether and how the operation moves an outline.
    fn outcome(&self, region: &Region) -> Result<Outcome, &'static str> {
        let result = (self.operation)(region).ok_or("the result could not be proved")?;
        let kept = result.rings.iter().flat_map(|r| &r.vertices).filter(|v| v.id.is_some()).count();
        let lost = result.vertex_count() - kept;
        if lost == 0 && kept == region.vertex_count() {
            return Ok(Outcome::Unmoved);
        }
        let (before, after) = (BoundaryIndex::new(region), BoundaryIndex::new(&result));
        let moved = deviation((region, &before), (&result, &after), self.face.units_per_em());
        let is_unmoved = moved <= UNMOVED * self.options.tolerance;
        Ok(if is_unmoved { Outcome::Unmoved } else { Outcome::Moved(result, after) })
    }

    /// How far the outline `written` is from the exact result.
    fn off(&self, written: Region, exact: &Region, index: &BoundaryIndex) -> f64 {
        let written_index = BoundaryIndex::new(&written);
        deviation((&written, &written_index), (exact, index), self.face.units_per_em())
    }

    /// The exact result as a glyph of its own.
    fn written(&self, filled: &Filled, exact: &Region, index: &BoundaryIndex) -> Result<Done, &'static str> {
        if exact.is_empty() {
            return Ok(Done::new(Fate::Vanished, Vec::new()));
        }
        // Fonts have the solid on the right.
        let turned = exact.reversed();
        let tracer = trace::Tracer::new(&filled.sources);
        let pieces: Vec<Vec<trace::Piece>> = turned.rings.iter().map(|ring| tracer.pieces(ring)).collect();
        let mut best: Option<(f64, Vec<Contour>)> = None;
        'accuracies: for accuracy in ACCURACIES {
            let contour = |pieces: &Vec<trace::Piece>| {
                let knots = quadratics::knots(pieces, &filled.sources, accuracy * self.options.tolerance);
                grid::contour(&knots, index)
            };
            // What rounding has flattened encloses nothing.
            let mut rounded: Vec<Rounded> = pieces.iter().map(contour).filter(|c| c.points.len() > 2).collect();
            let mut try_out = |rounded: &[Rounded]| {
                let contours: Vec<Contour> = rounded.iter().map(Rounded::contour).collect();
                // Rounding may let parts overlap that nearly touch: the lines are compared, not what they fill.
                let drawn = Filled::lines_of_contours(&contours, self.options.sampling);
                let off = self.off(drawn, exact, index);
                if best.as_ref().is_none_or(|(least, _)| off < *least) {
                    best = Some((off, contours));
                }
                off <= self.options.tolerance
            };
            if try_out(&rounded) {
                break;
            }
            rounded.iter_mut().for_each(|r| polish::polish(r, index, self.options.tolerance));
            if try_out(&rounded) {
                break;
            }
            for part in LIMITS {
                let limit = part * self.options.tolerance;
                let is_settled = settle::settle(&mut rounded, exact, index, limit, self.face.units_per_em());
                if try_out(&rounded) {
                    break 'accuracies;
                }
                if !is_settled {
                    break;
                }
            }
        }
        let (off, contours) = best.ok_or("it has no outline")?;
        let data = glyf::encode(&contours).ok_or("its coordinates are too large for the format")?;
        let fate = if contours.is_empty() { Fate::Vanished } else { Fate::Changed };
        Ok(Done { written: contours, deviation: off, ..Done::new(fate, data) })
    }
}

fn region_box(region: &Region) -> [i16; 4] {
    let b = region.bounds();
    [b.min.x.floor(), b.min.y.floor(), b.max.x.ceil(), b.max.y.ceil()].map(|x| x as i16)
}
