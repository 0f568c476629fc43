//! `clopen close`, `open` and `clopen` as a user runs them: both bounds, ellipses, and some elements of a drawing.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use clopen::io::svg::{self, Drawing, ReadOptions, Selection};
use clopen::plane::{Link, Point, Region};

fn folder_with(drawing: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("in.svg"), drawing).unwrap();
    folder
}

fn page(body: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100mm\" height=\"100mm\" viewBox=\"0 0 100 100\">{body}</svg>"
    )
}

fn run(folder: &Path, arguments: &str) -> Output {
    let mut command = Command::cargo_bin("clopen").unwrap();
    command.current_dir(folder).args(arguments.split_whitespace()).output().unwrap()
}

fn words(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).unwrap()
}

/// Runs a command that must do its work, and reads what it wrote.
#[track_caller]
fn result(folder: &Path, arguments: &str) -> String {
    let output = run(folder, &format!("{arguments} -o out.svg"));
    assert_eq!(output.status.code(), Some(0), "{arguments}: {}", words(&output));
    fs::read_to_string(folder.join("out.svg")).unwrap()
}

#[track_caller]
fn report(folder: &Path, arguments: &str) -> serde_json::Value {
    let output = run(folder, &format!("{arguments} -o out.svg --format json"));
    assert_eq!(output.status.code(), Some(0), "{arguments}: {}", words(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn read(text: &str) -> Drawing {
    svg::read(text.as_bytes(), &ReadOptions::default()).unwrap()
}

/// The commands of the path with this id.
#[track_caller]
fn data<'t>(text: &'t str, id: &str) -> &'t str {
    let rest = text.split(&format!("<path id=\"{id}\"")).nth(1).unwrap_or_else(|| panic!("no {id} in {text}"));
    rest.split(" d=\"").nth(1).unwrap().split('"').next().unwrap()
}

/// An outline with slots, a neck, a curve and an arc: something for every operation.
const PART: &str =
    "M20 20V60H35V75H49V66H51V75H65V60H80V45.5H90V44.5H80V20H65V30C60 40 40 40 35 30V28A3 3 0 0 0 35 22V20Z";

#[test]
fn clopening_says_how_much_the_order_matters() {
    let folder = folder_with(&page(&format!("<path d='{PART}'/>")));
    let report = report(folder.path(), "clopen in.svg -r 2 --topology merge");
    assert_eq!((report["operation"].as_str(), report["order"].as_str()), (Some("clopen"), Some("close-open")));
    let difference = &report["differences"][0];
    assert_eq!((difference["first"].as_str(), difference["second"].as_str()), (Some("close-open"), Some("open-close")));
    // Closing first fills the slot of 2 mm between (49, 66) and (51, 75) for good; nothing else differs so much.
    let largest = difference["largest_units"].as_f64().unwrap();
    let area = difference["symmetric_difference_square_units"].as_f64().unwrap();
    let outcome = |first: fn(&Region, _, _) -> _, second: fn(&Region, _, _) -> _| -> Region {
        use clopen::rolling::{Outcome, Topology};
        let r = clopen::units::Radius::new(2.0).unwrap();
        let first: Outcome = first(&read(&page(&format!("<path d='{PART}'/>"))).region, r, Topology::Merge);
        let second: Outcome = second(&first.region, r, Topology::Merge);
        second.region
    };
    use clopen::rolling::{close, open};
    let (a, b) = (outcome(close, open), outcome(open, close));
    let (i, j) = (clopen::plane::BoundaryIndex::new(&a), clopen::plane::BoundaryIndex::new(&b));
    let samples = |region: &Region, index: &clopen::plane::BoundaryIndex| {
        let points: Vec<Point> =
            region.segments().flat_map(|s| (0..32).map(move |k| s.point_at(f64::from(k) / 32.0))).collect();
        points.into_iter().map(|p| index.distance(p)).fold(0.0, f64::max)
    };
    let expected = samples(&a, &j).max(samples(&b, &i));
    assert!(largest >= expected - 1e-9 && largest < expected + 0.1, "{largest} {expected}");
    assert!(area >= (a.area() - b.area()).abs() - 1e-3, "{area}");
    assert!(difference["place_units"][1].as_f64().unwrap() > 0.0, "places count downward as in SVG");
}

#[test]
fn the_second_operation_keeps_the_arcs_of_the_first() {
    use clopen::rolling::{Topology, close, open};
    let (mut arcs, mut vertices) = (0, 0);
    for far in [0.0, 1e6] {
        let body = format!("<path d='{PART}' transform='translate({far} {})'/>", 0.5 * far);
        let drawing = read(&page(&body));
        let r = clopen::units::Radius::new(1.25).unwrap();
        for topology in [Topology::Keep, Topology::Merge] {
            let first = close(&drawing.region, r, topology);
            let second = open(&first.region, r, topology);
            assert_eq!((first.contradictions, second.contradictions), (0, 0));
            let links = |region: &Region| -> Vec<Link> { region.segments().map(|s| s.link).collect() };
            let made = links(&first.region);
            // The opening makes convex arcs: every concave one of the radius is the closing's, bit for bit.
            for link in links(&second.region) {
                if let Link::Arc(arc) = link
                    && arc.turn == clopen::plane::Turn::Right
                {
                    assert!(made.contains(&link), "{link:?}");
                    arcs += 1;
                }
            }
            // And every vertex of an identity is where it was.
            for v in second.region.rings.iter().flat_map(|ring| &ring.vertices) {
                if let Some(source) = v.id.and_then(|id| drawing.sources.vertex(id)) {
                    assert_eq!(source.point, v.point);
                    vertices += 1;
                }
            }
            // Doing both again changes nothing beyond rounding, and keeps each arc that is there.
            let again = open(&close(&second.region, r, topology).region, r, topology);
            assert!((again.region.area() - second.region.area()).abs() < 1e-9);
        }
    }
    assert!(arcs >= 20 && vertices > 400, "{arcs} {vertices}");
}

#[test]
fn an_ellipse_of_equal_axes_is_the_disk_byte_for_byte() {
    let folder = folder_with(&page(&format!("<path d='{PART}'/><circle cx='50' cy='10' r='5'/>")));
    for command in ["close", "open", "clopen"] {
        let plain = (
            result(folder.path(), &format!("{command} in.svg -r 2")),
            report(folder.path(), &format!("{command} in.svg -r 2")),
        );
        let round = format!("{command} in.svg -r 2 --aspect 1 --angle 30");
        assert_eq!(plain, (result(folder.path(), &round), report(folder.path(), &round)));
    }
}

#[test]
fn an_ellipse_does_what_the_disk_does_to_the_stretched_drawing() {
    // An upright ellipse of half axes 4 and 2, and a disk of radius 4 on the drawing that is twice as high; sizes of the
    // page do not matter here.
    let lines = [(20, 20), (20, 60), (35, 60), (35, 75), (49, 75), (49, 66), (51, 66), (51, 75), (65, 75), (65, 20)];
    let path = |stretch: i32| {
        let points: Vec<String> = lines.iter().map(|(x, y)| format!("{x},{}", stretch * y)).collect();
        page(&format!("<polygon points='{}'/>", points.join(" ")))
    };
    for (command, topology) in [("close", "keep"), ("close", "merge"), ("open", "merge"), ("clopen", "keep")] {
        let run = |drawing: String, more: &str| -> Vec<Point> {
            let folder = folder_with(&drawing);
            let text = result(folder.path(), &format!("{command} in.svg -r 4 --topology {topology} {more}"));
            // What is written, with the ends of its commands, arcs as arcs.
            let drawing = read(&text);
            drawing.sources.vertices.iter().filter(|v| v.sample.is_none()).map(|v| v.point).collect()
        };
        let (ellipse, disk) = (run(path(1), "--aspect 2"), run(path(2), ""));
        assert_eq!(ellipse.len(), disk.len(), "{command} {topology}");
        for p in disk {
            let there = Point::new(p.x, p.y / 2.0);
            let nearest = ellipse.iter().map(|q| (q - there).norm()).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-12 * 100.0, "{command} {topology}: {there} is off by {nearest}");
        }
    }
    // The same ellipse, named by its other half axis.
    let folder = folder_with(&path(1));
    let (a, b) = (
        result(folder.path(), "close in.svg -r 4 --aspect 2"),
        result(folder.path(), "close in.svg -r 2 --aspect 0.5 --angle 90"),
    );
    assert!(a.contains("A4 2 0 0 ") && b.contains("A2 4 -90 0 "), "{a}\n{b}");
    assert!((read(&a).region.area() - read(&b).region.area()).abs() < 1e-6);
}

#[test]
fn an_ellipse_keeps_the_commands_that_it_does_not_touch() {
    let body = format!("<path d='{PART}'/><path d='M5 80Q10 95 20 80Z'/><circle cx='50' cy='10' r='5'/>");
    let folder = folder_with(&page(&body));
    for angle in [0, 30, 90, 135] {
        let text = result(folder.path(), &format!("close in.svg -r 2 --aspect 1.75 --angle {angle}"));
        assert!(text.contains("A2 1.1428571428571428 "), "{text}");
        for kept in ["A5 5 0 0 0 45 10", "A5 5 0 0 0 50 15", "A5 5 0 0 0 55 10", "A5 5 0 0 0 50 5", "Q10 95 20 80"] {
            assert!(text.contains(kept), "{angle}: {kept} is not in {text}");
        }
        let closed = read(&text);
        let input = read(&page(&body));
        let index = clopen::plane::BoundaryIndex::new(&closed.region);
        for v in input.region.rings.iter().flat_map(|r| &r.vertices) {
            let out = index.winding_number(v.point) <= 0 && index.distance(v.point) > 1.01 * closed.chord_tolerance;
            assert!(!out, "{angle}: {} is cut off", v.point);
        }
    }
}

#[test]
fn interlocking_parts_keep_their_fit() {
    let outline = "M30 30H45V40A5 5 0 0 0 55 40V30H70V45L60 50L70 55V70C60 60 40 60 30 70Z";
    let body = format!("<path id='A' d='{outline}'/><path id='B' fill-rule='evenodd' d='M5 5H95V95H5Z{outline}'/>");
    let elements = |region: &Region| {
        let bits = |p: Point| (p.x.to_bits(), p.y.to_bits());
        let mut all: Vec<_> = region.segments().map(|s| (bits(s.start), bits(s.end), s.link == Link::Line)).collect();
        all.sort_unstable();
        all
    };
    for element in ["-r 2", "-r 2 --topology merge", "-r 2 --aspect 2 --angle 30"] {
        let folder = folder_with(&page(&body));
        let first = result(folder.path(), &format!("close in.svg --only A {element}"));
        assert_eq!(data(&first, "B").matches('\n').count(), 1, "the counterpart is as it was");
        fs::write(folder.path().join("in.svg"), &first).unwrap();
        let both = result(folder.path(), &format!("open in.svg --only B {element}"));
        assert_eq!(data(&first, "A"), data(&both, "A"));
        assert!(data(&both, "A").contains("A2 "), "nothing was closed: {both}");
        // The hole of B is the outline of A: commands end in the same places, to the last bit.
        let part = |id: &str| {
            let selection = Selection { only: vec![id.to_owned()], ..Selection::default() };
            let parts = svg::read_parts(both.as_bytes(), &ReadOptions::default(), &selection).unwrap();
            parts.chosen().clone()
        };
        let ends = |drawing: &Drawing| -> BTreeSet<(u64, u64)> {
            let ends = drawing.sources.vertices.iter().filter(|v| v.sample.is_none());
            ends.map(|v| (v.point.x.to_bits(), v.point.y.to_bits())).collect()
        };
        let (a, b) = (part("A"), part("B"));
        assert!(ends(&a).is_subset(&ends(&b)), "{element}");
        // The plate's own corners have become eight more.
        assert_eq!(ends(&b).len(), ends(&a).len() + 8, "{element}");
        let (a, b) = (a.region, b.region);
        if !element.contains("aspect") {
            let hole = b.rings.iter().find(|ring| ring.area() < 0.0).unwrap().reversed();
            assert_eq!(elements(&a), elements(&Region::new(vec![hole])), "{element}");
        }
        // Together they fill the plate but for its own corners, which the opening has rounded.
        let corners = 4.0 * (1.0 - std::f64::consts::FRAC_PI_4) * 4.0;
        if !element.contains("aspect") {
            assert!((a.area() + b.area() - (8100.0 - corners)).abs() < 1e-6, "{element}");
        }
    }
}

const GROUPS: &str = "<g id='outer'><rect id='r' x='5' y='5' width='20' height='20'/><g id='inner'><path id='ell' d='M40 5H60V15H50V25H40Z'/>\
    <path d='M20 10H45V20H20Z'/></g></g><defs><path id='stored' d='M0 0H10V5H5V10H0Z'/></defs>\
    <use id='u1' href='#stored' x='10' y='60'/><g id='moved' transform='translate(30 60)'><use href='#stored'/></g>";

#[test]
fn elements_are_chosen_by_their_own_name_or_that_of_what_holds_or_shows_them() {
    let folder = folder_with(&page(GROUPS));
    let count = |arguments: &str| {
        let text = result(folder.path(), &format!("close in.svg -r 1 {arguments}"));
        text.matches("A1 1 ").count()
    };
    // The ell has a corner; with its neighbour in the group, which it overlaps, it has two more.
    assert_eq!(count("--only ell"), 1);
    assert_eq!(count("--only inner"), 3);
    assert_eq!(count("--only outer --except ell"), 2);
    assert_eq!(count("--only u1"), 1);
    assert_eq!(count("--only moved"), 1);
    assert_eq!(count("--only stored"), 2);
    assert_eq!(count("--except outer"), 2);
    assert_eq!(count("--only u1 --only ell"), 2);
}

#[test]
fn what_is_not_chosen_is_written_as_it_was_in_its_place_and_under_its_names() {
    let folder = folder_with(&page(GROUPS));
    let text = result(folder.path(), "close in.svg -r 1 --only ell");
    let order: Vec<&str> = text.lines().map(|l| l.split(['"', ' ']).nth(2).unwrap_or(l)).collect();
    assert_eq!(data(&text, "r"), "M5 25L25 25L25 5L5 5Z");
    let groups: Vec<&str> = text.lines().filter(|l| l.starts_with("<g")).collect();
    assert_eq!(groups, ["<g id=\"outer\">", "<g id=\"inner\">", "<g id=\"u1\">", "<g id=\"moved\">"], "{order:?}");
    assert_eq!(text.matches("<g").count(), text.matches("</g>").count());
    assert_eq!(text.matches("<path").count(), 5);
    // So a second run finds the same elements.
    fs::write(folder.path().join("in.svg"), &text).unwrap();
    let again = result(folder.path(), "close in.svg -r 1 --only inner");
    assert_eq!(again.matches("A1 1 ").count(), 3, "{again}");
    assert!(again.contains("<g id=\"inner\">\n<path fill-rule"), "{again}");
    // Two elements of different groups become one path, before the first group that it would tear.
    let torn = result(folder.path(), "close in.svg -r 1 --only ell --only u1");
    assert!(torn.lines().nth(1).unwrap().starts_with("<path fill-rule"), "{torn}");
    assert_eq!(torn.matches("<g id=\"outer\">").count(), 1);
}

#[test]
fn what_makes_no_sense_is_refused_in_a_sentence() {
    let folder = folder_with(&page(GROUPS));
    for (arguments, expected) in [
        ("--aspect 0", "the aspect is 0"),
        ("--aspect -2", "the aspect is -2"),
        ("--aspect nan", "the aspect is NaN"),
        ("--aspect inf", "the aspect is inf"),
        ("--aspect 1e9", "the aspect is 1000000000"),
        ("--aspect 2 --angle nan", "the angle is NaN"),
        ("--angle 30", "--aspect"),
        ("--only elk", "did you mean \"ell\"?"),
        ("--only ell --except innr", "did you mean \"inner\"?"),
        ("--only zzzzzz", "no element with id=\"zzzzzz\", nor any with an id like it"),
        ("--only ell --except ell", "\"ell\" is named by both --only and --except"),
        ("--only ell --except inner", "no element is left"),
        ("--except outer --except u1 --except moved", "no element is left"),
    ] {
        for command in ["close", "open", "clopen"] {
            let output = run(folder.path(), &format!("{command} in.svg -r 1 -o out.svg {arguments}"));
            assert_eq!(output.status.code(), Some(2), "{arguments}: {}", words(&output));
            assert!(words(&output).contains(expected), "{arguments}: {}", words(&output));
            assert!(!folder.path().join("out.svg").exists(), "{arguments}");
        }
    }
    let output = run(folder.path(), "clopen in.svg -r 1 --order open-first -o out.svg");
    assert_eq!(output.status.code(), Some(2));
    let output = run(folder.path(), "close in.svg -r 0.02 --aspect 900 -o out.svg");
    assert_eq!(output.status.code(), Some(2));
    assert!(words(&output).contains("try an aspect nearer to 1"), "{}", words(&output));
}

#[test]
fn what_is_hidden_cannot_be_chosen_but_has_an_area() {
    let text = page(
        "<rect id='shown' width='9' height='9'/><g display='none'><circle id='pin' cx='5' cy='5' r='2'/></g>\
        <linearGradient id='paint'/>",
    );
    let folder = folder_with(&text);
    for (id, expected) in [("pin", "no filled shape"), ("paint", "no filled shape")] {
        let output = run(folder.path(), &format!("close in.svg -r 1 --only {id} -o out.svg"));
        assert_eq!(output.status.code(), Some(2));
        assert!(words(&output).contains(expected), "{}", words(&output));
    }
    let area = |id: &str| svg::read_area(text.as_bytes(), &ReadOptions::default(), id);
    assert!((area("pin").unwrap().area() - 4.0 * std::f64::consts::PI).abs() < 1e-12);
    assert_eq!(
        area("paint").unwrap_err().to_string(),
        "the element with id=\"paint\" has no area: name a closed shape, or a group of such"
    );
    assert!(area("pins").unwrap_err().to_string().contains("did you mean \"pin\"?"));
}

#[test]
fn areas_of_groups_and_references_are_where_they_are_shown() {
    let text = page(GROUPS);
    let area = |id: &str| svg::read_area(text.as_bytes(), &ReadOptions::default(), id).unwrap();
    assert_eq!(area("u1").bounds().min, Point::new(10.0, -70.0));
    assert_eq!(area("moved").bounds().min, Point::new(30.0, -70.0));
    assert_eq!((area("stored").rings.len(), area("stored").area()), (2, 150.0));
    // The ell and what overlaps it, as one.
    assert_eq!((area("inner").rings.len(), area("inner").area()), (1, 300.0 + 250.0 - 50.0));
    assert!(area("inner").rings[0].vertices.iter().all(|v| v.id.is_none()));
}

#[test]
fn vertices_know_what_radius_their_element_asks_for() {
    let drawing = read(&page(
        "<g data-clopen-radius='3mm'><rect width='4' height='4'/><rect x='9' width='4' height='4' data-clopen-radius='1'/></g>\
         <rect x='20' width='4' height='4'/><defs><rect id='s' width='4' height='4'/></defs>\
         <use href='#s' x='30' data-clopen-radius='5%'/><use href='#s' x='40'/>",
    ));
    let radius = |x: f64| {
        let vertices = drawing.region.rings.iter().flat_map(|r| &r.vertices);
        let v = vertices.min_by(|a, b| (a.point.x - x).abs().total_cmp(&(b.point.x - x).abs())).unwrap();
        drawing.sources.radius(v.id.unwrap())
    };
    assert_eq!([0.0, 9.0, 20.0, 30.0, 40.0].map(radius), [Some("3mm"), Some("1"), None, Some("5%"), None]);
}
