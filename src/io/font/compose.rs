//! Composite glyphs put together.

use super::contour::Contour;
use super::face::{Face, Source};
use super::glyf::{Composite, Glyph};

/// Components of components of components: more than any font has, and no room for a ring of them.
const DEEPEST: usize = 16;

/// Components of a glyph, those of its components included: more than any font has. Sixteen levels of a few components each
/// would be more than can ever be walked, and need not have a single point.
const MOST_COMPONENTS: usize = 1 << 14;

/// More points than the format can number.
const MOST_POINTS: usize = 1 << 16;

/// The contours of a composite, given those of its components.
///
/// # Errors
/// What is wrong with it.
pub(super) fn composed(
    composite: &Composite,
    mut contours_of: impl FnMut(u16) -> Result<Vec<Contour>, &'static str>,
) -> Result<Vec<Contour>, &'static str> {
    let mut all: Vec<Contour> = Vec::new();
    for component in &composite.components {
        let contours = contours_of(component.glyph)?;
        all.extend(component.placed(&contours, &all).ok_or("a component hangs on a point that is not there")?);
        if all.iter().map(Vec::len).sum::<usize>() > MOST_POINTS {
            return Err("it has more points than a glyph can have");
        }
    }
    Ok(all)
}

/// The contours of a TrueType glyph, those of its components included.
///
/// # Errors
/// What is wrong with it.
pub(super) fn flattened(face: &Face, glyph: u16) -> Result<Vec<Contour>, &'static str> {
    below(face, glyph, DEEPEST, &mut 0)
}

/// `visited` counts the components that were looked at.
fn below(face: &Face, glyph: u16, depth: usize, visited: &mut usize) -> Result<Vec<Contour>, &'static str> {
    match face.source(glyph)? {
        Source::TrueType(Glyph::Simple(simple)) => Ok(simple.contours),
        Source::TrueType(Glyph::Composite(composite)) => {
            let depth = depth.checked_sub(1).ok_or("it is a component of itself")?;
            composed(&composite, |g| {
                *visited += 1;
                if *visited > MOST_COMPONENTS {
                    return Err("it has more components than a glyph can have");
                }
                below(face, g, depth, visited)
            })
        }
        Source::TrueType(Glyph::Empty) | Source::Cff(_) => Ok(Vec::new()),
    }
}
