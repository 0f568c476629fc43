//! `clopen simulate` on programs whose motions cannot be told from their text, or are easily misread.

use std::fs;
use std::path::PathBuf;
use std::process::Output;

use assert_cmd::Command;
use serde_json::Value;

const HEAD: &str = "G21 G90 G17 G94\nG0 Z5\nM3 S12000\nG4 P1\n";
const END: &str = "G0 Z5\nM5\nM2\n";

struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    /// A program of `text` alone.
    fn whole(text: &str) -> Bench {
        let bench = Bench { folder: tempfile::tempdir().unwrap() };
        fs::write(bench.path("part.nc"), text).unwrap();
        bench
    }

    fn new(text: &str) -> Bench {
        Bench::whole(&format!("{HEAD}{text}{END}"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let stock = ["--stock", "100x100x5mm", "--stock-at=-10mm,-10mm"];
        let mut command = Command::cargo_bin("clopen").unwrap();
        command.current_dir(self.folder.path()).args(["simulate", "part.nc"]);
        command.args(stock).args(arguments).output().unwrap()
    }

    /// The report of a flat tool of 3 mm, and the exit status.
    fn json(&self) -> (Value, Option<i32>) {
        let output = self.run(&["--tool", "0=flat 3mm", "--format", "json"]);
        let value = serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{e}: {}", said(&output)));
        (value, output.status.code())
    }
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

#[test]
fn what_cannot_be_followed_is_a_finding_with_its_line_and_fails() {
    for (program, rule, line) in [
        ("G55\nG0 X10 Y10\nG1 Z-1 F100\nG1 X20\n", "shifted-origin", 5),
        ("G10 L20 P1 X0\nG0 X10 Y10\nG1 Z-1 F100\nX20\n", "shifted-origin", 5),
        ("G43 H1\nG43.1 Z10\nG0 X10 Y10\nG1 Z-1 F100\nX20\n", "shifted-origin", 6),
        ("G0 X10 Y10\nG1 Z-3 F100\nG1 X20\nG28\nG0 X0 Y0\n", "unknown-way", 8),
        ("G0 X10 Y10\nG1 Z-3 F100\nG1 X20\nG53 G0 X40 Y40\nG53 G0 Z0\n", "unknown-way", 8),
        ("G53 G0 X40 Y40\nG1 Z-3 F100\nG0 Z5\n", "unknown-way", 6),
        ("G0 X0 Y0\nG53 G1 Z-3 F100\n", "unknown-way", 6),
        ("G0 X0 Y0\nG28 Z5\nG91 G1 Z-7 F100\nG90\n", "unknown-way", 7),
        ("G0 X0 Y0\nG1 Z-1 F100\nG2 X10 I1000000000 J0\n", "arc-radius-mismatch", 7),
        ("G0 X0 Y0\nG1 Z-1 F200\nG2 X20 Y0 R8 F500\n", "arc-radius-too-small", 7),
        ("G0 X0 Y0\nG1 Z-1 F200\nG2 X20 Y0 I8 J0 F500\n", "arc-radius-mismatch", 7),
        ("G0 X0 Y0\nG1 Z-1 F200\nG2 X0 Y0 R8 F500\n", "arc-radius-closed", 7),
        ("G0 X0 Y0\nG1 Z-2\nG1 X30\n", "no-feed", 6),
        ("G4\nG0 X0 Y0\nG1 Z-2 F100\n", "dwell-without-time", 5),
    ] {
        let (json, status) = Bench::new(program).json();
        assert_eq!((status, &json["clean"]), (Some(1), &Value::from(false)), "{program}: {json}");
        let findings = json["findings"].as_array().unwrap();
        assert_eq!(findings[0]["rule"], rule, "{program}: {findings:?}");
        assert_eq!(findings[0]["line"], line, "{program}: {findings:?}");
    }
}

#[test]
fn a_finding_about_the_text_stands_in_the_words_too() {
    let output = Bench::new("G0 X0 Y0\nG1 Z-2\n").run(&["--tool", "0=flat 3mm"]);
    assert_eq!(output.status.code(), Some(1));
    let text = said(&output);
    assert!(text.contains("FOUND       line 6: Motion at a feed without an F") && text.contains("a guess"), "{text}");
    assert!(!text.contains("nothing"), "{text}");
}

#[test]
fn what_is_the_same_on_any_machine_is_clean() {
    for program in [
        // One system throughout, whichever; its own origin; ways home from above the stock.
        "G54\nG0 X10 Y10\nG1 Z-1 F100\n",
        "G0 X10 Y10\nG1 Z-1 F100\nG0 Z5\nG28\n",
        "G0 X10 Y10\nG1 Z-1 F100\nG91 G28 Z0\nG90\nG0 X0 Y0\n",
        "G0 X10 Y10\nG1 Z-1 F100\nG0 Z5\nG53 G0 X0 Y0\nG53 G0 Z0\n",
        "G53 G0 Z0\nG0 X10 Y10\nG1 Z-1 F100\n",
        "G28\nG0 Z5\nG0 X10 Y10\nG1 Z-1 F100\n",
    ] {
        let (json, status) = Bench::new(program).json();
        assert_eq!(status, Some(0), "{program}: {json}");
    }
    let (json, status) =
        Bench::whole("G21 G90 G17 G94 G55\nG0 Z5\nM3 S9000\nG4 P1\nG0 X1\nG1 Z-1 F90\nG0 Z5\nM5\nM2\n").json();
    assert_eq!(status, Some(0), "{json}");
}

#[test]
fn a_program_without_motions_is_told_so() {
    for text in ["", "%\n%\n", "(nothing)\nG21\nM2\n"] {
        let output = Bench::whole(text).run(&["--tool", "0=flat 3mm"]);
        assert_eq!(output.status.code(), Some(2), "{text:?}: {}", said(&output));
        assert!(said(&output).contains("nothing moves"), "{text:?}: {}", said(&output));
    }
}

/// A sheet with two parts, the second at 60 mm, and a hole of 3 mm in the first.
const DRAWING: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="60mm" viewBox="0 0 100 60">
    <path fill-rule="evenodd" d="M0 20H40V60H0Z M60 20H100V60H60Z M22 40A2 2 0 1 0 18 40A2 2 0 1 0 22 40Z"/></svg>"#;

/// Around a square of 40 mm with a tool of 3 mm, down to z.
fn around(x: f64, z: f64) -> String {
    let (left, right) = (x - 1.5, x + 41.5);
    format!("G0 X{left} Y-1.5\nG1 Z{z} F200\nG1 X{right} F600\nG1 Y41.5\nG1 X{left}\nG1 Y-1.5\nG0 Z5\n")
}

const HOLE: &str = "G0 X20.5 Y20\nG1 Z-2 F200\nG3 X20.5 Y20 I-0.5 J0 F600\nG0 Z5\n";

#[test]
fn a_part_that_is_not_finished_fails() {
    let run = |program: &str| {
        let bench = Bench::new(program);
        fs::write(bench.path("part.svg"), DRAWING).unwrap();
        let output = bench.run(&["--tool", "0=flat 3mm", "--against", "part.svg"]);
        (output.status.code(), said(&output))
    };
    let (first, second) = (around(0.0, -2.0), around(60.0, -2.0));
    let (status, text) = run(&format!("{HOLE}{first}{second}"));
    assert_eq!(status, Some(0), "{text}");
    assert!(text.contains("found       nothing") && !text.contains("NOT CUT"), "{text}");
    for (program, words) in [
        (
            format!("{HOLE}{first}"),
            "the outline around (80.000, 20.000), 160.0 mm long, is cut nowhere down to z -2.000",
        ),
        (format!("{first}{second}"), "the outline around (20.000, 20.000), 12.6 mm long, is cut nowhere"),
        (format!("{HOLE}{first}{}", around(60.0, -1.0)), "the outline around (80.000, 20.000)"),
        (format!("{HOLE}{first}{}", second.split("G1 X58.5").next().unwrap()), "of an outline, at (71."),
    ] {
        let (status, text) = run(&program);
        assert_eq!(status, Some(1), "{program}:\n{text}");
        assert!(text.contains(words) && !text.contains("nothing"), "{words}:\n{text}");
    }
}

#[test]
fn cells_that_do_not_show_the_tool_are_refused() {
    let bench = Bench::new("G0 X0 Y0\nG1 Z-1 F200\nG1 X20\n");
    for cell in ["1e9mm", "0.8mm"] {
        let output = bench.run(&["--tool", "0=flat 3mm", "--cell", cell]);
        assert_eq!(output.status.code(), Some(2), "{cell}: {}", said(&output));
        assert!(said(&output).contains("a quarter of it, 0.75 mm"), "{}", said(&output));
    }
    assert_eq!(bench.run(&["--tool", "0=flat 3mm", "--cell", "0.75mm"]).status.code(), Some(0));
    let mut command = Command::cargo_bin("clopen").unwrap();
    let far = format!("{HEAD}G0 X1000000000 Y10\nG1 Z-1 F100\nX-1000000000\n{END}");
    let output = command.args(["simulate", "-", "--tool", "0=flat 3mm"]).write_stdin(far).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("--stock"), "{}", said(&output));
}

#[test]
fn a_tool_of_another_number_is_not_taken_and_told() {
    let bench = Bench::new("(tool diameter 3 mm)\nG0 X0 Y0\nG1 Z-1 F200\nG1 X20\n");
    let output = bench.run(&["--tool", "5=flat 6mm"]);
    let text = said(&output);
    assert_eq!(output.status.code(), Some(0), "{text}");
    assert!(text.contains("tool        0: flat 3 mm") && text.contains("the program has no tool 5"), "{text}");
    let unknown = Bench::new("G0 X0 Y0\nG1 Z-1 F200\n").run(&["--tool", "5=flat 6mm"]);
    assert_eq!(unknown.status.code(), Some(2), "{}", said(&unknown));
}

#[test]
fn drilled_holes_are_simulated() {
    let (json, status) = Bench::new("G0 X0 Y0\nG99 G83 X10 Y10 Z-3 R1 Q1 F100\nX20\nG80\n").json();
    assert_eq!(status, Some(0), "{json}");
    let removed = json["removed_mm3"].as_f64().unwrap();
    let volume = 2.0 * 3.0 * std::f64::consts::PI * 1.5 * 1.5;
    assert!((removed / volume - 1.0).abs() < 0.01, "{removed} against {volume}");
}
