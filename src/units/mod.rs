//! Lengths, radii, speeds and words as people write them; millimetres and `f64` inside.
//!
//! A length is parsed once, at the edge of the program, and resolved once against the drawing it is meant for.

mod brief;
mod font_length;
mod length;
mod nearest;
mod radius;
mod speed;

pub use brief::Brief;
pub use font_length::{FontLength, ParseFontLengthError};
pub use length::{DrawingScale, Length, ParseLengthError, ResolveLengthError};
pub use nearest::{nearest, nearest_name};
pub use radius::{InvalidRadius, Radius};
pub use speed::{ParseSpeedError, Speed};

/// Millimetres in an inch.
pub const MM_PER_INCH: f64 = 25.4;

/// CSS pixels in an inch: what SVG means by `px` and by numbers without a unit in `width` and `height`.
pub const PX_PER_INCH: f64 = 96.0;
