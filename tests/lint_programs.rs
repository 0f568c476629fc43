//! The linter on a folder of good and a folder of bad programs, and against LinuxCNC's interpreter.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use clopen::gcode::{Controller, LintOptions, RULES, lint};

fn programs(folder: &str) -> Vec<(String, PathBuf, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/programs").join(folder);
    let mut programs: Vec<_> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "nc"))
        .map(|path| {
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            let text = std::fs::read_to_string(&path).unwrap();
            (name, path, text)
        })
        .collect();
    programs.sort();
    assert!(!programs.is_empty(), "{} holds no programs", folder.display());
    programs
}

#[test]
fn good_programs_have_no_findings() {
    for (name, _, text) in programs("good") {
        assert_eq!(lint(&text, &LintOptions::default()), [], "{name}");
    }
}

#[test]
fn bad_programs_break_the_rule_they_are_named_after() {
    let mut tested = BTreeSet::new();
    for (name, _, text) in programs("bad") {
        let rule_name = name.split("--").next().unwrap();
        let info = RULES.iter().find(|r| r.name == rule_name).unwrap_or_else(|| panic!("{name} is no rule"));
        let findings = lint(&text, &LintOptions::default());
        assert!(findings.iter().any(|f| f.rule == info.rule && f.severity == info.severity), "{name}: {findings:#?}");
        tested.insert(info.rule);
    }
    let untested: Vec<_> = RULES.iter().filter(|r| !tested.contains(&r.rule)).map(|r| r.name).collect();
    assert!(untested.is_empty(), "no program breaks {untested:?}");
}

/// Warnings of our own leave a program usable: both controllers take it.
#[test]
fn a_controller_is_asked_for_its_own_rules_only() {
    for (name, _, text) in programs("bad") {
        let rule_name = name.split("--").next().unwrap();
        let info = RULES.iter().find(|r| r.name == rule_name).unwrap();
        let has = |controller| {
            let options = LintOptions { controller, stock_top: 0.0 };
            lint(&text, &options).iter().any(|f| f.rule == info.rule)
        };
        let is_ours = info.rule.is_ours() || info.meaning_lost;
        assert_eq!(has(Controller::Grbl), is_ours || info.grbl_error.is_some(), "{name}");
        assert_eq!(has(Controller::LinuxCnc), is_ours || info.linuxcnc_refuses, "{name}");
    }
}

/// LinuxCNC's own verdict on every program, where its interpreter is installed.
#[test]
fn linuxcnc_agrees() {
    if Command::new("rs274").arg("-h").output().is_err() {
        println!("skipped: rs274 is not installed");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("tool.tbl");
    std::fs::write(&table, "T1 P1 D3.175 ;\n").unwrap();
    let options = LintOptions { controller: Controller::LinuxCnc, stock_top: 0.0 };
    let mut disagreements = Vec::new();
    for (name, path, text) in programs("good").into_iter().chain(programs("bad")) {
        let variables = folder.path().join("empty.var");
        std::fs::write(&variables, "").unwrap();
        let output = Command::new("rs274")
            .current_dir(folder.path())
            .args(["-t".as_ref(), table.as_os_str(), "-v".as_ref(), variables.as_os_str(), "-g".as_ref()])
            .args([path.as_os_str(), folder.path().join("out").as_os_str()])
            .output()
            .unwrap();
        let refusals: Vec<_> = lint(&text, &options).into_iter().filter(|f| f.rule.info().linuxcnc_refuses).collect();
        if output.status.success() != refusals.is_empty() {
            let words = String::from_utf8_lossy(&output.stderr);
            disagreements.push(format!("{name}: LinuxCNC says {words:?}, we say {refusals:?}"));
        }
    }
    assert!(disagreements.is_empty(), "{disagreements:#?}");
}
