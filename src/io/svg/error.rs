//! Why a file cannot be read, and what of it was not used.

use std::fmt;
use std::path::PathBuf;

/// An element of the file.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Place {
    /// The element's name, such as `path`.
    pub element: String,
    /// Its `id`, where the file gives one.
    pub id: Option<String>,
    /// The line where it starts, counted from 1.
    pub line: usize,
}

/// Messages quote no more characters of an id than this.
const LONGEST_ID: usize = 40;

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "<{}", self.element)?;
        if let Some(id) = &self.id {
            write!(f, " id=\"{}\"", short(id))?;
        }
        write!(f, "> on line {}", self.line)
    }
}

/// As much of an id as is quoted.
fn short(id: &str) -> String {
    let rest = if id.chars().nth(LONGEST_ID).is_some() { "..." } else { "" };
    id.chars().take(LONGEST_ID).collect::<String>() + rest
}

fn meant(nearest: Option<&str>) -> String {
    match nearest {
        Some(id) => format!(": did you mean \"{}\"?", short(id)),
        None => ", nor any with an id like it: see the ids in your drawing program's object properties".to_owned(),
    }
}

fn nothing_chosen(id: Option<&str>) -> String {
    match id {
        Some(id) => format!(
            "the element with id=\"{}\" has no filled shape in it that is shown: fill it, or choose another",
            short(id)
        ),
        None => "no element is left to work on: choose fewer with --except, or others with --only".to_owned(),
    }
}

/// The largest coordinate that is taken for meant, in user units: a thousand kilometres of millimetres.
pub const MAX_COORDINATE: f64 = 1e9;

/// Why there is no drawing.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// No bytes.
    #[error("the file is empty: save the drawing again")]
    Empty,
    /// Compressed, or not text at all.
    #[error(
        "the file is not text (byte {offset} is no UTF-8): save the drawing as plain SVG in UTF-8, not as SVGZ or a picture"
    )]
    NotText {
        /// Where the text ends, in bytes.
        offset: usize,
    },
    /// The XML ends early.
    #[error("the file breaks off on line {line}: it may have been cut short while saving or copying; save it again")]
    CutOff {
        /// Where, counted from 1.
        line: u32,
    },
    /// The XML is broken.
    #[error("line {line}, column {column}: {reason}; repair the file, or save it again as plain SVG")]
    Malformed {
        /// Where, counted from 1.
        line: u32,
        /// Where, counted from 1.
        column: u32,
        /// The parser's words.
        reason: String,
    },
    /// XML or text, but no drawing.
    #[error("the file is no SVG drawing: {found}; export the drawing as plain SVG")]
    NotSvg {
        /// What is there instead.
        found: String,
    },
    /// `width`, `height` or `viewBox` are zero or negative.
    #[error("<svg> on line {line} has no valid size: width, height and the sides of viewBox must be above zero")]
    InvalidSize {
        /// Where the root element starts, counted from 1.
        line: usize,
    },
    /// Too many or too deeply nested elements.
    #[error(
        "the drawing has more elements, or deeper nested ones, than can be read: simplify it, and look for <use> elements \
         that show each other"
    )]
    TooLarge,
    /// A coordinate beyond [`MAX_COORDINATE`].
    #[error("{place} has the coordinate {value:e}, beyond 1e9 user units: repair or remove the element")]
    Huge {
        /// The element.
        place: Place,
        /// The coordinate.
        value: f64,
    },
    /// A dash pattern with too many dashes.
    #[error(
        "{place} has {dashes:.1e} dashes, more than 1e5 in the drawing: give it a longer stroke-dasharray, or none for a \
         solid stroke"
    )]
    TooManyDashes {
        /// The element with which the dashes are too many.
        place: Place,
        /// How many it has.
        dashes: f64,
    },
    /// Nothing is filled.
    #[error("the drawing has no filled shape{}", nothing(found))]
    NothingFilled {
        /// What is there instead.
        found: Found,
        /// What was left out on the way.
        warnings: Vec<Warning>,
    },
    /// A font file cannot be read.
    #[error("the font {} cannot be read: {reason}", path.display())]
    Font {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: std::io::Error,
    },
    /// An `id` that is not in the file.
    #[error("the drawing has no element with id=\"{}\"{}", short(id), meant(nearest.as_deref()))]
    UnknownId {
        /// What was asked for.
        id: String,
        /// The most like it that there is.
        nearest: Option<String>,
    },
    /// One `id` both chosen and left out.
    #[error("\"{}\" is named by both --only and --except: leave one of them out", short(id))]
    ContradictorySelection {
        /// Which.
        id: String,
    },
    /// Nothing to work on.
    #[error("{}", nothing_chosen(id.as_deref()))]
    NothingChosen {
        /// What was chosen and has nothing filled in it; none where everything was left out.
        id: Option<String>,
    },
    /// No outline in an element whose area was asked for.
    #[error("the element with id=\"{}\" has no area: name a closed shape, or a group of such", short(id))]
    NoArea {
        /// Which.
        id: String,
    },
    /// An option has no meaning.
    #[error("{name} is {value}: it must be a finite number above zero")]
    InvalidOption {
        /// Which.
        name: &'static str,
        /// Its value.
        value: f64,
    },
}

/// What a drawing without filled shape has instead.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// Shapes with a stroke and no fill.
    pub strokes: usize,
    /// Text elements that could not be set.
    pub texts: usize,
    /// Bitmaps.
    pub images: usize,
    /// Shapes that are not shown.
    pub hidden: usize,
    /// Shapes that have neither fill nor stroke, or no area.
    pub unpainted: usize,
}

fn nothing(found: &Found) -> String {
    let mut parts = Vec::new();
    let mut say = |count: usize, what: &str, which: &str, remedy: &str| {
        if count > 0 {
            parts.push(format!("{count} {what}{}{which} ({remedy})", if count == 1 { "" } else { "s" }));
        }
    };
    say(found.strokes, "stroke", "", "fill the shapes; or --strokes, which takes strokes as areas");
    say(found.texts, "text", " whose font is not installed", "name a font file with --font, or convert text to paths");
    say(found.images, "image", "", "trace images to paths");
    say(found.hidden, "hidden shape", "", "show the layer");
    say(found.unpainted, "shape", " without fill or area", "give it a fill");
    match parts.len() {
        0 => ": there is nothing in it; draw a closed shape and fill it".to_owned(),
        _ => format!(", only {}", parts.join(", ")),
    }
}

/// Something in the file that is not in the region.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Warning {
    /// Where.
    pub place: Place,
    /// What.
    pub kind: WarningKind,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.kind)
    }
}

/// What was not used, or not as it looks.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum WarningKind {
    /// A mask hides part of the drawing; here it does not.
    #[error("masks are not applied: what the mask hides is part of the outline; use a clip path")]
    Mask,
    /// A filter changes the drawing; here it does not.
    #[error("filters are not applied")]
    Filter,
    /// A bitmap.
    #[error("an image has no outline: trace it to paths")]
    Image,
    /// Shapes at the vertices of a line.
    #[error("markers are left out: convert them to paths")]
    Marker,
    /// `display:none`.
    #[error("hidden, with {shapes} shape(s): left out")]
    Hidden {
        /// How many shapes are in it.
        shapes: usize,
    },
    /// `visibility:hidden`.
    #[error("invisible: left out")]
    Invisible,
    /// Path data with an error in it.
    #[error("the path data breaks off at character {at}: what follows is left out")]
    PathCutShort {
        /// Where, counted in characters from 0.
        at: usize,
    },
    /// A reference to nothing.
    #[error("refers to \"{href}\", which is not in the file: left out")]
    UnresolvedUse {
        /// The reference.
        href: String,
    },
    /// A reference to itself.
    #[error("refers to \"{href}\" and is left out: the reference is circular or has nothing to show")]
    EmptyUse {
        /// The reference.
        href: String,
    },
    /// No font to set it in.
    #[error(
        "the text \"{text}\" is left out, as its font is not installed: name a file with --font, or convert text to paths"
    )]
    TextWithoutFont {
        /// The text.
        text: String,
    },
    /// Strokes that were not asked for.
    #[error("has a stroke and no fill: left out; fill it, or take strokes as areas with --strokes")]
    StrokeOnly,
    /// Strokes that were not asked for, on shapes that are filled. Said once, of the whole file.
    #[error(
        "{shapes} shape(s) in it have a stroke beside their fill: the fill alone is used; --strokes adds the stroke"
    )]
    StrokeBesideFill {
        /// How many shapes.
        shapes: usize,
    },
    /// Digits that went through single precision.
    #[error("its position is known to seven digits only (a transform or unit that needs context)")]
    SinglePrecision,
    /// A view box that cannot be read.
    #[error("viewBox=\"{text}\" is not four numbers with width and height above zero: the physical size is not known")]
    InvalidViewBox {
        /// What is there.
        text: String,
    },
    /// Text in a font that is not there.
    #[error("text asks for the font \"{asked}\", which is not installed: set in \"{taken}\"; --font names another")]
    FontReplaced {
        /// The family that the text asks for.
        asked: String,
        /// The family that it is set in.
        taken: String,
    },
    /// `preserveAspectRatio="none"` with different scales.
    #[error("the drawing is stretched unevenly (preserveAspectRatio=\"none\"): its physical size is not used")]
    UnevenScale,
}
