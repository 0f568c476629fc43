//! A font, opened: its size, its metrics and where its glyphs are.

use skrifa::MetadataProvider as _;
use skrifa::outline::{DrawSettings, OutlineGlyphCollection, OutlinePen};
use skrifa::prelude::{GlyphId, LocationRef, Size};

use super::FontError;
use super::contour::y_down;
use super::glyf::{self, Glyph};
use super::names::{FontNames, Names};
use super::sfnt::{Sfnt, i16_at, u16_at, u32_at};
use crate::io::svg::outline::{Command, Outline};
use crate::plane::Point;

/// A font.
pub struct Face<'a> {
    pub(super) sfnt: Sfnt<'a>,
    pub(super) units_per_em: u16,
    pub(super) glyph_count: u16,
    /// How many glyphs have an advance of their own; the rest have the last one.
    pub(super) advance_count: u16,
    pub(super) hmtx: &'a [u8],
    glyphs: Glyphs<'a>,
    /// The file, as the crates for shaping and for CFF see it.
    pub(super) reference: skrifa::FontRef<'a>,
}

enum Glyphs<'a> {
    TrueType { glyf: &'a [u8], offsets: Vec<usize> },
    Cff(Box<OutlineGlyphCollection<'a>>),
}

/// Which outlines a font has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum OutlineFormat {
    /// Quadratic curves, in the table `glyf`.
    TrueType,
    /// Cubic curves, in the table `CFF `.
    Cff,
}

/// The outline of one glyph as the file has it.
pub(super) enum Source {
    TrueType(Glyph),
    /// Cubic curves, y down.
    Cff(Outline),
}

impl<'a> Face<'a> {
    /// Opens a font; `index` tells which one of a collection.
    ///
    /// # Errors
    /// Where it is no font, damaged, variable or without outlines.
    pub fn parse(bytes: &'a [u8], index: Option<u32>) -> Result<Face<'a>, FontError> {
        let sfnt = Sfnt::parse(bytes, index)?;
        if sfnt.tables.contains_key(b"fvar") {
            return Err(FontError::Variable);
        }
        let reference =
            skrifa::FontRef::from_index(bytes, sfnt.index).map_err(|e| FontError::NotAFont { found: e.to_string() })?;
        let head = sfnt.required(b"head", 54)?;
        let units_per_em = u16_at(head, 18).unwrap_or(0);
        if !(16..=16_384).contains(&units_per_em) {
            return Err(FontError::damaged(b"head", "has no valid size of the em"));
        }
        let glyph_count = u16_at(sfnt.required(b"maxp", 6)?, 4).unwrap_or(0);
        let advance_count = u16_at(sfnt.required(b"hhea", 36)?, 34).unwrap_or(0);
        let bearings = usize::from(glyph_count).checked_sub(usize::from(advance_count));
        let (Some(bearings), true) = (bearings, advance_count > 0) else {
            return Err(FontError::damaged(b"hhea", "counts more advances than there are glyphs, or none"));
        };
        let hmtx = sfnt.required(b"hmtx", 4 * usize::from(advance_count) + 2 * bearings)?;
        let glyphs = if sfnt.tables.contains_key(b"glyf") {
            let glyf = sfnt.required(b"glyf", 0)?;
            let long = u16_at(head, 50) == Some(1);
            let count = usize::from(glyph_count) + 1;
            let loca = sfnt.required(b"loca", count * if long { 4 } else { 2 })?;
            let offset = |k: usize| {
                if long {
                    u32_at(loca, 4 * k).unwrap_or(0) as usize
                } else {
                    2 * usize::from(u16_at(loca, 2 * k).unwrap_or(0))
                }
            };
            let offsets: Vec<usize> = (0..count).map(offset).collect();
            if !offsets.is_sorted() || offsets.last().is_some_and(|end| *end > glyf.len()) {
                return Err(FontError::damaged(b"loca", "contradicts the table 'glyf'"));
            }
            Glyphs::TrueType { glyf, offsets }
        } else if sfnt.tables.contains_key(b"CFF ") || sfnt.tables.contains_key(b"CFF2") {
            Glyphs::Cff(Box::new(reference.outline_glyphs()))
        } else {
            return Err(FontError::NoOutlines);
        };
        Ok(Face { sfnt, units_per_em, glyph_count, advance_count, hmtx, glyphs, reference })
    }

    /// Font units in an em.
    pub fn units_per_em(&self) -> f64 {
        f64::from(self.units_per_em)
    }

    /// How many glyphs there are.
    pub fn glyph_count(&self) -> usize {
        usize::from(self.glyph_count)
    }

    /// What it is called.
    ///
    /// # Errors
    /// Where its names are damaged.
    pub fn names(&self) -> Result<FontNames, FontError> {
        Ok(Names::parse(self.sfnt.required(b"name", 6)?)?.summary())
    }

    /// Whether it has a glyph for a character.
    pub fn has_glyph(&self, c: char) -> bool {
        self.reference.charmap().map(c).is_some_and(|glyph| glyph.to_u32() != 0)
    }

    /// The number of a glyph with the first character that it stands for: `36 (A)`.
    pub fn glyph_label(&self, glyph: u16) -> String {
        let stands_for = |&(_, g): &(u32, GlyphId)| g.to_u32() == u32::from(glyph);
        let character = self.reference.charmap().mappings().find(stands_for).and_then(|(c, _)| char::from_u32(c));
        match character.filter(|c| !c.is_control() && !c.is_whitespace()) {
            Some(c) => format!("{glyph} ({c})"),
            None => glyph.to_string(),
        }
    }

    /// Which outlines it has.
    pub fn format(&self) -> OutlineFormat {
        match self.glyphs {
            Glyphs::TrueType { .. } => OutlineFormat::TrueType,
            Glyphs::Cff(_) => OutlineFormat::Cff,
        }
    }

    /// The line of text from the highest to the lowest place that the font keeps free: ascender and descender.
    pub fn line_extent(&self) -> (f64, f64) {
        let hhea = self.sfnt.tables[b"hhea"];
        let at = |place| f64::from(i16_at(hhea, place).unwrap_or(0));
        let (ascender, descender) = (at(4), at(6));
        if ascender > descender { (ascender, descender) } else { (self.units_per_em(), 0.0) }
    }

    /// The advance of a glyph.
    pub(super) fn advance(&self, glyph: u16) -> u16 {
        let k = glyph.min(self.advance_count - 1);
        u16_at(self.hmtx, 4 * usize::from(k)).unwrap_or(0)
    }

    /// Where the left bearing of a glyph stands in `hmtx`.
    pub(super) fn bearing_at(&self, glyph: u16) -> usize {
        bearing_at(glyph, self.advance_count)
    }

    /// What the file says of a glyph.
    pub(super) fn source(&self, glyph: u16) -> Result<Source, &'static str> {
        match &self.glyphs {
            Glyphs::TrueType { glyf, offsets } => {
                let (from, to) = (offsets.get(usize::from(glyph)), offsets.get(usize::from(glyph) + 1));
                let data = from.zip(to).and_then(|(from, to)| glyf.get(*from..*to));
                glyf::parse(data.ok_or("there is no such glyph")?).map(Source::TrueType)
            }
            Glyphs::Cff(outlines) => {
                let mut pen = Pen::default();
                if let Some(found) = outlines.get(GlyphId::from(glyph)) {
                    let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
                    found.draw(settings, &mut pen).map_err(|_| "its data is damaged")?;
                }
                Ok(Source::Cff(pen.finished()))
            }
        }
    }
}

/// Where the bearing of a glyph stands in `hmtx` or `vmtx`.
pub(super) fn bearing_at(glyph: u16, advance_count: u16) -> usize {
    if glyph < advance_count {
        4 * usize::from(glyph) + 2
    } else {
        4 * usize::from(advance_count) + 2 * usize::from(glyph - advance_count)
    }
}

/// Collects the outline of a CFF glyph.
#[derive(Default)]
struct Pen {
    outline: Outline,
}

impl Pen {
    fn finished(mut self) -> Outline {
        self.end();
        self.outline
    }

    /// Closes what is open by a line of its own.
    fn end(&mut self) {
        if let Some(subpath) = self.outline.subpaths.last()
            && !subpath.closed
        {
            let start = subpath.start;
            if self.outline.pen() != Some(start) {
                self.outline.push(Command::Line(start));
            }
            self.outline.close();
        }
    }
}

fn point(x: f32, y: f32) -> Point {
    y_down(Point::new(f64::from(x), f64::from(y)))
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.end();
        self.outline.move_to(point(x, y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.outline.push(Command::Line(point(x, y)));
    }

    fn quad_to(&mut self, cx0: f32, cy0: f32, x: f32, y: f32) {
        self.outline.push(Command::Quadratic(point(cx0, cy0), point(x, y)));
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        self.outline.push(Command::Cubic(point(cx0, cy0), point(cx1, cy1), point(x, y)));
    }

    fn close(&mut self) {
        self.end();
    }
}
