//! The whole command: programs in strings, what is said of them, the files and the exit status.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::Command;
use clopen::io::mesh::{MeshFormat, read as read_mesh};
use clopen::mesh::problems;
use serde_json::Value;

const HEAD: &str = "G21 G90 G17 G94\nG0 Z5\nM3 S12000\nG4 P1\nF600\n";

/// A pocket of 20 by 10 with a tool of 4 mm, in two passes.
const POCKET: &str = "G0 X2 Y2\nG1 Z-1 F200\nG1 X18 F600\nG1 Y8\nG1 X2\nG1 Y2\nG1 Y5\nG1 X18\nG0 Z5\nG0 X2 Y2\nG1 Z-2 F200\nG1 X18 F600\n\
    G1 Y8\nG1 X2\nG1 Y2\nG1 Y5\nG1 X18\nG0 Z5\n";

const END: &str = "M5\nM2\n";

/// An outline of 20 by 10 mm whose lower left corner is at 30, 40.
const DRAWING: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="60mm" viewBox="0 0 60 60">
    <path d="M30 10H50V20H30Z"/></svg>"#;

struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new(program: &str) -> Bench {
        let bench = Bench { folder: tempfile::tempdir().unwrap() };
        fs::write(bench.path("part.nc"), format!("{HEAD}{program}{END}")).unwrap();
        fs::write(bench.path("part.svg"), DRAWING).unwrap();
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let mut command = Command::cargo_bin("clopen").unwrap();
        command.current_dir(self.folder.path()).arg("simulate").args(arguments).output().unwrap()
    }

    fn json(&self, arguments: &[&str]) -> (Value, Option<i32>) {
        let output = self.run(&[&["part.nc", "--format", "json"], arguments].concat());
        let value = serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{e}: {}", said(&output)));
        (value, output.status.code())
    }
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

fn exists(path: &Path) -> bool {
    path.metadata().is_ok_and(|m| m.len() > 0)
}

#[test]
fn a_good_program_is_clean_and_its_figures_are_told() {
    let bench = Bench::new(POCKET);
    let output = bench.run(&["part.nc", "--tool", "0=flat 4mm"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let text = said(&output);
    for part in ["flat 4 mm", "x -2.00 to 22.00", "z -2.00 to 0.00", "found       nothing", "operation"] {
        assert!(text.contains(part), "{part} is missing:\n{text}");
    }
    let (json, status) = bench.json(&["--tool", "0=flat 4mm"]);
    assert_eq!((json["clean"].as_bool(), status), (Some(true), Some(0)));
    // The corners keep a quarter of what a disk leaves of a square.
    let volume = 2.0 * (200.0 - 4.0 * 4.0 * (1.0 - std::f64::consts::FRAC_PI_4));
    let removed = json["removed_mm3"].as_f64().unwrap();
    assert!((removed / volume - 1.0).abs() < 5e-3, "{removed} against {volume}");
    assert_eq!(json["operations"][0]["deepest_z_mm"], -2.0);
    assert!(json["total_seconds"].as_f64().unwrap() > json["time"]["dwell_seconds"].as_f64().unwrap());
}

#[test]
fn comments_of_the_program_tell_its_tools_and_operations() {
    let two = "(tool 1 \"mill\" flat diameter 4 mm)\n(tool 2 \"v\" cone angle 90 deg tip 0 mm diameter 6 mm)\n(operation pocket)\nT1\n";
    let bench = Bench::new(&format!("{two}{POCKET}(operation groove)\nT2\nG0 X0 Y15\nG1 Z-1\nG1 X20\nG0 Z5\n"));
    let (json, status) = bench.json(&["--stock", "40x40x6", "--stock-at", "-10,-10"]);
    assert_eq!(status, Some(0), "{json}");
    let names: Vec<_> = json["operations"].as_array().unwrap().iter().map(|o| o["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["pocket", "groove"]);
    // A groove with a round end of a cone each: 20 long, 1 deep and 2 wide.
    let groove = json["operations"][1]["removed_mm3"].as_f64().unwrap();
    assert!((groove / (20.0 + std::f64::consts::PI / 3.0) - 1.0).abs() < 0.02, "{groove}");
    assert_eq!(json["stock"]["max_x_mm"], 30.0);
}

#[test]
fn an_unknown_tool_is_asked_for() {
    let output = Bench::new(&format!("T3\n{POCKET}")).run(&["part.nc"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("tool 3") && said(&output).contains("--tool \"3=flat"), "{}", said(&output));
    assert!(said(&output).contains("line 8"), "{}", said(&output));
}

#[test]
fn what_goes_wrong_is_found_with_its_line() {
    let bench = Bench::new(&format!("{POCKET}G0 X30 Y5\nG0 Z-1\nG0 Z5\nG0 X10 Y5\nG1 Z-9\nG0 Z5\n"));
    let stock = ["--tool", "0=flat 4mm", "--stock", "60x30x6mm", "--stock-at=-10mm,-10mm"];
    let (json, status) = bench.json(&stock);
    assert_eq!(status, Some(1));
    let kinds: Vec<_> = json["events"].as_array().unwrap().iter().map(|e| (&e["kind"], &e["line"])).collect();
    assert_eq!(kinds, [(&Value::from("rapid-through-stock"), &Value::from(25)), (&"overrun".into(), &28.into())]);
    // Deep enough a board below, and the second is none; a clamp, and there is one more.
    let (json, _) = bench.json(&[stock.as_slice(), &["--spoil", "4mm"]].concat());
    assert_eq!(json["events"].as_array().unwrap().len(), 1);
    let (json, status) = bench.json(&[stock.as_slice(), &["--keepout", "-10,-10,0.5,30,12"]].concat());
    assert_eq!(status, Some(1));
    let collision = &json["events"].as_array().unwrap()[0];
    assert_eq!((&collision["kind"], &collision["keepout"]), (&"collision".into(), &1.into()));
}

#[test]
fn a_part_shows_gouges_and_leftovers() {
    let bench = Bench::new(POCKET);
    let against = ["--tool", "0=flat 4mm", "--against", "part.svg", "--side", "inside"];
    let (json, status) = bench.json(&against);
    assert_eq!(status, Some(0), "{json}");
    assert!(json["against"]["gouge"]["depth_mm"].as_f64().unwrap().abs() < 1e-9);
    assert_eq!(json["against"]["uncut"]["places"].as_array().unwrap().len(), 4);
    // A wider tool takes of the part.
    let (json, status) = bench.json(&["--tool", "0=flat 5mm", "--against", "part.svg", "--side", "inside"]);
    assert_eq!(status, Some(1));
    assert!((json["against"]["gouge"]["depth_mm"].as_f64().unwrap() - 0.5).abs() < 1e-9);
    // The drawing lies elsewhere.
    let (json, status) = bench.json(&[against.as_slice(), &["--origin", "drawing"]].concat());
    assert_eq!(status, Some(1), "{json}");
}

#[test]
fn pictures_levels_and_a_mesh_are_written() {
    let bench = Bench::new(POCKET);
    let tool = ["part.nc", "--tool", "0=flat 4mm", "--stock", "30x20x5mm"];
    let files = ["-o", "cut.png", "--levels", "level", "--stl", "cut.stl"];
    let output = bench.run(&[tool.as_slice(), &files].concat());
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    for name in ["cut.png", "level-01.png", "level-02.png", "cut.stl"] {
        assert!(exists(&bench.path(name)), "{name} is missing");
    }
    assert!(!exists(&bench.path("level-03.png")));
    let mesh = read_mesh(&fs::read(bench.path("cut.stl")).unwrap(), MeshFormat::Stl).unwrap();
    assert_eq!(problems(&mesh), []);
    assert!(mesh.polygon_count() < 20_000, "{}", mesh.polygon_count());
    let bounds = |axis: usize| {
        let values = mesh.points.iter().map(|p| p[axis]);
        (values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max))
    };
    assert_eq!((bounds(0), bounds(1), bounds(2)), ((-5.0, 25.0), (-5.0, 15.0), (-5.0, 0.0)));
}

#[test]
fn what_cannot_run_writes_nothing() {
    let bench = Bench::new(POCKET);
    let tool = ["part.nc", "--tool", "0=flat 4mm"];
    for (arguments, part) in [
        (vec!["--stock", "30x20"], "--stock \"30x20\""),
        (vec!["--stock", "30x20x0"], "above zero"),
        (vec!["--cell", "0.00001mm"], "--cell"),
        (vec!["--stl", "cut.obj"], "cut.stl"),
        (vec!["-o", "cut.jpg"], "png"),
        (vec!["--against", "nowhere.svg"], "nowhere.svg"),
        (vec!["--keepout", "1,2,3"], "1,2,3"),
        (vec!["--tool", "1=cube 3mm"], "T1=flat 3.175mm"),
        (vec!["-o", "nowhere/cut.png"], "nowhere"),
        (vec!["--acceleration", "0"], "--acceleration"),
        (vec!["--stl", "part.nc"], "STL"),
    ] {
        let arguments = [tool.as_slice(), &arguments, &["--levels", "level"]].concat();
        let output = bench.run(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output));
        assert!(said(&output).contains(part), "{arguments:?}: {}", said(&output));
        assert!(!exists(&bench.path("level-01.png")), "{arguments:?}");
    }
    let output = bench.run(&["part.svg"]);
    assert!(output.status.code() == Some(2) && said(&output).contains("drawing"), "{}", said(&output));
}

#[test]
fn a_program_comes_from_standard_input() {
    let mut command = Command::cargo_bin("clopen").unwrap();
    let output = command.args(["simulate", "-", "--tool", "0=flat 4mm"]).write_stdin(format!("{HEAD}{POCKET}{END}"));
    let output = output.output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
}

#[test]
fn a_slower_machine_takes_longer() {
    let bench = Bench::new(POCKET);
    let seconds = |more: &[&str]| {
        let (json, _) = bench.json(&[&["--tool", "0=flat 4mm"], more].concat());
        json["total_seconds"].as_f64().unwrap()
    };
    let usual = seconds(&[]);
    assert!(seconds(&["--acceleration", "50"]) > usual);
    assert!(seconds(&["--rapid", "500mm/min"]) > usual);
    assert!(seconds(&["--junction-deviation", "0.0001mm"]) > usual);
}
