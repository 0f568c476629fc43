//! What `clopen mill` says that rounding saves, on drawings whose times are known.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

/// How far the plate below the teeth reaches, in millimetres: hardly, since what rounding saves it saves between the teeth.
const PLATE: f64 = 1.0;

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
        .args([
            "--depth",
            "1mm",
            "--entry",
            "plunge",
            "--plunge-feed",
            "2000mm/min",
            "--acceleration",
            &acceleration.to_string(),
        ])
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

/// How far a saving may be from the known one, as a share of it, and in seconds: entry and the flattening of the known paths are
/// not told, and between teeth 5 mm apart the disk rests on two tips.
const WITHIN: (f64, f64) = (0.22, 0.1);

#[test]
fn the_certificate_says_what_rounding_saves() {
    for ((teeth, width, height, known), least) in KNOWN.into_iter().zip(LEAST_PERCENT) {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("zigzag.svg"), zigzag(teeth, width, height)).unwrap();
        for (acceleration, known) in [500.0, 100.0].into_iter().zip(known) {
            let report = mill(folder.path(), acceleration, &["--path-radius", "2mm"]);
            let (seconds, percent) = (told(&report, "time saved", " s ("), told(&report, "time saved", " %)"));
            println!("{teeth} x {width} x {height} at {acceleration}: {seconds} s, {percent} %; known {known:.1} s");
            assert!((seconds - known).abs() < WITHIN.0 * known + WITHIN.1, "{seconds} against {known}");
            let least = if acceleration == 500.0 { least } else { 1.5 * least };
            assert!(percent >= least, "{percent} % of {teeth} x {width} x {height} at {acceleration}");
        }
    }
}

#[test]
fn the_numbers_for_programs_say_the_same() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("zigzag.svg"), zigzag(20, 10.0, 10.0)).unwrap();
    let json = |radius: &str| -> Value {
        serde_json::from_str(&mill(folder.path(), 500.0, &["--path-radius", radius, "--format", "json"])).unwrap()
    };
    let (rounded, sharp) = (json("2mm"), json("0"));
    let number = |value: &Value, path: &str| value.pointer(path).unwrap().as_f64().unwrap();
    // What is said of the sharp path is what that path says of itself.
    let itself = number(&sharp, "/certificate/time/feed_seconds");
    assert!((number(&rounded, "/sharp/feed_seconds") - itself).abs() < 1e-9);
    let length = number(&sharp, "/certificate/statistics/cut_length_mm");
    assert!((number(&rounded, "/sharp/cut_length_mm") - length).abs() < 1e-9);
    let saved = itself - number(&rounded, "/certificate/time/feed_seconds");
    assert!((number(&rounded, "/sharp/saved_seconds") - saved).abs() < 1e-9 && saved > 2.0, "{saved}");
    assert_eq!(rounded["sharp"]["same_outlines"], true);
    assert!(sharp["sharp"].is_null(), "a sharp path has nothing to be held against");
    assert!(!mill(folder.path(), 500.0, &["--path-radius", "0"]).contains("time saved"));
}

#[test]
fn jobs_with_operations_say_it_too() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("zigzag.svg"), zigzag(20, 10.0, 10.0)).unwrap();
    let job = "version = 1\n[machine]\nacceleration = [500, 500, 500]\n[[tool]]\nnumber = 1\ndiameter = 3.175\nfeed = 2000\n\
               plunge-feed = 2000\n[[operation]]\nkind = \"profile\"\nname = \"teeth\"\ntool = 1\ndepth = 1\n\
               path-radius = 2\nentry = \"plunge\"\n";
    fs::write(folder.path().join("job.toml"), job).unwrap();
    let report = mill_job(folder.path(), &[]);
    let (seconds, percent) = (told(&report, "time saved", " s ("), told(&report, "time saved", " %)"));
    assert!((2.5..4.0).contains(&seconds) && percent >= 15.0, "{report}");
    let json: Value = serde_json::from_str(&mill_job(folder.path(), &["--format", "json"])).unwrap();
    assert!((json["sharp"]["saved_seconds"].as_f64().unwrap() - seconds).abs() < 0.051, "{}", json["sharp"]);
}

fn mill_job(folder: &Path, more: &[&str]) -> String {
    let output = Command::cargo_bin("clopen")
        .unwrap()
        .current_dir(folder)
        .args(["mill", "zigzag.svg", "--no-preview", "--job", "job.toml"])
        .args(more)
        .output()
        .unwrap();
    assert!(output.status.code() != Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}
