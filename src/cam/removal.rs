//! What a program leaves standing next to the part: where the tool did not reach.
//!
//! Stages: the motions that reach the floor are joined to paths and stroked with the tool; stock less swept less part
//! is what stands beside the part; pieces of it that hang on the part are its places. A thin skin around the part is
//! taken away first, because the rounding of a program leaves hairs between the places, and is given back by the
//! length of contact.

use std::collections::HashSet;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

use super::motion::{MotionKind, Program};
use super::solid::{Remainder, Solid};
use super::stroke::{Polygon, Stroke};
use crate::plane::{Bounds, Point, Region};

/// Thickness of the skin in millimetres: a few times what three decimals of a millimetre round away.
const SKIN: f64 = 0.004;

/// Places thinner than this, in millimetres, are rounding and not left standing.
pub const LEAST_UNCUT_DEPTH: f64 = 0.012;

/// Chord error of the overlay as a fraction of the tool's radius.
const RELATIVE_FLATTENING: f64 = 1e-4;

/// Motions this much above the floor, in millimetres, still reach it.
const FLOOR_ROUNDING: f64 = 0.005;

/// What stands beside the part.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Uncut {
    /// Area of all places in square millimetres.
    pub area_mm2: f64,
    /// The places, largest first.
    pub places: Vec<UncutPlace>,
    /// Whether the cut goes all around: where it does not, the part still hangs on the stock.
    pub is_cut_free: bool,
}

/// One piece of material that the tool did not reach.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct UncutPlace {
    /// Where it is thickest.
    pub x_mm: f64,
    /// Where it is thickest.
    pub y_mm: f64,
    /// Its area in square millimetres.
    pub area_mm2: f64,
    /// Greatest distance of it from the part, in millimetres.
    pub depth_mm: f64,
    /// Its outlines, for pictures.
    #[serde(skip)]
    pub outlines: Vec<Vec<Point>>,
}

/// What `program` leaves standing next to `part`, cutting with a disk of `tool_radius` down to `floor`.
///
/// `floor` is z in millimetres; motions above it leave material below them and do not count.
pub fn uncut(program: &Program, part: &Region, remainder: Remainder, tool_radius: f64, floor: f64) -> Uncut {
    let paths = paths_at_floor(program, floor, tool_radius * RELATIVE_FLATTENING);
    if part.is_empty() || paths.is_empty() || tool_radius <= 0.0 {
        return Uncut::default();
    }
    let reach = paths.iter().flatten().copied();
    let frame = part.bounds().union(Bounds::of_points(reach)).inflated(4.0 * tool_radius);
    let stroke = Stroke { radius: tool_radius, tolerance: tool_radius * RELATIVE_FLATTENING };
    let mut cut: Vec<Polygon> = paths.iter().flat_map(|path| stroke.rings(path)).collect();
    let skin = Stroke { radius: SKIN, tolerance: 0.1 * SKIN };
    let rings: Vec<Vec<Point>> = part.rings.iter().map(|r| r.flatten(0.1 * SKIN)).collect();
    for ring in &rings {
        let closed: Vec<Point> = ring.iter().chain(ring.first()).copied().collect();
        cut.extend(skin.rings(&closed));
    }
    let coordinates = |ring: &Vec<Point>| ring.iter().map(|p| [p.x, p.y]).collect::<Polygon>();
    match remainder {
        Remainder::Inside => cut.extend(rings.iter().map(coordinates)),
        Remainder::Outside => {
            cut.push(rectangle(frame));
            cut.extend(rings.iter().map(|ring| coordinates(ring).into_iter().rev().collect::<Polygon>()));
        }
    }
    let left = vec![rectangle(frame)].overlay_as::<i64>(&cut, OverlayRule::Difference, FillRule::NonZero);
    let solid = Solid::new(part, remainder);
    let mut result = Uncut { is_cut_free: true, ..Uncut::default() };
    for shape in left {
        let vertices = || shape.iter().flatten().map(|&[x, y]| Point::new(x, y));
        if !vertices().any(|p| solid.boundary.is_nearer(p, 1.5 * SKIN)) {
            continue;
        }
        if remainder == Remainder::Inside && vertices().any(|p| is_on_frame(p, &frame)) {
            result.is_cut_free = false;
            continue;
        }
        if let Some(place) = place(&shape, &solid) {
            result.area_mm2 += place.area_mm2;
            result.places.push(place);
        }
    }
    result.places.sort_by(|a, b| b.area_mm2.total_cmp(&a.area_mm2));
    result
}

/// The paths of all motions at the floor, joined where they follow each other; each trace once.
fn paths_at_floor(program: &Program, floor: f64, tolerance: f64) -> Vec<Vec<Point>> {
    let mut seen = HashSet::new();
    let mut paths: Vec<Vec<Point>> = Vec::new();
    let mut is_open = false;
    for motion in &program.motions {
        if matches!(motion.kind, MotionKind::Dwell { .. }) {
            continue;
        }
        let is_plunge = motion.trace().next().is_none();
        let lowest_that_counts = if is_plunge { motion.to.z } else { motion.from.z.max(motion.to.z) };
        if lowest_that_counts > floor + FLOOR_ROUNDING {
            is_open = false;
            continue;
        }
        if is_plunge && !is_open {
            paths.push(vec![motion.to.xy()]);
            is_open = true;
        }
        for element in motion.trace() {
            let key = [element.start.x, element.start.y, element.end.x, element.end.y, element.sweep()];
            if !seen.insert(key.map(f64::to_bits)) {
                is_open = false;
                continue;
            }
            if !is_open {
                paths.push(vec![element.start]);
                is_open = true;
            }
            // Proof of a last path: one was pushed whenever none is open.
            let path = paths.last_mut().expect("a path is open");
            element.flatten(tolerance, |p| path.push(p));
        }
    }
    paths
}

fn rectangle(b: Bounds) -> Polygon {
    vec![[b.min.x, b.min.y], [b.max.x, b.min.y], [b.max.x, b.max.y], [b.min.x, b.max.y]]
}

fn is_on_frame(p: Point, frame: &Bounds) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() < SKIN;
    near(p.x, frame.min.x) || near(p.x, frame.max.x) || near(p.y, frame.min.y) || near(p.y, frame.max.y)
}

/// The place that a piece makes; `None` where it is thin enough to be rounding.
fn place(shape: &[Polygon], solid: &Solid) -> Option<UncutPlace> {
    let outlines: Vec<Vec<Point>> =
        shape.iter().map(|ring| ring.iter().map(|&[x, y]| Point::new(x, y)).collect()).collect();
    let is_skin = |d: f64| d < 1.5 * SKIN;
    let (mut doubled_area, mut contact, mut perimeter) = (0.0, 0.0, 0.0);
    let mut deepest = (0.0, *outlines.first()?.first()?);
    for ring in &outlines {
        let origin = ring.first()?.coords;
        let distances: Vec<f64> = ring.iter().map(|p| solid.boundary.distance(*p)).collect();
        for (i, p) in ring.iter().enumerate() {
            let next = (i + 1) % ring.len();
            let q = ring[next];
            doubled_area += (p.coords - origin).perp(&(q.coords - origin));
            perimeter += (q - p).norm();
            if is_skin(distances[i]) && is_skin(distances[next]) {
                contact += (q - p).norm();
            }
            if distances[i] > deepest.0 {
                deepest = (distances[i], *p);
            }
        }
    }
    // Surrounded by the part, as an unreached hole is, a piece is thickest somewhere inside.
    if contact > MOSTLY * perimeter {
        deepest = deepest_inside(&outlines, solid, deepest);
    }
    let (depth, at) = deepest;
    let area = 0.5 * doubled_area + SKIN * contact;
    (depth > LEAST_UNCUT_DEPTH).then_some(UncutPlace {
        x_mm: at.x,
        y_mm: at.y,
        area_mm2: area,
        depth_mm: depth,
        outlines,
    })
}

/// A piece is surrounded by the part if this much of its outline is.
const MOSTLY: f64 = 0.75;

/// The point inside of `outlines` that is farthest from the part, found by halving squares that can still hold it.
fn deepest_inside(outlines: &[Vec<Point>], solid: &Solid, mut best: (f64, Point)) -> (f64, Point) {
    /// Found to this fraction of the piece's size.
    const PRECISION: f64 = 0.01;
    const MOST_SQUARES: usize = 2000;
    let bounds = Bounds::of_points(outlines.iter().flatten().copied());
    let contains = |p: Point| outlines.iter().map(|ring| winding(ring, p)).sum::<i32>() != 0;
    let half = 0.5 * bounds.width().max(bounds.height());
    let mut open = vec![(bounds.center(), half)];
    let mut count = 0;
    while let Some((center, half)) = open.pop() {
        count += 1;
        let distance = solid.boundary.distance(center);
        if distance > best.0 && contains(center) {
            best = (distance, center);
        }
        let corner = half * std::f64::consts::SQRT_2;
        if count > MOST_SQUARES || distance + corner <= best.0 + PRECISION * bounds.diagonal() {
            continue;
        }
        let q = 0.5 * half;
        open.extend([(-q, -q), (q, -q), (-q, q), (q, q)].map(|(x, y)| (center + crate::plane::Vector::new(x, y), q)));
    }
    best
}

fn winding(ring: &[Point], p: Point) -> i32 {
    let n = ring.len();
    (0..n).map(|i| crate::plane::Segment::line(ring[i], ring[(i + 1) % n]).ray_crossings(p)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::read;
    use crate::plane::Ring;
    use std::f64::consts::PI;

    const HEAD: &str = "G21 G90 G17 G94\nG0 Z5\nM3 S1000\nG4 P1\nF500\n";

    fn left(path: &str, part: &Region, remainder: Remainder, radius: f64) -> Uncut {
        let program = read(&format!("{HEAD}{path}")).unwrap();
        uncut(&program, part, remainder, radius, -1.0)
    }

    fn polygon(points: &[[f64; 2]]) -> Ring {
        Ring::polygon(points.iter().map(|p| Point::new(p[0], p[1])))
    }

    #[test]
    fn a_round_tool_leaves_the_corners_of_a_pocket() {
        let pocket = Region::new(vec![polygon(&[[0.0, 0.0], [20.0, 0.0], [20.0, 10.0], [0.0, 10.0]])]);
        let path = "G0 X2 Y2\nG1 Z-1\nG1 X18\nG1 Y8\nG1 X2\nG1 Y2\nG1 Y5\nG1 X18";
        let found = left(path, &pocket, Remainder::Outside, 2.0);
        assert_eq!(found.places.len(), 4, "{found:?}");
        let (area, depth) = (4.0 * (1.0 - PI / 4.0), 2.0 * (1.0 - 1.0 / 2f64.sqrt()));
        for place in &found.places {
            assert!((place.area_mm2 / area - 1.0).abs() < 1e-3, "{} against {area}", place.area_mm2);
            assert!((place.depth_mm - depth).abs() < 1e-3, "{} against {depth}", place.depth_mm);
        }
        assert!((found.area_mm2 / (4.0 * area) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_concave_corner_of_a_part_keeps_a_fillet() {
        // An L: its one inside corner stands at (10, 10). The path is the sharp one, two passes.
        let part = Region::new(vec![polygon(&[
            [0.0, 0.0],
            [20.0, 0.0],
            [20.0, 10.0],
            [10.0, 10.0],
            [10.0, 20.0],
            [0.0, 20.0],
        ])]);
        let once = "G1 Y20\nG2 X0 Y22 I2 J0\nG1 X10\nG2 X12 Y20 I0 J-2\nG1 Y12\nG1 X20\nG2 X22 Y10 I0 J-2\nG1 Y0\n\
                    G2 X20 Y-2 I-2 J0\nG1 X0\nG2 X-2 Y0 I0 J2\n";
        let path = format!("G0 X-2 Y0\nG1 Z-0.5\n{once}G1 Z-1\n{once}");
        let found = left(&path, &part, Remainder::Inside, 2.0);
        assert!(found.is_cut_free && found.places.len() == 1, "{found:?}");
        assert!((found.area_mm2 / (4.0 - PI) - 1.0).abs() < 1e-3, "{}", found.area_mm2);
        // Without the pass at the floor it stands on it all around.
        let shallow = left(&format!("G0 X-2 Y0\nG1 Z-0.5\n{once}"), &part, Remainder::Inside, 2.0);
        assert_eq!(shallow, Uncut::default());
        // Half of the way leaves it on the stock.
        let half = left("G0 X-2 Y0\nG1 Z-1\nG1 Y20\n", &part, Remainder::Inside, 2.0);
        assert!(!half.is_cut_free);
    }

    #[test]
    fn an_unreached_hole_is_found_whole_and_a_slug_is_not() {
        let mut part = Region::new(vec![polygon(&[[0.0, 0.0], [60.0, 0.0], [60.0, 30.0], [0.0, 30.0]])]);
        part.rings.push(Ring::circle(Point::new(15.0, 15.0), 1.0).reversed());
        part.rings.push(Ring::circle(Point::new(40.0, 15.0), 10.0).reversed());
        let path = "G0 X48 Y15\nG1 Z-1\nG3 X48 Y15 I-8 J0\nG0 Z5\nG0 X-2 Y-2\nG1 Z-1\nG1 X62\nG1 Y32\nG1 X-2\nG1 Y-2\n";
        let found = left(path, &part, Remainder::Inside, 2.0);
        assert!(found.is_cut_free && found.places.len() == 1, "{found:?}");
        assert!((found.area_mm2 - PI).abs() < 0.005, "{}", found.area_mm2);
        assert!((found.places[0].depth_mm - 1.0).abs() < 0.03, "{:?}", found.places[0].depth_mm);
    }

    #[test]
    fn rounding_leaves_nothing() {
        // Two thousandths too far away all around.
        let part = Region::new(vec![polygon(&[[0.0, 0.0], [60.0, 0.0], [60.0, 30.0], [0.0, 30.0]])]);
        let path = "G0 X-2.002 Y-2.002\nG1 Z-1\nG1 X62.002\nG1 Y32.002\nG1 X-2.002\nG1 Y-2.002\n";
        let found = left(path, &part, Remainder::Inside, 2.0);
        assert!(found.is_cut_free && found.places.is_empty(), "{found:?}");
    }
}
