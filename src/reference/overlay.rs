//! The closing as a union of swept pieces, by `i_overlay`'s boolean operations on 64-bit integers.
//!
//! One offset: every boundary element sweeps a piece (a rectangle or a ring sector), every corner a circular sector; their
//! union is added to the solid or taken from it. Pieces lie on one side of the boundary only, and a corner whose
//! offsets cross needs none: the nearest boundary point of any point of the union is covered by its own piece.
//!
//! The arcs of the pieces are inscribed polygons, so the union is wrong by their flatness. It is used for its *topology*
//! alone: every edge of it is traced back to the element or corner that is nearest to its middle, and the result is
//! rebuilt from the exact offset curves and their exact intersections. What flatness can still spoil is which of two
//! curves comes first where they pass each other by less: the certificate finds that, and a finer flatness is tried.
//! `i_overlay`'s own offsetting is not used: its round joins are limited to an angle of 0.01 π.

use std::panic::{AssertUnwindSafe, catch_unwind};

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::{Overlay, ShapeType};
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;

use super::curve::{Feature, Features, POINT_RADIUS};
use super::{Method, Operation, Reference, ReferenceError, Side, best_certified};
use crate::plane::{Arc, BoundaryIndex, Joint, Link, Point, Region, Ring, Segment, Vector, Vertex};
use crate::units::Radius;

/// The sagitta of the pieces' arcs in radii, tried in this order. The first is right unless boundaries of different parts
/// of the offset pass each other by less; each step costs about three times the time of the one before.
const FLATNESS: [f64; 3] = [1e-3, 1e-4, 1e-5];

/// Bits of the integer coordinates: as many as an `f64` holds without rounding, less one for what stands out of the box.
const COORDINATE_BITS: i32 = 51;

/// Edges of the union shorter than this many grid units are made by its snapping.
const SNAP_UNITS: f64 = 64.0;

/// Distance in radii at which a vertex of the union is the end of an offset curve, and not a crossing of two: far above
/// the grid, far below the flatness that displaces a crossing.
const CURVE_END: f64 = 1e-9;

/// The closing or opening by unions of swept pieces, certified.
///
/// # Errors
/// See [`ReferenceError`].
pub fn closing(region: &Region, radius: Radius, operation: Operation) -> Result<Reference, ReferenceError> {
    let [first_side, second_side] = operation.sides();
    best_certified(region, radius, operation, Method::Overlay, &FLATNESS, |unit, flatness| {
        // Its integer geometry is not known to panic on any input; should it, that is no reason to lose the process.
        catch_unwind(AssertUnwindSafe(|| {
            let first = offset(unit, first_side, flatness);
            let second = offset(&first, second_side, flatness);
            [first, second]
        }))
        .ok()
    })
}

/// The offset of `region` by 1.
fn offset(region: &Region, side: Side, flatness: f64) -> Region {
    if region.is_empty() {
        return Region::default();
    }
    let features = Features::new(region, side);
    let bounds = region.bounds().inflated(1.0);
    let extent = bounds.width().max(bounds.height());
    let grid = Grid { center: bounds.center(), scale: 2f64.powi(COORDINATE_BITS - (extent.log2().ceil() as i32)) };
    let mut overlay = Overlay::<i64>::new(16 * region.vertex_count());
    let mut outline = Vec::new();
    let mut first_element = 0;
    for ring in &region.rings {
        outline.clear();
        for i in first_element..first_element + ring.len() {
            // The same points as those of the piece, so that no sliver opens between them.
            let (inner, _) = flattened_element(&features, i, flatness);
            outline.extend(inner.iter().take(inner.len() - 1).map(|p| grid.to_integer(*p)));
        }
        first_element += ring.len();
        overlay.add_contour(&outline, ShapeType::Subject);
    }
    for i in 0..features.elements.len() {
        for mut piece in pieces(&features, i, flatness) {
            if side == Side::Inward {
                piece.reverse();
            }
            let contour: Vec<IntPoint<i64>> = piece.iter().map(|p| grid.to_integer(*p)).collect();
            overlay.add_contour(&contour, ShapeType::Clip);
        }
    }
    let rule = match side {
        Side::Outward => OverlayRule::Union,
        Side::Inward => OverlayRule::Difference,
    };
    let shapes = overlay.overlay(rule, FillRule::NonZero);
    let tracer = Tracer {
        index: BoundaryIndex::of_segments(features.elements.clone()),
        features,
        snap: SNAP_UNITS / grid.scale,
    };
    let rings = shapes
        .iter()
        .flatten()
        .filter_map(|contour| tracer.ring(&contour.iter().map(|p| grid.to_point(*p)).collect::<Vec<_>>()));
    Region::new(rings.collect())
}

/// The integer grid of the union.
struct Grid {
    center: Point,
    scale: f64,
}

impl Grid {
    fn to_integer(&self, p: Point) -> IntPoint<i64> {
        let v = (p - self.center) * self.scale;
        IntPoint::new(v.x.round() as i64, v.y.round() as i64)
    }

    fn to_point(&self, p: IntPoint<i64>) -> Point {
        self.center + Vector::new(p.x as f64, p.y as f64) / self.scale
    }
}

/// Points along element `i`, and the offsets of these points.
fn flattened_element(features: &Features, i: usize, flatness: f64) -> (Vec<Point>, Vec<Point>) {
    let s = &features.elements[i];
    let (start, end) = (features.offset_start(i), features.offset_end(i));
    let Link::Arc(arc) = s.link else { return (vec![s.start, s.end], vec![start, end]) };
    let widest = arc.radius.max(features.offset_radius(&arc).abs());
    let count = chord_count(s.sweep(), widest, flatness);
    let inner: Vec<Point> = (0..=count).map(|k| s.point_at(k as f64 / count as f64)).collect();
    let mut outer: Vec<Point> = inner.iter().map(|p| p + features.normal(arc.tangent_at(*p))).collect();
    (outer[0], outer[count]) = (start, end);
    (inner, outer)
}

/// How many chords keep within `flatness` of an arc.
fn chord_count(sweep: f64, radius: f64, flatness: f64) -> usize {
    let step = if flatness < radius { 2.0 * (1.0 - flatness / radius).acos() } else { 1.0 };
    (sweep / step).ceil().max(1.0) as usize
}

/// What element `i` and the corner at its end sweep, counterclockwise when growing.
fn pieces(features: &Features, i: usize, flatness: f64) -> Vec<Vec<Point>> {
    let s = &features.elements[i];
    let (mut inner, outer) = flattened_element(features, i, flatness);
    let narrow = matches!(s.link, Link::Arc(arc) if features.offset_radius(&arc) <= POINT_RADIUS);
    let next = features.next(i);
    let mut sector: Vec<Point> = Vec::new();
    if let Some(Segment { link: Link::Arc(arc), start, end }) = features.corner_curve(next) {
        let curve = Segment { start, end, link: Link::Arc(arc) };
        let count = chord_count(curve.sweep(), 1.0, flatness);
        sector.extend((0..=count).map(|k| curve.point_at(k as f64 / count as f64)));
    }
    if let (true, Link::Arc(arc)) = (narrow, s.link) {
        // Nothing beyond the centre is nearest to the arc: the piece ends there, and the corner's stands alone.
        inner.reverse();
        inner.push(arc.center);
        if sector.is_empty() {
            return vec![inner];
        }
        sector.push(s.end);
        return vec![inner, sector];
    }
    let mut piece = outer;
    if !sector.is_empty() {
        piece.pop();
        piece.append(&mut sector);
    }
    inner.reverse();
    piece.append(&mut inner);
    vec![piece]
}

/// Rebuilds rings of the union from exact curves.
struct Tracer {
    index: BoundaryIndex,
    features: Features,
    snap: f64,
}

/// Consecutive edges of the union that come from one feature: the vertex where they start, and their curve.
struct Run {
    feature: Option<Feature>,
    start: Point,
    curve: Segment,
}

impl Tracer {
    fn ring(&self, contour: &[Point]) -> Option<Ring> {
        let mut points: Vec<Point> = Vec::with_capacity(contour.len());
        for &p in contour {
            if points.last().is_none_or(|q| (p - q).norm() > self.snap) {
                points.push(p);
            }
        }
        while points.len() > 1 && (points[points.len() - 1] - points[0]).norm() <= self.snap {
            points.pop();
        }
        let n = points.len();
        if n < 3 {
            return None;
        }
        let features: Vec<Option<Feature>> =
            (0..n).map(|i| self.feature(nalgebra::center(&points[i], &points[(i + 1) % n]))).collect();
        // A run starts where the feature changes; edges without a feature are runs of their own.
        let starts: Vec<usize> =
            (0..n).filter(|&i| features[i].is_none() || features[i] != features[(i + n - 1) % n]).collect();
        let runs: Vec<Run> = starts
            .iter()
            .map(|&i| {
                let chord = Segment::line(points[i], points[(i + 1) % n]);
                let curve = features[i].and_then(|f| self.features.curve(f)).unwrap_or(chord);
                Run { feature: features[i], start: points[i], curve }
            })
            .collect();
        if runs.len() < 2 {
            return Some(self.single_curve(&points, runs.first()));
        }
        let m = runs.len();
        let joints: Vec<Point> = (0..m).map(|k| junction(&runs[(k + m - 1) % m], &runs[k])).collect();
        let vertices: Vec<Vertex> = (0..m)
            .filter(|&k| self.is_drawn(&runs[k], joints[k], joints[(k + 1) % m], runs[(k + 1) % m].start))
            .map(|k| Vertex { point: joints[k], link: runs[k].curve.link, joint: Joint::Corner, id: None })
            .collect();
        (vertices.len() >= 2).then_some(Ring { vertices })
    }

    /// A ring that runs along one offset curve only: a whole circle, as two arcs.
    fn single_curve(&self, points: &[Point], run: Option<&Run>) -> Ring {
        let Some(Run { curve: Segment { link: Link::Arc(arc), .. }, feature: Some(_), .. }) = run else {
            return Ring::polygon(points.iter().copied());
        };
        let spoke = Vector::x() * arc.radius;
        let vertex = |point| Vertex { point, link: Link::Arc(*arc), joint: Joint::Corner, id: None };
        Ring { vertices: vec![vertex(arc.center + spoke), vertex(arc.center - spoke)] }
    }

    /// The feature of the boundary whose offset passes through `p`, or near to it.
    fn feature(&self, p: Point) -> Option<Feature> {
        let (i, nearest) = self.index.nearest(p)?;
        let s = &self.features.elements[i];
        let near = |q: Point| (nearest.point - q).norm() <= CURVE_END;
        let corner = if near(s.start) {
            Some(i)
        } else if near(s.end) {
            Some(self.features.next(i))
        } else {
            None
        };
        let feature = match corner.filter(|&c| self.features.corner_curve(c).is_some()) {
            Some(c) => Feature::Corner(c),
            None => Feature::Element(i),
        };
        self.features.curve(feature).map(|_| feature)
    }

    /// Whether a run still has a length once its ends stand where they belong: edges made by snapping have none, and would
    /// otherwise go the long way round their circle.
    fn is_drawn(&self, run: &Run, from: Point, to: Point, union_to: Point) -> bool {
        if from == to {
            return false;
        }
        let Link::Arc(Arc { .. }) = run.curve.link else {
            return run.curve.start != run.curve.end || run.feature.is_none();
        };
        let exact = Segment { start: from, end: to, link: run.curve.link }.sweep();
        let drawn = Segment { start: run.start, end: union_to, link: run.curve.link }.sweep();
        (exact - drawn).abs() < std::f64::consts::PI
    }
}

/// Where one run ends and the next begins: an end of one of the curves if the union's vertex is there, else the crossing
/// of the two that is nearest to it.
fn junction(before: &Run, after: &Run) -> Point {
    let v = after.start;
    let nearest = |points: &[Point]| {
        points.iter().copied().min_by(|a, b| (a - v).norm_squared().total_cmp(&(b - v).norm_squared()))
    };
    let ends = [before.curve.end, after.curve.start, before.curve.start, after.curve.end];
    if let Some(end) = nearest(&ends).filter(|p| (p - v).norm() <= CURVE_END) {
        return end;
    }
    nearest(&crossings(&before.curve, &after.curve)).unwrap_or(v)
}

/// The crossings of the straight lines and whole circles that two curves run on.
fn crossings(a: &Segment, b: &Segment) -> Vec<Point> {
    match (a.link, b.link) {
        (Link::Line, Link::Line) => {
            let (u, v) = (a.end - a.start, b.end - b.start);
            let cross = u.perp(&v);
            if cross == 0.0 { vec![] } else { vec![a.start + u * ((b.start - a.start).perp(&v) / cross)] }
        }
        (Link::Line, Link::Arc(arc)) => line_circle(a, &arc),
        (Link::Arc(arc), Link::Line) => line_circle(b, &arc),
        (Link::Arc(p), Link::Arc(q)) => circle_circle(&p, &q),
    }
}

fn line_circle(line: &Segment, arc: &Arc) -> Vec<Point> {
    let Some(u) = (line.end - line.start).try_normalize(0.0) else { return vec![] };
    let foot = line.start + u * (arc.center - line.start).dot(&u);
    let height = (line.start - arc.center).perp(&u).abs();
    let half_squared = (arc.radius - height) * (arc.radius + height);
    if half_squared < 0.0 {
        return vec![foot];
    }
    vec![foot + u * half_squared.sqrt(), foot - u * half_squared.sqrt()]
}

fn circle_circle(p: &Arc, q: &Arc) -> Vec<Point> {
    let d = q.center - p.center;
    let distance = d.norm();
    if distance == 0.0 {
        return vec![];
    }
    let u = d / distance;
    let along = 0.5 * (distance + (p.radius - q.radius) * (p.radius + q.radius) / distance);
    let foot = p.center + u * along;
    let half_squared = (p.radius - along) * (p.radius + along);
    if half_squared < 0.0 {
        return vec![foot];
    }
    let across = Vector::new(-u.y, u.x) * half_squared.sqrt();
    vec![foot + across, foot - across]
}
