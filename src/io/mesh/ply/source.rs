//! The numbers of a PLY, one after the other, in whichever way they are written.

use super::super::error::quoted;
use super::super::text::{Syntax, Text};
use super::header::{Element, Encoding, Header, Type};
use crate::io::mesh::{MeshError, Place};

/// Reads the numbers behind a header.
pub(super) struct Source<'a> {
    bytes: &'a [u8],
    /// How many bytes of binary data are passed.
    at: usize,
    encoding: Encoding,
    text: Text<'a>,
    element: Option<&'a Element>,
    row: usize,
}

impl<'a> Source<'a> {
    pub fn new(bytes: &'a [u8], header: &Header) -> Source<'a> {
        let text = Text::starting(bytes, header.size, header.lines + 1, Syntax::Plain);
        Source { bytes, at: header.size, encoding: header.encoding, text, element: None, row: 0 }
    }

    fn left(&self) -> usize {
        match self.encoding {
            Encoding::Ascii => self.bytes.len() - self.text.at(),
            _ => self.bytes.len() - self.at,
        }
    }

    /// Which one of its elements is read.
    pub fn row(&self) -> usize {
        self.row
    }

    pub fn place(&self) -> Place {
        let element = self.element.map_or("end", Element::label);
        match self.encoding {
            Encoding::Ascii => self.text.place(),
            _ => Place::Byte { byte: self.at, element, number: self.row },
        }
    }

    /// Whether the file is long enough for what the header announces.
    pub fn has_room(&self, element: &Element) -> Result<(), MeshError> {
        let needed = u128::from(element.count) * element.least_size(self.encoding) as u128;
        // Behind the last number of a text nothing need stand.
        let slack = usize::from(self.encoding == Encoding::Ascii);
        if needed > (self.left() + slack) as u128 {
            return Err(MeshError::Count {
                place: element.line,
                element: quoted(element.name.as_bytes()).trim_matches('"').to_string(),
                count: element.count,
                left: self.left(),
            });
        }
        Ok(())
    }

    /// Goes to an element: in a text, to the next line with words.
    pub fn begin(&mut self, element: &'a Element, row: usize) -> Result<(), MeshError> {
        (self.element, self.row) = (Some(element), row);
        if self.encoding == Encoding::Ascii && !self.text.skip_blank_lines() {
            return Err(self.truncated());
        }
        Ok(())
    }

    /// Leaves an element: in a text, no more words may follow on its line.
    pub fn end(&mut self) -> Result<(), MeshError> {
        if self.encoding == Encoding::Ascii {
            if let Some(word) = self.text.word() {
                return Err(self.text.unexpected(Some(word), "the end of the line"));
            }
            self.text.next_line();
        }
        Ok(())
    }

    fn truncated(&self) -> MeshError {
        let missing = match self.element {
            Some(e) => format!("{} {} of {}", e.label(), self.row + 1, e.count),
            None => String::new(),
        };
        MeshError::Truncated { place: self.place(), missing }
    }

    /// The next number; in a text it is finite.
    pub fn value(&mut self, kind: Type) -> Result<f64, MeshError> {
        if self.encoding == Encoding::Ascii {
            return match self.text.word() {
                Some(word) => self.text.finite(word, "a number"),
                None if self.text.is_at_end() => Err(self.truncated()),
                None => Err(self.text.unexpected(None, "a number")),
            };
        }
        let size = kind.size();
        let Some(bytes) = self.bytes.get(self.at..self.at + size) else { return Err(self.truncated()) };
        let mut b = [0u8; 8];
        b[..size].copy_from_slice(bytes);
        if self.encoding == Encoding::Big {
            b[..size].reverse();
        }
        self.at += size;
        Ok(match kind {
            Type::I8 => f64::from(b[0] as i8),
            Type::U8 => f64::from(b[0]),
            Type::I16 => f64::from(i16::from_le_bytes([b[0], b[1]])),
            Type::U16 => f64::from(u16::from_le_bytes([b[0], b[1]])),
            Type::I32 => f64::from(i32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Type::U32 => f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Type::F32 => f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Type::F64 => f64::from_le_bytes(b),
        })
    }

    /// How many numbers the list that begins here has.
    pub fn count(&mut self, kind: Type, item: Type) -> Result<usize, MeshError> {
        let place = self.place();
        let value = self.value(kind)?;
        if value < 0.0 || value.fract() != 0.0 || !value.is_finite() {
            return Err(MeshError::Unexpected { place, found: value.to_string(), expected: "the length of a list" });
        }
        let least = match self.encoding {
            Encoding::Ascii => 1,
            _ => item.size(),
        };
        if value * least as f64 > self.left() as f64 {
            return Err(self.truncated());
        }
        Ok(value as usize)
    }

    /// A number that must be finite.
    pub fn finite(&self, value: f64, what: &'static str) -> Result<f64, MeshError> {
        if value.is_finite() {
            Ok(value)
        } else {
            Err(MeshError::NotFinite { place: self.place(), what, value: value.to_string() })
        }
    }

    /// A number that must be that of a vertex.
    pub fn corner(&self, value: f64, vertices: usize) -> Result<u32, MeshError> {
        if value.fract() != 0.0 || !value.is_finite() {
            let place = self.place();
            return Err(MeshError::Unexpected { place, found: value.to_string(), expected: "the number of a vertex" });
        }
        // u32::MAX stands for no vertex.
        if value < 0.0 || value >= vertices as f64 || value >= f64::from(u32::MAX) {
            return Err(MeshError::NoSuchVertex { place: self.place(), corner: value as i64, vertices, from: 0 });
        }
        Ok(value as u32)
    }

    /// Makes sure that nothing but white space is left.
    pub fn finish(&mut self) -> Result<(), MeshError> {
        let is_over = match self.encoding {
            Encoding::Ascii => !self.text.skip_blank_lines(),
            _ => self.bytes[self.at..].iter().all(u8::is_ascii_whitespace),
        };
        self.element = None;
        if is_over { Ok(()) } else { Err(MeshError::Trailing { place: self.place() }) }
    }
}
