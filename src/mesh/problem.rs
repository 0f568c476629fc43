//! What can be wrong with a surface.

use std::fmt;

/// What becomes of a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// A surface may be so.
    Allowed,
    /// [`repair`](super::repair()) mends it without a choice to make.
    Repairable,
    /// It needs someone who knows what was meant.
    Refused,
}

/// Something that is wrong with a surface, or at least worth saying. Vertices and polygons are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Problem {
    /// There are no polygons.
    Empty,
    /// A corner that is no vertex.
    NoSuchVertex {
        /// Whose corner.
        polygon: u32,
        /// The number of the vertex.
        vertex: u32,
    },
    /// A coordinate that is infinite or no number.
    NotFinite {
        /// Whose.
        vertex: u32,
    },
    /// A corner that follows itself, or a polygon of fewer than three different corners.
    RepeatedCorner {
        /// Whose corner.
        polygon: u32,
        /// The corner.
        vertex: u32,
    },
    /// A polygon that comes back to a corner so that one of its triangles has that corner twice.
    Tangled {
        /// Which one.
        polygon: u32,
        /// The corner.
        vertex: u32,
    },
    /// The same polygon again.
    Duplicate {
        /// The later one.
        polygon: u32,
        /// The earlier one.
        of: u32,
    },
    /// The same polygon again, with its corners the other way round.
    TurnedDuplicate {
        /// The later one.
        polygon: u32,
        /// The earlier one.
        of: u32,
    },
    /// A vertex of no polygon.
    Unused {
        /// Which one.
        vertex: u32,
    },
    /// Three polygons or more at an edge.
    NonManifoldEdge {
        /// One end.
        a: u32,
        /// The other one.
        b: u32,
        /// How many.
        polygons: u32,
    },
    /// Surfaces that touch in a vertex.
    NonManifoldVertex {
        /// Which one.
        vertex: u32,
        /// How many.
        fans: u32,
    },
    /// Neighbours that are oriented against each other.
    Inconsistent {
        /// One of them.
        polygon: u32,
        /// The other one.
        neighbour: u32,
    },
    /// A one-sided surface, like that of Möbius: no orientation is consistent.
    OneSided {
        /// One of its polygons.
        polygon: u32,
    },
    /// A closed component with its normals inward that is no cavity of another one.
    InsideOut {
        /// One of its polygons.
        polygon: u32,
        /// How many it has.
        polygons: u32,
    },
    /// A boundary: its vertices will be pinned.
    Boundary {
        /// A vertex on it.
        vertex: u32,
        /// How many edges it has.
        edges: u32,
    },
    /// A polygon that is without area, or one of its triangles: it has no normal.
    ZeroArea {
        /// Which one.
        polygon: u32,
        /// Whether no other polygon is at its edges: only then can it be left out without a crack.
        is_alone: bool,
    },
    /// Vertices on borders that lie exactly where others do: what looks closed may be open between them.
    Unwelded {
        /// The first of them that lies where an earlier one does.
        vertex: u32,
        /// How many of them.
        vertices: u32,
    },
    /// Polygons of separate bodies that lie on each other.
    Coincident {
        /// One of them.
        polygon: u32,
        /// The other one.
        other: u32,
    },
    /// Polygons that pass through each other, or one through itself.
    SelfIntersection {
        /// One of them.
        polygon: u32,
        /// The other one.
        other: u32,
    },
}

impl Problem {
    /// What becomes of it.
    pub fn severity(&self) -> Severity {
        match self {
            Problem::RepeatedCorner { .. }
            | Problem::Duplicate { .. }
            | Problem::Unused { .. }
            | Problem::Inconsistent { .. }
            | Problem::ZeroArea { is_alone: true, .. } => Severity::Repairable,
            Problem::Boundary { .. }
            | Problem::ZeroArea { .. }
            | Problem::Unwelded { .. }
            | Problem::Coincident { .. }
            | Problem::SelfIntersection { .. } => Severity::Allowed,
            Problem::Empty
            | Problem::NoSuchVertex { .. }
            | Problem::NotFinite { .. }
            | Problem::Tangled { .. }
            | Problem::TurnedDuplicate { .. }
            | Problem::NonManifoldEdge { .. }
            | Problem::NonManifoldVertex { .. }
            | Problem::OneSided { .. }
            | Problem::InsideOut { .. } => Severity::Refused,
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Problem::Empty => write!(f, "the surface has no faces"),
            Problem::NoSuchVertex { polygon, vertex } => {
                write!(f, "face {polygon} has the corner {vertex}, which is no vertex")
            }
            Problem::NotFinite { vertex } => write!(f, "vertex {vertex} has a coordinate that is not finite"),
            Problem::RepeatedCorner { polygon, vertex } => write!(f, "face {polygon} repeats its corner {vertex}"),
            Problem::Tangled { polygon, vertex } => {
                write!(f, "face {polygon} comes back to its corner {vertex}: cut it into simple faces")
            }
            Problem::Duplicate { polygon, of } => write!(f, "face {polygon} is face {of} again"),
            Problem::TurnedDuplicate { polygon, of } => {
                write!(f, "face {polygon} is face {of} turned over: remove one of them, or both")
            }
            Problem::Unused { vertex } => write!(f, "vertex {vertex} belongs to no face"),
            Problem::NonManifoldEdge { a, b, polygons } => {
                write!(f, "{polygons} faces meet at the edge from vertex {a} to vertex {b}: separate them")
            }
            Problem::NonManifoldVertex { vertex, fans } => {
                write!(f, "{fans} surfaces touch in vertex {vertex}: give each its own vertex there")
            }
            Problem::Inconsistent { polygon, neighbour } => {
                write!(f, "faces {polygon} and {neighbour} are neighbours and oriented against each other")
            }
            Problem::OneSided { polygon } => write!(f, "the surface of face {polygon} has one side only: cut it"),
            Problem::InsideOut { polygon, polygons } => write!(
                f,
                "the component of face {polygon} ({polygons} faces) is inside out, and no cavity of another one: reverse its \
                 faces if that was not meant"
            ),
            Problem::Boundary { vertex, edges } => {
                write!(f, "the surface has a boundary of {edges} edges at vertex {vertex}: its vertices are pinned")
            }
            Problem::ZeroArea { polygon, .. } => write!(f, "face {polygon} has no area, or a part of it has none"),
            Problem::Unwelded { vertex, vertices: 1 } => {
                write!(f, "vertex {vertex}, on a border, lies exactly where another one does: --repair welds them")
            }
            Problem::Unwelded { vertices, .. } => write!(
                f,
                "{vertices} vertices on borders lie exactly where others do, so that the surface is open there: --repair welds them"
            ),
            Problem::Coincident { polygon, other } => {
                write!(f, "faces {polygon} and {other} of separate bodies lie on each other: unite the bodies first")
            }
            Problem::SelfIntersection { polygon, other } if polygon == other => {
                write!(f, "face {polygon} is folded onto itself")
            }
            Problem::SelfIntersection { polygon, other } => {
                write!(f, "faces {polygon} and {other} pass through each other")
            }
        }
    }
}
