//! G2 and G3.

use super::super::Finding;
use super::super::arc_words::{ArcForm, solve_arc};
use super::super::block::Block;
use super::super::rules::Rule;
use super::{Interpreter, XY};
use crate::cam::{MotionKind, Point3, ProgramUnit};
use crate::plane::{Point, Turn};

/// Chord error of arcs outside of the XY plane, which are read as lines, in millimetres; far below what machines show.
const OTHER_PLANE_TOLERANCE: f64 = 1e-4;

impl Interpreter<'_> {
    /// An arc to `to`; outside of the XY plane it becomes lines.
    pub(super) fn move_arc(&mut self, block: &Block, turn: Turn, axes: [Option<f64>; 3], to: Point3) {
        let plane = self.plane.unwrap_or(XY);
        let scale = self.millimetres();
        let origin = if self.arc_centers_are_absolute { self.places.origin() } else { [0.0; 3] };
        let offsets = [('I', 0), ('J', 1), ('K', 2)].map(|(l, axis)| block.value(l).map(|v| origin[axis] + v * scale));
        let form = ArcForm {
            from: self.position,
            to,
            plane,
            turn,
            offsets,
            offsets_are_absolute: self.arc_centers_are_absolute,
            radius: block.value('R').map(|v| v * scale),
            has_end: axes[plane[0]].is_some() || axes[plane[1]].is_some(),
            is_inch: self.unit == Some(ProgramUnit::Inch),
            mismatch: self.dialect().arc_mismatch,
            radius_slack: self.dialect().radius_slack,
        };
        let is_helix = axes[plane[2]].is_some() && to[plane[2]] != self.position[plane[2]];
        if !self.dialect().arcs || (is_helix && !self.dialect().helical_arcs) {
            self.find(Rule::NoArcs, "");
        }
        let line = self.line;
        let solved = solve_arc(&form, |rule, detail| self.out.findings.push(Finding::new(line, rule, detail)));
        let Some(arc) = solved else { return };
        if block.value('P').is_some_and(|turns| turns != 1.0) {
            self.find(Rule::NotFollowed, "an arc of several turns");
        }
        let feed = self.feed_for(arc.length(), block);
        if plane == XY {
            let center = Point::new(arc.center[0], arc.center[1]);
            self.push(arc.to, MotionKind::Arc { center, turn, feed });
            return;
        }
        self.find_once(Rule::ArcOtherPlane, "");
        for p in arc.points(OTHER_PLANE_TOLERANCE) {
            self.push(p, MotionKind::Feed { feed });
        }
    }
}
