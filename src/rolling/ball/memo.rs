//! Answers that are remembered: from round to round most of the surface stays as it was, and the same is asked again.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Mutex, PoisonError};

/// A table of fixed size of questions with their answers, in which what comes later takes the place of what was there. An answer
/// depends on its question alone, so it does not matter what is in the table, or who put it there.
#[derive(Debug)]
pub(super) struct Memo<Q, A> {
    places: Vec<Mutex<Option<(Q, A)>>>,
}

impl<Q, A> Memo<Q, A> {
    /// An empty one with so many places.
    pub fn new(places: usize) -> Memo<Q, A> {
        Memo { places: (0..places).map(|_| Mutex::new(None)).collect() }
    }
}

impl<Q, A> Clone for Memo<Q, A> {
    /// An empty one of the same size.
    fn clone(&self) -> Memo<Q, A> {
        Memo::new(self.places.len())
    }
}

impl<Q: Hash + Eq, A: Clone> Memo<Q, A> {
    /// The answer to a question: the one that is known, or what `find` finds.
    pub fn get_or(&self, question: Q, find: impl FnOnce() -> A) -> A {
        let mut hasher = DefaultHasher::new();
        question.hash(&mut hasher);
        let Some(place) = hasher.finish().checked_rem(self.places.len() as u64) else { return find() };
        let place = &self.places[place as usize];
        // Nothing that could panic is done while a place is held.
        let known = match &*place.lock().unwrap_or_else(PoisonError::into_inner) {
            Some((known, answer)) if *known == question => Some(answer.clone()),
            _ => None,
        };
        known.unwrap_or_else(|| {
            let answer = find();
            *place.lock().unwrap_or_else(PoisonError::into_inner) = Some((question, answer.clone()));
            answer
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_known_is_not_looked_for_again_and_answers_do_not_depend_on_the_size_of_the_table() {
        for places in [0, 1, 7, 1000] {
            let memo = Memo::new(places);
            let mut looked = 0;
            for question in [3u64, 3, 5, 3, 8, 5, 3] {
                let answer = memo.get_or(question, || {
                    looked += 1;
                    question * question
                });
                assert_eq!(answer, question * question);
            }
            let expected = match places {
                0 => 7..=7,
                1 => 6..=6,
                1000 => 3..=4,
                _ => 3..=6,
            };
            assert!(expected.contains(&looked), "{places} places, {looked}");
        }
    }
}
