use super::*;
use crate::cam::test_shapes::p;
use crate::cam::{Settings, Step, Tool, ToolShape, Toolpath};
use crate::gcode::{GRBL, LintOptions, ProgramFile, lint, write_files, write_steps};
use crate::plane::Vector;
use crate::units::Speed;

const MM: WriteOptions = WriteOptions { units: Units::Millimetres, arcs: Arcs::Arcs };

fn tool(number: u32) -> Tool {
    let shape = ToolShape::Flat;
    Tool { number, name: String::new(), shape, is_drill: false, diameter: 3.0, flutes: 2, flute_length: 20.0 }
}

/// Down at (0, 0), along to (10, 0), which is twice as deep, and up.
fn step(label: &str, number: u32, spindle_speed: f64) -> Step {
    let speed = |v| Speed::from_mm_per_min(v).unwrap();
    let moving = |x: f64, z: f64, kind| Move { to: p(x, 0.0), z, kind, contour: 0 };
    let moves = vec![
        moving(0.0, 5.0, MoveKind::Rapid),
        moving(0.0, 5.0, MoveKind::Rapid),
        moving(0.0, -1.0, MoveKind::Plunge),
        moving(10.0, -2.0, MoveKind::Cut(Link::Line)),
        moving(10.0, 5.0, MoveKind::Rapid),
    ];
    let settings =
        Settings { feed: speed(600.0), plunge_feed: speed(200.0), spindle_speed, dwell: 2.5, safe_height: 5.0 };
    let toolpath = Toolpath { settings, moves, contour_count: 1, part_side: Turn::Right, translation: Vector::zeros() };
    Step { label: label.into(), tool: tool(number), toolpath }
}

fn written(steps: &[Step], dialect: &Dialect) -> String {
    let text = write_steps(steps, &[], dialect, MM).unwrap();
    assert_eq!(lint(&text, &LintOptions { dialect, stock_top: 0.0 }), [], "{text}");
    text
}

fn named(name: &str) -> &'static Dialect {
    Dialect::named(name).unwrap()
}

const CUT: &str = "G0 X0 Y0\nG1 Z-1 F200\nG1 X10 Z-2 F600\nG0 Z5\n";

#[test]
fn a_program_of_one_tool_takes_it_to_be_there() {
    let text = written(&[step("slot", 3, 9000.0)], named("grblhal"));
    let head = "(tool 3 \"\" flat diameter 3 mm)\nG21\nG17 G90 G94\n(operation slot)\nG0 Z5\nM3 S9000\nG4 P2.5\n";
    assert_eq!(text, format!("{head}{CUT}M5\nM30\n"));
}

#[test]
fn a_change_of_tool_lifts_stops_changes_and_starts_again() {
    let text = written(&[step("a", 1, 9000.0), step("b", 1, 9000.0), step("c", 2, 5000.0)], named("mach3"));
    let head = "(tool 1 \"\" flat diameter 3 mm)\n(tool 2 \"\" flat diameter 3 mm)\nG21\nG17 G90 G94\n\
        G40 G80 G91.1\n";
    let first = "(operation a)\nT1 M6\nG43 H1\nG0 Z5\nM3 S9000\nG4 P2.5\n";
    // The same tool at the same speed just goes on; the feed is still that of the cut before.
    let second = "(operation b)\nG0 X0\nG1 Z-1 F200\nG1 X10 Z-2 F600\nG0 Z5\nM5\n";
    let third = "(operation c)\nT2 M6\nG43 H2\nG0 Z5\nM3 S5000\nG4 P2.5\n";
    assert_eq!(text, format!("{head}{first}{CUT}{second}{third}{CUT}M5\nM30\n"));
}

#[test]
fn another_speed_of_the_same_tool_is_waited_for() {
    let text = written(&[step("a", 1, 9000.0), step("b", 1, 5000.0)], &GRBL);
    assert!(text.contains("G0 Z5\n(operation b)\nM3 S5000\nG4 P2.5\nG0 X0\n"), "{text}");
}

#[test]
fn without_a_tool_changer_every_tool_gets_its_program() {
    let steps = [step("a", 1, 9000.0), step("b", 2, 9000.0), step("c", 2, 9000.0), step("d", 1, 9000.0)];
    let error = write_steps(&steps, &[], &GRBL, MM).unwrap_err();
    assert_eq!(error, WriteError::NoToolChange { dialect: "grbl".into(), count: 2 });
    let files = write_files(&steps, &["job".into()], &GRBL, MM).unwrap();
    let suffixes: Vec<&str> = files.iter().map(|f| f.suffix.as_str()).collect();
    assert_eq!(suffixes, ["-1-t1", "-2-t2", "-3-t1"]);
    for (file, of) in files.iter().zip(["1 of 3", "2 of 3", "3 of 3"]) {
        assert!(file.text.starts_with(&format!("(job)\n(program {of})\n")), "{}", file.text);
        assert!(file.text.ends_with("M5\nM30\n") && !file.text.contains("M6"), "{}", file.text);
        assert_eq!(lint(&file.text, &LintOptions { dialect: &GRBL, stock_top: 0.0 }), []);
    }
    assert!(files[1].text.contains("(operation b)") && files[1].text.contains("(operation c)"));
    let one = write_files(&steps, &[], named("linuxcnc"), MM).unwrap();
    let whole = write_steps(&steps, &[], named("linuxcnc"), MM).unwrap();
    assert_eq!(one, [ProgramFile { suffix: String::new(), text: whole }]);
    assert_eq!(write_files(&[], &[], &GRBL, MM), Err(WriteError::Empty));
}

#[test]
fn a_beam_is_on_only_while_it_cuts() {
    let text = written(&[step("a", 1, 800.0), step("b", 1, 300.0)], named("grbl-laser"));
    let head = "(tool 1 \"\" flat diameter 3 mm)\nG21\nG17 G90 G94\n(operation a)\nM5\nG0 X0 Y0\n";
    let rest = "M4 S800\nG1 X10 F600\nM5\n(operation b)\nG0 X0\nM4 S300\nG1 X10\nM5\nM30\n";
    assert_eq!(text, format!("{head}{rest}"));
}

#[test]
fn a_pen_is_down_only_while_it_draws() {
    let text = written(&[step("a", 1, 0.0)], named("plotter"));
    let expected = "(operation a)\nG0 Z3\nG0 X0 Y0\nG1 Z0 F200\nG1 X10 F600\nG0 Z3\nM30\n";
    assert!(text.ends_with(expected), "{text}");
    let text = written(&[step("a", 1, 0.0)], named("plotter-servo"));
    let expected = "(operation a)\nM3 S30\nG4 P0.2\nG0 X0 Y0\nM3 S60\nG4 P0.2\nG1 X10 F600\nM3 S30\nG4 P0.2\nM30\n";
    assert!(text.ends_with(expected), "{text}");
}

#[test]
fn marlin_gets_one_command_a_line_a_duty_cycle_and_the_feed_of_rapids() {
    let text = written(&[step("a", 1, 15_000.0)], named("marlin"));
    let expected = ";tool 1 \"\" flat diameter 3 mm\nG21\nG90\n;operation a\nG0 Z5 F3000\nM3 S127.5\nG4 S2.5\n\
        G0 X0 Y0\nG1 Z-1 F200\nG1 X10 Z-2 F600\nG0 Z5 F3000\nM5\n";
    assert_eq!(text, expected);
    let error = write_steps(&[step("a", 1, 60_000.0)], &[], named("marlin"), MM).unwrap_err();
    assert!(matches!(error, WriteError::Speed { most, .. } if most == 30_000.0), "{error}");
    let inches = WriteOptions { units: Units::Inches, ..MM };
    let error = write_steps(&[step("a", 1, 100.0)], &[], named("marlin"), inches).unwrap_err();
    assert_eq!(error, WriteError::Units { dialect: "marlin".into(), unit: "inches" });
    // Whole seconds, rounded up.
    assert!(written(&[step("a", 1, 100.0)], named("smoothieware")).contains("\nG4 S3\n"));
}

#[test]
fn a_helix_becomes_lines_where_the_controller_has_none() {
    let arc = Arc { center: p(5.0, 0.0), radius: 5.0, turn: Turn::Left };
    let mut helix = step("a", 1, 100.0);
    helix.toolpath.moves[3] = Move { to: p(10.0, 0.0), z: -2.0, kind: MoveKind::Ramp(Link::Arc(arc)), contour: 0 };
    assert!(written(&[helix.clone()], &GRBL).contains("G3 X10 Y0 Z-2 I5 J0\n"));
    let dialect = Dialect::parse("base = \"grbl\"\nhelical-arcs = false", "x").unwrap();
    let text = written(&[helix.clone()], &dialect);
    let depths: Vec<&str> = text.lines().filter(|l| l.starts_with("G1 X")).collect();
    assert!(depths.len() > 20 && !text.contains("G3") && text.contains(" Z-1.5"), "{text}");
    // At one height it stays an arc.
    helix.toolpath.moves[3] = Move { to: p(10.0, 0.0), z: -1.0, kind: MoveKind::Cut(Link::Arc(arc)), contour: 0 };
    assert!(written(&[helix], &dialect).contains("G3 X10 Y0 I5 J0 F600\n"));
}

#[test]
fn the_head_tells_the_diameter_and_not_the_number() {
    let mut cone = step("engrave", 7, 100.0);
    cone.tool.shape = ToolShape::Cone { angle: std::f64::consts::FRAC_PI_3, tip_diameter: 0.2 };
    cone.tool.name = "V bit (60)".into();
    let text = written(&[cone], &GRBL);
    assert!(text.starts_with("(tool 7 \"V bit [60]\" cone angle 60 deg tip 0.2 mm diameter 3 mm)\n"), "{text}");
    assert_eq!(crate::gcode::read(&text).unwrap().tool_diameter(), Some(3.0));
}
