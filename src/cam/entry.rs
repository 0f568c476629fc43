//! Where the tool enters a contour.
//!
//! The tool dwells where it enters and may leave a mark, so it enters in the middle of a long stretch that it cuts
//! freely: a straight one, or a convex one of the part. Concave stretches grip the tool and come last; corners never.

use crate::plane::{Link, Point, Ring, Segment, Turn};

use super::contour::middle;

/// What a millimetre of a convex arc is worth in millimetres of a straight stretch.
const CONVEX_WORTH: f64 = 0.5;

/// The same of a concave arc: taken where a contour has little else, as a round hole.
const CONCAVE_WORTH: f64 = 0.05;

/// Other places are offered to the order if they are worth this share of the best one.
const WORTH_OFFERING: f64 = 0.5;

/// How many places are offered: the order tries them all.
const OFFERED: usize = 4;

/// A place where the tool may enter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EntryPlace {
    /// The element of the path that it lies on.
    pub element: usize,
    /// Where it is.
    pub point: Point,
}

/// The places of a path that has the part on its left, best first; `None` for an empty path.
pub(super) fn places(path: &Ring) -> Option<Vec<EntryPlace>> {
    if path.len() < 2 {
        let point = path.vertices.first()?.point;
        return Some(vec![EntryPlace { element: 0, point }]);
    }
    let mut ranked: Vec<(f64, usize)> = path.segments().map(|s| worth(&s)).zip(0..).collect();
    // Descending; equal worth in the order of the path, so that the choice is the same everywhere.
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let enough = WORTH_OFFERING * ranked[0].0;
    let offered = ranked.iter().take_while(|(worth, _)| *worth >= enough).take(OFFERED);
    Some(offered.map(|&(_, element)| EntryPlace { element, point: middle(&path.segment(element)) }).collect())
}

/// How good it is to enter in the middle of an element, in millimetres.
fn worth(segment: &Segment) -> f64 {
    let share = match segment.link {
        Link::Line => 1.0,
        Link::Arc(arc) if arc.turn == Turn::Left => CONVEX_WORTH,
        Link::Arc(_) => CONCAVE_WORTH,
    };
    share * segment.length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::{Arc, Joint, Vertex};

    #[test]
    fn the_longest_straight_stretch_comes_first() {
        let p = |x: f64, y: f64| Point::new(x, y);
        let path = Ring::polygon([p(0.0, 0.0), p(30.0, 0.0), p(30.0, 10.0), p(0.0, 10.0)]);
        let places = places(&path).unwrap();
        assert_eq!(places[0], EntryPlace { element: 0, point: p(15.0, 0.0) });
        assert_eq!(places[1], EntryPlace { element: 2, point: p(15.0, 10.0) });
        assert_eq!(places.len(), 2);
    }

    #[test]
    fn a_long_concave_arc_gives_way_to_a_short_line() {
        // A half disk bitten out of a plate: the bite is the longest element.
        let p = |x: f64, y: f64| Point::new(x, y);
        let mut path = Ring::polygon([p(-5.0, 0.0), p(-5.0, -2.0), p(5.0, -2.0), p(5.0, 0.0)]);
        let bite = Arc { center: p(0.0, 0.0), radius: 5.0, turn: Turn::Right };
        path.vertices[3] = Vertex { link: Link::Arc(bite), joint: Joint::Corner, ..path.vertices[3] };
        // Turn::Right from (5, 0) to (-5, 0) passes below: keep the bite above the plate's lower edge.
        let path = Ring { vertices: path.vertices };
        assert_eq!(places(&path).unwrap()[0].point, p(0.0, -2.0));
    }

    #[test]
    fn a_round_hole_is_entered_on_its_arc_and_a_point_at_itself() {
        let hole = Ring::circle(Point::new(1.0, 1.0), 3.0).reversed();
        let places_of_hole = places(&hole).unwrap();
        assert_eq!(places_of_hole.len(), 4);
        for e in places_of_hole {
            assert!(((e.point - Point::new(1.0, 1.0)).norm() - 3.0).abs() < 1e-12);
            assert!(hole.segment(e.element).nearest(e.point).distance < 1e-12);
        }
        let drill = Ring { vertices: vec![Vertex::corner(Point::new(4.0, 4.0))] };
        assert_eq!(places(&drill).unwrap()[0].point, Point::new(4.0, 4.0));
        assert!(places(&Ring::default()).is_none());
    }
}
