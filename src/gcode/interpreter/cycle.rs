//! The cycles of drilling: G81, G82, G83 and G73, as in RS274/NGC 3.5.16 and the manual of LinuxCNC.

use super::super::block::Block;
use super::super::rules::Rule;
use super::{Interpreter, MotionMode, XY};
use crate::cam::{MotionKind, Point3};

/// How one hole is drilled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cycle {
    /// G81: down and out.
    Drill,
    /// G82: with a wait at the bottom.
    Dwell,
    /// G83: out after every peck.
    Peck,
    /// G73: back a little after every peck.
    BreakChip,
}

impl Cycle {
    /// The cycle of a code in tenths.
    pub(super) fn of(tenths: u32) -> Option<Cycle> {
        Some(match tenths {
            730 => Cycle::BreakChip,
            810 => Cycle::Drill,
            820 => Cycle::Dwell,
            830 => Cycle::Peck,
            _ => return None,
        })
    }
}

/// The words of a cycle, in millimetres and as they stand in the program: they hold for the holes that follow.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CycleWords {
    z: Option<f64>,
    r: Option<f64>,
    q: Option<f64>,
    p: Option<f64>,
    /// Height before the first hole.
    start: Option<f64>,
    /// G99.
    pub(super) returns_to_r: bool,
}

/// How far above the bottom a drill that comes back slows down, and how far G73 goes back, in millimetres: 0.01 inch, as in
/// LinuxCNC.
const PECK_CLEARANCE: f64 = 0.254;

/// Most pecks of a hole, and most holes of a line: more is a slip of the pen, and would fill the memory.
const MOST_REPEATS: f64 = 10_000.0;

impl Interpreter<'_> {
    /// G0 to G3 and G80 end a cycle, and another cycle forgets the words of the one before.
    pub(super) fn set_motion(&mut self, mode: Option<MotionMode>) {
        if self.motion != mode {
            let CycleWords { start, returns_to_r, .. } = self.cycle;
            let start = start.filter(|_| matches!(mode, Some(MotionMode::Cycle(_))));
            self.cycle = CycleWords { start, returns_to_r, ..CycleWords::default() };
        }
        self.motion = mode;
    }

    /// The holes of one line.
    pub(super) fn drill(&mut self, cycle: Cycle, block: &Block, axes: [Option<f64>; 3]) {
        let scale = self.millimetres();
        let is_incremental = self.is_incremental == Some(true);
        for (letter, word) in [('R', &mut self.cycle.r), ('Z', &mut self.cycle.z), ('Q', &mut self.cycle.q)] {
            *word = block.value(letter).map(|v| v * scale).or(*word);
        }
        self.cycle.p = block.value('P').or(self.cycle.p);
        let repeats = block.value('L').unwrap_or(1.0);
        let pecks = matches!(cycle, Cycle::Peck | Cycle::BreakChip);
        let (Some(z), Some(r)) = (self.cycle.z, self.cycle.r) else {
            return self.find(Rule::NotFollowed, "a drilling cycle without Z or R");
        };
        if !self.z_is_known {
            self.find_once(Rule::TravelBeforeLift, "");
        }
        // Steps count from the present height, and the depth from R.
        let origin = self.places.origin()[2];
        let (r, bottom) =
            if is_incremental { (self.position.z + r, self.position.z + r + z) } else { (origin + r, origin + z) };
        let q = if pecks { self.cycle.q.unwrap_or(0.0) } else { f64::INFINITY };
        let refused = match () {
            () if self.plane.unwrap_or(XY) != XY => Some("a drilling cycle outside of the XY plane"),
            () if bottom > r => Some("a drilling cycle with R below Z"),
            () if q <= 0.0 => Some("a drilling cycle without Q above zero"),
            () if pecks && (r - bottom) / q > MOST_REPEATS => Some("a drilling cycle of too many pecks"),
            () if block.value('K').is_some() => Some("a drilling cycle with K"),
            () if !(1.0..=MOST_REPEATS).contains(&repeats) || repeats.fract() != 0.0 => {
                Some("a drilling cycle with this L")
            }
            () => None,
        };
        if let Some(what) = refused {
            return self.find(Rule::NotFollowed, what);
        }
        if !self.z_is_known {
            (self.position.z, self.z_is_known) = (r, true);
        }
        let start = *self.cycle.start.get_or_insert(self.position.z);
        let home = if self.cycle.returns_to_r { r } else { start.max(r) };
        // Casts of a whole number within the bounds above.
        for _ in 0..repeats as usize {
            if self.position.z < r {
                self.push_z(r, None);
            }
            let to = self.target([axes[0], axes[1], None]);
            self.note_unknown_way(self.motion, axes, Point3::new(to.x, to.y, bottom));
            if to != self.position {
                self.push(to, MotionKind::Rapid);
            }
            self.drill_here(cycle, [r, bottom, q], block);
            self.push_z(home, None);
        }
    }

    /// One hole at the present place.
    fn drill_here(&mut self, cycle: Cycle, [r, bottom, q]: [f64; 3], block: &Block) {
        let feed = self.feed_for(r - bottom, block);
        self.push_z(r, None);
        let mut end = r;
        loop {
            end = (end - q).max(bottom);
            self.push_z(end, Some(feed));
            if end <= bottom {
                break;
            }
            if cycle == Cycle::Peck {
                self.push_z(r, None);
            }
            self.push_z((end + PECK_CLEARANCE).min(r), None);
        }
        if cycle == Cycle::Dwell {
            let per_second = self.dialect().dwell_units.get(&'P').map_or(1.0, |unit| unit.per_second());
            let seconds = self.cycle.p.unwrap_or(0.0).max(0.0) / per_second;
            self.push(self.position, MotionKind::Dwell { seconds });
        }
    }

    fn push_z(&mut self, z: f64, feed: Option<f64>) {
        if z != self.position.z {
            let kind = feed.map_or(MotionKind::Rapid, |feed| MotionKind::Feed { feed });
            self.push(Point3::new(self.position.x, self.position.y, z), kind);
        }
    }
}
