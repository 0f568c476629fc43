use std::f64::consts::TAU;
use std::process::Command;

use proptest::prelude::*;

use super::*;
use crate::cam::test_shapes::{filled, p, plate, rounded_l, star, wavy};
use crate::cam::{Direction, Job, Origin, PathRadius, Settings, Side, Toolpath, plan};
use crate::gcode::{GRBL, LINUXCNC};
use crate::plane::{BoundaryIndex, Region, Ring, Vector};
use crate::units::Speed;

const OPTIONS: [WriteOptions; 4] = [
    WriteOptions { units: Units::Millimetres, arcs: Arcs::Arcs },
    WriteOptions { units: Units::Inches, arcs: Arcs::Arcs },
    WriteOptions { units: Units::Millimetres, arcs: Arcs::Lines },
    WriteOptions { units: Units::Inches, arcs: Arcs::Lines },
];

fn job() -> Job {
    Job { tool_diameter: 4.0, path_radius: PathRadius::Length(1.0), origin: Origin::Drawing, ..Job::default() }
}

fn shapes() -> Vec<(&'static str, Region)> {
    vec![
        ("rounded L", rounded_l(3.0)),
        ("plate with holes", plate(3, 2, 4.5)),
        ("many circles", plate(9, 9, 2.3)),
        ("drill holes", plate(3, 3, 2.0)),
        ("smooth curve", Region::new(vec![wavy(30.0, 0.2, 5.0, 3000)])),
        ("large circle", Region::new(vec![Ring::circle(p(0.0, 0.0), 700.0)])),
    ]
}

fn program(region: &Region, job: &Job, dialect: &Dialect, options: WriteOptions) -> String {
    let toolpath = plan(job, region, region).unwrap();
    write(&toolpath, &job.summary(), dialect, options).unwrap()
}

/// What a controller would do: an own, strict little interpreter that knows what the writer says and nothing else.
#[derive(Debug, Default)]
struct Machine {
    unit: f64,
    at: [f64; 3],
    feed: Option<f64>,
    spindle: bool,
    waited: bool,
    stated: Vec<String>,
    /// Start, end and link of every motion at a feed, in millimetres.
    cuts: Vec<([f64; 3], [f64; 3], Link)>,
    rapids: Vec<([f64; 3], [f64; 3])>,
    worst_mismatch: f64,
    ended: bool,
}

fn words(line: &str) -> Vec<(char, f64)> {
    let words: Vec<(char, f64)> = line
        .split(' ')
        .map(|w| {
            let (letter, number) = w.split_at(1);
            assert!(letter.chars().all(|c| c.is_ascii_uppercase()), "{line}");
            assert!(number.chars().all(|c| c.is_ascii_digit() || c == '.' || c == '-'), "{line}");
            assert!(number != "-0", "{line}");
            (letter.chars().next().unwrap(), number.parse().expect(line))
        })
        .collect();
    words
}

impl Machine {
    fn run(text: &str, dialect: &Dialect) -> Machine {
        let mut machine = Machine { at: [f64::NAN; 3], ..Machine::default() };
        assert!(text.is_ascii() && text.ends_with('\n'));
        for line in text.lines() {
            assert!(line.len() <= 79 && !machine.ended, "{line}");
            if let Some(inner) = line.strip_prefix('(') {
                assert!(inner.find(['(', ')']) == Some(inner.len() - 1), "{line}");
                assert!(machine.stated.is_empty(), "a comment behind the head: {line}");
                continue;
            }
            machine.block(line, dialect);
        }
        assert!(machine.ended && !machine.spindle);
        assert!(machine.worst_mismatch <= LARGEST_MISMATCH, "{}", machine.worst_mismatch);
        machine
    }

    fn block(&mut self, line: &str, dialect: &Dialect) {
        let words = words(line);
        let get = |letter: char| words.iter().find(|w| w.0 == letter).map(|w| w.1);
        let (first, code) = words[0];
        let motion = matches!((first, code), ('G', c) if c <= 3.0);
        if !motion {
            self.stated.extend(line.split(' ').map(str::to_owned));
            match (first, code) {
                ('G', 21.0) => self.unit = 1.0,
                ('G', 20.0) => self.unit = 25.4,
                ('M', 3.0) => self.spindle = get('S').unwrap() > 0.0,
                ('G', 4.0) => self.waited = self.spindle && get('P').is_some(),
                ('M', 5.0) => self.spindle = false,
                ('M', _) => {
                    assert_eq!([line], *dialect.program_end);
                    self.ended = true;
                }
                _ => {}
            }
            return;
        }
        let letters: Vec<char> = words.iter().map(|w| w.0).collect();
        let mut sorted = letters.clone();
        sorted.sort_unstable();
        sorted.dedup();
        assert_eq!(sorted.len(), letters.len(), "a word twice: {line}");
        assert!(!letters.contains(&'K') && !letters.contains(&'R'), "{line}");
        for code in ["G17", "G90", "G94"] {
            assert!(self.stated.iter().any(|s| s == code), "{code} is missing before {line}");
        }
        let from = self.at;
        for (axis, letter) in ['X', 'Y', 'Z'].into_iter().enumerate() {
            if let Some(value) = get(letter) {
                self.at[axis] = value * self.unit;
            }
        }
        assert!(self.at[2].is_finite(), "z has to be known first: {line}");
        assert!(from != self.at, "nothing moves: {line}");
        self.feed = get('F').map(|f| f * self.unit).or(self.feed);
        match code as u8 {
            0 => {
                assert!(get('F').is_none());
                assert!(get('Z').is_none() || (get('X').is_none() && get('Y').is_none()), "{line}");
                self.rapids.push((from, self.at));
            }
            1 => self.cut(from, Link::Line),
            2 | 3 => {
                let (i, j) = (get('I').unwrap() * self.unit, get('J').unwrap() * self.unit);
                assert!(get('X').is_some() && get('Y').is_some() && from[..2] != self.at[..2], "{line}");
                let center = p(from[0] + i, from[1] + j);
                let (r0, r1) = (i.hypot(j), (p(self.at[0], self.at[1]) - center).norm());
                self.worst_mismatch = self.worst_mismatch.max((r0 - r1).abs());
                let turn = if code == 2.0 { Turn::Right } else { Turn::Left };
                self.cut(from, Link::Arc(Arc { center, radius: r0, turn }));
            }
            _ => panic!("{line}"),
        }
    }

    fn cut(&mut self, from: [f64; 3], link: Link) {
        assert!(self.waited && self.feed.is_some_and(|f| f > 0.0));
        self.cuts.push((from, self.at, link));
    }

    fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        self.cuts.iter().map(|(a, b, link)| Segment { start: p(a[0], a[1]), end: p(b[0], b[1]), link: *link })
    }
}

/// The most that the tool, of `radius`, cuts into the part; and the most that its path leaves the wall, at full depth.
fn gouge_and_gap(machine: &Machine, part: &Region, radius: f64) -> (f64, f64) {
    let index = BoundaryIndex::new(part);
    let mut worst = (0f64, 0f64);
    for s in machine.segments() {
        let count = (s.length() / 0.05).ceil().clamp(2.0, 2000.0) as usize;
        for k in 0..=count {
            let d = index.distance(s.point_at(k as f64 / count as f64)) - radius;
            worst = (worst.0.max(-d), worst.1.max(d));
        }
    }
    worst
}

#[test]
fn the_always_and_never_lists_hold() {
    for (name, region) in shapes() {
        for dialect in [&*GRBL, &*LINUXCNC] {
            for options in OPTIONS {
                let job = job();
                let text = program(&region, &job, dialect, options);
                let machine = Machine::run(&text, dialect);
                assert!(machine.cuts.len() > 4, "{name}");
                // z alone first.
                let (from, to) = machine.rapids[0];
                assert!(from[2].is_nan() && to[0].is_nan() && (to[2] - 5.0).abs() < 1e-4, "{name}");
                for (from, to) in &machine.rapids {
                    let across = from[..2] != to[..2] && to[0].is_finite();
                    assert!(!across || (to[2] - 5.0).abs() < 2e-4, "{name}: {from:?} {to:?}");
                    assert!(to[2] > 0.0);
                }
                assert!((machine.at[2] - 5.0).abs() < 2e-4, "{name}: ends with z up");
                let has_arcs = machine.cuts.iter().any(|c| c.2 != Link::Line);
                assert!(!has_arcs || options.arcs == Arcs::Arcs, "{name}");
                let (gouge, gap) = gouge_and_gap(&machine, &region, 2.0);
                assert!(gouge <= 0.001 && gap <= 0.003, "{name}, {options:?}: {gouge} {gap}");
                let tail: Vec<&str> = text.lines().rev().take(3).collect();
                assert_eq!(tail[..2], [dialect.program_end[0].as_str(), "M5"]);
                assert!(tail[2].starts_with("G0 Z"));
            }
        }
    }
}

#[test]
fn a_program_reads_like_this() {
    let job = Job { depth: 1.0, entry: crate::cam::Entry::Plunge, ..job() };
    let square = Region::new(vec![Ring::polygon([p(0.0, 0.0), p(20.0, 0.0), p(20.0, 10.0), p(0.0, 10.0)])]);
    let toolpath = plan(&job, &square, &square).unwrap();
    let text = write(&toolpath, &["square (20 x 10)".to_owned()], &GRBL, WriteOptions::default()).unwrap();
    let expected = "(square [20 x 10])\nG21\nG17 G90 G94\nG0 Z5\nM3 S18000\nG4 P3\nG0 X-2 Y5\nG0 Z1\nG1 Z-1 F300\n\
                    G1 Y10 F1000\nG2 X0 Y12 I2 J0\nG1 X20\nG2 X22 Y10 I0 J-2\nG1 Y0\nG2 X20 Y-2 I-2 J0\nG1 X0\n\
                    G2 X-2 Y0 I0 J2\nG1 Y5\nG0 Z5\nM5\nM30\n";
    assert_eq!(text, expected);
    let cnc =
        write(&toolpath, &[], &LINUXCNC, WriteOptions { units: Units::Inches, ..WriteOptions::default() }).unwrap();
    assert!(cnc.starts_with("G20\nG17 G90 G94\nG40 G80 G91.1\nG64 P0.00004\nG0 Z0.19685\n"), "{cnc}");
    assert!(cnc.contains(" F39.37\n") && cnc.ends_with("M5\nM2\n"), "{cnc}");
}

#[test]
fn the_settings_stand_at_the_top() {
    let text = program(&rounded_l(3.0), &job(), &GRBL, WriteOptions::default());
    for words in ["(tool diameter 4 mm)", "(feed 1000 mm/min, plunge feed 300 mm/min)", "direction climb"] {
        assert!(text.contains(words), "{words} is missing in\n{text}");
    }
}

fn toolpath_of(moves: Vec<Move>) -> Toolpath {
    let speed = |v| Speed::from_mm_per_min(v).unwrap();
    let settings = Settings {
        feed: speed(1000.0),
        plunge_feed: speed(300.0),
        spindle_speed: 1000.0,
        dwell: 1.0,
        safe_height: 5.0,
    };
    Toolpath { settings, moves, contour_count: 1, part_side: Turn::Right, translation: Vector::zeros() }
}

/// A toolpath of one link from `start`, and the lines of its motion at a feed.
fn cut_of(start: Point, end: Point, link: Link) -> Vec<String> {
    let moving = |to, z, kind| Move { to, z, kind, contour: 0 };
    let toolpath = toolpath_of(vec![
        moving(start, 5.0, MoveKind::Rapid),
        moving(start, 5.0, MoveKind::Rapid),
        moving(start, -1.0, MoveKind::Plunge),
        moving(end, -1.0, MoveKind::Cut(link)),
    ]);
    let text = write(&toolpath, &[], &GRBL, WriteOptions::default()).unwrap();
    Machine::run(&text, &GRBL);
    text.lines()
        .skip_while(|l| !l.starts_with("G1 Z-1"))
        .skip(1)
        .take_while(|l| !l.starts_with("G0"))
        .map(str::to_owned)
        .collect()
}

#[test]
fn arcs_that_rounding_would_break_become_lines_or_two_arcs() {
    let arc = |center: Point, radius: f64, turn: Turn| Arc { center, radius, turn };
    // Its rounded ends are one: dropped, for a controller would run a full circle.
    let tiny = arc(p(0.0, 0.0), 2.0, Turn::Left);
    assert!(cut_of(p(2.0, 0.0), tiny.travel(p(2.0, 0.0), 1e-5), Link::Arc(tiny)).is_empty());
    // Nearly all around.
    let end = tiny.travel(p(2.0, 0.0), TAU - 1e-5);
    let lines = cut_of(p(2.0, 0.0), end, Link::Arc(tiny));
    assert_eq!(lines.len(), 2);
    assert!(lines.iter().all(|l| l.starts_with("G3 ")), "{lines:?}");
    // Flatter than a decimal can say.
    let flat = arc(p(0.0, 900.0), 900.0, Turn::Left);
    let lines = cut_of(p(0.0, 0.0), flat.travel(p(0.0, 0.0), 1e-4), Link::Arc(flat));
    assert!(lines.len() == 1 && lines[0].starts_with("G1 "), "{lines:?}");
    // Larger than single precision is good for.
    let large = arc(p(0.0, 5000.0), 5000.0, Turn::Left);
    let lines = cut_of(p(0.0, 0.0), large.travel(p(0.0, 0.0), 0.01), Link::Arc(large));
    assert!(lines.len() > 3 && lines.iter().all(|l| l.starts_with("G1 ")), "{lines:?}");
}

#[test]
fn a_controller_is_added_as_data() {
    let odd = "base = \"grbl\"\ncomments = \"semicolon\"\ndecimals-mm = 3\narcs = false\nline-numbers = true\n";
    let odd = Dialect::parse(odd, "odd").unwrap();
    let text = program(&rounded_l(3.0), &job(), &odd, WriteOptions::default());
    assert!(text.starts_with(";tool diameter 4 mm\n"));
    let lines: Vec<&str> = text.lines().filter(|l| !l.starts_with(';')).collect();
    assert!(lines.len() > 50 && lines.iter().all(|l| l.starts_with('N') && !l.contains("G2 ") && !l.contains("G3 ")));
    assert!(lines[0].ends_with(" G21"));
}

#[test]
fn the_longest_numbers_fit_a_line() {
    let far = 99_000.123_4;
    let arc = Arc { center: p(far, 0.0), radius: 999.999_9, turn: Turn::Left };
    let start = arc.center - Vector::new(arc.radius, 0.0);
    let moving = |to, z, kind| Move { to, z, kind, contour: 0 };
    let mut toolpath = toolpath_of(vec![
        moving(start, 5.0, MoveKind::Rapid),
        moving(start, 5.0, MoveKind::Rapid),
        moving(arc.travel(start, 2.0), -9_999.123_4, MoveKind::Ramp(Link::Arc(arc))),
    ]);
    toolpath.settings.plunge_feed = Speed::from_mm_per_min(987_654.321).unwrap();
    for options in OPTIONS {
        let text = write(&toolpath, &[], &GRBL, options).unwrap();
        assert!(text.lines().all(|l| l.len() <= 79), "{text}");
    }
}

#[test]
fn what_cannot_be_written_is_an_error_with_the_contour() {
    let moving = |to, kind| Move { to, z: 5.0, kind, contour: 2 };
    for bad in [f64::NAN, f64::INFINITY, 1e9] {
        let toolpath = toolpath_of(vec![moving(p(0.0, 0.0), MoveKind::Rapid), moving(p(bad, 0.0), MoveKind::Rapid)]);
        let error = write(&toolpath, &[], &GRBL, WriteOptions::default()).unwrap_err();
        assert!(matches!(error, WriteError::Place { contour: 3, .. }), "{error}");
    }
    let mut slow = toolpath_of(vec![moving(p(0.0, 0.0), MoveKind::Rapid)]);
    slow.settings.spindle_speed = 1e-9;
    assert!(matches!(write(&slow, &[], &GRBL, WriteOptions::default()), Err(WriteError::Rate { .. })));
}

#[test]
fn lines_for_arcs_never_cut_into_the_part() {
    // A disk and a hole: chords of the one would cut in, chords of the other not.
    for (region, side) in
        [(Region::new(vec![Ring::circle(p(3.0, 4.0), 30.0)]), Side::Outside), (plate(2, 2, 4.9), Side::Outside)]
    {
        for direction in [Direction::Climb, Direction::Conventional] {
            let job = Job { side, direction, ..job() };
            let text = program(&region, &job, &GRBL, OPTIONS[2]);
            assert!(!text.contains("G2 ") && !text.contains("G3 "));
            let machine = Machine::run(&text, &GRBL);
            let (gouge, gap) = gouge_and_gap(&machine, &region, 2.0);
            assert!(gouge <= 1e-4, "{gouge}");
            assert!(gap <= LINES_FOR_ARC_TOLERANCE, "{gap}");
        }
    }
}

/// Runs LinuxCNC's interpreter on a program; `None` where it is not installed.
fn linuxcnc(text: &str) -> Option<Result<String, String>> {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    std::fs::write(file("tool.tbl"), "T1 P1 D3.175 ;\n").unwrap();
    std::fs::write(file("empty.var"), "").unwrap();
    std::fs::write(file("program.ngc"), text).unwrap();
    let output = Command::new("rs274")
        .args(["-t", "tool.tbl", "-v", "empty.var", "-g", "program.ngc", "out.canon"])
        .current_dir(folder.path())
        .output()
        .ok()?;
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    let canon = std::fs::read_to_string(file("out.canon")).unwrap_or_default();
    Some(if output.status.success() { Ok(canon) } else { Err(errors) })
}

#[test]
fn linuxcnc_accepts_both_dialects() {
    for (name, region) in shapes() {
        for dialect in [&*GRBL, &*LINUXCNC] {
            for options in OPTIONS {
                let text = program(&region, &job(), dialect, options);
                let Some(result) = linuxcnc(&text) else {
                    println!("skipped: rs274 is not installed");
                    return;
                };
                let canon = result.unwrap_or_else(|e| panic!("{name}, {}, {options:?}: {e}", dialect.name));
                assert!(canon.contains("PROGRAM_END"), "{name}");
                let count = |word: &str| canon.matches(word).count();
                let machine = Machine::run(&text, dialect);
                assert_eq!(count("ARC_FEED") + count("STRAIGHT_FEED"), machine.cuts.len(), "{name}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// The written program of any shape keeps the tool out of the part.
    #[test]
    fn written_programs_keep_out_of_the_part(
        radii in proptest::collection::vec(30.0..60.0f64, 3..9), x in -200.0..200.0f64, extra in 0.0..2.0f64,
        option in 0..4usize, climb: bool, smooth: bool,
    ) {
        let hole = if smooth { wavy(10.0, 0.1, 3.0, 700) } else { Ring::circle(p(0.0, 0.0), 9.0) };
        let mut part = Region::new(vec![filled(&star(p(0.0, 0.0), &radii), 2.0 + extra), hole.reversed()]);
        for ring in &mut part.rings {
            let moved: Vec<Segment> = ring.segments().map(|s| s.translated(Vector::new(x, 1.7 * x))).collect();
            ring.vertices.iter_mut().zip(moved).for_each(|(v, s)| (v.point, v.link) = (s.start, s.link));
        }
        let direction = if climb { Direction::Climb } else { Direction::Conventional };
        let job = Job { direction, path_radius: PathRadius::Length(extra), ..job() };
        let text = program(&part, &job, &GRBL, OPTIONS[option]);
        let machine = Machine::run(&text, &GRBL);
        let (gouge, _) = gouge_and_gap(&machine, &part, 2.0);
        prop_assert!(gouge <= 0.001, "{}", gouge);
    }

    /// Any arc: what is written is within a last decimal or so of what was meant.
    #[test]
    fn written_arcs_are_the_arcs_meant(
        radius in 0.001..900.0f64, from in 0.0..TAU, sweep in 1e-4..0.999 * TAU, left: bool, x in -500.0..500.0f64,
    ) {
        let turn = if left { Turn::Left } else { Turn::Right };
        let arc = Arc { center: p(x, -0.3 * x), radius, turn };
        let start = arc.center + Vector::new(from.cos(), from.sin()) * radius;
        let exact = Segment { start, end: arc.travel(start, sweep), link: Link::Arc(arc) };
        let moving = |to, z, kind| Move { to, z, kind, contour: 0 };
        let toolpath = toolpath_of(vec![
            moving(start, 5.0, MoveKind::Rapid),
            moving(start, 5.0, MoveKind::Rapid),
            moving(start, -1.0, MoveKind::Plunge),
            moving(exact.end, -1.0, MoveKind::Cut(exact.link)),
        ]);
        let text = write(&toolpath, &[], &GRBL, WriteOptions::default()).unwrap();
        let machine = Machine::run(&text, &GRBL);
        // The ends of a half circle may be an odd number of decimals apart: one decimal is the best that there is. On short
        // arcs a step of the centre changes the radii by less.
        let best = if sweep < 0.5 { 0.3e-4 } else { 1.5e-4 };
        prop_assert!(machine.worst_mismatch <= best, "{} {:?}", machine.worst_mismatch, text);
        let mut length = 0.0;
        for s in machine.segments().skip(1) {
            length += s.length();
            for k in 0..=16 {
                let d = exact.nearest(s.point_at(f64::from(k) / 16.0)).distance;
                prop_assert!(d <= 0.0012, "{} {:?}", d, text);
                if s.link != Link::Line {
                    prop_assert!(d <= 2.5e-4, "{} {:?}", d, text);
                }
            }
        }
        prop_assert!((length - exact.length()).abs() <= 1e-3 * (1.0 + exact.length()), "{} {}", length, exact.length());
    }
}
