//! What can be wrong with a font.

use crate::units::Brief;

/// Why a font cannot be read, set or restyled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FontError {
    /// The file is none.
    #[error("it is no TrueType or OpenType font ({found}); name a .ttf or .otf file")]
    NotAFont {
        /// What was found instead.
        found: String,
    },
    /// A web font.
    #[error("it is a compressed web font (WOFF): unpack it to .ttf or .otf first, for example with woff2_decompress")]
    WebFont,
    /// The number of a font in a collection.
    #[error("it is a collection of {count} fonts: choose one with --index 0 to {}", count.saturating_sub(1))]
    Collection {
        /// How many there are.
        count: u32,
    },
    /// A number, but no collection.
    #[error("it is one font and no collection: leave out --index")]
    NoCollection,
    /// A table is absent, cut off or contradicts others.
    #[error("its table '{table}' {problem}; the font is damaged: try to open it in a font editor and export it again")]
    Damaged {
        /// The tag.
        table: String,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// No outlines.
    #[error("it has no outlines (no table glyf or CFF): a font of bitmaps cannot be restyled")]
    NoOutlines,
    /// An axis to vary along.
    #[error("it is a variable font: make an instance of it first, for example with fonttools varLib.instancer")]
    Variable,
    /// The owner says no.
    #[error("its owner forbids modification (OS/2 fsType {0:#06x}, restricted licence): ask for permission")]
    Restricted(u16),
    /// Nothing to set.
    #[error("there is no text to set: give a word, for example clopen text \"Quartz\" --font F.ttf")]
    NoText,
    /// Text without a mark.
    #[error("the text is blank: nothing in it has an outline")]
    BlankText,
    /// Characters that the font lacks.
    #[error("the font has no glyph for {}: choose another font or other words", listed(.0))]
    MissingGlyphs(Vec<char>),
    /// A line break.
    #[error("the text has a line break or control character (U+{:04X}): one line at a time", u32::from(*.0))]
    NotOneLine(char),
    /// A glyph that cannot be drawn.
    #[error("glyph {glyph} cannot be drawn: {problem}")]
    Glyph {
        /// Its number.
        glyph: u16,
        /// Why.
        problem: &'static str,
    },
    /// A disk larger than the letters, or none.
    #[error("a radius of {} font units is not between 0 and the em, which is {units_per_em}: try a few hundredths of it, for \
         example 30em/1000",
        Brief(*radius))]
    Radius {
        /// In font units.
        radius: f64,
        /// Font units in an em.
        units_per_em: f64,
    },
    /// A name that the font must not have.
    #[error("{0}")]
    Name(String),
}

impl FontError {
    pub(super) fn damaged(tag: &[u8; 4], problem: &'static str) -> FontError {
        FontError::Damaged { table: String::from_utf8_lossy(tag).into_owned(), problem }
    }
}

fn listed(characters: &[char]) -> String {
    let named: Vec<String> = characters.iter().map(|c| format!("'{c}' (U+{:04X})", u32::from(*c))).collect();
    named.join(", ")
}
