//! A state as arcs: the curve that the chords between moved nodes are inscribed in.
//!
//! The chords are cut into runs at corners and where the outline is still what it was. At every node of a run a direction is
//! known: that of the circle through it and its neighbours, at the ends of a run that of the outline that it joins. From
//! each node the farthest one is sought that a biarc reaches without leaving the nodes between.

use super::front::CurveFront;
use super::outline::Outline;
use crate::plane::{Biarc, Joint, Place, Region, Ring, Segment, Vector, Vertex, turn_angle};

/// How far arcs may stray from the nodes, in edge lengths: a part of the flow's own error.
const STRAY: f64 = 0.005;

/// Chords turn by more than this, in radians, at corners only: along the sharpest curve that edges can follow they turn
/// by half of it.
const SHARPEST: f64 = 0.5;

/// A turn is no corner where it is smaller than this, in radians, or goes the same way as the turn beside it and is at most
/// so much larger.
const SLIGHT: f64 = 0.02;
const ALIKE: f64 = 1.5;

/// The most that a biarc turns, in radians: half a turn and it would no longer be clear which of its arcs is meant.
const LARGEST_TURN: f64 = 2.0;

/// The front's outline with arcs where it moved.
pub(super) fn rounded(front: &CurveFront) -> Region {
    let outline = &front.outline;
    let rings = (0..outline.loops.len() as u32).map(|ring| {
        let nodes: Vec<u32> = outline.needed(ring).collect();
        let stray = nodes.first().map_or(0.0, |&i| STRAY * front.edge_at(i));
        Ring { vertices: round(outline, &nodes, stray) }
    });
    Region::new(rings.filter(|r| r.len() > 1).collect())
}

/// The vertices of a ring of `nodes`.
fn round(outline: &Outline, nodes: &[u32], stray: f64) -> Vec<Vertex> {
    let n = nodes.len();
    let edge = |k: usize| outline.edge(nodes[k % n]);
    let is_still = |k: usize| outline.is_still(nodes[k % n]);
    // Nodes that are not needed lie on still edges: the edge before a node starts at one of them.
    let into = |k: usize| outline.edge(outline.node(nodes[k % n]).prev).end_tangent();
    let turn = |k: usize| turn_angle(into(k), edge(k).start_tangent());
    // Whether the turn at a node goes on beside it.
    let joins = |k: usize, inner: usize| {
        let (turn, beside) = (turn(k), turn(inner));
        turn.abs() <= SLIGHT || (turn * beside > 0.0 && turn.abs() <= ALIKE * beside.abs())
    };
    // Vertices that did not move are corners that the curve leans on, or samples of a curve that it goes on along.
    let has_moved = |k: usize| outline.node(nodes[k % n]).moved;
    let is_smooth = |k: usize| match has_moved(k) {
        true => turn(k).abs() <= SHARPEST,
        false => joins(k, k + 1) && joins(k, k + n - 1),
    };
    // A run may start where it cannot go back: at a still edge or a corner, or else anywhere.
    let starts = |k: usize| is_still(k + n - 1) || !is_smooth(k);
    let first = (0..n).find(|&k| starts(k)).unwrap_or(0);
    let mut vertices = Vec::with_capacity(n);
    let mut k = first;
    while k < first + n {
        if is_still(k) {
            vertices.push(outline.vertex(nodes[k % n]));
            k += 1;
            continue;
        }
        let mut end = k + 1;
        while end < first + n && !is_still(end) && is_smooth(end) {
            end += 1;
        }
        let run: Vec<Segment> = (k..end).map(edge).collect();
        let is_closed = end - k == n && !starts(first);
        let (before, after) = if is_closed {
            let seam = tangent_between(&run[n - 1], &run[0]);
            (Some(seam), Some(seam))
        } else {
            // Where the outline goes on as it was, the curve leaves it without a corner, unless it meets it in one.
            (
                (is_still(k + n - 1) && joins(k, k + 1)).then(|| into(k)),
                (is_still(end) && joins(end, end + n - 1)).then(|| edge(end).start_tangent()),
            )
        };
        let from = vertices.len();
        follow(&run, before, after, stray, &mut vertices);
        // The run starts at a vertex of the outline, which keeps its name.
        let Vertex { joint, id, .. } = outline.vertex(nodes[k % n]);
        (vertices[from].joint, vertices[from].id) = (joint, id);
        k = end;
    }
    vertices
}

/// The direction of the circle through the ends of two chords where they meet.
fn tangent_between(into: &Segment, out: &Segment) -> Vector {
    let (u, v) = (into.end - into.start, out.end - out.start);
    // The angle between the chords is shared out in proportion to their lengths.
    let (a, b) = (u.norm(), v.norm());
    (u * (b / a) + v * (a / b)).try_normalize(0.0).unwrap_or_else(|| out.start_tangent())
}

/// The direction at the free end of `chord`, which the circle through it and the chord beside it has there.
fn mirrored(tangent: Vector, chord: Vector) -> Vector {
    let along = chord * (2.0 * tangent.dot(&chord) / chord.norm_squared());
    along - tangent
}

/// Appends the vertices of the arcs along a run of chords, which has the directions `before` and `after` at its ends.
fn follow(run: &[Segment], before: Option<Vector>, after: Option<Vector>, stray: f64, vertices: &mut Vec<Vertex>) {
    let n = run.len();
    let mut tangents: Vec<Vector> = Vec::with_capacity(n + 1);
    tangents.push(Vector::zeros());
    tangents.extend(run.windows(2).map(|pair| tangent_between(&pair[0], &pair[1])));
    tangents.push(Vector::zeros());
    tangents[0] = before.unwrap_or_else(|| match n {
        1 => run[0].start_tangent(),
        _ => mirrored(tangents[1], run[0].end - run[0].start),
    });
    tangents[n] = after.unwrap_or_else(|| match n {
        1 => run[0].start_tangent(),
        _ => mirrored(tangents[n - 1], run[n - 1].end - run[n - 1].start),
    });
    let point = |k: usize| if k < n { run[k].start } else { run[n - 1].end };
    let place = |k: usize| Place { point: point(k), tangent: tangents[k] };
    let mut turned = vec![0.0; n + 1];
    for k in 1..=n {
        turned[k] = turned[k - 1] + turn_angle(tangents[k - 1], tangents[k]).abs();
    }
    let fits = |from: usize, to: usize| {
        let biarc = Biarc::between(place(from), place(to)).filter(|_| turned[to] - turned[from] <= LARGEST_TURN)?;
        let keeps_to_nodes = (from + 1..to).all(|k| biarc.offside(point(k)).abs() <= stray);
        // Over a chord the curve bulges by an eighth of its length for every radian that it turns: not much more.
        let keeps_to_chords = (from..to).all(|k| {
            let bulge = run[k].length() * turn_angle(tangents[k], tangents[k + 1]).abs() / 8.0;
            biarc.offside(run[k].point_at(0.5)).abs() <= bulge + 2.0 * stray
        });
        (keeps_to_nodes && keeps_to_chords).then_some(biarc)
    };
    let mut from = 0;
    while from < n {
        // Gallop, then bisect.
        let (mut good, mut bad, mut best) = (from, n + 1, None);
        let mut step = 1;
        while good < n {
            let to = (from + step).min(n);
            let Some(biarc) = fits(from, to) else {
                bad = to;
                break;
            };
            (good, best) = (to, Some(biarc));
            step *= 2;
        }
        while good > from && good + 1 < bad {
            let middle = good + (bad - good) / 2;
            match fits(from, middle) {
                Some(biarc) => (good, best) = (middle, Some(biarc)),
                None => bad = middle,
            }
        }
        match best {
            Some(biarc) => vertices.extend([biarc.first, biarc.second].map(starting)),
            None => {
                good = from + 1;
                vertices.push(starting(run[from]));
            }
        }
        from = good;
    }
}

fn starting(segment: Segment) -> Vertex {
    Vertex { point: segment.start, link: segment.link, joint: Joint::Corner, id: None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::{Link, Point};

    #[test]
    fn chords_of_a_circle_become_its_arcs() {
        let at = |k: i32| Point::new((0.1 * f64::from(k)).cos(), (0.1 * f64::from(k)).sin()) * 3.0;
        let run: Vec<Segment> = (0..15).map(|k| Segment::line(at(k), at(k + 1))).collect();
        let mut vertices = Vec::new();
        follow(&run, None, None, 1e-6, &mut vertices);
        assert_eq!(vertices.len(), 2);
        for v in vertices {
            let Link::Arc(arc) = v.link else { panic!("{v:?}") };
            assert!(arc.center.coords.norm() < 1e-9 && (arc.radius - 3.0).abs() < 1e-9, "{arc:?}");
        }
    }
}
