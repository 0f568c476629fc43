//! The word that was probably meant.

/// A slip of the keyboard changes at most this share of the letters of a name; a name is not offered beyond it.
const LARGEST_SLIP: f64 = 0.4;

/// Of `words` the one with the fewest changes of letters from `word`, the first of equals; none where all of them are
/// other words.
pub fn nearest<'w>(word: &str, words: impl Iterator<Item = &'w str>) -> Option<&'w str> {
    let letters: Vec<char> = word.chars().collect();
    let rated = words.map(|other| (changes(&letters, other), other));
    let (changes, found) = rated.reduce(|a, b| if b.0 < a.0 { b } else { a })?;
    (changes as f64 <= LARGEST_SLIP * letters.len().max(found.chars().count()) as f64).then_some(found)
}

/// The name of `names` that is nearest to what was `typed`, in any case; `None` where none is near. Of equally near ones
/// the first.
pub fn nearest_name<'a>(typed: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let typed: Vec<char> = typed.trim().to_lowercase().chars().collect();
    let mut best: Option<(usize, &str)> = None;
    for name in names {
        let distance = changes(&typed, &name.to_lowercase());
        if best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, name));
        }
    }
    let (distance, name) = best?;
    let longest = typed.len().max(name.chars().count());
    (distance as f64 <= LARGEST_SLIP * longest as f64).then_some(name)
}

/// How many letters have to be put in, taken out, exchanged or swapped with their neighbour to make one word of the other
/// (Levenshtein; optimal string alignment).
fn changes(word: &[char], other: &str) -> usize {
    let other: Vec<char> = other.chars().collect();
    let mut before: Vec<usize> = Vec::new();
    let mut row: Vec<usize> = (0..=word.len()).collect();
    for (i, letter) in other.iter().enumerate() {
        let mut next = vec![i + 1];
        for (j, own) in word.iter().enumerate() {
            let exchanged = row[j] + usize::from(own != letter);
            let mut least = exchanged.min(row[j + 1] + 1).min(next[j] + 1);
            if i > 0 && j > 0 && *own == other[i - 1] && word[j - 1] == *letter {
                least = least.min(before[j - 1] + 1);
            }
            next.push(least);
        }
        before = std::mem::replace(&mut row, next);
    }
    row[word.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_word_is_found() {
        let words = ["plate", "part-A", "part-B"];
        for (typed, meant) in
            [("part-a", Some("part-A")), ("plat", Some("plate")), ("patr-A", Some("part-A")), ("x", None)]
        {
            assert_eq!(nearest(typed, words.into_iter()), meant, "{typed}");
        }
        assert_eq!(nearest("a", std::iter::empty()), None);
    }

    #[test]
    fn changes_are_counted() {
        let count = |a: &str, b| changes(&a.chars().collect::<Vec<_>>(), b);
        assert_eq!((count("kitten", "sitting"), count("", "abc"), count("abc", "")), (3, 3, 3));
        assert_eq!((count("loewr", "lower"), count("ab", "ba"), count("abc", "cab")), (1, 1, 2));
    }

    #[test]
    fn a_slip_is_understood_and_a_stranger_is_not() {
        let names = ["grbl", "linuxcnc", "mach3"];
        assert_eq!(nearest_name("gbrl", names), Some("grbl"));
        assert_eq!(nearest_name("Linux-CNC", names), Some("linuxcnc"));
        assert_eq!(nearest_name("mach4", names), Some("mach3"));
        assert_eq!(nearest_name("heidenhain", names), None);
        for (typed, other) in [("wcs", "arcs"), ("below", "tool")] {
            assert_eq!((nearest_name(typed, [other]), nearest(typed, [other].into_iter())), (None, None));
        }
        assert_eq!(nearest_name("", names), None);
        assert_eq!(nearest_name("grbl", []), None);
    }
}
