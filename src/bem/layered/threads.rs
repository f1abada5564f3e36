//! Work on several threads, with results that do not depend on their number.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::error::{Error, Result};

/// Number of threads: of all processors with the feature `rayon`, otherwise one.
pub(in crate::bem) fn threads() -> usize {
    #[cfg(feature = "rayon")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "rayon"))]
    1
}

/// Calls `work` once for each item, on `threads` threads with a workspace each.
///
/// `after` is called on this thread, with the number of items done so far; its error stops all threads.
///
/// # Errors
/// The first error in the order of the items.
pub(in crate::bem) fn on_threads<T: Send, W: Default>(
    threads: usize,
    items: impl Iterator<Item = T> + Send,
    work: impl Fn(&mut W, T) -> Result<()> + Sync,
    mut after: impl FnMut(usize) -> Result<()>,
) -> Result<()> {
    let queue = Mutex::new(items.enumerate());
    let done = AtomicUsize::new(0);
    let stopped = AtomicBool::new(false);
    let work_off_queue = |after: &mut dyn FnMut(usize) -> Result<()>| {
        let mut workspace = W::default();
        while !stopped.load(Ordering::Relaxed) {
            // If a thread panics, its queue stays valid.
            let next = queue.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((number, item)) = next else { break };
            work(&mut workspace, item).map_err(|error| (number, error))?;
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            after(done).map_err(|error| (number, error))?;
        }
        Ok(())
    };
    // Separate threads instead of a pool: a waiting worker of a pool may start other work, which may wait for the
    // results of these threads.
    let mut failures: Vec<(usize, Error)> = std::thread::scope(|scope| {
        let others: Vec<_> =
            (1..threads).map(|_| scope.spawn(|| work_off_queue(&mut |_| Ok(())))).collect();
        let outcome = work_off_queue(&mut after);
        stopped.store(outcome.is_err(), Ordering::Relaxed);
        let mut failures: Vec<_> = outcome.err().into_iter().collect();
        for thread in others {
            match thread.join() {
                Ok(outcome) => failures.extend(outcome.err()),
                // A user's damping law may panic; the panic is passed on.
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        failures
    });
    failures.sort_by_key(|(number, _)| *number);
    failures.into_iter().next().map_or(Ok(()), |(_, error)| Err(error))
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::error::positive;

    /// Each item is done once; the error is of the first item that fails, whichever thread ends first.
    #[test]
    fn threads_do_all_items_or_return_the_first_error() {
        for threads in [1, 2, 5] {
            let mut squares = vec![0; 100];
            let calls = AtomicUsize::new(0);
            let mut last = 0;
            on_threads(
                threads,
                (0..100).zip(&mut squares),
                |(): &mut (), (item, square): (usize, &mut usize)| {
                    *square += item * item;
                    calls.fetch_add(1, Ordering::Relaxed);
                    Ok(())
                },
                |done| {
                    last = done;
                    Ok(())
                },
            )
            .unwrap();
            assert!(squares.iter().enumerate().all(|(item, square)| *square == item * item));
            assert!(calls.into_inner() == 100 && last <= 100);

            let found = on_threads(threads, 0..100, fail_first_item_last, |_| Ok(()));
            assert!(matches!(found, Err(Error::Input { value: -0.5, .. })), "{found:?}");
            assert!(on_threads(threads, 0..100, wait, stop_after_three).is_err());
        }
    }

    fn fail_first_item_last((): &mut (), item: usize) -> Result<()> {
        std::thread::sleep(Duration::from_millis(if item == 0 { 100 } else { 0 }));
        positive("item", -0.5 - item as f64).map(|_| ())
    }

    /// Long enough for the calling thread to do some of the items.
    #[allow(clippy::unnecessary_wraps, reason = "the type of the function that it stands for")]
    fn wait((): &mut (), _item: usize) -> Result<()> {
        std::thread::sleep(Duration::from_millis(2));
        Ok(())
    }

    fn stop_after_three(done: usize) -> Result<()> {
        positive("rest", 3.0 - done as f64).map(|_| ())
    }
}
