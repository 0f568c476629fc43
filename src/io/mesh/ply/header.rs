//! The header of a PLY: what elements there are, and of what they consist.

use std::fmt;

use super::super::text::{Syntax, Text};
use crate::io::mesh::MeshError;

/// How the numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

impl fmt::Display for Encoding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Encoding::Ascii => "ascii",
            Encoding::Little => "binary_little_endian",
            Encoding::Big => "binary_big_endian",
        })
    }
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Type {
    fn of_name(name: &[u8]) -> Option<Type> {
        Some(match name {
            b"char" | b"int8" => Type::I8,
            b"uchar" | b"uint8" => Type::U8,
            b"short" | b"int16" => Type::I16,
            b"ushort" | b"uint16" => Type::U16,
            b"int" | b"int32" => Type::I32,
            b"uint" | b"uint32" => Type::U32,
            b"float" | b"float32" => Type::F32,
            b"double" | b"float64" => Type::F64,
            _ => return None,
        })
    }

    /// How many bytes it has.
    pub fn size(self) -> usize {
        match self {
            Type::I8 | Type::U8 => 1,
            Type::I16 | Type::U16 => 2,
            Type::I32 | Type::U32 | Type::F32 => 4,
            Type::F64 => 8,
        }
    }

    /// A part of a colour as a byte: fractions go from 0 to 1, 16 bits to 65535, the rest to 255.
    pub fn byte(self, value: f64) -> u8 {
        let scale = match self {
            Type::F32 | Type::F64 => 255.0,
            Type::U16 => 1.0 / 257.0,
            _ => 1.0,
        };
        (value * scale).round() as u8
    }
}

/// One number, or as many as the file says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Scalar(Type),
    List { count: Type, item: Type },
}

/// A property of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub name: String,
    pub kind: Kind,
}

/// A kind of element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Element {
    pub name: String,
    /// How many of them follow.
    pub count: u64,
    pub properties: Vec<Property>,
    /// The line of the header.
    pub line: crate::io::mesh::Place,
}

impl Element {
    /// The name as messages use it.
    pub fn label(&self) -> &'static str {
        match self.name.as_str() {
            "vertex" => "vertex",
            "face" => "face",
            _ => "other element",
        }
    }

    /// The fewest bytes that one of them takes.
    pub fn least_size(&self, encoding: Encoding) -> usize {
        let sizes = self.properties.iter().map(|p| match (encoding, p.kind) {
            // A digit and what parts it from the next one.
            (Encoding::Ascii, _) => 2,
            (_, Kind::Scalar(kind)) => kind.size(),
            (_, Kind::List { count, .. }) => count.size(),
        });
        sizes.sum()
    }
}

/// The header of a file.
#[derive(Clone, Debug)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    /// How many bytes it has.
    pub size: usize,
    /// How many lines it has.
    pub lines: usize,
}

impl Header {
    pub fn read(bytes: &[u8]) -> Result<Header, MeshError> {
        let mut text = Text::new(bytes, Syntax::Plain);
        match text.word() {
            Some(b"ply") => {}
            other => return Err(text.unexpected(other, "\"ply\"")),
        }
        let mut encoding = None;
        let mut elements: Vec<Element> = vec![];
        let mut lines = 1;
        loop {
            if !text.next_line() || text.is_at_end() {
                return Err(text.unexpected(None, "\"end_header\""));
            }
            lines += 1;
            match text.word() {
                Some(b"format") => {
                    encoding = Some(match text.word() {
                        Some(b"ascii") => Encoding::Ascii,
                        Some(b"binary_little_endian") => Encoding::Little,
                        Some(b"binary_big_endian") => Encoding::Big,
                        other => {
                            let expected = "ascii, binary_little_endian or binary_big_endian";
                            return Err(text.unexpected(other, expected));
                        }
                    });
                }
                Some(b"element") => {
                    let name = name(&mut text)?;
                    // Only what is read must not come twice; of all others there may be any number.
                    let is_read = matches!(name.as_str(), "vertex" | "face");
                    if is_read && elements.iter().any(|e| e.name == name) {
                        return Err(text.unexpected(Some(name.as_bytes()), "an element that is not there yet"));
                    }
                    let word = text.word();
                    let Some(count) = word.and_then(|w| std::str::from_utf8(w).ok()?.parse::<u64>().ok()) else {
                        return Err(text.unexpected(word, "how many there are"));
                    };
                    elements.push(Element { name, count, properties: vec![], line: text.place() });
                }
                Some(b"property") => {
                    let Some(element) = elements.last_mut() else {
                        return Err(text.unexpected(Some(b"property"), "an element"));
                    };
                    let property = property(&mut text)?;
                    element.properties.push(property);
                }
                Some(b"end_header") => break,
                Some(b"comment" | b"obj_info") | None => {}
                Some(other) => return Err(text.unexpected(Some(other), "a line of a PLY header")),
            }
        }
        let Some(encoding) = encoding else { return Err(MeshError::Header { missing: "line \"format\"" }) };
        if let Some(word) = text.word() {
            return Err(text.unexpected(Some(word), "the end of the line"));
        }
        // Binary data may begin with what looks like the second half of CR LF: lines end as the first one did.
        let first = bytes.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(0);
        let has_two = bytes[first..].starts_with(b"\r\n");
        let end = bytes.len().min(text.at() + if has_two { 2 } else { 1 });
        Ok(Header { encoding, elements, size: end, lines })
    }
}

fn name(text: &mut Text) -> Result<String, MeshError> {
    match text.word() {
        Some(word) => Ok(String::from_utf8_lossy(word).into_owned()),
        None => Err(text.unexpected(None, "a name")),
    }
}

fn property(text: &mut Text) -> Result<Property, MeshError> {
    let expected = "a type, such as float or uchar,";
    let kind = |word: Option<&[u8]>, text: &mut Text| {
        let word = word.or_else(|| text.word());
        word.and_then(Type::of_name).ok_or_else(|| text.unexpected(word, expected))
    };
    let kind = match text.word() {
        Some(b"list") => Kind::List { count: kind(None, text)?, item: kind(None, text)? },
        None => return Err(text.unexpected(None, expected)),
        word => Kind::Scalar(kind(word, text)?),
    };
    Ok(Property { name: name(text)?, kind })
}
