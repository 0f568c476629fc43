//! Loops on the grid back to vertices and arcs: an end of a link becomes the vertex that it was, bit for bit, and a cut is
//! solved again on the links that cross there.

use std::collections::HashMap;

use crate::plane::{Arc, Joint, Link, Point, Ring, Segment, Vector, Vertex};

use super::grid::{Cell, Grid};
use super::overlay::{ARC_CHORDS, Edge, Source};

/// A cut of straight links, solved again, lies within so many cells of where the grid has it, or the links are nearly
/// parallel and the grid knows better.
const LINE_CUT: f64 = 16.0;

/// A cut of an arc, solved again, lies within so many times the sampling error of where the chords have it.
const ARC_CUT: f64 = 100.0;

/// Where links meet at a small angle, chords cross far from where the links do: the distance allowed grows with the
/// inverse sine of the angle, down to this one, at which two tangent arcs part by the sampling error.
const SHALLOW: f64 = 0.02;

/// Circles whose distance differs from touching by this, in parts of the radius squared, touch.
const TANGENT: f64 = 1e-12;

/// Consecutive edges that are part of one link.
#[derive(Clone, Debug)]
struct Run {
    source: u32,
    /// Whether the loop travels the link the way it was drawn.
    forward: bool,
    cells: Vec<Cell>,
}

pub(super) fn rings(loops: impl Iterator<Item = Vec<Edge>>, sources: &[Source], grid: &Grid, extent: f64) -> Vec<Ring> {
    let mut originals: HashMap<Cell, Vertex> = HashMap::with_capacity(sources.len());
    for source in sources {
        originals.entry(grid.cell_of(source.start.point)).or_insert(source.start);
    }
    let restorer = Restorer { sources, grid, extent, originals };
    loops.map(|edges| restorer.ring(&edges)).filter(|r| r.len() > 2 || r.area() != 0.0).collect()
}

struct Restorer<'a> {
    sources: &'a [Source],
    grid: &'a Grid,
    extent: f64,
    originals: HashMap<Cell, Vertex>,
}

impl Restorer<'_> {
    fn ring(&self, edges: &[Edge]) -> Ring {
        let runs = self.runs(edges);
        let n = runs.len();
        // Where each run starts; `None` where the links there cannot be brought to cross.
        let starts: Vec<Option<Vertex>> = (0..n).map(|k| self.joint(&runs[(k + n - 1) % n], &runs[k])).collect();
        let mut ring = Ring::default();
        for (k, run) in runs.iter().enumerate() {
            let rough = || Vertex::corner(self.grid.point_of(run.cells[0]));
            let start = starts[k].unwrap_or_else(rough);
            let end = starts[(k + 1) % n];
            let source = &self.sources[run.source as usize];
            let link = if run.forward { source.start.link } else { source.start.link.reversed() };
            let arc = match link {
                Link::Arc(arc) => Some(arc),
                Link::Line => None,
            };
            let whole = arc.is_none_or(|arc| {
                starts[k].is_some() && end.is_some_and(|end| self.is_part(&arc, source, start.point, end.point))
            });
            if arc.is_some() && starts[k].is_some() && end.is_some_and(|end| end.point == start.point) {
                // Two cuts that are one: chords cross twice where arcs touch.
                ring.vertices.push(Vertex { link: Link::Line, ..start });
                continue;
            }
            if whole {
                ring.vertices.push(Vertex { link, ..start });
                continue;
            }
            // The arc cannot be kept: its chords stand for it.
            ring.vertices.push(Vertex { link: Link::Line, ..start });
            for &cell in &run.cells[1..] {
                ring.vertices.push(Vertex { joint: Joint::Smooth, ..Vertex::corner(self.grid.point_of(cell)) });
            }
        }
        drop_repeated(&mut ring);
        ring
    }

    fn runs(&self, edges: &[Edge]) -> Vec<Run> {
        let forward: Vec<bool> = edges.iter().map(|e| self.is_forward(e)).collect();
        let same = |i: usize, j: usize| edges[i].source == edges[j].source && forward[i] == forward[j];
        let n = edges.len();
        let first = (0..n).find(|&k| !same((k + n - 1) % n, k)).unwrap_or(0);
        let mut runs: Vec<Run> = Vec::new();
        for k in 0..n {
            let index = (first + k) % n;
            let edge = edges[index];
            match runs.last_mut() {
                Some(run) if same((index + n - 1) % n, index) => run.cells.push(edge.start),
                _ => runs.push(Run { source: edge.source, forward: forward[index], cells: vec![edge.start] }),
            }
        }
        runs
    }

    fn is_forward(&self, edge: &Edge) -> bool {
        let segment = self.sources[edge.source as usize].segment();
        let (a, b) = (self.grid.point_of(edge.start), self.grid.point_of(edge.end));
        let along = match segment.link {
            Link::Line => segment.end - segment.start,
            Link::Arc(arc) => arc.tangent_at(nalgebra::center(&a, &b)),
        };
        along.dot(&(b - a)) > 0.0
    }

    /// The vertex between two runs.
    fn joint(&self, before: &Run, after: &Run) -> Option<Vertex> {
        let cell = after.cells[0];
        let [b, a] = [before, after].map(|r| &self.sources[r.source as usize]);
        // The link travelled before ends where the one after begins, as in the drawing.
        let at_start = if after.forward { a.start } else { a.end };
        let at_end = if before.forward { b.end } else { b.start };
        let follows = before.forward == after.forward
            && after.source == if before.forward { b.after } else { b.before }
            && at_start.id == at_end.id
            && at_start.point == at_end.point;
        if follows && self.grid.cell_of(at_start.point) == cell {
            return Some(at_start);
        }
        if let Some(original) = self.originals.get(&cell) {
            return Some(Vertex { joint: Joint::Corner, ..*original });
        }
        let rough = self.grid.point_of(cell);
        let (b, a) = (b.segment(), a.segment());
        let (solved, limit) = match (b.link, a.link) {
            (Link::Line, Link::Line) => (line_line(&b, &a), LINE_CUT * self.grid.cell()),
            (Link::Line, Link::Arc(arc)) => (line_circle(&b, &arc, rough), self.arc_cut(&arc)),
            (Link::Arc(arc), Link::Line) => (line_circle(&a, &arc, rough), self.arc_cut(&arc)),
            (Link::Arc(b), Link::Arc(a)) => (circle_circle(&b, &a, rough), self.arc_cut(&b).max(self.arc_cut(&a))),
        };
        let straight = b.link == Link::Line && a.link == Link::Line;
        let sine = |p: &Point| (tangent(&b, *p).perp(&tangent(&a, *p))).abs();
        let limit = |p: &Point| if straight { limit } else { limit / sine(p).max(SHALLOW) };
        let near = solved.filter(|p| (p - rough).norm() <= limit(p));
        near.or(straight.then_some(rough)).map(Vertex::corner)
    }

    fn arc_cut(&self, arc: &Arc) -> f64 {
        ARC_CUT * ARC_CHORDS * arc.radius.min(self.extent)
    }

    /// Whether the way from `start` to `end` along `arc` is part of the link that it was.
    fn is_part(&self, arc: &Arc, source: &Source, start: Point, end: Point) -> bool {
        let slack = 2.0 * self.arc_cut(arc) / arc.radius;
        start != end && arc.angle_between(start, end) <= source.segment().sweep() + slack
    }
}

/// The direction of a link at `p`.
fn tangent(segment: &Segment, p: Point) -> Vector {
    match segment.link {
        Link::Line => segment.start_tangent(),
        Link::Arc(arc) => arc.tangent_at(p),
    }
}

/// The root of what is negative only by rounding where circles touch.
fn root(x: f64, radius: f64) -> f64 {
    if x < 0.0 && x >= -TANGENT * radius * radius { 0.0 } else { x.sqrt() }
}

fn line_line(a: &Segment, b: &Segment) -> Option<Point> {
    let (d, e) = (a.end - a.start, b.end - b.start);
    let det = d.perp(&e);
    let t = (b.start - a.start).perp(&e) / det;
    t.is_finite().then(|| a.start + d * t)
}

fn line_circle(line: &Segment, arc: &Arc, near: Point) -> Option<Point> {
    let direction = (line.end - line.start).try_normalize(0.0)?;
    let foot = line.start + direction * (arc.center - line.start).dot(&direction);
    let height_squared = (foot - arc.center).norm_squared();
    let half = root(arc.radius * arc.radius - height_squared, arc.radius);
    nearest([foot + direction * half, foot - direction * half], near)
}

fn circle_circle(a: &Arc, b: &Arc, near: Point) -> Option<Point> {
    let between = b.center - a.center;
    let distance = between.norm();
    let along = (distance * distance + a.radius * a.radius - b.radius * b.radius) / (2.0 * distance);
    let half = root(a.radius * a.radius - along * along, a.radius);
    let direction = between / distance;
    let foot = a.center + direction * along;
    let across = crate::plane::left_normal(direction) * half;
    nearest([foot + across, foot - across], near)
}

/// The nearer of two points; `None` unless both are numbers.
fn nearest([p, q]: [Point; 2], near: Point) -> Option<Point> {
    let (dp, dq) = ((p - near).norm(), (q - near).norm());
    (dp.is_finite() && dq.is_finite()).then_some(if dp <= dq { p } else { q })
}

/// Drops links without length, keeping the vertex that has an identity.
fn drop_repeated(ring: &mut Ring) {
    let old = std::mem::take(&mut ring.vertices);
    let n = old.len();
    let mut identity: Option<Vertex> = None;
    for (k, v) in old.iter().enumerate() {
        let next = &old[(k + 1) % n];
        if v.point == next.point && n > 1 {
            // The next vertex stands for both.
            identity = identity.or(v.id.map(|_| *v));
            continue;
        }
        let id = v.id.or(identity.filter(|i| i.point == v.point).and_then(|i| i.id));
        ring.vertices.push(Vertex { id, ..*v });
        identity = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Turn;

    #[test]
    fn cuts_are_solved() {
        let p = Point::new;
        let arc = |x: f64, radius: f64| Arc { center: p(x, 0.0), radius, turn: Turn::Left };
        let cut = line_line(&Segment::line(p(0.0, 0.0), p(2.0, 2.0)), &Segment::line(p(0.0, 2.0), p(2.0, 0.0)));
        assert_eq!(cut, Some(p(1.0, 1.0)));
        assert_eq!(line_line(&Segment::line(p(0.0, 0.0), p(1.0, 0.0)), &Segment::line(p(0.0, 1.0), p(1.0, 1.0))), None);
        let line = Segment::line(p(3.0, -9.0), p(3.0, 9.0));
        assert_eq!(line_circle(&line, &arc(0.0, 5.0), p(3.0, 3.9)), Some(p(3.0, 4.0)));
        assert_eq!(line_circle(&line, &arc(0.0, 2.0), p(2.0, 0.0)), None);
        assert_eq!(circle_circle(&arc(0.0, 5.0), &arc(6.0, 5.0), p(3.0, -4.1)), Some(p(3.0, -4.0)));
        assert_eq!(circle_circle(&arc(0.0, 1.0), &arc(6.0, 1.0), p(3.0, 0.0)), None);
    }
}
