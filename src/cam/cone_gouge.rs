//! How far a cone cuts beyond the outline that it carves.

use super::gouge::Gouge;
use super::motion::{Motion, Point3, Program};
use super::{Tool, ToolShape};
use crate::plane::{BoundaryIndex, Point, Region};

/// The deepest place is searched for to this, in millimetres.
const SEARCH_TOLERANCE: f64 = 1e-4;

/// Most evaluations along one motion.
const MOST_EVALUATIONS: usize = 4000;

/// How far the circle that the cone cuts into the top of the stock reaches out of `region` at worst; negative where it
/// stays inside. `None` for other tools, and where nothing is cut.
///
/// Along a motion the reach changes by no more than the way in the plane and what the cone widens on the way down: an
/// interval whose ends are low cannot hide a high middle.
pub fn deepest_carving(program: &Program, region: &Region, tool: &Tool, stock_top: f64) -> Option<Gouge> {
    let ToolShape::Cone { angle, .. } = tool.shape else { return None };
    let slope = (0.5 * angle).tan();
    let index = BoundaryIndex::new(region);
    let reach = |p: Point3| {
        let at = Point::new(p.x, p.y);
        let distance = index.distance(at);
        let clearance = if index.winding_number(at) > 0 { distance } else { -distance };
        tool.radius_at(stock_top - p.z) - clearance
    };
    let mut deepest: Option<Gouge> = None;
    for motion in program.motions.iter().filter(|m| m.is_in_stock(stock_top)) {
        let known = deepest.map_or(f64::NEG_INFINITY, |d| d.depth_mm);
        let (depth, at) = along(motion, &reach, slope, stock_top, known);
        if depth > known {
            deepest = Some(Gouge { depth_mm: depth, x_mm: at.x, y_mm: at.y, line: motion.line });
        }
    }
    deepest
}

/// The highest reach along a motion and its place; what is not above `known` is not searched for.
fn along(motion: &Motion, reach: &impl Fn(Point3) -> f64, slope: f64, top: f64, known: f64) -> (f64, Point3) {
    let mut best = (f64::NEG_INFINITY, motion.to);
    let mut evaluations = 0;
    let elements: Vec<_> = motion.trace().collect();
    let count = elements.len().max(1);
    let fall = motion.to.z - motion.from.z;
    for k in 0..count {
        let length = elements.get(k).map_or(0.0, |s| s.length());
        let place = |t: f64| {
            let flat = elements.get(k).map_or(motion.to.xy(), |s| s.point_at(t));
            Point3::new(flat.x, flat.y, motion.from.z + fall * ((k as f64 + t) / count as f64))
        };
        // Above the stock nothing is cut.
        let at = |t: f64| {
            let p = place(t);
            (t, if p.z < top { reach(p) } else { f64::NEG_INFINITY })
        };
        let change = length + slope * fall.abs() / count as f64;
        let (first, last) = (at(0.0), at(1.0));
        let mut open = vec![(first, last)];
        let mut consider = |(t, value): (f64, f64)| {
            if value > best.0 {
                best = (value, place(t));
            }
        };
        consider(first);
        consider(last);
        while let Some((a, b)) = open.pop() {
            let bound = if a.1.is_finite() && b.1.is_finite() {
                0.5 * (a.1 + b.1 + (b.0 - a.0) * change)
            } else {
                a.1.max(b.1) + (b.0 - a.0) * change
            };
            let target = best.0.max(known) + SEARCH_TOLERANCE;
            if bound <= target || evaluations >= MOST_EVALUATIONS {
                continue;
            }
            evaluations += 1;
            let middle = at(0.5 * (a.0 + b.0));
            if middle.1 > best.0 {
                best = (middle.1, place(middle.0));
            }
            open.extend([(a, middle), (middle, b)]);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::read;
    use crate::plane::Ring;

    fn carve(path: &str) -> Option<Gouge> {
        let p = Point::new;
        let slot = Region::new(vec![Ring::polygon([p(0.0, 0.0), p(40.0, 0.0), p(40.0, 4.0), p(0.0, 4.0)])]);
        let shape = ToolShape::Cone { angle: std::f64::consts::FRAC_PI_2, tip_diameter: 0.0 };
        let tool = Tool { shape, ..Tool::flat(1, 10.0) };
        let program = read(&format!("G21 G90 G17 G94\nG0 Z5\nM3 S1000\nG4 P1\n{path}\nG0 Z5\nM5\nM2\n")).unwrap();
        deepest_carving(&program, &slot, &tool, 0.0)
    }

    #[test]
    fn a_cone_as_deep_as_the_slot_is_wide_touches_its_edges() {
        let touch = carve("G0 X2 Y2\nG1 Z-2 F100\nG1 X38 F500").unwrap();
        assert!(touch.depth_mm.abs() < 1e-3, "{touch:?}");
    }

    #[test]
    fn a_cone_too_deep_or_off_the_middle_reaches_out_by_as_much() {
        let deep = carve("G0 X3 Y2\nG1 Z-2 F100\nG1 X20 Z-2.5 F500\nG1 X37 Z-2").unwrap();
        assert!((deep.depth_mm - 0.5).abs() < 1e-3 && (deep.x_mm - 20.0).abs() < 1e-2, "{deep:?}");
        let aside = carve("G0 X4 Y2.3\nG1 Z-2 F100\nG1 X36 F500").unwrap();
        assert!((aside.depth_mm - 0.3).abs() < 1e-3, "{aside:?}");
        assert!(carve("G0 X4 Y2").is_none());
    }
}
