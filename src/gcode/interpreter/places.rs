//! Where the program's zero is, and motions to places that only the machine knows.

use super::super::rules::Rule;
use super::{Interpreter, MotionMode};
use crate::cam::{MotionKind, Point3};

/// Where a homing motion leaves Z if the program has not moved yet, in millimetres: only pictures see it.
const ASSUMED_HOME: f64 = 25.0;

/// The coordinate system that controllers start in, in tenths: G54.
const FIRST_SYSTEM: u32 = 540;

/// What is known about places.
#[derive(Default)]
pub(super) struct Places {
    /// Where the program's zero lies in the coordinates in which it began, in millimetres.
    origin: [f64; 3],
    /// The origin that G92.2 has put aside and G92.3 takes again.
    aside: [f64; 3],
    /// Whether the program has said where the axis is.
    is_said: [bool; 3],
    /// Whether the axis stands where only the machine knows.
    is_lost: [bool; 3],
    /// The coordinate system, in tenths of its code.
    system: Option<u32>,
}

impl Places {
    pub(super) fn origin(&self) -> [f64; 3] {
        self.origin
    }
}

impl Interpreter<'_> {
    /// Where the axis words of a line lead.
    pub(super) fn target(&self, axes: [Option<f64>; 3]) -> Point3 {
        let scale = self.millimetres();
        let mut to = self.position;
        for (axis, value) in axes.into_iter().enumerate() {
            if let Some(value) = value {
                let is_incremental = self.is_incremental == Some(true);
                to[axis] = value * scale + if is_incremental { self.position[axis] } else { self.places.origin[axis] };
            }
        }
        to
    }

    /// The program says where Z is, perhaps for the first time.
    pub(super) fn take_z(&mut self, axes: [Option<f64>; 3], to: Point3) {
        if axes[2].is_some() && !self.z_is_known {
            // Where the tool was is unknown; that it was already there makes the first move of Z no plunge.
            if self.is_incremental != Some(true) {
                self.position.z = to.z;
            }
            self.z_is_known = true;
        }
    }

    /// A motion is about to be made: notes whether it may cut where nobody knows.
    pub(super) fn note_unknown_way(&mut self, mode: Option<MotionMode>, axes: [Option<f64>; 3], to: Point3) {
        let was_lost = self.places.is_lost;
        for (axis, _) in axes.iter().enumerate().filter(|(_, value)| value.is_some()) {
            self.places.is_said[axis] = true;
            // A step from an unknown place leads to another one.
            self.places.is_lost[axis] &= self.is_incremental == Some(true);
        }
        let is_rapid = matches!(mode, None | Some(MotionMode::Rapid | MotionMode::Cycle(_)));
        let [x, y, mut z] = if is_rapid { self.places.is_lost } else { was_lost };
        // Straight down from home, which is above, it is the end that counts.
        if axes[0].is_none() && axes[1].is_none() {
            z = self.places.is_lost[2];
        }
        if z && (!is_rapid || axes[2].is_some()) {
            self.out.unknown_ways.push((self.line, f64::NEG_INFINITY));
        } else if x || y {
            self.out.unknown_ways.push((self.line, self.position.z.min(to.z)));
        }
    }

    /// G54 to G59.3. Where the systems lie only the machine knows; the one in which the program begins is its own.
    pub(super) fn choose_system(&mut self, tenths: u32) {
        if !self.out.program.motions.is_empty() && self.places.system.unwrap_or(FIRST_SYSTEM) != tenths {
            self.find_once(Rule::ShiftedOrigin, &format!("G{}", f64::from(tenths) / 10.0));
        }
        self.places.system = Some(tenths);
    }

    /// G52 and G92 to G92.3.
    pub(super) fn set_origin(&mut self, tenths: u32, axes: [Option<f64>; 3]) {
        let scale = self.millimetres();
        let mut is_of_unknown_place = false;
        let places = &mut self.places;
        match tenths {
            520 | 920 => {
                for (axis, value) in axes.into_iter().enumerate() {
                    let Some(value) = value.map(|v| v * scale) else { continue };
                    let is_said = places.is_said[axis] && (axis != 2 || self.z_is_known);
                    if tenths == 520 {
                        places.origin[axis] = value;
                    } else if is_said {
                        is_of_unknown_place |= places.is_lost[axis];
                        places.origin[axis] = self.position[axis] - value;
                    } else {
                        // Wherever the tool stands, the program calls it so, and has cut nothing before.
                        self.position[axis] = value;
                        places.is_said[axis] = true;
                        places.is_lost[axis] = false;
                    }
                }
            }
            921 => (places.origin, places.aside) = ([0.0; 3], [0.0; 3]),
            922 => places.aside = std::mem::take(&mut places.origin),
            _ => places.origin = places.aside,
        }
        if is_of_unknown_place {
            self.find_once(Rule::ShiftedOrigin, "G92 at a place that only the machine knows");
        }
    }

    /// G28, G30 and G53: the machine knows the place, the program does not. Z goes up, which is where machines have their
    /// home. G28 and G30 go through the place that the line names.
    pub(super) fn home(&mut self, tenths: u32, axes: [Option<f64>; 3]) {
        self.find_once(Rule::Homing, "");
        let has_axes = axes.iter().any(Option::is_some);
        let is_in_machine_coordinates = tenths == 530;
        let goes = axes.map(|value| value.is_some() || (!has_axes && !is_in_machine_coordinates));
        if !is_in_machine_coordinates && has_axes {
            let to = self.target(axes);
            self.take_z(axes, to);
            if to != self.position {
                self.note_unknown_way(Some(MotionMode::Rapid), axes, to);
                self.push(to, MotionKind::Rapid);
            }
        }
        let is_at_a_feed = is_in_machine_coordinates && !matches!(self.motion, None | Some(MotionMode::Rapid));
        if has_axes && is_at_a_feed {
            self.out.unknown_ways.push((self.line, f64::NEG_INFINITY));
        } else if (goes[0] || goes[1]) && self.z_is_known {
            self.out.unknown_ways.push((self.line, self.position.z));
        }
        for (lost, goes) in self.places.is_lost.iter_mut().zip(goes) {
            *lost |= goes;
        }
        if goes[2] {
            let z = if self.highest.is_finite() { self.highest } else { ASSUMED_HOME };
            self.push(Point3::new(self.position.x, self.position.y, z), MotionKind::Rapid);
            self.z_is_known = true;
        }
    }
}
