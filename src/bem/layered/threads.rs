//! Computations on several threads, with results that do not depend on the number of threads.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::error::{Error, Result};

/// Number of threads: that of rayon's current pool with the feature `rayon`, otherwise one.
pub(in crate::bem) fn thread_count() -> usize {
    #[cfg(feature = "rayon")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "rayon"))]
    1
}

/// Calls `compute` once for each item, on several threads with a workspace each.
///
/// `report` is called on the calling thread, with the number of completed items; its error stops all threads.
///
/// # Errors
/// The first error in the order of the items.
pub(in crate::bem) fn on_threads<T: Send, W: Default>(
    thread_count: usize,
    items: impl Iterator<Item = T> + Send,
    compute: impl Fn(&mut W, T) -> Result<()> + Sync,
    mut report: impl FnMut(usize) -> Result<()>,
) -> Result<()> {
    let queue = Mutex::new(items.enumerate());
    let completed_count = AtomicUsize::new(0);
    let is_stopped = AtomicBool::new(false);
    let process_queue = |report: &mut dyn FnMut(usize) -> Result<()>| {
        let mut workspace = W::default();
        while !is_stopped.load(Ordering::Relaxed) {
            // The queue stays valid if a thread panics.
            let next_item = queue.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((index, item)) = next_item else { break };
            compute(&mut workspace, item).map_err(|error| (index, error))?;
            let new_count = completed_count.fetch_add(1, Ordering::Relaxed) + 1;
            report(new_count).map_err(|error| (index, error))?;
        }
        Ok(())
    };
    // Separate threads instead of a pool: a waiting thread of a pool may start another task, which may wait for the
    // results of these threads.
    let mut failures: Vec<(usize, Error)> = std::thread::scope(|scope| {
        let handles: Vec<_> =
            (1..thread_count).map(|_| scope.spawn(|| process_queue(&mut |_| Ok(())))).collect();
        let outcome = process_queue(&mut report);
        is_stopped.store(outcome.is_err(), Ordering::Relaxed);
        let mut failures: Vec<_> = outcome.err().into_iter().collect();
        for handle in handles {
            match handle.join() {
                Ok(outcome) => failures.extend(outcome.err()),
                // A user's damping law may panic; the panic continues on the calling thread.
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        failures
    });
    failures.sort_by_key(|(index, _)| *index);
    failures.into_iter().next().map_or(Ok(()), |(_, error)| Err(error))
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::error::positive;

    /// Each item is computed once, and the error is the error of the first item that fails.
    #[test]
    fn threads_compute_all_items_or_return_the_first_error() {
        for thread_count in [1, 2, 5] {
            let mut squares = vec![0; 100];
            let call_count = AtomicUsize::new(0);
            let mut last_report = 0;
            on_threads(
                thread_count,
                (0..100).zip(&mut squares),
                |(): &mut (), (item, square): (usize, &mut usize)| {
                    *square += item * item;
                    call_count.fetch_add(1, Ordering::Relaxed);
                    Ok(())
                },
                |completed| {
                    last_report = completed;
                    Ok(())
                },
            )
            .unwrap();
            assert!(squares.iter().enumerate().all(|(item, square)| *square == item * item));
            assert!(call_count.into_inner() == 100 && last_report <= 100);

            let outcome = on_threads(thread_count, 0..100, fail_first_item_last, |_| Ok(()));
            assert!(matches!(outcome, Err(Error::Input { value: -0.5, .. })), "{outcome:?}");
            assert!(on_threads(thread_count, 0..100, wait_briefly, stop_after_three).is_err());
        }
    }

    fn fail_first_item_last((): &mut (), item: usize) -> Result<()> {
        std::thread::sleep(Duration::from_millis(if item == 0 { 100 } else { 0 }));
        positive("item", -0.5 - item as f64).map(|_| ())
    }

    /// Waits long enough for the calling thread to compute some of the items.
    #[allow(clippy::unnecessary_wraps, reason = "the type of `compute`")]
    fn wait_briefly((): &mut (), _item: usize) -> Result<()> {
        std::thread::sleep(Duration::from_millis(2));
        Ok(())
    }

    fn stop_after_three(completed_count: usize) -> Result<()> {
        positive("remaining items", 3.0 - completed_count as f64).map(|_| ())
    }
}
