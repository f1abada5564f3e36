//! A file of a sweep's cases that grows while they run.

use std::fs::{File, OpenOptions, remove_file};
use std::io::{ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::file::{Ending, RowsByCase, StoredRow, add_rows, path_text, read_file};
use super::run::Sweep;
use super::table::{CaseTable, Columns, FILE_BEGINNING, TableRow, first_lines, heading_check_sum};
use super::{CaseGrid, Parameter, check_names};
use crate::error::{Error, Result, SweepError, require_part, same_length};
use crate::text::check_sum::CheckSum;
use crate::text::file::{make_folder_of, replace_file, write_error};

/// A file of a sweep's cases, to which a program appends rows and from which a later process continues.
///
/// While cases run, their rows are in the file with `.part` at the end of its name, as for
/// [`Sweep::table_in`](super::Sweep::table_in). The file has a column for each result of any case, and a column
/// `warnings` if any case has warnings. A result that a case does not have is NaN. Two processes must not append to the
/// same file.
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
    /// Combinations of the sweep's parameters.
    grid: Arc<CaseGrid>,
    /// Indices of the cases of the sweep, ascending.
    cases: Vec<usize>,
    /// Path of the complete file.
    path: PathBuf,
    /// File of the rows while cases are missing, with `.part` at the end of its name.
    part_path: PathBuf,
    /// Columns of results and warnings so far.
    columns: Columns,
    /// Rows so far.
    rows: RowsByCase,
    /// The open file at `part_path`; `None` if no row was missing.
    part_file: Option<File>,
    /// Check sum of the rows in that file.
    check_sum: CheckSum,
    /// Reason for which a row was not written; later rows are then not written either.
    write_fault: Option<ErrorKind>,
}

/// Columns that existing files of a sweep may have.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum FileColumns {
    /// The columns of the present table.
    MustBeSame,
    /// Any columns; new ones are added.
    MayDiffer,
}

/// An existing file of rows, as it was read.
struct StartedFile {
    columns: Columns,
    check_sum: CheckSum,
    /// Number of bytes up to the end of its last complete row.
    end_byte: u64,
}

short_debug! { CaseFile; self; path: self.path, cases: self.cases.len(), rows: self.rows.len() }

impl Sweep<'_> {
    /// Opens the file of this sweep's cases, or begins it.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be read or opened, has other values of parameters or cases outside this shard,
    /// is of another version of the format, or does not agree with its check sum.
    pub fn open(&self, path: impl AsRef<Path>) -> Result<CaseFile> {
        CaseFile::new(self, path.as_ref(), Columns::default(), FileColumns::MayDiffer)
    }
}

impl CaseFile {
    /// Reads the rows of existing files, and opens the file of rows if a case has none.
    pub(super) fn new(
        sweep: &Sweep<'_>,
        path: &Path,
        columns: Columns,
        file_columns: FileColumns,
    ) -> Result<Self> {
        let mut part_path = path.as_os_str().to_owned();
        part_path.push(".part");
        let mut case_file = Self {
            grid: sweep.grid.clone(),
            cases: sweep.cases().collect(),
            path: path.to_owned(),
            part_path: part_path.into(),
            columns,
            rows: RowsByCase::new(),
            part_file: None,
            check_sum: CheckSum::default(),
            write_fault: None,
        };
        let first_heading = case_file.columns.clone();
        if path.exists() {
            case_file.read_rows(path, Ending::Whole, file_columns)?;
        }
        let mut started_file = None;
        if case_file.part_path.exists() {
            let part_path = case_file.part_path.clone();
            let ending = Ending::Anywhere { heading: &first_heading };
            started_file = Some(case_file.read_rows(&part_path, ending, file_columns)?);
        }
        make_folder_of(path)?;
        if !case_file.missing().is_empty() {
            case_file.open_part(started_file).map_err(write_error(&case_file.part_path))?;
        }
        Ok(case_file)
    }

    /// Adds the rows and columns of an existing file.
    fn read_rows(
        &mut self,
        path: &Path,
        ending: Ending<'_>,
        file_columns: FileColumns,
    ) -> Result<StartedFile> {
        let is_of_sweep = |case| self.cases.binary_search(&case).is_ok();
        let must_be_same = file_columns == FileColumns::MustBeSame;
        let columns = must_be_same.then_some(&self.columns);
        let content = read_file(path, &self.grid, &is_of_sweep, columns, ending)?;
        self.extend_columns(&content.columns)?;
        let names = &content.columns.names;
        let rows = content.rows.into_iter().map(|row| TableRow {
            outcome: row.outcome.map(|results| self.columns.arranged(names, results)),
            ..row
        });
        add_rows(&mut self.rows, rows, path, ending)?;
        Ok(StartedFile {
            columns: content.columns,
            check_sum: content.check_sum,
            end_byte: content.end_byte,
        })
    }

    /// Adds the missing columns; returns whether a column was missing.
    fn extend_columns(&mut self, new_columns: &Columns) -> Result<bool> {
        let mut all_columns = self.columns.clone();
        for name in &new_columns.names {
            if !self.columns.names.contains(name) {
                all_columns.names.push(name.clone());
            }
        }
        all_columns.with_warnings |= new_columns.with_warnings;
        let parameters = self.grid.parameters.iter().map(Parameter::name);
        check_names(parameters.chain(all_columns.names.iter().map(String::as_str)))?;
        if all_columns == self.columns {
            return Ok(false);
        }
        for stored in self.rows.values_mut() {
            if let Ok(results) = &mut stored.row.outcome {
                results.resize(all_columns.names.len(), f64::NAN);
            }
        }
        self.columns = all_columns;
        Ok(true)
    }

    /// Opens the file of rows, or begins it.
    ///
    /// `started_file`: the file as it was read, if it exists.
    fn open_part(&mut self, started_file: Option<StartedFile>) -> std::io::Result<()> {
        let Some(started_file) = started_file.filter(|started_file| started_file.end_byte > 0)
        else {
            return self.rewrite_part();
        };
        if started_file.columns != self.columns {
            return self.rewrite_part();
        }
        let file = OpenOptions::new().write(true).open(&self.part_path)?;
        // The last row is removed if a process was killed while it wrote the row.
        file.set_len(started_file.end_byte)?;
        self.part_file = Some(file);
        self.check_sum = started_file.check_sum;
        Ok(())
    }

    /// Writes the file of rows at once, as when columns are added.
    fn rewrite_part(&mut self) -> std::io::Result<()> {
        self.check_sum = heading_check_sum(&self.grid, &self.columns);
        let mut lines = Vec::new();
        for stored in self.rows.values() {
            stored.row.add_to_check_sum(&self.grid, &self.columns, &mut self.check_sum);
            lines.push(stored.row.csv(&self.grid, &self.columns));
        }
        let text = first_lines(&self.grid, &self.columns, self.check_sum) + &lines.concat();
        // Some systems cannot replace an open file.
        self.part_file = None;
        replace_file(&self.part_path, text.as_bytes())?;
        self.part_file = Some(OpenOptions::new().write(true).open(&self.part_path)?);
        Ok(())
    }

    /// Numbers of the cases without a row, ascending.
    pub fn missing(&self) -> Vec<usize> {
        self.cases.iter().copied().filter(|case| !self.rows.contains_key(case)).collect()
    }

    /// Appends the row of a case: its results under their names, or the text of its error, and its run's warnings.
    ///
    /// After the call the row is in the file, even if the process is killed.
    ///
    /// # Errors
    /// [`SweepError::Unwritten`] with all rows so far if the row cannot be written; later rows then fail in the same
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
        let is_missing = self.cases.binary_search(&case).is_ok() && !self.rows.contains_key(&case);
        require_part("case", is_missing, "it must belong to the sweep and have no row")?;
        if let Ok(results) = &outcome {
            same_length("list of results of a case", results.len(), names.len())?;
        }
        let columns = Columns { names, with_warnings: !warnings.is_empty() };
        if self.extend_columns(&columns)? && self.write_fault.is_none() {
            self.write_fault = self.rewrite_part().err().map(|fault| fault.kind());
        }
        let outcome = outcome.map(|results| self.columns.arranged(&columns.names, results));
        let row = TableRow { warnings: warnings.to_owned(), ..TableRow::new(case, outcome) };
        self.append_row(row)
    }

    /// [`CaseFile::append`] for a row with these columns.
    pub(super) fn append_row(&mut self, row: TableRow) -> Result<()> {
        let row_text = row.csv(&self.grid, &self.columns);
        row.add_to_check_sum(&self.grid, &self.columns, &mut self.check_sum);
        let path = self.part_path.clone();
        self.rows.insert(row.case, StoredRow { row, path });
        if self.write_fault.is_none()
            && let Some(file) = &mut self.part_file
        {
            self.write_fault =
                append_text(file, &row_text, self.check_sum).err().map(|fault| fault.kind());
        }
        self.write_fault
            .map_or(Ok(()), |reason| Err(self.unwritten_error(&self.part_path, reason)))
    }

    /// The rows so far.
    pub fn table(&self) -> CaseTable {
        let rows = self.rows.values().map(|stored| stored.row.clone()).collect();
        CaseTable { grid: self.grid.clone(), columns: self.columns.clone(), rows }
    }

    /// Writes the whole file at once, removes the file of rows, and returns the table.
    ///
    /// A file that was already complete stays unchanged.
    ///
    /// # Errors
    /// [`SweepError::Missing`] if a case has no row; [`SweepError::Unwritten`] if the file cannot be written.
    pub fn finish(mut self) -> Result<CaseTable> {
        let cases = self.missing();
        if !cases.is_empty() {
            return Err(SweepError::Missing { cases, shards: Vec::new() }.into());
        }
        let table = self.table();
        let is_open = self.part_file.take().is_some();
        if is_open || self.part_path.exists() || !self.path.exists() {
            replace_file(&self.path, table.csv().as_ref())
                .map_err(|fault| self.unwritten_error(&self.path, fault.kind()))?;
            // If the file cannot be removed, it contains the same rows as the whole file.
            let _ = remove_file(&self.part_path);
        }
        Ok(table)
    }

    /// The error for a file that cannot be written, with the rows so far.
    fn unwritten_error(&self, file: &Path, reason: ErrorKind) -> Error {
        let error = SweepError::Unwritten {
            file: path_text(file),
            reason,
            computed: self.rows.len(),
            left: self.missing().len(),
            rows: self.table().csv().0,
        };
        error.into()
    }
}

/// Appends a row to a file, and then updates the check sum.
///
/// The row does not count if the process is killed between both writes.
fn append_text(file: &mut File, row: &str, check_sum: CheckSum) -> std::io::Result<()> {
    file.seek(SeekFrom::End(0))?;
    file.write_all(row.as_bytes())?;
    file.seek(SeekFrom::Start(FILE_BEGINNING.len() as u64))?;
    file.write_all(check_sum.text().as_bytes())
}
