//! Whole drawings: what is read of them, what is said of the rest, and what is written.

use std::path::{Path, PathBuf};

use clopen::io::svg::{self, Curves, Drawing, ReadError, ReadOptions, Strokes, WarningKind};
use clopen::plane::{Link, Point, Region, Ring};
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
    }
}
