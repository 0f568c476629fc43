//! What a program leaves standing next to the part: where the tool did not reach.
//!
//! Stages: the motions that reach the floor are joined to paths and stroked with the tool; strokes and outlines fall into groups
//! that lie apart; of each, stock less swept less part is what stands beside the part; pieces of it that hang on the part are its
//! places. A thin skin around the part is taken away first, because the rounding of a program leaves hairs between the places,
//! and is given back by the length of contact.

use super::motion::{Motion, Program};
use super::solid::{Remainder, Solid};
use super::stroke::{Polygon, Stroke};
use super::swept::{FLATTENING, Group, paths_at_floor, swept};
use crate::plane::{Point, Region, Ring, Segment, inscribed_circle};
use crate::threads;

/// Thickness of the skin in millimetres: a few times what three decimals of a millimetre round away.
pub(super) const SKIN: f64 = 0.004;

/// Places thinner than this, in millimetres, are rounding and not left standing.
pub const LEAST_UNCUT_DEPTH: f64 = 0.012;

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
    uncut_by(&[Run { motions: &program.motions, tool_radius }], part, remainder, floor)
}

/// Motions that follow each other with one tool.
pub(super) struct Run<'a> {
    pub(super) motions: &'a [Motion],
    pub(super) tool_radius: f64,
}

/// What several tools together leave standing next to `part`, as [`uncut`] tells of one.
pub(super) fn uncut_by(runs: &[Run], part: &Region, remainder: Remainder, floor: f64) -> Uncut {
    let paths: Vec<(Vec<Vec<Segment>>, f64)> = runs
        .iter()
        .map(|run| (paths_at_floor(run.motions, floor), run.tool_radius))
        .filter(|(paths, radius)| !paths.is_empty() && *radius > 0.0)
        .collect();
    if part.is_empty() || paths.is_empty() {
        return Uncut::default();
    }
    let largest_radius = paths.iter().map(|(_, radius)| *radius).fold(0.0, f64::max);
    let mut cut: Vec<Polygon> = Vec::new();
    for (paths, radius) in &paths {
        cut.extend(swept(paths, *radius));
    }
    // The part with its skin.
    let skin = Stroke { radius: SKIN, tolerance: FLATTENING };
    for ring in &part.rings {
        let solid_on_the_left = match remainder {
            Remainder::Inside => ring.segments().collect(),
            Remainder::Outside => ring.reversed().segments().collect::<Vec<_>>(),
        };
        let has_length: Vec<Segment> = solid_on_the_left.into_iter().filter(|s| s.length() > 0.0).collect();
        cut.push(skin.closed_side(&has_length));
    }
    let solid = Solid::new(part, remainder);
    let mut groups = Group::all(cut, largest_radius);
    if remainder == Remainder::Outside {
        groups.iter_mut().for_each(Group::surround);
    }
    let found = threads::map_long(&groups, threads::available(), |group| uncut_group(group, &solid));
    let mut result = Uncut { is_cut_free: true, ..Uncut::default() };
    for group in found {
        result.area_mm2 += group.area_mm2;
        result.places.extend(group.places);
        result.is_cut_free &= group.is_cut_free;
    }
    result.places.sort_by(|a, b| b.area_mm2.total_cmp(&a.area_mm2));
    result
}

/// What stands in a group of rings: of what is swept and of the part with its skin.
fn uncut_group(group: &Group, solid: &Solid) -> Uncut {
    let mut result = Uncut { is_cut_free: true, ..Uncut::default() };
    for shape in group.left() {
        let vertices = || shape.iter().flatten().map(|&[x, y]| Point::new(x, y));
        // The frame itself may lie on what another group goes around.
        if !vertices().any(|p| !group.is_on_frame(p) && solid.boundary.is_nearer(p, 1.5 * SKIN)) {
            continue;
        }
        if solid.remainder == Remainder::Inside && vertices().any(|p| group.is_on_frame(p)) {
            result.is_cut_free = false;
            continue;
        }
        if let Some(place) = place(&shape, solid) {
            result.area_mm2 += place.area_mm2;
            result.places.push(place);
        }
    }
    result
}

/// The point of some edges farthest from the part, at least as far as `deepest`; not looked for where all of them are nearer
/// than what counts as left. An edge is given by its ends with their distances; between them no distance exceeds half the
/// sum of these and the length.
fn deepest_along(mut edges: Vec<(Point, f64, Point, f64)>, mut deepest: (f64, Point), solid: &Solid) -> (f64, Point) {
    // A long piece of even depth has no deepest point: then nearly the deepest is enough.
    const ACCURACY: f64 = 1e-3;
    const MOST_LOOKS: usize = 2000;
    for _ in 0..MOST_LOOKS {
        let Some((p, at_p, q, at_q)) = edges.pop() else { break };
        if 0.5 * (at_p + at_q + (q - p).norm()) <= (deepest.0 * (1.0 + ACCURACY)).max(LEAST_UNCUT_DEPTH) {
            continue;
        }
        let middle = nalgebra::center(&p, &q);
        let at_middle = solid.boundary.distance(middle);
        if at_middle > deepest.0 {
            deepest = (at_middle, middle);
        }
        edges.extend([(p, at_p, middle, at_middle), (middle, at_middle, q, at_q)]);
    }
    deepest
}

/// The place that a piece makes; `None` where it is thin enough to be rounding.
fn place(shape: &[Polygon], solid: &Solid) -> Option<UncutPlace> {
    let outlines: Vec<Vec<Point>> =
        shape.iter().map(|ring| ring.iter().map(|&[x, y]| Point::new(x, y)).collect()).collect();
    let is_skin = |d: f64| d < 1.5 * SKIN;
    let (mut doubled_area, mut contact, mut perimeter) = (0.0, 0.0, 0.0);
    let mut deepest = (0.0, *outlines.first()?.first()?);
    let mut edges = vec![];
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
            edges.push((*p, distances[i], q, distances[next]));
        }
    }
    let area = 0.5 * doubled_area + SKIN * contact;
    // A hair of the overlay on the tool's path can be far from the part, and is nothing.
    if area <= LEAST_UNCUT_DEPTH * LEAST_UNCUT_DEPTH {
        return None;
    }
    deepest = deepest_along(edges, deepest, solid);
    // Surrounded by the part, as an unreached hole is, a piece is thickest somewhere inside.
    if contact > MOSTLY * perimeter {
        let circle =
            inscribed_circle(&Region::new(outlines.iter().map(|r| Ring::polygon(r.iter().copied())).collect()));
        if circle.radius + SKIN > deepest.0 {
            deepest = (circle.radius + SKIN, circle.center);
        }
    }
    let (depth, at) = deepest;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::read;
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
    fn an_unreached_triangle_is_as_deep_as_its_incircle() {
        let mut part = Region::new(vec![polygon(&[[0.0, 0.0], [60.0, 0.0], [60.0, 30.0], [0.0, 30.0]])]);
        part.rings.push(polygon(&[[20.0, 20.0], [24.0, 20.0], [22.0, 14.0]]));
        let path = "G0 X-2 Y-2\nG1 Z-1\nG1 X62\nG1 Y32\nG1 X-2\nG1 Y-2\n";
        let found = left(path, &part, Remainder::Inside, 2.0);
        assert!(found.places.len() == 1 && (found.area_mm2 - 12.0).abs() < 0.01, "{found:?}");
        assert!((found.places[0].depth_mm - 1.4415).abs() < 0.03, "{:?}", found.places[0].depth_mm);
    }

    #[test]
    fn a_part_that_the_frame_of_another_one_touches_is_cut_free() {
        // The corner of the frame around what a tool of 10 mm sweeps around the first part lies on the second one.
        let square = |x: f64, y: f64| polygon(&[[x, y], [x + 20.0, y], [x + 20.0, y + 20.0], [x, y + 20.0]]);
        let part = Region::new(vec![square(0.0, 0.0), square(35.0, 20.0)]);
        let around = |x0: f64, y0: f64, x1: f64, y1: f64| {
            let path = format!("G0 X{x0} Y{y0}\nG1 Z-1\nG1 X{x1}\nG1 Y{y1}\nG1 X{x0}\nG1 Y{y0}\nG0 Z5\n");
            read(&format!("{HEAD}{path}")).unwrap()
        };
        let (first, second) = (around(-5.0, -5.0, 25.0, 25.0), around(34.5, 19.5, 55.5, 40.5));
        let runs = [(&first, 5.0), (&second, 0.5)].map(|(p, tool_radius)| Run { motions: &p.motions, tool_radius });
        let found = uncut_by(&runs, &part, Remainder::Inside, -1.0);
        assert!(found.is_cut_free && found.places.is_empty(), "{found:?}");
        // And one that is not, is not.
        assert!(!uncut_by(&runs[..1], &part, Remainder::Inside, -1.0).is_cut_free);
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
