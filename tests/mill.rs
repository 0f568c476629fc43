//! The whole command: from a drawing to a program, a picture, a certificate and an exit status.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::Command;
use clopen::gcode::{Dialect, LintOptions, Severity, lint, read};
use serde_json::Value;

/// The deepest cut into the part that a program may make, in millimetres.
const GOUGE_LIMIT: f64 = 0.002;

/// How much less than promised a radius of the written path may be, in millimetres: rounding to the last decimal.
const RADIUS_ROUNDING: f64 = 1e-3;

const SIZED: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40">"#;

/// A plate that loses nothing.
const PLATE: &str = r#"<path d="M5 5H55V35H5Z M20 20a6 6 0 1 0 12 0a6 6 0 1 0 -12 0Z" fill-rule="evenodd"/></svg>"#;

/// The same with a hole that the default tool does not fit into.
const PLATE_WITH_SMALL_HOLE: &str =
    r#"<path d="M5 5H55V35H5Z M20 20a1 1 0 1 0 2 0a1 1 0 1 0 -2 0Z" fill-rule="evenodd"/></svg>"#;

fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("samples").join(name)
}

fn samples() -> Vec<PathBuf> {
    let folder = fs::read_dir(sample("")).unwrap().map(|e| e.unwrap().path());
    let mut found: Vec<PathBuf> = folder.filter(|p| p.extension().is_some_and(|e| e == "svg")).collect();
    found.sort();
    assert!(found.len() >= 6, "{found:?}");
    found
}

/// An empty folder to work in.
fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

fn clopen(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("clopen").unwrap();
    command.current_dir(folder);
    command
}

/// Runs `clopen mill`.
fn mill(folder: &Path, arguments: &[&str]) -> Output {
    clopen(folder).arg("mill").args(arguments).output().unwrap()
}

/// Writes a drawing into the folder.
fn draw(folder: &Path, name: &str, text: &str) {
    fs::write(folder.join(name), text).unwrap();
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn stdout(output: &Output) -> &str {
    std::str::from_utf8(&output.stdout).unwrap()
}

fn stderr(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).unwrap()
}

/// Asserts that the command could not run: status 2, one sentence with `words`, no file beside the input.
#[track_caller]
fn assert_refused(folder: &Path, arguments: &[&str], words: &[&str]) {
    let before = names(folder);
    let output = mill(folder, arguments);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(!said.contains("panicked"), "{said}");
    for word in words {
        assert!(said.contains(word), "{word} is missing in: {said}");
    }
    assert!(output.stdout.is_empty(), "{}", stdout(&output));
    assert_eq!(names(folder), before);
}

#[test]
fn two_words_make_a_program_and_a_picture_in_the_current_folder() {
    let here = folder();
    let bracket = sample("bracket.svg");
    let output = mill(here.path(), &[bracket.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    assert_eq!(names(here.path()), ["bracket.nc", "bracket.png"]);
    for word in ["part ", "tool ", "gouge ", "uncut ", "path ", "time ", "lost ", "bracket.nc, bracket.png"] {
        assert!(stdout(&output).contains(word), "{word} is missing in: {}", stdout(&output));
    }
    let picture = fs::read(here.path().join("bracket.png")).unwrap();
    assert!(picture.starts_with(b"\x89PNG") && picture.len() > 5000);
    let program = fs::read_to_string(here.path().join("bracket.nc")).unwrap();
    assert!(program.contains("tool diameter 3.175 mm") && program.contains("drawing bracket.svg"), "{program}");
}

#[test]
fn every_sample_spares_the_part_in_every_setting() {
    let settings: [(&[&str], &str); 7] = [
        (&[], "grbl"),
        (&["--dialect", "linuxcnc"], "linuxcnc"),
        (&["--no-arcs", "--tool-diameter", "6"], "grbl"),
        (&["--inches", "--direction", "conventional"], "grbl"),
        (&["--dialect", "linuxcnc", "--inches", "--entry", "plunge", "--path-radius", "0"], "linuxcnc"),
        (&["--side", "inside", "--path-radius", "2mm"], "grbl"),
        (&["--topology", "keep", "--tool-diameter", "1"], "grbl"),
    ];
    for drawing in samples() {
        for (setting, dialect) in settings {
            let here = folder();
            let mut arguments = vec![drawing.to_str().unwrap(), "-o", "part.nc", "--no-preview", "--format", "json"];
            arguments.extend(setting);
            let output = mill(here.path(), &arguments);
            let place = format!("{} {setting:?}: {}", drawing.display(), stderr(&output));
            if setting.contains(&"keep") && output.status.code() == Some(2) {
                assert!(stderr(&output).contains("--topology merge"), "{place}");
                continue;
            }
            assert!(matches!(output.status.code(), Some(0 | 1)), "{place}");
            let report: Value = serde_json::from_slice(&output.stdout).unwrap();
            let text = fs::read_to_string(here.path().join("part.nc")).unwrap();
            assert!(read(&text).unwrap().motions.len() > 10, "{place}");

            let certificate = &report["certificate"];
            // Keeping the topology means that parts nearer to each other than the tool are cut into, and said to be.
            if !setting.contains(&"keep") {
                let gouge = certificate["gouge"]["depth_mm"].as_f64().unwrap();
                assert!(gouge <= GOUGE_LIMIT, "{place}: gouge {gouge}");
            }
            assert_eq!(report["contradictions"], 0, "{place}");
            let promised =
                report["closing_radius_mm"].as_f64().unwrap() - 0.5 * report["tool_diameter_mm"].as_f64().unwrap();
            if let Some(smallest) = certificate["path_radius"]["smallest_concave_mm"].as_f64()
                && !setting.contains(&"--no-arcs")
                && !setting.contains(&"keep")
            {
                assert!(smallest > promised - RADIUS_ROUNDING, "{place}: radius {smallest}, promised {promised}");
            }
            let dialect = Dialect::named(dialect).unwrap();
            let findings = lint(&text, &LintOptions { dialect, stock_top: 0.0 });
            assert!(findings.iter().all(|f| f.severity != Severity::Error), "{place}: {findings:?}");
        }
    }
}

#[test]
fn linuxcnc_runs_the_program_of_every_sample() {
    if std::process::Command::new("rs274").arg("-h").output().is_err() {
        println!("skipped: rs274 (Debian package linuxcnc-uspace) is absent");
        return;
    }
    for drawing in samples() {
        for setting in [&["--dialect", "linuxcnc"][..], &["--dialect", "grbl"], &["--dialect", "linuxcnc", "--inches"]]
        {
            let here = folder();
            let mut arguments = vec![drawing.to_str().unwrap(), "-o", "part.ngc", "--no-preview", "--accept-losses"];
            arguments.extend(setting);
            let made = mill(here.path(), &arguments);
            assert_eq!(made.status.code(), Some(0), "{}: {}", drawing.display(), stdout(&made));
            draw(here.path(), "tool.tbl", "T1 P1 D3.175 ;\n");
            draw(here.path(), "empty.var", "");
            let judge = std::process::Command::new("rs274")
                .args(["-t", "tool.tbl", "-v", "empty.var", "-g", "part.ngc", "out.canon"])
                .current_dir(here.path())
                .output()
                .unwrap();
            assert!(judge.status.success(), "{} {setting:?}: {}", drawing.display(), stderr(&judge));
            let canon = fs::read_to_string(here.path().join("out.canon")).unwrap();
            assert!(canon.contains("PROGRAM_END") && canon.matches("ARC_FEED").count() > 3, "{}", drawing.display());
        }
    }
}

#[test]
fn a_lost_feature_is_named_and_fails_with_the_program_still_written() {
    let here = folder();
    draw(here.path(), "plate.svg", &format!("{SIZED}{PLATE_WITH_SMALL_HOLE}"));
    let output = mill(here.path(), &["plate.svg"]);
    assert_eq!(output.status.code(), Some(1));
    let said = stdout(&output);
    // In the machine's coordinates: the corner of the part is its origin, y points up.
    assert!(
        said.contains("hole 2.00 mm wide at (16.000, 15.000): filled; the tool of 3.175 mm does not fit"),
        "{said}"
    );
    assert!(said.contains("--accept-losses"), "{said}");
    assert_eq!(names(here.path()), ["plate.nc", "plate.png", "plate.svg"]);

    let accepted = mill(here.path(), &["plate.svg", "--accept-losses"]);
    assert_eq!(accepted.status.code(), Some(0));
    assert!(stdout(&accepted).contains("hole 2.00 mm wide"));
    let smaller = mill(here.path(), &["plate.svg", "--tool-diameter", "1.5mm", "--path-radius", "0"]);
    assert_eq!(smaller.status.code(), Some(0), "{}", stdout(&smaller));
    assert!(stdout(&smaller).contains("lost            nothing"));
}

#[test]
fn without_a_size_nothing_is_guessed() {
    let here = folder();
    draw(here.path(), "plate.svg", &format!(r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 40">{PLATE}"#));
    assert_refused(here.path(), &["plate.svg"], &["plate.svg", "no physical size", "--dpi", "--width"]);
    let output = mill(here.path(), &["plate.svg", "--width", "100mm"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("100.00 x 60.00 mm"), "{}", stdout(&output));
}

#[test]
fn bad_input_gets_one_sentence_and_leaves_nothing() {
    let here = folder();
    let good = format!("{SIZED}{PLATE}");
    draw(here.path(), "plate.svg", &good);
    draw(here.path(), "empty.svg", "");
    draw(here.path(), "cut.svg", &good[..good.len() / 2]);
    draw(here.path(), "blank.svg", &format!("{SIZED}</svg>"));
    draw(here.path(), "job.toml", "tool-diamter = \"3mm\"\n");
    let refuse = |arguments: &[&str], words: &[&str]| assert_refused(here.path(), arguments, words);
    refuse(&["missing.svg"], &["missing.svg"]);
    refuse(&["empty.svg"], &["empty.svg"]);
    refuse(&["cut.svg"], &["cut.svg"]);
    refuse(&["blank.svg"], &["blank.svg"]);
    refuse(&["."], &["folder"]);
    refuse(&["plate.svg", "--path-radius", "nan"], &["--path-radius"]);
    refuse(&["plate.svg", "--path-radius", "-1mm"], &["path-radius"]);
    refuse(&["plate.svg", "--path-radius", "1e9"], &["path-radius"]);
    refuse(&["plate.svg", "--tool-diameter", "0"], &["tool-diameter"]);
    refuse(&["plate.svg", "--tool-diameter", "inf"], &["--tool-diameter"]);
    refuse(&["plate.svg", "--depth", "0"], &["depth"]);
    refuse(&["plate.svg", "--safe-height", "-1"], &["safe-height", "stock-top"]);
    refuse(&["plate.svg", "--spindle-speed", "-1"], &["spindle-speed", "above zero"]);
    refuse(&["plate.svg", "--dwell", "-1"], &["dwell"]);
    refuse(&["plate.svg", "--dpi", "-5"], &["--dpi", "above zero"]);
    refuse(&["plate.svg", "--width", "1e12"], &["plate.svg", "scale"]);
    refuse(&["plate.svg", "--width", "1e-9"], &["plate.svg", "e-9 mm across", "scale"]);
    refuse(&["plate.svg", "--dialect", "fanuc"], &["fanuc", "grbl", "linuxcnc"]);
    refuse(&["plate.svg", "--job", "job.toml"], &["job.toml", "tool-diamter"]);
    refuse(&["plate.svg", "--tool-diameter", "500mm"], &["plate.svg", "larger than the whole part", "scale"]);
    refuse(&["plate.svg", "--side", "inside", "--tool-diameter", "50mm"], &["plate.svg", "tool"]);
    refuse(&["plate.svg", "-o", "no/such/folder/plate.nc"], &["no/such/folder/plate.nc", "cannot be written"]);
}

#[test]
fn where_the_picture_cannot_be_written_there_is_no_program_either() {
    let here = folder();
    draw(here.path(), "plate.svg", &format!("{SIZED}{PLATE}"));
    fs::create_dir(here.path().join("plate.png")).unwrap();
    assert_refused(here.path(), &["plate.svg"], &["plate.png", "cannot be written"]);
    let output = mill(here.path(), &["plate.svg", "--no-preview"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn the_same_drawing_gives_the_same_bytes() {
    let (here, there) = (folder(), folder());
    let word = sample("word.svg");
    for folder in [here.path(), there.path()] {
        mill(folder, &[word.to_str().unwrap()]);
    }
    for name in ["word.nc", "word.png"] {
        assert!(fs::read(here.path().join(name)).unwrap() == fs::read(there.path().join(name)).unwrap(), "{name}");
    }
}

#[test]
fn a_program_on_standard_output_is_nothing_but_the_program() {
    let here = folder();
    let drawing = format!("{SIZED}{PLATE}");
    let output = clopen(here.path()).args(["mill", "-", "-o", "-"]).write_stdin(drawing.clone()).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("gouge"), "{}", stderr(&output));
    assert!(names(here.path()).is_empty());
    // Each line is a comment or words.
    assert!(stdout(&output).lines().all(|l| l.starts_with(['(', ';', 'G', 'M'])), "{}", stdout(&output));
    assert!(read(stdout(&output)).unwrap().motions.len() > 10);

    let named = clopen(here.path()).args(["mill", "-"]).write_stdin(drawing).output().unwrap();
    assert_eq!(named.status.code(), Some(0));
    assert_eq!(names(here.path()), ["part.nc", "part.png"]);
}

#[test]
fn flags_beat_the_job_file_and_the_job_file_beats_defaults() {
    let here = folder();
    draw(here.path(), "plate.svg", &format!("{SIZED}{PLATE}"));
    draw(here.path(), "job.toml", "tool-diameter = \"1/8in\"\ndepth = 4\ndepth-per-pass = \"2mm\"\nfeed = 600\n");
    let output = mill(here.path(), &["plate.svg", "--job", "job.toml", "--feed", "900", "--no-preview"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let program = fs::read_to_string(here.path().join("plate.nc")).unwrap();
    for words in ["depth 4 mm, at most 2 mm a pass, 2 passes", "feed 900 mm/min", "F900"] {
        assert!(program.contains(words), "{words} is missing in: {program}");
    }
    assert!(stdout(&output).contains("2 passes"), "{}", stdout(&output));
}

#[test]
fn the_certificate_as_json_has_units_in_its_names() {
    let here = folder();
    draw(here.path(), "plate.svg", &format!("{SIZED}{PLATE_WITH_SMALL_HOLE}"));
    let output = mill(here.path(), &["plate.svg", "--format", "json"]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["part_width_mm"], 50.0);
    assert_eq!(report["part_topology"]["holes"], 1);
    assert_eq!(report["good"], false);
    assert_eq!(report["lost_features"][0]["kind"], "hole_filled");
    assert_eq!(report["written"][0], "plate.nc");
    let certificate = &report["certificate"];
    assert_eq!(certificate["statistics"]["depth_mm"], 3.0);
    assert_eq!(certificate["statistics"]["passes"], 3);
    assert_eq!(certificate["uncut"]["is_cut_free"], true);
    // The hole that was not drilled.
    let area = certificate["uncut"]["area_mm2"].as_f64().unwrap();
    assert!((area - std::f64::consts::PI).abs() < 0.01, "{area}");
    assert!(certificate["time"].as_object().unwrap().keys().all(|k| k.ends_with("seconds")));
}

#[test]
fn nothing_that_is_read_or_written_is_written_over() {
    let folder = folder();
    draw(folder.path(), "part.png", &format!("{SIZED}{PLATE}"));
    // The picture would take the drawing's place, or the program's.
    for arguments in [["part.png", "-o", "part.nc"], ["part.png", "-o", "part.png"], ["part.png", "-o", "out.png"]] {
        assert_eq!(mill(folder.path(), &arguments).status.code(), Some(2), "{arguments:?}");
        assert_eq!(names(folder.path()), ["part.png"], "{arguments:?}");
    }
    let output = mill(folder.path(), &["part.png", "-o", "part.nc", "--no-preview"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

/// `/dev/full` is handed over as an open stream: no path of it reaches the program.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_and_a_mute_standard_error_is_no_crash() {
    let full = || fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let folder = folder();
    draw(folder.path(), "part.svg", &format!("{SIZED}{PLATE}"));
    let run = |arguments: &[&str]| {
        let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("clopen"));
        command.current_dir(folder.path()).args(arguments);
        command
    };
    let told = run(&["mill", "part.svg", "--format", "json"]).stdout(full()).output().unwrap();
    assert_eq!(told.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&told.stderr).contains("standard output"));
    let mute = run(&["close", "part.svg", "-r", "1mm", "-o", "closed.svg"]).stderr(full()).status().unwrap();
    assert_eq!(mute.code(), Some(0));
}

#[test]
fn certificates_say_what_the_flags_make_of_the_program() {
    let dir = folder();
    draw(dir.path(), "plate.svg", &format!("{SIZED}{PLATE}"));
    let words = |arguments: &[&str]| {
        let output = mill(dir.path(), &[&["plate.svg", "--accept-losses"], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}{}", stdout(&output), stderr(&output));
        stdout(&output).to_owned()
    };
    let line = |text: &str, label: &str| text.lines().find(|l| l.starts_with(label)).map(str::to_owned);
    // Broken into lines, the path keeps the radius that it had.
    let (arcs, lines) = (words(&[]), words(&["--no-arcs"]));
    let path = line(&arcs, "path").unwrap();
    assert!(!path.contains("0.000") && !path.contains("lines"), "{path}");
    assert_eq!(line(&lines, "path").unwrap(), format!("{path} (before it was broken into lines)"));
    // Inches beside millimetres, and only there.
    let inches = words(&["--inches"]);
    assert!(line(&inches, "part").unwrap().contains("50.00 x 30.00 mm (1.9685 x 1.1811 in)"), "{inches}");
    assert!(line(&inches, "tool").unwrap().contains("3.175 mm (0.12500 in)"), "{inches}");
    assert!(!arcs.contains(" in)"), "{arcs}");
    // On the outline nothing is gouged: half of the tool's width is meant.
    let on = words(&["--side", "on"]);
    assert!(line(&on, "gouge").is_none() && line(&on, "uncut").is_none(), "{on}");
    assert!(line(&on, "centre").is_some() && on.contains("1.587 mm on either side"), "{on}");
}

#[test]
fn a_job_file_sets_what_the_flags_do() {
    let dir = folder();
    draw(dir.path(), "plate.svg", &format!("{SIZED}{PLATE}"));
    draw(dir.path(), "job.toml", "dialect = \"linuxcnc\"\nno-arcs = true\ninches = true\ntopology = \"keep\"\n");
    let output = mill(dir.path(), &["plate.svg", "--job", "job.toml", "-o", "from-file.nc"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let arguments = ["--dialect", "linuxcnc", "--no-arcs", "--inches", "--topology", "keep"];
    let output = mill(dir.path(), &[&["plate.svg", "-o", "from-flags.nc"], &arguments[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = |name: &str| fs::read_to_string(dir.path().join(name)).unwrap();
    assert_eq!(text("from-file.nc"), text("from-flags.nc"));
    assert!(text("from-file.nc").contains("G20") && !text("from-file.nc").contains("G2 X"));
    // Flags beat the file.
    let output = mill(dir.path(), &["plate.svg", "--job", "job.toml", "--dialect", "grbl", "-o", "grbl.nc"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(text("grbl.nc").contains("dialect grbl") && !text("grbl.nc").contains("G64"));
    draw(dir.path(), "job.toml", "dialect = \"fanuc\"\n");
    let output = mill(dir.path(), &["plate.svg", "--job", "job.toml"]);
    assert!(output.status.code() == Some(2) && stderr(&output).contains("grbl, linuxcnc"), "{}", stderr(&output));
}

#[test]
fn what_was_written_for_one_controller_is_linted_for_it() {
    let dir = folder();
    draw(dir.path(), "plate.svg", &format!("{SIZED}{PLATE}"));
    mill(dir.path(), &["plate.svg", "-o", "part.nc", "--dialect", "linuxcnc"]);
    let lint = |arguments: &[&str]| clopen(dir.path()).arg("lint").args(arguments).output().unwrap();
    let text = fs::read_to_string(dir.path().join("part.nc")).unwrap();
    assert!(text.contains("G64"));
    let output = lint(&["part.nc"]);
    assert!(output.status.code() == Some(0) && output.stdout.is_empty(), "{}", stdout(&output));
    assert_eq!(lint(&["part.nc", "--dialect", "portable"]).status.code(), Some(1));
    // The same from somebody else runs on either, or it is said.
    draw(dir.path(), "other.nc", &text.replace("(clopen", "(other"));
    assert_eq!(lint(&["other.nc"]).status.code(), Some(1));
    // What follows the end is said once; comments and % may follow.
    draw(dir.path(), "after.nc", &(text.clone() + "(end)\n%\n"));
    assert!(lint(&["after.nc"]).stdout.is_empty());
    draw(dir.path(), "after.nc", &(text + "G0 Z-3\nG1 X9\n"));
    let output = lint(&["after.nc"]);
    assert_eq!(stdout(&output).matches("follows M2 or M30").count(), 1, "{}", stdout(&output));
}

#[test]
fn drawings_without_size_and_numbers_without_sense_get_one_short_sentence() {
    let dir = folder();
    let invalid = SIZED.replace("0 0 60 40", "a b c");
    draw(dir.path(), "plate.svg", &format!("{SIZED}{PLATE}"));
    draw(dir.path(), "invalid.svg", &format!("{invalid}{PLATE}"));
    let refused = |arguments: &[&str]| {
        let output = clopen(dir.path()).args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stdout(&output));
        stderr(&output).to_owned()
    };
    let text = refused(&["mill", "invalid.svg"]);
    assert!(
        text.contains("viewBox=\"a b c\"") && text.contains("no physical size") && text.contains("--dpi"),
        "{text}"
    );
    for arguments in [
        ["close", "plate.svg", "-r", "1e300mm"],
        ["close", "plate.svg", "-r", "1e-300mm"],
        ["mill", "plate.svg", "--feed", "1e300"],
        ["mill", "plate.svg", "--depth", "1e300"],
    ] {
        let text = refused(&arguments);
        assert!(text.len() < 300 && !text.contains("0000000000"), "{text}");
    }
    assert!(refused(&["close", "plate.svg", "-r", "2furlongs"]).contains("a bare number is millimetres"));
    // A font that is none is a slip even where there is no text.
    let text = refused(&["close", "plate.svg", "-r", "1mm", "--font", "/nonexistent"]);
    assert!(text.contains("/nonexistent"), "{text}");
    draw(dir.path(), "huge.nc", &format!("G21 G90 X{} ?{}\n", "9".repeat(4000), "!".repeat(4000)));
    let output = clopen(dir.path()).args(["lint", "huge.nc"]).output().unwrap();
    assert!(output.status.code() == Some(1) && output.stdout.len() < 1000, "{}", stdout(&output));
}

#[test]
fn a_check_against_nothing_is_infinite_in_words_of_json() {
    let dir = folder();
    draw(dir.path(), "plate.svg", &format!("{SIZED}{PLATE}"));
    draw(dir.path(), "empty.svg", &format!("{SIZED}</svg>"));
    let arguments = ["check", "plate.svg", "empty.svg", "-r", "1mm", "--format", "json"];
    let output = clopen(dir.path()).args(arguments).output().unwrap();
    let value: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(value["hausdorff"]["reference_to_output_units"], "infinite");
    assert_eq!(value["hausdorff"]["largest_over_r"], "infinite");
}
