//! Pictures of programs, as they were read back, of outlines and fonts, of surfaces, and of the states of a flow: as a sheet or
//! in motion. A [`page`] tells all about a program to a browser.
//!
//! The same input gives the same bytes.

mod animation;
mod canvas;
mod contact;
mod cut_stock;
mod frame;
mod indexed;
mod lettering;
mod mesh;
mod mesh_raster;
mod mesh_view;
mod outline;
mod page;
mod palette;
mod program;
mod sheet;
mod specimen;
mod state;

pub use animation::{Picture, animation};
pub use contact::{Cell, contact_sheet};
pub use cut_stock::{cut_level, cut_stock};
pub use frame::{Frame, time_captions};
pub use mesh::{MeshStyle, mesh, meshes};
pub use mesh_raster::Shading;
pub use outline::outline;
pub use page::{Difference, Outline, Page, PageFinding, PageOperation, PageProgram, PageTool, page};
pub use program::{Scene, program};
pub use sheet::DEFAULT_SIZE;
pub use specimen::{SpecimenRow, specimen};

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PreviewError {
    /// Nothing to show, or coordinates that are no numbers.
    #[error("there is nothing to draw: the outlines and the program are empty, or their coordinates are not finite")]
    Nothing,
    /// A size that no picture can have.
    #[error("a picture of {width} by {height} pixels cannot be made: choose a size from 64 to 16384")]
    Size {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// The file could not be made.
    #[error("the picture could not be encoded: {0}")]
    Encoding(String),
}
