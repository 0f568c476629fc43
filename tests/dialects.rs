//! Dialect files that people write: read or refused with a reason, never a panic.

use clopen::gcode::{Dialect, LintOptions, lint};
use proptest::prelude::*;

const PROGRAM: &str =
    "G21 G17 G90 G94\nG0 Z5\nM3 S9000\nG4 P2\nG0 X1 Y1\nG1 Z-1 F100\nG2 X5 Y5 I2 J2 F300\nM6 T2\nG0 Z5\nM5\nM30\n";

/// A manual change with a pause, as those write it whose controller knows no M6.
#[test]
fn a_pause_can_stand_for_a_change() {
    let text = "base = \"grbl\"\ntool-change = [\"(put in tool {number})\", \"M0\"]\n";
    let dialect = Dialect::parse(text, "shed").unwrap();
    assert_eq!(dialect.tool_change[0].replace("{number}", "2"), "(put in tool 2)");
    assert!(Dialect::named("shed").is_err(), "it stays its owner's");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn no_file_makes_the_reader_panic(
        any in ".{0,60}",
        key in prop::sample::select(vec![
            "name", "title", "machine", "letters", "codes", "units", "comments", "decimals-mm", "longest-line",
            "refused-code-length", "line-numbers", "preamble", "corner-tolerance", "program-end", "spindle-on",
            "spindle-full", "dwell-word", "dwell-units", "tool-change", "arcs", "largest-arc-radius", "arc-mismatch",
            "radius-slack", "rapid-feed", "pen-up", "pen-up-z", "refuses", "base",
        ]),
        value in prop::sample::select(vec![
            "0", "-1", "300", "1e308", "nan", "inf", "true", "\"\"", "\"G\"", "\"{speed}\"", "\"\u{e4}\u{20ac}\"", "[]", "[\"G1\"]",
            "[\"\u{20ac}1\"]", "[\"mm\"]", "{}", "{ P = \"seconds\" }", "{ mm = 0.0, inch = 0.0, relative = 0.0 }",
            "{ rpm = 1.0, word = 0.0 }", "\"grbl\"", "\"pen\"", "\"laser\"",
        ]),
        base in prop::sample::select(vec!["grbl", "linuxcnc", "marlin", "plotter", "grbl-laser"]),
    ) {
        prop_assert!(Dialect::parse(&any, "x").is_err(), "a dialect needs more than {:?}", any);
        let base = if key == "base" { String::new() } else { format!("base = \"{base}\"\n") };
        match Dialect::parse(&format!("{base}{key} = {value}\n"), "x") {
            Ok(dialect) => drop(lint(PROGRAM, &LintOptions { dialect: &dialect, stock_top: 0.0 })),
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }
}
