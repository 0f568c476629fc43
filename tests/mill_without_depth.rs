//! Beams and pens: the certificate knows when they work, though their programs have no depth.

use std::fs;
use std::process::Output;

use assert_cmd::Command;

const DRAWING: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"60mm\" height=\"60mm\" viewBox=\"0 0 60 60\">\
                       <rect id=\"a\" x=\"10\" y=\"10\" width=\"40\" height=\"30\"/></svg>";

fn mill(job: Option<&str>, more: &[&str]) -> (String, String, Option<i32>) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.svg"), DRAWING).unwrap();
    let mut arguments = vec!["mill", "a.svg", "-o", "x.nc", "--no-preview"];
    if let Some(job) = job {
        fs::write(folder.path().join("job.toml"), job).unwrap();
        arguments.extend(["--job", "job.toml"]);
    }
    arguments.extend(more);
    let run = Command::cargo_bin("clopen").unwrap().current_dir(folder.path()).args(arguments).output();
    let Output { status, stdout, stderr } = run.unwrap();
    let said = String::from_utf8_lossy(&stdout).into_owned() + &String::from_utf8_lossy(&stderr);
    (said, fs::read_to_string(folder.path().join("x.nc")).unwrap_or_default(), status.code())
}

fn job(dialect: &str, operation: &str) -> String {
    format!(
        "version = 1\n[stock]\nthickness = 3\n[machine]\ndialect = \"{dialect}\"\n[[tool]]\nnumber = 1\ndiameter = 0.2\n\
         spindle-speed = 800\ndepth-per-pass = 1\n[[operation]]\n{operation}\ntool = 1\n"
    )
}

#[test]
fn a_beam_that_goes_around_once_a_pass_cuts_free() {
    let (text, program, code) = mill(Some(&job("grbl-laser", "kind = \"profile\"\nthrough = true")), &[]);
    assert_eq!(code, Some(0), "{text}");
    // 3.2 mm in passes of 1 mm at most: four laps of 40 x 30 and the beam beside them.
    let row: Vec<&str> = text.lines().find(|l| l.starts_with("profile 1")).unwrap().split_whitespace().collect();
    assert_eq!(row[3], "4", "{text}");
    let length: f64 = row[4].parse().unwrap();
    assert!((length - 4.0 * 140.6).abs() < 4.0, "{text}");
    // 800 is the power for a whole millimetre; each of the passes takes 0.8.
    assert!(program.contains("M4 S640") && !program.contains('Z'), "{program}");
    let (text, _, code) =
        mill(None, &["--dialect", "grbl-laser", "--tool-diameter", "0.2mm", "--spindle-speed", "800"]);
    assert_eq!(code, Some(0), "{text}");
}

#[test]
fn a_pen_draws_what_it_was_asked_to() {
    for dialect in ["plotter", "plotter-servo"] {
        let (text, _, code) = mill(Some(&job(dialect, "kind = \"engrave\"\ndepth = 0.5")), &[]);
        assert_eq!(code, Some(0), "{dialect}: {text}");
        let row: Vec<&str> = text.lines().find(|l| l.starts_with("engrave 1")).unwrap().split_whitespace().collect();
        let length: f64 = row[4].parse().unwrap();
        assert!((length - 140.0).abs() < 1.0, "{dialect}: {text}");
    }
}

#[test]
fn tabs_that_a_beam_would_cut_are_told() {
    let operation = "kind = \"profile\"\nthrough = true\ntabs = { count = 2 }";
    let (text, _, code) = mill(Some(&job("grbl-laser", operation)), &[]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("2 tabs were asked for"), "{text}");
}

#[test]
fn beams_and_pens_have_defaults_of_their_own() {
    let (text, program, code) = mill(None, &["--dialect", "grbl-laser"]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("0.200 mm, path radius"), "{text}");
    assert!(text.contains("in 3 passes"), "{text}");
    assert!(program.contains("M4 S1000"), "{program}");
    let (text, _, code) = mill(None, &["--dialect", "plotter"]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("0.500 mm, path radius"), "{text}");
    let plain = job("grbl-laser", "kind = \"profile\"\nthrough = true").replace("spindle-speed = 800\n", "");
    let (text, program, code) = mill(Some(&plain), &[]);
    assert_eq!(code, Some(0), "{text}");
    assert!(program.contains("M4 S800"), "{program}");
    assert!(!text.contains("a tooth"), "{text}");
}

#[test]
fn the_power_of_a_beam_follows_the_depth() {
    let power = |depth: f64| {
        let engraving = format!("kind = \"engrave\"\ndepth = {depth}");
        let (text, program, code) = mill(Some(&job("grbl-laser", &engraving)), &[]);
        assert_eq!(code, Some(0), "{text}");
        let s = program.lines().find_map(|l| l.strip_prefix("M4 S").map(str::to_owned));
        s.unwrap_or_else(|| panic!("no power: {program}")).parse::<f64>().unwrap()
    };
    assert_eq!([power(1.0), power(0.5), power(0.25)], [800.0, 400.0, 200.0]);
    // Two laps of 0.75.
    assert_eq!(power(1.5), 600.0);
    let (text, program, _) = mill(None, &["--dialect", "grbl-laser", "--spindle-speed", "800", "--depth", "0.5mm"]);
    assert!(program.contains("M4 S400"), "{text}{program}");
}
