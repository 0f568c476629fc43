//! Rims on one sheet filled with triangles, from where they are nearest.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

use crate::mesh::{Point, Vector};

/// Rims face each other where their normals agree by this cosine.
const ALIKE: f64 = 0.3;

/// The way from a rim to one that it faces leaves it at an angle whose sine is at least this.
const FACING: f64 = 0.3;

/// Rims that overlap by less than this many edge lengths face each other, too.
const OVERLAP: f64 = 0.7;

/// An edge counts as longer by this factor where its triangle turns its back on the ball.
const TURNED: f64 = 8.0;

/// A vertex of a rim.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub vertex: u32,
    pub point: Point,
    /// The normal of the closing, where the vertex moved.
    pub normal: Option<Vector>,
}

/// Rims that belong together, and the triangles between them.
#[derive(Clone, Debug)]
pub(super) struct Strip {
    /// The vertices of the rims.
    pub corners: Vec<u32>,
    pub triangles: Vec<[u32; 3]>,
    /// A polygon that is left, where edges between its corners are taken by others; it wants a vertex in the middle.
    pub rest: Vec<u32>,
}

/// Fills rims, which run as the triangles are to: what is missing lies on their left. Rims that lie side by side within
/// `reach` are joined. `is_edge` tells the edges that there are.
pub(super) fn zip(rims: &[Vec<Corner>], reach: f64, edge: f64, is_edge: impl Fn(u32, u32) -> bool) -> Vec<Strip> {
    let (polygons, bridges) = join(rims.to_vec(), reach, edge, &is_edge);
    let mut edges: BTreeSet<(u32, u32)> = bridges.into_iter().collect();
    let mut strips = Vec::new();
    for polygon in polygons {
        let (triangles, rest) = cut_ears(&polygon, |a, b| is_edge(a, b) || edges.contains(&(a.min(b), a.max(b))));
        for t in &triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                edges.insert((a.min(b), a.max(b)));
            }
        }
        strips.push(Strip { corners: polygon.iter().map(|c| c.vertex).collect(), triangles, rest });
    }
    strips
}

/// Joins rims by bridges between the nearest vertices that face each other, until none are left.
fn join(
    rims: Vec<Vec<Corner>>,
    reach: f64,
    edge: f64,
    is_edge: &impl Fn(u32, u32) -> bool,
) -> (Vec<Vec<Corner>>, Vec<(u32, u32)>) {
    // Direction from each vertex to what is missing.
    let inward = |rim: &[Corner], k: usize| {
        let (before, after) = (rim[(k + rim.len() - 1) % rim.len()], rim[(k + 1) % rim.len()]);
        let n = rim[k].normal?;
        n.cross(&(after.point - before.point)).try_normalize(0.0)
    };
    let mut all: Vec<(usize, Corner, Vector)> = Vec::new();
    for (i, rim) in rims.iter().enumerate() {
        for (k, c) in rim.iter().enumerate() {
            if let Some(d) = inward(rim, k) {
                all.push((i, *c, d));
            }
        }
    }
    // By cells as large as the reach, each corner meets those of its own and the neighbouring ones.
    let cell = |p: &Point| [p.x, p.y, p.z].map(|x| (x / reach).floor() as i64);
    let mut cells: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
    for (k, (_, c, _)) in all.iter().enumerate() {
        cells.entry(cell(&c.point)).or_default().push(k);
    }
    let mut pairs: Vec<(f64, [u32; 2], [usize; 2])> = Vec::new();
    for (k, (i, a, d)) in all.iter().enumerate() {
        let [x, y, z] = cell(&a.point);
        let near = (0..27).filter_map(|n| cells.get(&[x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1]));
        for (j, b, e) in near.flatten().filter(|&&l| l > k).map(|&l| &all[l]) {
            let along = b.point - a.point;
            let length = along.norm();
            let (Some(m), Some(n)) = (a.normal, b.normal) else { continue };
            let facing = |d: &Vector, along: Vector| d.dot(&along) > FACING * length || length < OVERLAP * edge;
            if i != j && length <= reach && m.dot(&n) > ALIKE && facing(d, along) && facing(e, -along) {
                pairs.push((length, [a.vertex, b.vertex], [*i, *j]));
            }
        }
    }
    pairs.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
    // The polygon that each rim is a part of by now.
    let mut part_of: Vec<usize> = (0..rims.len()).collect();
    let mut polygons: Vec<Option<Vec<Corner>>> = rims.into_iter().map(Some).collect();
    let mut bridges = Vec::new();
    for (_, [u, v], [i, j]) in pairs {
        let (p, q) = (part_of[i].min(part_of[j]), part_of[i].max(part_of[j]));
        if p == q || is_edge(u, v) {
            continue;
        }
        let (Some(one), Some(other)) = (&polygons[p], &polygons[q]) else { continue };
        let at = |polygon: &[Corner]| polygon.iter().position(|c| c.vertex == u || c.vertex == v);
        let (Some(at), Some(from)) = (at(one), at(other)) else { continue };
        let mut joined: Vec<Corner> = one[..=at].to_vec();
        joined.extend(other[from..].iter().chain(&other[..=from]));
        joined.extend(&one[at..]);
        polygons[p] = Some(joined);
        polygons[q] = None;
        part_of.iter_mut().filter(|part| **part == q).for_each(|part| *part = p);
        bridges.push((u.min(v), u.max(v)));
    }
    (polygons.into_iter().flatten().collect(), bridges)
}

/// A length to sort by.
#[derive(Clone, Copy, PartialEq)]
struct Length(f64);

impl Eq for Length {}

impl PartialOrd for Length {
    fn partial_cmp(&self, other: &Length) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Length {
    fn cmp(&self, other: &Length) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// Cuts ears off a polygon, that with the shortest new edge first.
fn cut_ears(polygon: &[Corner], is_edge: impl Fn(u32, u32) -> bool) -> (Vec<[u32; 3]>, Vec<u32>) {
    let mut triangles = Vec::new();
    let n = polygon.len();
    let mut next: Vec<usize> = (0..n).map(|k| (k + 1) % n).collect();
    let mut before: Vec<usize> = (0..n).map(|k| (k + n - 1) % n).collect();
    let mut version = vec![0u32; n];
    let mut made = BTreeSet::new();
    let cost = |p: usize, q: usize, s: usize| {
        let [a, b, c] = [p, q, s].map(|k| polygon[k].point);
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default();
        let agreement = [p, q, s].iter().filter_map(|&k| polygon[k].normal).map(|m| m.dot(&normal)).fold(1.0, f64::min);
        (c - a).norm() * if agreement < ALIKE { TURNED } else { 1.0 }
    };
    let mut ears: BinaryHeap<Reverse<(Length, usize, u32)>> =
        (0..n).map(|q| Reverse((Length(cost(before[q], q, next[q])), q, 0))).collect();
    let mut left = n;
    while left > 2 {
        let Some(Reverse((_, q, seen))) = ears.pop() else { break };
        if version[q] != seen {
            continue;
        }
        let (p, s) = (before[q], next[q]);
        let (a, c) = (polygon[p].vertex, polygon[s].vertex);
        let key = (a.min(c), a.max(c));
        if left > 3 && (a == c || is_edge(a, c) || made.contains(&key)) {
            continue;
        }
        triangles.push([a, polygon[q].vertex, c]);
        made.insert(key);
        (next[p], before[s]) = (s, p);
        version[q] = u32::MAX;
        left -= 1;
        for k in [p, s] {
            version[k] += 1;
            ears.push(Reverse((Length(cost(before[k], k, next[k])), k, version[k])));
        }
    }
    let mut rest = Vec::new();
    if left > 2
        && let Some(first) = (0..n).find(|&k| version[k] != u32::MAX)
    {
        let mut at = first;
        while rest.is_empty() || at != first {
            rest.push(polygon[at].vertex);
            at = next[at];
        }
    }
    (triangles, rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of corners in the plane z = 0 whose normal is up, the hole on its left where it runs counterclockwise.
    fn ring(first: u32, radius: f64, n: u32, counterclockwise: bool) -> Vec<Corner> {
        let corner = |k: u32| {
            let turn = if counterclockwise { 1.0 } else { -1.0 };
            let (s, c) = (turn * std::f64::consts::TAU * f64::from(k) / f64::from(n)).sin_cos();
            Corner { vertex: first + k, point: Point::new(radius * c, radius * s, 0.0), normal: Some(Vector::z()) }
        };
        (0..n).map(corner).collect()
    }

    fn area(strips: &[Strip], corners: &[Vec<Corner>]) -> f64 {
        let place = |v: u32| corners.iter().flatten().find(|c| c.vertex == v).unwrap().point;
        let twice = |t: &[u32; 3]| {
            let [a, b, c] = t.map(place);
            (b - a).cross(&(c - a)).z
        };
        strips.iter().flat_map(|s| &s.triangles).map(|t| twice(t) / 2.0).sum()
    }

    #[test]
    fn rims_side_by_side_are_joined_by_a_strip() {
        let rims = vec![ring(0, 1.0, 24, true), ring(100, 0.8, 20, false)];
        let strips = zip(&rims, 0.5, 0.25, |_, _| false);
        assert_eq!(strips.len(), 1);
        assert_eq!(strips[0].triangles.len(), 24 + 20);
        let ring_area = |r: f64, n: f64| 0.5 * n * r * r * (std::f64::consts::TAU / n).sin();
        let expected = ring_area(1.0, 24.0) - ring_area(0.8, 20.0);
        assert!((area(&strips, &rims) - expected).abs() < 1e-12, "no triangle lies on another");
    }

    #[test]
    fn a_rim_alone_is_filled_with_triangles_between_its_corners() {
        let rims = vec![ring(0, 1.0, 12, true), ring(100, 0.2, 5, false)];
        let strips = zip(&rims, 0.5, 0.25, |_, _| false);
        assert_eq!(strips.len(), 2, "rims farther apart than the reach are not joined");
        assert_eq!(strips[0].triangles.len(), 10);
        assert!(strips[0].rest.is_empty());
    }

    #[test]
    fn edges_that_there_are_already_are_not_made_again() {
        // Both diagonals of a square are taken: it is left, for a vertex in its middle.
        let rims = vec![ring(0, 1.0, 4, true)];
        let strips = zip(&rims, 0.5, 0.25, |a, b| a % 2 == b % 2);
        assert!(strips[0].triangles.is_empty());
        assert_eq!(strips[0].rest.len(), 4);
    }
}
