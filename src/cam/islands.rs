//! What stands inside of a pocket that was to be empty.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

use super::motion::Program;
use super::removal::LEAST_UNCUT_DEPTH;
use super::stroke::{Polygon, Stroke};
use super::swept::paths_at_floor;
use crate::plane::{Point, Region, Ring, inscribed_circle};

/// Chord error of the overlay, in tool radii.
const FLATTENING: f64 = 1e-4;

/// A piece that was to be cut away and stands.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Island {
    /// Where it is thickest.
    pub x_mm: f64,
    /// Where it is thickest.
    pub y_mm: f64,
    /// How thick it is there.
    pub thickness_mm: f64,
}

/// The pieces thicker than [`LEAST_UNCUT_DEPTH`] that `program` leaves of `pocket` at `floor` with a tool of this radius.
///
/// Independent of how the path was planned: what the motions sweep is taken from the pocket.
pub fn islands(program: &Program, pocket: &Region, tool_radius: f64, floor: f64) -> Vec<Island> {
    let tolerance = FLATTENING * tool_radius;
    let stroke = Stroke { radius: tool_radius, tolerance };
    let polygon = |ring: &Ring| ring.flatten(tolerance).iter().map(|p| [p.x, p.y]).collect::<Polygon>();
    let area: Vec<Polygon> = pocket.rings.iter().map(polygon).collect();
    let mut swept: Vec<Polygon> = Vec::new();
    for path in paths_at_floor(&program.motions, floor) {
        match path.as_slice() {
            [point] if point.start == point.end => swept.push(stroke.disk(point.start)),
            _ => swept.extend(stroke.rings(&path)),
        }
    }
    let left = area.overlay_as::<i64>(&swept, OverlayRule::Difference, FillRule::NonZero);
    let piece = |shape: &Vec<Polygon>| {
        let ring = |points: &Polygon| Ring::polygon(points.iter().map(|&[x, y]| Point::new(x, y)));
        inscribed_circle(&Region::new(shape.iter().map(ring).collect()))
    };
    left.iter()
        .map(piece)
        .filter(|c| 2.0 * c.radius > LEAST_UNCUT_DEPTH)
        .map(|c| Island { x_mm: c.center.x, y_mm: c.center.y, thickness_mm: 2.0 * c.radius })
        .collect()
}
