//! What would do harm at the machine is told, or not written at all.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

const PLATE: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40">
<rect id="plate" x="5" y="5" width="50" height="30" fill="#f00"/>
<circle id="hole" cx="30" cy="20" r="5" fill="#00f"/>
</svg>"##;

const HEAD: &str = "version = 1
[stock]
thickness = 6
[machine]
dialect = \"grbl\"
[[tool]]
number = 1
diameter = 3
depth-per-pass = 2
";

const AROUND: &str = "[[operation]]\nname = \"around\"\nkind = \"profile\"\ntool = 1\nthrough = true\npath-radius = 0\nselect = { id = \"plate\" }\n";
const HOLE: &str =
    "[[operation]]\nname = \"bore\"\nkind = \"drill\"\ntool = 1\nthrough = true\nselect = { id = \"hole\" }\n";
const TABS: &str = "tabs = { count = 4, width = 4, height = 1.5 }\n";

/// What the command says and its exit status.
fn clopen(folder: &Path, arguments: &[&str]) -> (String, Option<i32>) {
    let output = Command::cargo_bin("clopen").unwrap().current_dir(folder).args(arguments).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    (said, output.status.code())
}

/// A folder with `a.svg` and `job.toml`.
fn folder(drawing: &str, job: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.svg"), drawing).unwrap();
    fs::write(folder.path().join("job.toml"), job).unwrap();
    folder
}

fn mill(job: &str, more: &[&str]) -> (String, Option<i32>) {
    let arguments = ["mill", "a.svg", "--job", "job.toml", "-o", "x.nc", "--no-preview"];
    clopen(folder(PLATE, job).path(), &[&arguments, more].concat())
}

#[test]
fn a_part_that_is_cut_free_before_its_holes_are_made_fails() {
    let (text, code) = mill(&format!("{HEAD}{HOLE}{AROUND}"), &[]);
    assert_eq!(code, Some(0), "{text}");
    let late = format!("{HEAD}{AROUND}{HOLE}");
    let (text, code) = mill(&late, &[]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("FAILED  operation \"around\" cuts the part free before \"bore\" works on it"), "{text}");
    let (text, _) = mill(&late, &["--format", "json"]);
    let json: Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&json["good"], json["out_of_order"].as_array().unwrap().len()), (&Value::Bool(false), 1), "{text}");
    // What tape or a vacuum holds, the user knows; what hangs on tabs does not come off.
    let (text, code) = mill(&late, &["--accept-losses"]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("note    operation \"around\" cuts the part free"), "{text}");
    let (text, code) = mill(&format!("{HEAD}{AROUND}{TABS}{HOLE}"), &[]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("note    operation \"around\" leaves the part on its tabs before \"bore\""), "{text}");
    // A skin is cut with its operation.
    let (text, code) = mill(&format!("{HEAD}{AROUND}onion-skin = 0.4\n{HOLE}"), &[]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("cuts the last skin below the part before \"bore\""), "{text}");
    // A cut that leaves a floor frees nothing.
    let shallow = AROUND.replace("through = true", "depth = 3");
    let (text, code) = mill(&format!("{HEAD}{shallow}{HOLE}"), &[]);
    assert_eq!(code, Some(0), "{text}");
    assert!(!text.contains("works on it"), "{text}");
}

#[test]
fn a_clamp_as_high_as_the_travel_is_told() {
    let job =
        |top: &str| format!("{HEAD}{HOLE}[[keepout]]\nx = [50, 60]\ny = [30, 40]\n{top}").replace("[[op", "\n[[op");
    let (text, code) = mill(&job("top = 12\n"), &[]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("keepout 1 is as high as the tool travels"), "{text}");
    let (text, code) = mill(&job("top = 1\n"), &[]);
    assert_eq!(code, Some(0), "{text}");
    assert!(!text.contains("keepout 1"), "{text}");
}

/// An L with a window near its edge: the tool fits nowhere between them, and each is to be kept for itself.
const WINDOW: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="60mm" viewBox="0 0 60 60">
<path id="a" fill-rule="evenodd" d="M10 10H50V28H30V50H10ZM20 14.2H26V18H20Z"/></svg>"##;

#[test]
fn a_program_that_would_cut_into_the_part_is_not_written() {
    let operation = "[[operation]]\nkind = \"pocket\"\ntool = 1\ndepth = 1\ntopology = \"keep\"\n";
    let head = HEAD.replace("diameter = 3", "diameter = 6");
    let arguments = ["mill", "a.svg", "--job", "job.toml", "-o", "x.nc"];
    let keep = folder(WINDOW, &format!("{head}{operation}"));
    let (text, code) = clopen(keep.path(), &arguments);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("into what must remain: topology = \"merge\" leaves out"), "{text}");
    assert!(text.contains("NOT WRITTEN"), "{text}");
    assert!(!keep.path().join("x.nc").exists(), "the program");
    assert!(keep.path().join("x.png").exists(), "the picture that shows why");
    let (text, _) = clopen(keep.path(), &[&arguments[..], &["--format", "json"]].concat());
    assert_eq!(serde_json::from_str::<Value>(&text).unwrap()["withheld"], true, "{text}");
    let merge = folder(WINDOW, &format!("{head}{operation}").replace("keep", "merge"));
    let (text, _) = clopen(merge.path(), &arguments);
    assert!(merge.path().join("x.nc").exists(), "{text}");
    assert!(!text.contains("NOT WRITTEN"), "{text}");
}

#[test]
fn pictures_of_jobs_show_the_drawing_and_what_is_cut() {
    let place = folder(PLATE, &format!("{HEAD}{HOLE}{AROUND}"));
    let (text, code) = clopen(place.path(), &["mill", "a.svg", "--job", "job.toml", "-o", "x.nc"]);
    assert_eq!(code, Some(0), "{text}");
    let picture = tiny_skia::Pixmap::decode_png(&fs::read(place.path().join("x.png")).unwrap()).unwrap();
    let colours: BTreeSet<[u8; 3]> = picture.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]).collect();
    for (what, colour) in [("drawing", [250, 236, 209]), ("cut", [233, 238, 243])] {
        assert!(colours.contains(&colour), "nothing in the colour of the {what}");
    }
}

#[test]
fn programs_of_lasers_are_simulated_through_the_stock() {
    // Twice around a square, by the power of a beam and without a Z.
    let square = "X20 Y0\nX20 Y20\nX0 Y20\nX0 Y0\n";
    let program = format!("G21 G90 G17 G94\nM4 S0\nG0 X0 Y0\nG1 F1000 S800\n{square}M5\nM2\n");
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("x.nc"), program).unwrap();
    let simulate = |more: &[&str]| {
        let arguments = ["simulate", "x.nc", "--tool", "0=flat 0.2mm", "--cell", "0.05mm", "--format", "json"];
        clopen(place.path(), &[&arguments, more].concat())
    };
    let (text, code) = simulate(&["--dialect", "grbl-laser", "--stock", "30x30x4mm", "--stock-at", "-5,-5"]);
    assert_eq!(code, Some(0), "{text}");
    let json: Value = serde_json::from_str(&text).unwrap();
    let removed = json["removed_mm3"].as_f64().unwrap_or_else(|| panic!("{text}"));
    assert!((removed / (80.0 * 0.2 * 4.0) - 1.0).abs() < 0.3, "{removed}");
    // As a program of a router it cuts nothing.
    let (text, code) = simulate(&[]);
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("nothing goes below"), "{text}");
}
