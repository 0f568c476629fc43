//! How deep a program cuts into what must remain.

use std::collections::HashSet;

use super::motion::{Motion, Program};
use super::solid::{Remainder, Solid};
use crate::plane::{Point, Region, Segment};

/// The deepest cut into what must remain.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Gouge {
    /// Depth in millimetres; negative where nothing is cut: then the least distance that is kept.
    pub depth_mm: f64,
    /// Where the tool's centre is then.
    pub x_mm: f64,
    /// Where the tool's centre is then.
    pub y_mm: f64,
    /// The line of the program.
    pub line: usize,
}

/// Where the tool's centre itself lies in what must remain, its depth is searched for to this, in millimetres. (A
/// centre outside has its distance in closed form.)
const SEARCH_TOLERANCE: f64 = 1e-4;

/// The deepest cut of `program` into what must remain; `None` where nothing moves below `stock_top`, or nothing must
/// remain.
///
/// Counts every motion below the top of the stock, rapids too, as a disk of `tool_radius` along its whole way.
pub fn deepest_cut(
    program: &Program,
    region: &Region,
    remainder: Remainder,
    tool_radius: f64,
    stock_top: f64,
) -> Option<Gouge> {
    let solid = Solid::new(region, remainder);
    // Passes at several depths repeat themselves in the plane.
    let mut seen = HashSet::new();
    let mut deepest: Option<Gouge> = None;
    let mut end_of_last: Option<(Point, bool)> = None;
    for motion in program.motions.iter().filter(|m| m.is_in_stock(stock_top)) {
        for element in elements(motion) {
            if !seen.insert(bits(&element)) {
                end_of_last = None;
                continue;
            }
            let starts_inside = match end_of_last {
                Some((end, inside)) if end == element.start => inside,
                _ => solid.contains(element.start),
            };
            let (_, approach) = solid.boundary.approach(&element)?;
            let known = deepest.map_or(f64::NEG_INFINITY, |d| d.depth_mm - tool_radius);
            let is_apart = approach.distance > 0.0;
            end_of_last = is_apart.then_some((element.end, starts_inside));
            let (depth, center) = if is_apart && !starts_inside {
                (-approach.distance, approach.on_first)
            } else {
                solid.deepest(&element, known, SEARCH_TOLERANCE)
            };
            let depth = depth + tool_radius;
            if deepest.is_none_or(|d| depth > d.depth_mm) {
                deepest = Some(Gouge { depth_mm: depth, x_mm: center.x, y_mm: center.y, line: motion.line });
            }
        }
    }
    deepest
}

/// The trace, or the point where the tool goes down.
fn elements(motion: &Motion) -> impl Iterator<Item = Segment> {
    let at = motion.to.xy();
    let plunge = motion.trace().next().is_none().then_some(Segment::line(at, at));
    motion.trace().chain(plunge)
}

fn bits(element: &Segment) -> [u64; 7] {
    let (center, turn) = match element.link {
        crate::plane::Link::Line => ([0.0; 2], 0),
        crate::plane::Link::Arc(arc) => ([arc.center.x, arc.center.y], 1 + arc.turn as u64),
    };
    let [a, b] = [element.start, element.end];
    [a.x.to_bits(), a.y.to_bits(), b.x.to_bits(), b.y.to_bits(), center[0].to_bits(), center[1].to_bits(), turn]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::read;
    use crate::plane::Ring;

    const HEAD: &str = "G21 G90 G17 G94\nG0 Z5\nM3 S1000\nG4 P1\n";

    fn square(side: f64) -> Region {
        let p = Point::new;
        Region::new(vec![Ring::polygon([p(0.0, 0.0), p(side, 0.0), p(side, side), p(0.0, side)])])
    }

    fn gouge(path: &str, region: &Region, remainder: Remainder, radius: f64) -> Gouge {
        let program = read(&format!("{HEAD}{path}")).unwrap();
        deepest_cut(&program, region, remainder, radius, 0.0).unwrap()
    }

    #[test]
    fn a_path_that_is_too_close_gouges_by_as_much() {
        let around = |d: f64| {
            format!(
                "G0 X{a} Y0\nG1 Z-1 F100\nG1 Y10\nG2 X0 Y{b} I{d} J0\nG1 X10\nG2 X{b} Y10 I0 J-{d}\nG1 Y0\n\
                 G2 X10 Y{a} I-{d} J0\nG1 X0\nG2 X{a} Y0 I0 J{d}",
                a = -d,
                b = 10.0 + d
            )
        };
        let good = gouge(&around(2.0), &square(10.0), Remainder::Inside, 2.0);
        assert!(good.depth_mm.abs() < 1e-12, "{good:?}");
        let bad = gouge(&around(1.99), &square(10.0), Remainder::Inside, 2.0);
        assert!((bad.depth_mm - 0.01).abs() < 1e-12, "{bad:?}");
        let far = gouge(&around(2.5), &square(10.0), Remainder::Inside, 2.0);
        assert!((far.depth_mm + 0.5).abs() < 1e-12, "{far:?}");
    }

    #[test]
    fn a_hole_is_cut_from_within() {
        let mut plate = square(40.0);
        plate.rings.push(Ring::circle(Point::new(20.0, 20.0), 10.0).reversed());
        let hole = |r: f64| format!("G0 X{} Y20\nG1 Z-1 F100\nG3 I-{r} J0 X{}", 20.0 + r, 20.0 + r);
        let good = gouge(&hole(8.0), &plate, Remainder::Inside, 2.0);
        assert!(good.depth_mm.abs() < 1e-12, "{good:?}");
        let bad = gouge(&hole(8.125), &plate, Remainder::Inside, 2.0);
        assert!((bad.depth_mm - 0.125).abs() < 1e-12, "{bad:?}");
        assert_eq!(bad.line, 6, "the plunge already is too near");
    }

    #[test]
    fn a_tool_inside_of_the_part_is_as_deep_as_it_is() {
        // Straight through the middle: 5 mm from all sides there, and the tool's radius more.
        let through = gouge("G0 X-5 Y5\nG1 Z-1 F100\nG1 X15", &square(10.0), Remainder::Inside, 2.0);
        assert!((through.depth_mm - 7.0).abs() < 2.0 * SEARCH_TOLERANCE, "{through:?}");
        // A plunge into it, and a rapid through it.
        let plunge = gouge("G0 X3 Y5\nG1 Z-1 F100", &square(10.0), Remainder::Inside, 2.0);
        assert!((plunge.depth_mm - 5.0).abs() < 1e-12, "{plunge:?}");
        let rapid = gouge("G0 X-5 Y5\nG0 Z-1\nG0 X1", &square(10.0), Remainder::Inside, 2.0);
        assert!((rapid.depth_mm - 3.0).abs() < 2.0 * SEARCH_TOLERANCE, "{rapid:?}");
    }

    #[test]
    fn a_pocket_leaves_what_is_around_it() {
        let path = "G0 X2 Y2\nG1 Z-1 F100\nG1 X8\nG1 Y8\nG1 X2\nG1 Y2";
        let good = gouge(path, &square(10.0), Remainder::Outside, 2.0);
        assert!(good.depth_mm.abs() < 1e-12, "{good:?}");
        let bad = gouge(path, &square(10.0), Remainder::Outside, 2.5);
        assert!((bad.depth_mm - 0.5).abs() < 1e-12, "{bad:?}");
    }

    #[test]
    fn nothing_is_cut_above_the_stock() {
        let program = read("G21 G90\nG0 Z5\nG0 X5 Y5\n").unwrap();
        assert_eq!(deepest_cut(&program, &square(10.0), Remainder::Inside, 2.0, 0.0), None);
    }
}
