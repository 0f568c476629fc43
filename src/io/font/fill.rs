//! Outlines to regions: sampled, overlapping contours united, every vertex with its source.

use super::FontError;
use super::contour::{self, Contour};
use crate::io::svg::affine::Affine;
use crate::io::svg::outline::Outline;
use crate::io::svg::sample::{self, Meetings};
use crate::io::svg::{Curves, Place, Sources};
use crate::io::unite::{self, Rule};
use crate::plane::{Region, Ring};
use crate::units::Radius;

/// How far the chords may stray from the curves of letters, in parts of the em: a hundredth of a unit of a thousand.
pub const CHORD_TOLERANCE: f64 = 1e-5;

/// What a disk may cut off the turn between two commands, in parts of the em, for the turn to count as the rounding of
/// coordinates to whole units: a fiftieth of a unit of a thousand.
const UNSEEN_CUT: f64 = 2e-5;

/// No turn beyond this (radians) is rounding.
const SHARPEST_MEETING: f64 = 0.1;

/// How the outlines of a font are sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// How far chords stray from curves, in font units.
    pub tolerance: f64,
    /// Commands that meet at no greater angle, in radians, meet smoothly.
    pub smooth_angle: f64,
}

impl Sampling {
    /// For a disk of `radius`, both in font units: a turn δ loses r (1/cos(δ/2) - 1), nearly r δ²/8, to it.
    pub fn new(units_per_em: f64, radius: f64) -> Sampling {
        let smooth_angle = (8.0 * UNSEEN_CUT * units_per_em / radius).sqrt().min(SHARPEST_MEETING);
        Sampling { tolerance: CHORD_TOLERANCE * units_per_em, smooth_angle }
    }
}

/// A glyph or a line of text as a region that knows its curves.
#[derive(Clone, Debug, Default)]
pub(super) struct Filled {
    pub region: Region,
    pub sources: Sources,
}

impl Filled {
    /// What one outline fills by the nonzero rule, added: what several fill is united by [`Filled::unite`].
    pub fn add(&mut self, outline: &Outline, affine: &Affine, sampling: Sampling, name: &str) {
        let rings = self.rings(outline, affine, sampling, name);
        self.region.rings.extend(unite::resolve(rings, Rule::NonZero));
    }

    /// The rings of an outline, which may cross.
    fn rings(&mut self, outline: &Outline, affine: &Affine, sampling: Sampling, name: &str) -> Vec<Ring> {
        let element = self.sources.elements.len() as u32;
        let place = Place { element: name.to_owned(), id: None, line: 1 };
        self.sources.elements = self.sources.elements.iter().cloned().chain([place]).collect();
        let sampling = sample::Sampling {
            tolerance: sampling.tolerance,
            curves: Curves::Arcs,
            meetings: Meetings::All(sampling.smooth_angle),
            known: None,
        };
        sample::rings(outline, affine, sampling, element, &mut self.sources)
    }

    /// Unites what overlaps.
    pub fn unite(&mut self) {
        self.region.rings = unite::resolve(std::mem::take(&mut self.region.rings), Rule::AtLeast(1));
    }

    /// What an outline fills.
    pub fn of_outline(outline: &Outline, sampling: Sampling) -> Filled {
        let mut filled = Filled::default();
        filled.add(outline, &Affine::IDENTITY, sampling, "glyph");
        filled
    }

    /// The lines that contours draw, what overlaps not united.
    pub fn lines_of_contours(contours: &[Contour], sampling: Sampling) -> Region {
        let mut filled = Filled::default();
        Region::new(filled.rings(&contour::outline(contours), &Affine::IDENTITY, sampling, "glyph"))
    }

    /// What contours fill.
    pub fn of_contours(contours: &[Contour], sampling: Sampling) -> Filled {
        Filled::of_outline(&contour::outline(contours), sampling)
    }
}

/// Refuses a radius (in font units) that is no radius, or larger than the em.
///
/// # Errors
/// In both cases.
pub fn check_radius(radius: f64, units_per_em: f64) -> Result<Radius, FontError> {
    let error = FontError::Radius { radius, units_per_em };
    Radius::new(radius).ok().filter(|r| r.get() <= units_per_em).ok_or(error)
}
