//! What a comparison found.

use super::Place;
use crate::plane::TopologyCount;
use crate::reference::{Method, Operation};

/// The result of [`compare`](super::compare). Lengths are in the units of the drawing (`_units`) and in radii
/// (`_over_r`).
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Report {
    /// What was done to the input.
    pub operation: Operation,
    /// Radius of the disk.
    pub radius_units: f64,
    /// Who computed the reference.
    pub reference_method: Method,
    /// The certified error of the reference: no number below it means anything.
    pub reference_error_units: f64,
    /// The radius that the reference is certified for.
    pub reference_radius_units: f64,
    /// Where the boundaries do not run along each other, no point is farther than the one found by more than this.
    pub resolution_units: f64,
    /// The Hausdorff distance between output and reference.
    pub hausdorff: Distance,
    /// The same without what lies within two radii of a change of topology: for results that keep the input's topology.
    pub hausdorff_where_topology_agrees: Distance,
    /// How many pieces of the reference's change of the input alter its topology.
    pub topological_pieces: usize,
    /// Areas.
    pub area: Area,
    /// Whether a closing contains its input, or an opening lies in it.
    pub containment: Containment,
    /// What did not need to move, and did not.
    pub kept: Kept,
    /// Pieces and holes.
    pub topology: Topology,
    /// The sharpest turn of the kind that the operation must remove, where one is sharper than the radius.
    pub smallest_radius: Option<SmallestRadius>,
}

/// A distance between two boundaries. One between something and nothing is infinite, in JSON
/// the text `infinite`.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Distance {
    /// The largest distance from a point of the output to the reference.
    #[serde(serialize_with = "finite_or_word")]
    pub output_to_reference_units: f64,
    /// The largest distance from a point of the reference to the output.
    #[serde(serialize_with = "finite_or_word")]
    pub reference_to_output_units: f64,
    /// The larger of the two.
    #[serde(serialize_with = "finite_or_word")]
    pub largest_over_r: f64,
    /// Where the larger of the two is found.
    pub place: Option<Place>,
}

/// JSON has no number for what is infinite, and `null` would say that nothing was measured.
pub(crate) fn finite_or_word<S: serde::Serializer>(value: &f64, to: S) -> Result<S::Ok, S::Error> {
    if value.is_infinite() { to.serialize_str("infinite") } else { to.serialize_f64(*value) }
}

/// Areas, with true arcs but for the symmetric difference, whose arcs are flattened to 1e-5 r.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Area {
    /// Of the input.
    pub input_units2: f64,
    /// Of the output.
    pub output_units2: f64,
    /// Of the reference.
    pub reference_units2: f64,
    /// Of what is in one of output and reference, and not in the other.
    pub symmetric_difference_units2: f64,
    /// The mean width of the symmetric difference along the reference's boundary.
    pub mean_difference_over_r: f64,
}

/// How far the input of a closing sticks out of the output, or the output of an opening out of the input.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Containment {
    /// The largest such distance.
    #[serde(serialize_with = "finite_or_word")]
    pub violation_units: f64,
    /// The same in radii.
    #[serde(serialize_with = "finite_or_word")]
    pub violation_over_r: f64,
    /// Where it is.
    pub place: Option<Place>,
}

/// Vertices of the input that lie on the reference's boundary (within 1e-7 r), and whether the output has them bit for bit.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Kept {
    /// Vertices that need not move.
    pub still_vertices: usize,
    /// Those of them that are found in the output with the same bits.
    pub found: usize,
    /// The fraction; 1 where no vertex stays still.
    pub fraction: f64,
}

/// Components and holes.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Topology {
    /// Of the input.
    pub input: TopologyCount,
    /// Of the output.
    pub output: TopologyCount,
    /// Of the reference.
    pub reference: TopologyCount,
}

/// A turn of the output's boundary that is sharper than the radius.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct SmallestRadius {
    /// Its radius; 0 for a corner.
    pub radius_units: f64,
    /// The same in radii of the disk.
    pub radius_over_r: f64,
    /// Where it is.
    pub place: Place,
}

impl Report {
    /// Whether the output is right within `tolerance_over_r`, a distance in radii: everywhere, or where
    /// `keeps_topology` says that the result was not meant to change it, where topology agrees.
    pub fn passes(&self, tolerance_over_r: f64, keeps_topology: bool) -> bool {
        let distance = if keeps_topology { &self.hausdorff_where_topology_agrees } else { &self.hausdorff };
        distance.largest_over_r <= tolerance_over_r
            && self.containment.violation_over_r <= tolerance_over_r
            && (keeps_topology || self.topology.output == self.topology.reference)
    }
}
