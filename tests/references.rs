//! The rolling disk against the stored references: 26 drawings, three radii, closed and opened.
//!
//! A spread of them, or all with CLOPEN_ALL_REFERENCES set (best in release). They were made from the polygons
//! that `Curves::Polygon` gives, and are themselves certified by distances to 1e-6 r only: where a result is farther than
//! 1e-7 r from one, the definition of the closing decides.

mod laws;

use std::path::{Path, PathBuf};
use std::process::Command;

use clopen::io::svg::{self, Curves, ReadOptions};
use clopen::plane::{Arc, Joint, Link, Point, Region, Ring, Turn, Vector, Vertex};
use clopen::reference::Operation;
use clopen::rolling::{self, Topology};
use laws::{ACCURACY, Arbiter};

/// What may poke out, over the radius.
const CONTAINMENT: f64 = 1e-9;

/// Of all references every so many are compared by default: it shares no factor with the six of each drawing.
const SPREAD: usize = 7;

/// Drawings with more vertices are left to the full run.
const LARGEST_BY_DEFAULT: u64 = 8000;

/// By how much numbers of vertices may differ: the references' polygons keep a few points on straight lines, or nearly so,
/// where shapes meet that are united.
const VERTICES_APART: f64 = 1e-3;

/// References that a polygon clipper made, within its own tolerance.
const CLIPPED: &str = "clipper2";

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/2d")
}

/// Rings of "x y bulge" rows, ended by "#", with y downward.
fn parse_arcs(text: &str) -> Region {
    let rings = text.split('#').map(|block| {
        let rows: Vec<[f64; 3]> = block
            .lines()
            .filter_map(|l| {
                let mut numbers = l.split_whitespace().map(|t| t.parse::<f64>().unwrap());
                Some([numbers.next()?, -numbers.next()?, -numbers.next()?])
            })
            .collect();
        let n = rows.len();
        let vertices = (0..n).map(|i| {
            let ([ax, ay, bulge], [bx, by, _]) = (rows[i], rows[(i + 1) % n]);
            let (from, to) = (Point::new(ax, ay), Point::new(bx, by));
            let link = if bulge.abs() < 1e-12 {
                Link::Line
            } else {
                let chord = to - from;
                let center = nalgebra::center(&from, &to)
                    + Vector::new(-chord.y, chord.x) * ((1.0 - bulge * bulge) / (4.0 * bulge));
                let turn = if bulge > 0.0 { Turn::Left } else { Turn::Right };
                Link::Arc(Arc { center, radius: (from - center).norm(), turn })
            };
            Vertex { point: from, link, joint: Joint::Corner, id: None }
        });
        Ring { vertices: vertices.collect() }
    });
    // Seen from the other side rings run the other way.
    Region::new(rings.filter(|r| r.len() > 1).collect()).reversed()
}

/// Polygons and multipolygons in little-endian well-known binary, with y downward.
fn parse_wkb(bytes: &[u8]) -> Region {
    struct Reader<'a>(&'a [u8]);
    impl Reader<'_> {
        fn take<const N: usize>(&mut self) -> [u8; N] {
            let (head, tail) = self.0.split_first_chunk().expect("the file is whole");
            self.0 = tail;
            *head
        }
        fn number(&mut self) -> u32 {
            u32::from_le_bytes(self.take())
        }
        fn geometry(&mut self, rings: &mut Vec<Ring>) {
            assert_eq!(self.take::<1>(), [1], "little-endian");
            let kind = self.number();
            let count = self.number();
            for k in 0..count {
                if kind == 6 {
                    self.geometry(rings);
                    continue;
                }
                assert_eq!(kind, 3, "a polygon");
                let points = self.number();
                let mut ring = Ring::polygon((0..points).map(|_| {
                    let x = f64::from_le_bytes(self.take());
                    Point::new(x, -f64::from_le_bytes(self.take()))
                }));
                // The first point is repeated at the end.
                ring.vertices.pop();
                let outer = k == 0;
                rings.push(if (ring.area() > 0.0) == outer { ring } else { ring.reversed() });
            }
        }
    }
    let mut rings = vec![];
    Reader(bytes).geometry(&mut rings);
    Region::new(rings)
}

fn unpacked(path: &Path) -> Vec<u8> {
    let output = Command::new("xz").arg("-dc").arg(path).output().unwrap();
    assert!(output.status.success(), "{}", path.display());
    output.stdout
}

fn stored(key: &str, source: &str) -> Region {
    let folder = folder().join("ref");
    if source == CLIPPED {
        parse_wkb(&unpacked(&folder.join(format!("{key}.wkb.xz"))))
    } else {
        parse_arcs(&String::from_utf8(unpacked(&folder.join(format!("{key}.arcs.xz")))).unwrap())
    }
}

#[test]
fn results_agree_with_stored_references_or_the_references_are_at_fault() {
    let Ok(index) = std::fs::read_to_string(folder().join("ref/index.json")) else {
        println!("skipped: ../shared is absent");
        return;
    };
    if Command::new("xz").arg("--version").output().is_err() {
        println!("skipped: the command xz is absent");
        return;
    }
    let index: serde_json::Value = serde_json::from_str(&index).unwrap();
    let index = index.as_object().unwrap();
    let all = std::env::var_os("CLOPEN_ALL_REFERENCES").is_some();
    let mut failures = vec![];
    let (mut compared, mut farthest, mut still_vertices, mut proved) = (0, 0.0f64, 0, 0);
    for (k, (key, entry)) in index.iter().enumerate() {
        let vertices = entry["nv_in"].as_u64().unwrap();
        if !all && (k % SPREAD != 0 || vertices > LARGEST_BY_DEFAULT) {
            continue;
        }
        let options = ReadOptions { curves: Curves::Polygon, ..ReadOptions::default() };
        let drawing = std::fs::read(folder().join(entry["file"].as_str().unwrap())).unwrap();
        let input = svg::read(&drawing, &options).unwrap().region;
        let r = entry["r"].as_f64().unwrap();
        let operation = if entry["mode"] == "close" { Operation::Close } else { Operation::Open };
        let run = if operation == Operation::Close { rolling::close } else { rolling::open };
        let mut fail = |what: String| failures.push(format!("{key}: {what}"));
        if (input.vertex_count() as f64 / vertices as f64 - 1.0).abs() > VERTICES_APART {
            fail(format!("{} vertices read, the reference was made from {vertices}", input.vertex_count()));
        }
        let [merged, kept] = [Topology::Merge, Topology::Keep].map(|t| run(&input, laws::radius(r), t));
        if merged.contradictions > 0 {
            fail(format!("{} contradictions", merged.contradictions));
        }
        let source = entry["source"].as_str().unwrap();
        let reference = stored(key, source);
        let (d, place) = laws::hausdorff(&merged.region, &reference, r);
        if d > ACCURACY * r {
            let arbiter = Arbiter::new(&input, operation, r);
            let ours = arbiter.fault_against(&merged.region, &reference, 0.5 * ACCURACY * r, 48);
            let theirs = arbiter.fault_against(&reference, &merged.region, 0.5 * ACCURACY * r, 48);
            println!("{key}: {:.1e} r at {place}: reference {theirs:?}", d / r);
            if ours.is_some() || theirs.is_none() {
                fail(format!("{:.1e} r from the reference at {place}: ours {ours:?}, theirs {theirs:?}", d / r));
            }
        } else {
            farthest = farthest.max(d / r);
        }
        for (mode, outcome) in [("merge", &merged), ("keep", &kept)] {
            let (violation, place) = laws::containment(&input, &outcome.region, operation, r);
            if violation > CONTAINMENT * r {
                fail(format!("{mode}: containment fails by {:.1e} r at {place}", violation / r));
            }
            let misplaced = laws::misplaced_identities(&input, &outcome.region);
            if misplaced > 0 {
                fail(format!("{mode}: {misplaced} vertices with an identity have moved"));
            }
            let (still, lost) = laws::lost_vertices(&input, &outcome.region, operation, 1e-9 * r);
            still_vertices += still;
            let lost = laws::truly_still(lost, &input, operation, r);
            if let Some(p) = lost.first() {
                fail(format!("{mode}: {} vertices that are still are lost, as {p}", lost.len()));
            }
        }
        if let Some(place) = laws::crossing(&merged.region, r) {
            fail(format!("the result crosses itself at {place}"));
        }
        if kept.differences.is_empty() {
            proved += 1;
            let (d, place) = laws::hausdorff(&merged.region, &kept.region, r);
            if d > ACCURACY * r {
                fail(format!("keep is {:.1e} r from merge at {place} and tells no difference", d / r));
            }
        }
        compared += 1;
    }
    println!(
        "{compared} compared, {farthest:.1e} r at most where they agree; {still_vertices} still vertices; keep is merge in {proved}"
    );
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(compared >= if all { 156 } else { 15 }, "only {compared} compared");
    assert!(still_vertices > 1000 && proved > 0);
}
