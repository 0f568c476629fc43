//! Sets of G and M codes.

use std::collections::BTreeSet;

use super::super::codes;

/// The codes that a controller understands. In a file they are a list of codes and of runs of them: `["G0-G3", "G38.2"]`. A
/// run counts in whole numbers, or in tenths where it begins with a tenth.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Deserialize)]
#[serde(try_from = "Vec<String>")]
pub struct CodeSet {
    /// Whether it is a G code, and its number in tenths.
    codes: BTreeSet<(bool, u32)>,
}

/// A text that is no code and no run of codes.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("codes: \"{0}\" is neither a code (\"G38.2\") nor a run of codes (\"G0-G3\")")]
pub struct InvalidCode(String);

impl CodeSet {
    /// Whether the code of this number, in tenths, is in the set.
    pub(in crate::gcode) fn contains(&self, is_g: bool, tenths: u32) -> bool {
        self.codes.contains(&(is_g, tenths))
    }
}

fn code(text: &str) -> Option<(bool, u32)> {
    let (letter, number) = text.split_at_checked(1)?;
    let is_g = match letter {
        "G" => true,
        "M" => false,
        _ => return None,
    };
    Some((is_g, codes::tenths(number.parse().ok()?)?))
}

impl TryFrom<Vec<String>> for CodeSet {
    type Error = InvalidCode;

    fn try_from(texts: Vec<String>) -> Result<CodeSet, InvalidCode> {
        let mut set = CodeSet::default();
        for text in texts {
            let (first, last) = text.split_once('-').unwrap_or((&text, &text));
            match (code(first), code(last)) {
                (Some((is_g, a)), Some((other, b))) if is_g == other && a <= b => {
                    let step = if a % 10 == 0 { 10 } else { 1 };
                    set.codes.extend((a..=b).step_by(step).map(|tenths| (is_g, tenths)));
                }
                _ => return Err(InvalidCode(text)),
            }
        }
        Ok(set)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(texts: &[&str]) -> Result<CodeSet, InvalidCode> {
        texts.iter().map(|t| (*t).to_owned()).collect::<Vec<_>>().try_into()
    }

    #[test]
    fn runs_count_in_whole_numbers_or_in_tenths() {
        let codes = set(&["G0-G3", "G38.2-G38.5", "M30"]).unwrap();
        for (is_g, tenths) in [(true, 0), (true, 10), (true, 30), (true, 382), (true, 384), (true, 385), (false, 300)] {
            assert!(codes.contains(is_g, tenths), "{is_g} {tenths}");
        }
        for (is_g, tenths) in [(true, 1), (true, 40), (true, 380), (true, 390), (false, 0), (true, 300)] {
            assert!(!codes.contains(is_g, tenths), "{is_g} {tenths}");
        }
    }

    #[test]
    fn what_is_no_code_is_named() {
        for text in ["", "G", "X1", "G1-M3", "G3-G1", "G1.25", "G-1", "G1-", "Gnan"] {
            assert_eq!(set(&["G0", text]), Err(InvalidCode(text.to_owned())));
        }
    }
}
