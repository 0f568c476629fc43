//! SVG drawings: read to a region that keeps the digits of the file, written back with the commands that did not change.
//!
//! What is read: every filled shape (paths, basic shapes, text), wherever transforms, nested `svg`, `use` and `symbol` put
//! it, by its own fill rule, cut down to its clip paths, all united into one [`Region`](crate::plane::Region); strokes as areas on request.
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
mod area;
mod collect;
mod document;
mod drawing;
mod elliptic;
mod error;
mod fill;
mod fonts;
mod gather;
mod joined;
mod known;
mod leftovers;
mod locate;
mod options;
pub(super) mod outline;
mod part;
mod parts;
mod placement;
mod rough;
pub(super) mod sample;
mod selection;
mod shape;
mod shapes;
mod stroke;
mod thin;
mod viewport;
mod write;

pub use animate::{Still, animate, animate_parts};
pub use area::read_area;
pub use drawing::{Curve, CurveKind, Drawing, RADIUS_ATTRIBUTE, Sources, VertexSource};
pub use error::{Found, MAX_COORDINATE, Place, ReadError, Warning, WarningKind};
pub use options::{Curves, DEFAULT_FLATTEN, ReadOptions, Strokes};
pub use parts::{Part, Parts, read_parts};
pub use selection::Selection;
pub use shapes::{Color, DrawnLine, DrawnShape, Shapes, read_shapes};
pub use viewport::Page;
pub use write::{write, write_parts};

use gather::{Gathered, gather};

/// Reads an SVG file.
///
/// # Errors
/// Where the file is broken or holds no filled shape; the error says where and what to try.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<Drawing, ReadError> {
    gather(bytes, options, None, whole)
}

/// Reads an SVG file that was made from `other`, to be compared with it: with the chord tolerance of `other` in place of
/// that of the options, and with the samples of `other` on its curves and on parts of them. So whatever of a curve was
/// kept has the same vertices in both drawings.
///
/// # Errors
/// As [`read`].
pub fn read_alike(bytes: &[u8], options: &ReadOptions, other: &Drawing) -> Result<Drawing, ReadError> {
    gather(bytes, options, Some(other), whole)
}

/// All items united.
fn whole(gathered: Gathered) -> Result<Drawing, ReadError> {
    let drawing = gathered.drawing(&gathered.collection.items);
    if drawing.region.is_empty() {
        return Err(gathered.nothing_filled());
    }
    let mm_per_unit = gathered.mm_per_unit(drawing.region.bounds().width());
    Ok(Drawing { mm_per_unit, warnings: gathered.collection.warnings, ..drawing })
}
