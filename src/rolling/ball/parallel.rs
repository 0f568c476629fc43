//! One function on many items, on several threads, with the results in order whatever the threads.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Items that a thread takes at once.
const CHUNK: usize = 128;

/// `f` of every item, in the order of the items.
pub(super) fn map<T: Sync, R: Send>(items: &[T], threads: usize, f: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let chunks = items.len().div_ceil(CHUNK);
    if threads < 2 || chunks < 2 {
        return items.iter().map(f).collect();
    }
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::with_capacity(chunks));
    std::thread::scope(|scope| {
        for _ in 0..threads.min(chunks) {
            scope.spawn(|| {
                loop {
                    let k = next.fetch_add(1, Ordering::Relaxed);
                    let Some(chunk) = items.chunks(CHUNK).nth(k) else { break };
                    let results: Vec<R> = chunk.iter().map(&f).collect();
                    done.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((k, results));
                }
            });
        }
    });
    let mut done = done.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    done.sort_by_key(|(k, _)| *k);
    done.into_iter().flat_map(|(_, results)| results).collect()
}
