//! What goes wrong while a program runs.

use super::motion::{Motion, Point3};

/// What went wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum EventKind {
    /// A rapid meets material that still stands; the amount is how deep its cutter is in it, in millimetres.
    RapidThroughStock,
    /// A tool enters a keepout; the amount is how far, in millimetres.
    Collision {
        /// Which one, counted from 1 as they were given.
        keepout: usize,
    },
    /// A tool goes below the stock by more than what was allowed; the amount is how far it is below, in millimetres.
    Overrun,
    /// A drill moves sideways in material; the amount is how far, in millimetres.
    DrillSideways,
    /// Material is cut while the spindle stands still; the amount is how much, in cubic millimetres.
    SpindleOff,
}

impl EventKind {
    /// What happened, in words.
    pub fn words(&self) -> String {
        match self {
            EventKind::RapidThroughStock => "rapid through stock".to_owned(),
            EventKind::Collision { keepout } => format!("collision with keepout {keepout}"),
            EventKind::Overrun => "below the stock".to_owned(),
            EventKind::DrillSideways => "drill moves sideways".to_owned(),
            EventKind::SpindleOff => "cuts with the spindle off".to_owned(),
        }
    }

    /// The unit of its amount.
    pub fn unit(&self) -> &'static str {
        match self {
            EventKind::SpindleOff => "mm3",
            _ => "mm",
        }
    }
}

/// Something that went wrong, on one motion or on several in a row.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Event {
    /// What.
    #[serde(flatten)]
    pub kind: EventKind,
    /// The line of the first motion.
    pub line: usize,
    /// The line of the last motion.
    pub last_line: usize,
    /// How bad it is at worst: millimetres, of [`EventKind::SpindleOff`] cubic millimetres.
    pub amount: f64,
    /// The line where it is worst.
    pub worst_line: usize,
    /// Where it is worst.
    pub x_mm: f64,
    /// Where it is worst.
    pub y_mm: f64,
    /// Where it is worst.
    pub z_mm: f64,
    /// The tool.
    pub tool: u32,
}

/// Events as they are found; what goes on over motions that follow each other is one.
#[derive(Debug, Default)]
pub(super) struct Events {
    events: Vec<Event>,
    /// Indices of those that the motion before and the present one had.
    before: Vec<usize>,
    now: Vec<usize>,
}

impl Events {
    pub(super) fn next_motion(&mut self) {
        self.before = std::mem::take(&mut self.now);
    }

    pub(super) fn find(&mut self, kind: EventKind, motion: &Motion, amount: f64, at: Point3) {
        let events = &mut self.events;
        let same = |&index: &usize| events[index].kind == kind && events[index].tool == motion.tool;
        let going_on = self.before.iter().copied().find(same);
        let index = going_on.unwrap_or(events.len());
        self.now.push(index);
        let (line, tool) = (motion.line, motion.tool);
        let new =
            Event { kind, line, last_line: line, amount, worst_line: line, x_mm: at.x, y_mm: at.y, z_mm: at.z, tool };
        match events.get_mut(index) {
            None => events.push(new),
            Some(event) if amount > event.amount => *event = Event { line: event.line, ..new },
            Some(event) => event.last_line = line,
        }
    }

    pub(super) fn into_vec(self) -> Vec<Event> {
        self.events
    }
}
