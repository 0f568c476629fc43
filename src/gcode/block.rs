//! One line of a program, taken apart into words.
//!
//! The crate `gcode` does the reading. It is given one line at a time, so that a bracket that is never closed cannot
//! swallow the lines below it, and numbers are read again from the text, because it keeps no more than an `f32`.

use gcode::core::{
    BlockVisitor, CommandVisitor, ControlFlow, Diagnostics, Number, ProgramVisitor, Span, TokenType, Value,
};

/// Digits that the number of a command may have: with more, the multiplication inside `gcode` overflows.
const MAX_COMMAND_DIGITS: usize = 8;

/// A letter with its number, `X12.5`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Word {
    /// Upper case.
    pub letter: char,
    /// The number after it.
    pub value: f64,
}

/// Something on a line that is no word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A letter whose number is missing or no number.
    BadNumber(String),
    /// Characters that mean nothing, or an expression, parameter or O-word flow that this reader cannot follow.
    Unknown(String),
    /// A `(` without its `)`.
    UnclosedComment,
    /// A `(` inside a comment in brackets.
    NestedComment,
}

/// One line of a program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Block {
    /// The words in order, line numbers left out.
    pub words: Vec<Word>,
    /// The comments without brackets or semicolon, trimmed.
    pub comments: Vec<String>,
    /// What is wrong with the line.
    pub faults: Vec<Fault>,
    /// Whether the line holds a `%`.
    pub has_delimiter: bool,
    /// Whether the line holds a program number (`O100`).
    pub has_program_number: bool,
    /// Whether the line begins with `/`, which lets the operator skip it.
    pub is_deletable: bool,
    /// Length in characters without comments and blanks, as a controller counts it.
    pub code_length: usize,
}

impl Block {
    /// Whether the line holds anything but comments and `%`.
    pub fn has_code(&self) -> bool {
        let is_text = |f: &Fault| matches!(f, Fault::BadNumber(_) | Fault::Unknown(_));
        !self.words.is_empty() || self.has_program_number || self.faults.iter().any(is_text)
    }

    /// Takes `line`, a line without its end, apart.
    pub fn parse(line: &str) -> Block {
        let mut block = Block::default();
        let code = line.trim_start();
        let code = match code.strip_prefix('/') {
            Some(rest) => {
                block.is_deletable = true;
                rest
            }
            None => code,
        };
        let outline = Outline::of(code);
        block.code_length = usize::from(block.is_deletable) + outline.length;
        if outline.longest_command > MAX_COMMAND_DIGITS {
            block.faults.push(Fault::BadNumber(code.trim_end().to_owned()));
            return block;
        }
        let mut commands = 0;
        gcode::core::parse(code, &mut Visitor { code, block: &mut block, commands: &mut commands });
        // The crate drops a command whose number it cannot read (`G5.25`) through a callback that cannot be named from
        // outside; counting finds it out.
        if commands != outline.commands && block.faults.is_empty() {
            block.faults.push(Fault::BadNumber(code.trim_end().to_owned()));
        }
        block
    }

    /// The number of the first word with `letter`.
    pub fn value(&self, letter: char) -> Option<f64> {
        self.words.iter().find(|w| w.letter == letter).map(|w| w.value)
    }
}

/// What counting characters tells of a line.
#[derive(Default)]
struct Outline {
    /// Characters outside of comments and blanks.
    length: usize,
    /// Letters G, M and T outside of comments.
    commands: usize,
    /// The most digits that follow such a letter.
    longest_command: usize,
}

impl Outline {
    fn of(code: &str) -> Outline {
        let mut outline = Outline::default();
        let mut in_brackets = false;
        let mut digits_of_command = None;
        for c in code.chars() {
            match c {
                '(' => in_brackets = true,
                ')' => in_brackets = false,
                ';' if !in_brackets => break,
                _ if in_brackets || c.is_whitespace() => {}
                _ => {
                    outline.length += 1;
                    match c.to_ascii_uppercase() {
                        'G' | 'M' | 'T' => {
                            outline.commands += 1;
                            digits_of_command = Some(0);
                        }
                        '0'..='9' => {
                            if let Some(digits) = &mut digits_of_command {
                                *digits += 1;
                                outline.longest_command = outline.longest_command.max(*digits);
                            }
                        }
                        _ => digits_of_command = None,
                    }
                }
            }
        }
        outline
    }
}

/// The visitor that `gcode` drives along one line.
struct Visitor<'a> {
    code: &'a str,
    block: &'a mut Block,
    commands: &'a mut usize,
}

impl Visitor<'_> {
    fn reborrow(&mut self) -> Visitor<'_> {
        Visitor { code: self.code, block: self.block, commands: self.commands }
    }

    /// Takes the word whose letter stands at `start`; blanks may stand before and in the number.
    fn word_at(&mut self, start: usize) {
        let text = self.code.get(start..).unwrap_or("");
        let Some(letter) = text.chars().next() else { return };
        let number: String = text
            .chars()
            .skip(1)
            .filter(|c| !c.is_whitespace())
            .take_while(|c| matches!(c, '0'..='9' | '.' | '+' | '-'))
            .collect();
        match number.parse::<f64>() {
            Ok(value) if value.is_finite() => {
                self.block.words.push(Word { letter: letter.to_ascii_uppercase(), value });
            }
            _ => self.block.faults.push(Fault::BadNumber(format!("{letter}{number}"))),
        }
    }
}

impl Diagnostics for Visitor<'_> {
    fn emit_unknown_content(&mut self, text: &str, _span: Span) {
        self.block.faults.push(Fault::Unknown(text.to_owned()));
    }

    fn emit_unexpected(&mut self, actual: &str, expected: &[TokenType], _span: Span) {
        let fault = match actual {
            // A line number after a command: controllers take it anywhere.
            "N" if expected.contains(&TokenType::Letter) => return,
            "O" => Fault::Unknown(actual.to_owned()),
            _ if expected.contains(&TokenType::Number) => Fault::BadNumber(actual.to_owned()),
            _ => Fault::Unknown(actual.to_owned()),
        };
        self.block.faults.push(fault);
    }

    fn emit_parse_int_error(&mut self, value: &str, _error: std::num::ParseIntError, _span: Span) {
        self.block.faults.push(Fault::BadNumber(value.to_owned()));
    }
}

impl ProgramVisitor for Visitor<'_> {
    fn start_block(&mut self) -> ControlFlow<impl BlockVisitor + '_> {
        ControlFlow::Continue(self.reborrow())
    }
}

impl BlockVisitor for Visitor<'_> {
    fn comment(&mut self, value: &str, _span: Span) {
        let text = match value.strip_prefix('(') {
            Some(bracketed) => match bracketed.strip_suffix(')') {
                Some(inside) => {
                    if inside.contains('(') {
                        self.block.faults.push(Fault::NestedComment);
                    }
                    inside
                }
                None => {
                    // `(a (b)` leaves the outer bracket open, because the crate counts them.
                    let fault = if bracketed.contains('(') { Fault::NestedComment } else { Fault::UnclosedComment };
                    self.block.faults.push(fault);
                    bracketed
                }
            },
            None => value.trim_start_matches(';'),
        };
        self.block.comments.push(text.trim().to_owned());
    }

    fn program_number(&mut self, _number: u32, _span: Span) {
        self.block.has_program_number = true;
    }

    fn program_delimiter(&mut self, _span: Span) {
        self.block.has_delimiter = true;
    }

    fn word_address(&mut self, _letter: char, _value: Value<'_>, span: Span) {
        self.word_at(span.start);
    }

    fn start_general_code(&mut self, _number: Number) -> ControlFlow<impl CommandVisitor + '_> {
        ControlFlow::Continue(self.reborrow())
    }

    fn start_miscellaneous_code(&mut self, _number: Number) -> ControlFlow<impl CommandVisitor + '_> {
        ControlFlow::Continue(self.reborrow())
    }

    fn start_tool_change_code(&mut self, _number: Number) -> ControlFlow<impl CommandVisitor + '_> {
        ControlFlow::Continue(self.reborrow())
    }
}

impl CommandVisitor for Visitor<'_> {
    fn argument(&mut self, _letter: char, _value: Value<'_>, span: Span) {
        self.word_at(span.start);
    }

    fn end_command(mut self, span: Span) {
        *self.commands += 1;
        self.word_at(span.start);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> String {
        let mut words = Block::parse(line).words;
        words.sort_by_key(|w| w.letter);
        words.iter().map(|w| format!("{}{} ", w.letter, w.value)).collect::<String>().trim_end().to_owned()
    }

    #[test]
    fn words_keep_all_their_digits() {
        assert_eq!(words("g1 x1234.56789012 Y-.5f 600"), "F600 G1 X1234.56789012 Y-0.5");
        assert_eq!(words("N10G03X1Y2I-0.5J.25"), "G3 I-0.5 J0.25 X1 Y2");
        assert_eq!(words("G90.1 G5.2 M3 S10000 T2"), "G90.1 G5.2 M3 S10000 T2");
        assert_eq!(words("X - 5 (a comment; with X7) Y+3 ; X8"), "X-5 Y3");
    }

    #[test]
    fn comments_and_marks_are_told_apart() {
        let block = Block::parse("/N5 G0 X1 (first) (second) ; third");
        assert!(block.is_deletable && block.faults.is_empty());
        assert_eq!(block.comments, ["first", "second", "third"]);
        assert_eq!(block.code_length, "/N5G0X1".len());
        assert!(Block::parse("%").has_delimiter);
        assert!(Block::parse("O100").has_program_number);
    }

    #[test]
    fn what_is_no_word_is_a_fault() {
        for (line, expected) in [
            ("G1 X", Fault::BadNumber("X".into())),
            ("G1 Xnan", Fault::BadNumber("X".into())),
            ("G1 X1.2.3", Fault::BadNumber("X1.2.3".into())),
            ("G1 (never closed", Fault::UnclosedComment),
            ("G1 (a (b) c) X1", Fault::NestedComment),
            ("G1 (a (b) X1", Fault::NestedComment),
            ("G38.25 X1", Fault::BadNumber("G38.25 X1".into())),
            ("G99999999999 X1", Fault::BadNumber("G99999999999 X1".into())),
            ("G1 X#1", Fault::BadNumber("X".into())),
            ("G1 X1 $", Fault::Unknown("$".into())),
        ] {
            let faults = Block::parse(line).faults;
            assert!(faults.contains(&expected), "{line}: {faults:?}");
        }
    }
}
