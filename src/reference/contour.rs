//! Level sets on the cells of a grid that they pass through, with their sharp edges and corners: dual contouring (Ju, Losasso,
//! Schaefer and Warren, 2002), a vertex for each sheet in a cell as in dual marching cubes (Nielson, 2004).
//!
//! 1. Cells are halved from one that holds everything down to the voxel, as long as the level can be in them: the field is a
//!    distance, which changes by no more than the way.
//! 2. Edges of cells whose ends lie on both sides are crossed somewhere: where, and with which normal, is found by secants.
//! 3. Each sheet in a cell gets the point that is nearest to the tangent planes of its crossings.
//! 4. Around each crossed edge four such points make a quad, which is cut along the diagonal that keeps to the level.

use super::volume::{LONGEST_SIDE, MOST_CELLS, VolumeError};
use crate::mesh::{Point, TriangleMesh, Vector};
use crate::threads;

/// A distance from the level, negative inside, and the direction in which it grows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) value: f64,
    pub(super) gradient: Vector,
}

/// Steps towards the crossing of an edge: each takes an error down by about its square.
const SECANTS: usize = 3;

/// Directions in which the normals of a sheet say less than this fraction of what they say in the best one are left to the
/// mean of the crossings: a curved sheet is no edge. It stands for normals about 10° to either side of their mean.
const FLATNESS: f64 = 0.01;

/// How far beyond its cell a point may lie, in voxels: where an edge of the surface grazes the cell.
const BEYOND: f64 = 0.3;

/// The offset of the grid, in voxels: so that planes of models at round numbers are no planes of the grid.
const SHIFT: [f64; 3] = [0.37, 0.41, 0.43];

/// So many cells tell how many there will be, but for a factor of four.
const TELLING: usize = 1 << 14;

/// Slack of the test for the level in a cell, for rounding.
const SLACK: f64 = 1.0 + 1e-6;

/// Bits of a coordinate in a key.
const BITS: u32 = 20;

/// A cell or a corner as one number, ordered by x, then y, then z.
fn key([x, y, z]: [u32; 3]) -> u64 {
    u64::from(x) << (2 * BITS) | u64::from(y) << BITS | u64::from(z)
}

fn place(key: u64) -> [u32; 3] {
    [2 * BITS, BITS, 0].map(|shift| (key >> shift) as u32 & ((1 << BITS) - 1))
}

/// The step of a key along an axis.
fn step(axis: usize) -> u64 {
    1 << (BITS * (2 - axis as u32))
}

/// Corner `c` of a cell: bit k of it is the offset along axis k.
fn corner_key(cell: u64, c: usize) -> u64 {
    cell + (0..3).filter(|k| c >> k & 1 == 1).map(step).sum::<u64>()
}

/// An edge of a cell is 4 axis + the offsets along the two next axes, the first of them counting 1 and the second 2. The
/// lower one of its corners.
fn edge_start(edge: usize) -> usize {
    let axis = edge / 4;
    (edge & 1) << ((axis + 1) % 3) | (edge >> 1 & 1) << ((axis + 2) % 3)
}

/// The grid: where its corners are.
struct Grid {
    origin: Point,
    voxel: f64,
}

impl Grid {
    fn point(&self, key: u64) -> Point {
        self.origin + Vector::from(place(key).map(f64::from)) * self.voxel
    }
}

/// The surface where `field` is zero, within `bounds`, seen from where it is positive.
pub(super) fn contour(
    field: &(impl Fn(Point) -> Sample + Sync),
    [low, high]: [Point; 2],
    voxel: f64,
) -> Result<TriangleMesh, VolumeError> {
    let grid = Grid { origin: low - Vector::from(SHIFT) * voxel, voxel };
    let cells = leaves(field, &grid, high)?;
    let mut corners: Vec<u64> = cells.iter().flat_map(|&cell| (0..8).map(move |c| corner_key(cell, c))).collect();
    corners.sort_unstable();
    corners.dedup();
    let values = threads::map(&corners, threads::available(), |&k| field(grid.point(k)).value);
    let edges = crossed_edges(&corners, &values);
    let crossings = threads::map(&edges, threads::available(), |e| crossing(field, &grid, e));
    // Which edge belongs to which sheet of a cell, for every pattern of its corners.
    let sheets: Vec<[u8; 12]> = (0..256).map(sheets_of).collect();
    let active: Vec<Active> = cells.iter().filter_map(|&cell| Active::new(cell, &corners, &values)).collect();
    let placed = threads::map(&active, threads::available(), |cell| {
        cell.vertices(&grid, &sheets[cell.pattern], &edges, &crossings)
    });
    let mut firsts = Vec::with_capacity(active.len());
    let mut mesh = TriangleMesh::default();
    for points in &placed {
        firsts.push(mesh.points.len() as u32);
        mesh.points.extend(points);
    }
    let quads: Vec<[u32; 4]> = edges.iter().filter_map(|e| quad(e, &active, &sheets, &firsts)).collect();
    let points = &mesh.points;
    let cut = threads::map(&quads, threads::available(), |&[a, b, c, d]| {
        let off = |p: u32, q: u32| field(nalgebra::center(&points[p as usize], &points[q as usize])).value.abs();
        if off(a, c) <= off(b, d) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    });
    mesh.faces = cut.into_iter().flatten().collect();
    Ok(mesh)
}

/// The cells that the level can be in, ordered.
fn leaves(field: &(impl Fn(Point) -> Sample + Sync), grid: &Grid, high: Point) -> Result<Vec<u64>, VolumeError> {
    let voxel = grid.voxel;
    let sides = (high - grid.origin) / voxel;
    let longest = sides.max();
    // One corner more than cells must have a number.
    let limit = f64::from(LONGEST_SIDE - 2);
    // Also where it is infinite or no number.
    if !longest.is_finite() || longest >= limit {
        return Err(VolumeError::TooFine { voxel, suggestion: voxel * longest / limit * 1.1 });
    }
    let counts = [0, 1, 2].map(|k| sides[k].ceil().max(1.0) as u32);
    let mut size = counts.into_iter().fold(1, u32::max).next_power_of_two();
    let mut cells = vec![[0u32; 3]];
    while size > 1 {
        size /= 2;
        let halved = |c: [u32; 3]| (0..8u32).map(move |k| [0, 1, 2].map(|i| c[i] + (k >> i & 1) * size));
        let inside = |c: &[u32; 3]| (0..3).all(|k| c[k] < counts[k]);
        let candidates: Vec<[u32; 3]> = cells.iter().copied().flat_map(halved).filter(inside).collect();
        let reach = f64::from(size) * voxel * 0.75f64.sqrt() * SLACK;
        let is_met = threads::map(&candidates, threads::available(), |c| {
            let middle = c.map(|x| f64::from(x) + 0.5 * f64::from(size));
            field(grid.origin + Vector::from(middle) * voxel).value.abs() <= reach
        });
        cells = candidates.into_iter().zip(is_met).filter(|(_, met)| *met).map(|(c, _)| c).collect();
        // A surface passes through four times as many cells of half the size, once they are small against it.
        let expected = cells.len() as f64 * f64::from(size).powi(2);
        let is_hopeless = cells.len() > TELLING && expected > 4.0 * MOST_CELLS as f64;
        if is_hopeless || cells.len() > MOST_CELLS {
            return Err(VolumeError::TooFine {
                voxel,
                suggestion: voxel * (expected / MOST_CELLS as f64).sqrt() * 1.1,
            });
        }
    }
    let mut keys: Vec<u64> = cells.into_iter().map(key).collect();
    keys.sort_unstable();
    Ok(keys)
}

/// An edge of the grid whose ends lie on both sides of the level.
struct Edge {
    start: u64,
    axis: usize,
    values: [f64; 2],
}

impl Edge {
    /// A number for the edge, in the order of the edges.
    fn key(&self) -> u64 {
        self.start << 2 | self.axis as u64
    }
}

/// All such edges, in order.
fn crossed_edges(corners: &[u64], values: &[f64]) -> Vec<Edge> {
    let mut edges = Vec::new();
    // The ends along each axis come in the order of the starts.
    let mut ends = [0usize; 3];
    for (&start, &value) in corners.iter().zip(values) {
        for (axis, end) in ends.iter_mut().enumerate() {
            let wanted = start + step(axis);
            while corners.get(*end).is_some_and(|&k| k < wanted) {
                *end += 1;
            }
            if corners.get(*end) == Some(&wanted) && (value < 0.0) != (values[*end] < 0.0) {
                edges.push(Edge { start, axis, values: [value, values[*end]] });
            }
        }
    }
    edges
}

/// A tangent plane of the level.
struct Plane {
    /// A point of the edge, as near to the level as was tried.
    at: Point,
    normal: Vector,
    /// How far the plane is from that point, along the normal.
    offset: f64,
}

/// Where an edge meets the level, by secants that keep it between two ends.
fn crossing(field: &impl Fn(Point) -> Sample, grid: &Grid, edge: &Edge) -> Plane {
    let start = grid.point(edge.start);
    let at = |t: f64| {
        let mut p = start;
        p[edge.axis] += t * grid.voxel;
        p
    };
    let ([mut from, mut to], [mut below, mut above]) = ([0.0, 1.0], edge.values);
    let mut k = 0;
    loop {
        // A corner of the field would hold one end for ever: never nearer to it than a fiftieth.
        let t = from + (to - from) * (below / (below - above)).clamp(0.02, 0.98);
        let sample = field(at(t));
        k += 1;
        if k > SECANTS || !(above - below).is_normal() {
            return Plane { at: at(t), normal: sample.gradient, offset: -sample.value };
        }
        if (sample.value < 0.0) == (below < 0.0) {
            (from, below) = (t, sample.value);
        } else {
            (to, above) = (t, sample.value);
        }
    }
}

/// The sheet of each edge in a cell whose corners inside are the bits of `pattern`: numbers from 0, 255 for edges that are not
/// crossed. Edges that are crossed on one side of the cell belong together; where all four are, those around each
/// corner inside, whichever cell asks.
fn sheets_of(pattern: usize) -> [u8; 12] {
    let inside = |c: usize| pattern >> c & 1 == 1;
    let is_crossed = |e: usize| inside(edge_start(e)) != inside(edge_start(e) | 1 << (e / 4));
    let mut sheet: [u8; 12] = std::array::from_fn(|e| if is_crossed(e) { e as u8 } else { u8::MAX });
    let mut unite = |e: usize, f: usize| {
        let (keep, drop) = (sheet[e].min(sheet[f]), sheet[e].max(sheet[f]));
        for s in &mut sheet {
            if *s == drop {
                *s = keep;
            }
        }
    };
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for side in 0..2 {
            // Around the side: corners, and the edge from each to the next.
            let corner = |i: usize, j: usize| side << axis | i << u | j << v;
            let corners = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            // Along u the offsets are those of v and the axis; along v those of the axis and u.
            let edges = [4 * u + 2 * side, 4 * v + side + 2, 4 * u + 1 + 2 * side, 4 * v + side];
            let crossed: Vec<usize> = edges.into_iter().filter(|&e| is_crossed(e)).collect();
            match crossed[..] {
                [e, f] => unite(e, f),
                [_, _, _, _] => {
                    for k in (0..4).filter(|&k| inside(corners[k])) {
                        unite(edges[k], edges[(k + 3) % 4]);
                    }
                }
                _ => {}
            }
        }
    }
    // Numbers without gaps.
    let mut names: Vec<u8> = sheet.iter().copied().filter(|&s| s != u8::MAX).collect();
    names.sort_unstable();
    names.dedup();
    sheet.map(|s| names.iter().position(|&n| n == s).map_or(u8::MAX, |k| k as u8))
}

/// A cell that the level passes through.
struct Active {
    cell: u64,
    /// Its corners inside, as bits.
    pattern: usize,
}

impl Active {
    fn new(cell: u64, corners: &[u64], values: &[f64]) -> Option<Active> {
        let is_inside = |c: usize| corners.binary_search(&corner_key(cell, c)).is_ok_and(|i| values[i] < 0.0);
        let pattern = (0..8).filter(|&c| is_inside(c)).fold(0, |bits, c| bits | 1 << c);
        (pattern != 0 && pattern != 255).then_some(Active { cell, pattern })
    }

    /// The point of each sheet.
    fn vertices(&self, grid: &Grid, sheet: &[u8; 12], edges: &[Edge], crossings: &[Plane]) -> Vec<Point> {
        let mut planes: Vec<(u8, &Plane)> = Vec::with_capacity(12);
        for (e, &s) in sheet.iter().enumerate().filter(|(_, s)| **s != u8::MAX) {
            let wanted = corner_key(self.cell, edge_start(e)) << 2 | (e / 4) as u64;
            if let Ok(i) = edges.binary_search_by_key(&wanted, Edge::key) {
                planes.push((s, &crossings[i]));
            }
        }
        let low = grid.point(self.cell);
        let slack = Vector::repeat(BEYOND * grid.voxel);
        let (low, high) = (low - slack, low + slack + Vector::repeat(grid.voxel));
        let count = planes.iter().map(|(s, _)| s + 1).max().unwrap_or(0);
        let of_sheet = |k: u8| planes.iter().filter(move |(s, _)| *s == k).map(|(_, plane)| *plane);
        (0..count).map(|k| meeting_point(of_sheet(k)).sup(&low).inf(&high)).collect()
    }
}

/// The point nearest to all planes, and where these leave it open, to the mean of their points.
fn meeting_point<'a>(planes: impl Iterator<Item = &'a Plane> + Clone) -> Point {
    let count = planes.clone().count().max(1) as f64;
    let mean = Point::from(planes.clone().map(|p| p.at.coords).sum::<Vector>() / count);
    let (mut matrix, mut right) = (nalgebra::Matrix3::zeros(), Vector::zeros());
    for plane in planes {
        matrix += plane.normal * plane.normal.transpose();
        right += plane.normal * (plane.normal.dot(&(plane.at - mean)) + plane.offset);
    }
    let eigen = matrix.symmetric_eigen();
    let least = FLATNESS * eigen.eigenvalues.max();
    let mut point = mean;
    for k in 0..3 {
        if eigen.eigenvalues[k] > least {
            let axis = eigen.eigenvectors.column(k);
            point += axis * (axis.dot(&right) / eigen.eigenvalues[k]);
        }
    }
    point
}

/// The points around an edge, counterclockwise seen from where the field is positive.
fn quad(edge: &Edge, active: &[Active], sheets: &[[u8; 12]], firsts: &[u32]) -> Option<[u32; 4]> {
    let (u, v) = ((edge.axis + 1) % 3, (edge.axis + 2) % 3);
    let mut quad = [0; 4];
    // How many cells back along u and v.
    for (corner, (i, j)) in quad.iter_mut().zip([(1, 1), (0, 1), (0, 0), (1, 0)]) {
        let cell = edge.start.checked_sub(i * step(u) + j * step(v))?;
        let k = active.binary_search_by_key(&cell, |a| a.cell).ok()?;
        let sheet = sheets[active[k].pattern][4 * edge.axis + i as usize + 2 * j as usize];
        *corner = firsts[k] + u32::from(sheet);
    }
    if edge.values[0] >= 0.0 {
        quad.reverse();
    }
    Some(quad)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_have_the_corners_that_their_numbers_say() {
        // Every edge once, of two corners that differ in one bit.
        let mut pairs: Vec<[usize; 2]> = (0..12).map(|e| [edge_start(e), edge_start(e) | 1 << (e / 4)]).collect();
        assert!(pairs.iter().all(|[a, b]| (a ^ b).count_ones() == 1));
        pairs.sort_unstable();
        pairs.dedup();
        assert_eq!(pairs.len(), 12);
    }

    #[test]
    fn sheets_are_as_many_as_corners_that_do_not_touch() {
        let count = |pattern: usize| sheets_of(pattern).iter().filter(|s| **s != 255).max().map_or(0, |s| s + 1);
        assert_eq!((count(0), count(255)), (0, 0));
        assert_eq!((count(0b1), count(0b11), count(0b1001), count(0b1000_0001)), (1, 1, 2, 2));
        // Every second corner inside: four sheets; the opposite corners of a side outside: one sheet.
        assert_eq!((count(0b0110_1001), count(255 - 0b1001)), (4, 1));
    }

    #[test]
    fn a_cube_keeps_its_edges_and_corners() {
        let half = Vector::new(0.5, 0.6, 0.7);
        let field = |p: Point| {
            // The distance from a box, of the largest of the three.
            let d = p.coords.abs() - half;
            let k = d.imax();
            let mut gradient = Vector::zeros();
            gradient[k] = p[k].signum();
            Sample { value: d[k], gradient }
        };
        let one = Vector::repeat(1.0);
        let mesh = contour(&field, [Point::origin() - one, Point::origin() + one], 0.09).unwrap();
        assert!((mesh.volume() - 8.0 * half.product()).abs() < 1e-9, "{}", mesh.volume());
        assert_eq!(mesh.points.len() as i64 - mesh.faces.len() as i64 / 2, 2);
    }
}
