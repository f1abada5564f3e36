//! Runs a sweep into a table.

use std::fmt::Display;

use super::run::{Sweep, SweepCase};
use super::table::{CaseTable, Columns, TableRow};
use super::{Parameter, check_names};
use crate::error::CaseError;
use crate::error::Result;

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
        let columns = self.checked_columns(&columns)?;
        let mut rows = Vec::new();
        self.run(run, |case, result| rows.push(table_row(case, result)));
        rows.sort_unstable_by_key(|row| row.case);
        Ok(CaseTable { grid: self.grid.clone(), columns: Columns::of_results(columns), rows })
    }

    /// The columns' names; an error if one is empty, reserved or occurs twice.
    pub(super) fn checked_columns<S: AsRef<str>>(&self, columns: &[S]) -> Result<Vec<String>> {
        let columns: Vec<String> = columns.iter().map(|name| name.as_ref().to_owned()).collect();
        let parameters = self.grid.parameters.iter().map(Parameter::name);
        check_names(parameters.chain(columns.iter().map(String::as_str)))?;
        Ok(columns)
    }
}
