//! How tightly the path of a program turns.

use super::motion::{Motion, Program};
use super::solid::{Remainder, Solid};
use crate::plane::{Link, Region, Segment, turn_angle};

/// The tightest turns of a path in the XY plane, below the top of the stock.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct TightestTurns {
    /// Least radius in millimetres; 0 where the path has a corner, `None` where it does not turn.
    pub smallest_mm: Option<f64>,
    /// The same along concave turns alone, where the part lies on the outside of the turn: what rounding decides. (Around
    /// the part's own corners a path turns at the tool's radius at least.)
    pub smallest_concave_mm: Option<f64>,
    /// The tightest arc, left or right.
    pub tightest_arc: Option<PathPlace>,
    /// The sharpest corner.
    pub sharpest_corner: Option<PathPlace>,
    /// How many corners there are, every pass counted.
    pub corners: usize,
}

/// A place on a path.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct PathPlace {
    /// Radius of the arc in millimetres; 0 for a corner.
    pub radius_mm: f64,
    /// How far the path turns there, in degrees.
    pub turn_degrees: f64,
    /// Where it is: a corner, or the start of an arc.
    pub x_mm: f64,
    /// Where it is.
    pub y_mm: f64,
    /// The line of the program.
    pub line: usize,
}

/// What rounding to the digits of a program may move an end of an element, in millimetres: half a step of three
/// decimals, in both directions, at both the end and the centre.
const ROUNDING: f64 = 0.0015;

/// A joint that turns by less than this, in radians, is smooth however long its elements are: GRBL takes it at full
/// speed.
const SMOOTH_TURN: f64 = 2e-3;

/// Elements shorter than this have no direction that survives rounding, in millimetres.
const SHORTEST: f64 = 3.0 * ROUNDING;

/// The most that an arc that is written as a line may bulge, in millimetres: a tenth of the fourth decimal, with room. An arc
/// of length l and sagitta s turns by 8 s / l.
const FLAT_SAGITTA: f64 = 2e-5;

/// The tightest turns of `program` around what must remain.
pub fn tightest_turns(program: &Program, region: &Region, remainder: Remainder, stock_top: f64) -> TightestTurns {
    let solid = Solid::new(region, remainder);
    let mut result = TightestTurns::default();
    let mut last: Option<Segment> = None;
    // The way along elements that were too short to have a direction.
    let mut skipped = 0.0;
    for motion in &program.motions {
        if !motion.is_feed() || !motion.is_in_stock(stock_top) || motion.trace().next().is_none() {
            // A plunge, a rapid and a dwell stop the tool: what comes after is a new path.
            last = None;
            skipped = 0.0;
            continue;
        }
        for element in motion.trace() {
            // Too short to have a direction: the joint is between its neighbours.
            if element.length() < SHORTEST {
                skipped += element.length();
                continue;
            }
            if let Some(before) = last {
                result.add_joint(&before, &element, skipped, motion, &solid);
            }
            skipped = 0.0;
            result.add_arc(&element, motion, &solid);
            last = Some(element);
        }
    }
    result
}

impl TightestTurns {
    fn add_arc(&mut self, element: &Segment, motion: &Motion, solid: &Solid) {
        let Link::Arc(arc) = element.link else { return };
        let place = PathPlace {
            radius_mm: arc.radius,
            turn_degrees: element.sweep().to_degrees(),
            x_mm: element.start.x,
            y_mm: element.start.y,
            line: motion.line,
        };
        if self.tightest_arc.is_none_or(|a| arc.radius < a.radius_mm) {
            self.tightest_arc = Some(place);
        }
        let middle = element.point_at(0.5);
        self.add_radius(arc.radius, arc.center - middle, middle, solid);
    }

    /// Takes the turn between two elements with a way of `skipped` between them.
    fn add_joint(&mut self, before: &Segment, after: &Segment, skipped: f64, motion: &Motion, solid: &Solid) {
        let turn = turn_angle(before.end_tangent(), after.start_tangent());
        let chord = |s: &Segment| (s.end - s.start).norm().max(SHORTEST);
        let flattened = if skipped > 0.0 { 8.0 * FLAT_SAGITTA / skipped } else { 0.0 };
        let noise = SMOOTH_TURN + ROUNDING * (1.0 / chord(before) + 1.0 / chord(after)) + flattened;
        if turn.abs() <= noise {
            return;
        }
        self.corners += 1;
        let degrees = turn.abs().to_degrees();
        if self.sharpest_corner.is_none_or(|c| degrees > c.turn_degrees) {
            self.sharpest_corner = Some(PathPlace {
                radius_mm: 0.0,
                turn_degrees: degrees,
                x_mm: after.start.x,
                y_mm: after.start.y,
                line: motion.line,
            });
        }
        // The inside of the turn.
        let inward = after.start_tangent() - before.end_tangent();
        self.add_radius(0.0, inward, after.start, solid);
    }

    /// Takes a turn with its centre towards `inward` of `place`.
    fn add_radius(&mut self, radius: f64, inward: crate::plane::Vector, place: crate::plane::Point, solid: &Solid) {
        let least = |old: Option<f64>| Some(old.map_or(radius, |r| r.min(radius)));
        self.smallest_mm = least(self.smallest_mm);
        if self.smallest_concave_mm.is_some_and(|smallest| smallest <= radius) {
            return;
        }
        let is_concave = solid.boundary.nearest(place).is_some_and(|(_, n)| (n.point - place).dot(&inward) < 0.0);
        if is_concave {
            self.smallest_concave_mm = least(self.smallest_concave_mm);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::read;
    use crate::plane::{Point, Ring};

    fn of(path: &str) -> TightestTurns {
        let ring = [[0.0, 0.0], [20.0, 0.0], [20.0, 10.0], [10.0, 10.0], [10.0, 20.0], [0.0, 20.0]];
        let part = Region::new(vec![Ring::polygon(ring.map(|p| Point::new(p[0], p[1])))]);
        let program = read(&format!("G21 G90 G17 G94\nG0 Z5\nG0 X-2 Y0\nG1 Z-1 F500\n{path}")).unwrap();
        tightest_turns(&program, &part, Remainder::Inside, 0.0)
    }

    #[test]
    fn corners_and_arcs() {
        let sharp = of("G1 Y20\nG2 X0 Y22 I2 J0\nG1 X10\nG2 X12 Y20 I0 J-2\nG1 Y12\nG1 X20\nG2 X22 Y10 I0 J-2\nG1 Y0");
        assert_eq!(sharp.smallest_mm, Some(0.0));
        assert_eq!(sharp.smallest_concave_mm, Some(0.0));
        assert_eq!(sharp.corners, 1);
        let corner = sharp.sharpest_corner.unwrap();
        assert!((corner.turn_degrees - 90.0).abs() < 1e-9 && corner.line == 10, "{corner:?}");
        let round = of("G1 Y20\nG2 X0 Y22 I2 J0\nG1 X10\nG2 X12 Y20 I0 J-2\nG1 Y15\nG3 X15 Y12 I3 J0\nG1 X20\n\
                        G2 X22 Y10 I0 J-2\nG1 Y0");
        assert_eq!((round.smallest_mm, round.smallest_concave_mm, round.corners), (Some(2.0), Some(3.0), 0));
        assert_eq!(of("G1 Y20"), TightestTurns::default());
    }

    #[test]
    fn rounded_digits_are_no_corner_and_small_corners_are() {
        // A half circle of many short lines has corners; of rounded arcs it has none.
        let mut lines = String::new();
        let mut arcs = String::new();
        for k in 0..60 {
            let angle = |k: i32| std::f64::consts::PI * (1.0 - f64::from(k) / 60.0);
            let at = |k: i32| ((10.0 + 12.0 * angle(k).cos()), (12.0 * angle(k).sin()));
            let ((ax, ay), (x, y)) = (at(k), at(k + 1));
            lines += &format!("G1 X{x:.3} Y{y:.3}\n");
            arcs += &format!("G2 X{x:.3} Y{y:.3} I{:.3} J{:.3}\n", 10.0 - ax, -ay);
        }
        assert_eq!(of(&lines).corners, 59);
        let arcs = of(&arcs);
        assert_eq!(arcs.corners, 0, "{arcs:?}");
        assert!((arcs.smallest_mm.unwrap() - 12.0).abs() < 0.01);
    }

    #[test]
    fn an_arc_of_three_thousandths_written_as_a_line_is_no_corner() {
        // From a coast: a third of a degree at a radius of 0.56.
        let coast = "G1 X51.12 Y60.65\nG1 X51.0817 Y60.3272\nG1 X51.0813 Y60.3239\nG1 X50.6954 Y57.292";
        // The way there makes one.
        assert_eq!(of(coast).corners, 1);
        // Twenty degrees in the same way are one.
        let corner = "G1 X51.12 Y60.65\nG1 X51.0817 Y60.3272\nG1 X51.0813 Y60.3239\nG1 X49.7 Y57.5";
        assert_eq!(of(corner).corners, 2);
    }

    #[test]
    fn a_plunge_between_two_elements_is_no_corner() {
        assert_eq!(of("G1 Y20\nG1 Z-2\nG1 X5").corners, 0);
    }
}
