//! The offset references against the certified references of the shared data.
//!
//! A stored closing of a drawing is a fixed point of the closing, and the closing of a stored opening's complement is one as
//! well: this needs no reader of drawings. Their inputs are held against them where drawings are read.

use std::path::{Path, PathBuf};
use std::process::Command;

use clopen::check::compare;
use clopen::plane::{Arc, Joint, Link, Point, Region, Ring, Turn, Vector, Vertex};
use clopen::reference::{self, Operation};
use clopen::units::Radius;

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

#[test]
fn stored_results_are_fixed_points() {
    let Ok(index) = std::fs::read_to_string(folder().join("index.json")) else {
        println!("skipped: ../shared is absent");
        return;
    };
    if Command::new("xz").arg("--version").output().is_err() {
        println!("skipped: the command xz is absent");
        return;
    }
    let index: serde_json::Value = serde_json::from_str(&index).unwrap();
    let (mut compared, mut worst, mut refused) = (0, (0.0, String::new()), Vec::new());
    for (key, entry) in index.as_object().unwrap() {
        // Each takes a fraction of a second; the largest would take many.
        if entry["source"] != "cav-exact" || entry["nv_arcs"].as_u64().unwrap_or(u64::MAX) > 3000 {
            continue;
        }
        let unpacked = Command::new("xz").arg("-dc").arg(folder().join(format!("{key}.arcs.xz"))).output().unwrap();
        let stored = parse(&String::from_utf8(unpacked.stdout).unwrap());
        if stored.is_empty() {
            continue;
        }
        // A little smaller, so that arcs of exactly the radius do not stand on the edge between moving and not.
        let radius = Radius::new(entry["r"].as_f64().unwrap() * (1.0 - 1e-6)).unwrap();
        let operation = if entry["mode"] == "close" { Operation::Close } else { Operation::Open };
        match reference::closing(&stored, radius, operation) {
            Ok(reference) => {
                let report = compare(&stored, &stored, &reference, radius, operation);
                let error = report.hausdorff.largest_over_r;
                if error > 1e-7 {
                    println!("{key}: {error:.2e} ({:?})", reference.method);
                }
                if error > worst.0 {
                    worst = (error, key.clone());
                }
                compared += 1;
            }
            Err(error) => refused.push(format!("{key}: {error}")),
        }
    }
    println!("{compared} compared, worst {:.2e} r ({}), {} refused", worst.0, worst.1, refused.len());
    assert!(compared > 60, "{compared}");
    assert!(refused.len() <= 2, "{}", refused.join("\n"));
    // The stored arcs meet within 1e-6 r only; at a radius this near to theirs the fillets differ by no more.
    assert!(worst.0 < 1e-4, "{worst:?}");
}
