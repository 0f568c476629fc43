//! For every rule a program that breaks it, and the same program mended.

use std::collections::BTreeSet;
use std::process::Command;

use clopen::gcode::{Dialect, LintOptions, RULES, RuleInfo, lint};

/// Programs without any finding: which one, and for which dialect.
const CUT: &str = "G21\nG17 G90 G94\nG0 Z5\nM3 S10000\nG4 P2\nG0 X0 Y0\nG1 Z-1 F100\nG1 X5 F500\nG3 X10 Y5 I0 J5\nG0 Z5\nM5\n\
    M30\n";
const TOOLS: &str = "G21\nG17 G90 G94\nT1 M6\nG0 Z5\nM3 S10000\nG4 P2\nG0 X0 Y0\nG1 Z-1 F100\nG1 X5 F500\nG0 Z5\nM5\nT2 M6\n\
    G0 Z5\nM3 S8000\nG4 P2\nG0 X0 Y0\nG1 Z-1 F90\nG1 X5 F400\nG0 Z5\nM5\nM30\n";
const MARLIN: &str = "G21\nG90\nG0 Z5 F3000\nM3 S200\nG4 S2\nG0 X0 Y0\nG1 Z-1 F100\nG1 X5 F500\nG3 X10 Y5 I0 J5\nG0 Z5 F3000\n\
    M5\n";
const LASER: &str = "G21\nG17 G90 G94\nM5\nG0 X0 Y0\nM4 S800\nG1 X5 F500\nM5\nG0 X9\nM30\n";
const PECK: &str = "G21\nG17 G90 G94\nG0 Z5\nM3 S10000\nG4 P2\nG0 X3 Y3\nG1 Z-2 F100\nG0 Z1\nG0 Z-1.5\nG1 Z-4\nG0 Z5\nM5\n\
    M30\n";

/// The rule, the dialect, the good program, what is replaced in it, and by what.
const CASES: &[(&str, &str, &str, &str, &str)] = &[
    ("bad-number", "grbl", CUT, "G1 X5", "G1 X"),
    ("bad-number", "grbl", CUT, "X5", "Xnan"),
    ("unknown-text", "grbl", CUT, "G1 X5", "G1 X5 $"),
    ("expression", "grbl", CUT, "G1 X5", "G1 X#1\nG1 X5"),
    ("not-followed", "linuxcnc", CUT, "G1 X5", "G1 X[2+3]\nG1 X5"),
    ("exponent", "grbl", CUT, "X5", "X5E0"),
    ("unknown-code", "grbl", CUT, "G90", "G90 G123"),
    ("unsupported-code", "grbl", CUT, "G90", "G90 G64"),
    ("unsupported-code", "grbl", CUT, "X5", "X5 A0"),
    ("unsupported-code", "marlin", MARLIN, "G90", "G94"),
    ("unsupported-code", "grbl-laser", LASER, "G0 X0", "G0 Z5 X0"),
    ("tool-change", "grbl", CUT, "M3", "T1 M6\nM3"),
    ("tool-change", "marlin", MARLIN, "M3", "M6\nM3"),
    ("several-codes", "marlin", MARLIN, "G21\nG90", "G21 G90"),
    ("motion-word-missing", "marlin", MARLIN, "G1 X5", "X5"),
    ("not-followed", "linuxcnc", CUT, "G1 X5", "G85 X5 Z-2 R1\nG80\nG1 X5"),
    ("shifted-origin", "grbl", CUT, "G1 X5 F500", "G55\nG1 X5 F500"),
    ("set-origin", "grbl", CUT, "G0 Z5\nM3", "G92 X0 Y0\nG0 Z5\nM3"),
    ("homing", "grbl", CUT, "G0 Z5\nM5", "G0 Z5\nG28\nM5"),
    ("unknown-way", "grbl", CUT, "G0 Z5\nM5", "G28\nM5"),
    ("duplicate-word", "grbl", CUT, "X5", "X5 X6"),
    ("conflicting-codes", "grbl", CUT, "G1 X5", "G1 G0 X5"),
    ("unused-word", "grbl", CUT, "X5", "X5 I2"),
    (
        "line-too-long",
        "grbl",
        CUT,
        "G1 X5",
        "G1 X5.00000000000000000000000000000000000000000000000000000000000000000000000000000000",
    ),
    ("unclosed-comment", "linuxcnc", CUT, "X5", "X5 (slot"),
    ("nested-comment", "grbl", CUT, "X5", "X5 (a (slot))"),
    ("percent-sign", "grbl", CUT, "G21", "%\nG21"),
    ("program-number", "grbl", CUT, "G21", "O100\nG21"),
    ("block-delete", "linuxcnc", CUT, "G1 X5", "/G1 X5"),
    ("missing-units", "grbl", CUT, "G21\n", ""),
    ("missing-units", "marlin", MARLIN, "G21\n", ""),
    ("missing-plane", "grbl", CUT, "G17 ", ""),
    ("missing-distance-mode", "grbl", CUT, "G90 ", ""),
    ("missing-feed-mode", "grbl", CUT, " G94", ""),
    ("missing-motion-mode", "linuxcnc", CUT, "G0 Z5\nM3", "Z5\nM3"),
    ("no-feed", "grbl", CUT, " F100", ""),
    ("no-feed", "grbl", CUT, "F100", "F0"),
    ("feed-of-rapid", "marlin", MARLIN, " F100", ""),
    ("feed-of-rapid", "grbl", CUT, "G0 X0 Y0\nG1 Z-1 F100", "G0 X0 Y0 F100\nG1 Z-1"),
    ("rapid-without-feed", "marlin", MARLIN, "G0 Z5 F3000\nM5", "G0 Z5\nM5"),
    ("feed-after-tool-change", "grblhal", TOOLS, " F90", ""),
    ("negative-value", "grbl", CUT, "F500", "F-500"),
    ("speed-out-of-range", "marlin", MARLIN, "S200", "S10000"),
    ("dwell-without-time", "grbl", CUT, "G4 P2", "G4"),
    ("arc-without-center", "grbl", CUT, " I0 J5", ""),
    ("arc-without-end", "grbl", CUT, "G3 X10 Y5", "G3"),
    ("arc-radius-mismatch", "grbl", CUT, "X10 Y5 I0", "X10.01 Y5 I0"),
    ("arc-radius-mismatch", "linuxcnc", CUT, "X10 Y5 I0", "X10.03 Y5 I0"),
    ("arc-radius-mismatch", "mach3", CUT, "X10 Y5 I0", "X10.003 Y5 I0"),
    ("arc-imprecise", "grbl", CUT, "X10 Y5 I0", "X10.003 Y5 I0"),
    ("arc-wrong-plane", "linuxcnc", CUT, "I0 J5", "J5 K0"),
    ("arc-other-plane", "grbl", CUT, "G3 X10 Y5 I0 J5", "G18\nG3 X7 Z-1 I1 K0"),
    ("arc-radius-form", "grbl", CUT, "I0 J5", "R5"),
    ("arc-radius-too-small", "grbl", CUT, "I0 J5", "R3"),
    ("arc-radius-closed", "grbl", CUT, "G3 X10 Y5 I0 J5", "G3 X5 Y0 R5"),
    ("arc-end-equals-start", "grbl", CUT, "G3 X10 Y5 I0 J5", "G3 X5 Y0 I0 J5\nG1 X9"),
    ("travel-before-lift", "grbl", CUT, "G0 Z5\nM3", "G0 X0 Y0 Z5\nM3"),
    ("travel-before-lift", "grblhal", TOOLS, "T2 M6\nG0 Z5", "T2 M6"),
    ("rapid-through-material", "grbl", CUT, "G1 X5 F500", "G0 X5"),
    ("rapid-plunge", "grbl", CUT, "G1 Z-1 F100", "G0 Z-1"),
    ("rapid-plunge", "grbl", PECK, "G0 Z-1.5", "G0 Z-2.5"),
    ("rapid-plunge", "grbl", PECK, "G0 Z1\n", "G0 Z5\nG0 X4\n"),
    ("low-travel", "grbl", CUT, "G0 X0 Y0", "G0 Z0.2\nG0 X1 Y0"),
    ("fast-plunge", "grbl", CUT, "G1 Z-1 F100", "G1 Z-1 F500"),
    ("spindle-off", "grbl", CUT, "M3 S10000\nG4 P2\n", ""),
    ("no-dwell", "grbl", CUT, "G4 P2\n", ""),
    ("no-dwell", "grblhal", TOOLS, "M3 S8000\nG4 P2\n", "M3 S8000\n"),
    ("no-spindle-speed", "grbl", CUT, "M3 S10000", "M3"),
    ("spindle-on-at-tool-change", "grblhal", TOOLS, "M5\nT2", "T2"),
    ("beam-on-travel", "grbl-laser", LASER, "M5\nG0 X9", "G0 X9\nM5"),
    ("spindle-left-on", "grbl", CUT, "M5\n", ""),
    ("spindle-left-on", "grbl-laser", LASER, "M5\nG0 X9", ""),
    ("tool-left-down", "grbl", CUT, "G0 Z5\nM5", "M5"),
    ("no-program-end", "linuxcnc", CUT, "M30\n", ""),
    ("after-end", "grbl", CUT, "M30\n", "M30\nG0 X0\n"),
    (
        "no-motion",
        "grbl",
        CUT,
        "G0 Z5\nM3 S10000\nG4 P2\nG0 X0 Y0\nG1 Z-1 F100\nG1 X5 F500\nG3 X10 Y5 I0 J5\nG0 Z5\nM5\n",
        "",
    ),
];

fn found(text: &str, dialect: &Dialect) -> Vec<&'static str> {
    let findings = lint(text, &LintOptions { dialect, stock_top: 0.0 });
    findings.iter().map(|f| f.rule.info().name).collect()
}

#[test]
fn each_rule_is_broken_by_one_program_and_kept_by_its_mended_one() {
    let mut seen = BTreeSet::new();
    let mut unbroken = Vec::new();
    for (rule, name, good, what, by) in CASES {
        let dialect = Dialect::named(name).unwrap();
        assert!(RuleInfo::named(rule).is_some(), "{rule} is no rule");
        assert_eq!(found(good, dialect), [""; 0], "{name}: {good}");
        let bad = good.replacen(what, by, 1);
        assert_ne!(bad, *good, "{rule}: nothing was replaced");
        let findings = found(&bad, dialect);
        if !findings.contains(rule) {
            unbroken.push(format!("{rule} for {name}: {findings:?} in\n{bad}"));
        }
        seen.insert(*rule);
    }
    assert!(unbroken.is_empty(), "{}", unbroken.join("\n"));
    // Arcs are missing from no built-in dialect.
    let text = "base = \"grbl\"\narcs = false";
    assert!(found(CUT, &Dialect::parse(text, "x").unwrap()).contains(&"no-arcs"));
    let text = "base = \"grbl\"\nhelical-arcs = false";
    let flat = Dialect::parse(text, "x").unwrap();
    assert_eq!(found(CUT, &flat), [""; 0]);
    assert!(found(&CUT.replace("X10 Y5 I0", "X10 Y5 Z-2 I0"), &flat).contains(&"no-arcs"));
    seen.insert("no-arcs");
    let untested: Vec<&str> = RULES.iter().map(|r| r.name).filter(|n| !seen.contains(n)).collect();
    assert!(untested.is_empty(), "no program breaks {untested:?}");
}

/// A rule is asked for only where it means something.
#[test]
fn rules_know_their_machines() {
    let named = |name| Dialect::named(name).unwrap();
    assert_eq!(found(CUT, named("linuxcnc")), [""; 0]);
    assert_eq!(found(TOOLS, named("linuxcnc")), [""; 0]);
    assert!(found(TOOLS, named("grbl")).contains(&"tool-change"));
    // A beam needs no time to start, and no height.
    assert_eq!(found(LASER, named("grbl-laser")), [""; 0]);
    assert!(found(LASER, named("grbl")).contains(&"travel-before-lift"));
    // Marlin takes any arc, and ends with its text.
    assert_eq!(found(&MARLIN.replace("X10 Y5", "X11 Y5"), named("marlin")), ["arc-imprecise"]);
    assert!(found(MARLIN, named("linuxcnc")).contains(&"no-program-end"));
    // Milliseconds are no seconds, but a wait they are.
    assert_eq!(found(&MARLIN.replace("G4 S2", "G4 P2000"), named("marlin")), [""; 0]);
}

/// The source of a finding is the controller where it refuses, and otherwise where the rule comes from.
#[test]
fn findings_name_their_source() {
    let source = |name, text: &str| {
        let findings = lint(text, &LintOptions { dialect: Dialect::named(name).unwrap(), stock_top: 0.0 });
        findings.into_iter().map(|f| f.source).collect::<Vec<_>>()
    };
    assert_eq!(source("grbl", &CUT.replace(" F100", "")), ["grbl: error 22"]);
    assert_eq!(source("linuxcnc", &CUT.replace(" F100", "")), ["linuxcnc: refused"]);
    assert_eq!(source("grbl", &CUT.replace("G4 P2\n", "")), ["grbl 1373, gnea/grbl 701 730, pcb2gcode 85"]);
}

/// LinuxCNC's own interpreter refuses just those of all these programs that its dialect says it does.
#[test]
fn linuxcnc_agrees_on_every_case() {
    if Command::new("rs274").arg("-h").output().is_err() {
        println!("skipped: rs274 (Debian package linuxcnc-uspace) is absent");
        return;
    }
    let here = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    file("tool.tbl", "T1 P1 D3 Z0 ;\nT2 P2 D2.5 Z0 ;\n");
    let dialect = Dialect::named("linuxcnc").unwrap();
    let mut disagreements = Vec::new();
    for (rule, _, good, what, by) in CASES {
        let bad = good.replacen(what, by, 1);
        file("program.ngc", &bad);
        file("empty.var", "");
        let output = Command::new("rs274")
            .args(["-t", "tool.tbl", "-v", "empty.var", "-g", "program.ngc", "out.canon"])
            .current_dir(here.path())
            .output()
            .unwrap();
        let findings = lint(&bad, &LintOptions { dialect, stock_top: 0.0 });
        let refused: Vec<_> = findings.iter().filter(|f| dialect.refuses.contains_key(&f.rule)).collect();
        if output.status.success() != refused.is_empty() {
            let words = String::from_utf8_lossy(&output.stderr).into_owned();
            disagreements.push(format!("{rule} ({what:?} to {by:?}): LinuxCNC says {words:?}, we say {refused:?}"));
        }
    }
    assert!(disagreements.is_empty(), "{}", disagreements.join("\n"));
}
