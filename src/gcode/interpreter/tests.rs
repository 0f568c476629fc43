//! Origins, ways home and drilling cycles, motion by motion.

use crate::cam::{Motion, MotionKind, Point3};
use crate::gcode::{Dialect, LintOptions, Rule, lint, read};

const HEAD: &str = "G21 G90 G17 G94\nG0 Z5\n";

fn motions(text: &str) -> Vec<Motion> {
    read(&format!("{HEAD}{text}")).unwrap().motions
}

fn ends(text: &str) -> Vec<[f64; 3]> {
    motions(text).iter().skip(1).map(|m| [m.to.x, m.to.y, m.to.z]).collect()
}

#[test]
fn the_origin_that_g92_sets_is_followed() {
    let found = ends("G0 X10 Y10\nG92 X0 Y1 Z6\nG1 Z-1 F100\nX10 Y1\nG92.2\nX0\nG92.3\nX0\nG92.1\nX0");
    let expected = [
        [10.0, 10.0, 5.0],
        [10.0, 10.0, -2.0],
        [20.0, 10.0, -2.0],
        [0.0, 10.0, -2.0],
        [10.0, 10.0, -2.0],
        [0.0, 10.0, -2.0],
    ];
    assert_eq!(found, expected);
    // A second one counts from where the tool is, not from the first.
    assert_eq!(ends("G0 X10\nG92 X1\nX2\nG92 X0\nX1")[2], [12.0, 0.0, 5.0]);
    // Steps are the same from any origin; absolute centres are not.
    assert_eq!(ends("G0 X10\nG92 X0\nG91\nX1")[1], [11.0, 0.0, 5.0]);
    let arc = motions("G0 X10 Y0\nG92 X0\nG90.1 G3 X2 Y0 I1 J0 F100")[2];
    assert!(matches!(arc.kind, MotionKind::Arc { center, .. } if center.x == 11.0 && center.y == 0.0), "{arc:?}");
    assert_eq!(ends("G20\nG0 X1\nG92 X0\nX1")[1][0], 50.8);
    assert_eq!(ends("G52 X3\nG0 X10\nG52 X0\nX10"), [[13.0, 0.0, 5.0], [10.0, 0.0, 5.0]]);
}

#[test]
fn the_first_g92_names_the_place_where_the_tool_stands() {
    let program = read("G21 G90\nG92 X7 Y8 Z9\nG0 X10\nG0 Z12").unwrap();
    assert_eq!(program.motions[0].from, Point3::new(7.0, 8.0, 9.0));
    assert_eq!(program.motions[0].to, Point3::new(10.0, 8.0, 9.0));
    assert_eq!(program.motions[1].to.z, 12.0);
}

#[test]
fn ways_home_go_through_the_place_they_name() {
    assert_eq!(
        ends("G0 X1 Y1 Z9\nG0 Z3\nG28 X40 Z2"),
        [[1.0, 1.0, 9.0], [1.0, 1.0, 3.0], [40.0, 1.0, 2.0], [40.0, 1.0, 9.0]]
    );
    assert_eq!(ends("G0 X1\nG91 G28 Z0"), [[1.0, 0.0, 5.0], [1.0, 0.0, 5.0]]);
}

#[test]
fn feed_by_turns_is_a_feed_for_its_speed() {
    let program = read("G21 G90 G17 G95\nG0 Z1\nM3 S2000\nG1 X30 F0.1\nS1000\nG1 X0").unwrap();
    let feeds: Vec<_> = program.motions.iter().filter_map(Motion::feed).collect();
    assert_eq!(feeds, [200.0, 100.0]);
}

/// Heights of the way of one hole at a time: what stands before it is its place, then each end of a way with how it goes.
fn holes(text: &str) -> String {
    let mut words = String::new();
    for m in motions(text).iter().skip(1) {
        match m.kind {
            MotionKind::Dwell { seconds } => words += &format!("wait {seconds} "),
            _ if m.from.xy() != m.to.xy() => words += &format!("({}, {}) ", m.to.x, m.to.y),
            MotionKind::Rapid => words += &format!("to {:.3} ", m.to.z),
            _ => words += &format!("drill {:.3} ", m.to.z),
        }
    }
    words.trim_end().to_owned()
}

#[test]
fn drilling_cycles_are_the_motions_they_stand_for() {
    for (text, expected) in [
        (
            "G81 X1 Y2 Z-3 R1 F100\nX4\nG80",
            "(1, 2) to 1.000 drill -3.000 to 5.000 (4, 2) to 1.000 drill -3.000 to 5.000",
        ),
        ("G99 G81 X1 Y2 Z-3 R1 F100\nX4 Z-2", "(1, 2) to 1.000 drill -3.000 to 1.000 (4, 2) drill -2.000 to 1.000"),
        ("G98 G82 X1 Z-3 R1 P0.5 F100\n", "(1, 0) to 1.000 drill -3.000 wait 0.5 to 5.000"),
        ("G83 X1 Z-2.5 R1 Q2 F100", "(1, 0) to 1.000 drill -1.000 to 1.000 to -0.746 drill -2.500 to 5.000"),
        ("G73 X1 Z-2.5 R1 Q2 F100", "(1, 0) to 1.000 drill -1.000 to -0.746 drill -2.500 to 5.000"),
        // Steps: R from the present height, Z from R, and L holes in a row.
        ("G91 G99 G81 X2 Z-4 R-4 L2 F100", "(2, 0) to 1.000 drill -3.000 to 1.000 (4, 0) drill -3.000 to 1.000"),
        ("G0 Z0\nG81 X1 Z-3 R1 F100", "to 0.000 to 1.000 (1, 0) drill -3.000 to 1.000"),
        // G80 ends it.
        ("G81 X1 Z-3 R1 F100\nG80\nG0 X9", "(1, 0) to 1.000 drill -3.000 to 5.000 (9, 0)"),
        // Where the origin is moved, so are the holes.
        ("G0 X1 Y0\nG92 X0 Z6\nG81 X0 Z-3 R1 F100", "(1, 0) to 0.000 drill -4.000 to 5.000"),
    ] {
        assert_eq!(holes(text), expected, "{text}");
    }
}

#[test]
fn drilling_cycles_that_make_no_sense_are_refused_in_words() {
    for (text, part) in [
        ("G81 X1 Z-3 F100", "without Z or R"),
        ("G81 X1 Z3 R1 F100", "R below Z"),
        ("G83 X1 Z-3 R1 F100", "without Q"),
        ("G83 X1 Z-3 R1 Q1e-9 F100", ""),
        ("G83 X1 Z-3 R1 Q0.000000001 F100", "too many pecks"),
        ("G18 G81 X1 Z-3 R1 F100", "outside of the XY plane"),
        ("G81 X1 Z-3 R1 L0 F100", "with this L"),
        ("G81 X1 Z-3 R1 L1000000 F100", "with this L"),
        ("G81 X1 Z-3 R1 K2 F100", "with K"),
        ("G85 X1 Z-3 R1 F100", "G85"),
    ] {
        let error = read(&format!("{HEAD}{text}")).unwrap_err().to_string();
        assert!(error.contains(part) && error.contains("line 3"), "{text}: {error}");
    }
}

#[test]
fn a_controller_that_works_expressions_out_is_not_told_that_they_are_wrong() {
    let found = |name: &str, line: &str| {
        let text = format!("{HEAD}{line}\nM2\n");
        let findings = lint(&text, &LintOptions { dialect: Dialect::named(name).unwrap(), stock_top: 0.0 });
        findings.into_iter().map(|f| (f.rule, f.severity.to_string())).collect::<Vec<_>>()
    };
    for line in ["#1=5", "G0 X[2*3]", "G0 X#1", "o100 sub", "o100 if [#1 gt 2]", "G0 X#<width>"] {
        assert_eq!(found("linuxcnc", line), [(Rule::NotFollowed, "warning".to_owned())], "{line}");
        // Nor is what follows from it: the arc is none where X is not 6.
        let more = format!("G1 X5 F100\n{line}\nG2 X8 I1");
        let rules: Vec<_> = found("linuxcnc", &more).into_iter().map(|(rule, _)| rule).collect();
        assert!(
            rules.iter().all(|rule| matches!(rule, Rule::NotFollowed | Rule::SpindleOff | Rule::FeedOfRapid)),
            "{rules:?}"
        );
        assert!(found("grbl", line).iter().any(|(_, severity)| severity == "error"), "{line}");
    }
}
