//! The word that was probably meant.

/// Of `words` the one with the fewest changes of letters from `word`, the first of equals; none where all of them are
/// other words altogether.
pub fn nearest<'w>(word: &str, words: impl Iterator<Item = &'w str>) -> Option<&'w str> {
    let letters: Vec<char> = word.chars().collect();
    let rated = words.map(|other| (changes(&letters, other), other));
    let (changes, found) = rated.reduce(|a, b| if b.0 < a.0 { b } else { a })?;
    // Words that have no letter in common are as many changes apart as the longer one has letters.
    (changes < letters.len().max(found.chars().count())).then_some(found)
}

/// How many letters have to be put in, taken out or exchanged to make one word of the other (Levenshtein).
fn changes(word: &[char], other: &str) -> usize {
    let mut row: Vec<usize> = (0..=word.len()).collect();
    for (i, letter) in other.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, own) in word.iter().enumerate() {
            let exchanged = diagonal + usize::from(*own != letter);
            diagonal = row[j + 1];
            row[j + 1] = exchanged.min(diagonal + 1).min(row[j] + 1);
        }
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
            [("part-a", Some("part-A")), ("plat", Some("plate")), ("A-part", Some("part-A")), ("x", None)]
        {
            assert_eq!(nearest(typed, words.into_iter()), meant, "{typed}");
        }
        assert_eq!(nearest("a", std::iter::empty()), None);
    }

    #[test]
    fn changes_are_counted() {
        let count = |a: &str, b| changes(&a.chars().collect::<Vec<_>>(), b);
        assert_eq!((count("kitten", "sitting"), count("", "abc"), count("abc", "")), (3, 3, 3));
    }
}
