//! The triangles that fill a plane figure given by its directed edges, holes and all.
//!
//! Edges become loops, at vertices where several meet by the sector that the inside has there; loops that run clockwise are holes,
//! and hang on the loop around them by a bridge that crosses nothing; the ears of the single polygon are cut off; and edges
//! that are no part of the figure's border are turned until the triangles are Delaunay's.

use std::collections::{HashMap, HashSet};

use crate::mesh::triangulate::cut_ears;
use crate::mesh::{Point, Vector};

/// The areas of the triangles may add up to that of the figure but for this part of the square of its diagonal: anything more
/// is an overlap or a hole, not rounding.
const WRONG_AREA: f64 = 1e-9;

/// An edge is turned only if its opposite angles exceed a half turn by this: squares have two diagonals that are as good.
const SAME_ANGLES: f64 = 1e-9;

/// Edges are turned no more than so many times for each edge of the border: a guard against rounding, never seen.
const MOST_TURNS: usize = 200;

/// What closes a surface in a plane.
pub(super) struct Capped {
    pub faces: Vec<[u32; 3]>,
    /// Pieces of the border that are no loops.
    pub open_ends: usize,
}

type Flat = [f64; 2];

/// The vertices in the plane, as seen from the tip of its normal.
struct Figure {
    flat: HashMap<u32, Flat>,
    diagonal: f64,
}

/// Fills what lies to the left of the edges, seen against the normal; none where the edges cross.
pub(super) fn cap(points: &[Point], edges: &[[u32; 2]], normal: Vector) -> Option<Capped> {
    let figure = Figure::new(points, edges, normal);
    let (loops, open_ends) = figure.loops(edges);
    let area: f64 = loops.iter().map(|l| figure.area(l)).sum();
    let mut faces = vec![];
    for polygon in figure.with_holes(loops)? {
        match polygon[..] {
            [a, b, c] => faces.push([a, b, c]),
            _ => cut_ears(points, &polygon, &mut faces),
        }
    }
    figure.turn_to_delaunay(&mut faces, edges);
    let areas = || faces.iter().map(|f| figure.area(f));
    let wrong = WRONG_AREA * figure.diagonal * figure.diagonal;
    let is_right = (areas().sum::<f64>() - area).abs() <= wrong && areas().all(|a| a >= -wrong);
    is_right.then_some(Capped { faces, open_ends })
}

fn turn(a: Flat, b: Flat, c: Flat) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Whether two segments have a point in common.
fn meet(a: Flat, b: Flat, c: Flat, d: Flat) -> bool {
    let overlap = |k: usize| a[k].min(b[k]) <= c[k].max(d[k]) && c[k].min(d[k]) <= a[k].max(b[k]);
    overlap(0) && overlap(1) && turn(a, b, c) * turn(a, b, d) <= 0.0 && turn(c, d, a) * turn(c, d, b) <= 0.0
}

/// The angle from one direction counterclockwise to another, above 0 and up to a whole turn.
fn angle(from: Flat, to: Flat) -> f64 {
    let angle = (from[0] * to[1] - from[1] * to[0]).atan2(from[0] * to[0] + from[1] * to[1]);
    if angle > 0.0 { angle } else { angle + std::f64::consts::TAU }
}

impl Figure {
    fn new(points: &[Point], edges: &[[u32; 2]], normal: Vector) -> Figure {
        // Along the axes where the normal is: coordinates are then those of the surface, to the last bit.
        let mut along = Vector::zeros();
        along[(normal.iamax() + 1) % 3] = 1.0;
        let u = (along - normal * normal.dot(&along)).normalize();
        let v = normal.cross(&u);
        let origin = edges.first().map_or(Point::origin(), |e| points[e[0] as usize]);
        let at = |k: u32| points[k as usize] - origin;
        let flat: HashMap<u32, Flat> =
            edges.as_flattened().iter().map(|&k| (k, [u.dot(&at(k)), v.dot(&at(k))])).collect();
        let extent = |k: usize| {
            let most = flat.values().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
            most - flat.values().map(|p| p[k]).fold(f64::INFINITY, f64::min)
        };
        let diagonal = if flat.is_empty() { 0.0 } else { extent(0).hypot(extent(1)) };
        Figure { flat, diagonal }
    }

    fn at(&self, v: u32) -> Flat {
        self.flat[&v]
    }

    fn along(&self, a: u32, b: u32) -> Flat {
        let (p, q) = (self.at(a), self.at(b));
        [q[0] - p[0], q[1] - p[1]]
    }

    fn area(&self, polygon: &[u32]) -> f64 {
        let first = self.at(polygon[0]);
        polygon.windows(2).map(|e| 0.5 * turn(first, self.at(e[0]), self.at(e[1]))).sum()
    }

    /// The loops that edges form, and how many pieces are none.
    fn loops(&self, edges: &[[u32; 2]]) -> (Vec<Vec<u32>>, usize) {
        let mut out: HashMap<u32, Vec<u32>> = HashMap::new();
        let mut excess: HashMap<u32, i32> = HashMap::new();
        for &[a, b] in edges {
            out.entry(a).or_default().push(b);
            *excess.entry(a).or_default() += 1;
            *excess.entry(b).or_default() -= 1;
        }
        // From `b`, where one arrives from `a`, along the border of the inside on the left.
        let next = |out: &mut HashMap<u32, Vec<u32>>, a: Option<u32>, b: u32| -> Option<u32> {
            let targets = out.get_mut(&b).filter(|t| !t.is_empty())?;
            let clockwise = |&t: &u32| a.map_or(0.0, |a| angle(self.along(b, t), self.along(b, a)));
            let best = (0..targets.len()).min_by(|&i, &j| {
                clockwise(&targets[i]).total_cmp(&clockwise(&targets[j])).then(targets[i].cmp(&targets[j]))
            })?;
            Some(targets.remove(best))
        };
        // Pieces that begin somewhere end somewhere, and enclose nothing.
        let mut starts: Vec<u32> = edges.iter().map(|e| e[0]).filter(|v| excess[v] > 0).collect();
        starts.dedup();
        let mut open_ends = 0;
        for start in starts {
            for _ in 0..excess[&start] {
                open_ends += 1;
                let (mut before, mut at) = (None, start);
                while let Some(v) = next(&mut out, before, at) {
                    (before, at) = (Some(at), v);
                    if excess[&v] < 0 {
                        break;
                    }
                }
            }
        }
        let mut loops = vec![];
        for &[start, _] in edges {
            while let Some(second) = next(&mut out, None, start) {
                let mut found = vec![start];
                let (mut before, mut at) = (start, second);
                // Until it comes back along the sector in which it began.
                loop {
                    if at == start {
                        let to_second = angle(self.along(start, second), self.along(start, before));
                        let others = out.get(&start).into_iter().flatten();
                        let is_nearest = others
                            .map(|&t| angle(self.along(start, t), self.along(start, before)))
                            .all(|other| to_second <= other);
                        if is_nearest {
                            break;
                        }
                    }
                    found.push(at);
                    let Some(v) = next(&mut out, Some(before), at) else { break };
                    (before, at) = (at, v);
                }
                loops.push(found);
            }
        }
        (loops, open_ends)
    }

    /// One polygon for each loop with an inside, holes joined to it; none where a hole is in nothing or cannot be reached.
    fn with_holes(&self, loops: Vec<Vec<u32>>) -> Option<Vec<Vec<u32>>> {
        let (mut outer, holes): (Vec<Vec<u32>>, Vec<Vec<u32>>) = loops.into_iter().partition(|l| self.area(l) >= 0.0);
        let mut holes_of: Vec<Vec<Vec<u32>>> = vec![vec![]; outer.len()];
        let areas: Vec<f64> = outer.iter().map(|l| self.area(l)).collect();
        for hole in holes {
            let (p, q) = (self.at(hole[0]), self.at(hole[1]));
            let middle = [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
            let around = (0..outer.len()).filter(|&k| self.is_within(middle, &outer[k]));
            let least = around.min_by(|&i, &j| areas[i].total_cmp(&areas[j]))?;
            holes_of[least].push(hole);
        }
        for (polygon, mut holes) in outer.iter_mut().zip(holes_of) {
            let rightmost = |hole: &[u32]| {
                (0..hole.len()).max_by(|&i, &j| self.at(hole[i])[0].total_cmp(&self.at(hole[j])[0])).unwrap_or(0)
            };
            holes.iter_mut().for_each(|hole| {
                let k = rightmost(hole);
                hole.rotate_left(k);
            });
            holes.sort_by(|a, b| self.at(b[0])[0].total_cmp(&self.at(a[0])[0]).then(a[0].cmp(&b[0])));
            for k in 0..holes.len() {
                let at = self.bridge(polygon, &holes[k..])?;
                let hole = &holes[k];
                let joined = hole.iter().chain([&hole[0], &polygon[at]]).copied().collect::<Vec<u32>>();
                polygon.splice(at + 1..at + 1, joined);
            }
        }
        Some(outer)
    }

    fn is_within(&self, p: Flat, polygon: &[u32]) -> bool {
        let crossed = (0..polygon.len()).filter(|&k| {
            let (a, b) = (self.at(polygon[k]), self.at(polygon[(k + 1) % polygon.len()]));
            (a[1] > p[1]) != (b[1] > p[1]) && (turn(a, b, p) > 0.0) == (b[1] > a[1])
        });
        crossed.count() % 2 == 1
    }

    /// The nearest corner of the polygon that is seen from the first corner of the first hole.
    fn bridge(&self, polygon: &[u32], holes: &[Vec<u32>]) -> Option<usize> {
        let from = holes[0][0];
        let p = self.at(from);
        let n = polygon.len();
        let mut near: Vec<(f64, usize)> =
            (0..n).map(|k| (self.along(from, polygon[k]), k)).map(|(d, k)| (d[0] * d[0] + d[1] * d[1], k)).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let edges = |polygon: &[u32]| -> Vec<[u32; 2]> {
            (0..polygon.len()).map(|k| [polygon[k], polygon[(k + 1) % polygon.len()]]).collect()
        };
        let all: Vec<[u32; 2]> =
            std::iter::once(polygon).chain(holes.iter().map(Vec::as_slice)).flat_map(edges).collect();
        // The inside at a corner is between the edge that leaves it and the one that comes, counterclockwise.
        let sees = |before: u32, corner: u32, after: u32, to: u32| {
            let out = self.along(corner, after);
            angle(out, self.along(corner, to)) < angle(out, self.along(corner, before))
        };
        let hole = &holes[0];
        near.into_iter().map(|(_, k)| k).find(|&k| {
            let to = polygon[k];
            let q = self.at(to);
            to != from
                && sees(polygon[(k + n - 1) % n], to, polygon[(k + 1) % n], from)
                && sees(hole[hole.len() - 1], from, hole[1], to)
                && all.iter().all(|&[a, b]| {
                    let is_at_end = [a, b].iter().any(|v| *v == from || *v == to);
                    is_at_end || !meet(p, q, self.at(a), self.at(b))
                })
        })
    }

    /// Turns inner edges of which the opposite angles are together more than a half turn.
    fn turn_to_delaunay(&self, faces: &mut [[u32; 3]], border: &[[u32; 2]]) {
        let is_border: HashSet<[u32; 2]> = border.iter().copied().collect();
        let mut face_at: HashMap<[u32; 2], usize> = HashMap::new();
        for (f, &[a, b, c]) in faces.iter().enumerate() {
            for edge in [[a, b], [b, c], [c, a]] {
                if face_at.insert(edge, f).is_some() {
                    return;
                }
            }
        }
        let mut open: Vec<[u32; 2]> = faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        let opposite = |face: [u32; 3], a: u32, b: u32| face.into_iter().find(|&v| v != a && v != b);
        let angle_at = |v: u32, a: u32, b: u32| {
            let (s, t) = (self.along(v, a), self.along(v, b));
            (s[0] * t[1] - s[1] * t[0]).abs().atan2(s[0] * t[0] + s[1] * t[1])
        };
        let mut left = MOST_TURNS * border.len();
        while let Some([a, b]) = open.pop() {
            let (Some(&f), Some(&g)) = (face_at.get(&[a, b]), face_at.get(&[b, a])) else { continue };
            let (Some(c), Some(d)) = (opposite(faces[f], a, b), opposite(faces[g], a, b)) else { continue };
            let is_bad = angle_at(c, a, b) + angle_at(d, a, b) > std::f64::consts::PI + SAME_ANGLES;
            let [p, q, r, s] = [a, b, c, d].map(|v| self.at(v));
            let is_convex = turn(s, r, p) > 0.0 && turn(s, r, q) < 0.0;
            let exists = face_at.contains_key(&[c, d]) || face_at.contains_key(&[d, c]);
            if !is_bad
                || !is_convex
                || exists
                || is_border.contains(&[a, b])
                || is_border.contains(&[b, a])
                || left == 0
            {
                continue;
            }
            left -= 1;
            // a b c and b a d become d b c and d c a.
            (faces[f], faces[g]) = ([d, b, c], [d, c, a]);
            face_at.remove(&[a, b]);
            face_at.remove(&[b, a]);
            face_at.extend([([d, b], f), ([b, c], f), ([c, d], f), ([d, c], g), ([c, a], g), ([a, d], g)]);
            open.extend([[d, b], [b, c], [c, a], [a, d]]);
        }
    }
}
