//! Lines of text that flow: the command `clopen text` with states on the way.
#![cfg(feature = "text")]

mod small_font;

use std::f64::consts::PI;
use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use clopen::io::svg::{ReadOptions, read};
use clopen::plane::Region;
use small_font::{file, tables};

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("f.ttf"), file(&tables())).unwrap();
    folder
}

fn text(folder: &Path, arguments: &str) -> Output {
    let mut command = Command::cargo_bin("clopen").unwrap();
    command
        .current_dir(folder)
        .args(["text", "L", "--font", "f.ttf"])
        .args(arguments.split_whitespace())
        .output()
        .unwrap()
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn text_well(folder: &Path, arguments: &str) -> Vec<u8> {
    let output = text(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments}: {}", words(&output));
    output.stdout
}

fn region(bytes: &[u8]) -> Region {
    read(bytes, &ReadOptions::default()).unwrap().region
}

/// What a disk of radius 40 takes out of a convex right corner.
const CORNER: f64 = (1.0 - PI / 4.0) * 40.0 * 40.0;

/// The area of an L: a corner of two bars, 200 wide.
const ELL: f64 = 200.0 * 700.0 + 300.0 * 200.0;

#[test]
fn eight_states_without_a_file_play_on_standard_output() {
    let folder = folder();
    let output = text(folder.path(), "--op open -r 40u --frames 8");
    assert_eq!(output.status.code(), Some(0), "{}", words(&output));
    assert!(words(&output).contains("plays all states"), "{}", words(&output));
    let svg = String::from_utf8(output.stdout).unwrap();
    // The letter as it is, and eight states, each with its time below; states that look alike are one drawing.
    let drawn = svg.matches("<animate ").count() - 9;
    assert!((3..=9).contains(&drawn), "{drawn}: {svg}");
    assert_eq!(svg.matches(" r²").count(), 9);
    // Who knows no animation sees the last of them, the opened letter.
    // (and the caption below it).
    let area = region(svg.as_bytes()).rings.iter().map(|r| r.area()).fold(0.0, f64::max);
    assert!((area - (ELL - 5.0 * CORNER)).abs() < 0.05 * CORNER, "{area}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "no file appears that was not named");
}

#[test]
fn letters_flow_to_what_the_disk_makes_of_them() {
    let folder = folder();
    for (op, corners) in [("open", -5.0), ("close", 1.0), ("clopen", -4.0)] {
        let disk = region(&text_well(folder.path(), &format!("--op {op} -r 40u")));
        let flow = region(&text_well(folder.path(), &format!("--op {op} -r 40em/1000 --time 1000")));
        assert!((flow.area() - (ELL + corners * CORNER)).abs() < 0.02 * CORNER, "{op}: {}", flow.area());
        assert!((flow.area() - disk.area()).abs() < 0.02 * CORNER, "{op}");
        let early = region(&text_well(folder.path(), &format!("--op {op} -r 40u --time 0.02"))).area();
        let part = (early - ELL) / (corners * CORNER);
        assert!(0.05 < part && part < 0.95, "{op}: {part} of the way");
    }
}

#[test]
fn states_of_letters_are_drawings_and_pictures() {
    let folder = folder();
    let report = text_well(
        folder.path(),
        "--op open -r 40u --time 0.1 --frames 3 --stills s.svg --animation a.svg --apng a.png --sheet s.png --columns 3 \
         --pixels 300 -o last.svg --format json",
    );
    let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
    assert_eq!(report["largest_radius_units"], 40.0);
    assert_eq!(report["frames"].as_array().unwrap().len(), 3);
    assert!((report["largest_radius_mm"].as_f64().unwrap() - 4.0).abs() < 1e-12, "an em is 100 mm");
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert_eq!(bytes("s-03.svg"), bytes("last.svg"));
    let areas = ["s-01.svg", "s-02.svg", "s-03.svg"].map(|name| region(&bytes(name)).area());
    assert!(ELL > areas[0] && areas[0] > areas[1] && areas[1] > areas[2], "{areas:?}");
    assert_eq!(tiny_skia::Pixmap::decode_png(&bytes("s.png")).unwrap().width(), 300);
    let reader = png::Decoder::new(std::io::Cursor::new(bytes("a.png"))).read_info().unwrap();
    assert_eq!(reader.info().animation_control().unwrap().num_frames, 4);
}

#[test]
fn what_means_nothing_is_told_in_a_sentence() {
    let folder = folder();
    for (arguments, expected) in [
        ("-r 40u --frames 0", "--frames 0"),
        ("-r 40u --time 0", "--time 0"),
        ("-r 40u --time 1 --topology merge", "--topology merge"),
        ("-r 40u --frames 2 -o o.svg", "--sheet"),
        ("-r 40u --frames 2 --format json", "-o OUT.svg"),
        ("-r 40u --sheet f.ttf", "written over"),
        ("-r 40u --sheet s.png --pixels 3", "3"),
        ("-r 1001 --frames 2", "the em, which is 1000"),
        ("-r 0 --time 1", "--radius"),
        ("-r 40u --time 1 --size 0mm", "--size"),
    ] {
        let output = text(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments}: {}", words(&output));
        assert!(words(&output).contains(expected), "{arguments}: {}", words(&output));
        assert_eq!(words(&output).trim_end().lines().count(), 1, "{arguments}: {}", words(&output));
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is written");
}
