//! Comments that no controller takes for anything else.

use super::Dialect;

/// Words that LinuxCNC acts on at the beginning of a comment, when a comma follows.
const ACTIVE_WORDS: [&str; 8] = ["MSG", "DEBUG", "PRINT", "LOG", "LOGOPEN", "LOGAPPEND", "LOGCLOSE", "PROBEOPEN"];

/// `text` as comment lines of the dialect, broken at spaces where it is too long.
///
/// Parentheses, line breaks and everything beyond ASCII are replaced; so are the characters that GRBL takes from the wire
/// wherever they stand (`!`, `~`, `?`) and those that mark lines for some controllers (`%`, `$`, `;`).
pub(super) fn comment_lines(text: &str, dialect: &Dialect) -> Vec<String> {
    let (open, close) = dialect.comments.marks();
    let room = dialect.longest_line.saturating_sub(open.len() + close.len()).max(1);
    let clean: String = text.chars().map(harmless).collect();
    let mut lines = Vec::new();
    let mut line = String::new();
    for word in clean.split_ascii_whitespace() {
        if !line.is_empty() && line.len() + 1 + word.len() > room {
            lines.push(std::mem::take(&mut line));
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
        while line.len() > room {
            // All ASCII: any index is a character's border.
            let rest = line.split_off(room);
            lines.push(std::mem::replace(&mut line, rest));
        }
    }
    if !line.is_empty() {
        lines.push(line);
    }
    lines.iter().map(|l| format!("{open}{}{close}", passive(l))).collect()
}

fn harmless(c: char) -> char {
    match c {
        '(' => '[',
        ')' => ']',
        '!' | '~' | '?' | '%' | '$' | ';' => '_',
        c if c.is_ascii_graphic() => c,
        c if c.is_whitespace() => ' ',
        _ => '_',
    }
}

/// The line with the comma taken from a word that LinuxCNC would act on.
fn passive(line: &str) -> String {
    let active = line.split_once(',').is_some_and(|(word, _)| {
        let word = word.trim();
        ACTIVE_WORDS.iter().any(|a| word.eq_ignore_ascii_case(a)) || word.eq_ignore_ascii_case("PY")
    });
    if active { line.replacen(',', " ", 1) } else { line.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::super::GRBL;
    use super::*;

    #[test]
    fn comments_are_plain_and_short() {
        let one = |text: &str| comment_lines(text, &GRBL).join("\n");
        assert_eq!(one("part (2) \u{2013} 50% of it!"), "(part [2] _ 50_ of it_)");
        assert_eq!(one("a\nM3 S1000"), "(a M3 S1000)");
        assert_eq!(one("msg, stop"), "(msg  stop)");
        assert_eq!(one("PRINT,#1"), "(PRINT #1)");
        assert_eq!(one("a message, stop"), "(a message, stop)");
        assert_eq!(one(""), "");
        let lines = comment_lines(&"word ".repeat(40), &GRBL);
        assert!(lines.len() > 2 && lines.iter().all(|l| l.len() <= 79));
        let long = comment_lines(&"x".repeat(200), &GRBL);
        assert_eq!(long.iter().map(|l| l.len() - 2).sum::<usize>(), 200);
        assert!(long.iter().all(|l| l.len() <= 79));
    }
}
