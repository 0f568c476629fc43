//! One job of three steps and two tools, written for every dialect in both units, byte for byte.
//!
//! The programs are stored in `tests/programs/golden`. After a change that is meant, `CLOPEN_GOLDEN=write cargo test --test
//! golden_programs` writes them anew: look at the difference before it is committed.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use clopen::cam::{Move, MoveKind, Settings, Step, Tool, ToolShape, Toolpath};
use clopen::gcode::{Arcs, Dialect, LintOptions, Units, WriteError, WriteOptions, lint, read, write_files};
use clopen::plane::{Arc, Link, Point, Turn, Vector};
use clopen::units::Speed;

const SAFE: f64 = 5.0;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/programs/golden")
}

fn settings(spindle_speed: f64) -> Settings {
    let speed = |v| Speed::from_mm_per_min(v).unwrap();
    Settings { feed: speed(800.0), plunge_feed: speed(250.0), spindle_speed, dwell: 2.0, safe_height: SAFE }
}

/// Moves one after the other.
struct Path3(Vec<Move>);

impl Path3 {
    fn new() -> Path3 {
        Path3(vec![Move { to: Point::origin(), z: SAFE, kind: MoveKind::Rapid, contour: 0 }])
    }

    fn to(&mut self, x: f64, y: f64, z: f64, kind: MoveKind) -> &mut Path3 {
        self.0.push(Move { to: Point::new(x, y), z, kind, contour: 0 });
        self
    }

    fn line(&mut self, x: f64, y: f64, z: f64) -> &mut Path3 {
        self.to(x, y, z, MoveKind::Cut(Link::Line))
    }

    fn arc(&mut self, x: f64, y: f64, z: f64, center: [f64; 2], radius: f64) -> &mut Path3 {
        let center = Point::new(center[0], center[1]);
        self.to(x, y, z, MoveKind::Cut(Link::Arc(Arc { center, radius, turn: Turn::Left })))
    }

    fn step(&mut self, label: &str, tool: Tool, spindle_speed: f64) -> Step {
        let toolpath = Toolpath {
            settings: settings(spindle_speed),
            moves: std::mem::take(&mut self.0),
            contour_count: 1,
            part_side: Turn::Right,
            translation: Vector::zeros(),
        };
        Step { label: label.into(), tool, toolpath }
    }
}

fn tool(number: u32, diameter: f64, is_drill: bool) -> Tool {
    let shape = match is_drill {
        true => ToolShape::Cone { angle: 118f64.to_radians(), tip_diameter: 0.0 },
        false => ToolShape::Flat,
    };
    Tool { number, name: String::new(), shape, is_drill, diameter, flutes: 2, flute_length: 20.0 }
}

/// A pocket with a helix and a tab, two holes drilled in pecks, and a line on a slope with the first tool again.
fn job() -> Vec<Step> {
    let helix = Link::Arc(Arc { center: Point::new(10.0, 10.0), radius: 2.0, turn: Turn::Left });
    let mut pocket = Path3::new();
    pocket.to(12.0, 10.0, SAFE, MoveKind::Rapid).to(12.0, 10.0, 0.5, MoveKind::Rapid);
    pocket.to(12.0, 10.0, 0.0, MoveKind::Plunge).to(8.0, 10.0, -0.5, MoveKind::Ramp(helix));
    pocket.to(12.0, 10.0, -1.0, MoveKind::Ramp(helix)).line(14.0, 10.0, -1.0).line(14.0, 13.0, -1.0);
    pocket.arc(13.0, 14.0, -1.0, [13.0, 13.0], 1.0).line(11.0, 14.0, -1.0).line(10.5, 14.0, -0.5);
    pocket.line(9.5, 14.0, -0.5).line(9.0, 14.0, -1.0).line(7.0, 14.0, -1.0);
    pocket.arc(6.0, 13.0, -1.0, [7.0, 13.0], 1.0).line(6.0, 7.0, -1.0).arc(7.0, 6.0, -1.0, [7.0, 7.0], 1.0);
    pocket.line(13.0, 6.0, -1.0).arc(14.0, 7.0, -1.0, [13.0, 7.0], 1.0).line(14.0, 10.0, -1.0);
    pocket.to(14.0, 10.0, SAFE, MoveKind::Rapid);
    let mut holes = Path3::new();
    for (x, y) in [(3.0, 3.0), (17.0, 16.666_67)] {
        holes.to(x, y, SAFE, MoveKind::Rapid).to(x, y, 0.5, MoveKind::Rapid).to(x, y, -2.0, MoveKind::Plunge);
        // Out for the chips, and back into its own hole.
        holes.to(x, y, 0.5, MoveKind::Rapid).to(x, y, -1.5, MoveKind::Rapid).to(x, y, -4.0, MoveKind::Plunge);
        holes.to(x, y, SAFE, MoveKind::Rapid);
    }
    let mut slope = Path3::new();
    slope.to(0.0, 20.0, SAFE, MoveKind::Rapid).to(0.0, 20.0, -0.25, MoveKind::Plunge).line(20.0, 20.0, -1.25);
    // An arc whose rounded ends are no longer on it.
    slope.arc(0.0, 20.0, -1.25, [10.0, 16.0], 116f64.sqrt()).to(0.0, 20.0, SAFE, MoveKind::Rapid);
    vec![
        pocket.step("pocket", tool(1, 3.0, false), 12_000.0),
        holes.step("holes", tool(2, 2.5, true), 6000.0),
        slope.step("slope", tool(1, 3.0, false), 10_000.0),
    ]
}

/// The programs of the job by the name of their file, and their dialects.
fn programs() -> Vec<(String, &'static Dialect, String)> {
    let mut programs = Vec::new();
    for dialect in Dialect::built_in() {
        for (units, unit) in [(Units::Millimetres, "mm"), (Units::Inches, "inch")] {
            let header = ["clopen golden program".to_owned(), format!("dialect {}", dialect.name)];
            let options = WriteOptions { units, arcs: Arcs::Arcs };
            let mut steps = job();
            // The power of a beam is not a speed.
            if dialect.name == "grbl-laser" {
                steps.iter_mut().for_each(|s| s.toolpath.settings.spindle_speed /= 20.0);
            }
            match write_files(&steps, &header, dialect, options) {
                Ok(files) => programs.extend(
                    files.into_iter().map(|f| (format!("{}-{unit}{}.nc", dialect.name, f.suffix), dialect, f.text)),
                ),
                Err(error) => {
                    let is_unknown = !dialect.units.contains(&units) && matches!(error, WriteError::Units { .. });
                    assert!(is_unknown, "{} {unit}: {error}", dialect.name);
                }
            }
        }
    }
    programs
}

#[test]
fn every_dialect_writes_what_is_stored() {
    let is_writing = std::env::var("CLOPEN_GOLDEN").is_ok_and(|v| v == "write");
    let mut names = BTreeSet::new();
    for (name, _, text) in programs() {
        let path = folder().join(&name);
        if is_writing {
            std::fs::create_dir_all(folder()).unwrap();
            std::fs::write(&path, &text).unwrap();
        }
        let stored = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(text, stored, "{name}");
        names.insert(name);
    }
    assert!(names.len() > Dialect::built_in().len());
    let stored = std::fs::read_dir(folder()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    let stray: Vec<String> = stored.filter(|n| !names.contains(n)).collect();
    assert!(stray.is_empty(), "nothing writes {stray:?}");
}

#[test]
fn each_passes_the_lint_of_its_dialect_and_is_read_back() {
    for (name, dialect, text) in programs() {
        assert_eq!(lint(&text, &LintOptions { dialect, stock_top: 0.0 }), [], "{name}:\n{text}");
        assert_eq!(Dialect::of_header(&text), Some(dialect), "{name}");
        let program = read(&text).unwrap();
        let cuts = program.motions.iter().filter(|m| m.is_feed()).count();
        // Drilling says nothing to a machine without depth.
        let least = if name.contains("-t2") { usize::from(dialect.has_depth()) } else { 2 };
        assert!(cuts >= least, "{name}: {cuts}");
    }
}

/// Whether all programs cut the same: every controller's text leads to the same places.
#[test]
fn dialects_differ_in_words_and_not_in_places() {
    let corners = |text: &str| -> Vec<[i64; 3]> {
        let feeds = read(text).unwrap().motions.into_iter().filter(|m| m.is_feed());
        // A ten thousandth of an inch apart.
        feeds.map(|m| [m.to.x, m.to.y, m.to.z].map(|v| (v * 400.0).round() as i64)).collect()
    };
    let mut seen = 0;
    let mut first: Option<Vec<[i64; 3]>> = None;
    for dialect in Dialect::built_in().iter().filter(|d| d.has_depth()) {
        for unit in ["mm", "inch"] {
            let start = format!("{}-{unit}", dialect.name);
            let texts: Vec<(String, &Dialect, String)> = programs();
            let of_job = texts
                .iter()
                .filter(|(name, ..)| *name == format!("{start}.nc") || name.starts_with(&format!("{start}-")));
            let mut parts: Vec<(&String, &String)> = of_job.map(|(name, _, text)| (name, text)).collect();
            if parts.is_empty() {
                continue;
            }
            // In the order of the job.
            parts.sort();
            let places: Vec<[i64; 3]> = parts.iter().flat_map(|(_, text)| corners(text)).collect();
            seen += 1;
            let expected = first.get_or_insert_with(|| places.clone());
            assert_eq!(&places, expected, "{start}");
        }
    }
    assert!(seen >= 12, "{seen}");
}

#[test]
fn linuxcnc_runs_its_programs() {
    if Command::new("rs274").arg("-h").output().is_err() {
        println!("skipped: rs274 (Debian package linuxcnc-uspace) is absent");
        return;
    }
    let here = tempfile::tempdir().unwrap();
    std::fs::write(here.path().join("tool.tbl"), "T1 P1 D3 Z0 ;\nT2 P2 D2.5 Z0 ;\n").unwrap();
    for unit in ["mm", "inch"] {
        std::fs::write(here.path().join("empty.var"), "").unwrap();
        let path = folder().join(format!("linuxcnc-{unit}.nc"));
        let output = Command::new("rs274")
            .args(["-t", "tool.tbl", "-v", "empty.var", "-g", path.to_str().unwrap(), "out.canon"])
            .current_dir(here.path())
            .output()
            .unwrap();
        assert!(output.status.success(), "{unit}: {}", String::from_utf8_lossy(&output.stderr));
        let canon = std::fs::read_to_string(here.path().join("out.canon")).unwrap();
        assert!(canon.contains("PROGRAM_END"), "{unit}");
        assert_eq!(canon.matches("CHANGE_TOOL").count(), 3, "{canon}");
        assert_eq!(canon.matches("START_SPINDLE").count(), 3, "{unit}");
        assert_eq!(canon.matches("DWELL").count(), 3, "{unit}");
    }
}
