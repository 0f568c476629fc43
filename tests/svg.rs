//! Whole drawings: what is read of them, what is said of the rest, and what is written.

use std::path::{Path, PathBuf};

use clopen::io::svg::{self, Curves, Drawing, ReadError, ReadOptions, Strokes, WarningKind};
use clopen::plane::{Joint, Link, Point, Region};
use clopen::rolling::{self, Topology};
use clopen::units::Radius;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

/// Area of the difference between what is read and what is expected, in parts of the area expected: the coordinates of
/// the expectations and the flattening of both are good for seven digits.
const AREA_DIFFERENCE: f64 = 1e-6;

fn read(text: &str) -> Result<Drawing, ReadError> {
    svg::read(text.as_bytes(), &ReadOptions::default())
}

fn drawing(body: &str) -> Drawing {
    read(&format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 100 100\">{body}</svg>")).unwrap()
}

/// The rings as polygons in the file's own coordinates, y down.
fn polygons(region: &Region) -> Vec<Vec<[f64; 2]>> {
    let tolerance = 1e-7 * region.bounds().diagonal().max(f64::MIN_POSITIVE);
    region.rings.iter().map(|r| r.flatten(tolerance).iter().map(|p| [p.x, -p.y]).collect()).collect()
}

fn area_of(polygons: &[Vec<[f64; 2]>]) -> f64 {
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let area = |p: &Vec<[f64; 2]>| (0..p.len()).map(|k| cross(p[k], p[(k + 1) % p.len()])).sum::<f64>() / 2.0;
    polygons.iter().map(area).sum()
}

/// Area of the symmetric difference.
fn difference(a: &[Vec<[f64; 2]>], b: &[Vec<[f64; 2]>]) -> f64 {
    let shapes = a.to_vec().overlay(&b.to_vec(), OverlayRule::Xor, FillRule::EvenOdd);
    shapes.iter().map(|shape| area_of(shape).abs()).sum()
}

fn shared() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/2d");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: ../shared is absent");
    None
}

fn expected(folder: &Path, name: &str) -> Option<Vec<Vec<[f64; 2]>>> {
    let text = std::fs::read_to_string(folder.join("expected").join(format!("{name}.geojson"))).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let geometry = json.get("geometry")?.as_object()?;
    let rings =
        |polygon: &serde_json::Value| -> Vec<Vec<[f64; 2]>> { serde_json::from_value(polygon.clone()).unwrap() };
    let coordinates = &geometry["coordinates"];
    Some(match geometry["type"].as_str().unwrap() {
        "Polygon" => rings(coordinates),
        _ => coordinates.as_array().unwrap().iter().flat_map(rings).collect(),
    })
}

#[test]
fn awkward_drawings_read_as_expected() {
    let Some(folder) = shared() else { return };
    let options = ReadOptions { strokes: Strokes::Areas, ..ReadOptions::default() };
    let mut compared = 0;
    for name in [
        "awk_css_style",
        "awk_duplicate_points",
        "awk_inkscape_layers",
        "awk_nested_transforms",
        "awk_stroke_only",
        "awk_units_inch_offset_viewbox",
        "awk_use_symbol_defs",
    ] {
        let found = svg::read(&std::fs::read(folder.join(format!("{name}.svg"))).unwrap(), &options).unwrap();
        let expected = expected(&folder, name).unwrap();
        let area = area_of(&expected).abs();
        let difference = difference(&polygons(&found.region), &expected);
        assert!(difference <= AREA_DIFFERENCE * area, "{name}: {difference} of {area}");
        assert!((found.region.area() - area).abs() <= AREA_DIFFERENCE * area, "{name}");
        compared += 1;
    }
    assert_eq!(compared, 7);
}

#[test]
fn awkward_drawings_without_geometry_read_as_their_notes_say() {
    let Some(folder) = shared() else { return };
    let read = |name: &str| {
        let bytes = std::fs::read(folder.join(format!("{name}.svg"))).unwrap();
        svg::read(&bytes, &ReadOptions::default())
    };
    // Self-intersecting star: five triangles that touch in points, or a ten-gon.
    let star = read("awk_evenodd_star").unwrap().region;
    assert_eq!((star.topology().components, star.topology().holes), (5, 0));
    let star = read("awk_nonzero_star").unwrap().region;
    assert_eq!((star.rings.len(), star.rings[0].len()), (1, 10));
    // Open subpaths: a triangle and a leaf, closed.
    let open = read("awk_open_paths").unwrap().region;
    assert_eq!(open.topology().components, 2);
    // A stroke without fill, nothing, no bytes: each has its sentence.
    let said = |name: &str| read(name).unwrap_err().to_string();
    assert!(said("awk_stroke_only").contains("--strokes"), "{}", said("awk_stroke_only"));
    assert!(said("awk_empty").contains("no filled shape"), "{}", said("awk_empty"));
    assert!(said("awk_zero_bytes").contains("empty"), "{}", said("awk_zero_bytes"));
    // Text: set, or named in the message.
    match read("awk_text_only") {
        Ok(text) => assert!(text.region.topology().holes >= 1, "R and g have holes"),
        Err(error) => assert!(error.to_string().contains("text"), "{error}"),
    }
    // Sizes: 100 user units are an inch; pixels; millimetres; none.
    let mm = |name: &str| read(name).unwrap().mm_per_unit;
    assert_eq!(mm("awk_units_inch_offset_viewbox"), Some(0.254));
    assert_eq!(mm("awk_use_symbol_defs"), Some(25.4 / 96.0));
    assert_eq!(mm("awk_inkscape_layers"), Some(1.0));
    assert_eq!(mm("awk_css_style"), None);
    // Hidden layers are named.
    let layers = read("awk_inkscape_layers").unwrap();
    let [warning] = &layers.warnings[..] else { panic!("{:?}", layers.warnings) };
    assert_eq!((warning.place.id.as_deref(), &warning.kind), (Some("layer2"), &WarningKind::Hidden { shapes: 1 }));
}

#[test]
fn countries_glyphs_icons_and_parts_read_whole() {
    let Some(folder) = shared() else { return };
    let mut names: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .filter_map(|e| e.unwrap().file_name().into_string().ok())
        .filter(|n| n.ends_with(".svg") && !n.starts_with("awk_"))
        .collect();
    names.sort();
    assert!(names.len() >= 18, "{names:?}");
    for name in names {
        let bytes = std::fs::read(folder.join(&name)).unwrap();
        let mut read = Vec::new();
        for curves in [Curves::Arcs, Curves::Polygon] {
            let start = std::time::Instant::now();
            let found = svg::read(&bytes, &ReadOptions { curves, ..ReadOptions::default() }).unwrap();
            let counts = (found.region.rings.len(), found.region.vertex_count());
            println!("{name} {curves:?} {counts:?} area {} {:?}", found.region.area(), start.elapsed());
            assert_eq!(found.warnings, [], "{name}");
            assert!(found.region.area() > 0.0);
            let has_arcs = found.region.segments().any(|s| s.link != Link::Line);
            assert!(curves == Curves::Arcs || !has_arcs, "{name}");
            read.push(found.region);
        }
        // Both describe one area, up to the sampling of arcs.
        let bounds = read[0].bounds();
        let sampling = svg::DEFAULT_FLATTEN * bounds.width().max(bounds.height()) * read[0].perimeter();
        let difference = difference(&polygons(&read[0]), &polygons(&read[1]));
        println!("{name} difference {difference} {sampling}");
        assert!(difference <= sampling, "{name}: {difference} beyond {sampling}");
        assert!((read[0].area() - read[1].area()).abs() <= sampling, "{name}");
        assert_eq!(read[0].topology(), read[1].topology(), "{name}");
    }
}

/// The coordinates of all vertices, in the file's own axes.
fn points(drawing: &Drawing) -> Vec<(f64, f64)> {
    drawing.region.rings.iter().flat_map(|r| r.vertices.iter().map(|v| (v.point.x, 0.0 - v.point.y))).collect()
}

fn kinds(drawing: &Drawing) -> Vec<&WarningKind> {
    drawing.warnings.iter().map(|w| &w.kind).collect()
}

#[test]
fn coordinates_keep_every_digit() {
    let d = drawing("<path d='M0.1 0.2L33.333333333333336 1e-7 44.00000000000001 55.123456789012345 .7 60z'/>");
    let expected = [(0.1, 0.2), (33.333333333333336, 1e-7), (44.00000000000001, 55.123456789012345), (0.7, 60.0)];
    let found = points(&d);
    assert_eq!(found.len(), 4);
    assert!(expected.iter().all(|e| found.contains(e)), "{found:?}");
    // Other shapes too, and inside groups without transform, nested svg and use without offset.
    for body in [
        "<rect x='0.1' y='0.3' width='0.7' height='10.1'/>",
        "<polygon points='0.1,.3 .7999999999999999 .3 0.7999999999999999 10.4 0.1 10.4'/>",
        "<g id='g'><svg><rect x='0.1' y='0.3' width='0.7' height='10.1'/></svg></g>",
        "<defs><rect id='r' x='0.1' y='0.3' width='0.7' height='10.1'/></defs><use href='#r'/>",
        "<symbol id='s' overflow='visible'><path d='M0.1 .3H0.7999999999999999V10.4H.1z'/></symbol><use href='#s'/>",
        "<rect id='r' x='0.1' y='0.3' width='0.7' height='10.1'/><use href='#r'/><use href='#r'/>",
    ] {
        let mut found = points(&drawing(body));
        found.sort_by(|a, b| a.partial_cmp(b).unwrap());
        let (right, bottom) = (0.1 + 0.7, 0.3 + 10.1);
        assert_eq!(found, [(0.1, 0.3), (0.1, bottom), (right, 0.3), (right, bottom)], "{body}");
    }
}

#[test]
fn transforms_are_those_of_the_file_in_double_precision() {
    let turn = 30f64.to_radians();
    let d = drawing(
        "<defs><g id='g' transform='scale(1.1)'><path d='M1 2L3.3 2 3.3 7z'/></g></defs>\
         <g transform='translate(20.2 30.3)'><use x='.7' y='.9' transform='rotate(30)' xlink:href='#g' \
         xmlns:xlink='http://www.w3.org/1999/xlink'/></g>",
    );
    let found = points(&d);
    for (x, y) in [(1.0, 2.0), (3.3, 2.0), (3.3, 7.0)] {
        let (u, v) = (1.1 * x + 0.7, 1.1 * y + 0.9);
        let p = (20.2 + turn.cos() * u - turn.sin() * v, 30.3 + turn.sin() * u + turn.cos() * v);
        let near = |q: &&(f64, f64)| (q.0 - p.0).abs() < 1e-14 * 40.0 && (q.1 - p.1).abs() < 1e-14 * 40.0;
        assert!(found.iter().any(|q| near(&q)), "{p:?} not in {found:?}");
    }
    assert_eq!(kinds(&d), Vec::<&WarningKind>::new());
}

#[test]
fn symbols_are_fitted_into_their_size() {
    let symbol = "<symbol id='s' viewBox='0 0 10 10'><rect width='10' height='5'/></symbol>";
    let d = drawing(&format!("{symbol}<use href='#s' x='3' y='4' width='20' height='40'/>"));
    // Ten units into twenty wide and forty high: scaled by two, ten below the top.
    let mut found = points(&d);
    found.sort_by(|a, b| a.partial_cmp(b).unwrap());
    assert_eq!(found, [(3.0, 14.0), (3.0, 24.0), (23.0, 14.0), (23.0, 24.0)]);
    assert_eq!(kinds(&d), Vec::<&WarningKind>::new());
}

#[test]
fn circles_are_arcs_under_turns_and_scales_and_curves_under_stretches() {
    for (body, area, arcs) in [
        ("<circle cx='50' cy='50' r='20'/>", 400.0, true),
        ("<circle cx='5' cy='5' r='2' transform='rotate(17) scale(-3)'/>", 36.0, true),
        ("<ellipse rx='2' ry='8' transform='scale(4 1)'/>", 64.0, true),
        ("<circle r='10%' cx='50%' cy='50%'/>", 100.0, true),
        ("<circle r='5' transform='scale(2 1)'/>", 50.0, false),
        ("<ellipse rx='2' ry='8'/>", 16.0, false),
    ] {
        let d = drawing(body);
        let expected = area * std::f64::consts::PI;
        let tolerance = if arcs { 1e-6 } else { 1e-5 };
        assert!((d.region.area() - expected).abs() < tolerance * expected, "{body} {}", d.region.area());
        assert!(d.region.segments().all(|s| (s.link != Link::Line) == arcs), "{body}");
        assert_eq!(d.region.rings.len(), 1);
        assert_eq!(d.region.rings[0].len() == 4, arcs);
    }
}

#[test]
fn clip_paths_are_applied_with_those_inside_them() {
    let clips = "<clipPath id='left' clip-path='url(#top)'><rect width='50' height='100'/></clipPath>\
                 <clipPath id='top'><path d='M0 0H100V50H0z'/></clipPath>\
                 <clipPath id='box' clipPathUnits='objectBoundingBox'><rect width='.5' height='1'/></clipPath>";
    for (body, area) in [
        ("<circle cx='50' cy='50' r='20' clip-path='url(#top)'/>", 200.0 * std::f64::consts::PI),
        ("<circle cx='50' cy='50' r='20' clip-path='url(#left)'/>", 100.0 * std::f64::consts::PI),
        (
            "<g clip-path='url(#top)'><g transform='translate(0 -10)'><rect y='40' width='10' height='40'/></g></g>",
            200.0,
        ),
        ("<g transform='translate(0 -10)' clip-path='url(#top)'><rect y='40' width='10' height='40'/></g>", 100.0),
        ("<rect x='20' width='10' height='40' clip-path='url(#box)'/>", 200.0),
        ("<rect width='10' height='10' clip-path='url(#top)'/>", 100.0),
    ] {
        let d = drawing(&format!("{clips}{body}"));
        assert!((d.region.area() - area).abs() < 1e-9 * area, "{body} {} {area}", d.region.area());
    }
    let error = read(
        "<svg viewBox='0 0 9 9'><clipPath id='c'><rect x='5' width='1' height='1'/></clipPath>\
        <rect width='1' height='1' clip-path='url(#c)'/></svg>",
    );
    assert!(matches!(error, Err(ReadError::NothingFilled { .. })));
}

#[test]
fn what_is_left_out_is_named() {
    let d = drawing(
        "<rect id='seen' width='9' height='9'/>\n<g id='layer' style='display:none'><path d='M0 0H9V9'/><rect width='1' \
         height='1'/></g>\n<rect id='ghost' visibility='hidden' width='9' height='9'/>\n<path id='cut' d='M20 20H30V30L oops'/>\n\
         <use href='#nowhere'/>\n<image id='photo' width='1' height='1' href='photo.png'/>\n<line id='hair' x2='5' stroke='red'/>\n\
         <mask id='m'><rect width='9' height='9' fill='white'/></mask><rect id='masked' x='50' width='9' height='9' mask='url(#m)'/>",
    );
    let found: Vec<(Option<&str>, usize)> = d.warnings.iter().map(|w| (w.place.id.as_deref(), w.place.line)).collect();
    let expected = [
        (Some("layer"), 2),
        (Some("ghost"), 3),
        (Some("cut"), 4),
        (None, 5),
        (Some("photo"), 6),
        (Some("hair"), 7),
        (Some("masked"), 8),
    ];
    assert_eq!(found, expected, "{:?}", d.warnings);
    assert_eq!(d.warnings[0].kind, WarningKind::Hidden { shapes: 2 });
    assert_eq!(d.warnings[1].kind, WarningKind::Invisible);
    assert!(matches!(d.warnings[2].kind, WarningKind::PathCutShort { .. }));
    assert_eq!(d.warnings[3].kind, WarningKind::UnresolvedUse { href: "#nowhere".to_owned() });
    assert_eq!(d.warnings[4].kind, WarningKind::Image);
    assert_eq!(d.warnings[5].kind, WarningKind::StrokeOnly);
    assert_eq!(d.warnings[6].kind, WarningKind::Mask);
    // Two squares and the triangle that was drawn before the path data broke off.
    assert!((d.region.area() - (81.0 + 81.0 + 50.0)).abs() < 1e-9, "{}", d.region.area());
}

#[test]
fn a_file_that_cannot_be_used_gets_one_clear_sentence() {
    let svg = |body: &str| format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'>\n{body}</svg>");
    for (text, words) in [
        (String::new(), "empty"),
        ("   \n".to_owned(), "empty"),
        ("solid cube".to_owned(), "no SVG"),
        ("<html><body/></html>".to_owned(), "<html>"),
        ("<svg viewBox='0 0 9 9'><path d='M0 0".to_owned(), "breaks off"),
        ("<svg viewBox='0 0 9 9'><g><g>".to_owned(), "breaks off"),
        ("<svg viewBox='0 0 9 9'>\n<a></b></svg>".to_owned(), "line 2"),
        ("<svg width='0' height='0'/>".to_owned(), "size"),
        (svg(""), "nothing in it"),
        (svg("<path id='big' d='M0 0H1e12V1'/>"), "<path id=\"big\"> on line 2 has the coordinate 1e12"),
        (svg("<path d='M0 0H1e39V1z'/>"), "1e39"),
        (svg("<rect width='1' height='1' transform='scale(1e11)'/>"), "beyond 1e9"),
        (svg("<path d='M0 0L9 9' stroke='red' fill='none'/>"), "--strokes"),
        (svg("<path d='M0 0H9V9' fill='none'/>"), "without fill"),
        (svg("<g display='none'><path d='M0 0H9V9'/></g>"), "hidden"),
        (svg("<path d='M0 0NaN 3'/>"), "no filled shape"),
    ] {
        let error = read(&text).map(|d| d.region.area()).unwrap_err().to_string();
        assert!(error.contains(words), "{text}: {error}");
        assert!(!error.contains('\n') && error.len() < 200, "{error}");
    }
    assert!(matches!(svg::read(b"\x1f\x8b\x08\x00", &ReadOptions::default()), Err(ReadError::NotText { offset: 1 })));
}

#[test]
fn sizes_come_from_the_file_or_the_options() {
    let text = "<svg viewBox='0 0 100 100'><rect x='10' y='10' width='50' height='20'/></svg>";
    let mm = |options: ReadOptions| svg::read(text.as_bytes(), &options).unwrap().mm_per_unit;
    assert_eq!(mm(ReadOptions::default()), None);
    assert_eq!(mm(ReadOptions { dpi: Some(100.0), ..ReadOptions::default() }), Some(0.254));
    assert_eq!(mm(ReadOptions { width_mm: Some(25.0), ..ReadOptions::default() }), Some(0.5));
    let wrong = ReadOptions { dpi: Some(-1.0), ..ReadOptions::default() };
    assert!(matches!(svg::read(text.as_bytes(), &wrong), Err(ReadError::InvalidOption { .. })));
}

/// Every vertex with its links, from the lowest vertex on, so that rings compare whatever vertex they start at.
fn normal_form(region: &Region) -> Vec<Vec<(Point, Link)>> {
    let mut rings: Vec<Vec<(Point, Link)>> = Vec::new();
    for ring in &region.rings {
        let mut vertices: Vec<(Point, Link)> = ring.vertices.iter().map(|v| (v.point, v.link)).collect();
        let first = (0..vertices.len()).min_by(|&a, &b| key(&vertices[a]).partial_cmp(&key(&vertices[b])).unwrap());
        vertices.rotate_left(first.unwrap_or(0));
        rings.push(vertices);
    }
    rings.sort_by(|a, b| key(&a[0]).partial_cmp(&key(&b[0])).unwrap());
    rings
}

fn key(vertex: &(Point, Link)) -> (f64, f64) {
    (vertex.0.x, vertex.0.y)
}

#[test]
fn what_is_written_reads_back_the_same_bit_for_bit() {
    let mut drawings: Vec<(String, Vec<u8>)> = Vec::new();
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples");
    for folder in [Some(samples), shared()].into_iter().flatten() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|e| e == "svg") {
                drawings.push((path.display().to_string(), std::fs::read(&path).unwrap()));
            }
        }
    }
    drawings.sort();
    let mut compared = 0;
    for (name, bytes) in drawings {
        let Ok(first) = svg::read(&bytes, &ReadOptions::default()) else { continue };
        let written = svg::write(&first, &first.region);
        // Read for itself it may be sampled otherwise (it is one shape now, and parts are curves of their own): the ends
        // of the commands stay.
        let alone = svg::read(written.as_bytes(), &ReadOptions::default()).unwrap();
        let present: Vec<Point> = alone.region.rings.iter().flat_map(|r| &r.vertices).map(|v| v.point).collect();
        let vertices = first.region.rings.iter().flat_map(|r| &r.vertices);
        assert!(vertices.filter(|v| v.joint == Joint::Corner).all(|v| present.contains(&v.point)), "{name}");
        // Read alike it is the same.
        let second = svg::read_alike(written.as_bytes(), &ReadOptions::default(), &first).unwrap();
        assert_eq!((first.mm_per_unit, &first.page), (second.mm_per_unit, &second.page), "{name}");
        let (a, b) = (normal_form(&first.region), normal_form(&second.region));
        assert_eq!(a.len(), b.len(), "{name}");
        let mut moved = 0.0f64;
        for (a, b) in a.iter().zip(&b) {
            assert_eq!(a.len(), b.len(), "{name}");
            for (v, w) in a.iter().zip(b) {
                assert_eq!(v.0, w.0, "{name}");
                match (v.1, w.1) {
                    (Link::Arc(v), Link::Arc(w)) => {
                        assert_eq!(v.turn, w.turn);
                        moved =
                            moved.max((v.center - w.center).norm() / v.radius).max((v.radius / w.radius - 1.0).abs());
                    }
                    (v, w) => assert_eq!(v, w, "{name}"),
                }
            }
        }
        println!("{name}: {} curves kept, arcs moved {moved:e}", written.matches(['C', 'Q']).count());
        assert!(moved < 1e-9, "{name}: {moved:e}");
        compared += 1;
    }
    assert!(compared >= 6);
}

#[test]
fn samples_read_with_a_size_and_without_warning() {
    for (name, width, components, holes) in [
        ("bracket", 110.0, 1, 7),
        ("gear", 88.0, 1, 6),
        ("inch", 88.9, 1, 5),
        ("maple-leaf", 95.0, 1, 0),
        ("vietnam", 105.496, 27, 0),
        ("word", 201.0, 4, 3),
    ] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples").join(format!("{name}.svg"));
        let d = svg::read(&std::fs::read(path).unwrap(), &ReadOptions::default()).unwrap();
        assert_eq!(d.warnings, [], "{name}");
        let found = d.region.bounds().width() * d.mm_per_unit.unwrap();
        assert!((found - width).abs() < 0.2 * width, "{name}: {found} mm wide");
        let topology = d.region.topology();
        assert_eq!((topology.components, topology.holes), (components, holes), "{name}");
    }
}

#[test]
fn cut_and_damaged_files_neither_panic_nor_hang() {
    let mut files: Vec<String> = vec![
        "<svg xmlns='http://www.w3.org/2000/svg' width='9mm' viewBox='0 0 9 9'><style>.a{fill:none}#b{fill-rule:evenodd}</style>\
         <defs><symbol id='s' viewBox='0 0 2 2'><circle r='1' cx='1' cy='1'/></symbol><clipPath id='c'><rect width='5' height='5'/>\
         </clipPath></defs><use href='#s' x='2' width='3' height='3'/><g clip-path='url(#c)' transform='rotate(20) scale(2,3)'>\
         <path id='b' class='a' d='M1 1C2 3 4 5 6 1S3 3 2 2Q1 1 3 4T1 2A2 3 20 1 0 4 4H3V2Z' stroke='red' stroke-dasharray='1 2'/>\
         <ellipse rx='3' ry='2'/></g><rect rx='1' x='4' y='4' width='3' height='3' style='fill:blue'/></svg>"
            .to_owned(),
    ];
    for name in ["bracket", "maple-leaf", "word"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples").join(format!("{name}.svg"));
        files.push(std::fs::read_to_string(path).unwrap());
    }
    let options = ReadOptions { strokes: Strokes::Areas, flatten: 1e-4, ..ReadOptions::default() };
    let mut outcomes = [0, 0];
    let mut seed = 1u64;
    let mut random = |below: usize| {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as usize % below
    };
    for file in &files {
        let bytes = file.as_bytes();
        for end in 0..bytes.len() {
            outcomes[usize::from(svg::read(&bytes[..end], &options).is_ok())] += 1;
        }
        for _ in 0..400 {
            let mut damaged = bytes.to_vec();
            for _ in 0..1 + random(4) {
                let (at, alphabet) = (random(damaged.len()), b"0123456789.-eE <>/\"'#MLCQAZmz%&\xff");
                damaged[at] = alphabet[random(alphabet.len())];
            }
            let result = svg::read(&damaged, &options);
            if let Ok(d) = &result {
                assert!(d.region.area() > 0.0 && d.region.bounds().diagonal().is_finite());
                assert!(svg::read(svg::write(d, &d.region).as_bytes(), &options).is_ok());
            }
            outcomes[usize::from(result.is_ok())] += 1;
        }
    }
    println!("{} refused, {} read", outcomes[0], outcomes[1]);
    assert!(outcomes[1] > 500);
}

/// How often each command letter stands in the path of a written drawing.
fn commands(written: &str) -> impl Fn(char) -> usize {
    let data = written.split(" d=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
    move |letter| data.matches(letter).count()
}

#[test]
fn a_closed_word_keeps_its_curves_whole_or_in_part() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/word.svg");
    let text = std::fs::read_to_string(path).unwrap();
    let before = svg::read(text.as_bytes(), &ReadOptions::default()).unwrap();
    let outcome = rolling::close(&before.region, Radius::new(2.0).unwrap(), Topology::Keep);
    let written = svg::write(&before, &outcome.region);
    let curves = text.split_whitespace().filter(|w| w.starts_with('C')).count();
    assert_eq!(curves, 38);
    let count = commands(&written);
    // No curve of the word is lost: each is there whole or as the one part that the disk left of it.
    assert_eq!(count('C'), curves);
    // The eight quarters of the O are untouched.
    assert!(written.contains("C5 58 16 71 32 71C48 71 59 58 59 40C59 22 48 9 32 9C16 9 5 22 5 40Z"), "{written}");
    // One arc where the disk lies in a corner, and straight lines as in the word but for the feet of the arcs.
    assert!(count('A') >= 14 && count('L') <= 45, "{} arcs, {} lines", count('A'), count('L'));
    assert!(written.len() < 5000, "{} bytes", written.len());

    let vertices = |region: &Region| -> Vec<Point> {
        region.rings.iter().flat_map(|r| r.vertices.iter().map(|v| v.point)).collect()
    };
    // Read to be compared, what was kept is there to the last bit: also the samples of the parts.
    let after = svg::read_alike(written.as_bytes(), &ReadOptions::default(), &before).unwrap();
    assert_eq!(after.chord_tolerance, before.chord_tolerance);
    let bits = |p: &Point| (p.x.to_bits(), p.y.to_bits());
    let present: std::collections::HashSet<_> = vertices(&after.region).iter().map(bits).collect();
    let kept: Vec<Point> =
        outcome.region.rings.iter().flat_map(|r| &r.vertices).filter(|v| v.id.is_some()).map(|v| v.point).collect();
    assert!(kept.len() > 7000 && kept.iter().all(|p| present.contains(&bits(p))));
    // Read for itself it is sampled by its own size.
    let alone = svg::read(written.as_bytes(), &ReadOptions::default()).unwrap();
    assert!(alone.chord_tolerance > 2.0 * before.chord_tolerance);
}

#[test]
fn strokes_beside_fills_are_named_once() {
    let body = "<g stroke='red'><path d='M0 0L9 0 9 9z'/><path d='M20 0L29 0 29 9z'/></g>\
                <path d='M40 0L49 0 49 9z' stroke='red' stroke-opacity='0'/>";
    let [warning] = &drawing(body).warnings[..] else { panic!() };
    assert_eq!(warning.kind, WarningKind::StrokeBesideFill { shapes: 2 });
    assert!(warning.to_string().contains("2 shape(s)") && warning.to_string().contains("--strokes"));
    let text = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{body}</svg>");
    let strokes = ReadOptions { strokes: Strokes::Areas, ..ReadOptions::default() };
    assert_eq!(svg::read(text.as_bytes(), &strokes).unwrap().warnings, []);
}

const TEXT: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 40'>\
                    <text x='5' y='30' font-family='No Such Family' font-size='30'>Rg</text></svg>";

/// A font file of the system with Latin letters.
#[cfg(feature = "text")]
fn font_file() -> Option<PathBuf> {
    use usvg::fontdb::{Database, Family, Query, Source};
    let mut fonts = Database::new();
    fonts.load_system_fonts();
    let families = ["DejaVu Serif", "DejaVu Sans", "Liberation Serif", "Times New Roman", "Helvetica"];
    let file = families.iter().find_map(|name| {
        let face = fonts.query(&Query { families: &[Family::Name(name)], ..Query::default() })?;
        match fonts.face(face)?.source.clone() {
            Source::File(path) => Some(path),
            _ => None,
        }
    });
    if file.is_none() {
        println!("skipped: no font of the system is known to this test");
    }
    file
}

#[cfg(feature = "text")]
#[test]
fn text_is_set_in_the_font_that_is_named() {
    let Some(font) = font_file() else { return };
    let options = ReadOptions { fonts: vec![font], ..ReadOptions::default() };
    let set = svg::read(TEXT.as_bytes(), &options).unwrap();
    // An R with one hole, a g with one or two, and a baseline of 30 below which only the g reaches.
    let topology = set.region.topology();
    assert!(topology.components == 2 && (2..=3).contains(&topology.holes), "{topology:?}");
    let bounds = set.region.bounds();
    assert!(bounds.min.y < -31.0 && bounds.max.y > -20.0 && bounds.min.x >= 5.0 && bounds.max.x < 60.0, "{bounds:?}");
    assert_eq!(set.warnings, []);
    // The same again, from fonts loaded before.
    assert_eq!(svg::read(TEXT.as_bytes(), &options).unwrap(), set);
    if let Some(folder) = shared() {
        let bytes = std::fs::read(folder.join("awk_text_only.svg")).unwrap();
        assert!(svg::read(&bytes, &options).unwrap().region.topology().holes >= 2);
    }
}

#[cfg(feature = "text")]
#[test]
fn a_font_that_is_none_is_refused_and_no_font_is_said() {
    let refused = |path: PathBuf| {
        let options = ReadOptions { fonts: vec![path], ..ReadOptions::default() };
        svg::read(TEXT.as_bytes(), &options).unwrap_err()
    };
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    assert!(matches!(refused(manifest.join("no such font.ttf")), ReadError::Font { .. }));
    let error = refused(manifest.join("Cargo.toml")).to_string();
    assert!(error.contains("Cargo.toml") && error.contains("no TrueType"), "{error}");
    // A family that no system has is not replaced by any other: the text is named, and the font option.
    if let Err(error) = read(TEXT) {
        assert!(matches!(&error, ReadError::NothingFilled { found, .. } if found.texts == 1), "{error}");
        assert!(error.to_string().contains("--font"), "{error}");
    }
}

#[test]
fn dashes_without_end_are_refused_and_many_shapes_are_read() {
    let dashed = |length: &str, ways: usize| {
        let way = format!(
            "<path id=\"fine\" d=\"M0 0L90 90\" stroke=\"black\" stroke-width=\"0.1\" stroke-dasharray=\"{length}\"/>"
        );
        let text =
            format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 100 100\">{}</svg>", way.repeat(ways));
        svg::read(text.as_bytes(), &ReadOptions { strokes: Strokes::Areas, ..ReadOptions::default() })
    };
    assert!(dashed("0.5", 1).is_ok());
    for (length, ways) in [("0.0001", 1), ("0.003", 8)] {
        let error = dashed(length, ways).unwrap_err();
        assert!(matches!(error, ReadError::TooManyDashes { .. }), "{error}");
        let text = error.to_string();
        assert!(text.contains("id=\"fine\"") && text.contains("longer stroke-dasharray"), "{text}");
    }
    // Items of one clip path are cut together: the same area as each by itself.
    let squares: String = (0..40)
        .map(|k| format!("<rect x=\"{}\" y=\"{}\" width=\"5\" height=\"5\"/>", k % 8 * 12, k / 8 * 12))
        .collect();
    let clip = "<clipPath id=\"c\"><rect x=\"2\" width=\"90\" height=\"50\"/></clipPath>";
    let together = drawing(&format!("{clip}<g clip-path=\"url(#c)\">{squares}</g>"));
    let apart = drawing(&format!("{clip}{}", squares.replace("<rect", "<rect clip-path=\"url(#c)\"")));
    assert!((together.region.area() - apart.region.area()).abs() < 1e-9);
    assert!((together.region.area() - 836.0).abs() < 1e-9);
}

#[test]
fn arcs_flatter_than_rounding_are_lines() {
    let flat = drawing("<path d='M10 10A1e12 1e12 0 0 1 20 20L30 10Z'/>");
    let plain = drawing("<path d='M10 10L20 20L30 10Z'/>");
    assert_eq!(points(&flat), points(&plain));
    assert!(flat.region.segments().all(|s| s.link == Link::Line));
    // The long way round is a circle beyond all coordinates, and a radius of 1e7 still bulges.
    assert!(matches!(
        read(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><path d='M10 10A1e12 1e12 0 1 1 20 20L30 10Z'/></svg>"
        ),
        Err(ReadError::Huge { .. })
    ));
    let round = drawing("<path d='M10 10A1e7 1e7 0 0 1 20 20L30 10Z'/>");
    assert!(round.region.segments().any(|s| s.link != Link::Line));
}

#[cfg(feature = "text")]
#[test]
fn generic_and_common_families_are_set_in_an_installed_font_that_is_named() {
    if font_file().is_none() {
        return;
    }
    for family in ["sans-serif", "serif", "monospace", "Arial", "Times New Roman", "Courier New"] {
        let set = read(&TEXT.replace("No Such Family", family)).unwrap();
        assert!(set.region.topology().components >= 2, "{family}");
        for kind in kinds(&set) {
            assert!(matches!(kind, WarningKind::FontReplaced { asked, .. } if asked == family), "{kind:?}");
        }
    }
}
