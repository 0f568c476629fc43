//! The stored references: 26 drawings, three radii, closed and opened, as `../shared/data/2d/ref` has them.

use std::path::{Path, PathBuf};
use std::process::Command;

use clopen::io::svg::{self, Curves, ReadOptions};
use clopen::plane::{Arc, Joint, Link, Point, Region, Ring, Turn, Vector, Vertex};
use clopen::reference::Operation;

/// References that a polygon clipper made, within its own tolerance; all others have exact arcs.
const CLIPPED: &str = "clipper2";

/// What the index says of a reference.
pub struct Entry {
    /// The name of the drawing, the radius in per cent of the diagonal, and the operation.
    pub key: String,
    pub file: String,
    pub r: f64,
    pub operation: Operation,
    /// How many vertices the polygon had that the reference was made from.
    pub vertices: usize,
    source: String,
}

/// All references that are stored; `None`, and why is printed, where they cannot be had.
pub fn index() -> Option<Vec<Entry>> {
    let Ok(text) = std::fs::read_to_string(folder().join("ref/index.json")) else {
        println!("skipped: ../shared is absent");
        return None;
    };
    if Command::new("xz").arg("--version").output().is_err() {
        println!("skipped: the command xz is absent");
        return None;
    }
    let index: serde_json::Value = serde_json::from_str(&text).unwrap();
    let entry = |(key, entry): (&String, &serde_json::Value)| Entry {
        key: key.clone(),
        file: entry["file"].as_str().unwrap().to_owned(),
        r: entry["r"].as_f64().unwrap(),
        operation: if entry["mode"] == "close" { Operation::Close } else { Operation::Open },
        vertices: entry["nv_in"].as_u64().unwrap() as usize,
        source: entry["source"].as_str().unwrap().to_owned(),
    };
    Some(index.as_object().unwrap().iter().map(entry).collect())
}

impl Entry {
    /// The name of the drawing.
    pub fn drawing(&self) -> &str {
        self.file.trim_end_matches(".svg")
    }

    /// The drawing as the polygon that references are made from.
    pub fn input(&self) -> Region {
        let options = ReadOptions { curves: Curves::Polygon, ..ReadOptions::default() };
        svg::read(&std::fs::read(folder().join(&self.file)).unwrap(), &options).unwrap().region
    }

    /// The reference itself.
    pub fn reference(&self) -> Region {
        let folder = folder().join("ref");
        if self.source == CLIPPED {
            parse_wkb(&unpacked(&folder.join(format!("{}.wkb.xz", self.key))))
        } else {
            parse_arcs(&String::from_utf8(unpacked(&folder.join(format!("{}.arcs.xz", self.key)))).unwrap())
        }
    }
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/2d")
}

fn unpacked(path: &Path) -> Vec<u8> {
    let output = Command::new("xz").arg("-dc").arg(path).output().unwrap();
    assert!(output.status.success(), "{}", path.display());
    output.stdout
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
