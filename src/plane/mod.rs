//! Points, arcs, rings and regions of the plane.
//!
//! Everything here is exact geometry on straight links and circular arcs, in `f64`. Lengths carry no unit: whoever
//! reads a drawing decides (see [`crate::units`]). Solid material lies on the left of every link, so outer rings run
//! counterclockwise and holes clockwise, with the y axis pointing up.

mod apart;
mod biarc;
mod bounds;
mod chain_tree;
mod distance;
mod inscribed;
mod medial_axis;
mod overlap;
mod pins;
mod point;
mod radius_field;
mod region;
mod ring;
mod segment;
mod segment_distance;
mod stretch;

pub use apart::{any_meet, groups_apart};
pub use biarc::{Biarc, Place};
pub use bounds::Bounds;
pub use chain_tree::ChainTree;
pub use distance::BoundaryIndex;
pub use inscribed::{InscribedCircle, inscribed_circle};
pub use medial_axis::{AxisEdge, AxisNode, MedialAxis, medial_axis};
pub use pins::{PinnedArea, PinnedRegion, pin_distance};
pub use point::{Point, Vector, left_normal, right_normal, turn_angle};
pub use radius_field::{Gradient, RadiusField, RadiusMap};
pub use region::{Region, TopologyCount, place_along_curve};
pub use ring::{Joint, Ring, Vertex, VertexId};
pub use segment::{Arc, Link, Nearest, Segment, Turn};
pub use segment_distance::Approach;
pub use stretch::{InvalidStretch, LARGEST_ASPECT, Stretch, Stretched};
