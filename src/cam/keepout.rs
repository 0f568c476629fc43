//! Boxes that no tool may enter: clamps, screws, the vise.

use std::str::FromStr;

use super::motion::{Motion, MotionKind, Point3};
use crate::plane::{Bounds, Point, Segment};
use crate::units::{DrawingScale, Length};

/// A box that no tool may enter, in millimetres and in the program's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keepout {
    /// Its outline seen from above.
    pub outline: Bounds,
    /// z of its upper face; infinite where no height clears it.
    pub top: f64,
}

/// Tools nearer than this to a keepout, in millimetres, touch it without entering.
const TOUCH: f64 = 1e-6;

/// Why a text is no keepout.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "\"{text}\" is no box to keep out of: write two corners as x0,y0,x1,y1, and the z of its top behind them if it can be \
     passed over, for example 0,0,20mm,15mm,12mm"
)]
pub struct ParseKeepoutError {
    text: String,
}

impl Keepout {
    /// How far a tool of `radius` gets into the box on its way along `motion`, in millimetres, and where its tip is then; `None`
    /// where it stays out. A tool whose axis is in the box is in it by its radius and more; the radius is told.
    pub fn entered_by(&self, motion: &Motion, radius: f64) -> Option<(f64, Point3)> {
        if motion.from == motion.to && motion.trace().next().is_none() {
            return None;
        }
        let elements = below(motion, self.top);
        let mut deepest: Option<(f64, Point3)> = None;
        for (element, z) in elements {
            let (distance, at) = self.distance(&element);
            let depth = radius - distance;
            if depth > TOUCH && deepest.is_none_or(|(known, _)| depth > known) {
                deepest = Some((depth, Point3::new(at.x, at.y, z)));
            }
        }
        deepest
    }

    /// The least distance of an element from the outline, 0 where it gets inside, and the place on the element.
    fn distance(&self, element: &Segment) -> (f64, Point) {
        if self.outline.contains(element.start) {
            return (0.0, element.start);
        }
        let Bounds { min, max } = self.outline;
        let corners = [min, Point::new(max.x, min.y), max, Point::new(min.x, max.y)];
        let sides = (0..4).map(|k| Segment::line(corners[k], corners[(k + 1) % 4]));
        let nearest = sides.map(|side| element.approach(&side)).min_by(|a, b| a.distance.total_cmp(&b.distance));
        nearest.map_or((f64::INFINITY, element.start), |a| (a.distance, a.on_first))
    }
}

/// The parts of a motion that lie below `top` in the plane, each with the lowest height on it.
fn below(motion: &Motion, top: f64) -> Vec<(Segment, f64)> {
    let (from, to) = (motion.from.z, motion.to.z);
    if from.min(to) >= top || matches!(motion.kind, MotionKind::Dwell { .. }) {
        return Vec::new();
    }
    let lowest = from.min(to);
    if motion.trace().next().is_none() {
        return vec![(Segment::line(motion.to.xy(), motion.to.xy()), lowest)];
    }
    motion.trace_below(top).into_iter().map(|part| (part, lowest)).collect()
}

/// A typed keepout.
impl FromStr for Keepout {
    type Err = ParseKeepoutError;

    fn from_str(text: &str) -> Result<Keepout, ParseKeepoutError> {
        let error = || ParseKeepoutError { text: text.to_owned() };
        let no_drawing = DrawingScale { mm_per_unit: None, diagonal: 0.0 };
        let length = |part: &str| part.parse::<Length>().ok()?.to_millimetres(&no_drawing).ok();
        let numbers: Vec<f64> = text.split(',').map(length).collect::<Option<_>>().ok_or_else(error)?;
        let (corners, top) = match *numbers.as_slice() {
            [a, b, c, d] => ([a, b, c, d], f64::INFINITY),
            [a, b, c, d, top] => ([a, b, c, d], top),
            _ => return Err(error()),
        };
        let outline = Bounds::of_points([Point::new(corners[0], corners[1]), Point::new(corners[2], corners[3])]);
        Ok(Keepout { outline, top })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::read;

    fn entered(keepout: &str, path: &str, radius: f64) -> Option<f64> {
        let keepout: Keepout = keepout.parse().unwrap();
        let program = read(&format!("G21 G90 G17 G94 F100\nG0 Z20\nG0 X-50 Y0\n{path}")).unwrap();
        let depths = program.motions.iter().filter_map(|m| keepout.entered_by(m, radius)).map(|(depth, _)| depth);
        depths.reduce(f64::max)
    }

    #[test]
    fn the_tool_keeps_its_radius_from_a_box_or_enters_it() {
        let level = "G0 Z5\nG0 Y-8\nG1 X50";
        assert_eq!(entered("-10,-5,10,5,12", level, 3.0), None);
        assert_eq!(entered("-10,-5,10,5,12", level, 2.0), None);
        assert!((entered("-10,-5,10,5,12", level, 4.5).unwrap() - 1.5).abs() < 1e-12);
        // Its middle goes through.
        assert_eq!(entered("10,5,-10,-5,12", "G0 Z5\nG1 X50", 3.0), Some(3.0));
        // Above it, and on it.
        assert_eq!(entered("-10,-5,10,5,12", "G0 Z12\nG1 X50", 3.0), None);
        assert_eq!(entered("-10,-5,10,5", "G1 X50", 3.0), Some(3.0), "no height clears a box without one");
    }

    #[test]
    fn only_the_part_of_a_slope_that_is_low_counts() {
        // Falls from 20 at -50 to 0 at 50; below 10 from 0 on.
        assert_eq!(entered("-30,-5,-4,5,10", "G1 X50 Z0", 3.0), None);
        assert!((entered("-30,-5,-2,5,10", "G1 X50 Z0", 3.0).unwrap() - 1.0).abs() < 1e-9);
        assert!(entered("-30,-5,-4,5,10", "G0 Z0\nG1 X50 Z20", 3.0).is_some());
    }

    #[test]
    fn arcs_and_plunges_enter_too() {
        assert!((entered("-5,20,5,40,0", "G0 X20 Y0\nG1 Z-1\nG3 X-20 Y0 I-20 J0", 3.0).unwrap() - 3.0).abs() < 1e-9);
        assert_eq!(entered("-5,24,5,40,0", "G0 X20 Y0\nG1 Z-1\nG3 X-20 Y0 I-20 J0", 3.0), None);
        assert_eq!(entered("-5,-5,5,5,0", "G0 X7 Y0\nG1 Z-1", 3.0), Some(1.0));
    }

    #[test]
    fn what_is_no_box_is_refused() {
        for text in ["", "1,2,3", "1,2,3,4,5,6", "1,2,3,x", "1,2,3,4u"] {
            assert!(text.parse::<Keepout>().is_err(), "{text}");
        }
        assert_eq!("1in,0,0,0".parse::<Keepout>().unwrap().outline.max.x, 25.4);
    }
}
