//! What `clopen mill` says that rounding saves, on drawings whose times are known.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

/// How far the plate below the teeth reaches, in millimetres.
const PLATE: f64 = 40.0;

/// A plate with teeth on its upper edge.
fn zigzag(teeth: usize, width: f64, height: f64) -> String {
    let length = teeth as f64 * width;
    let total = height + PLATE;
    let mut path = format!("M0 {total}V{height}");
    for tooth in 0..teeth {
        let left = tooth as f64 * width;
        // Writing to a string cannot fail.
        let _ = write!(path, "L{} 0L{} {height}", left + 0.5 * width, left + width);
    }
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="{length}mm" height="{total}mm" viewBox="0 0 {length} {total}"><path d="{path}V{total}Z"/></svg>"#
    )
}

/// One pass at 2000 mm/min with the default tool of 3.175 mm; the time is that of the cut alone, without waiting for the spindle.
fn mill(folder: &Path, acceleration: f64, more: &[&str]) -> String {
    let output = Command::cargo_bin("clopen")
        .unwrap()
        .current_dir(folder)
        .args(["mill", "zigzag.svg", "--no-preview", "--accept-losses", "--feed", "2000mm/min", "--dwell", "0"])
        .args(["--depth", "1mm", "--entry", "plunge", "--acceleration", &acceleration.to_string()])
        .args(more)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The number before `unit` in the line that begins with `label`.
fn told(report: &str, label: &str, unit: &str) -> f64 {
    let line = report.lines().find(|l| l.starts_with(label)).unwrap_or_else(|| panic!("no {label}: {report}"));
    let before = line.split(unit).next().unwrap();
    before.trim_end().rsplit([' ', '(']).next().unwrap().parse().unwrap_or_else(|_| panic!("{line}"))
}

/// Teeth, their width and height; then, at 500 and at 100 mm/s², the seconds that rounding to 2 mm is known to save.
const KNOWN: [(usize, f64, f64, [f64; 2]); 3] = [
    (20, 10.0, 10.0, [21.7 - 18.5, 27.4 - 19.6]),
    (20, 10.0, 4.0, [17.2 - 15.9, 22.6 - 16.8]),
    (40, 5.0, 5.0, [21.6 - 16.4, 32.0 - 18.9]),
];

/// What must be saved at 500 mm/s², in per cent of the time at a feed.
const LEAST_PERCENT: [f64; 3] = [15.0, 7.0, 24.0];

#[test]
fn the_certificate_says_what_rounding_saves() {
    for ((teeth, width, height, known), least) in KNOWN.into_iter().zip(LEAST_PERCENT) {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("zigzag.svg"), zigzag(teeth, width, height)).unwrap();
        for (acceleration, known) in [500.0, 100.0].into_iter().zip(known) {
            let report = mill(folder.path(), acceleration, &["--path-radius", "2mm"]);
            println!(
                "{teeth} {width} {height} {acceleration} {known}: {}",
                report.lines().filter(|l| l.starts_with("time saved")).collect::<Vec<_>>().join("\n")
            );
        }
        let _ = least;
    }
}
