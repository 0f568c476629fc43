//! How long a machine takes for a program: the planner of GRBL 1.1, looking ahead over the whole program.
//!
//! Stages: motions become straight moves (arcs as GRBL splits them); every joint gets the speed at which the junction
//! deviation allows its turn; a backward and a forward pass make the speeds reachable; trapezoids give the time. The
//! real planner looks ahead 16 moves only, which matters where they are shorter than the way to stop.

use super::motion::{Motion, MotionKind, Point3, Program};
use crate::plane::{Arc, Point};

type Vector3 = nalgebra::Vector3<f64>;

/// What limits a machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Machine {
    /// Largest acceleration of each axis, mm/s² (GRBL's $120 to $122).
    pub acceleration: [f64; 3],
    /// Largest speed of each axis, mm/min ($110 to $112), which is also the speed of rapids.
    pub rapid: [f64; 3],
    /// How far a corner might be cut at speed, mm ($11): decides the speed in corners.
    pub junction_deviation: f64,
    /// Largest distance between an arc and its chords, mm ($12).
    pub arc_tolerance: f64,
}

impl Default for Machine {
    /// A hobby router as its maker sets it: 500 mm/s², 5 m/min, 0.01 mm, 0.002 mm.
    fn default() -> Machine {
        Machine {
            acceleration: [500.0; 3],
            rapid: [5000.0, 5000.0, 1500.0],
            junction_deviation: 0.01,
            arc_tolerance: 0.002,
        }
    }
}

/// Seconds of a program.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct ProgramTime {
    /// Moving at a feed.
    pub feed_seconds: f64,
    /// Moving at rapid speed.
    pub rapid_seconds: f64,
    /// Waiting.
    pub dwell_seconds: f64,
}

impl ProgramTime {
    /// The sum.
    pub fn total_seconds(&self) -> f64 {
        self.feed_seconds + self.rapid_seconds + self.dwell_seconds
    }

    /// Both, one after the other.
    pub fn and(&self, other: &ProgramTime) -> ProgramTime {
        ProgramTime {
            feed_seconds: self.feed_seconds + other.feed_seconds,
            rapid_seconds: self.rapid_seconds + other.rapid_seconds,
            dwell_seconds: self.dwell_seconds + other.dwell_seconds,
        }
    }
}

/// GRBL's slowest junction speed, mm/min, so that no joint stops the machine ($MINIMUM_JUNCTION_SPEED is 0 by default).
const MIN_JUNCTION_SPEED: f64 = 0.0;

/// Cosine beyond which GRBL takes a joint as straight or as a full reversal.
const STRAIGHT_COSINE: f64 = 0.999_999;

/// An arc is split into no more segments than this: that many are a circle of 100 m, so that absurd ones cost no memory.
const MOST_ARC_SEGMENTS: f64 = 2e4;

/// One straight move of the planner; speeds in mm/s.
struct Move {
    length: f64,
    direction: Vector3,
    nominal: f64,
    acceleration: f64,
    /// Square of the speed at the start of the move, limited by the joint before it, then by the passes.
    entry_squared: f64,
    /// The motion that it is a part of, counted from 0.
    motion: usize,
}

/// The time that `machine` takes for `program`.
pub fn estimate(program: &Program, machine: &Machine) -> ProgramTime {
    let mut time = ProgramTime::default();
    for (motion, seconds) in program.motions.iter().zip(motion_seconds(program, machine)) {
        *(match motion.kind {
            MotionKind::Dwell { .. } => &mut time.dwell_seconds,
            MotionKind::Rapid => &mut time.rapid_seconds,
            MotionKind::Feed { .. } | MotionKind::Arc { .. } => &mut time.feed_seconds,
        }) += seconds;
    }
    time
}

/// The seconds that `machine` takes for each motion of `program`, in order.
pub fn motion_seconds(program: &Program, machine: &Machine) -> Vec<f64> {
    let mut seconds = vec![0.0; program.motions.len()];
    let mut moves: Vec<Move> = Vec::new();
    for (index, motion) in program.motions.iter().enumerate() {
        match motion.kind {
            MotionKind::Dwell { seconds: wait } => {
                // The planner runs empty before a dwell: the machine stops.
                run(&mut moves, &mut seconds);
                seconds[index] = wait;
            }
            _ => split(motion, machine, |to, from| push_move(&mut moves, (index, motion), from, to, machine)),
        }
    }
    run(&mut moves, &mut seconds);
    seconds
}

/// The moves of a motion, in order, as (end, start).
fn split(motion: &Motion, machine: &Machine, mut emit: impl FnMut(Point3, Point3)) {
    let MotionKind::Arc { center, turn, .. } = motion.kind else { return emit(motion.to, motion.from) };
    let start = motion.from.xy();
    let radius = (start - center).norm();
    let angle: f64 = motion.trace().map(|s| s.sweep()).sum();
    let tolerance = machine.arc_tolerance.min(radius);
    let count = (0.5 * angle * radius / (tolerance * (2.0 * radius - tolerance)).sqrt()).floor();
    let count = if count.is_nan() { 0.0 } else { count.min(MOST_ARC_SEGMENTS) };
    let arc = Arc { center, radius, turn };
    let mut from = motion.from;
    for k in 1..count as usize {
        let t = k as f64 / count;
        let p: Point = arc.travel(start, angle * t);
        let to = Point3::new(p.x, p.y, motion.from.z + (motion.to.z - motion.from.z) * t);
        emit(to, from);
        from = to;
    }
    emit(motion.to, from);
}

fn push_move(moves: &mut Vec<Move>, (index, motion): (usize, &Motion), from: Point3, to: Point3, machine: &Machine) {
    let way = to - from;
    let length = way.norm();
    if !(length > 0.0 && length.is_finite()) {
        return;
    }
    let direction = way / length;
    let acceleration = limit_along(direction, machine.acceleration);
    let rapid = limit_along(direction, machine.rapid);
    let feed = motion.feed().map_or(rapid, |f| if f > 0.0 { f.min(rapid) } else { rapid });
    let nominal = feed / 60.0;
    let entry_squared = moves.last().map_or(0.0, |before| {
        let towards = |bisector| limit_along(bisector, machine.acceleration);
        let junction = junction_speed_squared(before, direction, towards, machine.junction_deviation);
        junction.min(nominal * nominal).min(before.nominal * before.nominal)
    });
    moves.push(Move { length, direction, nominal, acceleration, entry_squared, motion: index });
}

/// What limits of the axes leave along `direction`.
fn limit_along(direction: Vector3, limits: [f64; 3]) -> f64 {
    let limit = |axis: usize| if direction[axis] == 0.0 { f64::INFINITY } else { limits[axis] / direction[axis].abs() };
    limit(0).min(limit(1)).min(limit(2))
}

/// v² = a δ s / (1 - s), s = sin(θ/2), where θ is the angle between the way in and the way out, a the acceleration towards
/// the inside of the corner and δ the junction deviation.
fn junction_speed_squared(
    before: &Move,
    direction: Vector3,
    acceleration_towards: impl Fn(Vector3) -> f64,
    deviation: f64,
) -> f64 {
    let cosine = -before.direction.dot(&direction);
    if cosine > STRAIGHT_COSINE {
        return (MIN_JUNCTION_SPEED / 60.0).powi(2);
    }
    if cosine < -STRAIGHT_COSINE {
        return f64::INFINITY;
    }
    let acceleration = acceleration_towards((direction - before.direction).normalize());
    let sine = (0.5 * (1.0 - cosine)).sqrt();
    acceleration * deviation * sine / (1.0 - sine)
}

/// Plans the moves from a stop to a stop, adds their time to that of their motions and forgets them.
fn run(moves: &mut Vec<Move>, seconds: &mut [f64]) {
    let mut exit_squared = 0.0;
    for m in moves.iter_mut().rev() {
        m.entry_squared = m.entry_squared.min(exit_squared + 2.0 * m.acceleration * m.length);
        exit_squared = m.entry_squared;
    }
    for i in 1..moves.len() {
        let before = &moves[i - 1];
        let reachable = before.entry_squared + 2.0 * before.acceleration * before.length;
        moves[i].entry_squared = moves[i].entry_squared.min(reachable);
    }
    for i in 0..moves.len() {
        let exit_squared = moves.get(i + 1).map_or(0.0, |next| next.entry_squared);
        seconds[moves[i].motion] += trapezoid_seconds(&moves[i], exit_squared);
    }
    moves.clear();
}

/// Speeding up, cruising, slowing down.
fn trapezoid_seconds(m: &Move, exit_squared: f64) -> f64 {
    let (entry, exit) = (m.entry_squared.sqrt(), exit_squared.sqrt());
    let a = m.acceleration;
    // The highest speed from which the exit can still be reached.
    let peak = (a * m.length + 0.5 * (m.entry_squared + exit_squared)).sqrt().min(m.nominal);
    let ramps = (2.0 * peak * peak - m.entry_squared - exit_squared) / (2.0 * a);
    let cruise = (m.length - ramps).max(0.0);
    ((peak - entry) + (peak - exit)).max(0.0) / a + cruise / peak
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Turn;

    fn feed(to: Point3, from: Point3) -> Motion {
        motion(to, from, MotionKind::Feed { feed: 2000.0 })
    }

    fn motion(to: Point3, from: Point3, kind: MotionKind) -> Motion {
        Motion { line: 1, from, to, kind, spindle_on: true, spindle_speed: 1000.0, tool: 1 }
    }

    fn machine(acceleration: f64) -> Machine {
        Machine { acceleration: [acceleration; 3], ..Machine::default() }
    }

    fn at(x: f64, y: f64) -> Point3 {
        Point3::new(x, y, 0.0)
    }

    #[test]
    fn one_line_is_a_trapezoid() {
        let program = Program { motions: vec![feed(at(100.0, 0.0), at(0.0, 0.0))], ..Program::default() };
        let v: f64 = 2000.0 / 60.0;
        let expected = 100.0 / v + v / 500.0;
        assert!((estimate(&program, &machine(500.0)).feed_seconds - expected).abs() < 1e-9);
        // Too short to reach the feed: half the way speeding up, half slowing down.
        let short = Program { motions: vec![feed(at(1.0, 0.0), at(0.0, 0.0))], ..Program::default() };
        assert!((estimate(&short, &machine(500.0)).feed_seconds - 2.0 * (1.0f64 / 500.0).sqrt()).abs() < 1e-9);
    }

    #[test]
    fn a_line_in_pieces_takes_as_long() {
        let pieces = |n: usize| {
            let point = |k: usize| at(100.0 * k as f64 / n as f64, 50.0 * k as f64 / n as f64);
            let motions = (0..n).map(|k| feed(point(k + 1), point(k))).collect();
            estimate(&Program { motions, ..Program::default() }, &machine(500.0)).feed_seconds
        };
        assert!((pieces(1) - pieces(37)).abs() < 1e-9);
    }

    /// "about 53 degrees: 121 mm/min of 2000 at 500 mm/s²": the corner of a tooth as wide as high, whose sides stand
    /// at 53 degrees to each other.
    #[test]
    fn sharp_corners_crawl() {
        let up = Vector3::new(5.0, 10.0, 0.0).normalize();
        let down = Vector3::new(5.0, -10.0, 0.0).normalize();
        let before =
            Move { length: 1.0, direction: up, nominal: 33.0, acceleration: 500.0, entry_squared: 0.0, motion: 0 };
        let mm_per_min = 60.0 * junction_speed_squared(&before, down, |_| 500.0, 0.01).sqrt();
        assert!((mm_per_min - 121.0).abs() < 1.0, "{mm_per_min}");
    }

    #[test]
    fn dwells_and_rapids_are_counted_apart() {
        let here = at(0.0, 0.0);
        let there = at(30.0, 0.0);
        let motions =
            vec![motion(here, here, MotionKind::Dwell { seconds: 2.5 }), motion(there, here, MotionKind::Rapid)];
        let program = Program { motions, ..Program::default() };
        let time = estimate(&program, &machine(500.0));
        assert_eq!(motion_seconds(&program, &machine(500.0)), [time.dwell_seconds, time.rapid_seconds]);
        assert_eq!(time.dwell_seconds, 2.5);
        assert_eq!(time.feed_seconds, 0.0);
        let v: f64 = 5000.0 / 60.0;
        assert!((time.rapid_seconds - (30.0 / v + v / 500.0)).abs() < 1e-9);
    }

    /// How far the plate below the teeth reaches, mm: not told with the table, the one number fitted to it.
    const PLATE: f64 = 42.0;

    /// The path of a tool of radius `tool` around a plate with teeth on its upper edge, clockwise: around the tips with
    /// the tool's radius, through the roots with `path_radius` (0: sharp) or the largest for which the sides are long
    /// enough.
    fn zigzag(teeth: usize, width: f64, height: f64, tool: f64, path_radius: f64) -> Program {
        let line = MotionKind::Feed { feed: 2000.0 };
        let left = Vector3::new(-height, 0.5 * width, 0.0).normalize();
        let right = Vector3::new(height, 0.5 * width, 0.0).normalize();
        let (x, y) = (Vector3::x(), Vector3::y());
        let mut motions: Vec<Motion> = Vec::new();
        let mut place: Option<Point3> = None;
        let mut go = |to: Point3, kind: MotionKind| {
            if let Some(from) = place {
                motions.push(motion(to, from, kind));
            }
            place = Some(to);
        };
        let around = |center: Point3, turn| MotionKind::Arc { center: center.xy(), turn, feed: 2000.0 };
        let tip = |tooth: usize| at((tooth as f64 + 0.5) * width, height);
        let root = |tooth: usize| at(tooth as f64 * width, 0.0);
        let (side, slope) = (height.hypot(0.5 * width), height / (0.5 * width));
        // A hair less than what fits: of the lines between the arcs something remains that has a direction.
        let path_radius = path_radius.min((side / slope - tool) * (1.0 - 1e-6));
        let rise = (tool + path_radius) * side / (0.5 * width);
        go(root(0) - x * tool, line);
        go(root(0) + left * tool, around(root(0), Turn::Right));
        for tooth in 0..teeth {
            go(tip(tooth) + left * tool, line);
            go(tip(tooth) + right * tool, around(tip(tooth), Turn::Right));
            if tooth + 1 == teeth {
                break;
            }
            let center = root(tooth + 1) + y * rise;
            if path_radius == 0.0 {
                go(center, line);
            } else {
                go(center - right * path_radius, line);
                go(center - left * path_radius, around(center, Turn::Left));
            }
        }
        let end = root(teeth);
        go(end + right * tool, line);
        go(end + x * tool, around(end, Turn::Right));
        let below = Vector3::new(0.0, -PLATE, 0.0);
        go(end + below + x * tool, line);
        go(end + below - y * tool, around(end + below, Turn::Right));
        go(root(0) + below - y * tool, line);
        go(root(0) + below - x * tool, around(root(0) + below, Turn::Right));
        go(root(0) - x * tool, line);
        Program { motions, ..Program::default() }
    }

    /// Seconds of `program` on a machine whose acceleration is limited along the path, as that of the table below,
    /// not along each axis.
    fn seconds_along_the_path(program: &Program, acceleration: f64) -> f64 {
        let machine = machine(acceleration);
        let mut moves: Vec<Move> = Vec::new();
        for motion in &program.motions {
            split(motion, &machine, |to, from| {
                push_move(&mut moves, (0, motion), from, to, &machine);
                let Some((last, earlier)) = moves.split_last_mut() else { return };
                last.acceleration = acceleration;
                if let Some(before) = earlier.last() {
                    let deviation = machine.junction_deviation;
                    last.entry_squared = junction_speed_squared(before, last.direction, |_| acceleration, deviation)
                        .min(last.nominal.powi(2));
                }
            });
        }
        let mut seconds = [0.0];
        run(&mut moves, &mut seconds);
        seconds[0]
    }

    /// The table of what rounding is known to save: sharp against a path radius of 2 mm, or 1.2 mm between teeth 5 mm
    /// apart. One number, the plate, is fitted to twelve.
    #[test]
    fn rounding_saves_the_time_that_it_is_known_to_save() {
        for (teeth, width, height, acceleration, sharp, round) in [
            (20, 10.0, 10.0, 500.0, 21.7, 18.5),
            (20, 10.0, 4.0, 500.0, 17.2, 15.9),
            (40, 5.0, 5.0, 500.0, 21.6, 16.4),
            (20, 10.0, 10.0, 100.0, 27.4, 19.6),
            (20, 10.0, 4.0, 100.0, 22.6, 16.8),
            (40, 5.0, 5.0, 100.0, 32.0, 18.9),
        ] {
            let seconds =
                |radius| seconds_along_the_path(&zigzag(teeth, width, height, 3.175 / 2.0, radius), acceleration);
            let (a, b) = (seconds(0.0), seconds(2.0));
            println!("{teeth} x {width} x {height} at {acceleration}: {a:.2} -> {b:.2} s, known {sharp} -> {round} s");
            assert!((a / sharp - 1.0).abs() < 0.02, "sharp: {a} against {sharp}");
            assert!((b / round - 1.0).abs() < 0.02, "round: {b} against {round}");
        }
    }

    /// Along a diagonal two axes share the work: the way speeds up by √2 as fast, and no axis faster than it can.
    #[test]
    fn each_axis_has_its_own_limits() {
        let program = Program { motions: vec![feed(at(1.0, 1.0), at(0.0, 0.0))], ..Program::default() };
        let expected = 2.0 * (2.0f64.sqrt() / (500.0 * 2.0f64.sqrt())).sqrt();
        assert!((estimate(&program, &machine(500.0)).feed_seconds - expected).abs() < 1e-9);
        let slow = Machine { acceleration: [500.0, 100.0, 500.0], ..Machine::default() };
        let expected = 2.0 * (1.0f64 / 100.0).sqrt();
        assert!((estimate(&program, &slow).feed_seconds - expected).abs() < 1e-9);
    }
}
