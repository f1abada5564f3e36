//! Many independent simulations.
//!
//! With the feature `rayon` they run on all processors, one simulation per thread; without it one
//! after the other. Results are the same bit for bit: a simulation is built, marched and dropped
//! on one thread.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Mutex, PoisonError};

use crate::error::CaseError;

/// A number of cases to run, each by the same closure. Cases with several parameters are a list that
/// the closure looks up.
///
/// ```
/// use basemat::Sweep;
///
/// let roots = Sweep::new(4).collect(|case| {
///     if case.index() == 2 { Err("no two") } else { Ok((case.index() as f64).sqrt()) }
/// });
/// assert_eq!(roots, [Ok(0.0), Ok(1.0), Err("no two"), Ok(3.0_f64.sqrt())]);
///
/// // Widths × frictions; the error type is what the closure's `?` needs to know.
/// let cases: Vec<_> = [4.0, 6.0].iter().flat_map(|&b| [0.2, 0.4].map(|phi| (b, phi))).collect();
/// let products = Sweep::new(cases.len()).collect(|case| {
///     let (width, friction) = cases[case.index()];
///     basemat::Result::Ok(width * friction)
/// });
/// assert_eq!(products[3], Ok(6.0 * 0.4));
/// ```
pub struct Sweep<'a> {
    count: usize,
    progress: Box<dyn Fn(usize, f64) + Sync + 'a>,
}

short_debug! { Sweep<'_>; self; count: self.count }

/// One case of a [`Sweep`], while it runs.
pub struct SweepCase<'a> {
    index: usize,
    progress: &'a (dyn Fn(usize, f64) + Sync),
}

short_debug! { SweepCase<'_>; self; index: self.index }

impl SweepCase<'_> {
    /// Which case this is, from 0.
    pub fn index(&self) -> usize {
        self.index
    }

    /// Tells the sweep's progress callback what `fraction` of this case is done.
    pub fn report(&self, fraction: f64) {
        (self.progress)(self.index, fraction);
    }
}

impl<'a> Sweep<'a> {
    /// A sweep over the cases 0 … `count` − 1.
    pub fn new(count: usize) -> Self {
        Self { count, progress: Box::new(|_, _| ()) }
    }

    /// Calls `progress` with a case's index and the fraction of it that is done: whenever the case
    /// says so with [`SweepCase::report`], and with 1 when it ends, well or not.
    #[must_use]
    pub fn on_progress(mut self, progress: impl Fn(usize, f64) + Sync + 'a) -> Self {
        self.progress = Box::new(progress);
        self
    }

    /// Runs all cases and returns their results, in the order of the cases. A case that fails is a
    /// result like any other: the sweep goes on.
    ///
    /// # Panics
    /// After the other cases, if one panics: their results are lost then, unlike those of
    /// [`Sweep::run`] and [`Sweep::collect_caught`].
    pub fn collect<T: Send, E: Send>(
        &self,
        run: impl Fn(&SweepCase<'_>) -> Result<T, E> + Sync,
    ) -> Vec<Result<T, E>> {
        let mut results = Vec::new();
        self.run(run, |index, result| results.push((index, result)));
        results.sort_unstable_by_key(|(index, _)| *index);
        results.into_iter().map(|(_, result)| result).collect()
    }

    /// As [`Sweep::collect`], but a case that panics is an error like any other. Where panics abort
    /// the program (`panic = "abort"`) nothing can be caught.
    ///
    /// ```
    /// use basemat::{CaseError, Sweep};
    ///
    /// let floors = [3, 5];
    /// let found = Sweep::new(3).collect_caught(|case| Ok::<_, basemat::Error>(floors[case.index()]));
    /// assert_eq!(found[..2], [Ok(3), Ok(5)]);
    /// assert!(matches!(&found[2], Err(CaseError::Panicked { message }) if message.contains("index")));
    /// ```
    pub fn collect_caught<T: Send, E: Send>(
        &self,
        run: impl Fn(&SweepCase<'_>) -> Result<T, E> + Sync,
    ) -> Vec<Result<T, CaseError<E>>> {
        self.collect(|case| match caught(&run, case) {
            Ok(result) => result.map_err(CaseError::Failed),
            Err(payload) => Err(CaseError::panicked(payload.as_ref())),
        })
    }

    /// Runs all cases, and hands every result to `sink` with the index of its case as soon as it
    /// is there, in whatever order cases end, one at a time. A case that fails is a result like
    /// any other: the sweep goes on.
    ///
    /// # Panics
    /// If a case panics: after all others, whose results `sink` has got by then.
    pub fn run<T: Send, E: Send>(
        &self,
        run: impl Fn(&SweepCase<'_>) -> Result<T, E> + Sync,
        sink: impl FnMut(usize, Result<T, E>) + Send,
    ) {
        let sink = Mutex::new(sink);
        let panic = Mutex::new(None);
        for_each(self.count, &|index| {
            let result = caught(&run, &SweepCase { index, progress: &*self.progress });
            (self.progress)(index, 1.0);
            match result {
                Ok(result) => {
                    let mut sink = sink.lock().unwrap_or_else(PoisonError::into_inner);
                    (*sink)(index, result);
                }
                Err(payload) => {
                    panic.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(payload);
                }
            }
        });
        if let Some(payload) = panic.into_inner().unwrap_or_else(PoisonError::into_inner) {
            resume_unwind(payload);
        }
    }
}

/// The result of a case, or the panic in it. What it has built is dropped with it; what cases share
/// is theirs to keep sound.
fn caught<T, E>(
    run: &impl Fn(&SweepCase<'_>) -> Result<T, E>,
    case: &SweepCase<'_>,
) -> Result<Result<T, E>, Box<dyn Any + Send>> {
    catch_unwind(AssertUnwindSafe(|| run(case)))
}

#[cfg(feature = "rayon")]
fn for_each(count: usize, run: &(dyn Fn(usize) + Sync)) {
    use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};
    // Cases are long and few: each is a task of its own.
    (0..count).into_par_iter().with_max_len(1).for_each(run);
}

#[cfg(not(feature = "rayon"))]
fn for_each(count: usize, run: &(dyn Fn(usize) + Sync)) {
    (0..count).for_each(run);
}
