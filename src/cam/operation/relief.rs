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
            found.push(Relief { corner, to, reach });
        }
    }
    found
}

/// The path with the ways to the corners near it; corners that it does not come near are told.
pub(super) fn insert(path: &mut Region, reliefs: &[Relief], notices: &mut Vec<Notice>) -> Vec<Segment> {
    let mut spikes = Vec::new();
    for relief in reliefs {
        match Place::nearest(path, relief.to) {
            Some(place) if place.distance <= relief.reach => {
                if place.distance > 0.0 {
                    spikes.push(Spike { place, to: vec![relief.to] });
                }
            }
            _ => notices.push(Notice::CornerSkipped(relief.corner)),
        }
    }
    let ways = spikes.iter().map(|spike| Segment::line(spike.place.at, spike.to[0])).collect();
    insert_all(path, spikes);
    ways
}

/// The path of the roughing, no farther than `reach` from where `ways` begin, with the same ways.
pub(super) fn insert_ways(path: &mut Region, ways: &[Segment], reach: f64) {
    let near = ways.iter().filter_map(|way| Some((Place::nearest(path, way.start)?, way)));
    let spikes = near
        .filter(|(place, _)| place.distance <= reach)
        .map(|(place, way)| Spike { place, to: vec![way.start, way.end] })
        .collect();
    insert_all(path, spikes);
}

/// A place of a path.
#[derive(Clone, Copy, Debug)]
struct Place {
    ring: usize,
    element: usize,
    at: Point,
    /// Length of the element up to the place.
    before: f64,
    /// How far it is from what it was sought for.
    distance: f64,
}

impl Place {
    fn nearest(path: &Region, p: Point) -> Option<Place> {
        let rings = path.rings.iter().enumerate();
        let all = rings.flat_map(|(r, ring)| ring.segments().enumerate().map(move |(e, s)| (r, e, s, s.nearest(p))));
        let (ring, element, s, near) = all.min_by(|a, b| a.3.distance.total_cmp(&b.3.distance))?;
        let at = near.point;
        let before = if at == s.start { 0.0 } else { Segment { end: at, ..s }.length() };
        Some(Place { ring, element, at, before, distance: near.distance })
    }
}

/// A way out of a path over some points, and back over them.
#[derive(Clone, Debug)]
struct Spike {
    place: Place,
    to: Vec<Point>,
}

/// All ways leave the path as it was, never each other: from its end to its start, so that the places before stay.
fn insert_all(path: &mut Region, mut spikes: Vec<Spike>) {
    let key = |s: &Spike| (s.place.ring, s.place.element);
    spikes.sort_by(|a, b| key(b).cmp(&key(a)).then(b.place.before.total_cmp(&a.place.before)));
    for spike in spikes {
        spike.insert(&mut path.rings[spike.place.ring]);
    }
}

impl Spike {
    fn insert(&self, ring: &mut Ring) {
        let (element, at) = (self.place.element, self.place.at);
        let link = ring.vertices[element].link;
        let corner = |point: Point, link: Link| Vertex { point, link, joint: Joint::Corner, id: None };
        let back = self.to.iter().rev().skip(1);
        let out_and_back = self.to.iter().chain(back).map(|&p| corner(p, Link::Line));
        let mut new: Vec<Vertex> = out_and_back.chain([corner(at, link)]).collect();
        if ring.vertices[element].point == at {
            // The element begins after the way.
            ring.vertices[element].link = Link::Line;
        } else {
            new.insert(0, corner(at, Link::Line));
        }
        ring.vertices.splice(element + 1..element + 1, new);
    }
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
