//! The closing with true arcs, by `cavalier_contours`.
//!
//! Its offset is exact but for its tolerances, and no single setting of them works everywhere: several are tried, and the
//! certificate chooses. The settings are in radii, because the offset runs in coordinates where the radius is 1.

use std::f64::consts::PI;
use std::panic::{AssertUnwindSafe, catch_unwind};

use cavalier_contours::polyline::{PlineSource, PlineSourceMut, Polyline};
use cavalier_contours::shape_algorithms::{Shape, ShapeOffsetOptions};

use super::{Method, Operation, Reference, ReferenceError, Side, best_certified};
use crate::plane::{Arc, Joint, Link, Point, Region, Ring, Turn, Vector, Vertex};
use crate::units::Radius;

/// Settings of the offset's three tolerances in radii: equal positions, slices valid by distance, joining of slices.
/// In the order in which they succeed most often.
const SETTINGS: [[f64; 3]; 6] = [
    [1e-10, 1e-9, 1e-8],
    [1e-9, 1e-7, 1e-7],
    [1e-8, 1e-6, 1e-6],
    [1e-7, 1e-6, 1e-5],
    [1e-5, 1e-4, 1e-4],
    [1e-12, 1e-10, 1e-9],
];

/// Arcs are handed over in pieces that sweep at most this: `cavalier_contours` knows none beyond a half turn.
const LARGEST_SWEEP: f64 = 0.9 * PI;

/// Bulges below this are straight: the sagitta is then below the rounding of the chord.
const FLAT_BULGE: f64 = 1e-14;

/// The closing or opening by two parallel offsets with true arcs, certified.
///
/// # Errors
/// See [`ReferenceError`]; [`ReferenceError::NotCertified`] where no setting gives a right answer.
pub fn closing(region: &Region, radius: Radius, operation: Operation) -> Result<Reference, ReferenceError> {
    best_certified(region, radius, operation, Method::Arcs, &SETTINGS, |unit, setting| {
        // It panics on some inputs with touching loops; here that is one more uncertified answer.
        catch_unwind(AssertUnwindSafe(|| offset_twice(unit, operation, setting))).ok()
    })
}

fn offset_twice(
    unit: &Region,
    operation: Operation,
    [pos_equal_eps, offset_dist_eps, slice_join_eps]: [f64; 3],
) -> [Region; 2] {
    let options = ShapeOffsetOptions { pos_equal_eps, offset_dist_eps, slice_join_eps };
    // Counterclockwise loops shrink where the offset is positive.
    let signed = |side| match side {
        Side::Outward => -1.0,
        Side::Inward => 1.0,
    };
    let [first_side, second_side] = operation.sides();
    let first = Shape::from_plines(unit.rings.iter().map(to_polyline)).parallel_offset(signed(first_side), &options);
    let second = first.parallel_offset(signed(second_side), &options);
    [to_region(&first), to_region(&second)]
}

fn to_polyline(ring: &Ring) -> Polyline<f64> {
    let mut line = Polyline::new_closed();
    for s in ring.segments() {
        match s.link {
            Link::Line => {
                line.add(s.start.x, s.start.y, 0.0);
            }
            Link::Arc(arc) => {
                let sweep = s.sweep();
                let pieces = (sweep / LARGEST_SWEEP).ceil().max(1.0);
                let bulge = arc.turn.sign() * (sweep / pieces / 4.0).tan();
                for k in 0..pieces as usize {
                    let p = s.point_at(k as f64 / pieces);
                    line.add(p.x, p.y, bulge);
                }
            }
        }
    }
    line
}

fn to_region(shape: &Shape<f64>) -> Region {
    let rings = shape.ccw_plines.iter().chain(&shape.cw_plines).map(|indexed| to_ring(&indexed.polyline));
    Region::new(rings.filter(|r| r.len() >= 2).collect())
}

fn to_ring(line: &Polyline<f64>) -> Ring {
    let points: Vec<(Point, f64)> = line.iter_vertexes().map(|v| (Point::new(v.x, v.y), v.bulge)).collect();
    let n = points.len();
    let vertices = (0..n).filter_map(|i| {
        let ((point, bulge), (next, _)) = (points[i], points[(i + 1) % n]);
        (point != next).then(|| Vertex { point, link: link(point, next, bulge), joint: Joint::Corner, id: None })
    });
    Ring { vertices: vertices.collect() }
}

/// The link between two points whose bulge is the tangent of a quarter of the sweep.
fn link(from: Point, to: Point, bulge: f64) -> Link {
    if bulge.abs() < FLAT_BULGE {
        return Link::Line;
    }
    let chord = to - from;
    // Distance from the chord's middle to the centre over the chord, positive to the left.
    let rise = (1.0 - bulge * bulge) / (4.0 * bulge);
    let center = nalgebra::center(&from, &to) + Vector::new(-chord.y, chord.x) * rise;
    let radius = chord.norm() * (1.0 + bulge * bulge) / (4.0 * bulge.abs());
    Link::Arc(Arc { center, radius, turn: if bulge > 0.0 { Turn::Left } else { Turn::Right } })
}
