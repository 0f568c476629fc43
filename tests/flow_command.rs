//! The whole command `clopen flow`: from a drawing to states, pictures, a report and an exit status.

use std::f64::consts::{PI, SQRT_2};
use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use clopen::io::svg::{Drawing, ReadOptions, read};
use clopen::plane::{BoundaryIndex, Point};
use serde_json::Value;

/// A comb, 100 by 40 mm, of user units of a millimetre.
const COMB: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="40mm" viewBox="0 0 100 40"><path id="comb" d="M5 35V5H15V25H25V5H35V25H45V5H55V25H65V5H75V25H85V5H95V35Z"/></svg>"#;

/// An angle whose one inside corner is at (10, 10).
const ANGLE: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="30mm" height="30mm" viewBox="0 0 30 30"><path d="M0 0H30V10H10V30H0Z"/></svg>"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("comb.svg"), COMB).unwrap();
    fs::write(folder.path().join("angle.svg"), ANGLE).unwrap();
    folder
}

fn flow(folder: &Path, arguments: &str) -> Output {
    let mut command = Command::cargo_bin("clopen").unwrap();
    command.current_dir(folder).arg("flow").args(arguments.split_whitespace()).output().unwrap()
}

fn flow_well(folder: &Path, arguments: &str) -> Output {
    let output = flow(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments}: {}", words(&output));
    output
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap()
}

fn drawing(bytes: &[u8]) -> Drawing {
    read(bytes, &ReadOptions::default()).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// How far the outline of a file has gone from a point of the file.
fn gone_from(file: &Path, x: f64, y: f64) -> f64 {
    BoundaryIndex::new(&drawing(&fs::read(file).unwrap()).region).distance(Point::new(x, -y))
}

/// How far a disk of radius `r` keeps out of a right corner.
fn corner_depth(r: f64) -> f64 {
    r * (SQRT_2 - 1.0)
}

#[test]
fn the_limit_of_a_corner_is_a_fillet_on_standard_output() {
    let folder = folder();
    let output = flow_well(folder.path(), "angle.svg --op close -r 3mm");
    let closed = drawing(&output.stdout);
    let expected = 500.0 + 9.0 * (1.0 - PI / 4.0);
    assert!((closed.region.area() - expected).abs() < 0.05, "{} is not {expected}", closed.region.area());
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    assert!(text.contains("viewBox=\"0 0 30 30\"") && text.contains("L30 0"), "{text}");
    assert!(words(&output).contains("5 of 6 vertices kept bit for bit"), "{}", words(&output));
    assert_eq!(output.stdout, flow(folder.path(), "angle.svg --op close -r 3mm").stdout, "the same bytes again");
    let opened = drawing(&flow_well(folder.path(), "angle.svg --op open -r 3mm").stdout);
    let expected = 500.0 - 5.0 * 9.0 * (1.0 - PI / 4.0);
    assert!((opened.region.area() - expected).abs() < 0.1, "{} is not {expected}", opened.region.area());
    let both = drawing(&flow_well(folder.path(), "angle.svg --op clopen -r 3mm").stdout);
    let expected = 500.0 - 4.0 * 9.0 * (1.0 - PI / 4.0);
    assert!((both.region.area() - expected).abs() < 0.15, "{} is not {expected}", both.region.area());
}

#[test]
fn states_are_even_in_time() {
    let folder = folder();
    for arguments in ["--time 0.08", ""] {
        let command =
            format!("angle.svg --op close -r 3mm {arguments} --frames 4 --stills s.svg -o last.svg --format json");
        let report = json(&flow_well(folder.path(), &command));
        let times: Vec<f64> = report["frames"].as_array().unwrap().iter().map(|f| number(&f["time_r2"])).collect();
        assert_eq!(times.len(), 4);
        let end = number(&report["time_r2"]);
        for (k, time) in times.iter().enumerate() {
            assert!((time / end - (k + 1) as f64 / 4.0).abs() < 1e-9, "{times:?}");
        }
        if arguments.is_empty() {
            assert!(report["end"].is_string() && end > 0.08, "{report}");
        } else {
            assert!(report["end"].is_null() && (end - 0.08).abs() < 1e-12, "{report}");
        }
        let last = fs::read(folder.path().join("last.svg")).unwrap();
        assert_eq!(last, fs::read(folder.path().join("s-04.svg")).unwrap());
        let areas: Vec<f64> = (1..=4)
            .map(|k| drawing(&fs::read(folder.path().join(format!("s-{k:02}.svg"))).unwrap()).region.area())
            .collect();
        assert!(areas.windows(2).all(|pair| pair[0] < pair[1]) && areas[0] > 500.0, "{areas:?}");
        assert!(!folder.path().join("s-05.svg").exists());
    }
}

/// A flow that ends before the time that was asked for has its frames in the time that it took.
#[test]
fn states_of_a_flow_that_ends_early_are_even_too() {
    let folder = folder();
    let report = json(&flow_well(
        folder.path(),
        "angle.svg --op close -r 3mm --time 1000 --frames 5 --sheet s.png --format json",
    ));
    let end = number(&report["time_r2"]);
    assert!(end < 10.0);
    assert!((number(&report["frames"][0]["time_r2"]) / end - 0.2).abs() < 1e-9, "{report}");
}

#[test]
fn states_are_even_in_area() {
    let folder = folder();
    let command = "comb.svg --op close -r 3mm --frames 5 --frames-by area --stills {}.svg --format json";
    let report = json(&flow_well(folder.path(), command));
    let areas: Vec<f64> =
        report["frames"].as_array().unwrap().iter().map(|f| number(&f["area_square_units"])).collect();
    let whole = areas[4] - number(&report["area_in_square_units"]);
    assert!(whole > 1.0, "{report}");
    for (k, area) in areas.iter().enumerate() {
        let part = (area - number(&report["area_in_square_units"])) / whole;
        assert!((part - (k + 1) as f64 / 5.0).abs() < 0.03, "{part} in state {}: {areas:?}", k + 1);
    }
    assert!(folder.path().join("05.svg").exists());
}

#[test]
fn pictures_are_what_they_should_be() {
    let folder = folder();
    let output = flow_well(
        folder.path(),
        "comb.svg --op open -r 4mm --frames 6 --frames-by area --animation a.svg --apng a.png --sheet s.png --size 500",
    );
    assert!(output.stdout.is_empty(), "the drawing was not asked for");
    for name in ["a.svg", "a.png", "s.png"] {
        assert!(words(&output).contains(name), "{}", words(&output));
    }
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    let svg = String::from_utf8(bytes("a.svg")).unwrap();
    // The comb itself and six states.
    assert_eq!(svg.matches("<animate ").count(), 7 + 7, "{svg}");
    assert_eq!(svg.matches(" r²").count(), 7);
    assert!(read(svg.as_bytes(), &ReadOptions::default()).is_ok());
    let reader = png::Decoder::new(std::io::Cursor::new(bytes("a.png"))).read_info().unwrap();
    assert_eq!(reader.info().animation_control().unwrap().num_frames, 7);
    assert_eq!(reader.info().color_type, png::ColorType::Indexed);
    let size = |name: &str| {
        let picture = tiny_skia::Pixmap::decode_png(&bytes(name)).unwrap();
        (picture.width(), picture.height())
    };
    assert_eq!(size("s.png").0, 500);
    assert_eq!(size("a.png").0.max(size("a.png").1), 500);
}

#[test]
fn pinned_corners_stay_bit_for_bit() {
    let folder = folder();
    flow_well(folder.path(), "comb.svg --op clopen -r 3mm --pin 44,0,12,15 --pin-circle 95,35,1 -o out.svg");
    let out = folder.path().join("out.svg");
    for (x, y) in [(45.0, 5.0), (55.0, 5.0), (95.0, 35.0)] {
        assert_eq!(gone_from(&out, x, y), 0.0, "({x}, {y}) is pinned");
    }
    for (x, y) in [(25.0, 5.0), (35.0, 5.0), (5.0, 35.0), (95.0, 5.0)] {
        let gone = gone_from(&out, x, y);
        assert!((gone - corner_depth(3.0)).abs() < 0.05, "({x}, {y}) has moved by {gone}");
    }
    assert!(gone_from(&out, 45.0, 25.0) > 1.0, "what is not pinned moves");
}

#[test]
fn a_flow_of_which_nothing_comes_any_more_ends_with_its_reason_and_the_best_state() {
    let folder = folder();
    // Between pins a flow without a bound comes ever nearer to straight lines, and no tolerance like this is ever met.
    let kite = r#"<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100"><path d="M0 0L50 10L100 0L50 100Z"/></svg>"#;
    fs::write(folder.path().join("kite.svg"), kite).unwrap();
    let pins = "--pin=-1,-1,2,2 --pin 99,-1,2,2 --pin 49,99,2,2";
    let output = flow(folder.path(), &format!("kite.svg -r 60mm --bound none --tolerance 1e-13 {pins} -o out.svg"));
    assert_eq!(output.status.code(), Some(1), "{}", words(&output));
    assert!(words(&output).contains("STALLED"), "{}", words(&output));
    let out = folder.path().join("out.svg");
    for (x, y) in [(0.0, 0.0), (100.0, 0.0), (50.0, 100.0)] {
        assert_eq!(gone_from(&out, x, y), 0.0, "({x}, {y}) is pinned");
    }
    let gone = gone_from(&out, 50.0, 0.0);
    assert!(gone < 0.01, "the dent is as good as straight: {gone}");
}

#[test]
fn radii_vary_along_a_line() {
    let folder = folder();
    flow_well(
        folder.path(),
        "comb.svg --op close --radius-from 15,0=1.5mm --radius-to 85,35=4.5mm --edge-length 0.2mm -o out.svg",
    );
    let file = folder.path().join("out.svg");
    // The direction of the gradient is slanted; what counts is where the fillet is.
    let radius = |x: f64, y: f64| {
        let t = ((x - 15.0) * 70.0 + y * 35.0) / (70.0 * 70.0 + 35.0 * 35.0);
        1.5 + 3.0 * t
    };
    let mut fillets = vec![];
    for x in [15.0, 25.0, 35.0, 45.0, 55.0, 65.0, 75.0, 85.0] {
        let (gone, expected) = (gone_from(&file, x, 25.0), corner_depth(radius(x, 25.0)));
        assert!((gone - expected).abs() < 0.12 * expected, "at x {x}: {gone}, expected about {expected}");
        fillets.push(gone);
    }
    assert!(fillets[7] > 1.6 * fillets[0], "{fillets:?}");
}

/// Writes a PNG of so many columns.
fn picture(path: &Path, columns: u32, color: png::ColorType, data: &[u8]) {
    let mut bytes = Vec::new();
    let rows = (data.len() / color.samples()) as u32 / columns;
    let mut encoder = png::Encoder::new(&mut bytes, columns, rows);
    encoder.set_color(color);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(data).unwrap();
    writer.finish().unwrap();
    fs::write(path, bytes).unwrap();
}

#[test]
fn radii_vary_by_a_picture_over_the_page() {
    let folder = folder();
    // Black over the left half of the page, white over the right.
    picture(&folder.path().join("map.png"), 4, png::ColorType::Grayscale, &[0, 0, 255, 255, 0, 0, 255, 255]);
    flow_well(
        folder.path(),
        "comb.svg --op close --radius-map map.png --radius-black 1mm --radius-white 3mm -o out.svg",
    );
    let file = folder.path().join("out.svg");
    for (x, r) in [(15.0, 1.0), (25.0, 1.0), (75.0, 3.0), (85.0, 3.0)] {
        let gone = gone_from(&file, x, 25.0);
        assert!((gone - corner_depth(r)).abs() < 0.03 * r, "at x {x}: {gone}");
    }
}

/// The area of whatever shrinks by its curvature falls by 2 pi in a unit of time.
#[test]
fn without_a_bound_curves_shorten() {
    let folder = folder();
    fs::write(folder.path().join("disk.svg"), "<svg viewBox='0 0 20 20'><circle cx='10' cy='10' r='5'/></svg>")
        .unwrap();
    let output = flow_well(folder.path(), "disk.svg --bound none -r 2u --time 1.5 -o out.svg --format json");
    let area = number(&json(&output)["area_out_square_units"]);
    let expected = PI * (25.0 - 2.0 * 1.5 * 4.0);
    assert!((area / expected - 1.0).abs() < 0.01, "{area} is not {expected}");
    assert!(json(&output)["operation"].is_null());
}

/// A small island stands where the fillet of the corner comes to be.
#[test]
fn a_flow_that_runs_into_itself_says_so() {
    let folder = folder();
    let island = ANGLE.replace("H0Z", "H0Z M10.6 10.6H11.2V11.2H10.6Z");
    fs::write(folder.path().join("island.svg"), island).unwrap();
    let run = |on_contact: &str| {
        let command =
            format!("island.svg --op close -r 6mm --on-contact {on_contact} -o {on_contact}.svg --format json");
        let output = flow(folder.path(), &command);
        assert_eq!(output.status.code(), Some(1), "{on_contact}: {}", words(&output));
        assert!(folder.path().join(format!("{on_contact}.svg")).exists(), "the state is written all the same");
        json(&output)
    };
    let (stopped, reported) = (run("stop"), run("report"));
    assert_eq!(stopped["end"], "contact");
    assert_ne!(reported["end"], "contact");
    assert!(number(&stopped["time_r2"]) < number(&reported["time_r2"]));
    for report in [stopped, reported] {
        let place = report["contacts_units"][0].as_array().unwrap().iter().map(number).collect::<Vec<_>>();
        assert!(place.iter().all(|x| (10.3..11.5).contains(x)), "{place:?}");
    }
    let output = flow(folder.path(), "island.svg --op close -r 6mm -o o.svg");
    assert!(words(&output).contains("ran into itself near"), "{}", words(&output));
}

#[test]
fn bad_input_is_told_in_a_sentence() {
    let folder = folder();
    let here = folder.path();
    picture(&here.join("flat.png"), 2, png::ColorType::Grayscale, &[7; 4]);
    picture(&here.join("colour.png"), 2, png::ColorType::Rgb, &[0, 0, 0, 255, 0, 0]);
    let map = "--radius-black 1 --radius-white 2 --radius-map";
    for (arguments, expected) in [
        ("--op close -r 2 --frames 0 --sheet s.png", "--frames 0"),
        ("--op close -r 2 --frames -3 --sheet s.png", "--frames -3"),
        ("--op close -r 2 --frames 1000000 --sheet s.png", "--frames 1000000"),
        ("--op close -r 2 --frames 3 -o o.svg", "--sheet"),
        ("--op close -r 2 --time -1", "--time -1"),
        ("--op close -r 2 --time NaN", "--time NaN"),
        ("--op close -r 2 --time 0", "--time 0"),
        ("--op close -r 2 --time inf", "--time inf"),
        ("--op close -r 0", "--radius"),
        ("--op close -r -2mm", "--radius"),
        ("--op close -r 5000m", "no length"),
        ("--op close -r 900000mm", "is the unit right"),
        ("--op close", "no radius"),
        ("-r 2", "--op"),
        ("-r 2 --bound curvature", "--op"),
        ("--op close --radius-from 1,2=3", "--radius-to"),
        ("--op close --radius-from 1,2=3 --radius-to 1,2=4", "same place"),
        ("--op close --radius-from 1,2=3 --radius-to 1,3=0", "--radius-to"),
        ("--op close --radius-from 1=3 --radius-to 1,3=2", "10,0=1mm"),
        (&format!("--op close {map} flat.png"), "without grey"),
        (&format!("--op close {map} colour.png"), "without grey"),
        (&format!("--op close {map} comb.svg"), "no PNG"),
        (&format!("--op close {map} nothing.png"), "nothing.png"),
        ("--op close -r 2 --pin 200,200,3,3", "touches no outline"),
        ("--op close -r 2 --pin 40,28,3,3", "touches no outline"),
        ("--op close -r 2 --pin 1,2,3", "width"),
        ("--op close -r 2 --pin-circle 0,0,-1", "radius above zero"),
        ("--op close -r 2 --edge-length 5mm", "edge length"),
        ("--op close -r 2 --time-step 0", "time step"),
        ("--op close -r 2 --tolerance -1", "tolerance"),
        ("--op close -r 2 --sheet s.png --size 3", "--size 3"),
        ("--op close -r 2 -o comb.svg", "written over"),
        ("--op close -r 2 -o a.svg --animation a.svg", "two results"),
        ("--op close -r 2 --sheet no/where.png", "folder"),
        ("--op close -r 2 --format json", "-o OUT.svg"),
    ] {
        let output = flow(here, &format!("comb.svg {arguments}"));
        assert_eq!(output.status.code(), Some(2), "{arguments}: {}", words(&output));
        assert!(words(&output).contains(expected), "{arguments}: {}", words(&output));
        assert!(output.stdout.is_empty(), "{arguments}");
    }
    let mut names: Vec<String> =
        fs::read_dir(here).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    assert_eq!(names, ["angle.svg", "colour.png", "comb.svg", "flat.png"], "nothing is written");
}
