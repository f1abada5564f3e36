//! Parameters and results of cases, one row each.

use std::fmt;
use std::sync::Arc;

use super::{CaseGrid, ERROR_COLUMN, WARNINGS_COLUMN};
use crate::error::{Error, Result};
use crate::text::check_sum::CheckSum;
use crate::text::column::NumberCell;
use crate::text::csv::{Csv, csv_line};
use crate::text::line_breaks::broken_lines;
use crate::text::readable_number::number;
use crate::text::table::{MAX_LINE_CHARACTERS, Table};

/// The results of a [`Sweep`](super::Sweep), one row for each case.
///
/// A row has the case's number, its parameters, and its results or its error. The table prints with five
/// figures, in lines of at most 99 characters; a wide table breaks into blocks.
///
/// Tables are equal if all their bits are equal; every NaN counts as the same.
#[derive(Debug, Clone)]
pub struct CaseTable {
    pub(super) grid: Arc<CaseGrid>,
    pub(super) columns: Columns,
    /// Rows, ascending by case.
    pub(super) rows: Vec<TableRow>,
}

/// Columns between the parameters and the errors.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Columns {
    /// Names of the results.
    pub(super) names: Vec<String>,
    /// Whether a column of warnings follows the results.
    pub(super) with_warnings: bool,
}

impl Columns {
    /// Columns of results without warnings.
    pub(super) fn of_results(names: Vec<String>) -> Self {
        Self { names, with_warnings: false }
    }

    /// Results in the order of these columns, NaN for a column without a result.
    ///
    /// `names`: columns of the `results`.
    #[cfg(feature = "io")]
    pub(super) fn arranged(&self, names: &[String], results: Vec<f64>) -> Vec<f64> {
        if self.names == names {
            return results;
        }
        let mut arranged = Vec::with_capacity(self.names.len());
        for name in &self.names {
            let index = names.iter().position(|result_name| result_name == name);
            arranged.push(index.map_or(f64::NAN, |index| results[index]));
        }
        arranged
    }
}

/// A case with its results or its error.
#[derive(Debug, Clone)]
pub(super) struct TableRow {
    /// Index of the case.
    pub(super) case: usize,
    /// Results in the order of the columns, or the text of the error.
    pub(super) outcome: std::result::Result<Vec<f64>, String>,
    /// Texts of the run's warnings; empty if there are none.
    pub(super) warnings: String,
}

impl TableRow {
    /// Row without warnings, in the form in which it is read back.
    ///
    /// Every NaN becomes the same NaN, and an empty error text becomes "failed".
    pub(super) fn new(case: usize, outcome: std::result::Result<Vec<f64>, String>) -> Self {
        let outcome = match outcome {
            Ok(mut results) => {
                for value in &mut results {
                    if value.is_nan() {
                        *value = f64::NAN;
                    }
                }
                Ok(results)
            }
            Err(reason) if reason.is_empty() => Err("failed".to_owned()),
            Err(reason) => Err(reason),
        };
        Self { case, outcome, warnings: String::new() }
    }

    /// Adds the values of all cells to the check sum of a table.
    pub(super) fn add_to_check_sum(
        &self,
        grid: &CaseGrid,
        columns: &Columns,
        check_sum: &mut CheckSum,
    ) {
        check_sum.add(self.case as u64);
        for cell in parameter_cells(grid, self.case) {
            check_sum.add_text(&cell);
        }
        match &self.outcome {
            Ok(results) => check_sum.add_numbers(results),
            Err(reason) => check_sum.add_text(reason),
        }
        if columns.with_warnings {
            check_sum.add_text(&self.warnings);
        }
    }

    /// The outcome with its numbers as bits.
    fn outcome_bits(&self) -> std::result::Result<Vec<u64>, &str> {
        match &self.outcome {
            Ok(results) => Ok(results.iter().map(|value| value.to_bits()).collect()),
            Err(reason) => Err(reason),
        }
    }

    /// Writes the row as a line of CSV, with its line end.
    pub(super) fn csv(&self, grid: &CaseGrid, columns: &Columns) -> String {
        let mut cells = vec![self.case.to_string()];
        cells.extend(parameter_cells(grid, self.case));
        match &self.outcome {
            Ok(results) => cells.extend(results.iter().map(|&value| NumberCell(value).to_string())),
            Err(_) => cells.extend(columns.names.iter().map(|_| String::new())),
        }
        if columns.with_warnings {
            cells.push(self.warnings.clone());
        }
        cells.push(self.outcome.as_ref().err().cloned().unwrap_or_default());
        csv_line(&cells)
    }
}

impl PartialEq for TableRow {
    fn eq(&self, other: &Self) -> bool {
        self.case == other.case
            && self.warnings == other.warnings
            && self.outcome_bits() == other.outcome_bits()
    }
}

impl PartialEq for CaseTable {
    fn eq(&self, other: &Self) -> bool {
        (&self.grid, &self.columns, &self.rows) == (&other.grid, &other.columns, &other.rows)
    }
}

/// Values of a case's parameters, as text.
pub(super) fn parameter_cells(grid: &CaseGrid, case: usize) -> impl Iterator<Item = String> {
    grid.parameters.iter().enumerate().map(move |(index, parameter)| {
        let value_index = grid.value_index(case, index);
        match parameter.number(value_index) {
            Some(number) => NumberCell(number).to_string(),
            None => parameter.text(value_index).unwrap_or_default().to_owned(),
        }
    })
}

/// Headings of all columns.
pub(super) fn heading(grid: &CaseGrid, columns: &Columns) -> Vec<String> {
    let mut cells = vec!["case".to_owned()];
    cells.extend(grid.parameters.iter().map(|parameter| parameter.name().to_owned()));
    cells.extend_from_slice(&columns.names);
    if columns.with_warnings {
        cells.push(WARNINGS_COLUMN.to_owned());
    }
    cells.push(ERROR_COLUMN.to_owned());
    cells
}

/// Beginning of a table's file, up to its check sum. The number is the version of the format.
pub(super) const FILE_BEGINNING: &str = "# basemat sweep 1 check sum ";

/// Check sum of a table without rows.
pub(super) fn heading_check_sum(grid: &CaseGrid, columns: &Columns) -> CheckSum {
    let mut check_sum = CheckSum::default();
    for name in heading(grid, columns) {
        check_sum.add_text(&name);
    }
    check_sum
}

/// The first two lines of a table's file.
pub(super) fn first_lines(grid: &CaseGrid, columns: &Columns, check_sum: CheckSum) -> String {
    format!("{FILE_BEGINNING}{}\n{}", check_sum.text(), csv_line(&heading(grid, columns)))
}

/// A row of a [`CaseTable`].
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct CaseRow<'a> {
    /// Number of the case in the whole sweep, from 0.
    pub index: usize,
    /// The results in the order of [`CaseTable::columns`], or the text of the error if the case failed or panicked.
    pub results: std::result::Result<&'a [f64], &'a str>,
    /// Texts of the run's warnings as a program stored them with [`CaseFile::append`](super::CaseFile::append); empty
    /// without any.
    pub warnings: &'a str,
    table: &'a CaseTable,
}

impl<'a> CaseRow<'a> {
    /// Number in a `column`: a result, or the value of a numeric parameter.
    ///
    /// # Errors
    /// [`Error::Name`](crate::Error::Name) if no column of numbers has this name;
    /// [`Error::Part`] for a result of a case that failed.
    pub fn value(&self, column: &str) -> Result<f64> {
        if let Some(number) = self.table.grid.number(self.index, column) {
            return Ok(number);
        }
        let columns = &self.table.columns.names;
        let index = columns.iter().position(|name| name == column);
        let index = index.ok_or_else(|| {
            self.table.grid.missing_name_error("column of numbers", column, columns)
        })?;
        match self.results {
            Ok(results) => Ok(results[index]),
            Err(reason) => Err(Error::part(format!("case {} failed", self.index), reason)),
        }
    }

    /// Value of a `parameter` whose values are texts.
    ///
    /// # Errors
    /// [`Error::Name`](crate::Error::Name) if no such parameter has this name.
    pub fn text(&self, parameter: &str) -> Result<&'a str> {
        self.table.grid.text(self.index, parameter)
    }

    /// Position of the case's value among all values of a parameter, from 0.
    ///
    /// # Errors
    /// [`Error::Name`](crate::Error::Name) if there is no parameter of this name.
    pub fn place(&self, parameter: &str) -> Result<usize> {
        self.table.grid.named_value_index(self.index, parameter)
    }
}

impl CaseTable {
    /// The rows, ascending by case.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = CaseRow<'_>> {
        self.rows.iter().map(|row| {
            let results = row.outcome.as_deref().map_err(String::as_str);
            CaseRow { index: row.case, results, warnings: &row.warnings, table: self }
        })
    }

    /// Names of the results.
    pub fn columns(&self) -> &[String] {
        &self.columns.names
    }

    /// Writes the table as CSV (RFC 4180): a comment, a heading, and a line for each case.
    ///
    /// The comment has the version of the format and the check sum of all values, which are needed to read the table
    /// again: other programs skip the first line. Columns are `case`, the parameters, the results, `warnings` if a case of a
    /// [`CaseFile`](super::CaseFile) has some, and `error`. Numbers, in the caller's units, have enough digits to be read
    /// back to the last bit. NaN is an empty cell, infinities are `inf` and `-inf`. A case that failed has empty results and
    /// a text in `error`.
    pub fn csv(&self) -> Csv {
        let mut sum = heading_check_sum(&self.grid, &self.columns);
        for row in &self.rows {
            row.add_to_check_sum(&self.grid, &self.columns, &mut sum);
        }
        let mut text = first_lines(&self.grid, &self.columns, sum);
        text.extend(self.rows.iter().map(|row| row.csv(&self.grid, &self.columns)));
        Csv(text)
    }
}

/// Largest magnitude, excluded, of a whole number that is printed with all digits.
const MAX_WHOLE_NUMBER: f64 = 1e15;
/// Smallest magnitude of a number that is printed without an exponent.
const MIN_DECIMAL_NUMBER: f64 = 1e-6;

/// Text of a number for a printed table, with five figures.
///
/// A whole number has all digits; very small numbers have an exponent.
fn five_figures(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < MAX_WHOLE_NUMBER {
        // Adding zero removes a negative sign of zero.
        format!("{}", value + 0.0)
    } else if value.abs() < MIN_DECIMAL_NUMBER {
        format!("{value:.3e}")
    } else {
        number(value)
    }
}

impl fmt::Display for CaseTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let result_count = self.columns.names.len();
        let results = Columns::of_results(self.columns.names.clone());
        let mut heading = heading(&self.grid, &results);
        heading.pop();
        let rows = self.rows.iter().map(|row| {
            let mut cells = vec![row.case.to_string()];
            cells.extend(parameter_cells(&self.grid, row.case));
            match &row.outcome {
                Ok(results) => cells.extend(results.iter().map(|&value| five_figures(value))),
                Err(_) => cells.extend(std::iter::repeat_n("failed".to_owned(), result_count)),
            }
            cells
        });
        f.write_str(&Table { heading, repeated_column_count: 1, rows: rows.collect() }.text())?;
        for row in &self.rows {
            if let Err(reason) = &row.outcome {
                write_lines(f, &format!("case {} failed: {reason}", row.case))?;
            }
            if !row.warnings.is_empty() {
                write_lines(f, &format!("case {} warns: {}", row.case, row.warnings))?;
            }
        }
        Ok(())
    }
}

/// Writes a text below a table, in lines of limited length.
fn write_lines(f: &mut fmt::Formatter<'_>, text: &str) -> fmt::Result {
    for line in broken_lines(text, MAX_LINE_CHARACTERS) {
        write!(f, "\n{line}")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_cells() {
        assert_eq!(five_figures(1e-12), "1.000e-12");
        assert_eq!(
            [-0.0, 3600.0, 0.5, 1.25e20].map(five_figures),
            ["0", "3600", "0.50000", "1.250e20"]
        );
        assert_eq!([five_figures(f64::NAN), five_figures(f64::NEG_INFINITY)], ["NaN", "-inf"]);
    }
}
