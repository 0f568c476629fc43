//! Glyph outlines as fonts hold them: closed contours of points on and off the curve.

use crate::io::svg::outline::{Command, Outline};
use crate::plane::Point;

/// A point of a contour, y up, in font units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ContourPoint {
    pub point: Point,
    /// Two neighbours off the curve have a point on it in their middle.
    pub on_curve: bool,
}

/// A closed contour of quadratic curves.
pub(super) type Contour = Vec<ContourPoint>;

/// The outline of `contours` in the coordinates of drawings, where y points down: reading it turns it up again, exactly.
pub(super) fn outline(contours: &[Contour]) -> Outline {
    let mut outline = Outline::default();
    for contour in contours {
        add_contour(contour, &mut outline);
    }
    outline
}

/// `p` as drawings have it.
pub(super) fn y_down(p: Point) -> Point {
    Point::new(p.x, -p.y)
}

fn add_contour(contour: &Contour, outline: &mut Outline) {
    let n = contour.len();
    // A point alone encloses nothing: fonts mark places with it.
    if n < 2 {
        return;
    }
    let at = |k: usize| contour[k % n];
    let first_on = contour.iter().position(|p| p.on_curve);
    let start = first_on.map_or_else(|| nalgebra::center(&at(0).point, &at(n - 1).point), |k| at(k).point);
    let first = first_on.map_or(0, |k| k + 1);
    outline.move_to(y_down(start));
    let mut control: Option<Point> = None;
    // Every point after the start, and back to it.
    let rest = if first_on.is_some() { n - 1 } else { n };
    for k in first..first + rest {
        let p = at(k);
        match (control, p.on_curve) {
            (None, true) => outline.push(Command::Line(y_down(p.point))),
            (Some(c), true) => outline.push(Command::Quadratic(y_down(c), y_down(p.point))),
            (None, false) => {}
            (Some(c), false) => {
                outline.push(Command::Quadratic(y_down(c), y_down(nalgebra::center(&c, &p.point))));
            }
        }
        control = (!p.on_curve).then_some(p.point);
    }
    match control {
        Some(c) => outline.push(Command::Quadratic(y_down(c), y_down(start))),
        None => outline.push(Command::Line(y_down(start))),
    }
    outline.close();
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contour(points: &[(f64, f64, bool)]) -> Contour {
        points.iter().map(|&(x, y, on_curve)| ContourPoint { point: Point::new(x, y), on_curve }).collect()
    }

    #[test]
    fn points_off_the_curve_imply_points_on_it() {
        let p = Point::new;
        let corners = [(1.0, 1.0, false), (-1.0, 1.0, false), (-1.0, -1.0, false), (1.0, -1.0, false)];
        let round = outline(&[contour(&corners)]);
        let subpath = &round.subpaths[0];
        assert_eq!((subpath.start, subpath.commands.len()), (p(1.0, 0.0), 4));
        assert_eq!(subpath.commands[0], Command::Quadratic(p(1.0, -1.0), p(0.0, -1.0)));
        assert_eq!(subpath.commands[3], Command::Quadratic(p(1.0, 1.0), p(1.0, 0.0)));
        // The same from any start, and with a point on the curve in the midst.
        let mixed = outline(&[contour(&[(0.0, 2.0, false), (4.0, 0.0, true), (0.0, -4.0, true)])]);
        let expected = [Command::Line(p(0.0, 4.0)), Command::Quadratic(p(0.0, -2.0), p(4.0, 0.0))];
        assert_eq!((mixed.subpaths[0].start, &mixed.subpaths[0].commands[..]), (p(4.0, 0.0), &expected[..]));
    }

    #[test]
    fn marks_of_one_point_have_no_outline() {
        assert!(outline(&[contour(&[(3.0, 3.0, true)]), vec![]]).subpaths.is_empty());
    }
}
