//! Edges to closed loops.

use std::collections::HashMap;

use super::grid::Cell;
use super::overlay::Edge;

/// Joins edges, each with the solid on its left, to loops that do not touch themselves. Where pieces of the solid touch in
/// a point, they get loops of their own.
pub(super) fn link(mut edges: Vec<Edge>) -> Vec<Vec<Edge>> {
    // One order for one input, whatever order the overlay gives them in.
    edges.sort_by_key(|e| (e.start.x, e.start.y, e.end.x, e.end.y));
    let mut leaving: HashMap<Cell, Vec<usize>> = HashMap::with_capacity(edges.len());
    for (index, edge) in edges.iter().enumerate() {
        leaving.entry(edge.start).or_default().push(index);
    }
    let mut used = vec![false; edges.len()];
    let mut loops = Vec::new();
    for first in 0..edges.len() {
        if used[first] {
            continue;
        }
        let mut path = Vec::new();
        let mut at = Some(first);
        while let Some(index) = at {
            used[index] = true;
            path.push(edges[index]);
            let arriving = edges[index];
            if arriving.end == edges[first].start {
                break;
            }
            let choices = leaving.get(&arriving.end).into_iter().flatten().copied();
            at = choices.filter(|&i| !used[i]).reduce(|a, b| next_of(&arriving, a, b, &edges));
        }
        if path.last().is_some_and(|e| e.end == path[0].start) {
            split(path, &mut loops);
        }
    }
    loops
}

/// The first of two leaving edges, turning clockwise from where `arriving` came from: the other side of the solid that lies
/// on its left.
fn next_of(arriving: &Edge, a: usize, b: usize, edges: &[Edge]) -> usize {
    let back = vector(arriving.end, arriving.start);
    let [u, v] = [a, b].map(|i| vector(edges[i].start, edges[i].end));
    let half = |w: (i128, i128)| match cross(back, w) {
        c if c < 0 => 0,
        0 if dot(back, w) < 0 => 1,
        c if c > 0 => 2,
        _ => 3,
    };
    let u_first = match half(u).cmp(&half(v)) {
        std::cmp::Ordering::Less => true,
        std::cmp::Ordering::Greater => false,
        std::cmp::Ordering::Equal => cross(u, v) <= 0,
    };
    if u_first { a } else { b }
}

fn vector(from: Cell, to: Cell) -> (i128, i128) {
    (i128::from(to.x) - i128::from(from.x), i128::from(to.y) - i128::from(from.y))
}

fn cross(a: (i128, i128), b: (i128, i128)) -> i128 {
    a.0 * b.1 - a.1 * b.0
}

fn dot(a: (i128, i128), b: (i128, i128)) -> i128 {
    a.0 * b.0 + a.1 * b.1
}

/// Cuts a loop that comes back to a point into loops that do not.
fn split(path: Vec<Edge>, loops: &mut Vec<Vec<Edge>>) {
    let mut open: Vec<Edge> = Vec::with_capacity(path.len());
    let mut visited: HashMap<Cell, usize> = HashMap::with_capacity(path.len());
    for edge in path {
        visited.insert(edge.start, open.len());
        open.push(edge);
        if let Some(&at) = visited.get(&edge.end) {
            let closed = open.split_off(at);
            for e in &closed {
                visited.remove(&e.start);
            }
            loops.push(closed);
        }
    }
}

/// Signed area of a loop in cells, counterclockwise positive.
pub(super) fn area(edges: &[Edge]) -> f64 {
    let Some(first) = edges.first() else { return 0.0 };
    let doubled: i128 = edges.iter().map(|e| cross(vector(first.start, e.start), vector(first.start, e.end))).sum();
    doubled as f64 / 2.0
}

/// Length of a loop in cells.
pub(super) fn length(edges: &[Edge]) -> f64 {
    let length = |e: &Edge| {
        let (x, y) = vector(e.start, e.end);
        (x as f64).hypot(y as f64)
    };
    edges.iter().map(length).sum()
}
