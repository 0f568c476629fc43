//! usvg's outlines, which are in single precision: compared with those of the file, and used where the file has none.

use crate::plane::Point;

use super::outline::{Command, Outline};

/// Whether usvg's path can be this outline: every point where a command ends comes in it, in order.
pub(super) fn looks_like(outline: &Outline, path: &usvg::tiny_skia_path::Path) -> bool {
    use usvg::tiny_skia_path::PathSegment;
    /// Single precision, after a sum or two.
    const ALIKE: f64 = 1e-6;
    let b = path.bounds();
    let size = [b.left(), b.top(), b.right(), b.bottom()].iter().fold(0.0f64, |m, x| m.max(f64::from(x.abs())));
    let mut drawn = path.segments().filter_map(|s| match s {
        PathSegment::MoveTo(p) | PathSegment::LineTo(p) | PathSegment::QuadTo(_, p) | PathSegment::CubicTo(_, _, p) => {
            Some(Point::new(f64::from(p.x), f64::from(p.y)))
        }
        PathSegment::Close => None,
    });
    let alike = |p: Point, q: Point| (p - q).amax() <= ALIKE * size;
    let mut ends = outline.subpaths.iter().filter(|s| !s.commands.is_empty()).flat_map(|s| {
        std::iter::once((true, s.start)).chain(s.commands.iter().map(|c| (!matches!(c, Command::Arc(_)), c.end())))
    });
    // Only an arc may have points of its own in between.
    let mut next = |exact: bool, p: Point| {
        if exact { drawn.next().is_some_and(|q| alike(p, q)) } else { drawn.any(|q| alike(p, q)) }
    };
    ends.all(|(exact, p)| next(exact, p)) && drawn.next().is_none()
}

/// usvg's outline, for what the file does not say in plain numbers.
pub(super) fn single_precision(path: &usvg::tiny_skia_path::Path, is_round: bool) -> Outline {
    use usvg::tiny_skia_path::PathSegment;
    if is_round {
        // The four cubics of an ellipse touch its box.
        let b = path.bounds();
        let [l, t, r, b] = [b.left(), b.top(), b.right(), b.bottom()].map(decimal);
        return Outline::ellipse(Point::new((l + r) / 2.0, (t + b) / 2.0), (r - l) / 2.0, (b - t) / 2.0);
    }
    let point = |p: usvg::tiny_skia_path::Point| Point::new(decimal(p.x), decimal(p.y));
    let mut outline = Outline::default();
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(p) => outline.move_to(point(p)),
            PathSegment::LineTo(p) => outline.push(Command::Line(point(p))),
            PathSegment::QuadTo(c, p) => outline.push(Command::Quadratic(point(c), point(p))),
            PathSegment::CubicTo(c, d, p) => outline.push(Command::Cubic(point(c), point(d), point(p))),
            PathSegment::Close => outline.close(),
        }
    }
    outline
}

/// The number that was meant by a number in single precision: the one with the fewest digits.
pub(super) fn decimal(x: f32) -> f64 {
    x.to_string().parse().unwrap_or(f64::from(x))
}
