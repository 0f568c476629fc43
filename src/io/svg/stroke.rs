//! The area that a stroke covers.

use kurbo::{BezPath, Cap, Join, PathEl, Shape, StrokeOpts};

use crate::plane::{Bounds, Point, left_normal, turn_angle};

use super::affine::Affine;
use super::elliptic::EllipticArc;
use super::outline::{Command, Outline};
use super::rough::decimal;

/// How far the edge of a stroke may stray from the true offset curve, in parts of the larger of outline and width: a
/// tenth of what sampling then adds.
const OFFSET_ACCURACY: f64 = 2e-7;

/// More dashes than this in one drawing are taken for a slip: a second or two, and 300 MB.
pub(super) const MAX_DASHES: f64 = 100_000.0;

/// The area covered by `stroke` along `outline`, to be filled by the nonzero rule, and how many dashes it is made of.
///
/// # Errors
/// The number of dashes, where it is above `most`.
pub(super) fn area(outline: &Outline, stroke: &usvg::Stroke, most: f64) -> Result<(Outline, f64), f64> {
    let width = decimal(stroke.width().get());
    let join = match stroke.linejoin() {
        usvg::LineJoin::Miter | usvg::LineJoin::MiterClip => Join::Miter,
        usvg::LineJoin::Round => Join::Round,
        usvg::LineJoin::Bevel => Join::Bevel,
    };
    let cap = match stroke.linecap() {
        usvg::LineCap::Butt => Cap::Butt,
        usvg::LineCap::Round => Cap::Round,
        usvg::LineCap::Square => Cap::Square,
    };
    let bounds = outline.bounds(&Affine::IDENTITY);
    let size = if bounds == Bounds::EMPTY { width } else { bounds.width().max(bounds.height()).max(width) };
    let tolerance = OFFSET_ACCURACY * size;
    let path = to_kurbo(outline, tolerance);
    let mut style = kurbo::Stroke::new(width).with_join(join).with_caps(cap);
    style = style.with_miter_limit(decimal(stroke.miterlimit().get()));
    let mut count = 0.0;
    if let Some(dashes) = stroke.dasharray() {
        let dashes: Vec<f64> = dashes.iter().map(|&d| decimal(d)).collect();
        let period: f64 = dashes.iter().sum();
        // Of an odd number of lengths every second round begins with a gap: half of them are dashes all the same.
        count = (path.perimeter(tolerance * 1e3) / period * dashes.len() as f64 / 2.0).ceil();
        if count.is_nan() || count > most {
            return Err(count);
        }
        style = style.with_dashes(decimal(stroke.dashoffset()), dashes);
    }
    let area = kurbo::stroke(path, &style, &StrokeOpts::default(), tolerance);
    Ok((from_kurbo(&area, width / 2.0), count))
}

fn to_kurbo(outline: &Outline, tolerance: f64) -> BezPath {
    let k = |p: Point| kurbo::Point::new(p.x, p.y);
    let mut path = BezPath::new();
    for subpath in &outline.subpaths {
        path.move_to(k(subpath.start));
        for command in &subpath.commands {
            match *command {
                Command::Line(p) => path.line_to(k(p)),
                Command::Quadratic(c, p) => path.quad_to(k(c), k(p)),
                Command::Cubic(c, d, p) => path.curve_to(k(c), k(d), k(p)),
                Command::Arc(arc) => {
                    let radii = kurbo::Vec2::new(arc.rx, arc.ry);
                    let arc_path =
                        kurbo::Arc::new(k(arc.center), radii, arc.start, arc.sweep, arc.degrees.to_radians());
                    arc_path.to_cubic_beziers(tolerance, |c, d, p| path.curve_to(c, d, p));
                }
            }
        }
        if subpath.closed {
            path.close_path();
        }
    }
    path
}

fn from_kurbo(path: &BezPath, radius: f64) -> Outline {
    let p = |k: kurbo::Point| Point::new(k.x, k.y);
    let mut outline = Outline::default();
    for element in path.elements() {
        let pen = outline.pen();
        match *element {
            PathEl::MoveTo(to) => outline.move_to(p(to)),
            PathEl::LineTo(to) => outline.push(Command::Line(p(to))),
            PathEl::QuadTo(c, to) => outline.push(Command::Quadratic(p(c), p(to))),
            PathEl::CurveTo(c, d, to) => {
                let round = pen.and_then(|from| round(from, p(c), p(d), p(to), radius));
                outline.push(round.map_or(Command::Cubic(p(c), p(d), p(to)), Command::Arc));
            }
            PathEl::ClosePath => outline.close(),
        }
    }
    outline
}

/// The arc that a cubic stands for, where it is part of a round join or cap: kurbo makes these of cubics that are off by
/// up to 2.7e-4 of the radius, whatever accuracy is asked for.
fn round(from: Point, c: Point, d: Point, to: Point, radius: f64) -> Option<EllipticArc> {
    /// In parts of the radius: rounding is far below, the offset of a curve that is no circle far above.
    const ALIKE: f64 = 1e-9;
    let (start, end) = ((c - from).try_normalize(0.0)?, (to - d).try_normalize(0.0)?);
    for side in [1.0, -1.0] {
        let center = from + left_normal(start) * (side * radius);
        if (to + left_normal(end) * (side * radius) - center).norm() > ALIKE * radius {
            continue;
        }
        let sweep = turn_angle(start, end);
        let arm = 4.0 / 3.0 * (sweep.abs() / 4.0).tan() * radius;
        if sweep * side > 0.0 && ((c - from).norm() - arm).abs() <= ALIKE * radius {
            let spoke = from - center;
            let start = spoke.y.atan2(spoke.x);
            return Some(EllipticArc { center, rx: radius, ry: radius, degrees: 0.0, start, sweep, to });
        }
    }
    None
}
