//! How deep a tool goes into material that nothing has cut before.

use std::collections::HashMap;

use clopen::cam::Program;
use clopen::plane::{Point, Segment};

/// A place that was cut: where, how deep, and after which way.
type Cut = (Point, f64, f64);

/// The deepest step of a program, and its line: how far a feed goes below what earlier motions have cut within `reach` of
/// it, or below `top`. What was cut on the same way just before does not count, so that a ramp's own fall is let through by
/// [`OWN_FALL`].
pub fn deepest_step(program: &Program, top: f64, reach: f64) -> (f64, usize) {
    let key = |p: Point| ((p.x / reach).floor() as i64, (p.y / reach).floor() as i64);
    let mut cut: HashMap<(i64, i64), Vec<Cut>> = HashMap::new();
    let mut way = 0.0;
    let mut deepest = (f64::NEG_INFINITY, 0);
    for motion in program.motions.iter().filter(|m| m.is_feed() && m.from.z.min(m.to.z) < top) {
        let at = motion.to.xy();
        let plunge = motion.trace().next().is_none().then_some(Segment::line(at, at));
        let pieces: Vec<Segment> = motion.trace().chain(plunge).collect();
        let whole: f64 = pieces.iter().map(Segment::length).sum();
        let mut gone = 0.0;
        for piece in pieces {
            let count = (piece.length() / (0.5 * reach)).ceil().max(1.0) as usize;
            for k in 1..=count {
                let share = k as f64 / count as f64;
                let p = if piece.length() > 0.0 { piece.point_at(share) } else { at };
                let along = gone + share * piece.length();
                let z = if whole > 0.0 {
                    motion.from.z + (motion.to.z - motion.from.z) * (along / whole)
                } else {
                    motion.to.z
                };
                let here = way + along;
                let (x, y) = key(p);
                let near = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| (x, y)));
                let earlier = near.filter_map(|cell| cut.get(&cell)).flatten();
                let before = earlier
                    .filter(|(q, _, then)| (p - q).norm() <= reach && here - then > OWN_WAY * reach)
                    .map(|(_, z, _)| *z)
                    .fold(top, f64::min);
                if before - z > deepest.0 {
                    deepest = (before - z, motion.line);
                }
                cut.entry(key(p)).or_default().push((p, z, here));
            }
            gone += piece.length();
        }
        way += whole + f64::EPSILON;
    }
    deepest
}

/// Ways shorter than this, in reaches, are the same cut going on.
const OWN_WAY: f64 = 3.0;

/// The most that a ramp falls over such a way, in reaches.
pub const OWN_FALL: f64 = 0.1 * OWN_WAY;
