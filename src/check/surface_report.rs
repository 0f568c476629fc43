//! What a check of a surface found.

use crate::reference::Operation;

/// A place for reports: x, y and z in the units of the mesh.
pub type SurfacePlace = [f64; 3];

/// The result of [`surface`](super::surface). Lengths are in the units of the mesh (`_units`), in edge lengths (`_over_h`) or in
/// radii (`_over_r`). The output has *moved* where it is more than [`MOVED`](super::MOVED) diagonals from the input.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct SurfaceReport {
    /// What was done to the input.
    pub operation: Operation,
    /// Radius of the ball.
    pub radius_units: f64,
    /// The edge length that `_over_h` refers to.
    pub edge_length_units: f64,
    /// The error against the true closing or opening.
    pub contact: ContactError,
    /// Whether a closing contains its input, or an opening lies in it.
    pub containment: SurfaceContainment,
    /// Whether all of it is there, the right way round.
    pub whole: SurfaceWhole,
    /// What did not move.
    pub kept: SurfaceKept,
    /// Pairs of faces of the output that cross each other.
    pub self_intersections: SelfIntersections,
    /// The triangles of the moved part.
    pub quality: TriangleQuality,
    /// The bound on the curvature, which is what the operation is for.
    pub curvature: CurvatureBound,
    /// The shape of the surface as such.
    pub topology: SurfaceTopologies,
}

/// The distances of the output from the boundary of the true closing or opening, by the definition alone. For an opening, "fat" and
/// "unfilled" are those of the complement: too much taken away, too little.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct ContactError {
    /// The mean over the area that moved, of the absolute distance.
    pub mean_over_h: f64,
    /// The same with signs: positive where too fat prevails.
    pub bias_over_h: f64,
    /// The larger of the two maxima that follow.
    pub largest_over_h: f64,
    /// The farthest that the moved part is outside of the true closing.
    pub too_fat_over_h: f64,
    /// Where that is.
    pub too_fat_place: Option<SurfacePlace>,
    /// The farthest that the moved part is inside of the true closing, as far as that is proved.
    pub unfilled_over_h: f64,
    /// Where that is.
    pub unfilled_place: Option<SurfacePlace>,
    /// The most by which some place of the moved part may be farther inside of it than is proved: no ball was found to rest near by, and
    /// none to be impossible.
    pub in_doubt_over_h: f64,
    /// Where that is.
    pub in_doubt_place: Option<SurfacePlace>,
    /// The farthest that what did not move is inside of the true closing: it should have moved.
    pub unfilled_where_kept_over_h: f64,
    /// Where that is.
    pub unfilled_where_kept_place: Option<SurfacePlace>,
    /// How uncertain the least certain of these distances is: so much more may be undone there.
    pub uncertain_where_kept_over_h: f64,
    /// The fraction of the moved area that is off by more than half an edge length.
    pub share_beyond_half_h: f64,
    /// The moved area over the whole.
    pub moved_area_share: f64,
    /// How many places were measured in the moved part: corners, middles of edges and of faces.
    pub moved_samples: usize,
    /// How many places were measured in the rest.
    pub kept_samples: usize,
    /// The largest amount by which a distance may be smaller than was found.
    pub uncertainty_over_h: f64,
    /// The fraction of the moved samples whose distance is certain to 4 thousandths of the radius.
    pub certain_share: f64,
}

/// Depths by which input and output are on the wrong sides of each other.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct SurfaceContainment {
    /// The deepest place of the output inside the input of a closing (outside that of an opening).
    pub output_violation_units: f64,
    /// The same in edge lengths.
    pub output_violation_over_h: f64,
    /// Where it is.
    pub output_place: Option<SurfacePlace>,
    /// The farthest place of the input outside the output of a closing (inside that of an opening).
    pub input_violation_units: f64,
    /// The same in edge lengths.
    pub input_violation_over_h: f64,
    /// Where it is.
    pub input_place: Option<SurfacePlace>,
}

/// Whether a result is all there and the right way round.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct SurfaceWhole {
    /// The farthest that the output is from a place of the input that a ball touches, which is on the surface of the true result.
    pub missing_units: f64,
    /// The same in edge lengths.
    pub missing_over_h: f64,
    /// Where that is.
    pub missing_place: Option<SurfacePlace>,
    /// Both surfaces are closed, and one of them has its solid outside.
    pub inside_out: bool,
    /// Faces of the output that lie on the input and face the other way.
    pub turned_faces: usize,
    /// Their area, in squares of the edge length.
    pub turned_area_over_h2: f64,
    /// The middle of the first of them.
    pub turned_place: Option<SurfacePlace>,
    /// Edges with a single face that are not on a border of the input.
    pub new_border_edges: usize,
    /// The middle of the first of them.
    pub new_border_place: Option<SurfacePlace>,
    /// Faces of the input with the same three places as one before them.
    pub doubled_faces_in: usize,
    /// The same in the output.
    pub doubled_faces_out: usize,
}

/// What of the input is found in the output with the same bits.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct SurfaceKept {
    /// Vertices of the input that faces have.
    pub input_vertices: usize,
    /// Those of them that are found.
    pub vertices_found: usize,
    /// The fraction.
    pub vertex_share: f64,
    /// Vertices of the input that need not move: a ball touches them.
    pub still_vertices: usize,
    /// Those of them that are found.
    pub still_vertices_found: usize,
    /// The fraction; 1 where no vertex stays still.
    pub still_vertex_share: f64,
    /// Faces of the input.
    pub input_faces: usize,
    /// Those of them whose three vertices are found as a face.
    pub faces_found: usize,
    /// The fraction.
    pub face_share: f64,
}

/// Crossing faces.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct SelfIntersections {
    /// Pairs in the input.
    pub input_pairs: usize,
    /// Pairs in the output.
    pub output_pairs: usize,
    /// The first of those in the output, as numbers of faces.
    pub first_output_pairs: Vec<(u32, u32)>,
}

/// Triangles with a vertex that moved.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct TriangleQuality {
    /// How many.
    pub moved_faces: usize,
    /// The smallest angle of all, in degrees; 60 where there are none.
    pub smallest_angle_degrees: f64,
    /// Where it is.
    pub smallest_angle_place: Option<SurfacePlace>,
    /// The mean of the smallest angle of each.
    pub mean_smallest_angle_degrees: f64,
    /// The mean length of their edges.
    pub mean_edge_over_h: f64,
}

/// The minimum curvature of the vertices that moved (the maximum, of opposite sign, for an opening).
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct CurvatureBound {
    /// Vertices that moved.
    pub moved_vertices: usize,
    /// The fraction of them with less than -1.1 / r.
    pub share_below_1_1: f64,
    /// The fraction of them with less than -1.5 / r.
    pub share_below_1_5: f64,
    /// The least, in 1 / r: -1 is the bound. 0 where nothing moved.
    pub least_times_r: f64,
}

/// Shapes before and after.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct SurfaceTopologies {
    /// Of the input.
    pub input: SurfaceTopology,
    /// Of the output.
    pub output: SurfaceTopology,
}

/// The shape of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct SurfaceTopology {
    /// Vertices that faces have.
    pub vertices: usize,
    /// Faces.
    pub faces: usize,
    /// Vertices less edges plus faces: 2 for each sphere, 2 less for each handle, 1 less for each hole in the surface.
    pub euler_characteristic: i64,
    /// Parts that no edge connects.
    pub components: usize,
    /// Closed lines of edges with a single face.
    pub boundary_loops: usize,
    /// Edges of more than two faces, or of two with opposite orientations.
    pub nonmanifold_edges: usize,
}

/// Why a surface was not checked.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceCheckError {
    /// A coordinate is infinite or not a number.
    #[error("vertex {vertex} of the {mesh} has a coordinate that is not finite: repair the mesh first")]
    NotFinite {
        /// `input` or `output`.
        mesh: &'static str,
        /// Index of the vertex.
        vertex: usize,
    },
    /// A corner of a face does not exist.
    #[error("face {face} of the {mesh} has a corner that does not exist: repair the mesh first")]
    Face {
        /// `input` or `output`.
        mesh: &'static str,
        /// Index of the face.
        face: usize,
    },
    /// There is nothing.
    #[error("the {mesh} has no faces: there is nothing to compare")]
    Empty {
        /// `input` or `output`.
        mesh: &'static str,
    },
    /// A length that is none.
    #[error("radius {radius} and edge length {edge_length} must both be positive and finite")]
    Length {
        /// The radius.
        radius: f64,
        /// The edge length.
        edge_length: f64,
    },
}
