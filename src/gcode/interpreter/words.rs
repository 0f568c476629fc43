//! What is wrong with the text of a line, whatever it would do.

use std::collections::BTreeSet;

use super::super::block::{Block, Fault};
use super::super::codes;
use super::super::rules::Rule;
use super::Interpreter;
use crate::units::Brief;

/// Findings quote no more characters than this.
const LONGEST_QUOTE: usize = 40;

/// The beginning of `text`.
fn excerpt(text: &str) -> String {
    match text.char_indices().nth(LONGEST_QUOTE) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

impl Interpreter<'_> {
    pub(super) fn check_text(&mut self, line: &str, block: &Block) {
        let dialect = self.dialect();
        let code_limit = dialect.refused_code_length.filter(|most| block.code_length > *most);
        if let Some(most) = code_limit {
            let length = block.code_length;
            self.find(Rule::LineTooLong, format!("{length} without comments and blanks, {most} are taken"));
        }
        if let Some(most) = dialect.refused_line_length.filter(|most| line.len() > *most && code_limit.is_none()) {
            self.find(Rule::LineTooLong, format!("{}, {most} are taken", line.len()));
        }
        if block.has_delimiter {
            self.find_once(Rule::PercentSign, "");
        }
        if block.has_program_number {
            self.find_once(Rule::ProgramNumber, "");
        }
        if block.is_deletable {
            self.find_once(Rule::BlockDelete, "");
        }
        let is_expression = |text: &str| text.contains(['#', '[', ']', '=']);
        let code = line.split(['(', ';']).next().unwrap_or("");
        let is_flow = code.trim_start().starts_with(['o', 'O']);
        for fault in &block.faults {
            match fault {
                // Flow control is a word O with something behind its number.
                Fault::BadNumber(_) | Fault::Unknown(_) if dialect.expressions && (is_expression(code) || is_flow) => {
                    self.find(Rule::NotFollowed, excerpt(code.trim()));
                    break;
                }
                Fault::BadNumber(_) | Fault::Unknown(_) if is_expression(code) => {
                    self.find(Rule::Expression, excerpt(code.trim()));
                    break;
                }
                Fault::BadNumber(text) => self.find(Rule::BadNumber, excerpt(text)),
                Fault::Unknown(text) => self.find(Rule::UnknownText, excerpt(text)),
                Fault::UnclosedComment => self.find(Rule::UnclosedComment, ""),
                Fault::NestedComment => self.find(Rule::NestedComment, ""),
            }
        }
    }

    pub(super) fn check_words(&mut self, block: &Block) {
        let dialect = self.dialect();
        let mut seen = 0u32;
        let mut commands = 0;
        let mut groups = BTreeSet::new();
        for word in &block.words {
            let tenths = codes::tenths(word.value);
            match word.letter {
                'G' | 'M' => {
                    let is_g = word.letter == 'G';
                    let text = format!("{}{}", word.letter, Brief(word.value));
                    match tenths {
                        Some(t) if dialect.codes.contains(is_g, t) => {}
                        Some(60) if !is_g => self.find(Rule::ToolChange, &text),
                        Some(t) if codes::is_known(is_g, t) => self.find(Rule::UnsupportedCode, &text),
                        _ => self.find(Rule::UnknownCode, &text),
                    }
                    commands += 1;
                    if dialect.one_code_a_line && commands > 1 {
                        self.find(Rule::SeveralCodes, &text);
                    }
                    if let Some(group) = tenths.and_then(|t| codes::group(is_g, t))
                        && !groups.insert(group)
                    {
                        self.find(Rule::ConflictingCodes, &text);
                    }
                }
                letter => {
                    let bit = 1u32 << (u32::from(letter).wrapping_sub(u32::from('A')) % 32);
                    if seen & bit != 0 {
                        self.find(Rule::DuplicateWord, letter);
                    }
                    seen |= bit;
                    match letter {
                        'E' => self.find(Rule::Exponent, format!("E{}", Brief(word.value))),
                        letter if !dialect.knows_letter(letter) => self.find(Rule::UnsupportedCode, letter),
                        'F' | 'S' | 'T' | 'P' if word.value < 0.0 => {
                            self.find(Rule::NegativeValue, format!("{letter}{}", Brief(word.value)));
                        }
                        _ => {}
                    }
                }
            }
        }
    }
}
