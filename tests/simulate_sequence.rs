//! Programs of a job, one a tool, run one after the other on the same stock.

use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use serde_json::Value;

const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40">
<rect id="plate" x="5" y="5" width="50" height="30"/>
<circle id="hole" cx="30" cy="20" r="1.5"/>
</svg>"##;

const JOB: &str = "version = 1
[stock]
thickness = 6
[machine]
dialect = \"grbl\"
[[tool]]
number = 1
diameter = 6
depth-per-pass = 2
[[tool]]
number = 2
type = \"drill\"
diameter = 3
[[operation]]
name = \"drill\"
kind = \"drill\"
tool = 2
depth = 5
select = { id = \"hole\" }
[[operation]]
name = \"around\"
kind = \"profile\"
tool = 1
depth = 5
select = { id = \"plate\" }
";

fn clopen(folder: &Path, arguments: &[&str]) -> Output {
    Command::cargo_bin("clopen").unwrap().current_dir(folder).args(arguments).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// A folder with `x-1-t2.nc`, which drills, and `x-2-t1.nc`, which cuts around.
fn programs() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.svg"), DRAWING).unwrap();
    fs::write(folder.path().join("job.toml"), JOB).unwrap();
    let made = clopen(folder.path(), &["mill", "a.svg", "--job", "job.toml", "-o", "x.nc", "--no-preview"]);
    assert_eq!(made.status.code(), Some(0), "{}", said(&made));
    folder
}

const STOCK: [&str; 4] = ["--stock", "80x60x6mm", "--stock-at", "-15,-15"];

#[test]
fn the_second_program_finds_what_the_first_has_left() {
    let folder = programs();
    let simulate = |files: &[&str]| {
        let more = ["--cell", "0.075mm", "--format", "json"];
        let output = clopen(folder.path(), &[&["simulate"], files, &STOCK, &more].concat());
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        serde_json::from_slice::<Value>(&output.stdout).unwrap()
    };
    let both = simulate(&["x-1-t2.nc", "x-2-t1.nc"]);
    let alone = [simulate(&["x-1-t2.nc"]), simulate(&["x-2-t1.nc"])];
    let removed = |json: &Value| json["removed_mm3"].as_f64().unwrap();
    assert!(removed(&alone[0]) > 20.0);
    assert!((removed(&both) - removed(&alone[0]) - removed(&alone[1])).abs() < 1e-2 * removed(&alone[0]), "{both}");
    let numbers: Vec<_> = both["tools"].as_array().unwrap().iter().map(|t| t["number"].as_u64().unwrap()).collect();
    assert_eq!(numbers, [1, 2]);
    let names: Vec<_> = both["operations"].as_array().unwrap().iter().map(|o| o["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["drill", "around"]);
    let first = fs::read_to_string(folder.path().join("x-1-t2.nc")).unwrap().lines().count();
    assert_eq!(both["programs"][1]["lines_before"].as_u64().unwrap() as usize, first);
}

#[test]
fn what_goes_wrong_is_told_with_its_program_and_the_line_there() {
    let folder = programs();
    let place = folder.path().join("x-2-t1.nc");
    let text = fs::read_to_string(&place).unwrap();
    let at = text.lines().position(|l| l.starts_with("M5")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let wrong = [&lines[..at], &["G0 X25 Y15", "G0 Z-1", "G0 Z5"], &lines[at..]].concat().join("\n") + "\n";
    fs::write(&place, wrong).unwrap();
    let output = clopen(folder.path(), &[&["simulate", "x-1-t2.nc", "x-2-t1.nc"][..], &STOCK].concat());
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(said(&output).contains(&format!("x-2-t1.nc: line {}", at + 2)), "{}", said(&output));
}

#[test]
fn only_one_program_comes_through_a_pipe() {
    let folder = programs();
    let output = clopen(folder.path(), &["simulate", "-", "-"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("standard input"), "{}", said(&output));
}
