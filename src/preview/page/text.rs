//! Text that stands in a page as text.

/// `text` with what HTML takes for markup written as entities, in elements and in attributes between quotes.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // No HTML may hold these, not even as entities.
            c if c.is_control() && !c.is_whitespace() => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// `text` as a JSON string that can stand in a script: nothing in it ends or opens an element.
pub(super) fn quoted(text: &str) -> String {
    let json = serde_json::Value::from(text).to_string();
    json.replace('<', "\\u003c").replace('>', "\\u003e").replace('\u{2028}', "\\u2028").replace('\u{2029}', "\\u2029")
}

/// A number with at most so many decimals, without idle zeros, as JSON and paths take it; 0 where it is none.
pub(super) fn number(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "0".to_owned();
    }
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Seconds as people say them.
pub(super) fn duration(seconds: f64) -> String {
    if !seconds.is_finite() || seconds < 59.95 {
        return format!("{seconds:.1} s");
    }
    let whole = seconds.round() as u64;
    match whole / 3600 {
        0 => format!("{} min {:02} s", whole / 60, whole % 60),
        hours => format!("{hours} h {:02} min", whole / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_becomes_markup() {
        assert_eq!(
            escaped("</script><b>\"Q&A\" 'x'\0"),
            "&lt;/script&gt;&lt;b&gt;&quot;Q&amp;A&quot; &#39;x&#39;\u{fffd}"
        );
        let json = quoted("</script><!-- \" \u{2028}\\");
        assert_eq!(json, "\"\\u003c/script\\u003e\\u003c!-- \\\" \\u2028\\\\\"");
        assert_eq!(serde_json::from_str::<String>(&json).unwrap(), "</script><!-- \" \u{2028}\\");
    }

    #[test]
    fn numbers_and_durations_are_short() {
        assert_eq!(
            [1.5, 100.0, -0.00001, f64::NAN, 0.12345].map(|x| number(x, 4)),
            ["1.5", "100", "0", "0", "0.1235"].map(str::to_owned)
        );
        assert_eq!(number(100.0, 0), "100");
        assert_eq!([5.04, 59.97, 200.4, 7322.0].map(duration), ["5.0 s", "1 min 00 s", "3 min 20 s", "2 h 02 min"]);
    }
}
