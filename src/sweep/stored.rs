//! Tables of a sweep in files: stored while they are computed, merged from shards.

use std::fmt::Display;
use std::ops::ControlFlow;
use std::path::Path;

use super::case_file::{CaseFile, FileColumns};
use super::file::{Ending, RowsByCase, add_rows, path_text, read_file};
use super::run::{Sweep, SweepCase, table_row};
use super::table::{CaseTable, Columns};
use crate::error::{FileFault, Result, SweepError};

impl Sweep<'_> {
    /// Runs a [`Sweep::table`] and stores its rows in a file, so that it can be restarted.
    ///
    /// A process that was killed and started again continues where it stopped; if the table is complete, it
    /// is only read.
    ///
    /// While cases run, their rows are in a file whose name is `path` with `.part` at its end. When it has all rows,
    /// `path` itself is written at once and the other file removed. Cases with a row in either file are not run again,
    /// nor are failed cases. To run a case again, delete its row and the check sum in the first line of `path`. After a
    /// change of the computation itself, delete both files. Two processes must not use the same file. Progress
    /// ([`Sweep::on_progress`]) counts the cases that run, not the rows that are read.
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
        let result_columns = Columns::of_results(self.checked_columns(&columns)?);
        let mut file = CaseFile::new(self, path.as_ref(), result_columns, FileColumns::MustBeSame)?;
        let missing_cases = file.missing();
        let mut write_error = None;
        self.run_each(
            missing_cases.len(),
            &|position| missing_cases[position],
            run,
            |case, result| {
                // After a failed write, the rows of cases that still run are stored in memory only.
                write_error = file.append_row(table_row(case, result)).err();
                if write_error.is_none() {
                    ControlFlow::Continue(())
                } else {
                    ControlFlow::Break(())
                }
            },
        );
        write_error.map_or_else(|| file.finish(), Err)
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
        let is_of_sweep = |case| self.position(case).is_some();
        for path in paths {
            let path = path.as_ref();
            let content =
                read_file(path, &self.grid, &is_of_sweep, columns.as_ref(), Ending::Whole)?;
            add_rows(&mut rows, content.rows, path, Ending::Whole)?;
            file_count += 1;
            with_warnings |= content.columns.with_warnings;
            if !content.columns.names.is_empty() {
                columns.get_or_insert(content.columns);
            }
        }
        let missing_cases: Vec<_> = self.cases().filter(|case| !rows.contains_key(case)).collect();
        if !missing_cases.is_empty() {
            let missing_positions: Vec<_> =
                missing_cases.iter().filter_map(|&case| self.position(case)).collect();
            let shards = missing_shards(&missing_positions, self.cases().len(), file_count);
            return Err(SweepError::Missing { cases: missing_cases, shards }.into());
        }
        let merged_columns = Columns { with_warnings, ..columns.unwrap_or_default() };
        self.checked_columns(&merged_columns.names)?;
        // Without names of results all cases of a file must have failed.
        for stored in rows.values() {
            let row = &stored.row;
            let result_count = row.outcome.as_ref().map_or(merged_columns.names.len(), Vec::len);
            if result_count != merged_columns.names.len() {
                let results = format!("results of case {}", row.case);
                let needed = merged_columns.names.len().to_string();
                return Err(
                    FileFault::count(&results, result_count, needed).of(path_text(&stored.path), 0)
                );
            }
        }
        let rows = rows.into_values().map(|stored| stored.row).collect();
        Ok(CaseTable { grid: self.grid.clone(), columns: merged_columns, rows })
    }
}

/// Largest number of missing shards that an error lists; for more shards it lists cases.
const MAX_LISTED_SHARDS: usize = 256;

/// The shards `[index, shard_count]` whose cases are exactly the missing ones, if there are such.
///
/// `missing_positions`: positions of the missing cases among all `case_count` cases. `file_count`: number of files, which
/// have the other shards.
fn missing_shards(
    missing_positions: &[usize],
    case_count: usize,
    file_count: usize,
) -> Vec<[usize; 2]> {
    if file_count == 0 {
        return Vec::new();
    }
    let max_shard_count =
        (file_count + missing_positions.len().min(MAX_LISTED_SHARDS)).min(case_count);
    for shard_count in file_count + 1..=max_shard_count {
        let missing_shard_count = shard_count - file_count;
        let min_case_count = missing_shard_count * (case_count / shard_count);
        if !(min_case_count..=min_case_count + missing_shard_count)
            .contains(&missing_positions.len())
        {
            continue;
        }
        let mut missing_counts = vec![0; shard_count];
        for position in missing_positions {
            missing_counts[position % shard_count] += 1;
        }
        let mut shards = Vec::new();
        let mut are_complete = true;
        for (index, &missing_in_shard) in missing_counts.iter().enumerate() {
            if missing_in_shard > 0 {
                shards.push([index, shard_count]);
                are_complete &=
                    missing_in_shard == shard_case_count(index, shard_count, case_count);
            }
        }
        if are_complete && shards.len() == missing_shard_count {
            return shards;
        }
    }
    Vec::new()
}

/// Number of cases of a shard: the quotient of both counts, or one more.
fn shard_case_count(index: usize, shard_count: usize, case_count: usize) -> usize {
    case_count / shard_count + usize::from(index < case_count % shard_count)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cases of a shard of ten cases.
    fn shard(index: usize, shard_count: usize) -> Vec<usize> {
        (index..10).step_by(shard_count).collect()
    }

    #[test]
    fn shards_that_are_missing() {
        assert_eq!(missing_shards(&shard(1, 4), 10, 3), [[1, 4]]);
        let mut missing_positions = [shard(0, 4), shard(3, 4)].concat();
        missing_positions.sort_unstable();
        assert_eq!(missing_shards(&missing_positions, 10, 2), [[0, 4], [3, 4]]);
        // One case more, one case less, and no files.
        assert!(missing_shards(&[1, 2, 5, 9], 10, 3).is_empty());
        assert!(missing_shards(&[1, 5], 10, 3).is_empty());
        assert!(missing_shards(&(0..10).collect::<Vec<_>>(), 10, 0).is_empty());
    }
}
