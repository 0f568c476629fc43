//! Lines of a job file.

use std::ops::Range;

/// Finds the lines of a text.
#[derive(Clone, Debug, Default)]
pub struct Locator {
    text: String,
}

impl Locator {
    pub(super) fn new(text: &str) -> Locator {
        Locator { text: text.to_owned() }
    }

    /// The line of a place, counted from 1.
    pub(super) fn line(&self, at: usize) -> usize {
        1 + self.text.bytes().take(at).filter(|b| *b == b'\n').count()
    }

    /// The line of `key` in the table that has this range; where it starts if the key is not found.
    pub(super) fn line_of(&self, table: &Range<usize>, key: &str) -> usize {
        let first = self.line(table.start);
        let lines = self.text.lines().enumerate().skip(first - 1);
        for (k, line) in lines {
            let line = line.trim_start();
            // The next table of any name, unless it is the header of this one.
            if k + 1 > first && line.starts_with("[[") {
                break;
            }
            let is_key = |at: usize| {
                let before = line[..at].chars().next_back();
                let after = line[at + key.len()..].trim_start();
                before.is_none_or(|c| !(c.is_alphanumeric() || c == '-' || c == '_')) && after.starts_with(['=', ']'])
            };
            let code = line.split('#').next().unwrap_or_default();
            if code.match_indices(key).any(|(at, _)| is_key(at)) {
                return k + 1;
            }
        }
        first
    }

    /// The line of the header `[name]`, or of the dotted key; 0 where there is none.
    pub(super) fn line_in(&self, table: &str, key: &str) -> usize {
        let header = format!("[{table}]");
        let Some(at) = self.text.lines().position(|line| line.trim_start().starts_with(&header)) else { return 0 };
        let start: usize = self.text.split_inclusive('\n').take(at).map(str::len).sum();
        self.line_of(&(start..start), key)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_found_in_their_own_table() {
        let text = "version = 1\n[stock]\ntop = 1 # feed = 3\n[[tool]]\nfeed = 2\n[[tool]]\nname = \"x\"\nfeed = 3\n\
                    tabs = { width = 3 }\n";
        let locator = Locator::new(text);
        let second = text.rfind("[[tool]]").unwrap();
        assert_eq!(locator.line_of(&(second..second), "feed"), 8);
        assert_eq!(locator.line_of(&(second..second), "width"), 9);
        assert_eq!(locator.line_of(&(second..second), "diameter"), 6);
        assert_eq!(locator.line_in("stock", "top"), 3);
        assert_eq!(locator.line_in("machine", "top"), 0);
    }
}
