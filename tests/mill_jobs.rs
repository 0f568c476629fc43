//! Jobs with operations: the whole command, and the programs that it writes held against their own simulation.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::Command;
use serde_json::Value;

fn jobs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/jobs")
}

fn clopen(folder: &Path, arguments: &[&str]) -> Output {
    Command::cargo_bin("clopen").unwrap().current_dir(folder).args(arguments).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// The report of a sample job, and the folder with its programs.
fn sample(name: &str, more: &[&str]) -> (Value, tempfile::TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let path = |end: &str| jobs().join(format!("{name}.{end}")).to_string_lossy().into_owned();
    let (svg, job) = (path("svg"), path("toml"));
    let arguments = [&["mill", &svg, "--job", &job, "-o", "job.nc", "--format", "json"], more].concat();
    let output = clopen(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    (serde_json::from_slice(&output.stdout).unwrap(), folder)
}

fn programs(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let mut found: Vec<PathBuf> = entries.filter(|p| p.extension().is_some_and(|e| e == "nc")).collect();
    found.sort();
    found
}

#[test]
fn every_sample_job_does_all_that_it_asks_for_and_no_rapid_meets_material() {
    for name in ["bracket", "sign", "pair"] {
        let (report, folder) = sample(name, &["--no-preview"]);
        for operation in report["operations"].as_array().unwrap() {
            let check = &operation["check"];
            let label = check["label"].as_str().unwrap();
            for count in ["tabs", "holes"] {
                assert_eq!(check[count][0], check[count][1], "{name} {label}");
            }
            assert!(check["gouge"]["depth_mm"].as_f64().unwrap_or(0.0) <= 0.002, "{name} {label}");
            assert!(check["islands"].as_array().unwrap().is_empty(), "{name} {label}");
        }
        // By code that shares nothing with the planner: the stock as a height map, motion by motion.
        for program in programs(folder.path()) {
            let file = program.file_name().unwrap().to_string_lossy().into_owned();
            let output = clopen(folder.path(), &["simulate", &file, "--spoil", "1", "--format", "json"]);
            let simulated: Value =
                serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{e}: {}", said(&output)));
            assert_eq!(output.status.code(), Some(0), "{name} {file}: {simulated}");
        }
    }
}

#[test]
fn a_bracket_of_everything_has_its_tabs_holes_and_passes() {
    let (report, _folder) = sample("bracket", &["--no-preview"]);
    let operation = |label: &str| {
        let all = report["operations"].as_array().unwrap();
        all.iter().map(|o| &o["check"]).find(|c| c["label"] == label).unwrap().clone()
    };
    assert_eq!(operation("bolt holes")["holes"][1], 5);
    assert_eq!(operation("cut out")["tabs"][1], 4);
    assert_eq!(operation("slot around a boss")["passes"][0], 2);
}

#[test]
fn a_machine_that_changes_tools_gets_one_program_and_flags_beat_the_file() {
    let (_, folder) = sample("bracket", &["--no-preview", "--dialect", "linuxcnc"]);
    let found = programs(folder.path());
    assert_eq!(found.len(), 1);
    let text = fs::read_to_string(&found[0]).unwrap();
    for words in ["T3 M6", "T1 M6", "\nG43\n", "(operation cut out)"] {
        assert!(text.contains(words), "{words}");
    }
}

#[test]
fn a_commented_job_file_is_written_for_a_drawing_and_is_a_job() {
    let folder = tempfile::tempdir().unwrap();
    let svg = jobs().join("pair.svg").to_string_lossy().into_owned();
    let output = clopen(folder.path(), &["mill", "--init", &svg]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("\"lower\"") && text.contains("\"upper\""), "{text}");
    fs::write(folder.path().join("job.toml"), text).unwrap();
    let output = clopen(folder.path(), &["mill", &svg, "--job", "job.toml", "-o", "x.nc", "--no-preview"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
}

#[test]
fn an_impossible_job_has_its_sentence_its_line_and_exit_status_2() {
    let folder = tempfile::tempdir().unwrap();
    let svg = jobs().join("pair.svg").to_string_lossy().into_owned();
    let good = fs::read_to_string(jobs().join("pair.toml")).unwrap();
    for (change, to, words) in [
        ("tool = 1\nthrough", "tool = 2\nthrough", "there is no tool 2"),
        ("through = true", "depth = -2", "depth is -2 mm"),
        ("depth-per-pass = 2", "depth-per-pass = 20", "deeper than the flutes"),
        ("onion-skin = 0.3", "tabs = { count = 2, height = 9 }", "higher than the cut is deep"),
        ("dialect = \"grbl\"", "dialect = \"gbrl\"", "grbl"),
        ("onion-skin", "onion-skins", "did you mean \"onion-skin\"?"),
        ("through = true", "through = true\nselect = { id = \"loewr\" }", "did you mean \"lower\"?"),
        ("diameter = 4", "diameter = 400", "too large"),
    ] {
        assert!(good.contains(change), "{change}");
        fs::write(folder.path().join("job.toml"), good.replacen(change, to, 1)).unwrap();
        let output = clopen(folder.path(), &["mill", &svg, "--job", "job.toml", "-o", "x.nc"]);
        let text = said(&output);
        assert_eq!(output.status.code(), Some(2), "{to}: {text}");
        assert!(text.contains(words), "{to}: {text}");
        assert!(text.contains("job.toml") || words == "grbl", "{to}: {text}");
        assert!(!folder.path().join("x.nc").exists());
    }
}
