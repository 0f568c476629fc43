//! STL, binary and text.
//!
//! The format has loose triangles. Vertices with bit-identical coordinates become one vertex (0 and -0 are the same), and no
//! others: what a program rounded differently stays apart.

use std::collections::HashMap;

use super::text::{Syntax, Text};
use super::{MeshError, MeshFormat, Place};
use crate::mesh::{Point, PolygonMesh, TriangleMesh};

/// What stands before the count in a binary file.
const HEADER: usize = 80;

/// Where the triangles of a binary file start.
const START: usize = HEADER + 4;

/// The bytes of a triangle: normal, three corners, and two that nobody agrees on.
const TRIANGLE: usize = 50;

/// Text has no byte 0 among its first ones; a binary file, which has small numbers, does.
const LOOKED_AT: usize = 1024;

/// How many triangles a binary file announces.
fn announced(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(HEADER..START)?;
    Some(u32::from_le_bytes([count[0], count[1], count[2], count[3]]))
}

/// Whether the size is that of a binary file: some of them begin with `solid` as well.
fn is_binary(bytes: &[u8]) -> bool {
    announced(bytes).is_some_and(|n| bytes.len() as u64 == START as u64 + TRIANGLE as u64 * u64::from(n))
}

fn is_text(bytes: &[u8]) -> bool {
    let word = Text::new(bytes, Syntax::Plain).word_anywhere();
    word.is_some_and(|w| w.eq_ignore_ascii_case(b"solid")) && !bytes[..bytes.len().min(LOOKED_AT)].contains(&0)
}

/// Whether this is STL without doubt.
pub(super) fn is_stl(bytes: &[u8]) -> bool {
    is_binary(bytes) || is_text(bytes)
}

/// Vertices that were met, by their coordinates.
#[derive(Default)]
struct Welded {
    mesh: PolygonMesh,
    known: HashMap<[u64; 3], u32>,
}

impl Welded {
    /// The number of the vertex at `p`.
    fn vertex(&mut self, p: [f64; 3]) -> u32 {
        // Adding 0 turns -0 into 0.
        let key = p.map(|x| (x + 0.0).to_bits());
        let points = &mut self.mesh.points;
        *self.known.entry(key).or_insert_with(|| {
            points.push(Point::from(p));
            points.len() as u32 - 1
        })
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<PolygonMesh, MeshError> {
    if is_binary(bytes) {
        return read_binary(bytes);
    }
    if is_text(bytes) {
        return read_text(bytes);
    }
    let end =
        Place::Byte { byte: bytes.len(), element: "triangle", number: bytes.len().saturating_sub(START) / TRIANGLE };
    let Some(count) = announced(bytes) else {
        return Err(MeshError::Truncated { place: end, missing: "the end of the header".into() });
    };
    let needed = START as u64 + TRIANGLE as u64 * u64::from(count);
    if bytes.len() as u64 > needed {
        let place = Place::Byte { byte: needed as usize, element: "triangle", number: count as usize };
        return Err(MeshError::Trailing { place });
    }
    let place = Place::Byte { byte: HEADER, element: "triangle", number: 0 };
    Err(MeshError::Count { place, element: "triangle".into(), count: count.into(), left: bytes.len() - START })
}

fn read_binary(bytes: &[u8]) -> Result<PolygonMesh, MeshError> {
    let mut welded = Welded::default();
    for (number, record) in bytes[START..].chunks_exact(TRIANGLE).enumerate() {
        let mut corners = [0; 3];
        for (k, corner) in corners.iter_mut().enumerate() {
            let at = 12 + 12 * k;
            let coordinate = |i: usize| {
                let b = &record[at + 4 * i..];
                f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
            };
            let p = [0, 1, 2].map(coordinate);
            if let Some(x) = p.iter().find(|x| !x.is_finite()) {
                let byte = START + TRIANGLE * number + at;
                let place = Place::Byte { byte, element: "triangle", number };
                return Err(MeshError::NotFinite { place, what: "a coordinate", value: x.to_string() });
            }
            *corner = welded.vertex(p);
        }
        welded.mesh.push(&corners);
    }
    Ok(welded.mesh)
}

fn read_text(bytes: &[u8]) -> Result<PolygonMesh, MeshError> {
    let mut text = Text::new(bytes, Syntax::Plain);
    let mut welded = Welded::default();
    let mut corners: Vec<u32> = vec![];
    while let Some(word) = text.word_anywhere() {
        let is = |keyword: &str| word.eq_ignore_ascii_case(keyword.as_bytes());
        if !is("solid") {
            return Err(text.unexpected(Some(word), "\"solid\""));
        }
        // Names may be any words, or none.
        text.next_line();
        loop {
            let Some(word) = text.word_anywhere() else {
                return Err(text.unexpected(None, "\"endsolid\""));
            };
            if word.eq_ignore_ascii_case(b"endsolid") {
                text.next_line();
                break;
            }
            if !word.eq_ignore_ascii_case(b"facet") {
                return Err(text.unexpected(Some(word), "\"facet\" or \"endsolid\""));
            }
            // Normals follow from the corners, and are wrong in many files.
            for _ in 0..4 {
                text.word_anywhere();
            }
            expect(&mut text, "outer", "\"outer\"")?;
            expect(&mut text, "loop", "\"loop\"")?;
            corners.clear();
            loop {
                match text.word_anywhere() {
                    Some(word) if word.eq_ignore_ascii_case(b"vertex") => {
                        let what = "a coordinate";
                        let p = [text.number(what)?, text.number(what)?, text.number(what)?];
                        corners.push(welded.vertex(p));
                    }
                    Some(word) if word.eq_ignore_ascii_case(b"endloop") => break,
                    other => return Err(text.unexpected(other, "\"vertex\" or \"endloop\"")),
                }
            }
            if corners.len() < 3 {
                return Err(MeshError::FewCorners { place: text.place(), corners: corners.len() });
            }
            expect(&mut text, "endfacet", "\"endfacet\"")?;
            welded.mesh.push(&corners);
        }
    }
    Ok(welded.mesh)
}

fn expect(text: &mut Text, keyword: &str, expected: &'static str) -> Result<(), MeshError> {
    match text.word_anywhere() {
        Some(word) if word.eq_ignore_ascii_case(keyword.as_bytes()) => Ok(()),
        other => Err(text.unexpected(other, expected)),
    }
}

/// A coordinate as the format can have it.
fn rounded(x: f64) -> f32 {
    x.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32
}

pub(super) fn write(mesh: &PolygonMesh) -> Vec<u8> {
    let triangles: TriangleMesh = mesh.triangulated();
    let mut out = Vec::with_capacity(START + TRIANGLE * triangles.faces.len());
    // It must not begin with "solid".
    out.extend_from_slice(format!("{:<HEADER$}", format!("{} by clopen", MeshFormat::Stl)).as_bytes());
    out.extend_from_slice(&(triangles.faces.len() as u32).to_le_bytes());
    for k in 0..triangles.faces.len() {
        let normal = triangles.area_vector(k).try_normalize(0.0).unwrap_or_default();
        let corners = triangles.triangle(k);
        let places = corners.iter().flat_map(|p| p.iter());
        for x in normal.iter().chain(places) {
            out.extend_from_slice(&rounded(*x).to_le_bytes());
        }
        out.extend_from_slice(&[0; 2]);
    }
    out
}
