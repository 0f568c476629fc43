//! What the header of a program written by clopen says.

use super::block::Block;

/// How many lines of a program are its header at most.
const HEADER_LINES: usize = 40;

/// The comments of the header of a program written by clopen, from the one that says so on; none of other programs.
pub(super) fn comments(text: &str) -> impl Iterator<Item = String> + '_ {
    let blocks = text.lines().take(HEADER_LINES).map(Block::parse);
    blocks.flat_map(|b| b.comments).skip_while(|c| !c.starts_with("clopen "))
}

/// The stock that a program was made for, in millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeaderStock {
    /// Its thickness, where it is known.
    pub thickness: Option<f64>,
    /// z of its top.
    pub top: f64,
}

impl HeaderStock {
    /// What the header of `text` says; `None` where it does not, as in programs of others.
    pub fn of(text: &str) -> Option<HeaderStock> {
        comments(text).find_map(|comment| {
            let top = ["stock top at ", "stock top ", ", top at "].iter().find_map(|key| number(&comment, key))?;
            Some(HeaderStock { thickness: number(&comment, "stock ").filter(|t| *t > 0.0), top })
        })
    }
}

impl std::fmt::Display for HeaderStock {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.thickness {
            Some(thickness) => write!(f, "stock {thickness} mm thick, top at {} mm", self.top),
            None => write!(f, "stock top at {} mm", self.top),
        }
    }
}

/// The number of millimetres behind `key`.
fn number(comment: &str, key: &str) -> Option<f64> {
    let behind = &comment[comment.find(key)? + key.len()..];
    let number: f64 = behind.split(" mm").next()?.parse().ok()?;
    number.is_finite().then_some(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        for stock in [
            HeaderStock { thickness: Some(6.35), top: 6.0 },
            HeaderStock { thickness: None, top: -1.5 },
            HeaderStock { thickness: Some(3.0), top: 0.0 },
        ] {
            assert_eq!(HeaderStock::of(&format!("%\n(clopen 0.1.0)\n(drawing a)\n({stock})\nG21\n")), Some(stock));
            assert_eq!(HeaderStock::of(&format!("({stock})\nG21\n")), None, "no program of clopen");
        }
        let single = "(clopen 0.1.0)\n(safe height 5 mm, stock top 2 mm)\n";
        assert_eq!(HeaderStock::of(single), Some(HeaderStock { thickness: None, top: 2.0 }));
        assert_eq!(HeaderStock::of("(clopen 0.1.0)\n(dialect grbl)\n"), None);
    }
}
