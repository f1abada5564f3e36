//! Tables of a sweep.

use std::fmt::Display;

use super::run::{Sweep, SweepCase};
use super::table::{CaseTable, Row};
use super::{Parameter, check_names};
use crate::error::CaseError;
use crate::error::{Result, same_length};

/// Row of a case from its result.
pub(super) fn row<const N: usize, E: Display>(
    case: usize,
    result: std::result::Result<[f64; N], CaseError<E>>,
) -> Row {
    Row::new(case, result.map(Vec::from).map_err(|error| error.to_string()))
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
        let columns = self.named(&columns)?;
        let mut rows = Vec::new();
        self.run(run, |case, result| rows.push(row(case, result)));
        Ok(self.tabled(columns, rows))
    }

    /// Table of cases that another program ran.
    ///
    /// `columns` are the names of the results. `outcomes` has for each case of [`Sweep::cases`] its results
    /// or the text of its error.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) if the number of outcomes differs from the number of cases, or the number
    /// of results from the number of columns; the errors of [`Sweep::table`].
    pub fn tabulate<S: AsRef<str>>(
        &self,
        columns: &[S],
        outcomes: impl IntoIterator<Item = std::result::Result<Vec<f64>, String>>,
    ) -> Result<CaseTable> {
        let columns = self.named(columns)?;
        let outcomes: Vec<_> = outcomes.into_iter().collect();
        same_length("list of outcomes", outcomes.len(), self.cases().len())?;
        for results in outcomes.iter().flatten() {
            same_length("list of results of a case", results.len(), columns.len())?;
        }
        let rows = self.cases().zip(outcomes).map(|(case, outcome)| Row::new(case, outcome));
        Ok(self.tabled(columns, rows.collect()))
    }

    /// The columns' names, checked together with the parameters' names.
    pub(super) fn named<S: AsRef<str>>(&self, columns: &[S]) -> Result<Vec<String>> {
        let own = || columns.iter().map(AsRef::as_ref);
        check_names(self.grid.parameters.iter().map(Parameter::name).chain(own()))?;
        Ok(own().map(str::to_owned).collect())
    }

    pub(super) fn tabled(&self, columns: Vec<String>, mut rows: Vec<Row>) -> CaseTable {
        rows.sort_unstable_by_key(|row| row.case);
        CaseTable { grid: self.grid.clone(), columns, rows }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Error;

    #[test]
    fn outcomes_of_another_program() {
        let sweep = Sweep::grid([Parameter::numbers("width_m", [4.0, 6.0, 8.0])]).unwrap();
        let run = |case: &SweepCase<'_>| match case.value("width_m") {
            Ok(width) if width < 7.0 => Ok([width, -0.0]),
            _ => Err("too wide"),
        };
        let wide = || Err("too wide".to_owned());
        let shard = || sweep.table(["width", "zero"], run).unwrap();
        let given = [Ok(vec![4.0, -0.0]), Ok(vec![6.0, -0.0]), wide()];
        assert_eq!(sweep.tabulate(&["width", "zero"], given.clone()).unwrap(), shard());
        assert_eq!(
            sweep.tabulate(&["width", "zero"], given[..2].to_vec()).unwrap_err(),
            Error::Size { quantity: "list of outcomes", found: 2, needed: 3 }
        );
        assert_eq!(
            sweep.tabulate(&["width"], given.clone()).unwrap_err(),
            Error::Size { quantity: "list of results of a case", found: 2, needed: 1 }
        );
        assert!(sweep.tabulate(&["width", "width_m"], given).is_err());
    }
}
