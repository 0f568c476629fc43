//! Outlines to rings: the transform applied, curves sampled, every vertex entered in the table of sources.
//!
//! Bézier curves are sampled at equal parameter steps, as many as Wang's formula asks for, so that a curve gives the same
//! samples wherever it stands in a path, and reading what was written gives the same samples again.

use std::f64::consts::PI;

use crate::plane::{Arc, Joint, Link, Point, Ring, Turn, Vector, Vertex, VertexId};

use super::affine::Affine;
use super::drawing::{Curve, CurveKind, Sources, VertexSource};
use super::elliptic::EllipticArc;
use super::known::Known;
use super::options::Curves;
use super::outline::{Command, Outline, Subpath};

/// At most so many samples a command: reached only by tolerances near the resolution of the numbers.
const MAX_SAMPLES: f64 = 65_536.0;

/// The largest angle, in radians, between the tangents of two curves that meet smoothly: control points written with
/// four digits keep within it, and a turn so small removes no visible corner.
const SMOOTH_ANGLE: f64 = 1e-3;

/// Which commands meet smoothly.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(not(feature = "text"), allow(dead_code))]
pub(in crate::io) enum Meetings {
    /// Two curves, where the angle between their tangents is that of rounding.
    Curves,
    /// Any two commands, where the angle is at most this many radians: the tangents of letters are known to whole font
    /// units only, and their curves run into straight stems.
    All(f64),
}

/// How to sample.
#[derive(Clone, Copy, Debug)]
pub(in crate::io) struct Sampling<'a> {
    /// Largest distance between chord and curve, root user units.
    pub tolerance: f64,
    pub curves: Curves,
    pub meetings: Meetings,
    /// Curves whose samples are to be met again.
    pub known: Option<&'a Known<'a>>,
}

impl Sampling<'_> {
    /// The inner samples of a curve of chords: those of the known curve that it is part of, or else `own`.
    fn inner(&self, from: Point, kind: &CurveKind, to: Point, own: impl Iterator<Item = Point>) -> Vec<Point> {
        let known = self.known.and_then(|known| known.samples(from, kind, to));
        known.unwrap_or_else(|| own.collect())
    }
}

/// The rings of `outline` under `affine`, open subpaths closed as a fill closes them.
pub(in crate::io) fn rings(
    outline: &Outline,
    affine: &Affine,
    sampling: Sampling,
    element: u32,
    sources: &mut Sources,
) -> Vec<Ring> {
    let rings = outline.subpaths.iter().map(|subpath| ring(subpath, affine, sampling, element, sources));
    rings.filter(|r| r.len() >= 2).collect()
}

/// A ring under construction.
struct Pen<'a> {
    ring: Ring,
    sources: &'a mut Sources,
    element: u32,
    /// Index in `sources.curves` of this ring's first curve.
    first_curve: usize,
    polygon: bool,
}

impl Pen<'_> {
    /// Adds a vertex, unless the ring already is there; the last vertex in either case.
    fn vertex(&mut self, point: Point, joint: Joint, sample: Option<(u32, u32)>) -> VertexId {
        if let Some(last) = self.ring.vertices.last()
            && last.point == point
            && let Some(id) = last.id
        {
            return id;
        }
        let id = VertexId::from_index(self.sources.vertices.len());
        self.sources.vertices.push(VertexSource { point, element: self.element, sample });
        let joint = if self.polygon { Joint::Corner } else { joint };
        self.ring.vertices.push(Vertex { point, link: Link::Line, joint, id: Some(id) });
        id
    }

    fn link(&mut self, link: Link) {
        if let Some(last) = self.ring.vertices.last_mut() {
            last.link = link;
        }
    }

    /// A curve from the last vertex by way of `inner` points to `to`, every link the same.
    fn curve(&mut self, kind: CurveKind, link: Link, joint: Joint, inner: Vec<Point>, to: Point) {
        let Some(from) = self.ring.vertices.last().and_then(|v| v.id) else { return };
        let number = self.sources.curves.len() as u32;
        let first_inner = self.sources.vertices.len();
        let steps = inner.len() as u32 + 1;
        for (k, p) in inner.into_iter().enumerate() {
            self.link(link);
            self.vertex(p, joint, Some((number, k as u32 + 1)));
        }
        let inner = self.sources.vertices.len() - first_inner;
        self.link(link);
        let to = self.vertex(to, Joint::Corner, None);
        self.sources.curves.push(Curve {
            element: self.element,
            kind,
            from,
            to,
            first_inner: first_inner as u32,
            inner: inner as u32,
            steps,
        });
    }
}

fn ring(subpath: &Subpath, affine: &Affine, sampling: Sampling, element: u32, sources: &mut Sources) -> Ring {
    let first_curve = sources.curves.len();
    let polygon = sampling.curves == Curves::Polygon;
    let mut pen = Pen { ring: Ring::default(), sources, element, first_curve, polygon };
    let start = affine.apply_y_up(subpath.start);
    let first = pen.vertex(start, Joint::Corner, None);
    let mut from = start;
    // The tangent at the end of the command before, where that was a curve, and the vertex there.
    let mut before: Option<Vector> = None;
    let mut first_tangent = None;
    for (index, command) in subpath.commands.iter().enumerate() {
        let to = affine.apply_y_up(command.end());
        let at = pen.ring.vertices.len() - 1;
        let mut tangents = draw(command, affine, sampling, from, to, &mut pen);
        if let (Command::Line(_), Meetings::All(_)) = (command, sampling.meetings)
            && from != to
        {
            tangents = Some((to - from, to - from));
        }
        if let (Some(a), Some((b, _))) = (before, tangents)
            && is_smooth(a, b, sampling.meetings)
            && !polygon
        {
            pen.ring.vertices[at].joint = Joint::Smooth;
        }
        if index == 0 {
            first_tangent = tangents.map(|t| t.0);
        }
        // A command without length does not part its neighbours.
        if from != to || tangents.is_some() {
            before = tangents.map(|t| t.1);
        }
        from = to;
    }
    close(&mut pen, first, before.zip(first_tangent).is_some_and(|(a, b)| is_smooth(a, b, sampling.meetings)));
    pen.ring
}

/// Drops a last vertex that repeats the first one.
fn close(pen: &mut Pen, first: VertexId, smooth: bool) {
    let vertices = &mut pen.ring.vertices;
    if vertices.len() < 2 || vertices[0].point != vertices[vertices.len() - 1].point {
        return;
    }
    let last = vertices.pop().and_then(|v| v.id);
    if smooth && !pen.polygon {
        vertices[0].joint = Joint::Smooth;
    }
    for curve in &mut pen.sources.curves[pen.first_curve..] {
        if Some(curve.to) == last {
            curve.to = first;
        }
        if Some(curve.from) == last {
            curve.from = first;
        }
    }
}

fn is_smooth(a: Vector, b: Vector, meetings: Meetings) -> bool {
    let angle = match meetings {
        Meetings::Curves => SMOOTH_ANGLE,
        Meetings::All(angle) => angle,
    };
    a.dot(&b) > 0.0 && a.perp(&b).abs() <= angle * a.dot(&b)
}

/// Draws one command; the tangents at its ends, where it is a curve of chords.
fn draw(
    command: &Command,
    affine: &Affine,
    sampling: Sampling,
    from: Point,
    to: Point,
    pen: &mut Pen,
) -> Option<(Vector, Vector)> {
    match *command {
        Command::Line(_) => {
            pen.vertex(to, Joint::Corner, None);
            None
        }
        Command::Quadratic(control, _) => {
            let c = affine.apply_y_up(control);
            let second = (from.coords - c.coords * 2.0 + to.coords).norm();
            let n = wang(second * 2.0, sampling.tolerance);
            let kind = CurveKind::Quadratic(c);
            let inner = sampling.inner(from, &kind, to, (1..n).map(|k| quadratic(from, c, to, k, n)));
            pen.curve(kind, Link::Line, Joint::Smooth, inner, to);
            tangents(&[from, c, to])
        }
        Command::Cubic(c, d, _) => {
            let [c, d] = [c, d].map(|c| affine.apply_y_up(c));
            let second = |a: Point, b: Point, c: Point| (a.coords - b.coords * 2.0 + c.coords).norm();
            let n = wang(second(from, c, d).max(second(c, d, to)) * 6.0, sampling.tolerance);
            let kind = CurveKind::Cubic(c, d);
            let inner = sampling.inner(from, &kind, to, (1..n).map(|k| cubic(from, c, d, to, k, n)));
            pen.curve(kind, Link::Line, Joint::Smooth, inner, to);
            tangents(&[from, c, d, to])
        }
        Command::Arc(arc) => {
            let circle = arc.circle_radius(affine);
            let axes = arc.image_axes(affine);
            let mirrored = affine.determinant() < 0.0;
            let clockwise = (arc.sweep > 0.0) != mirrored;
            let is_arc = sampling.curves == Curves::Arcs;
            let kept = circle.filter(|_| is_arc).map(|radius| Arc {
                center: affine.apply_y_up(arc.center),
                radius,
                turn: if clockwise { Turn::Right } else { Turn::Left },
            });
            let kind = CurveKind::Elliptic {
                radii: circle.map_or((axes.first, axes.second), |r| (r, r)),
                rotation: if circle.is_some() { 0.0 } else { axes.degrees },
                angle: arc.sweep.abs(),
                sweep: clockwise,
                arc: kept,
            };
            let (n, link, joint) = match kept {
                // An arc of more than half a turn is two links.
                Some(kept) => (if arc.sweep.abs() > PI { 2 } else { 1 }, Link::Arc(kept), Joint::Corner),
                None => (arc_samples(arc, axes.first.max(axes.second), sampling.tolerance), Link::Line, Joint::Smooth),
            };
            let inner = (1..n).map(|k| arc.point(affine, arc.start + arc.sweep * (k as f64 / n as f64)));
            let inner = if kept.is_some() { inner.collect() } else { sampling.inner(from, &kind, to, inner) };
            pen.curve(kind, link, joint, inner, to);
            // A true arc has its own tangents: only chords need to be told that they stand for a curve.
            if kept.is_some() {
                return None;
            }
            Some((arc.tangent(affine, arc.start), arc.tangent(affine, arc.start + arc.sweep)))
        }
    }
}

/// Wang's formula: how many equal parameter steps keep the chords of a curve within `tolerance`, given the largest
/// length of its second derivative.
fn wang(second_derivative: f64, tolerance: f64) -> usize {
    (second_derivative / (8.0 * tolerance)).sqrt().ceil().clamp(1.0, MAX_SAMPLES) as usize
}

/// How many equal angles keep the chords of an arc within `tolerance`.
fn arc_samples(arc: EllipticArc, longest: f64, tolerance: f64) -> usize {
    if tolerance >= longest {
        return 1;
    }
    let step = 2.0 * (1.0 - tolerance / longest).acos();
    (arc.sweep.abs() / step).ceil().clamp(1.0, MAX_SAMPLES) as usize
}

// The point k/n along a Bézier curve, by its Bernstein form. Every product and sum is arranged so that the curve run the
// other way gives the same bits: a ring that is turned round is written with its commands turned round.

fn quadratic(a: Point, b: Point, c: Point, k: usize, n: usize) -> Point {
    let (t, s) = (k as f64 / n as f64, (n - k) as f64 / n as f64);
    Point::from((a.coords * (s * s) + c.coords * (t * t)) + b.coords * (2.0 * (t * s)))
}

fn cubic(a: Point, b: Point, c: Point, d: Point, k: usize, n: usize) -> Point {
    let (t, s) = (k as f64 / n as f64, (n - k) as f64 / n as f64);
    let ts = 3.0 * (t * s);
    Point::from((a.coords * (s * s * s) + d.coords * (t * t * t)) + (b.coords * (ts * s) + c.coords * (ts * t)))
}

/// The directions at the ends of a Bézier curve: towards the next control point that is elsewhere.
fn tangents(points: &[Point]) -> Option<(Vector, Vector)> {
    let (first, last) = (*points.first()?, *points.last()?);
    let start = points.iter().map(|p| p - first).find(|v| *v != Vector::zeros())?;
    let end = points.iter().rev().map(|p| last - p).find(|v| *v != Vector::zeros())?;
    Some((start, end))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(commands: Vec<Command>, curves: Curves) -> (Vec<Ring>, Sources) {
        let outline = Outline { subpaths: vec![Subpath { start: Point::origin(), commands, closed: true }] };
        let mut sources = Sources::default();
        let rings = rings(
            &outline,
            &Affine::IDENTITY,
            Sampling { tolerance: 1e-3, curves, meetings: Meetings::Curves, known: None },
            0,
            &mut sources,
        );
        (rings, sources)
    }

    #[test]
    fn chords_stay_within_the_tolerance_and_are_not_many_more_than_needed() {
        let p = Point::new;
        let (rings, sources) = sampled(vec![Command::Cubic(p(1.0, 3.0), p(4.0, -2.0), p(5.0, 1.0))], Curves::Arcs);
        let ring = &rings[0];
        assert_eq!(sources.curves[0].inner as usize, ring.len() - 2);
        let n = ring.len() - 1;
        let mut worst = 0.0f64;
        for k in 0..n {
            let (a, b) = (ring.vertices[k].point, ring.vertices[k + 1].point);
            for quarter in 1..4 {
                let at = cubic(p(0.0, 0.0), p(1.0, -3.0), p(4.0, 2.0), p(5.0, -1.0), 4 * k + quarter, 4 * n);
                worst = worst.max(crate::plane::Segment::line(a, b).nearest(at).distance);
            }
        }
        assert!(worst < 1e-3 && worst > 0.3e-3, "{worst}");
        assert!(ring.vertices[1..n].iter().all(|v| v.joint == Joint::Smooth));
    }

    #[test]
    fn curves_that_meet_with_one_tangent_meet_smoothly() {
        let p = Point::new;
        let curve = |y| {
            vec![
                Command::Quadratic(p(0.0, 1.0), p(1.0, 1.0)),
                Command::Quadratic(p(2.0, y), p(2.0, 0.0)),
                Command::Quadratic(p(2.0, -3.0), p(0.0, 0.0)),
            ]
        };
        for (y, expected) in [(1.0, Joint::Smooth), (1.5, Joint::Corner)] {
            let (rings, sources) = sampled(curve(y), Curves::Arcs);
            let joint = |id: VertexId| rings[0].vertices.iter().find(|v| v.id == Some(id)).unwrap().joint;
            assert_eq!(joint(sources.curves[0].to), expected);
            assert_eq!(sources.curves[2].to, sources.curves[0].from);
            assert_eq!(joint(sources.curves[0].from), Joint::Corner);
        }
    }

    #[test]
    fn circles_are_four_arcs_with_exact_points_or_a_polygon() {
        let outline = Outline::ellipse(Point::new(0.1, 0.2), 0.3, 0.3);
        let mut sources = Sources::default();
        let sampling = Sampling { tolerance: 1e-3, curves: Curves::Arcs, meetings: Meetings::Curves, known: None };
        let arcs = &rings(&outline, &Affine::IDENTITY, sampling, 0, &mut sources)[0];
        let expected = [(0.1 + 0.3, -0.2), (0.1, -(0.2 + 0.3)), (0.1 - 0.3, -0.2), (0.1, -(0.2 - 0.3))];
        let arc = Arc { center: Point::new(0.1, -0.2), radius: 0.3, turn: Turn::Right };
        assert_eq!(arcs.len(), 4);
        for (v, (x, y)) in arcs.vertices.iter().zip(expected) {
            assert_eq!((v.point, v.link), (Point::new(x, y), Link::Arc(arc)));
        }
        let sampling = Sampling { curves: Curves::Polygon, ..sampling };
        let polygon = &rings(&outline, &Affine::IDENTITY, sampling, 0, &mut sources)[0];
        assert!(polygon.vertices.iter().all(|v| v.link == Link::Line && v.joint == Joint::Corner));
        assert_eq!(polygon.len(), 4 * ((PI / 2.0) / (2.0 * (1.0f64 - 1e-3 / 0.3).acos())).ceil() as usize);
    }

    #[test]
    fn repeated_points_are_dropped() {
        let p = Point::new;
        let line = |x, y| Command::Line(p(x, y));
        let commands = vec![line(0.0, 0.0), line(1.0, 0.0), line(1.0, 0.0), line(1.0, 1.0), line(0.0, 0.0)];
        let (rings, sources) = sampled(commands, Curves::Arcs);
        assert_eq!((rings[0].len(), sources.vertices.len()), (3, 4));
    }
}
