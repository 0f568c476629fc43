//! Geometry of an SVG element, read from its attributes in `f64`.

use std::rc::Rc;
use std::str::FromStr;

use svgtypes::{LengthUnit, PathParser, PathSegment, PointsParser};
use usvg::roxmltree::Node;

use crate::plane::Point;
use crate::units::{MM_PER_INCH, PX_PER_INCH};

use super::elliptic::EllipticArc;
use super::outline::{Command, Outline};

/// What an element's attributes say.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shape {
    pub outline: Rc<Outline>,
    /// Where the path data broke off, counted in characters, if it did.
    pub cut_at: Option<usize>,
}

/// The elements that have an outline of their own.
pub(super) const SHAPES: [&str; 7] = ["path", "rect", "circle", "ellipse", "polygon", "polyline", "line"];

/// The outline of `node`; `None` where it is no shape, or its size needs more context than its own attributes
/// (per cent, `em`).
pub(super) fn read(node: Node) -> Option<Shape> {
    let whole = |outline| Some(Shape { outline: Rc::new(outline), cut_at: None });
    let length = |name| user_length(node, name);
    match node.tag_name().name() {
        "path" => Some(read_path(attribute(node, "d").unwrap_or(""))),
        "rect" => {
            let (width, height) = (length("width")?, length("height")?);
            if width <= 0.0 || height <= 0.0 {
                return whole(Outline::default());
            }
            let (rx, ry) = radii(node)?;
            let (rx, ry) = (rx.min(width / 2.0), ry.min(height / 2.0));
            whole(Outline::rectangle(length("x")?, length("y")?, width, height, rx, ry))
        }
        "circle" => {
            let r = length("r")?;
            if r <= 0.0 {
                return whole(Outline::default());
            }
            whole(Outline::ellipse(Point::new(length("cx")?, length("cy")?), r, r))
        }
        "ellipse" => {
            let (rx, ry) = radii(node)?;
            if rx <= 0.0 || ry <= 0.0 {
                return whole(Outline::default());
            }
            whole(Outline::ellipse(Point::new(length("cx")?, length("cy")?), rx, ry))
        }
        "line" => {
            let ends = [Point::new(length("x1")?, length("y1")?), Point::new(length("x2")?, length("y2")?)];
            whole(Outline::polyline(ends, false))
        }
        name @ ("polygon" | "polyline") => {
            let points = PointsParser::from(attribute(node, "points").unwrap_or("")).map(|(x, y)| Point::new(x, y));
            whole(Outline::polyline(points, name == "polygon"))
        }
        _ => None,
    }
}

/// An attribute without namespace, or the style property of that name.
pub(super) fn attribute<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    let property = node.attribute("style").and_then(|style| {
        style
            .split(';')
            .filter_map(|p| p.split_once(':'))
            .filter(|(key, _)| key.trim() == name)
            .map(|(_, v)| v)
            .next_back()
    });
    property.or_else(|| node.attribute(name)).map(str::trim)
}

/// A length in user units, 0 where absent or malformed; `None` where it needs context.
fn user_length(node: Node, name: &str) -> Option<f64> {
    match attribute(node, name).map(svgtypes::Length::from_str) {
        None | Some(Err(_)) => Some(0.0),
        Some(Ok(length)) => to_pixels(length),
    }
}

/// A length in CSS pixels, which are the user units of an unscaled drawing; `None` for units that need context.
pub(super) fn to_pixels(length: svgtypes::Length) -> Option<f64> {
    let n = length.number;
    match length.unit {
        LengthUnit::None | LengthUnit::Px => Some(n),
        LengthUnit::In => Some(n * PX_PER_INCH),
        LengthUnit::Cm => Some(n * 10.0 * PX_PER_INCH / MM_PER_INCH),
        LengthUnit::Mm => Some(n * PX_PER_INCH / MM_PER_INCH),
        LengthUnit::Pt => Some(n * PX_PER_INCH / 72.0),
        LengthUnit::Pc => Some(n * PX_PER_INCH / 6.0),
        LengthUnit::Em | LengthUnit::Ex | LengthUnit::Percent => None,
    }
}

/// `rx` and `ry`: a missing or negative one takes the other's value.
fn radii(node: Node) -> Option<(f64, f64)> {
    let radius = |name| match attribute(node, name).map(svgtypes::Length::from_str) {
        Some(Ok(length)) if !length.number.is_sign_negative() => to_pixels(length).map(Some),
        _ => Some(None),
    };
    let (rx, ry) = (radius("rx")?, radius("ry")?);
    Some((rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0)))
}

/// Path data up to its first error, as SVG draws it.
fn read_path(data: &str) -> Shape {
    let mut reader = PathReader::default();
    let mut count = 0;
    for segment in PathParser::from(data) {
        match segment {
            Ok(segment) => reader.push(segment),
            Err(error) => {
                let at = match error {
                    svgtypes::Error::UnexpectedData(at)
                    | svgtypes::Error::InvalidChar(_, at)
                    | svgtypes::Error::InvalidString(_, at)
                    | svgtypes::Error::InvalidNumber(at) => at,
                    _ => data.chars().count(),
                };
                return Shape { outline: Rc::new(reader.outline), cut_at: Some(at) };
            }
        }
        count += 1;
    }
    // "none" and nothing at all are ways to say that there is no path.
    let garbage = count == 0 && !matches!(data, "" | "none");
    Shape { outline: Rc::new(reader.outline), cut_at: garbage.then_some(0) }
}

/// Makes relative and smooth commands absolute.
#[derive(Default)]
struct PathReader {
    outline: Outline,
    pen: Point,
    /// The last control point, for `S` after a cubic and `T` after a quadratic.
    cubic_control: Option<Point>,
    quadratic_control: Option<Point>,
    /// Whether the subpath was closed and a command would start a new one.
    closed: bool,
}

impl PathReader {
    fn push(&mut self, segment: PathSegment) {
        let pen = self.pen;
        // Only a relative command adds: an absolute number keeps its digits.
        let at = |abs: bool, x: f64, y: f64| if abs { Point::new(x, y) } else { Point::new(pen.x + x, pen.y + y) };
        let reflected = |control: Option<Point>| control.map_or(pen, |c| pen + (pen - c));
        let command = match segment {
            PathSegment::MoveTo { abs, x, y } => {
                self.pen = at(abs, x, y);
                self.outline.move_to(self.pen);
                (self.cubic_control, self.quadratic_control, self.closed) = (None, None, false);
                return;
            }
            PathSegment::ClosePath { .. } => {
                self.outline.close();
                self.pen = self.outline.subpaths.last().map_or(self.pen, |s| s.start);
                (self.cubic_control, self.quadratic_control, self.closed) = (None, None, true);
                return;
            }
            PathSegment::LineTo { abs, x, y } => Command::Line(at(abs, x, y)),
            PathSegment::HorizontalLineTo { abs, x } => {
                Command::Line(Point::new(if abs { x } else { pen.x + x }, pen.y))
            }
            PathSegment::VerticalLineTo { abs, y } => Command::Line(Point::new(pen.x, if abs { y } else { pen.y + y })),
            PathSegment::CurveTo { abs, x1, y1, x2, y2, x, y } => {
                Command::Cubic(at(abs, x1, y1), at(abs, x2, y2), at(abs, x, y))
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                Command::Cubic(reflected(self.cubic_control), at(abs, x2, y2), at(abs, x, y))
            }
            PathSegment::Quadratic { abs, x1, y1, x, y } => Command::Quadratic(at(abs, x1, y1), at(abs, x, y)),
            PathSegment::SmoothQuadratic { abs, x, y } => {
                Command::Quadratic(reflected(self.quadratic_control), at(abs, x, y))
            }
            PathSegment::EllipticalArc { abs, rx, ry, x_axis_rotation, large_arc, sweep, x, y } => {
                let to = at(abs, x, y);
                EllipticArc::from_svg(pen, (rx, ry), x_axis_rotation, large_arc, sweep, to)
                    .map_or(Command::Line(to), Command::Arc)
            }
        };
        if self.closed {
            self.outline.move_to(pen);
            self.closed = false;
        }
        self.outline.push(command);
        self.pen = command.end();
        self.cubic_control = if let Command::Cubic(_, c, _) = command { Some(c) } else { None };
        self.quadratic_control = if let Command::Quadratic(c, _) = command { Some(c) } else { None };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relative_smooth_and_closing_commands_become_absolute() {
        let p = Point::new;
        let shape = read_path("m1 2h3v4zl1 1c0 1 1 2 2 2s2 1 2 2q1 0 1 1t1 1");
        assert_eq!(shape.cut_at, None);
        let [first, second] = &shape.outline.subpaths[..] else { panic!("two subpaths") };
        assert_eq!(first.commands, [Command::Line(p(4.0, 2.0)), Command::Line(p(4.0, 6.0))]);
        assert!(first.closed && !second.closed);
        assert_eq!(second.start, p(1.0, 2.0));
        assert_eq!(
            second.commands,
            [
                Command::Line(p(2.0, 3.0)),
                Command::Cubic(p(2.0, 4.0), p(3.0, 5.0), p(4.0, 5.0)),
                Command::Cubic(p(5.0, 5.0), p(6.0, 6.0), p(6.0, 7.0)),
                Command::Quadratic(p(7.0, 7.0), p(7.0, 8.0)),
                Command::Quadratic(p(7.0, 9.0), p(8.0, 9.0)),
            ]
        );
    }

    #[test]
    fn broken_path_data_is_read_up_to_the_break() {
        let shape = read_path("M0 0L10 0 10 10L5 oops");
        assert_eq!(shape.outline.subpaths[0].commands.len(), 2);
        assert!(shape.cut_at.is_some_and(|at| (16..=21).contains(&at)), "{:?}", shape.cut_at);
        assert_eq!(read_path("").cut_at, None);
        assert!(read_path("L 1 1").cut_at.is_some());
    }

    #[test]
    fn shapes_are_read_with_their_units() {
        let xml = r#"<svg><rect x="1in" width="2" height="4" ry="1"/><circle r="-1"/><circle r="10%"/></svg>"#;
        let document = usvg::roxmltree::Document::parse(xml).unwrap();
        let shapes: Vec<_> = document.descendants().filter(|n| n.is_element()).skip(1).map(read).collect();
        let rect = shapes[0].as_ref().unwrap();
        // Width 2 with corners of radius 1: two half turns and two straight sides.
        assert_eq!(rect.outline.subpaths[0].start, Point::new(97.0, 0.0));
        let straight = |c: &&Command| matches!(c, Command::Line(_));
        assert_eq!(rect.outline.subpaths[0].commands.iter().filter(straight).count(), 2);
        assert_eq!(*shapes[1].as_ref().unwrap().outline, Outline::default());
        assert_eq!(shapes[2], None);
    }
}
