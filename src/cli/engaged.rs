//! Programs of beams and pens, which have no depth: what their text says of power and pen, as heights that can be held against a job.

use crate::cam::{Motion, Program};
use crate::gcode::{Dialect, MachineKind};

/// Places nearer than this, in millimetres, are one: the last decimals of a program.
const SAME_PLACE: f64 = 1e-3;

/// The program with `up` as the height of motions in which nothing is cut and `down` as that of the others. A program with depths of
/// its own, and one of a pen of which the text does not tell whether it is down, stay as they are.
pub(super) fn with_heights(mut program: Program, dialect: &Dialect, up: f64, down: f64) -> Program {
    if dialect.has_depth() {
        return program;
    }
    let Some(engagement) = Engagement::of(dialect) else { return program };
    for motion in &mut program.motions {
        let z = |z: f64| if engagement.is_in(motion, z) { down } else { up };
        let (from, to) = (z(motion.from.z), z(motion.to.z));
        // A pen that is set down draws nothing yet.
        let from = if (motion.to - motion.from).xy().norm() > SAME_PLACE { from } else { to };
        (motion.from.z, motion.to.z) = (from, to);
    }
    program
}

/// How a program tells whether beam or pen are at work.
#[derive(Clone, Copy)]
enum Engagement {
    /// Power, at a feed: a rapid is dark in laser mode, and without it a finding of its own.
    Power,
    /// Z below this height.
    Below(f64),
    /// A servo on the pin of the spindle's speed.
    Servo { up: f64, down: f64 },
}

impl Engagement {
    /// What `dialect` does; `None` where its lines do not tell.
    fn of(dialect: &Dialect) -> Option<Engagement> {
        Some(match (dialect.machine, dialect.pen_up_z, dialect.pen_down_z) {
            (MachineKind::Laser, ..) => Engagement::Power,
            (MachineKind::Pen, Some(up), Some(down)) => Engagement::Below(0.5 * (up + down)),
            (MachineKind::Pen, ..) => {
                Engagement::Servo { up: speed(&dialect.pen_up)?, down: speed(&dialect.pen_down)? }
            }
            (MachineKind::Router, ..) => return None,
        })
    }

    /// Whether beam or pen are at work at the end of `motion` that has the height `z`.
    fn is_in(self, motion: &Motion, z: f64) -> bool {
        match self {
            Engagement::Power => motion.spindle_on && motion.spindle_speed > 0.0 && motion.is_feed(),
            Engagement::Below(height) => z < height,
            Engagement::Servo { up, down } => (motion.spindle_speed - down).abs() < (motion.spindle_speed - up).abs(),
        }
    }
}

/// The last S of these lines.
fn speed(lines: &[String]) -> Option<f64> {
    lines
        .iter()
        .flat_map(|line| line.split_whitespace())
        .filter_map(|word| word.strip_prefix('S')?.parse().ok())
        .next_back()
}

/// How often the program goes everywhere that it goes at all with beam or pen at work: its passes.
pub(super) fn laps(program: &Program, top: f64) -> usize {
    let cuts: Vec<&Motion> = program.motions.iter().filter(|m| m.is_feed() && m.is_in_stock(top)).collect();
    let cuts: Vec<&Motion> = cuts.into_iter().filter(|m| (m.to - m.from).xy().norm() > SAME_PLACE).collect();
    let key = |m: &Motion| [m.from.x, m.from.y, m.to.x, m.to.y].map(|v| (v / SAME_PLACE).round() as i64);
    let mut counts = std::collections::BTreeMap::<[i64; 4], usize>::new();
    for motion in cuts {
        *counts.entry(key(motion)).or_default() += 1;
    }
    counts.into_values().min().unwrap_or(0)
}
