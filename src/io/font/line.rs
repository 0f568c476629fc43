//! A line of text, set with the kerning and the ligatures of its font.

use harfrust::{ShapeOptions, ShaperData, UnicodeBuffer};
use skrifa::MetadataProvider as _;

use super::FontError;
use super::compose::flattened;
use super::contour::outline;
use super::face::{Face, Source};
use super::fill::{Filled, Sampling};
use super::glyf::Glyph;
use crate::io::svg::affine::Affine;
use crate::io::svg::outline::Outline;
use crate::io::svg::{Curves, Drawing, Page};
use crate::plane::Bounds;

/// One glyph of a line.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedGlyph {
    /// Its number in the font.
    pub glyph: u16,
    /// Where its origin is, in font units, y up.
    pub origin: [f64; 2],
    /// How far it takes the pen, in font units.
    pub advance: f64,
}

/// Sets `text` in one line: the glyphs from left to right.
///
/// # Errors
/// Where there is no text, more than one line of it, or characters that the font lacks.
pub fn shape(face: &Face, text: &str) -> Result<Vec<PlacedGlyph>, FontError> {
    if text.is_empty() {
        return Err(FontError::NoText);
    }
    if let Some(control) = text.chars().find(|c| c.is_control()) {
        return Err(FontError::NotOneLine(control));
    }
    let data = ShaperData::new(&face.reference);
    let shaper = data.shaper(&face.reference).build();
    let mut buffer = UnicodeBuffer::new();
    buffer.push_str(text);
    buffer.guess_segment_properties();
    let shaped = shaper.shape(buffer, ShapeOptions::new());
    let missing = missing(face, text, shaped.glyph_infos().iter().filter(|i| i.glyph_id == 0).map(|i| i.cluster));
    if !missing.is_empty() {
        return Err(FontError::MissingGlyphs(missing));
    }
    let mut pen = [0.0, 0.0];
    let placed = shaped.glyph_infos().iter().zip(shaped.glyph_positions()).map(|(info, position)| {
        let origin = [pen[0] + f64::from(position.x_offset), pen[1] + f64::from(position.y_offset)];
        pen[0] += f64::from(position.x_advance);
        pen[1] += f64::from(position.y_advance);
        PlacedGlyph { glyph: info.glyph_id as u16, origin, advance: f64::from(position.x_advance) }
    });
    Ok(placed.collect())
}

/// The characters that came out as glyph 0, each once, in the order of the text.
fn missing(face: &Face, text: &str, clusters: impl Iterator<Item = u32>) -> Vec<char> {
    let charmap = face.reference.charmap();
    let lost: Vec<u32> = clusters.collect();
    let mut missing = Vec::new();
    if lost.is_empty() {
        return missing;
    }
    for (at, c) in text.char_indices() {
        // A cluster may begin before the character that is not there.
        let is_lost = lost.contains(&(at as u32)) || charmap.map(c).is_none_or(|g| g.to_u32() == 0);
        let is_there = charmap.map(c).is_some_and(|g| g.to_u32() != 0);
        if is_lost && !is_there && !missing.contains(&c) {
            missing.push(c);
        }
    }
    // The font may lack only what the shaper made of a character.
    if missing.is_empty() {
        missing.extend(text.char_indices().find(|(at, _)| lost.contains(&(*at as u32))).map(|(_, c)| c));
    }
    missing
}

/// A line of `text` as a drawing in font units, its baseline starting at the origin: overlapping glyphs united, every vertex
/// with its source. The page holds the line from ascender to descender and all that reaches beyond; an em is `em_mm`
/// millimetres.
///
/// # Errors
/// As [`shape`], and where a glyph cannot be drawn.
pub fn line(face: &Face, text: &str, sampling: Sampling, em_mm: f64) -> Result<Drawing, FontError> {
    let glyphs = shape(face, text)?;
    let mut filled = Filled::default();
    for placed in &glyphs {
        let [x, y] = placed.origin;
        let glyph_outline = glyph_outline(face, placed.glyph)?;
        filled.add(&glyph_outline, &Affine::translation(x, -y), sampling, &format!("glyph {}", placed.glyph));
    }
    filled.unite();
    if filled.region.is_empty() {
        return Err(FontError::BlankText);
    }
    let (ascender, descender) = face.line_extent();
    let advance: f64 = glyphs.iter().map(|g| g.advance).sum();
    let frame = Bounds::of_points([[0.0, descender], [advance, ascender]].map(|[x, y]| crate::plane::Point::new(x, y)));
    // Whole units: kerning and overhang may leave the frame by a little.
    let ink = filled.region.bounds();
    let page = frame.union(ink);
    let (left, top) = (page.min.x.floor(), page.max.y.ceil());
    let (width, height) = (page.max.x.ceil() - left, top - page.min.y.floor());
    let mm_per_unit = em_mm / face.units_per_em();
    Ok(Drawing {
        region: filled.region,
        mm_per_unit: Some(mm_per_unit),
        page: Page {
            width: Some(format!("{}mm", width * mm_per_unit)),
            height: Some(format!("{}mm", height * mm_per_unit)),
            view_box: Some(format!("{left} {} {width} {height}", 0.0 - top)),
            preserve_aspect_ratio: None,
        },
        curves: Curves::Arcs,
        chord_tolerance: sampling.tolerance,
        sources: filled.sources,
        warnings: Vec::new(),
    })
}

fn glyph_outline(face: &Face, glyph: u16) -> Result<Outline, FontError> {
    let error = |problem| FontError::Glyph { glyph, problem };
    Ok(match face.source(glyph).map_err(error)? {
        Source::Cff(outline) => outline,
        Source::TrueType(Glyph::Empty) => Outline::default(),
        Source::TrueType(_) => outline(&flattened(face, glyph).map_err(error)?),
    })
}
