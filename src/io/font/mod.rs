//! Letters: a line of text as a drawing, and a whole font through an operation.
//!
//! What is guaranteed of a restyled font ([`restyle`]):
//!
//! - glyphs that the operation does not move keep their bytes, without instructions; the others are within a stated
//!   distance of the exact result, in whole units, which is measured and told;
//! - a composite draws what the operation makes of its own outline; it stays a composite where its components give that;
//! - advances, kerning, `cmap`, `GSUB`, `GPOS` and every other table that does not speak of outlines stay byte for byte;
//! - instructions and all that belongs to them are gone: kept, they would pull new outlines to where old ones were;
//! - names 1, 3, 4, 6, 16 (and 18, 20, 21) are new, the revision is raised in `head` and in name 5, all else of the names stays;
//! - the same font gives the same bytes, whatever the number of threads: its date stays, too.
//!
//! Refused: variable fonts, web fonts, fonts without outlines, fonts whose OS/2 fsType says restricted, names that the licence
//! reserves. What else a licence says no program can judge: its text is in the report.

mod compose;
mod contour;
mod deviation;
mod error;
mod face;
mod fill;
mod glyf;
mod grid;
mod line;
mod names;
mod polish;
mod quadratics;
mod restyle;
mod settle;
mod sfnt;
mod stroke;
mod tables;
mod trace;
mod window;

pub use error::FontError;
pub use face::{Face, OutlineFormat};
pub use fill::{CHORD_TOLERANCE, Sampling, check_radius};
pub use line::{PlacedGlyph, line, shape};
pub use names::FontNames;
pub use restyle::{Fate, Operation, RestyleOptions};
pub use tables::{Restyled, restyle};

/// Default tolerance in parts of the em: half a unit of a thousand.
pub const DEFAULT_TOLERANCE: f64 = 5e-4;
