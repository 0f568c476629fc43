//! Wavefront OBJ.
//!
//! Read are `v` and `f`, with numbers that count from the start or backwards, lines joined by a backslash, and colours after
//! the coordinates, from 0 to 1 or from 0 to 255. All other statements are passed over.

use std::fmt::Write as _;

use super::text::{Syntax, Text};
use super::{MeshError, Place, UNCOLOURED};
use crate::mesh::{Point, PolygonMesh};

/// More numbers than this after `v` mean nothing.
const MOST_FIELDS: usize = 8;

/// Words with which a line of another format begins: the file is mixed.
const FOREIGN: &[&[u8]] =
    &[b"ply", b"element", b"property", b"end_header", b"solid", b"facet", b"outer", b"vertex", b"endloop", b"endfacet"];

/// Whether a statement of an OBJ is among the first lines: for files that are called something else.
pub(super) fn is_obj(bytes: &[u8]) -> bool {
    let mut text = Text::new(&bytes[..bytes.len().min(4096)], Syntax::Joined);
    loop {
        if let Some(b"v" | b"vn" | b"vt" | b"f" | b"mtllib" | b"usemtl") = text.word() {
            return text.word().is_some_and(|w| w.first().is_some_and(|b| b.is_ascii_graphic()));
        }
        if !text.next_line() {
            return false;
        }
    }
}

/// Whether a vertex with its three coordinates is the first statement but for names of materials, objects and groups: no other text
/// begins so.
pub(super) fn has_vertices(bytes: &[u8]) -> bool {
    let mut text = Text::new(bytes, Syntax::Joined);
    loop {
        match text.word() {
            None | Some(b"mtllib" | b"usemtl" | b"o" | b"g" | b"s" | b"vn" | b"vt") => {}
            Some(b"v") => {
                let is_number = |w: &[u8]| std::str::from_utf8(w).is_ok_and(|w| w.parse::<f64>().is_ok());
                return (0..3).all(|_| text.word().is_some_and(is_number));
            }
            Some(_) => return false,
        }
        if !text.next_line() {
            return false;
        }
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<PolygonMesh, MeshError> {
    let mut text = Text::new(bytes, Syntax::Joined);
    let mut mesh = PolygonMesh::default();
    let mut colours = Colours::default();
    let mut corners = vec![];
    // Corners may name vertices that come later: each that names a later one than all before it, and where it stands.
    let mut later: Vec<(i64, Place)> = vec![];
    loop {
        match text.word() {
            None => {}
            Some(b"v") => vertex(&mut text, &mut mesh, &mut colours)?,
            Some(b"f") => face(&mut text, &mut mesh, &mut corners, &mut later)?,
            Some(word) if word[0].is_ascii_alphabetic() && !FOREIGN.contains(&word) => {}
            Some(word) => return Err(text.unexpected(Some(word), "a statement of an OBJ file")),
        }
        if !text.next_line() {
            break;
        }
    }
    let count = mesh.points.len();
    if let Some(&(corner, place)) = later.iter().find(|(number, _)| *number > count as i64) {
        return Err(MeshError::NoSuchVertex { place, corner, vertices: count, from: 1 });
    }
    mesh.colours = colours.bytes(count);
    Ok(mesh)
}

/// Statements that are passed over, and what they tell of.
const LEFT_OUT: [(&[&[u8]], &str); 6] = [
    (&[b"vt"], "texture coordinates"),
    (&[b"vn"], "normals"),
    (&[b"usemtl", b"mtllib"], "materials"),
    (&[b"g", b"o"], "names of objects and groups"),
    (&[b"s"], "smoothing groups"),
    (&[b"l", b"p", b"curv", b"curv2", b"surf"], "points, lines and curves"),
];

/// What a file tells of that is left out.
pub(super) fn left_out(bytes: &[u8]) -> Vec<&'static str> {
    let mut text = Text::new(bytes, Syntax::Joined);
    let mut is_there = [false; LEFT_OUT.len()];
    loop {
        if let Some(word) = text.word().filter(|w| !matches!(*w, b"v" | b"f")) {
            let kinds = LEFT_OUT.iter().zip(&mut is_there);
            kinds.filter(|((words, _), _)| words.contains(&word)).for_each(|(_, is_there)| *is_there = true);
        }
        if !text.next_line() {
            break;
        }
    }
    LEFT_OUT.iter().zip(is_there).filter(|(_, is_there)| *is_there).map(|((_, what), _)| *what).collect()
}

/// The colours that were found, and after how many vertices.
#[derive(Default)]
struct Colours {
    found: Vec<(u32, [f64; 3])>,
}

impl Colours {
    /// A colour for each vertex; none where none was found.
    fn bytes(self, count: usize) -> Vec<[u8; 3]> {
        if self.found.is_empty() {
            return vec![];
        }
        // Both scales are in use; in the larger one nearly every file has a number above 1.
        let is_bytes = self.found.iter().any(|(_, c)| c.iter().any(|&x| x > 1.0));
        let scale = if is_bytes { 1.0 } else { 255.0 };
        let mut bytes = vec![UNCOLOURED; count];
        for (k, colour) in self.found {
            bytes[k as usize] = colour.map(|x| (x * scale).round() as u8);
        }
        bytes
    }
}

fn vertex(text: &mut Text, mesh: &mut PolygonMesh, colours: &mut Colours) -> Result<(), MeshError> {
    let what = "a coordinate";
    let point = Point::new(text.number(what)?, text.number(what)?, text.number(what)?);
    let mut more = [0.0; MOST_FIELDS];
    let mut count = 0;
    while let Some(word) = text.word() {
        if count == MOST_FIELDS {
            return Err(text.unexpected(Some(word), "the end of the line"));
        }
        more[count] = text.finite(word, "a colour or weight")?;
        count += 1;
    }
    // One number is a weight, which only curves need; three are a colour; four are both.
    match count {
        3 => colours.found.push((mesh.points.len() as u32, [more[0], more[1], more[2]])),
        4 => colours.found.push((mesh.points.len() as u32, [more[1], more[2], more[3]])),
        _ => {}
    }
    mesh.points.push(point);
    Ok(())
}

fn face(
    text: &mut Text,
    mesh: &mut PolygonMesh,
    corners: &mut Vec<u32>,
    later: &mut Vec<(i64, Place)>,
) -> Result<(), MeshError> {
    corners.clear();
    let count = mesh.points.len();
    while let Some(word) = text.word() {
        let digits = word.iter().position(|&b| b == b'/').map_or(word, |end| &word[..end]);
        let Some(number) = integer(digits) else {
            return Err(text.unexpected(Some(word), "the number of a vertex"));
        };
        let from_one = if number < 0 { count as i64 + 1 + number } else { number };
        // u32::MAX stands for no vertex.
        if from_one < 1 || from_one >= i64::from(u32::MAX) {
            return Err(MeshError::NoSuchVertex { place: text.place(), corner: number, vertices: count, from: 1 });
        }
        if from_one > count as i64 && later.last().is_none_or(|(most, _)| *most < from_one) {
            later.push((from_one, text.place()));
        }
        corners.push((from_one - 1) as u32);
    }
    if corners.len() < 3 {
        return Err(MeshError::FewCorners { place: text.place(), corners: corners.len() });
    }
    mesh.push(corners);
    Ok(())
}

/// A whole number with or without a sign.
fn integer(word: &[u8]) -> Option<i64> {
    let (sign, digits) = match word {
        [b'-', rest @ ..] => (-1, rest),
        [b'+', rest @ ..] => (1, rest),
        _ => (1, word),
    };
    // 18 digits fit, and zeros before them do not occur.
    if digits.is_empty() || digits.len() > 18 {
        return None;
    }
    let mut number = 0i64;
    for b in digits {
        number = 10 * number + i64::from(b.is_ascii_digit().then(|| b - b'0')?);
    }
    Some(sign * number)
}

/// Colours have this many digits after the point: enough to give every byte back.
const COLOUR_DIGITS: f64 = 1e4;

pub(super) fn write(mesh: &PolygonMesh) -> Vec<u8> {
    // What a vertex and a polygon take in most files.
    let mut out = String::with_capacity(48 * mesh.points.len() + 24 * mesh.polygon_count());
    let has_colours = mesh.colours.len() == mesh.points.len();
    for (k, p) in mesh.points.iter().enumerate() {
        out.push('v');
        for x in p.iter() {
            out.push(' ');
            number(&mut out, *x);
        }
        if has_colours {
            for byte in mesh.colours[k] {
                // Writing to a string cannot fail.
                let _ = write!(out, " {}", (f64::from(byte) / 255.0 * COLOUR_DIGITS).round() / COLOUR_DIGITS);
            }
        }
        out.push('\n');
    }
    for polygon in mesh.polygons() {
        out.push('f');
        for v in polygon {
            let _ = write!(out, " {}", u64::from(*v) + 1);
        }
        out.push('\n');
    }
    out.into_bytes()
}

/// The fewest digits that read back to the same bits, with an exponent where they would have rows of zeros.
fn number(out: &mut String, x: f64) {
    let size = x.abs();
    // Writing to a string cannot fail.
    let _ = if size != 0.0 && !(1e-5..1e16).contains(&size) { write!(out, "{x:e}") } else { write!(out, "{x}") };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_of_a_colour_comes_back_from_obj() {
        let mut mesh = PolygonMesh::new((0..256).map(|k| Point::new(f64::from(k), 0.0, 0.0)).collect());
        mesh.push(&[0, 1, 2]);
        mesh.colours = (0..=255).map(|k| [k, 255 - k, k / 2]).collect();
        assert_eq!(read(&write(&mesh)).unwrap(), mesh);
    }
}
