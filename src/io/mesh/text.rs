//! Words and lines of text files.

use super::error::quoted;
use super::{MeshError, Place};

/// Whether a backslash at the end of a line joins the next one to it, and `#` begins a comment.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Syntax {
    /// As in OBJ.
    Joined,
    /// As in STL and PLY.
    Plain,
}

/// A reader of words that counts lines. Lines end with LF, CR LF or CR.
#[derive(Clone)]
pub(super) struct Text<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
    syntax: Syntax,
}

impl<'a> Text<'a> {
    pub fn new(bytes: &'a [u8], syntax: Syntax) -> Text<'a> {
        // The mark of byte order that some editors put before the text.
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Text { bytes, at, line: 1, syntax }
    }

    /// A reader that starts at a byte, which is on this line.
    pub fn starting(bytes: &'a [u8], at: usize, line: usize, syntax: Syntax) -> Text<'a> {
        Text { bytes, at, line, syntax }
    }

    /// Goes to the next line with words, this one included; false where there is none.
    pub fn skip_blank_lines(&mut self) -> bool {
        loop {
            let before = self.clone();
            if self.word().is_some() {
                *self = before;
                return true;
            }
            if !self.next_line() {
                return false;
            }
        }
    }

    /// How many bytes have been passed.
    pub fn at(&self) -> usize {
        self.at
    }

    pub fn place(&self) -> Place {
        Place::Line(self.line)
    }

    pub fn is_at_end(&self) -> bool {
        self.at >= self.bytes.len()
    }

    /// How many bytes the end of a line has at `at`; none: no line ends there.
    fn line_end(&self, at: usize) -> usize {
        match self.bytes.get(at) {
            Some(b'\n') => 1,
            Some(b'\r') if self.bytes.get(at + 1) == Some(&b'\n') => 2,
            Some(b'\r') => 1,
            _ => 0,
        }
    }

    /// The next word on this line.
    pub fn word(&mut self) -> Option<&'a [u8]> {
        loop {
            match self.bytes.get(self.at)? {
                b' ' | b'\t' | 0x0b | 0x0c => self.at += 1,
                b'\n' | b'\r' => return None,
                b'#' if self.syntax == Syntax::Joined => {
                    self.skip_bytes_of_line();
                    return None;
                }
                b'\\' if self.syntax == Syntax::Joined && self.line_end(self.at + 1) > 0 => {
                    self.at += 1 + self.line_end(self.at + 1);
                    self.line += 1;
                }
                _ => break,
            }
        }
        let rest = &self.bytes[self.at..];
        let mut length = rest.iter().position(|b| matches!(b, b' ' | 0x09..=0x0d)).unwrap_or(rest.len());
        let is_joined = self.syntax == Syntax::Joined && length > 1 && rest[length - 1] == b'\\';
        if is_joined && self.line_end(self.at + length) > 0 {
            length -= 1;
        }
        self.at += length;
        Some(&rest[..length])
    }

    /// The next word, on whichever line.
    pub fn word_anywhere(&mut self) -> Option<&'a [u8]> {
        loop {
            if let Some(word) = self.word() {
                return Some(word);
            }
            if !self.next_line() {
                return None;
            }
        }
    }

    fn skip_bytes_of_line(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(rest.len());
    }

    /// Goes to the start of the next line; false at the end of the text.
    pub fn next_line(&mut self) -> bool {
        if self.syntax == Syntax::Joined {
            // The words that are left may end with a backslash.
            while self.word().is_some() {}
        } else {
            self.skip_bytes_of_line();
        }
        if self.is_at_end() {
            return false;
        }
        self.at += self.line_end(self.at);
        self.line += 1;
        true
    }

    /// The next word on this line, as a finite number.
    pub fn number(&mut self, what: &'static str) -> Result<f64, MeshError> {
        let Some(word) = self.word() else {
            return Err(self.unexpected(None, "a number"));
        };
        self.finite(word, what)
    }

    /// A word as a finite number.
    pub fn finite(&self, word: &[u8], what: &'static str) -> Result<f64, MeshError> {
        let value = std::str::from_utf8(word).ok().and_then(|w| w.parse::<f64>().ok());
        match value {
            Some(value) if value.is_finite() => Ok(value),
            Some(_) => Err(MeshError::NotFinite { place: self.place(), what, value: quoted(word) }),
            None => Err(self.unexpected(Some(word), "a number")),
        }
    }

    /// The error of a word, or of the end of a line, where something else must be.
    pub fn unexpected(&self, word: Option<&[u8]>, expected: &'static str) -> MeshError {
        match word {
            None if self.is_at_end() => MeshError::Truncated { place: self.place(), missing: expected.to_string() },
            None => MeshError::Unexpected { place: self.place(), found: "the end of the line".into(), expected },
            Some(word) => MeshError::Unexpected { place: self.place(), found: quoted(word), expected },
        }
    }
}
