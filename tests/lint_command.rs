//! `clopen lint` from the outside.

use std::fs;
use std::path::Path;
use std::process::Output;

use serde_json::Value;

const GOOD: &str = "G21\nG17 G90 G94\nG0 Z5\nM3 S10000\nG4 P2\nG0 X0 Y0\nG1 Z-1 F100\nG1 X5 F500\nG0 Z5\nM5\nM30\n";

fn lint(folder: &Path, arguments: &[&str]) -> Output {
    assert_cmd::Command::cargo_bin("clopen").unwrap().current_dir(folder).arg("lint").args(arguments).output().unwrap()
}

fn said(output: &Output) -> (String, String) {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (text(&output.stdout), text(&output.stderr))
}

#[test]
fn clean_is_0_findings_are_1_and_what_cannot_run_is_2() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("good.nc"), GOOD).unwrap();
    // A warning alone is a finding too.
    fs::write(dir.path().join("hasty.nc"), GOOD.replace("G4 P2\n", "")).unwrap();
    let status = |arguments: &[&str]| lint(dir.path(), arguments).status.code();
    assert_eq!(status(&["good.nc"]), Some(0));
    assert_eq!(status(&["hasty.nc"]), Some(1));
    assert_eq!(status(&["hasty.nc", "--allow", "no-dwell"]), Some(0));
    assert_eq!(status(&["hasty.nc", "--allow", "low-travel"]), Some(1));
    assert_eq!(status(&["missing.nc"]), Some(2));
    assert_eq!(status(&[]), Some(2));
    let (_, words) = said(&lint(dir.path(), &["hasty.nc", "--allow", "nodwell"]));
    assert!(words.contains("do you mean no-dwell?") && words.contains("--rules"), "{words}");
    let (found, _) = said(&lint(dir.path(), &["hasty.nc"]));
    assert_eq!(
        found,
        "hasty.nc:6: warning: Cutting before the spindle had time to start: no G4 after M3 or M4. [no-dwell; grbl 1373, \
         gnea/grbl 701 730, pcb2gcode 85]\n"
    );
}

#[test]
fn the_dialect_is_a_name_or_a_file() {
    let dir = tempfile::tempdir().unwrap();
    let changing = GOOD.replace("M3", "T2 M6\nG0 Z5\nM3");
    fs::write(dir.path().join("part.nc"), changing).unwrap();
    fs::write(dir.path().join("shed.toml"), "base = \"grbl\"\ncodes = [\"G0-G99\", \"M0-M30\"]\n").unwrap();
    fs::write(dir.path().join("slip.toml"), "base = \"grbl\"\nlongest-lime = 3\n").unwrap();
    fs::write(dir.path().join("base.toml"), "base = \"grlb\"\n").unwrap();
    let run = |dialect: &str| lint(dir.path(), &["part.nc", "--dialect", dialect]);
    assert_eq!(run("grbl").status.code(), Some(1));
    assert_eq!(run("FluidNC").status.code(), Some(0));
    assert_eq!(run("shed.toml").status.code(), Some(0));
    for (dialect, words) in [
        ("gbrl", "do you mean grbl?"),
        ("slip.toml", "longest-lime"),
        ("base.toml", "do you mean grbl?"),
        ("no.toml", "no.toml"),
    ] {
        let output = run(dialect);
        assert_eq!(output.status.code(), Some(2), "{dialect}");
        let (_, text) = said(&output);
        assert!(text.contains(words) && text.contains(dialect), "{dialect}: {text}");
    }
}

#[test]
fn json_has_every_finding_with_its_source() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("part.nc"), GOOD.replace(" F100", "")).unwrap();
    let output = lint(dir.path(), &["part.nc", "--format", "json", "--dialect", "grbl"]);
    let findings: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(findings.as_array().unwrap().len(), 1);
    let finding = &findings[0];
    assert_eq!((&finding["line"], &finding["rule"]), (&Value::from(7), &Value::from("no-feed")));
    assert_eq!((&finding["severity"], &finding["source"]), (&Value::from("error"), &Value::from("grbl: error 22")));
    assert!(finding["message"].as_str().unwrap().contains("without an F"));
}

#[test]
fn the_rules_are_a_table() {
    let dir = tempfile::tempdir().unwrap();
    let output = lint(dir.path(), &["--rules"]);
    assert_eq!(output.status.code(), Some(0));
    let (text, _) = said(&output);
    for words in ["no-feed", "grbl (error 22)", "linuxcnc (refused)", "rapid-plunge", "source: FreeCAD 8140", "warning"]
    {
        assert!(text.contains(words), "{words} is missing in\n{text}");
    }
    let output = lint(dir.path(), &["--rules", "--format", "json", "--dialect", "grbl"]);
    let rules: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(rules.as_array().unwrap().len(), clopen::gcode::RULES.len());
    let no_feed = rules.as_array().unwrap().iter().find(|r| r["rule"] == "no-feed").unwrap();
    assert_eq!(no_feed["refused_by"]["grbl"], "error 22");
    assert_eq!(no_feed["refused_by"].as_object().unwrap().len(), 1);
}
