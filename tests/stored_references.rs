//! The offset references against the certified references of the shared data.
//!
//! The countries alone: they are plain polygons, so that this needs no reader of drawings.

use std::path::{Path, PathBuf};
use std::process::Command;

use clopen::check::{compare, lost_features};
use clopen::plane::{Arc, Joint, Link, Point, Region, Ring, Turn, Vector, Vertex};
use clopen::reference::{Operation, arcs, overlay};
use clopen::units::Radius;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::overlay::FloatOverlay;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/2d/ref")
}

/// Rings of "x y bulge" rows, ended by "#".
fn parse(text: &str) -> Region {
    let mut rings = Vec::new();
    for block in text.split('#') {
        let rows: Vec<[f64; 3]> = block
            .lines()
            .filter_map(|l| {
                let mut numbers = l.split_whitespace().map(|t| t.parse::<f64>().unwrap());
                Some([numbers.next()?, numbers.next()?, numbers.next()?])
            })
            .collect();
        let n = rows.len();
        let vertices = (0..n).map(|i| {
            let (a, b) = (rows[i], rows[(i + 1) % n]);
            let (from, to) = (Point::new(a[0], a[1]), Point::new(b[0], b[1]));
            let bulge = a[2];
            let link = if bulge.abs() < 1e-12 {
                Link::Line
            } else {
                let chord = to - from;
                let center = nalgebra::center(&from, &to)
                    + Vector::new(-chord.y, chord.x) * ((1.0 - bulge * bulge) / (4.0 * bulge));
                let radius = (from - center).norm();
                Link::Arc(Arc { center, radius, turn: if bulge > 0.0 { Turn::Left } else { Turn::Right } })
            };
            Vertex { point: from, link, joint: Joint::Corner, id: None }
        });
        let ring = Ring { vertices: vertices.collect() };
        if n > 1 {
            rings.push(ring);
        }
    }
    Region::new(rings)
}

/// The drawing of a country: one path of straight links, absolute coordinates, drawn even-odd.
fn parse_country(svg: &str) -> Region {
    let data = svg.split(" d=\"").nth(1).unwrap().split('"').next().unwrap();
    let contours: Vec<Vec<[f64; 2]>> = data
        .split(['M', 'Z'])
        .map(|ring| {
            let pairs = ring.split_whitespace().map(|pair| pair.split_once(',').unwrap());
            pairs.map(|(x, y)| [x.parse().unwrap(), y.parse().unwrap()]).collect()
        })
        .filter(|ring: &Vec<_>| !ring.is_empty())
        .collect();
    let shapes = FloatOverlay::<[f64; 2], i64>::from_subj(&contours).overlay(OverlayRule::Subject, FillRule::EvenOdd);
    let ring = |c: &Vec<[f64; 2]>| Ring::polygon(c.iter().map(|p| Point::new(p[0], p[1])));
    Region::new(shapes.iter().flatten().map(ring).collect())
}

#[test]
fn countries_agree_with_their_stored_references() {
    let Ok(index) = std::fs::read_to_string(folder().join("index.json")) else {
        println!("skipped: ../shared is absent");
        return;
    };
    if Command::new("xz").arg("--version").output().is_err() {
        println!("skipped: the command xz is absent");
        return;
    }
    let index: serde_json::Value = serde_json::from_str(&index).unwrap();
    let mut compared = 0;
    for (key, entry) in index.as_object().unwrap().iter().filter(|(key, _)| key.starts_with("country_")) {
        let input = std::fs::read_to_string(folder().join("..").join(entry["file"].as_str().unwrap())).unwrap();
        let input = parse_country(&input);
        let unpacked = Command::new("xz").arg("-dc").arg(folder().join(format!("{key}.arcs.xz"))).output().unwrap();
        let stored = parse(&String::from_utf8(unpacked.stdout).unwrap());
        let radius = Radius::new(entry["r"].as_f64().unwrap()).unwrap();
        let operation = if entry["mode"] == "close" { Operation::Close } else { Operation::Open };
        let mut methods = vec![("arcs", arcs::closing as fn(&_, _, _) -> _)];
        // Exact as well on all of them, but each takes seconds.
        if key.starts_with("country_vietnam.r2") || std::env::var_os("CLOPEN_ALL_REFERENCES").is_some() {
            methods.push(("overlay", overlay::closing));
        }
        for (method, closing) in methods {
            let start = std::time::Instant::now();
            let reference = closing(&input, radius, operation).unwrap_or_else(|e| panic!("{key}, {method}: {e}"));
            let seconds = start.elapsed().as_secs_f64();
            let report = compare(&input, &stored, &reference, radius, operation);
            let distance = report.hausdorff.largest_over_r;
            println!(
                "{key}, {method}: {distance:.1e} r, certified {:.1e} r, {seconds:.2} s, kept {:.4}",
                reference.error_bound / radius.get(),
                report.kept.fraction
            );
            // The stored arcs are certified to 1e-6 r, by distances, which displaces narrow crossings by a little more.
            assert!(distance < 1e-5, "{key}, {method}: {distance:e}: {:?}", report.hausdorff);
            compared += 1;
        }
        let closed = arcs::closing(&input, radius, operation).unwrap().region;
        let start = std::time::Instant::now();
        let lost = lost_features(&input, &closed, radius, operation).len();
        println!("{key}: {lost} lost features in {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
        assert!(lost > 0, "{key}");
    }
    assert!(compared >= 14, "{compared}");
}
