//! Work on several threads with the results of one: in the order of the items, whatever thread did which.

use std::sync::atomic::{AtomicUsize, Ordering};

/// As many threads as the machine runs at once.
pub(crate) fn available() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

/// What `here` and `there` make, `there` on a thread of its own.
pub(crate) fn both<A, B: Send>(here: impl FnOnce() -> A, there: impl FnOnce() -> B + Send) -> (A, B) {
    std::thread::scope(|scope| {
        let other = scope.spawn(there);
        let mine = here();
        match other.join() {
            Ok(theirs) => (mine, theirs),
            Err(panic) => std::panic::resume_unwind(panic),
        }
    })
}

/// A list of short work is cut into so many pieces: small ones against the whole, that an expensive corner does not hold one
/// thread up alone.
const PIECES: usize = 64;

/// Pieces of short work have no fewer items: starting a thread takes as long as some of them.
const LEAST_PIECE: usize = 128;

/// `f`, which is short work, of every item.
pub(crate) fn map<T: Sync, R: Send>(items: &[T], threads: usize, f: impl Fn(&T) -> R + Sync) -> Vec<R> {
    map_pieces(items, (items.len() / PIECES).max(LEAST_PIECE), threads, f)
}

/// `f`, which is long work, of every item.
pub(crate) fn map_long<T: Sync, R: Send>(items: &[T], threads: usize, f: impl Fn(&T) -> R + Sync) -> Vec<R> {
    map_pieces(items, 1, threads, f)
}

fn map_pieces<T: Sync, R: Send>(items: &[T], piece: usize, threads: usize, f: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let pieces: Vec<&[T]> = items.chunks(piece).collect();
    if threads < 2 || pieces.len() < 2 {
        return items.iter().map(f).collect();
    }
    let next = AtomicUsize::new(0);
    let run = || {
        let mut done = Vec::new();
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            let Some(piece) = pieces.get(k) else { return done };
            done.push((k, piece.iter().map(&f).collect::<Vec<R>>()));
        }
    };
    let mut done = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads.min(pieces.len())).map(|_| scope.spawn(run)).collect();
        let mut done = run();
        for other in others {
            match other.join() {
                Ok(more) => done.extend(more),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        done
    });
    done.sort_unstable_by_key(|(k, _)| *k);
    done.into_iter().flat_map(|(_, results)| results).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_the_order_of_the_items() {
        for count in [0, 1, 63, 64, 65, 5000, 100_001] {
            let items: Vec<u32> = (0..count).collect();
            let twice: Vec<u32> = items.iter().map(|x| x * 2).collect();
            for threads in [0, 1, 2, 3] {
                assert_eq!(map(&items, threads, |x| x * 2), twice);
                assert_eq!(map_pieces(&items, 63, threads, |x| x * 2), twice);
            }
            if count < 100 {
                assert_eq!(map_long(&items, 2, |x| x * 2), twice);
            }
        }
        assert_eq!(both(|| 1, || 2), (1, 2));
    }

    #[test]
    fn a_panic_of_any_thread_is_that_of_the_caller() {
        let panics = |f: &(dyn Fn() + std::panic::RefUnwindSafe)| std::panic::catch_unwind(f).is_err();
        assert!(panics(&|| _ = map_long(&[1, 2, 3], 2, |x| assert!(*x != 2))));
        assert!(panics(&|| _ = both(|| (), || panic!("there"))));
    }
}
