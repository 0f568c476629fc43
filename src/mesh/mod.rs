//! Surfaces in space: polygons as files hold them, triangles, half-edges to edit them by, and a hierarchy to ask for
//! distances.
//!
//! A surface has its solid on the inside: seen from outside, the corners of a face run counterclockwise.

mod clean;
mod cut;
mod disk;
mod fans;
mod half_edge;
mod hierarchy;
mod intersect;
mod offset;
mod polygon_mesh;
mod problem;
mod repair;
mod topology;
mod triangle;
mod triangle_mesh;
mod triangulate;
mod validate;

pub use cut::{Cap, CutError, CutPlane, CutSurface, cut};
pub use half_edge::{HalfEdgeMesh, NONE, NotManifold};
pub use hierarchy::{Hierarchy, Nearest, Neighbourhood};
pub use intersect::{cross, self_intersections, self_intersections_of};
pub use offset::{FARTHEST, OffsetError, Thickness, offset, offset_part};
pub use polygon_mesh::PolygonMesh;
pub use problem::{Problem, Severity};
pub use repair::{Repair, repair};
pub use triangle::{Feature, nearest_on_triangle};
pub use triangle_mesh::TriangleMesh;
pub use validate::{MOST_INTERSECTIONS, problems};

/// A place in space.
pub type Point = nalgebra::Point3<f64>;

/// A direction and a length in space.
pub type Vector = nalgebra::Vector3<f64>;
