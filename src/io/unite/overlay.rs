//! Rings that cross, resolved on an integer grid by `i_overlay`, every edge of the result knowing the link it is part of.

use i_overlay::core::edge_data::{EdgeDataMerge, OverlayEdgeData};
use i_overlay::core::edge_overlay::{EdgeOverlay, InputEdge};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::ShapeType;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::Precision;
use i_overlay::segm::boolean::ShapeCountBoolean;
use i_overlay::vector::edge::{SUBJ_LEFT, SUBJ_RIGHT};

use std::f64::consts::TAU;

use crate::plane::{Arc, Bounds, Link, Point, Ring, Segment, Turn, Vertex};

use super::grid::{Cell, Grid};
use super::nearby::Points;
use super::{Rule, loops, restore};

/// How far the chords that stand for an arc may stray from it, in parts of its radius (or of the drawing, if that is
/// smaller). Decides only which crossings are seen; where they are is solved on the arcs.
pub(super) const ARC_CHORDS: f64 = 1e-6;

/// A vertex this near to a straight link, in cells, lies on it: three roundings to the grid.
const SEAM_CELLS: f64 = 2.5;

/// The same in units of the last digit of the coordinates, where these are coarser than the grid.
const SEAM_DIGITS: f64 = 4.0;

/// Crossings are moved to ends of edges nearer than 2 cells, then 4, 8...: what is parallel but for rounding must come to
/// an end soon.
const SNAPPING: Precision = Precision::MEDIUM_LOW;

/// How fast the samples of circles turn with the radius, in steps for a factor of e. Circles that touch in one point are
/// images of each other seen from there, and samples at equal angles would put their first chords on one line.
const TWIST: f64 = 50.0;

/// A link of the rings that are resolved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source {
    pub start: Vertex,
    pub end: Vertex,
    /// Numbers of the links before and after in the ring.
    pub before: u32,
    pub after: u32,
}

impl Source {
    pub fn segment(&self) -> Segment {
        Segment { start: self.start.point, end: self.end.point, link: self.start.link }
    }
}

/// An edge of the result, solid on the left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    pub start: Cell,
    pub end: Cell,
    /// The link that it is part of.
    pub source: u32,
}

/// The number of a link, carried through the overlay.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tag(u32);

/// Not part of any link: the frame that gives the rings their surroundings.
const FRAME: Tag = Tag(u32::MAX);

impl OverlayEdgeData for Tag {
    type Store = ();

    fn merge(edges: EdgeDataMerge<ShapeCountBoolean, Tag>, _store: &mut ()) -> Tag {
        Tag(edges.lhs_data.0.min(edges.rhs_data.0))
    }
}

/// The boundary of what is solid, where `rings` meet each other and have the winding number `outside` around them.
pub(super) fn resolve(rings: &[&Ring], rule: Rule, outside: i32, extent: f64) -> Vec<Ring> {
    let bounds = rings.iter().fold(Bounds::EMPTY, |b, r| b.union(r.bounds()));
    let grid = Grid::new(bounds, extent);
    let sources = sources(rings);
    let mut overlay = EdgeOverlay::<i64, Tag>::new(2 * sources.len());
    overlay.solver.precision = SNAPPING;
    let mut add = |a: Cell, b: Cell, data: Tag| overlay.add_edge(InputEdge { a, b, data }, ShapeType::Subject);
    let seams = Seams::new(&sources, &grid, &bounds);
    for (number, source) in sources.iter().enumerate() {
        let mut from = grid.cell_of(source.start.point);
        let mut add_to = |to: Cell| {
            add(from, to, Tag(number as u32));
            from = to;
        };
        match source.start.link {
            Link::Line => seams.split(&grid, source, &mut add_to),
            Link::Arc(_) => flatten(&source.segment(), extent, |p| add_to(grid.cell_of(p))),
        }
    }
    // What runs around the rings elsewhere runs around them here as a frame.
    let (outside, fill_rule) = match rule {
        Rule::NonZero => (outside, FillRule::NonZero),
        Rule::EvenOdd => (outside % 2, FillRule::EvenOdd),
        Rule::AtLeast(least) => (outside - least + 1, FillRule::Positive),
    };
    let frame = bounds.inflated(0.25 * extent);
    let (min, max) = (grid.cell_of(frame.min), grid.cell_of(frame.max));
    let corners = [min, Cell { x: max.x, y: min.y }, max, Cell { x: min.x, y: max.y }];
    for _ in 0..outside.unsigned_abs() {
        for k in 0..4 {
            let (a, b) = (corners[k], corners[(k + 1) % 4]);
            if outside > 0 { add(a, b, FRAME) } else { add(b, a, FRAME) }
        }
    }
    let vectors = overlay.build_vectors(OverlayRule::Subject, fill_rule);
    let edges = vectors.into_iter().filter(|e| e.data != FRAME).filter_map(|e| {
        let (left, right) = (e.fill & SUBJ_LEFT != 0, e.fill & SUBJ_RIGHT != 0);
        let (start, end) = if left { (e.a, e.b) } else { (e.b, e.a) };
        (left != right).then_some(Edge { start, end, source: e.data.0 })
    });
    let speck = super::SPECK * (extent / grid.cell()) * (extent / grid.cell());
    // Chords of arcs that touch cross, and leave slivers no wider than the chords stray.
    let sliver = |edges: &[Edge]| {
        let radius = |e: &Edge| match sources[e.source as usize].start.link {
            Link::Line => 0.0,
            Link::Arc(arc) => arc.radius.min(extent),
        };
        let width = 2.0 * ARC_CHORDS * edges.iter().map(radius).fold(0.0, f64::max) / grid.cell();
        loops::length(edges) / 2.0 * width
    };
    let is_real = |edges: &Vec<Edge>| loops::area(edges).abs() > speck.max(sliver(edges));
    let loops = loops::link(edges.collect()).into_iter().filter(is_real);
    restore::rings(loops, &sources, &grid, extent)
}

/// Where straight links run over each other: the vertices on them.
///
/// The grid turns links on one line into links that cross each other somewhere at an angle of nothing. Each such crossing
/// moves both by a cell, and makes new crossings. So a link is led through the vertices that lie on it: what runs over
/// each other is then the same on the grid.
struct Seams {
    vertices: Points,
    /// In cells.
    reach: f64,
}

impl Seams {
    fn new(sources: &[Source], grid: &Grid, bounds: &Bounds) -> Seams {
        let mut cells: Vec<Cell> = sources.iter().map(|s| grid.cell_of(s.start.point)).collect();
        cells.sort_unstable_by_key(|c| (c.x, c.y));
        cells.dedup();
        let vertices = Points::new(&cells.into_iter().map(in_cells).collect::<Vec<_>>());
        let corners = [bounds.min, bounds.max];
        let farthest = corners.iter().flat_map(|p| [p.x.abs(), p.y.abs()]).fold(0.0, f64::max);
        Seams { vertices, reach: SEAM_CELLS.max(SEAM_DIGITS * f64::EPSILON * farthest / grid.cell()) }
    }

    /// The cells after the first by which a straight link goes.
    fn split(&self, grid: &Grid, link: &Source, mut emit: impl FnMut(Cell)) {
        let [start, end] = [link.start, link.end].map(|v| grid.cell_of(v.point));
        let mut on_line: Vec<(f64, Cell)> = Vec::new();
        self.vertices.visit_on_line(in_cells(start), in_cells(end), self.reach, |p, along| {
            let cell = Cell { x: p.x as i64, y: p.y as i64 };
            if cell != start && cell != end {
                on_line.push((along, cell));
            }
        });
        on_line.sort_unstable_by(|(s, a), (t, b)| s.total_cmp(t).then((a.x, a.y).cmp(&(b.x, b.y))));
        on_line.iter().for_each(|(_, cell)| emit(*cell));
        emit(end);
    }
}

/// Exact: cells have fewer digits than `f64`.
fn in_cells(cell: Cell) -> Point {
    Point::new(cell.x as f64, cell.y as f64)
}

fn sources(rings: &[&Ring]) -> Vec<Source> {
    let mut sources = Vec::with_capacity(rings.iter().map(|r| r.len()).sum());
    for ring in rings {
        let (first, n) = (sources.len(), ring.len());
        let number = |k: usize| (first + k % n) as u32;
        for k in 0..n {
            let (start, end) = (ring.vertices[k], ring.vertices[(k + 1) % n]);
            sources.push(Source { start, end, before: number(k + n - 1), after: number(k + 1) });
        }
    }
    sources
}

/// The points after the start that stand for a link. Arcs of one circle are sampled at the same points of it, so that
/// arcs which run over each other have chords which do.
pub(super) fn flatten(segment: &Segment, extent: f64, mut emit: impl FnMut(Point)) {
    if let Link::Arc(arc) = segment.link {
        let step = sample_angle(&arc, extent);
        let phase = (TWIST * (arc.radius / extent).ln()).rem_euclid(1.0) * step;
        let angle = |p: Point| (p.y - arc.center.y).atan2(p.x - arc.center.x) - phase;
        let (from, sweep) = (angle(segment.start), segment.sweep());
        let sample = |k: f64| {
            let (sin, cos) = (k * step + phase).sin_cos();
            Point::new(arc.center.x + arc.radius * cos, arc.center.y + arc.radius * sin)
        };
        // Samples strictly inside, kept a little away from the ends.
        const END_GAP: f64 = 0.01;
        match arc.turn {
            Turn::Left => {
                let (mut k, last) = ((from / step + END_GAP).ceil(), (from + sweep) / step - END_GAP);
                while k < last {
                    emit(sample(k));
                    k += 1.0;
                }
            }
            Turn::Right => {
                let (mut k, last) = ((from / step - END_GAP).floor(), (from - sweep) / step + END_GAP);
                while k > last {
                    emit(sample(k));
                    k -= 1.0;
                }
            }
        }
    }
    emit(segment.end);
}

/// The angle between samples of an arc: a whole number of them make a turn.
fn sample_angle(arc: &Arc, extent: f64) -> f64 {
    let tolerance = ARC_CHORDS * arc.radius.min(extent);
    let step = 2.0 * (1.0 - tolerance / arc.radius).acos();
    // An arc of a radius beyond all measure is straight.
    if step > 0.0 { TAU / (TAU / step).ceil().max(8.0) } else { TAU }
}
