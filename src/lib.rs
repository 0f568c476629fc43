//! Outlines to milling programs that are checked before anything is cut; morphological closing and opening without
//! dilating and eroding, after Sellán, Kesten, Sheng and Jacobson, "Opening and Closing Surfaces" (2020).
//!
//! The promise: what need not move does not move, bit for bit; what moves is right to the last digits; and the program
//! says what the result will differ by before anything is cut.
//!
//! # The way of the data
//!
//! `drawing.svg` → [`io::svg`] (user units, fill rules resolved) → [`plane::Region`] → [`rolling`] (arcs and untouched pieces) →
//! [`cam`] (a toolpath with exact arcs) → [`gcode`] (text) → read back → lint, certificate, [`preview`]. The certificate and the
//! picture are made from the text that the machine gets.
//!
//! ```
//! use clopen::io::svg::{ReadOptions, read, write};
//! use clopen::rolling::{Topology, close};
//! use clopen::units::Radius;
//!
//! let svg = br#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 10 10"><path d="M0,0H10V4H4V10H0Z"/></svg>"#;
//! let drawing = read(svg, &ReadOptions::default())?;
//! let closed = close(&drawing.region, Radius::new(1.5)?, Topology::Keep);
//! assert!(closed.differences.is_empty());
//! assert!(write(&drawing, &closed.region).contains("A1.5"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The rooms
//!
//! Each imports only those above it that it names in its own documentation; a test keeps it so.
//!
//! - [`units`]: lengths, radii and feeds, typed, parsed once;
//! - [`plane`]: points, arcs, rings, regions, distance;
//! - [`linalg`]: the linear systems of the flow's step;
//! - [`mesh`]: surfaces in space: half-edges, hierarchies of triangles;
//! - [`flow`]: the flow whose limits closing and opening are, with its states on the way;
//! - [`rolling`]: the closing, directly: a disk rolls on the outline, exactly; a ball on the surface;
//! - [`mod@reference`]: the closing by polygon offsetting, sharing no code with `rolling`, and a witness by distances; surfaces on a grid;
//! - [`check`]: a result against its reference; features that are lost;
//! - [`io`]: SVG in and out, as an animation too; surfaces in and out; grey pictures in; fonts;
//! - [`cam`]: job, offset, order, toolpath; what a program's motions cut, and how long they take;
//! - [`gcode`]: the text of programs: dialects, writer, reader, lint;
//! - [`preview`]: pictures of drawings, of their states in a flow, of surfaces, and of programs;
//! - [`cli`]: the command: alone knows clap and terminals.
//!
//! Below them all, `threads`: work on several threads, the same bytes as on one.

pub mod cam;
pub mod check;
pub mod cli;
pub mod flow;
pub mod gcode;
pub mod io;
pub mod linalg;
pub mod mesh;
pub mod plane;
pub mod preview;
pub mod reference;
pub mod rolling;
mod threads;
pub mod units;
