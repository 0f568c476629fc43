//! What is wrong with the text of a line, whatever it would do.

use std::collections::BTreeSet;

use super::super::block::{Block, Fault};
use super::super::codes;
use super::super::rules::Rule;
use super::Interpreter;
use crate::units::Brief;

/// Most characters of a line for GRBL, without comments and blanks: its buffer of 80 holds an end mark.
const GRBL_LINE: usize = 79;

/// Most characters of a line for LinuxCNC, comments and blanks included; measured.
const LINUXCNC_LINE: usize = 252;

/// Findings quote no more characters than this.
const LONGEST_QUOTE: usize = 40;

/// The beginning of `text`.
fn excerpt(text: &str) -> String {
    match text.char_indices().nth(LONGEST_QUOTE) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

impl Interpreter {
    pub(super) fn check_text(&mut self, line: &str, block: &Block) {
        if block.code_length > GRBL_LINE {
            self.find(Rule::LineTooLong, format!("{} characters", block.code_length));
        }
        if line.len() > LINUXCNC_LINE {
            self.find(Rule::LineTooLongLinuxcnc, format!("{} characters", line.len()));
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
        for fault in &block.faults {
            match fault {
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
        let mut seen = 0u32;
        let mut groups = BTreeSet::new();
        for word in &block.words {
            let tenths = codes::tenths(word.value);
            match word.letter {
                'G' | 'M' => {
                    let is_g = word.letter == 'G';
                    let text = format!("{}{}", word.letter, Brief(word.value));
                    match tenths.map(|t| codes::support(is_g, t)) {
                        None | Some(codes::Support::Nowhere) => self.find(Rule::UnknownCode, &text),
                        Some(codes::Support::LinuxcncOnly) => {
                            let rule = if (is_g, tenths) == (false, Some(60)) {
                                Rule::ToolChange
                            } else {
                                Rule::GrblUnsupported
                            };
                            self.find(rule, &text);
                        }
                        Some(codes::Support::Both) => {}
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
                        'A' | 'B' | 'C' | 'D' | 'H' | 'Q' | 'U' | 'V' | 'W' => self.find(Rule::GrblUnsupported, letter),
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
