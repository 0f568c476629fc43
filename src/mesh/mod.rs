//! Surfaces in space: polygons as files hold them, triangles, half-edges to edit them by, and a hierarchy to ask for
//! distances.
//!
//! A surface has its solid on the inside: seen from outside, the corners of a face run counterclockwise.

mod half_edge;
mod hierarchy;
mod polygon_mesh;
mod triangle;
mod triangle_mesh;
mod triangulate;

pub use half_edge::{HalfEdgeMesh, NONE, NotManifold};
pub use hierarchy::{Hierarchy, Nearest};
pub use polygon_mesh::PolygonMesh;
pub use triangle::{Feature, nearest_on_triangle};
pub use triangle_mesh::TriangleMesh;

/// A place in space.
pub type Point = nalgebra::Point3<f64>;

/// A direction and a length in space.
pub type Vector = nalgebra::Vector3<f64>;
