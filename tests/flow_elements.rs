//! The command `clopen flow` on some elements of a drawing: chosen ones, ones with radii of their own, ones that pin.

use std::f64::consts::{PI, SQRT_2};
use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use clopen::io::svg::{self, Drawing, ReadOptions, Selection};
use clopen::plane::{BoundaryIndex, Point, Region};
use serde_json::Value;

fn page(body: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100mm\" height=\"100mm\" viewBox=\"0 0 100 100\">\n{body}\n</svg>"
    )
}

fn folder_with(body: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("in.svg"), page(body)).unwrap();
    folder
}

fn flow(folder: &Path, arguments: &str) -> Output {
    let mut command = Command::cargo_bin("clopen").unwrap();
    command.current_dir(folder).args(["flow", "in.svg"]).args(arguments.split_whitespace()).output().unwrap()
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn flow_well(folder: &Path, arguments: &str) -> Output {
    let output = flow(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments}: {}", words(&output));
    output
}

/// What the flow leaves on standard output.
fn result(folder: &Path, arguments: &str) -> String {
    String::from_utf8(flow_well(folder, arguments).stdout).unwrap()
}

/// The one line that a command says that cannot run.
fn refusal(folder: &Path, arguments: &str) -> String {
    let output = flow(folder, arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments}: {}", words(&output));
    assert!(output.stdout.is_empty(), "{arguments}");
    assert_eq!(words(&output).trim_end().lines().count(), 1, "{}", words(&output));
    words(&output)
}

fn drawing(text: &str) -> Drawing {
    svg::read(text.as_bytes(), &ReadOptions::default()).unwrap()
}

/// The element of that name by itself.
fn element(text: &str, id: &str) -> Region {
    let selection = Selection { only: vec![id.to_owned()], ..Selection::default() };
    svg::read_parts(text.as_bytes(), &ReadOptions::default(), &selection).unwrap().chosen().region.clone()
}

/// The path data of the element of that name, as written.
fn data<'t>(text: &'t str, id: &str) -> &'t str {
    let at = text.find(&format!("id=\"{id}\"")).unwrap_or_else(|| panic!("no {id} in {text}"));
    let data = &text[at..];
    let data = &data[data.find(" d=\"").unwrap() + 4..];
    &data[..data.find('"').unwrap()]
}

/// How far the outline has gone from a point of the file.
fn gone_from(region: &Region, x: f64, y: f64) -> f64 {
    BoundaryIndex::new(region).distance(Point::new(x, -y))
}

/// How far a disk of radius `r` keeps out of a right corner.
fn corner_depth(r: f64) -> f64 {
    r * (SQRT_2 - 1.0)
}

/// How far the points of the boundary of `a` lie from that of `b`, at most.
fn farthest(a: &Region, b: &Region) -> f64 {
    let index = BoundaryIndex::new(b);
    a.segments().flat_map(|s| [s.start, s.point_at(0.5)]).map(|p| index.distance(p)).fold(0.0, f64::max)
}

/// The vertices in an order of their own, to the last bit.
fn vertices(region: &Region) -> Vec<(u64, u64)> {
    let all = region.rings.iter().flat_map(|r| &r.vertices);
    let mut all: Vec<_> = all.map(|v| (v.point.x.to_bits(), v.point.y.to_bits())).collect();
    all.sort_unstable();
    all
}

/// A jigsaw part and the plate that it lies in.
const TAB: &str = "M30 30H45V40A5 5 0 0 0 55 40V30H70V45L60 50L70 55V70C60 60 40 60 30 70Z";

#[test]
fn interlocking_parts_keep_their_fit() {
    let body = format!("<path id='A' d='{TAB}'/><path id='B' fill-rule='evenodd' d='M5 5H95V95H5Z{TAB}'/>");
    let input = page(&body);
    for (time, h) in [("", 0.16), ("", 0.08), ("--time 0.1", 0.16), ("--time 0.1", 0.08)] {
        let edge = format!("-r 2 --edge-length {h} {time}");
        let folder = folder_with(&body);
        let first = result(folder.path(), &format!("--op close {edge} --only A"));
        assert_eq!(data(&first, "B").matches('M').count(), 2);
        let (plate, before) = (element(&first, "B"), element(&input, "B"));
        assert_eq!(vertices(&plate), vertices(&before), "the counterpart is as it was");
        fs::write(folder.path().join("in.svg"), &first).unwrap();
        let both = result(folder.path(), &format!("--op open {edge} --only B"));
        assert_eq!(data(&first, "A"), data(&both, "A"));
        let (a, b) = (element(&both, "A"), element(&both, "B"));
        assert!(a.area() > element(&input, "A").area() + 0.5, "nothing was closed");
        // The hole of the plate is the outline of the part.
        let hole = Region::new(b.rings.iter().filter(|r| r.area() < 0.0).map(|r| r.reversed()).collect());
        assert_eq!(hole.rings.len(), 1);
        let apart = farthest(&a, &hole).max(farthest(&hole, &a));
        // Opening is closing of what is empty, step by step: the same vertices and arcs, but for the digits of the file.
        assert!(apart < 1e-9, "{edge}: {apart:e}");
    }
}

const THREE: &str = "<path id='a' d='M5 5H35V15H15V35H5Z'/><g id='g'><path id='b' d='M45 5H75V15H55V35H45Z'/></g>\
    <path id='c' d='M5 45H35V55H15V75H5Z'/>";

#[test]
fn the_other_elements_are_written_unchanged_and_shown() {
    let folder = folder_with(THREE);
    let corner = |region: &Region, id: &str| {
        let (x, y) =
            [("a", (15.0, 15.0)), ("b", (55.0, 15.0)), ("c", (15.0, 55.0))].into_iter().find(|c| c.0 == id).unwrap().1;
        gone_from(region, x, y)
    };
    for (arguments, moving) in
        [("--only b", "b"), ("--only g", "b"), ("--except a --except g", "c"), ("--only a --only c", "ac")]
    {
        let text = result(folder.path(), &format!("--op close -r 3 {arguments}"));
        let region = drawing(&text).region;
        for id in ["a", "b", "c"] {
            let expected = if moving.contains(id) { corner_depth(3.0) } else { 0.0 };
            assert!((corner(&region, id) - expected).abs() < 0.01, "{arguments}: {id}");
        }
    }
    let output = flow_well(
        folder.path(),
        "--op close -r 3 --only b --frames 2 --stills s.svg --animation a.svg --sheet s.png --apng a.png --size 400",
    );
    assert!(output.stdout.is_empty());
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    for still in ["s-01.svg", "s-02.svg"] {
        for id in ["a", "c"] {
            assert_eq!(vertices(&element(&read(still), id)), vertices(&element(&page(THREE), id)));
        }
        assert!(corner(&drawing(&read(still)).region, "b") > 0.1);
    }
    // What stands still is there for the whole time; each of the states is there for a part of it.
    let animation = read("a.svg");
    let still = animation.lines().filter(|l| l.starts_with("<path d=") && !l.contains("<animate")).count();
    assert_eq!((still, animation.matches("<animate ").count()), (2, 3 + 3), "{animation}");
    // All three are in the pictures: three times what the one that moves takes up.
    let solid = |name: &str| {
        let picture = tiny_skia::Pixmap::decode_png(&fs::read(folder.path().join(name)).unwrap()).unwrap();
        let colour = |x: f64, y: f64| {
            let at = |side: u32, t: f64| (f64::from(side) * t) as u32;
            picture.pixel(at(picture.width(), x), at(picture.height(), y)).unwrap()
        };
        // In the first arms of all three; the picture is of 70 by 70 units, with margins and a caption.
        [colour(0.12, 0.2), colour(0.63, 0.2), colour(0.12, 0.75), colour(0.8, 0.75)]
    };
    let [a, b, c, nothing] = solid("a.png");
    assert!(a == b && b == c && a != nothing, "{a:?} {b:?} {c:?} {nothing:?}");
}

#[test]
fn elements_pin_by_their_area_painted_or_not() {
    let body = format!(
        "{THREE}<defs><circle id='still' cx='55' cy='15' r='8'/></defs><rect id='plain' fill='none' x='0' y='40' width='40' height='40'/>"
    );
    let folder = folder_with(&body);
    let region = drawing(&result(folder.path(), "--op close -r 3 --pin-id still --pin-id plain")).region;
    assert!((gone_from(&region, 15.0, 15.0) - corner_depth(3.0)).abs() < 0.01, "what is not pinned moves");
    assert_eq!((gone_from(&region, 55.0, 15.0), gone_from(&region, 15.0, 55.0)), (0.0, 0.0));
    let unknown = refusal(folder.path(), "--op close -r 3 --pin-id stil");
    assert!(unknown.contains("--pin-id") && unknown.contains("did you mean \"still\"?"), "{unknown}");
    let outside = folder_with(&format!("{THREE}<defs><circle id='far' cx='90' cy='90' r='2'/></defs>"));
    let far = refusal(outside.path(), "--op close -r 3 --pin-id far");
    assert!(far.contains("--pin-id far touches no outline"), "{far}");
    // Pins hold what flows; what was not chosen needs none.
    let other = refusal(folder.path(), "--op close -r 3 --only a --pin-id still");
    assert!(other.contains("touches no outline"), "{other}");
}

#[test]
fn elements_have_radii_of_their_own() {
    let body = THREE
        .replace("id='a'", "id='a' data-clopen-radius='1mm'")
        .replace("id='g'", "id='g' data-clopen-radius='4u'")
        .replace("id='c'", "id='c' data-clopen-radius='2'");
    let folder = folder_with(&body);
    let check = |arguments: &str, radii: [f64; 3]| {
        let output = flow_well(folder.path(), &format!("--op close {arguments} -o out.svg --format json"));
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        let range = ["smallest_radius_units", "largest_radius_units"].map(|name| report[name].as_f64().unwrap());
        let ends = [radii.iter().copied().fold(f64::MAX, f64::min), radii.iter().copied().fold(0.0, f64::max)];
        assert!((range[0] - ends[0]).abs() < 1e-9 && (range[1] - ends[1]).abs() < 1e-9, "{arguments}: {range:?}");
        let region = drawing(&fs::read_to_string(folder.path().join("out.svg")).unwrap()).region;
        for ((x, y), r) in [(15.0, 15.0), (55.0, 15.0), (15.0, 55.0)].into_iter().zip(radii) {
            let gone = gone_from(&region, x, y);
            assert!((gone - corner_depth(r)).abs() < 0.01 * r, "{arguments}: ({x}, {y}) has gone by {gone}");
        }
        let added = region.area() - drawing(&page(&body)).region.area();
        let expected: f64 = radii.iter().map(|r| (1.0 - PI / 4.0) * r * r).sum();
        assert!((added - expected).abs() < 0.02 * expected, "{arguments}: {added} and not {expected}");
    };
    check("", [1.0, 4.0, 2.0]);
    // Nobody is left that the radius would be for.
    check("-r 9", [1.0, 4.0, 2.0]);
    // Elements without one have that of the command.
    let input = |body: &str| fs::write(folder.path().join("in.svg"), page(body)).unwrap();
    input(&body.replace(" data-clopen-radius='2'", ""));
    check("-r 3", [1.0, 4.0, 3.0]);
    let none = refusal(folder.path(), "--op close");
    assert!(none.contains("no radius for <path id=\"c\"> on line 2") && none.contains("data-clopen-radius"), "{none}");
    let only = result(folder.path(), "--op close --only a");
    assert!((gone_from(&element(&only, "a"), 15.0, 15.0) - corner_depth(1.0)).abs() < 0.01);
    for (bad, why) in [
        ("2 miles", "no length"),
        ("", "no length"),
        ("0mm", "above zero"),
        ("-1u", "above zero"),
        ("900m", "no length"),
        ("1e7u", "is the unit right"),
    ] {
        input(&body.replace("'2'", &format!("'{bad}'")));
        let said = refusal(folder.path(), "--op close -r 1");
        assert!(
            said.contains("data-clopen-radius of <path id=\"c\"> on line 2") && said.contains(why),
            "{bad}: {said}"
        );
    }
}

/// Where outlines of elements cross there are vertices of neither.
#[test]
fn corners_in_which_elements_cross_have_a_radius_of_one_of_them() {
    let bars = |rest: &str| {
        format!(
            "<rect data-clopen-radius='2u' x='10' y='40' width='80' height='20'/><rect {rest} x='40' y='10' width='20' height='80'/>"
        )
    };
    for (rest, arguments, radii) in [
        ("data-clopen-radius='2u'", "", [2.0, 2.0]),
        ("data-clopen-radius='6u'", "", [2.0, 6.0]),
        ("", "-r 6", [2.0, 6.0]),
    ] {
        let folder = folder_with(&bars(rest));
        let region = drawing(&result(folder.path(), &format!("--op close {arguments}"))).region;
        for (x, y) in [(40.0, 40.0), (60.0, 40.0), (60.0, 60.0), (40.0, 60.0)] {
            let gone = gone_from(&region, x, y);
            let (low, high) = (corner_depth(radii[0]), corner_depth(radii[1]));
            assert!(gone > 0.97 * low && gone < 1.03 * high, "({x}, {y}) has gone by {gone}, not {low} to {high}");
        }
    }
}
