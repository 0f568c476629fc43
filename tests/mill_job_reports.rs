//! What is told of jobs that can be done: notes, warnings, counts, and what is left to later operations.

use std::fs;

use assert_cmd::Command;
use serde_json::Value;

/// A plate with a neck that a tool of 3 mm does not fit into and one of 1.5 mm does.
const NECK: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40">
<path id="neck" d="M5 5H25V9H35V5H55V25H35V11H25V25H5Z"/>
<circle id="c" cx="30" cy="34" r="1.5"/>
</svg>"##;

const HEAD: &str = "version = 1
[stock]
thickness = 6
width = 60
height = 40
[machine]
dialect = \"grbl\"
[[tool]]
number = 1
diameter = 3
flute-length = 2
[[tool]]
number = 2
diameter = 1.5
depth-per-pass = 0.75
[[tool]]
number = 3
type = \"ball\"
diameter = 4
[[tool]]
number = 4
type = \"drill\"
diameter = 3
";

/// The text and the JSON of a job on `drawing`, and the exit status.
fn mill(drawing: &str, job: &str) -> (String, Value, Option<i32>) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.svg"), drawing).unwrap();
    fs::write(folder.path().join("job.toml"), job).unwrap();
    let run = |format: &str| {
        let arguments = ["mill", "a.svg", "--job", "job.toml", "-o", "x.nc", "--no-preview", "--format", format];
        Command::cargo_bin("clopen").unwrap().current_dir(folder.path()).args(arguments).output().unwrap()
    };
    let (text, json) = (run("text"), run("json"));
    let said = String::from_utf8_lossy(&text.stdout).into_owned() + &String::from_utf8_lossy(&text.stderr);
    let json = serde_json::from_slice(&json.stdout).unwrap_or_else(|e| panic!("{e}: {said}"));
    (said, json, text.status.code())
}

const COARSE: &str = "[[operation]]\nname = \"coarse\"\nkind = \"pocket\"\ntool = 1\ndepth = 2\npath-radius = 0\nselect = { id = \"neck\" }\n";
const FINE: &str = "[[operation]]\nname = \"fine\"\nkind = \"pocket\"\ntool = 2\ndepth = 2\npath-radius = 0\nselect = { id = \"neck\" }\nrest-of = 1\n";

#[test]
fn what_a_later_operation_cuts_is_no_failure() {
    let (text, _, code) = mill(NECK, &format!("{HEAD}{COARSE}"));
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("FAILED  coarse"), "{text}");
    let (text, json, code) = mill(NECK, &format!("{HEAD}{COARSE}{FINE}"));
    assert_eq!(code, Some(0), "{text}");
    assert_eq!(json["good"], true);
    assert!(text.contains("that is left to \"fine\""), "{text}");
    // What is too narrow for the smaller tool as well is one.
    let narrow = NECK.replace("V11", "V10.2");
    let (text, json, code) = mill(&narrow, &format!("{HEAD}{COARSE}{FINE}"));
    assert_eq!((code, &json["good"]), (Some(1), &Value::Bool(false)), "{text}");
    assert!(text.contains("FAILED  fine"), "{text}");
}

#[test]
fn the_corners_of_a_pocket_are_noted_and_passes_are_those_that_were_asked_for() {
    let plain = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"20mm\" height=\"20mm\" viewBox=\"0 0 20 20\">\
                 <rect id=\"neck\" x=\"2\" y=\"2\" width=\"16\" height=\"16\"/></svg>";
    let allowance = COARSE.replace("depth = 2", "depth = 2\nallowance = 0.2");
    let (text, json, code) = mill(plain, &format!("{HEAD}{allowance}"));
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("mm² standing in the corners of the pocket in 4 places"), "{text}");
    let asked = json["operations"][0]["check"]["passes"][0].as_u64().unwrap();
    assert_eq!(asked, 2);
    let notes = json["operations"][0]["notes"].to_string();
    assert!(notes.contains("corners of the pocket"), "{notes}");
    let row = text.lines().find(|l| l.starts_with("coarse")).unwrap();
    assert_eq!(row.split_whitespace().nth(2), Some("2"), "{row}");
    let drilled = "[[operation]]\nkind = \"drill\"\ntool = 4\nselect = { id = \"c\" }\nthrough = true\n";
    let (text, _, _) = mill(NECK, &format!("{HEAD}{drilled}"));
    let row = text.lines().find(|l| l.starts_with("drill 1")).unwrap();
    assert_eq!(row.split_whitespace().nth(3), Some("-"), "{row}");
}

#[test]
fn what_is_unusual_is_warned_of() {
    let profile = |more: &str| format!("{HEAD}[[operation]]\nkind = \"profile\"\nselect = {{ id = \"neck\" }}\n{more}");
    for (job, words) in [
        (profile("tool = 1\ndepth = 3\n"), "it cuts 3.000 mm deep in all, and the flutes of tool 1 are 2 mm long"),
        (profile("tool = 3\ndepth = 1\n"), "a fillet of 2 mm at the foot of the wall"),
        (
            format!("{HEAD}[[operation]]\nkind = \"facing\"\ntool = 3\ndepth = 0.5\nstepover = 2\n"),
            "ridges 0.268 mm high",
        ),
        (
            profile("tool = 2\ndepth = 1\n").replace("width = 60", "width = 45"),
            "beyond the edge of the stock, 45 x 40 mm",
        ),
    ] {
        let (text, json, _) = mill(NECK, &job);
        assert!(text.contains(words), "{words}: {text}");
        assert!(json["warnings"].to_string().contains(words), "{words}");
    }
    let (text, _, _) = mill(NECK, &profile("tool = 1\ndepth = 2\n"));
    assert!(!text.contains("flutes") && !text.contains("edge of the stock"), "{text}");
}

#[test]
fn a_size_without_a_unit_is_noted() {
    let drill = "[[operation]]\nkind = \"drill\"\ntool = 2\ndepth = 1\nselect = { id = \"c\" }\n";
    let plain = NECK.replace("60mm", "60").replace("40mm", "40").replace("r=\"1.5\"", "r=\"12\"");
    let (text, ..) = mill(&plain, &format!("{HEAD}{drill}"));
    assert!(text.contains("taken for 1/96 inch each: --dpi 25.4"), "{text}");
    let (text, ..) = mill(NECK, &format!("{HEAD}{drill}"));
    assert!(!text.contains("1/96"), "{text}");
}

#[test]
fn sorting_by_tool_keeps_a_rest_behind_what_it_rests_on() {
    let first = "[[operation]]\nname = \"first\"\nkind = \"drill\"\ntool = 2\ndepth = 1\nselect = { id = \"c\" }\n";
    let (text, json, code) = mill(NECK, &format!("sort-by-tool = true\n{HEAD}{first}{COARSE}{FINE}"));
    assert_eq!(code, Some(0), "{text}");
    let labels: Vec<&str> =
        json["operations"].as_array().unwrap().iter().map(|o| o["check"]["label"].as_str().unwrap()).collect();
    assert_eq!(labels, ["first", "coarse", "fine"]);
}

#[test]
fn shapes_that_lie_wholly_on_others_are_told() {
    let drawing = r##"<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40">
<rect x="5" y="5" width="40" height="30"/><circle id="white" cx="20" cy="20" r="5" fill="#fff"/></svg>"##;
    let job = format!("{HEAD}[[operation]]\nkind = \"profile\"\ntool = 2\ndepth = 1\n");
    let (text, _, code) = mill(drawing, &job);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("the shape around (15.000, 15.000) lies wholly on another one"), "{text}");
    let (text, _, code) = mill(drawing, &format!("{job}select = {{ order = [1] }}\n"));
    assert!(code == Some(0) && !text.contains("wholly"), "{text}");
}

#[test]
fn a_stroked_circle_in_a_stroked_rectangle_is_a_hole() {
    let drawing = r##"<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40">
<g fill="none" stroke="#000"><rect x="5" y="5" width="40" height="30"/><circle cx="20" cy="20" r="5"/></g></svg>"##;
    let job = format!("{HEAD}[[operation]]\nkind = \"profile\"\ntool = 2\ndepth = 0.75\nentry = \"plunge\"\n");
    let (text, json, code) = mill(drawing, &job);
    assert_eq!(code, Some(0), "{text}");
    // Both outlines: around the plate, 1.5 mm longer on every side, and inside of the hole.
    let cut =
        json["operations"][0]["check"]["statistics"]["cut_length_mm"].as_f64().unwrap_or_else(|| panic!("{json}"));
    // The tool comes down twice, from 1 mm above.
    let expected = 140.0 + std::f64::consts::TAU * (0.75 + 4.25) + 2.0 * 1.75;
    assert!((cut - expected).abs() < 0.1, "{cut} of {expected}");
}
