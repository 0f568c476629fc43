//! Faces that pass through each other.
//!
//! Two triangles cross where each has corners on both sides of the other's plane and they have a piece of the line common to
//! both planes in common (Möller, 1997), or where they lie in one plane and overlap. Surfaces that only touch, and neighbours
//! with a corner or an edge in common, do not cross unless they do so elsewhere, or are folded onto each other. Corners at
//! bit-identical places count as one.

use super::{Hierarchy, Point, TriangleMesh, Vector};
use crate::threads;

/// Nearer to a plane than this, over the longest edge of both triangles, is in the plane; a thousand times what rounding does to
/// well shaped ones, and what makes the line common to two planes known to seven digits.
const IN_PLANE: f64 = 1e-9;

/// What is shared must be longer than this over the longest edge of the smaller triangle: less is a touch.
const OVERLAP: f64 = 1e-6;

/// All pairs of faces that pass through each other, each once with the lower number first, in order.
///
/// A surface that crosses another one exactly along edges that lie in the planes of its faces is not seen: each of these
/// faces only touches. Triangles without area cross nothing.
pub fn self_intersections(mesh: &TriangleMesh) -> Vec<(u32, u32)> {
    let hierarchy = Hierarchy::new(&mesh.points, &mesh.faces);
    let pairs = all(&hierarchy, usize::MAX).into_iter();
    pairs.filter(|(.., meeting)| *meeting != Meeting::Same).map(|(f, g, _)| (f, g)).collect()
}

/// The pairs of faces that pass through each other of which at least one is among `faces`; `hierarchy` is that of all faces of
/// the mesh that count.
pub fn self_intersections_of(
    mesh: &TriangleMesh,
    hierarchy: &Hierarchy,
    faces: impl IntoIterator<Item = u32>,
) -> Vec<(u32, u32)> {
    let mut pairs = vec![];
    for f in faces {
        let [a, b, c] = mesh.triangle(f as usize);
        hierarchy.any_in_box(a.inf(&b).inf(&c), a.sup(&b).sup(&c), |g| {
            if f != g && cross([a, b, c], mesh.triangle(g as usize)) {
                pairs.push((f.min(g), f.max(g)));
            }
            false
        });
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// How two triangles meet beyond a touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Meeting {
    /// They pass through each other.
    Through,
    /// They overlap in one plane.
    Overlap,
    /// All three corners are the same places.
    Same,
}

/// All pairs that meet, or as many as were found first.
pub(super) fn all(hierarchy: &Hierarchy, most: usize) -> Vec<(u32, u32, Meeting)> {
    // Each piece finds its first ones, whatever the others do.
    let found = threads::map_long(&hierarchy.pieces(), threads::available(), |&piece| {
        let mut pairs = vec![];
        hierarchy.any_pair(piece, |[f, g], [one, other]| {
            if pairs.len() < most
                && let Some(meeting) = meeting(*one, *other)
            {
                pairs.push((f.min(g), f.max(g), meeting));
            }
            pairs.len() >= most
        });
        pairs
    });
    let mut pairs: Vec<(u32, u32, Meeting)> = found.into_iter().flatten().take(most).collect();
    pairs.sort_unstable();
    pairs
}

/// A triangle with its plane.
struct Flat {
    corners: [Point; 3],
    /// Of unit length.
    normal: Vector,
    longest: f64,
}

impl Flat {
    /// None where the triangle has no area.
    fn new(corners: [Point; 3]) -> Option<Flat> {
        let [a, b, c] = corners;
        let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared()).sqrt();
        let normal = (b - a).cross(&(c - a));
        let length = normal.norm();
        (length > IN_PLANE * longest * longest).then(|| Flat { corners, normal: normal / length, longest })
    }

    /// How far the corners of another triangle are from the plane; 0 within the tolerance.
    fn distances(&self, other: &Flat) -> [f64; 3] {
        let near = IN_PLANE * self.longest.max(other.longest);
        // From the corner that is nearest: what both share is exactly in the plane.
        other.corners.map(|p| {
            let distance = self.normal.dot(&(p - self.corners[0]));
            if distance.abs() <= near || self.corners.contains(&p) { 0.0 } else { distance }
        })
    }

    /// The piece of a line that lies in the triangle, whose corners are so far from a plane through the line.
    fn piece(&self, distances: [f64; 3], origin: Point, along: Vector) -> [f64; 2] {
        let mut piece = [f64::INFINITY, f64::NEG_INFINITY];
        for k in 0..3 {
            let (d, e) = (distances[k], distances[(k + 1) % 3]);
            let (p, q) = (self.corners[k], self.corners[(k + 1) % 3]);
            let at = match d {
                0.0 => p,
                _ if d * e < 0.0 => p + (q - p) * (d / (d - e)),
                _ => continue,
            };
            let t = along.dot(&(at - origin));
            piece = [piece[0].min(t), piece[1].max(t)];
        }
        piece
    }
}

/// Whether two triangles pass through each other, or overlap in one plane.
pub fn cross(one: [Point; 3], other: [Point; 3]) -> bool {
    matches!(meeting(one, other), Some(Meeting::Through | Meeting::Overlap))
}

/// How two triangles meet, if they do more than touch.
fn meeting(one: [Point; 3], other: [Point; 3]) -> Option<Meeting> {
    if is_clearly_beside(&one, &other) {
        return None;
    }
    let shared = one.iter().filter(|p| other.contains(p)).count();
    let (one, other) = (Flat::new(one)?, Flat::new(other)?);
    if shared == 3 {
        return Some(Meeting::Same);
    }
    let of_other = one.distances(&other);
    if of_other.iter().all(|d| *d == 0.0) {
        return overlap(&one, &other).then_some(Meeting::Overlap);
    }
    let is_beside = |d: [f64; 3]| d.iter().all(|d| *d >= 0.0) || d.iter().all(|d| *d <= 0.0);
    let of_one = other.distances(&one);
    if of_one.iter().all(|d| *d == 0.0) {
        return overlap(&other, &one).then_some(Meeting::Overlap);
    }
    if shared == 2 || is_beside(of_other) || is_beside(of_one) {
        return None;
    }
    let along = one.normal.cross(&other.normal).try_normalize(0.0)?;
    let origin = one.corners[0];
    let [from, to] = one.piece(of_one, origin, along);
    let [low, high] = other.piece(of_other, origin, along);
    let is_long = to.min(high) - from.max(low) > OVERLAP * one.longest.min(other.longest);
    is_long.then_some(Meeting::Through)
}

/// Whether the second triangle is on one side of the plane of the first, far beyond rounding, and the first not in its plane: what
/// [`meeting`] would find, in a fraction of the time. Around a vertex of thousands of faces each is asked about each.
fn is_clearly_beside(one: &[Point; 3], other: &[Point; 3]) -> bool {
    let size = one.iter().chain(other).map(|p| (p - one[0]).amax()).fold(0.0, f64::max);
    // No two of the six are farther from each other than this.
    let near = IN_PLANE * 4.0 * size;
    let sides = |[a, b, c]: &[Point; 3], of: &[Point; 3]| {
        let normal = (b - a).cross(&(c - a));
        let margin = near * normal.abs().sum();
        let own = [*a, *b, *c];
        let of = of.map(|p| if own.contains(&p) { 0.0 } else { normal.dot(&(p - a)) });
        (of, margin)
    };
    let (of_other, margin) = sides(one, other);
    let is_on = |sign: f64| of_other.iter().all(|d| *d == 0.0 || sign * d > margin);
    if of_other.iter().all(|d| *d == 0.0) || !(is_on(1.0) || is_on(-1.0)) {
        return false;
    }
    let (of_one, margin) = sides(other, one);
    of_one.iter().any(|d| d.abs() > margin)
}

/// Whether two triangles in the plane of the first one have some area in common: no edge parts them.
fn overlap(one: &Flat, other: &Flat) -> bool {
    let least = OVERLAP * one.longest.min(other.longest);
    let parts = |triangle: &Flat, from: &Flat| {
        (0..3).any(|k| {
            let (p, q) = (triangle.corners[k], triangle.corners[(k + 1) % 3]);
            let inward = one.normal.cross(&(q - p)).normalize();
            // The other triangle may run the other way round in this plane.
            let own = inward.dot(&(triangle.corners[(k + 2) % 3] - p));
            let inward = inward * own.signum();
            from.corners.iter().all(|c| inward.dot(&(c - p)) <= least)
        })
    };
    !parts(one, other) && !parts(other, one)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both triangles, each from each corner and reversed, moved and turned.
    fn assert_cross(one: [[f64; 3]; 3], other: [[f64; 3]; 3], expected: bool) {
        let turned = |t: [[f64; 3]; 3], step: usize| {
            let rotation = nalgebra::Rotation3::from_euler_angles(0.3, 1.1, -0.7);
            t.map(|p| match step {
                0 => Point::from(p),
                1 => rotation * Point::from(p),
                _ => rotation * Point::from(p) * 1e-3 + Vector::new(5.0, -7.0, 11.0),
            })
        };
        for step in 0..3 {
            let (one, other) = (turned(one, step), turned(other, step));
            for k in 0..6 {
                let order = if k < 3 { [k, (k + 1) % 3, (k + 2) % 3] } else { [k % 3, (k + 2) % 3, (k + 1) % 3] };
                assert_eq!(cross(order.map(|i| one[i]), other), expected, "{one:?} {other:?}");
                assert_eq!(cross(other, order.map(|i| one[i])), expected, "{other:?} {one:?}");
            }
        }
    }

    const FLOOR: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    #[test]
    fn triangles_cross_where_they_pass_through_each_other() {
        assert_cross(FLOOR, [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, 9.0, 1.0]], true);
        // A spike, a blade across all of it, and what passes beside.
        assert_cross(FLOOR, [[1.0, 1.0, -1.0], [1.2, 1.0, 3.0], [1.0, 1.2, 3.0]], true);
        assert_cross(FLOOR, [[-9.0, 1.0, -1.0], [9.0, 1.0, -1.0], [0.0, 1.0, 9.0]], true);
        assert_cross(FLOOR, [[3.0, 3.0, -1.0], [3.0, 3.0, 1.0], [9.0, 9.0, 1.0]], false);
        assert_cross(FLOOR, [[1.0, 1.0, 0.5], [1.0, 1.0, 1.0], [1.0, 9.0, 1.0]], false);
    }

    #[test]
    fn triangles_that_touch_do_not_cross() {
        // With a corner, an edge, a face, a corner at the border.
        assert_cross(FLOOR, [[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [1.0, 2.0, 1.0]], false);
        assert_cross(FLOOR, [[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.0, 2.0, 1.0]], false);
        assert_cross(FLOOR, [[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [4.0, 4.0, 0.0]], false);
        assert_cross(FLOOR, [[2.0, 0.0, -1.0], [2.0, 0.0, 1.0], [2.0, -3.0, 0.5]], false);
    }

    #[test]
    fn neighbours_cross_only_beyond_what_they_share() {
        // An edge in common: at any angle but zero.
        assert_cross(FLOOR, [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.01]], false);
        assert_cross(FLOOR, [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 1.0, 0.0]], true);
        assert_cross(FLOOR, [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, -1.0, 0.0]], false);
        // A corner in common.
        assert_cross(FLOOR, [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [1.0, 1.0, -1.0]], true);
        assert_cross(FLOOR, [[0.0, 0.0, 0.0], [-1.0, -1.0, 1.0], [-1.0, -1.0, -1.0]], false);
        assert_cross(FLOOR, [[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [2.0, 1.0, 0.0]], true);
        assert_cross(FLOOR, [[0.0, 0.0, 0.0], [-1.0, 2.0, 0.0], [-2.0, 1.0, 0.0]], false);
        assert_cross(FLOOR, FLOOR, false);
        // In one plane, without a corner in common.
        assert_cross(FLOOR, [[1.0, 1.0, 0.0], [9.0, 1.0, 0.0], [9.0, 2.0, 0.0]], true);
        assert_cross(FLOOR, [[5.0, 0.0, 0.0], [9.0, 1.0, 0.0], [9.0, 2.0, 0.0]], false);
    }

    #[test]
    fn all_pairs_or_those_of_some_faces() {
        // A floor of two triangles, with a spike of three through one of them.
        let points = [
            [0.0, 0.0, 0.0],
            [4.0, 0.0, 0.0],
            [4.0, 4.0, 0.0],
            [0.0, 4.0, 0.0],
            [3.0, 1.0, -1.0],
            [3.1, 1.0, 1.0],
            [3.0, 1.1, 1.0],
            [2.9, 0.9, 1.0],
        ];
        let faces = vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7], [4, 7, 5]];
        let mesh = TriangleMesh::new(points.map(Point::from).to_vec(), faces);
        assert_eq!(self_intersections(&mesh), [(0, 2), (0, 3), (0, 4)]);
        let hierarchy = Hierarchy::new(&mesh.points, &mesh.faces);
        assert_eq!(self_intersections_of(&mesh, &hierarchy, [3, 1]), [(0, 3)]);
        assert_eq!(self_intersections_of(&mesh, &hierarchy, [0, 2]), [(0, 2), (0, 3), (0, 4)]);
        assert_eq!(all(&hierarchy, 2).len(), 2);
    }
}
