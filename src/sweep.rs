//! Many independent simulations.
//!
//! With the feature `rayon` they run on all processors, one simulation per thread; without it one
//! after the other. Results are the same bit for bit: a simulation is built, marched and dropped
//! on one thread.

use std::sync::{Mutex, PoisonError};

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
    pub fn collect<T: Send, E: Send>(
        &self,
        run: impl Fn(&SweepCase<'_>) -> Result<T, E> + Sync,
    ) -> Vec<Result<T, E>> {
        let mut results = Vec::new();
        self.run(run, |index, result| results.push((index, result)));
        results.sort_unstable_by_key(|(index, _)| *index);
        results.into_iter().map(|(_, result)| result).collect()
    }

    /// Runs all cases, and hands every result to `sink` with the index of its case as soon as it
    /// is there, in whatever order cases end, one at a time. A case that fails is a result like
    /// any other: the sweep goes on.
    pub fn run<T: Send, E: Send>(
        &self,
        run: impl Fn(&SweepCase<'_>) -> Result<T, E> + Sync,
        sink: impl FnMut(usize, Result<T, E>) + Send,
    ) {
        let sink = Mutex::new(sink);
        for_each(self.count, &|index| {
            let result = run(&SweepCase { index, progress: &*self.progress });
            (self.progress)(index, 1.0);
            let mut sink = sink.lock().unwrap_or_else(PoisonError::into_inner);
            (*sink)(index, result);
        });
    }
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
