//! The linter on a folder of good and a folder of bad programs, and against LinuxCNC's interpreter.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use clopen::cam::{CertifyOptions, certify};
use clopen::gcode::{Dialect, LintOptions, RULES, RuleScope, lint, read};
use clopen::plane::{Point, Region, Ring};
use proptest::prelude::*;

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
    // tests/lint_rules.rs has a program for every rule.
    assert!(tested.len() > 40, "{}", tested.len());
}

/// Warnings of our own leave a program usable: both controllers take it.
#[test]
fn a_controller_is_asked_for_its_own_rules_only() {
    for (name, _, text) in programs("bad") {
        let rule_name = name.split("--").next().unwrap();
        let info = RULES.iter().find(|r| r.name == rule_name).unwrap();
        for dialect in ["grbl", "linuxcnc"].map(|name| Dialect::named(name).unwrap()) {
            let found = lint(&text, &LintOptions { dialect, stock_top: 0.0 });
            let has = found.iter().any(|f| f.rule == info.rule);
            match info.scope {
                RuleScope::Always => assert!(has, "{name} {}", dialect.name),
                RuleScope::Refused => {
                    assert_eq!(has, dialect.refuses.contains_key(&info.rule), "{name} {}", dialect.name)
                }
                // As codes, lengths and tolerances of the dialect say: LinuxCNC is asked below.
                RuleScope::Data => {}
            }
        }
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
    let dialect = Dialect::named("linuxcnc").unwrap();
    let options = LintOptions { dialect, stock_top: 0.0 };
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
        let refusals: Vec<_> =
            lint(&text, &options).into_iter().filter(|f| dialect.refuses.contains_key(&f.rule)).collect();
        if output.status.success() != refusals.is_empty() {
            let words = String::from_utf8_lossy(&output.stderr);
            disagreements.push(format!("{name}: LinuxCNC says {words:?}, we say {refusals:?}"));
        }
    }
    assert!(disagreements.is_empty(), "{disagreements:#?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Any text at all, and text that looks like a program: read or refused, never a panic.
    #[test]
    fn no_text_makes_the_reader_panic(
        any in ".{0,80}",
        words in prop::collection::vec("[GMTXYZIJKRFPSNO/%][-+]?[0-9]{0,4}[.]?[0-9]{0,3}[ \n(;]?", 0..60),
    ) {
        for text in [any, format!("G21 G90 G17 G94 F100\nG0 Z1\n{}", words.concat())] {
            lint(&text, &LintOptions::default());
            if let Ok(program) = read(&text) {
                let disk = Region::new(vec![Ring::circle(Point::origin(), 10.0)]);
                certify(&program, &disk, &disk, &CertifyOptions::new(1.5));
            }
        }
    }

    /// Programs of motions alone are all read, and certified.
    #[test]
    fn any_motions_can_be_certified(
        motions in prop::collection::vec((0..4u8, prop::array::uniform5(-30..30i32), 1..2000i32), 0..30),
        reach in prop::sample::select(vec![1.0, 0.01, 1e7]),
    ) {
        let mut text = String::from("G21 G90 G17 G94 F100\nG0 Z1\n");
        for (g, [x, y, z, i, j], f) in motions {
            let [x, y, i, j] = [x, y, i, j].map(|v| f64::from(v) * reach);
            let center = if g > 1 { format!("I{i:.3} J{j:.3}") } else { String::new() };
            text += &format!("G{g} X{x:.3} Y{y:.3} Z{} {center} F{f}\n", f64::from(z) / 10.0);
        }
        if let Ok(program) = read(&text) {
            let disk = Region::new(vec![Ring::circle(Point::origin(), 10.0)]);
            let found = certify(&program, &disk, &disk, &CertifyOptions::new(1.5));
            prop_assert!(found.gouge.is_none_or(|g| g.depth_mm.is_finite() && g.depth_mm <= 11.5 + 1e-9));
            prop_assert!(found.time.total_seconds().is_finite());
            prop_assert!(found.uncut.area_mm2.is_finite() && found.uncut.area_mm2 >= 0.0);
        }
    }
}

/// Not a number compares as neither above nor below: no motion would be found below such a top.
#[test]
fn the_top_of_the_stock_is_a_physical_length() {
    let program = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/programs/bad/rapid-through-material.nc");
    let status = |top: &str| {
        let mut command = assert_cmd::Command::cargo_bin("clopen").unwrap();
        command.arg("lint").arg(&program).args(["--stock-top", top]).output().unwrap().status.code()
    };
    for top in ["nan", "inf", "2u", "high"] {
        assert_eq!(status(top), Some(2), "{top}");
    }
    assert_eq!(status("0"), Some(1));
    // Below everything, nothing is cut.
    assert_eq!(status("-1000mm"), Some(0));
}

/// A line can be as long as its file: what is found on it must not grow with it, nor lose what makes it unreadable.
#[test]
fn one_line_has_few_findings_of_a_kind() {
    let text = format!("G1{}", " G64 Q1 X1".repeat(10_000)) + " X#1\nM2\n";
    let findings = lint(&text, &LintOptions::default());
    assert!(findings.len() < 100, "{} findings", findings.len());
    assert_eq!(read(&text).unwrap_err().0.line, 1);
}
