//! A ring of a result, as the lines, arcs and parts of the glyph's own curves that it runs along.

use std::collections::HashMap;

use crate::io::svg::{CurveKind, Sources};
use crate::plane::{Arc, Link, Point, Ring, Segment, Vertex, VertexId};

/// A point lies on a chord within this, in font units: far above the rounding of coordinates, far below what a font can
/// hold.
const ON_CHORD: f64 = 1e-5;

/// One piece of a ring; it starts where the one before ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    pub kind: PieceKind,
    pub end: Point,
}

/// What a piece runs along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PieceKind {
    Line,
    Arc(Arc),
    /// The curve of this number in the sources, from parameter to parameter; backwards where they fall.
    Curve {
        number: u32,
        from: f64,
        to: f64,
    },
}

/// Looks up which curve a vertex is a sample of.
pub(super) struct Tracer<'a> {
    sources: &'a Sources,
    /// Curves that begin or end at a vertex, with the number of the sample.
    ends: HashMap<VertexId, Vec<(u32, u32)>>,
}

impl<'a> Tracer<'a> {
    pub fn new(sources: &'a Sources) -> Tracer<'a> {
        let mut ends: HashMap<VertexId, Vec<(u32, u32)>> = HashMap::new();
        for (number, curve) in sources.curves.iter().enumerate() {
            // Samples that fell together have no parameters: their chords are lines.
            if curve.steps == curve.inner + 1 && !matches!(curve.kind, CurveKind::Elliptic { .. }) {
                ends.entry(curve.from).or_default().push((number as u32, 0));
                ends.entry(curve.to).or_default().push((number as u32, curve.steps));
            }
        }
        Tracer { sources, ends }
    }

    /// The pieces of a ring, in order, none of them continuing the one before.
    pub fn pieces(&self, ring: &Ring) -> Vec<Piece> {
        let n = ring.len();
        let mut pieces: Vec<Piece> = Vec::with_capacity(n);
        for (k, vertex) in ring.vertices.iter().enumerate() {
            let next = &ring.vertices[(k + 1) % n];
            let kind = match vertex.link {
                Link::Arc(arc) => PieceKind::Arc(arc),
                Link::Line => self.chord(vertex, next).unwrap_or(PieceKind::Line),
            };
            push(&mut pieces, Piece { kind, end: next.point });
        }
        // What runs over the start of the ring is one piece, too.
        if pieces.len() > 1
            && let Some(last) = pieces.last().copied()
            && let Some(whole) = continued(last.kind, pieces[0].kind)
        {
            pieces[0].kind = whole;
            pieces.pop();
        }
        pieces
    }

    /// The samples that a vertex is.
    fn samples(&self, vertex: &Vertex) -> Vec<(u32, u32)> {
        let Some(id) = vertex.id else { return Vec::new() };
        match self.sources.vertex(id).and_then(|v| v.sample) {
            Some(sample) => vec![sample],
            None => self.ends.get(&id).cloned().unwrap_or_default(),
        }
    }

    /// The place of a sample.
    fn point(&self, number: u32, sample: u32) -> Option<Point> {
        let curve = self.sources.curves.get(number as usize)?;
        let id = match sample {
            0 => curve.from,
            k if k > curve.inner => curve.to,
            k => VertexId::from_index((curve.first_inner + k - 1) as usize),
        };
        self.sources.vertex(id).map(|v| v.point)
    }

    /// The part of a curve that the chord from `a` to `b` stands for.
    fn chord(&self, a: &Vertex, b: &Vertex) -> Option<PieceKind> {
        let (at_a, at_b) = (self.samples(a), self.samples(b));
        for &(number, i) in &at_a {
            if let Some(&(_, j)) = at_b.iter().find(|(other, j)| *other == number && i.abs_diff(*j) == 1) {
                return self.part(number, f64::from(i), f64::from(j));
            }
        }
        // One end is a sample, and the other was made on the chord beside it.
        for &(number, i) in &at_a {
            if let Some(along) = self.along(number, i, b.point) {
                return self.part(number, f64::from(i), along);
            }
        }
        for &(number, j) in &at_b {
            if let Some(along) = self.along(number, j, a.point) {
                return self.part(number, along, f64::from(j));
            }
        }
        None
    }

    /// Where `p` lies on a chord beside the sample, counted in samples.
    fn along(&self, number: u32, sample: u32, p: Point) -> Option<f64> {
        let steps = self.sources.curves.get(number as usize)?.steps;
        if self.sources.curves[number as usize].inner + 1 != steps {
            return None;
        }
        let start = self.point(number, sample)?;
        let beside = [sample.checked_add(1).filter(|k| *k <= steps), sample.checked_sub(1)];
        beside.into_iter().flatten().find_map(|other| {
            let end = self.point(number, other)?;
            let length = (end - start).norm();
            let fraction = (p - start).norm() / length;
            let is_on = Segment::line(start, end).nearest(p).distance <= ON_CHORD;
            let sign = if other > sample { 1.0 } else { -1.0 };
            (is_on && fraction > 0.0 && fraction <= 1.0).then(|| f64::from(sample) + sign * fraction)
        })
    }

    fn part(&self, number: u32, from: f64, to: f64) -> Option<PieceKind> {
        let steps = f64::from(self.sources.curves.get(number as usize)?.steps);
        Some(PieceKind::Curve { number, from: from / steps, to: to / steps })
    }
}

/// Appends a piece, or makes the last one longer.
fn push(pieces: &mut Vec<Piece>, piece: Piece) {
    if let Some(last) = pieces.last_mut()
        && let Some(whole) = continued(last.kind, piece.kind)
    {
        *last = Piece { kind: whole, end: piece.end };
    } else {
        pieces.push(piece);
    }
}

/// Both pieces as one, where the second goes on where the first ends, along the same curve.
fn continued(first: PieceKind, second: PieceKind) -> Option<PieceKind> {
    match (first, second) {
        (PieceKind::Curve { number, from, to }, PieceKind::Curve { number: same, from: at, to: end }) => {
            let goes_on = number == same && to == at && (to > from) == (end > at);
            goes_on.then_some(PieceKind::Curve { number, from, to: end })
        }
        (PieceKind::Arc(arc), PieceKind::Arc(same)) => (arc == same).then_some(first),
        _ => None,
    }
}
