//! Does the same work on many items, on all processors, until it is interrupted.

use crate::interrupt;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;

/// The results of `work` for all items, in their order. `None` for items whose work had not ended when Ctrl-C was
/// pressed. `progress` is called with the number of finished items.
pub fn map<T: Sync, R: Send>(
    items: &[T],
    work: impl Fn(&T) -> R + Sync,
    progress: &mut dyn FnMut(usize),
) -> Vec<Option<R>> {
    let next = AtomicUsize::new(0);
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    let mut results: Vec<Option<R>> = items.iter().map(|_| None).collect();
    let (tell, hear) = channel();
    std::thread::scope(|scope| {
        for _ in 0..workers.min(items.len()) {
            let (tell, next, work) = (tell.clone(), &next, &work);
            scope.spawn(move || {
                while !interrupt::asked() {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(item) = items.get(index) else { return };
                    let result = work(item);
                    // the result of interrupted work is not used; the receiver is gone only if the caller has ended
                    // early
                    if interrupt::asked() || tell.send((index, result)).is_err() {
                        return;
                    }
                }
            });
        }
        drop(tell);
        for (done, (index, result)) in hear.iter().enumerate() {
            results[index] = Some(result);
            progress(done + 1);
        }
    });
    results
}
