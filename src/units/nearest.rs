//! The name that was probably meant.

/// A slip of the keyboard changes at most this share of the letters of a name; a name is not offered beyond it.
const LARGEST_SLIP: f64 = 0.5;

/// The name of `names` that is nearest to what was `typed`, in any case; `None` where none is near. Of equally near ones
/// the first.
pub fn nearest_name<'a>(typed: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let typed = typed.trim().to_lowercase();
    let mut best: Option<(usize, &str)> = None;
    for name in names {
        let distance = edit_distance(&typed, &name.to_lowercase());
        if best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, name));
        }
    }
    let (distance, name) = best?;
    let longest = typed.chars().count().max(name.chars().count());
    (distance as f64 <= LARGEST_SLIP * longest as f64).then_some(name)
}

/// Levenshtein's distance: the fewest letters to add, take away or change that make `b` of `a`.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    // The distances from what was read of `a` to every beginning of `b`.
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, letter) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, other) in b.iter().enumerate() {
            let changed = diagonal + usize::from(letter != *other);
            diagonal = row[j + 1];
            row[j + 1] = changed.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_the_books() {
        for (a, b, distance) in
            [("", "", 0), ("", "abc", 3), ("kitten", "sitting", 3), ("flaw", "lawn", 2), ("x", "x", 0)]
        {
            assert_eq!(edit_distance(a, b), distance, "{a} {b}");
            assert_eq!(edit_distance(b, a), distance, "{b} {a}");
        }
    }

    #[test]
    fn a_slip_is_understood_and_a_stranger_is_not() {
        let names = ["grbl", "linuxcnc", "mach3"];
        assert_eq!(nearest_name("gbrl", names), Some("grbl"));
        assert_eq!(nearest_name("Linux-CNC", names), Some("linuxcnc"));
        assert_eq!(nearest_name("mach4", names), Some("mach3"));
        assert_eq!(nearest_name("heidenhain", names), None);
        assert_eq!(nearest_name("", names), None);
        assert_eq!(nearest_name("grbl", []), None);
    }
}
