//! Dogbones and T-bones: inside corners cut away, so that a square part fits.
//!
//! The path goes out of its way until the tool's edge is at the corner, along the bisector or along the longer wall, and
//! back. What that takes from the walls is asked for: it is taken from what must remain before the program is judged.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

use super::Corners;
use crate::cam::stroke::{Polygon, Stroke};
use crate::cam::{Notice, Remainder};
use crate::plane::{BoundaryIndex, Joint, Link, Point, Region, Ring, Segment, Vertex, left_normal, turn_angle};

/// Corners that turn by less than this, in radians (15 degrees), need no relief: a tool rounds them by next to nothing.
const LEAST_TURN: f64 = 0.26;

/// Corners sharper than this, half of the angle between their walls in radians (60 degrees in all), are left round: the tool
/// would cut more from the walls than it clears.
const SHARPEST: f64 = 0.52;

/// How much farther than its geometry says a corner may be from the path, and how much the other walls may reach into the
/// tool at the corner, in tool radii: the corner is hidden otherwise.
const HIDDEN: f64 = 0.05;

/// How near the tool's edge is brought to a corner, in millimetres: inside of it by this much, so that nothing stays.
const BEYOND: f64 = 0.01;

/// Chord error of what is taken from the walls, in millimetres: a hundredth of the gouge that a program may have.
const FLATTENING: f64 = 2e-5;

/// A way out of the path and back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Relief {
    /// The corner.
    corner: Point,
    /// Where the tool's centre goes.
    to: Point,
    /// The farthest that this may be from the path.
    reach: f64,
    /// Sine of half of the free angle between the walls.
    sine: f64,
}

/// The ways that a tool of `radius` takes to the inside corners of what stays, on a path of this radius.
pub(super) fn reliefs(
    stays: &Region,
    corners: Corners,
    radius: f64,
    path_radius: f64,
    notices: &mut Vec<Notice>,
) -> Vec<Relief> {
    let mut found = Vec::new();
    if corners == Corners::Round {
        return found;
    }
    let walls = BoundaryIndex::new(stays);
    for ring in &stays.rings {
        let n = ring.len();
        for k in 0..n {
            if ring.vertices[k].joint != Joint::Corner {
                continue;
            }
            let (before, after) = (ring.segment((k + n - 1) % n), ring.segment(k));
            let (arriving, leaving) = (before.end_tangent(), after.start_tangent());
            // The solid lies on the left: a turn to the right is an inside corner of what is cut away.
            let turn = turn_angle(arriving, leaving);
            if turn > -LEAST_TURN {
                continue;
            }
            let corner = ring.vertices[k].point;
            // Half of the free angle between the walls.
            let half = 0.5 * (std::f64::consts::PI + turn);
            if half < SHARPEST {
                notices.push(Notice::CornerSkipped(corner));
                continue;
            }
            let sine = half.sin();
            let middle = (leaving - arriving).normalize();
            // Where the tool touches both walls: a gap that it does not fit into has no corner for it.
            if walls.distance(corner + middle * (radius / sine)) < (1.0 - HIDDEN) * radius {
                notices.push(Notice::CornerSkipped(corner));
                continue;
            }
            let to = match corners {
                Corners::TBone => {
                    // Out of the free side of the longer wall.
                    let along = if before.length() >= after.length() { arriving } else { leaving };
                    corner - left_normal(along) * (radius - BEYOND)
                }
                _ => corner + middle * (radius - BEYOND),
            };
            let reach = (radius + path_radius) * (1.0 / sine - 1.0) + radius * (HIDDEN + 1.0 / half.tan());
            found.push(Relief { corner, to, reach, sine });
        }
    }
    found
}

/// The path, which keeps `allowance` more than the tool's radius from what stays, with the ways to the corners near it;
/// corners that it does not come near are told.
pub(super) fn insert(path: &mut Region, reliefs: &[Relief], allowance: f64, notices: &mut Vec<Notice>) -> Vec<Segment> {
    let mut ways: Vec<(usize, usize, Segment)> = Vec::new();
    for relief in reliefs {
        let nearest = path
            .rings
            .iter()
            .enumerate()
            .flat_map(|(r, ring)| ring.segments().enumerate().map(move |(e, s)| (r, e, s.nearest(relief.to))))
            .min_by(|a, b| a.2.distance.total_cmp(&b.2.distance));
        match nearest {
            Some((ring, element, near)) if near.distance <= relief.reach + allowance / relief.sine => {
                if near.distance > 0.0 {
                    ways.push((ring, element, Segment::line(near.point, relief.to)));
                }
            }
            _ => notices.push(Notice::CornerSkipped(relief.corner)),
        }
    }
    // From the last place of the path to the first, so that the places before stay what they are; all ways leave the path
    // as it was, never each other.
    let mut backwards: Vec<&(usize, usize, Segment)> = ways.iter().collect();
    let along = |way: &(usize, usize, Segment)| {
        let segment = path.rings[way.0].segment(way.1);
        if segment.start == way.2.start { 0.0 } else { Segment { end: way.2.start, ..segment }.length() }
    };
    backwards.sort_by(|a, b| (b.0, b.1).cmp(&(a.0, a.1)).then(along(b).total_cmp(&along(a))));
    let backwards: Vec<(usize, usize, Segment)> = backwards.into_iter().copied().collect();
    for (ring, element, way) in backwards {
        spike(&mut path.rings[ring], element, way.start, way.end);
    }
    ways.into_iter().map(|(_, _, way)| way).collect()
}

/// A way from `at` on an element to `to` and back.
fn spike(ring: &mut Ring, element: usize, at: Point, to: Point) {
    let link = ring.vertices[element].link;
    let corner = |point: Point, link: Link| Vertex { point, link, joint: Joint::Corner, id: None };
    let starts_here = ring.vertices[element].point == at;
    let mut new = vec![corner(at, Link::Line), corner(to, Link::Line), corner(at, link)];
    if starts_here {
        // The element begins after the way.
        ring.vertices[element].link = Link::Line;
        new.remove(0);
    }
    ring.vertices.splice(element + 1..element + 1, new);
}

/// `part` without what a tool of `radius` takes from it along `ways`; or with it, where the part is what is cut away.
pub(super) fn relieved(part: &Region, remainder: Remainder, ways: &[Segment], radius: f64) -> Region {
    if ways.is_empty() {
        return part.clone();
    }
    let stroke = Stroke { radius, tolerance: FLATTENING };
    let swept: Vec<Polygon> = ways.iter().flat_map(|way| stroke.rings(&[*way])).collect();
    let polygon = |ring: &Ring| ring.flatten(FLATTENING).iter().map(|p| [p.x, p.y]).collect::<Polygon>();
    let area: Vec<Polygon> = part.rings.iter().map(polygon).collect();
    let rule = match remainder {
        Remainder::Inside => OverlayRule::Difference,
        Remainder::Outside => OverlayRule::Union,
    };
    let shapes = area.overlay_as::<i64>(&swept, rule, FillRule::NonZero);
    let ring = |points: &Polygon| Ring::polygon(points.iter().map(|&[x, y]| Point::new(x, y)));
    Region::new(shapes.iter().flatten().map(ring).collect())
}
