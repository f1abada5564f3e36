//! A file of a sweep's cases that grows while they run.

use std::fs::{File, OpenOptions, remove_file};
use std::io::{ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::columns::Columns;
use super::file::{Ending, name, read};
use super::gathered::{RowsByCase, gather};
use super::run::Sweep;
use super::table::{CaseTable, FIRST, Row, first_lines, heading_sum};
use super::{Grid, Parameter, check_names};
use crate::error::{Error, Result, SweepError, require_part, same_length};
use crate::text::check_sum::CheckSum;
use crate::text::file::{make_folder_of, replaced, unwritten};

/// A file of a sweep's cases for a program that runs them itself: rows are appended, and a later process continues.
///
/// While cases run, their rows are in the file with `.part` at the end of its name, as for
/// [`Sweep::table_in`](super::Sweep::table_in). A column of results is there once a case has it, and `warnings` if a
/// case has some; a result that a case does not have is NaN. Two processes must not append to the same file.
///
/// ```
/// use basemat::sweep::{Parameter, Sweep};
///
/// let path = std::env::temp_dir().join(format!("basemat_case_file_{}.csv", std::process::id()));
/// let sweep = Sweep::grid([Parameter::numbers("width_m", [4.0, 6.0])])?;
/// let mut file = sweep.open(&path)?;
/// assert_eq!(file.missing(), [0, 1]);
/// file.append(1, &["area_m2"], Ok(vec![36.0]), "too wide")?;
/// drop(file);
///
/// // Another process.
/// let mut file = sweep.open(&path)?;
/// assert_eq!(file.missing(), [0]);
/// file.append(0, &["area_m2"], Ok(vec![16.0]), "")?;
/// let table = file.finish()?;
/// assert!(table.csv().ends_with("\ncase,width_m,area_m2,warnings,error\n0,4.0,16.0,,\n1,6.0,36.0,too wide,\n"));
/// assert_eq!(table.rows().nth(1).map(|row| row.warnings), Some("too wide"));
/// # std::fs::remove_file(path).unwrap();
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct CaseFile {
    grid: Arc<Grid>,
    /// Numbers of the cases of the sweep, ascending.
    cases: Vec<usize>,
    path: PathBuf,
    /// File of the rows while cases are missing.
    part: PathBuf,
    columns: Columns,
    rows: RowsByCase,
    /// `part`, unless all rows were there.
    file: Option<File>,
    /// Check sum of the rows in `part`.
    sum: CheckSum,
    /// Reason why a row was not written; later rows are then not written either.
    fault: Option<ErrorKind>,
}

short_debug! { CaseFile; self; path: self.path, cases: self.cases.len(), rows: self.rows.len() }

impl Sweep<'_> {
    /// Opens the file of this sweep's cases, or begins it.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be read or opened, has other values of parameters or cases outside this shard,
    /// is of another version of the format, or does not agree with its check sum.
    pub fn open(&self, path: impl AsRef<Path>) -> Result<CaseFile> {
        CaseFile::new(self, path.as_ref(), Columns::default(), false)
    }
}

impl CaseFile {
    /// Reads the rows that are there; `are_fixed`: whether existing files must have these `columns`.
    pub(super) fn new(
        sweep: &Sweep<'_>,
        path: &Path,
        columns: Columns,
        are_fixed: bool,
    ) -> Result<Self> {
        let mut part = path.as_os_str().to_owned();
        part.push(".part");
        let mut own = Self {
            grid: sweep.grid.clone(),
            cases: sweep.cases().collect(),
            path: path.to_owned(),
            part: part.into(),
            columns,
            rows: RowsByCase::new(),
            file: None,
            sum: CheckSum::default(),
            fault: None,
        };
        let heading = own.columns.clone();
        if path.exists() {
            own.gather(path, Ending::Whole, are_fixed)?;
        }
        let mut begun = None;
        if own.part.exists() {
            let part = own.part.clone();
            begun = Some(own.gather(&part, Ending::Anywhere { heading: &heading }, are_fixed)?);
        }
        make_folder_of(path)?;
        if !own.missing().is_empty() {
            own.begin(begun).map_err(unwritten(&own.part))?;
        }
        Ok(own)
    }

    /// Takes the rows of a file; returns its columns, its check sum and the end of its last whole row.
    fn gather(
        &mut self,
        path: &Path,
        ending: Ending<'_>,
        are_fixed: bool,
    ) -> Result<(Columns, CheckSum, u64)> {
        let wanted = |case| self.cases.binary_search(&case).is_ok();
        let columns = are_fixed.then_some(&self.columns);
        let content = read(path, &self.grid, &wanted, columns, ending)?;
        self.extend(&content.columns)?;
        let names = &content.columns.names;
        let rows = content.rows.into_iter().map(|row| Row {
            outcome: row.outcome.map(|results| self.columns.arranged(names, results)),
            ..row
        });
        gather(&mut self.rows, rows, path, ending)?;
        Ok((content.columns, content.sum, content.end))
    }

    /// Adds columns; returns whether there are new ones.
    fn extend(&mut self, others: &Columns) -> Result<bool> {
        let mut columns = self.columns.clone();
        let is_new = |name: &&String| !self.columns.names.contains(name);
        columns.names.extend(others.names.iter().filter(is_new).cloned());
        columns.with_warnings |= others.with_warnings;
        let parameters = self.grid.parameters.iter().map(Parameter::name);
        check_names(parameters.chain(columns.names.iter().map(String::as_str)))?;
        if columns == self.columns {
            return Ok(false);
        }
        for (row, _) in self.rows.values_mut() {
            if let Ok(results) = &mut row.outcome {
                results.resize(columns.names.len(), f64::NAN);
            }
        }
        self.columns = columns;
        Ok(true)
    }

    /// Opens the file of rows; `begun`: its columns, its check sum and the end of its rows, if it is there.
    fn begin(&mut self, begun: Option<(Columns, CheckSum, u64)>) -> std::io::Result<()> {
        let Some((columns, sum, end)) = begun.filter(|(.., end)| *end > 0) else {
            return self.begin_anew();
        };
        if columns != self.columns {
            return self.begin_anew();
        }
        let file = OpenOptions::new().write(true).open(&self.part)?;
        // The row within which a process was killed is deleted.
        file.set_len(end)?;
        (self.file, self.sum) = (Some(file), sum);
        Ok(())
    }

    /// Writes the file of rows at once, as when columns are added.
    fn begin_anew(&mut self) -> std::io::Result<()> {
        self.sum = heading_sum(&self.grid, &self.columns);
        let rows = || self.rows.values().map(|(row, _)| row);
        rows().for_each(|row| row.add_to(&self.grid, &self.columns, &mut self.sum));
        let mut text = first_lines(&self.grid, &self.columns, self.sum);
        text.extend(rows().map(|row| row.csv(&self.grid, &self.columns)));
        // An open file could not be replaced everywhere.
        self.file = None;
        replaced(&self.part, text.as_bytes())?;
        self.file = Some(OpenOptions::new().write(true).open(&self.part)?);
        Ok(())
    }

    /// Numbers of the cases without a row, ascending.
    pub fn missing(&self) -> Vec<usize> {
        self.cases.iter().copied().filter(|case| !self.rows.contains_key(case)).collect()
    }

    /// Appends the row of a case: its results under their names, or the text of its error, and its run's warnings.
    ///
    /// A process that is killed later has stored the row.
    ///
    /// # Errors
    /// [`SweepError::Unwritten`] with all rows so far if the row cannot be written; later rows are then refused in the same
    /// way, so that only the last line of the file can be incomplete. [`Error::Scene`] for a case that has a row or does
    /// not belong to the sweep, [`Error::Size`] if the numbers of names and results differ, and [`Error::DuplicateName`]
    /// for a result with the name of another column.
    pub fn append<S: AsRef<str>>(
        &mut self,
        case: usize,
        names: &[S],
        outcome: std::result::Result<Vec<f64>, String>,
        warnings: &str,
    ) -> Result<()> {
        let names: Vec<_> = names.iter().map(|name| name.as_ref().to_owned()).collect();
        let is_new = self.cases.binary_search(&case).is_ok() && !self.rows.contains_key(&case);
        require_part("case", is_new, "it must belong to the sweep and have no row")?;
        if let Ok(results) = &outcome {
            same_length("list of results of a case", results.len(), names.len())?;
        }
        let columns = Columns { names, with_warnings: !warnings.is_empty() };
        if self.extend(&columns)? && self.fault.is_none() {
            self.fault = self.begin_anew().err().map(|fault| fault.kind());
        }
        let outcome = outcome.map(|results| self.columns.arranged(&columns.names, results));
        let row = Row { warnings: warnings.to_owned(), ..Row::new(case, outcome) };
        self.append_row(row)
    }

    /// [`CaseFile::append`] for a row with these columns.
    pub(super) fn append_row(&mut self, row: Row) -> Result<()> {
        let text = row.csv(&self.grid, &self.columns);
        row.add_to(&self.grid, &self.columns, &mut self.sum);
        self.rows.insert(row.case, (row, self.part.clone()));
        if let (Some(file), None) = (&mut self.file, self.fault) {
            self.fault = append(file, &text, self.sum).err().map(|fault| fault.kind());
        }
        self.fault.map_or(Ok(()), |reason| Err(self.unwritten(&self.part, reason)))
    }

    /// The rows so far.
    pub fn table(&self) -> CaseTable {
        let rows = self.rows.values().map(|(row, _)| row.clone()).collect();
        CaseTable { grid: self.grid.clone(), columns: self.columns.clone(), rows }
    }

    /// Writes the whole file at once, removes the file of rows, and returns the table.
    ///
    /// A file that was whole before is left as it is.
    ///
    /// # Errors
    /// [`SweepError::Missing`] if a case has no row; [`SweepError::Unwritten`] if the file cannot be written.
    pub fn finish(mut self) -> Result<CaseTable> {
        let cases = self.missing();
        if !cases.is_empty() {
            return Err(SweepError::Missing { cases, shards: Vec::new() }.into());
        }
        let table = self.table();
        let is_open = self.file.take().is_some();
        if is_open || self.part.exists() || !self.path.exists() {
            replaced(&self.path, table.csv().as_ref())
                .map_err(|fault| self.unwritten(&self.path, fault.kind()))?;
            // If the file cannot be removed, it contains the same rows as the whole file.
            let _ = remove_file(&self.part);
        }
        Ok(table)
    }

    /// The error for a file that cannot be written, with the rows so far.
    fn unwritten(&self, file: &Path, reason: ErrorKind) -> Error {
        let (file, computed, left) = (name(file), self.rows.len(), self.missing().len());
        SweepError::Unwritten { file, reason, computed, left, rows: self.table().csv().0 }.into()
    }
}

/// Adds a row to a file, and then to its check sum: a process that is killed in between has not stored the row.
fn append(file: &mut File, row: &str, sum: CheckSum) -> std::io::Result<()> {
    file.seek(SeekFrom::End(0))?;
    file.write_all(row.as_bytes())?;
    file.seek(SeekFrom::Start(FIRST.len() as u64))?;
    file.write_all(sum.text().as_bytes())
}
