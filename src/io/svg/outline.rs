//! The outline of one element in its own coordinates, in `f64`: what the file says, before any transform.

use crate::plane::{Bounds, Point};

use super::affine::Affine;
use super::elliptic::EllipticArc;

/// One drawing command with its end point; it starts where the one before ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::io) enum Command {
    Line(Point),
    Quadratic(Point, Point),
    Cubic(Point, Point, Point),
    Arc(EllipticArc),
}

impl Command {
    pub fn end(&self) -> Point {
        match *self {
            Command::Line(p) | Command::Quadratic(_, p) | Command::Cubic(_, _, p) => p,
            Command::Arc(arc) => arc.to,
        }
    }
}

/// A run of commands without lifting the pen.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::io) struct Subpath {
    pub start: Point,
    pub commands: Vec<Command>,
    pub closed: bool,
}

/// All subpaths of an element.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::io) struct Outline {
    pub subpaths: Vec<Subpath>,
}

impl Outline {
    pub fn move_to(&mut self, start: Point) {
        self.subpaths.push(Subpath { start, commands: Vec::new(), closed: false });
    }

    /// Appends a command; nothing before the first [`Outline::move_to`].
    pub fn push(&mut self, command: Command) {
        if let Some(subpath) = self.subpaths.last_mut() {
            subpath.commands.push(command);
        }
    }

    pub fn close(&mut self) {
        if let Some(subpath) = self.subpaths.last_mut() {
            subpath.closed = true;
        }
    }

    /// The end of the last command.
    pub fn pen(&self) -> Option<Point> {
        let subpath = self.subpaths.last()?;
        Some(subpath.commands.last().map_or(subpath.start, Command::end))
    }

    /// The polygon or polyline through `points`.
    pub fn polyline(points: impl IntoIterator<Item = Point>, closed: bool) -> Outline {
        let mut outline = Outline::default();
        for p in points {
            if outline.subpaths.is_empty() {
                outline.move_to(p);
            } else {
                outline.push(Command::Line(p));
            }
        }
        if closed {
            outline.close();
        }
        outline
    }

    /// The four quarters of an axis-parallel ellipse, with exact axis points, as SVG runs them.
    pub fn ellipse(center: Point, rx: f64, ry: f64) -> Outline {
        let Point { coords: c } = center;
        let points =
            [(c.x + rx, c.y), (c.x, c.y + ry), (c.x - rx, c.y), (c.x, c.y - ry)].map(|(x, y)| Point::new(x, y));
        let mut outline = Outline::default();
        outline.move_to(points[0]);
        for quarter in 0..4 {
            let to = points[(quarter + 1) % 4];
            outline.push(Command::Arc(EllipticArc::quarter(center, rx, ry, quarter, to)));
        }
        outline.close();
        outline
    }

    /// A rectangle with corners rounded by quarter ellipses (sharp where `rx` or `ry` is 0), as SVG runs it.
    pub fn rectangle(x: f64, y: f64, width: f64, height: f64, rx: f64, ry: f64) -> Outline {
        let (right, bottom) = (x + width, y + height);
        if rx <= 0.0 || ry <= 0.0 {
            let corners = [(x, y), (right, y), (right, bottom), (x, bottom)];
            return Outline::polyline(corners.map(|(x, y)| Point::new(x, y)), true);
        }
        let (l, r, t, b) = (x + rx, right - rx, y + ry, bottom - ry);
        let mut outline = Outline::default();
        outline.move_to(Point::new(l, y));
        let corners = [
            (3, (r, y), (r, t), (right, t)),
            (0, (right, b), (r, b), (r, bottom)),
            (1, (l, bottom), (l, b), (x, b)),
            (2, (x, t), (l, t), (l, y)),
        ];
        for (quarter, line_to, center, arc_to) in corners {
            let [line_to, center, arc_to] = [line_to, center, arc_to].map(|(x, y)| Point::new(x, y));
            if outline.pen() != Some(line_to) {
                outline.push(Command::Line(line_to));
            }
            outline.push(Command::Arc(EllipticArc::quarter(center, rx, ry, quarter, arc_to)));
        }
        outline.close();
        outline
    }

    /// Every point that the commands name, control points included.
    pub fn points(&self) -> impl Iterator<Item = Point> + '_ {
        self.subpaths.iter().flat_map(|s| {
            let named = s.commands.iter().flat_map(|c| {
                let (points, count) = match *c {
                    Command::Line(p) => ([p; 3], 1),
                    Command::Quadratic(c, p) => ([c, p, p], 2),
                    Command::Cubic(c, d, p) => ([c, d, p], 3),
                    Command::Arc(arc) => ([arc.center, arc.to, arc.to], 2),
                };
                points.into_iter().take(count)
            });
            std::iter::once(s.start).chain(named)
        })
    }

    /// The smallest box around the image of the outline, y up. Subpaths without commands take no room.
    pub fn bounds(&self, affine: &Affine) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        for subpath in self.subpaths.iter().filter(|s| !s.commands.is_empty()) {
            let mut from = affine.apply_y_up(subpath.start);
            bounds = bounds.with_point(from);
            for command in &subpath.commands {
                let to = affine.apply_y_up(command.end());
                bounds = bounds.with_point(to);
                let lyon = |p: Point| lyon_geom::point(p.x, p.y);
                let curved = match *command {
                    Command::Line(_) => None,
                    Command::Quadratic(c, _) => {
                        let ctrl = lyon(affine.apply_y_up(c));
                        Some(lyon_geom::QuadraticBezierSegment { from: lyon(from), ctrl, to: lyon(to) }.bounding_box())
                    }
                    Command::Cubic(c, d, _) => {
                        let [ctrl1, ctrl2] = [c, d].map(|c| lyon(affine.apply_y_up(c)));
                        let curve = lyon_geom::CubicBezierSegment { from: lyon(from), ctrl1, ctrl2, to: lyon(to) };
                        Some(curve.bounding_box())
                    }
                    Command::Arc(arc) => {
                        bounds = bounds.union(arc.bounds(affine));
                        None
                    }
                };
                if let Some(b) = curved {
                    bounds = bounds.with_point(Point::new(b.min.x, b.min.y)).with_point(Point::new(b.max.x, b.max.y));
                }
                from = to;
            }
        }
        bounds
    }
}
