//! What a program leaves standing next to the part: where the tool did not reach.
//!
//! Stages: the motions that reach the floor are joined to paths and stroked with the tool; strokes and outlines fall into groups
//! that lie apart; of each, stock less swept less part
//! is what stands beside the part; pieces of it that hang on the part are its places. A thin skin around the part is
//! taken away first, because the rounding of a program leaves hairs between the places, and is given back by the
//! length of contact.

use std::collections::HashSet;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

use super::motion::{Motion, MotionKind, Program};
use super::solid::{Remainder, Solid};
use super::stroke::{Polygon, Stroke, joined_lines};
use crate::plane::{Bounds, Point, Region, Ring, Segment, groups_apart, inscribed_circle};
use crate::threads;

/// Thickness of the skin in millimetres: a few times what three decimals of a millimetre round away.
const SKIN: f64 = 0.004;

/// Places thinner than this, in millimetres, are rounding and not left standing.
pub const LEAST_UNCUT_DEPTH: f64 = 0.012;

/// Chord error of the overlay in millimetres: hairs of it stay within the skin.
const FLATTENING: f64 = 0.1 * SKIN;

/// Lines whose ends are this near to one line are taken as one, in millimetres: half of what three decimals round away.
const STRAIGHTNESS: f64 = 5e-4;

/// Motions this much above the floor, in millimetres, still reach it.
pub(super) const FLOOR_ROUNDING: f64 = 0.005;

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
    let mut cut = Vec::new();
    for (paths, radius) in &paths {
        let stroke = Stroke { radius: *radius, tolerance: FLATTENING };
        for path in paths {
            match path.as_slice() {
                // A plunge.
                [point] if point.start == point.end => cut.push(stroke.disk(point.start)),
                _ => cut.extend(stroke.rings(&joined_lines(path, STRAIGHTNESS))),
            }
        }
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
    // What lies around all groups hangs together: nothing that stands alone is shared by two of them.
    let around: Vec<Bounds> =
        cut.iter().map(|ring| Bounds::of_points(ring.iter().map(|&[x, y]| Point::new(x, y)))).collect();
    let groups: Vec<Group> = groups_apart(&around)
        .into_iter()
        .map(|members| {
            let frame = members.iter().fold(Bounds::EMPTY, |b, &k| b.union(around[k])).inflated(largest_radius);
            let around_pocket = (remainder == Remainder::Outside).then(|| rectangle(frame));
            Group {
                frame,
                cut: members.into_iter().map(|k| std::mem::take(&mut cut[k])).chain(around_pocket).collect(),
            }
        })
        .collect();
    let found = threads::map_long(&groups, threads::available(), |group| group.uncut(&solid));
    let mut result = Uncut { is_cut_free: true, ..Uncut::default() };
    for group in found {
        result.area_mm2 += group.area_mm2;
        result.places.extend(group.places);
        result.is_cut_free &= group.is_cut_free;
    }
    result.places.sort_by(|a, b| b.area_mm2.total_cmp(&a.area_mm2));
    result
}

/// Rings of what is swept and of the part with its skin, away from all others.
struct Group {
    frame: Bounds,
    cut: Vec<Polygon>,
}

impl Group {
    /// What stands within the frame.
    fn uncut(&self, solid: &Solid) -> Uncut {
        let stock = vec![rectangle(self.frame)];
        let left = stock.overlay_as::<i64>(&self.cut, OverlayRule::Difference, FillRule::NonZero);
        let mut result = Uncut { is_cut_free: true, ..Uncut::default() };
        for shape in left {
            let vertices = || shape.iter().flatten().map(|&[x, y]| Point::new(x, y));
            if !vertices().any(|p| solid.boundary.is_nearer(p, 1.5 * SKIN)) {
                continue;
            }
            if solid.remainder == Remainder::Inside && vertices().any(|p| is_on_frame(p, &self.frame)) {
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
}

/// The paths of all motions at the floor, joined where they follow each other; each trace once. A plunge is a line
/// without length.
pub(super) fn paths_at_floor(motions: &[Motion], floor: f64) -> Vec<Vec<Segment>> {
    let mut seen = HashSet::new();
    let mut paths: Vec<Vec<Segment>> = Vec::new();
    let mut is_open = false;
    for motion in motions {
        if matches!(motion.kind, MotionKind::Dwell { .. }) {
            continue;
        }
        let plunge = motion.trace().next().is_none().then(|| Segment::line(motion.to.xy(), motion.to.xy()));
        let lowest_that_counts = if plunge.is_some() { motion.to.z } else { motion.from.z.max(motion.to.z) };
        if lowest_that_counts > floor + FLOOR_ROUNDING {
            is_open = false;
            continue;
        }
        for element in motion.trace().chain(plunge) {
            let key = [element.start.x, element.start.y, element.end.x, element.end.y, element.sweep()];
            if !seen.insert(key.map(f64::to_bits)) {
                is_open = false;
                continue;
            }
            match paths.last_mut().filter(|_| is_open) {
                Some(path) => path.push(element),
                None => paths.push(vec![element]),
            }
            is_open = true;
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
    fn rounding_leaves_nothing() {
        // Two thousandths too far away all around.
        let part = Region::new(vec![polygon(&[[0.0, 0.0], [60.0, 0.0], [60.0, 30.0], [0.0, 30.0]])]);
        let path = "G0 X-2.002 Y-2.002\nG1 Z-1\nG1 X62.002\nG1 Y32.002\nG1 X-2.002\nG1 Y-2.002\n";
        let found = left(path, &part, Remainder::Inside, 2.0);
        assert!(found.is_cut_free && found.places.is_empty(), "{found:?}");
    }
}
