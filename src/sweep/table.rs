//! Parameters and results of cases, one row each.

use std::fmt;
use std::sync::Arc;

use super::columns::Columns;
use super::{ERROR, Grid, WARNINGS};
use crate::error::{Error, Result};
use crate::text::check_sum::CheckSum;
use crate::text::column::Cell;
use crate::text::csv::{Csv, csv_line};
use crate::text::line_breaks::in_columns;
use crate::text::readable_number::number;
use crate::text::table::{LONGEST_LINE, Table};

/// The results of a [`Sweep`](super::Sweep), one row for each case.
///
/// A row has the case's number, its parameters, and its results or its error. The table prints with five
/// figures, in lines of at most 99 characters; a wide table breaks into blocks.
///
/// Tables are equal if all their bits are equal; every NaN counts as the same.
#[derive(Debug, Clone)]
pub struct CaseTable {
    pub(super) grid: Arc<Grid>,
    pub(super) columns: Columns,
    /// Rows, ascending by case.
    pub(super) rows: Vec<Row>,
}

/// A case with its results or its error.
#[derive(Debug, Clone)]
pub(super) struct Row {
    pub(super) case: usize,
    pub(super) outcome: std::result::Result<Vec<f64>, String>,
    /// Texts of the run's warnings, empty without any.
    pub(super) warnings: String,
}

impl Row {
    /// Makes a row; a NaN loses its sign and payload, and an empty error text becomes "failed".
    pub(super) fn new(case: usize, outcome: std::result::Result<Vec<f64>, String>) -> Self {
        let clean = |value: f64| if value.is_nan() { f64::NAN } else { value };
        let outcome = match outcome {
            Ok(results) => Ok(results.into_iter().map(clean).collect()),
            Err(reason) if reason.is_empty() => Err("failed".to_owned()),
            Err(reason) => Err(reason),
        };
        Self { case, outcome, warnings: String::new() }
    }

    /// Adds the values of all cells to the check sum of a table.
    pub(super) fn add_to(&self, grid: &Grid, columns: &Columns, sum: &mut CheckSum) {
        sum.add(self.case as u64);
        parameter_cells(grid, self.case).for_each(|cell| sum.add_text(&cell));
        match &self.outcome {
            Ok(results) => sum.add_numbers(results),
            Err(reason) => sum.add_text(reason),
        }
        if columns.with_warnings {
            sum.add_text(&self.warnings);
        }
    }

    /// Writes the row as a line of CSV, with its line end.
    pub(super) fn csv(&self, grid: &Grid, columns: &Columns) -> String {
        let mut cells = vec![self.case.to_string()];
        cells.extend(parameter_cells(grid, self.case));
        match &self.outcome {
            Ok(results) => cells.extend(results.iter().map(|&value| Cell(value).to_string())),
            Err(_) => cells.extend(columns.names.iter().map(|_| String::new())),
        }
        if columns.with_warnings {
            cells.push(self.warnings.clone());
        }
        cells.push(self.outcome.as_ref().err().cloned().unwrap_or_default());
        csv_line(&cells)
    }
}

impl PartialEq for Row {
    fn eq(&self, other: &Self) -> bool {
        let bits = |row: &Self| match &row.outcome {
            Ok(results) => Ok(results.iter().map(|value| value.to_bits()).collect::<Vec<_>>()),
            Err(reason) => Err(reason.clone()),
        };
        self.case == other.case && self.warnings == other.warnings && bits(self) == bits(other)
    }
}

impl PartialEq for CaseTable {
    fn eq(&self, other: &Self) -> bool {
        (&self.grid, &self.columns, &self.rows) == (&other.grid, &other.columns, &other.rows)
    }
}

/// Values of a case's parameters, as text.
pub(super) fn parameter_cells(grid: &Grid, case: usize) -> impl Iterator<Item = String> {
    grid.parameters.iter().enumerate().map(move |(index, parameter)| {
        let place = grid.place_of(case, index);
        let text = || parameter.text(place).unwrap_or_default().to_owned();
        parameter.number(place).map_or_else(text, |value| Cell(value).to_string())
    })
}

/// Headings of all columns.
pub(super) fn heading(grid: &Grid, columns: &Columns) -> Vec<String> {
    let mut cells = vec!["case".to_owned()];
    cells.extend(grid.parameters.iter().map(|parameter| parameter.name().to_owned()));
    cells.extend_from_slice(&columns.names);
    if columns.with_warnings {
        cells.push(WARNINGS.to_owned());
    }
    cells.push(ERROR.to_owned());
    cells
}

/// First line of a table's file, up to its check sum. The number is the version of the format.
pub(super) const FIRST: &str = "# basemat sweep 1 check sum ";

/// Check sum of a table without rows.
pub(super) fn heading_sum(grid: &Grid, columns: &Columns) -> CheckSum {
    let mut sum = CheckSum::default();
    for name in heading(grid, columns) {
        sum.add_text(&name);
    }
    sum
}

/// The first two lines of a table's file.
pub(super) fn first_lines(grid: &Grid, columns: &Columns, sum: CheckSum) -> String {
    format!("{FIRST}{}\n{}", sum.text(), csv_line(&heading(grid, columns)))
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
        let index =
            index.ok_or_else(|| self.table.grid.no_name("column of numbers", column, columns))?;
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
        self.table.grid.place(self.index, parameter)
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
    /// [`CaseFile`](super::CaseFile) has some, and `error`. Numbers, in the caller's units, have enough digits to be read back to the last bit. NaN is an empty cell, infinities are
    /// `inf` and `-inf`. A case that failed has empty results and a text in `error`.
    pub fn csv(&self) -> Csv {
        let mut sum = heading_sum(&self.grid, &self.columns);
        self.rows.iter().for_each(|row| row.add_to(&self.grid, &self.columns, &mut sum));
        let mut text = first_lines(&self.grid, &self.columns, sum);
        text.extend(self.rows.iter().map(|row| row.csv(&self.grid, &self.columns)));
        Csv(text)
    }
}

/// Writes a number with five figures, a whole number in full, the smallest numbers with an exponent.
fn figures(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e15 {
        // Adding zero removes a negative sign of zero.
        format!("{}", value + 0.0)
    } else if value.abs() < 1e-6 {
        format!("{value:.3e}")
    } else {
        number(value)
    }
}

impl fmt::Display for CaseTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = self.columns.names.len();
        let results = Columns::of_results(self.columns.names.clone());
        let mut heading = heading(&self.grid, &results);
        heading.pop();
        let rows = self.rows.iter().map(|row| {
            let mut cells = vec![row.case.to_string()];
            cells.extend(parameter_cells(&self.grid, row.case));
            match &row.outcome {
                Ok(results) => cells.extend(results.iter().map(|&value| figures(value))),
                Err(_) => cells.extend(std::iter::repeat_n("failed".to_owned(), columns)),
            }
            cells
        });
        f.write_str(&Table { heading, repeated: 1, rows: rows.collect() }.text())?;
        let failed = |row: &Row| {
            row.outcome.as_ref().err().map(|reason| format!("case {} failed: {reason}", row.case))
        };
        let warned = |row: &Row| {
            (!row.warnings.is_empty()).then(|| format!("case {} warns: {}", row.case, row.warnings))
        };
        for text in self.rows.iter().flat_map(|row| [failed(row), warned(row)]).flatten() {
            for line in in_columns(&text, LONGEST_LINE) {
                write!(f, "\n{line}")?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_cells() {
        assert_eq!(figures(1e-12), "1.000e-12");
        assert_eq!([-0.0, 3600.0, 0.5, 1.25e20].map(figures), ["0", "3600", "0.50000", "1.250e20"]);
        assert_eq!([figures(f64::NAN), figures(f64::NEG_INFINITY)], ["NaN", "-inf"]);
    }
}
