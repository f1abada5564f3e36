//! Runs cases by one closure, on all processors or one after the other.

use std::fmt::Display;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, PoisonError};

use super::table::{CaseTable, Columns, TableRow};
use super::{CaseGrid, Parameter, check_names};
use crate::error::{CaseError, Error, Result};

/// A number of cases, each run by the same closure.
///
/// ```
/// use basemat::sweep::Parameter;
/// use basemat::sweep::CaseError;
/// use basemat::sweep::Sweep;
///
/// let roots = Sweep::new(4).collect(|case| match case.index {
///     1 => Err("no one"),
///     2 => panic!("no two"),
///     index => Ok((index as f64).sqrt()),
/// });
/// assert_eq!(roots[0], Ok(0.0));
/// assert_eq!(roots[1], Err(CaseError::Failed("no one")));
/// assert!(matches!(&roots[2], Err(CaseError::Panicked { message }) if message == "no two"));
/// assert_eq!(roots[3], Ok(3.0_f64.sqrt()));
///
/// // Widths × frictions.
/// let sweep = Sweep::grid([
///     Parameter::numbers("width_m", [4.0, 6.0]),
///     Parameter::numbers("friction", [0.2, 0.4]),
/// ])?;
/// let products = sweep
///     .collect(|case| basemat::Result::Ok(case.value("width_m")? * case.value("friction")?));
/// assert_eq!(products, [Ok(4.0 * 0.2), Ok(4.0 * 0.4), Ok(6.0 * 0.2), Ok(6.0 * 0.4)]);
///
/// // The second of three processes runs cases 1, 4, 7, …
/// assert_eq!(Sweep::new(9).shard(1, 3)?.cases().collect::<Vec<_>>(), [1, 4, 7]);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct Sweep<'a> {
    /// Combinations of all parameters.
    pub(super) grid: Arc<CaseGrid>,
    /// Index of the first case that is run.
    first_case: usize,
    /// Difference of the indices of two successive cases.
    stride: NonZeroUsize,
    /// Receives the index of a case and its completed fraction.
    pub(super) progress: Box<dyn Fn(usize, f64) + Sync + 'a>,
}

short_debug! {
    Sweep<'_>; self;
    count: self.cases().len(), parameters: self.grid.parameters, first: self.first_case,
    stride: self.stride
}

/// A case of a [`Sweep`] while it runs.
#[non_exhaustive]
pub struct SweepCase<'a> {
    /// Number of the case in the whole sweep, from 0.
    pub index: usize,
    grid: &'a CaseGrid,
    progress: &'a (dyn Fn(usize, f64) + Sync),
}

short_debug! { SweepCase<'_>; self; index: self.index }

impl SweepCase<'_> {
    /// Value of a parameter with numbers.
    ///
    /// # Errors
    /// [`Error::Name`] if no such parameter has this name.
    pub fn value(&self, parameter: &str) -> Result<f64> {
        let number = self.grid.number(self.index, parameter);
        number.ok_or_else(|| self.grid.missing_name_error("parameter with numbers", parameter, &[]))
    }

    /// Value of a parameter with texts.
    ///
    /// # Errors
    /// [`Error::Name`] if no such parameter has this name.
    pub fn text(&self, parameter: &str) -> Result<&str> {
        self.grid.text(self.index, parameter)
    }

    /// Position of the case's value among all values of a parameter, from 0.
    ///
    /// Use it, for example, as the index into a list of records.
    ///
    /// # Errors
    /// [`Error::Name`] if there is no parameter of this name.
    pub fn place(&self, parameter: &str) -> Result<usize> {
        self.grid.named_value_index(self.index, parameter)
    }

    /// Reports to the sweep's progress callback the completed `fraction` of this case.
    pub fn report(&self, fraction: f64) {
        (self.progress)(self.index, fraction);
    }
}

impl<'a> Sweep<'a> {
    /// A sweep over the cases 0 … `count` − 1.
    pub fn new(count: usize) -> Self {
        Self::over_grid(CaseGrid { parameters: Vec::new(), case_count: count })
    }

    /// A sweep over all combinations of the parameters' values.
    ///
    /// Cases are numbered in the order of the values, the last parameter fastest. Without parameters there is
    /// one case.
    ///
    /// # Errors
    /// [`Error::DuplicateName`] if two parameters have the same name, or one is called `case`, `warnings` or `error`;
    /// [`Error::Scene`] for a parameter without a name; [`Error::Item`] for a parameter without values, and for a value
    /// that occurs twice, is not finite or is an empty text; [`Error::Memory`] for more cases than a table holds.
    pub fn grid(parameters: impl IntoIterator<Item = Parameter>) -> Result<Self> {
        Ok(Self::over_grid(CaseGrid::new(parameters.into_iter().collect())?))
    }

    /// The sweep over all cases of a grid.
    fn over_grid(grid: CaseGrid) -> Self {
        let progress = Box::new(|_, _| ());
        Self { grid: Arc::new(grid), first_case: 0, stride: NonZeroUsize::MIN, progress }
    }

    /// Selects one of `shard_count` equal parts of the cases.
    ///
    /// The part `index`, from 0, has every `shard_count`-th case from case `index` on. Cases keep their numbers. A shard may
    /// be divided into shards again.
    ///
    /// # Errors
    /// [`Error::Index`] unless `index` is below `shard_count`.
    pub fn shard(self, index: usize, shard_count: usize) -> Result<Self> {
        let index_error = Error::Index { quantity: "shard", index, bound: shard_count };
        let shard_count = NonZeroUsize::new(shard_count)
            .filter(|shard_count| index < shard_count.get())
            .ok_or(index_error)?;
        // A saturated index is beyond the last case, so that the shard is empty.
        let first_case = self.first_case.saturating_add(self.stride.get().saturating_mul(index));
        Ok(Self { first_case, stride: self.stride.saturating_mul(shard_count), ..self })
    }

    /// Numbers of the cases that are run: all cases, or the cases of the shard.
    pub fn cases(&self) -> impl ExactSizeIterator<Item = usize> + use<> {
        (self.first_case.min(self.grid.case_count)..self.grid.case_count).step_by(self.stride.get())
    }

    /// Position of a case among the cases that are run; `None` if it is not run.
    #[cfg(feature = "io")]
    pub(super) fn position(&self, case: usize) -> Option<usize> {
        let distance = case.checked_sub(self.first_case).filter(|_| case < self.grid.case_count)?;
        (distance % self.stride == 0).then(|| distance / self.stride)
    }

    /// Calls `progress` with a case's number and its completed fraction.
    ///
    /// It is called at each [`SweepCase::report`], and with 1 when the case ends, successful or not.
    /// Cases whose rows are read from a file ([`Sweep::table_in`]) are not reported.
    #[must_use]
    pub fn on_progress(mut self, progress: impl Fn(usize, f64) + Sync + 'a) -> Self {
        self.progress = Box::new(progress);
        self
    }

    /// Runs the cases and returns their results, in the order of the cases.
    ///
    /// A case that fails or panics has an error as its result, and the sweep continues. If panics abort the
    /// program (`panic = "abort"`), they cannot be caught.
    pub fn collect<T: Send, E: Send>(
        &self,
        run: impl Fn(&SweepCase<'_>) -> std::result::Result<T, E> + Sync,
    ) -> Vec<std::result::Result<T, CaseError<E>>> {
        let mut results = Vec::new();
        self.run(run, |index, result| results.push((index, result)));
        results.sort_unstable_by_key(|(index, _)| *index);
        results.into_iter().map(|(_, result)| result).collect()
    }

    /// Runs all cases like [`Sweep::collect`], but passes each result to `sink` when its case ends.
    ///
    /// `sink` gets the number of the case and its result, one case at a time, in the order in which cases
    /// end.
    ///
    /// # Panics
    /// If `sink` or the progress callback does.
    pub fn run<T: Send, E: Send>(
        &self,
        run: impl Fn(&SweepCase<'_>) -> std::result::Result<T, E> + Sync,
        mut sink: impl FnMut(usize, std::result::Result<T, CaseError<E>>) + Send,
    ) {
        let case_index = |position: usize| self.first_case + position * self.stride.get();
        self.run_each(self.cases().len(), &case_index, run, |index, result| {
            sink(index, result);
            ControlFlow::Continue(())
        });
    }

    /// Runs `count` cases until `sink` breaks.
    ///
    /// `case_index`: index of the case at each position, from 0 to `count` − 1.
    ///
    /// Cases that are running then still pass their results to `sink`; no others are started.
    pub(super) fn run_each<T: Send, E: Send>(
        &self,
        count: usize,
        case_index: &(dyn Fn(usize) -> usize + Sync),
        run: impl Fn(&SweepCase<'_>) -> std::result::Result<T, E> + Sync,
        sink: impl FnMut(usize, std::result::Result<T, CaseError<E>>) -> ControlFlow<()> + Send,
    ) {
        let sink = Mutex::new(sink);
        for_each(count, &|position| {
            let index = case_index(position);
            let case = SweepCase { index, grid: &self.grid, progress: &*self.progress };
            // A case that panics drops its values; the caller must keep state that cases share valid.
            let result = match catch_unwind(AssertUnwindSafe(|| run(&case))) {
                Ok(result) => result.map_err(CaseError::Failed),
                Err(payload) => Err(CaseError::panicked(payload.as_ref())),
            };
            (self.progress)(index, 1.0);
            let mut sink = sink.lock().unwrap_or_else(PoisonError::into_inner);
            (*sink)(index, result)
        });
    }
}

/// Calls `run` for all numbers below `count`, on all processors, until it breaks.
#[cfg(feature = "rayon")]
fn for_each(count: usize, run: &(dyn Fn(usize) -> ControlFlow<()> + Sync)) {
    use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};
    // Cases are long and few, so each is a separate task.
    let _ = (0..count).into_par_iter().with_max_len(1).try_for_each(run);
}

/// Calls `run` for all numbers below `count`, one after the other, until it breaks.
#[cfg(not(feature = "rayon"))]
fn for_each(count: usize, run: &(dyn Fn(usize) -> ControlFlow<()> + Sync)) {
    let _ = (0..count).try_for_each(run);
}

/// Row of a case from its result.
pub(super) fn table_row<const N: usize, E: Display>(
    case: usize,
    result: std::result::Result<[f64; N], CaseError<E>>,
) -> TableRow {
    TableRow::new(case, result.map(Vec::from).map_err(|error| error.to_string()))
}

impl Sweep<'_> {
    /// Runs the cases and returns a table of their parameters and `columns` of results.
    ///
    /// The row of a case that fails or panics contains its error. The columns' names should contain units:
    /// `residual_slip_m`.
    ///
    /// ```
    /// use basemat::sweep::{Parameter, Sweep};
    ///
    /// let sweep = Sweep::grid([Parameter::numbers("width_m", [4.0, 6.0])])?;
    /// let table = sweep.table(["area_m2"], |case| match case.value("width_m")? {
    ///     6.0 => Err(basemat::Error::part("width", "too wide")),
    ///     width => Ok([width * width]),
    /// })?;
    /// assert!(table.csv().contains("\ncase,width_m,area_m2,error\n0,4.0,16.0,\n"));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// Errors of cases are not returned. [`Error::DuplicateName`](crate::Error::DuplicateName) if two columns
    /// (parameters, `case` and `error` among them) have the same name, [`Error::Scene`](crate::Error::Scene) if
    /// one has no name.
    pub fn table<const N: usize, E: Display + Send>(
        &self,
        columns: [&str; N],
        run: impl Fn(&SweepCase<'_>) -> std::result::Result<[f64; N], E> + Sync,
    ) -> Result<CaseTable> {
        let names = self.checked_columns(&columns)?;
        let mut rows = Vec::new();
        self.run(run, |case, result| rows.push(table_row(case, result)));
        rows.sort_unstable_by_key(|row| row.case);
        Ok(CaseTable { grid: self.grid.clone(), columns: Columns::of_results(names), rows })
    }

    /// The columns' names; an error if one is empty, reserved or occurs twice.
    pub(super) fn checked_columns<S: AsRef<str>>(&self, columns: &[S]) -> Result<Vec<String>> {
        let names: Vec<String> = columns.iter().map(|name| name.as_ref().to_owned()).collect();
        let parameters = self.grid.parameters.iter().map(Parameter::name);
        check_names(parameters.chain(names.iter().map(String::as_str)))?;
        Ok(names)
    }
}
