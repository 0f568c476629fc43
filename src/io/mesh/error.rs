//! Why a file with a surface cannot be read.

use std::fmt;

use super::MeshFormat;

/// Where in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of text, counted from 1.
    Line(usize),
    /// A byte of a binary file, and the element that it belongs to; both counted from 0.
    Byte {
        /// How many bytes come before.
        byte: usize,
        /// What is there: `vertex`, `face`, `triangle`.
        element: &'static str,
        /// Which of them.
        number: usize,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Line(line) => write!(f, "line {line}"),
            Place::Byte { byte, element, number } => write!(f, "byte {byte} ({element} {number}, counted from 0)"),
        }
    }
}

/// Why a file with a surface cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// Nothing but white space.
    #[error("the file is empty: export the mesh again")]
    Empty,
    /// More than 4 GiB.
    #[error("the file has more than 4 GiB: decimate the mesh, or write it as binary PLY")]
    TooLarge,
    /// The name says one format, the bytes another.
    #[error("the file is called {expected} but is {found}: rename it to end with .{}", found.to_string().to_lowercase())]
    OtherFormat {
        /// What was asked for.
        expected: MeshFormat,
        /// What it looks like.
        found: MeshFormat,
    },
    /// The file ends too early.
    #[error(
        "{place}: the file breaks off{}: it was cut short while saving or copying; export it again",
        before(missing)
    )]
    Truncated {
        /// Where it ends.
        place: Place,
        /// What should have followed.
        missing: String,
    },
    /// Something follows after the end.
    #[error(
        "{place}: the surface is complete, but something follows: the file is mixed with another or its header is wrong; \
         export it again"
    )]
    Trailing {
        /// Where the surface is complete.
        place: Place,
    },
    /// Something else stands where this must be.
    #[error("{place}: {found} stands where {expected} must be; repair the line or export the mesh again")]
    Unexpected {
        /// Where.
        place: Place,
        /// What is there.
        found: String,
        /// What must be there.
        expected: &'static str,
    },
    /// A number that is infinite or none at all.
    #[error("{place}: {what} is {value}, not a finite number: repair or remove that vertex")]
    NotFinite {
        /// Where.
        place: Place,
        /// Whose number.
        what: &'static str,
        /// What is there.
        value: String,
    },
    /// A corner without its vertex.
    #[error("{place}: a face has the corner {corner}, but there are {vertices} vertices{}", first(*.from))]
    NoSuchVertex {
        /// Where.
        place: Place,
        /// The number in the file.
        corner: i64,
        /// How many vertices there are.
        vertices: usize,
        /// The number of the first vertex: 1 in OBJ, 0 in PLY.
        from: u8,
    },
    /// A face with one or two corners.
    #[error("{place}: a face has {corners} corner{}, and needs three; remove it or export the mesh again", plural(*corners))]
    FewCorners {
        /// Where.
        place: Place,
        /// How many.
        corners: usize,
    },
    /// A face that comes back to its corners again and again.
    #[error(
        "face {face} (counted from 0) has {corners} corners at no more than {vertices} vertices: it comes back to them again and again; cut \
         it into simple faces"
    )]
    Tangled {
        /// Which one.
        face: usize,
        /// How many corners it has.
        corners: usize,
        /// At how many vertices.
        vertices: usize,
    },
    /// A count that the file has no room for.
    #[error(
        "{place}: the header promises {count} of \"{element}\", which the {left} bytes that follow cannot hold: the file was cut \
         short, or its header is wrong; export it again"
    )]
    Count {
        /// Where.
        place: Place,
        /// Of what.
        element: String,
        /// How many.
        count: u64,
        /// How many bytes there are for them.
        left: usize,
    },
    /// The header of a PLY lacks something.
    #[error("the PLY header has no {missing}: export the mesh again, with faces and coordinates")]
    Header {
        /// What.
        missing: &'static str,
    },
    /// Points alone, or nothing.
    #[error("the file has no faces ({vertices} vertices): export a surface, not a cloud of points, curves or strips")]
    NoFaces {
        /// How many vertices there are.
        vertices: usize,
    },
}

fn before(missing: &str) -> String {
    if missing.is_empty() { String::new() } else { format!(" before {missing}") }
}

fn first(from: u8) -> &'static str {
    match from {
        0 => ", counted from 0; export the mesh again",
        _ => ", counted from 1 (or backwards from -1); export the mesh again",
    }
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}

/// Messages quote no more characters of a word than this.
const LONGEST_WORD: usize = 30;

/// A word of the file as messages quote it.
pub(super) fn quoted(word: &[u8]) -> String {
    let text = String::from_utf8_lossy(&word[..word.len().min(4 * LONGEST_WORD)]);
    let mut shown: String = text.chars().take(LONGEST_WORD).flat_map(char::escape_debug).collect();
    if text.chars().nth(LONGEST_WORD).is_some() {
        shown.push('…');
    }
    format!("\"{shown}\"")
}
