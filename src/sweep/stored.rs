//! Tables of a sweep in files: stored while they are computed, merged from shards.

use std::fmt::Display;
use std::ops::ControlFlow;
use std::path::Path;

use super::case_file::CaseFile;
use super::file::{Ending, RowsByCase, add_rows, name, read};
use super::run::{Sweep, SweepCase, table_row};
use super::table::{CaseTable, Columns};
use crate::error::{FileFault, Result, SweepError};

impl Sweep<'_> {
    /// Runs a [`Sweep::table`] and stores its rows in a file, so that it can be restarted.
    ///
    /// A process that was killed and started again continues where it stopped; if the table is complete, it
    /// is only read.
    ///
    /// While cases run, their rows are in the file `path` with `.part` at its end. When all rows are there,
    /// `path` itself is written at once and the other file removed. Cases with a row in either file are not
    /// run again, nor are failed cases. To run a case again, delete its row and the check sum in the first line of
    /// `path`. After a change of the computation itself, delete both files. Two processes must not use the same
    /// file. Progress ([`Sweep::on_progress`]) counts the cases that run, not the rows that are read.
    ///
    /// # Errors
    /// As for [`Sweep::table`]; [`Error::File`](crate::Error::File) if the file of rows cannot be opened.
    /// [`SweepError::Unwritten`] if a row cannot be written: it holds all computed rows, and no further case
    /// is started. [`Error::File`](crate::Error::File) if an existing file has other columns, other values of parameters or
    /// cases outside this shard, another version of the format, or if it does not agree with its check sum.
    pub fn table_in<const N: usize, E: Display + Send>(
        &self,
        path: impl AsRef<Path>,
        columns: [&str; N],
        run: impl Fn(&SweepCase<'_>) -> std::result::Result<[f64; N], E> + Sync,
    ) -> Result<CaseTable> {
        let columns = Columns::of_results(self.checked_columns(&columns)?);
        let mut file = CaseFile::new(self, path.as_ref(), columns, true)?;
        let missing = file.missing();
        let mut fault = None;
        self.run_each(missing.len(), &|place| missing[place], run, |case, result| {
            // After a failed write the file only collects the rows of the cases that still run.
            fault = file.append_row(table_row(case, result)).err();
            if fault.is_none() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        fault.map_or_else(|| file.finish(), Err)
    }

    /// Combines the files of all shards into the table of all cases.
    ///
    /// The table is equal to the last bit to the table of [`Sweep::table`]. `self` is the sweep that was cut
    /// into shards.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) for a file that cannot be read, that was cut off, has other columns than the first
    /// one (a file whose cases all failed may have no names of results) or other values of parameters than this sweep, bit
    /// for bit, is of another version of the format, does not agree with its check sum, or has a case that another file
    /// has; [`SweepError::Missing`] for cases in no file.
    pub fn merge(&self, paths: impl IntoIterator<Item = impl AsRef<Path>>) -> Result<CaseTable> {
        let mut rows = RowsByCase::new();
        let mut columns: Option<Columns> = None;
        let mut file_count = 0;
        let mut with_warnings = false;
        let wanted = |case| self.place(case).is_some();
        for path in paths {
            let path = path.as_ref();
            let content = read(path, &self.grid, &wanted, columns.as_ref(), Ending::Whole)?;
            add_rows(&mut rows, content.rows, path, Ending::Whole)?;
            file_count += 1;
            with_warnings |= content.columns.with_warnings;
            if !content.columns.names.is_empty() {
                columns.get_or_insert(content.columns);
            }
        }
        let cases: Vec<_> = self.cases().filter(|case| !rows.contains_key(case)).collect();
        if !cases.is_empty() {
            let places: Vec<_> = cases.iter().filter_map(|&case| self.place(case)).collect();
            let shards = missing_shards(&places, self.cases().len(), file_count);
            return Err(SweepError::Missing { cases, shards }.into());
        }
        let columns = Columns { with_warnings, ..columns.unwrap_or_default() };
        self.checked_columns(&columns.names)?;
        // Without names of results all cases of a file must have failed.
        for stored in rows.values() {
            let row = &stored.row;
            let count = row.outcome.as_ref().map_or(columns.names.len(), Vec::len);
            if count != columns.names.len() {
                let results = format!("results of case {}", row.case);
                let needed = columns.names.len().to_string();
                return Err(FileFault::count(&results, count, needed).of(name(&stored.path), 0));
            }
        }
        let rows = rows.into_values().map(|stored| stored.row).collect();
        Ok(CaseTable { grid: self.grid.clone(), columns, rows })
    }
}

/// Largest number of missing shards that an error lists; above, it lists cases.
const MAX_LISTED_SHARDS: usize = 256;

/// The shards `[index, of]` whose cases are exactly the missing cases of `count`.
///
/// `files`: number of other shards that are there.
fn missing_shards(missing: &[usize], count: usize, files: usize) -> Vec<[usize; 2]> {
    if files == 0 {
        return Vec::new();
    }
    let max_shards = (files + missing.len().min(MAX_LISTED_SHARDS)).min(count);
    for of in files + 1..=max_shards {
        let missing_count = of - files;
        let min_cases = missing_count * (count / of);
        if !(min_cases..=min_cases + missing_count).contains(&missing.len()) {
            continue;
        }
        let mut missing_cases = vec![0; of];
        for place in missing {
            missing_cases[place % of] += 1;
        }
        let mut shards = Vec::new();
        let mut are_whole = true;
        for (index, &cases) in missing_cases.iter().enumerate() {
            if cases > 0 {
                shards.push([index, of]);
                are_whole &= cases == shard_cases(index, of, count);
            }
        }
        if are_whole && shards.len() == missing_count {
            return shards;
        }
    }
    Vec::new()
}

/// Number of cases of a shard: count / of, or one more.
fn shard_cases(index: usize, of: usize, count: usize) -> usize {
    count / of + usize::from(index < count % of)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cases of a shard of ten cases.
    fn shard(index: usize, of: usize) -> Vec<usize> {
        (index..10).step_by(of).collect()
    }

    #[test]
    fn shards_that_are_missing() {
        assert_eq!(missing_shards(&shard(1, 4), 10, 3), [[1, 4]]);
        let mut two = [shard(0, 4), shard(3, 4)].concat();
        two.sort_unstable();
        assert_eq!(missing_shards(&two, 10, 2), [[0, 4], [3, 4]]);
        // One case more, one case less, and no files.
        assert!(missing_shards(&[1, 2, 5, 9], 10, 3).is_empty());
        assert!(missing_shards(&[1, 5], 10, 3).is_empty());
        assert!(missing_shards(&(0..10).collect::<Vec<_>>(), 10, 0).is_empty());
    }
}
