//! From the words of G2 and G3 to a circle, and what is wrong with them.

use super::dialect::ArcMismatch;
use super::interpreter::PlaneAxes;
use super::rules::Rule;
use crate::cam::Point3;
use crate::plane::{Arc, Point, Turn};

/// Controllers refuse above so many times their fine limit, whatever the radius; measured on GRBL and LinuxCNC.
const COARSE_FACTOR: f64 = 100.0;
/// What a centre that is solved again after rounding reaches, in millimetres.
const GOOD_MISMATCH: f64 = 0.002;
/// Rounding of a text in inches with four decimals adds this much, in millimetres.
const GOOD_MISMATCH_INCH: f64 = 0.004;
/// GRBL reads an arc of an angle up to this, in radians, as a full circle.
const FULL_CIRCLE_ANGLE: f64 = 5e-7;

/// The words of an arc, in millimetres.
pub(super) struct ArcForm {
    pub(super) from: Point3,
    pub(super) to: Point3,
    pub(super) plane: PlaneAxes,
    pub(super) turn: Turn,
    pub(super) offsets: [Option<f64>; 3],
    pub(super) offsets_are_absolute: bool,
    pub(super) radius: Option<f64>,
    pub(super) has_end: bool,
    pub(super) is_inch: bool,
    /// Which arcs the controller refuses; `None` for one that takes all.
    pub(super) mismatch: Option<ArcMismatch>,
    /// How much shorter than half the chord R may be; `None` for a controller that takes all.
    pub(super) radius_slack: Option<f64>,
}

/// An arc in space.
pub(super) struct SolvedArc {
    from: Point3,
    /// Where it ends.
    pub(super) to: Point3,
    /// Centre in the two axes of the plane.
    pub(super) center: [f64; 2],
    plane: PlaneAxes,
    turn: Turn,
}

/// The circle of an arc; `None` where it has none. Everything wrong goes to `find`.
pub(super) fn solve_arc(form: &ArcForm, mut find: impl FnMut(Rule, String)) -> Option<SolvedArc> {
    let [a, b, across] = form.plane;
    let start = Point::new(form.from[a], form.from[b]);
    let end = Point::new(form.to[a], form.to[b]);
    if !form.has_end {
        find(Rule::ArcWithoutEnd, String::new());
    }
    let center = match form.radius {
        Some(radius) => center_of_radius(form, start, end, radius, &mut find)?,
        None => {
            if form.offsets[a].is_none() && form.offsets[b].is_none() {
                find(Rule::ArcWithoutCenter, String::new());
                return None;
            }
            if form.offsets[across].is_some() {
                find(Rule::ArcWrongPlane, ["I", "J", "K"][across].to_owned());
            }
            let place = |axis: usize, from: f64| match (form.offsets[axis], form.offsets_are_absolute) {
                (Some(value), true) => value,
                (value, _) => from + value.unwrap_or(0.0),
            };
            let center = Point::new(place(a, start.x), place(b, start.y));
            check_mismatch(form, start, end, center, &mut find);
            center
        }
    };
    let mut solved =
        SolvedArc { from: form.from, to: form.to, center: [center.x, center.y], plane: form.plane, turn: form.turn };
    let arc = Arc { center, radius: (start - center).norm(), turn: form.turn };
    if arc.radius == 0.0 || !arc.radius.is_finite() {
        find(Rule::ArcWithoutCenter, "its radius is zero".to_owned());
        return None;
    }
    if arc.angle_between(start, end) <= FULL_CIRCLE_ANGLE {
        (solved.to[a], solved.to[b]) = (start.x, start.y);
    }
    Some(solved)
}

fn check_mismatch(form: &ArcForm, start: Point, end: Point, center: Point, find: &mut impl FnMut(Rule, String)) {
    let (r0, r1) = ((start - center).norm(), (end - center).norm());
    let mismatch = (r0 - r1).abs();
    let text = || format!("radius {r0:.4} mm at the start, {r1:.4} mm at the end");
    if let Some(limit) = form.mismatch {
        let fine = if form.is_inch { limit.inch } else { limit.mm };
        if mismatch > fine * COARSE_FACTOR || (mismatch > fine && mismatch > limit.relative * r0.max(r1)) {
            find(Rule::ArcRadiusMismatch, text());
        }
    }
    let good = if form.is_inch { GOOD_MISMATCH_INCH } else { GOOD_MISMATCH };
    if mismatch > good {
        find(Rule::ArcImprecise, text());
    }
}

/// The centre of an arc given by its radius; a negative radius means the longer way round.
fn center_of_radius(
    form: &ArcForm,
    start: Point,
    end: Point,
    radius: f64,
    find: &mut impl FnMut(Rule, String),
) -> Option<Point> {
    find(Rule::ArcRadiusForm, format!("R {radius:.4} mm"));
    let chord = end - start;
    let length = chord.norm();
    if length == 0.0 {
        find(Rule::ArcRadiusClosed, String::new());
        return None;
    }
    let half = 0.5 * length;
    let short = half - radius.abs();
    if form.radius_slack.is_some_and(|slack| short > slack) {
        find(Rule::ArcRadiusTooSmall, format!("R {:.4} mm, half the chord {half:.4} mm", radius.abs()));
    }
    let height = (radius * radius - half * half).max(0.0).sqrt();
    // The shorter way to the left has its centre on the left.
    let side = form.turn.sign() * radius.signum();
    Some(start + chord * 0.5 + crate::plane::left_normal(chord) * (side * height / length))
}

impl SolvedArc {
    fn sweep(&self) -> f64 {
        let [a, b, _] = self.plane;
        let center = Point::new(self.center[0], self.center[1]);
        let start = Point::new(self.from[a], self.from[b]);
        let end = Point::new(self.to[a], self.to[b]);
        let arc = Arc { center, radius: (start - center).norm(), turn: self.turn };
        let angle = arc.angle_between(start, end);
        if angle <= FULL_CIRCLE_ANGLE { std::f64::consts::TAU } else { angle }
    }

    fn radius(&self) -> f64 {
        let [a, b, _] = self.plane;
        (self.from[a] - self.center[0]).hypot(self.from[b] - self.center[1])
    }

    /// Length in space, in millimetres.
    pub(super) fn length(&self) -> f64 {
        let across = self.plane[2];
        (self.sweep() * self.radius()).hypot(self.to[across] - self.from[across])
    }

    /// Points after the start up to and including the end, chords within `tolerance`.
    pub(super) fn points(&self, tolerance: f64) -> Vec<Point3> {
        /// An arc of absurd radius must not fill the memory.
        const MOST: f64 = 10_000.0;
        let [a, b, across] = self.plane;
        let (sweep, radius) = (self.sweep(), self.radius());
        let step = if tolerance < radius { 2.0 * (1.0 - tolerance / radius).acos() } else { 1.0 };
        let count = (sweep / step).ceil().clamp(1.0, MOST);
        let center = Point::new(self.center[0], self.center[1]);
        let arc = Arc { center, radius, turn: self.turn };
        let start = Point::new(self.from[a], self.from[b]);
        let mut points: Vec<Point3> = (1..count as usize)
            .map(|k| {
                let t = k as f64 / count;
                let p = arc.travel(start, sweep * t);
                let mut q = Point3::origin();
                (q[a], q[b]) = (p.x, p.y);
                q[across] = self.from[across] + (self.to[across] - self.from[across]) * t;
                q
            })
            .collect();
        points.push(self.to);
        points
    }
}
