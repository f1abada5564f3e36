//! Tables of a sweep in files: stored while they are computed, merged from shards.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fmt::Display;
use std::fs::{File, OpenOptions, remove_file};
use std::io::{ErrorKind, Seek, SeekFrom, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use super::file::{Content, Ending, name, read};
use super::run::{Sweep, SweepCase};
use super::table::{CaseTable, FIRST, Row, first_lines, heading_sum};
use super::tables::row;
use crate::error::{Error, FileFault, Result, SweepError};
use crate::text::check_sum::CheckSum;
use crate::text::file::{make_folder_of, replaced, unwritten};

/// Rows by their cases, each with the file that contains it.
type RowsByCase = BTreeMap<usize, (Row, PathBuf)>;

/// Adds a row to a file, and then to its check sum: a process that is killed in between has not stored the row.
fn append(file: &mut File, row: &str, sum: CheckSum) -> std::io::Result<()> {
    file.seek(SeekFrom::End(0))?;
    file.write_all(row.as_bytes())?;
    file.seek(SeekFrom::Start(FIRST.len() as u64))?;
    file.write_all(sum.text().as_bytes())
}

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
    /// As for [`Sweep::table`]; [`Error::File`] if the file of rows cannot be opened.
    /// [`SweepError::Unwritten`] if a row cannot be written: it holds all computed rows, and no further case
    /// is started. [`Error::File`] if an existing file has other columns, other values of parameters or
    /// cases outside this shard, another version of the format, or if it does not agree with its check sum.
    pub fn table_in<const N: usize, E: Display + Send>(
        &self,
        path: impl AsRef<Path>,
        columns: [&str; N],
        run: impl Fn(&SweepCase<'_>) -> std::result::Result<[f64; N], E> + Sync,
    ) -> Result<CaseTable> {
        let (path, columns) = (path.as_ref(), self.named(&columns)?);
        let part = PathBuf::from([path.as_os_str(), ".part".as_ref()].join("".as_ref()));
        let mut there = RowsByCase::new();
        if path.exists() {
            self.gather(&mut there, path, Some(&columns), Ending::Whole)?;
        }
        let (mut begun, mut sum) = (0, heading_sum(&self.grid, &columns));
        if part.exists() {
            let content = self.gather(&mut there, &part, Some(&columns), Ending::Anywhere)?;
            (begun, sum) = (content.end, content.sum);
        }
        let left: Vec<_> = self.cases().filter(|case| !there.contains_key(case)).collect();
        let mut rows: Vec<_> = there.into_values().map(|(row, _)| row).collect();
        make_folder_of(path)?;
        if !left.is_empty() {
            let open = || {
                let mut options = OpenOptions::new();
                let mut file = options.create(true).truncate(false).write(true).open(&part)?;
                // The row within which a process was killed is deleted.
                file.set_len(begun)?;
                if begun == 0 {
                    file.write_all(first_lines(&self.grid, &columns, sum).as_bytes())?;
                }
                Ok(file)
            };
            let mut file = open().map_err(unwritten(&part))?;
            let mut fault = None;
            self.run_each(left.len(), &|place| left[place], run, |case, result| {
                let row = row(case, result);
                // After a failed write nothing more is written, so that only the last line can be incomplete.
                if fault.is_none() {
                    row.add_to(&self.grid, &mut sum);
                    fault = append(&mut file, &row.csv(&self.grid, &columns), sum).err();
                }
                rows.push(row);
                if fault.is_none() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            });
            if let Some(fault) = fault {
                return Err(self.unwritten(&part, fault.kind(), &self.tabled(columns, rows)));
            }
        }
        let table = self.tabled(columns, rows);
        if !left.is_empty() || part.exists() || !path.exists() {
            if let Err(fault) = replaced(path, table.csv().as_ref()) {
                return Err(self.unwritten(path, fault.kind(), &table));
            }
            // If the file cannot be removed, it contains the same rows as `path`.
            let _ = remove_file(&part);
        }
        Ok(table)
    }

    /// The error for a file that cannot be written, with the rows of `table`.
    fn unwritten(&self, file: &Path, reason: ErrorKind, table: &CaseTable) -> Error {
        let (file, computed) = (name(file), table.rows.len());
        let left = self.cases().len() - computed;
        SweepError::Unwritten { file, reason, computed, left, rows: table.csv().0 }.into()
    }

    /// Combines the files of all shards into the table of all cases.
    ///
    /// The table is equal to the last bit to the table of [`Sweep::table`]. `self` is the sweep that was cut
    /// into shards.
    ///
    /// # Errors
    /// [`Error::File`] for a file that cannot be read, that was cut off, has other columns than the first
    /// one or other values of parameters than this sweep, bit for bit, is of another version of the format, does not
    /// agree with its check sum, or has a case that another file has; [`SweepError::Missing`] for cases in no file.
    pub fn merge(&self, paths: impl IntoIterator<Item = impl AsRef<Path>>) -> Result<CaseTable> {
        let (mut rows, mut columns, mut files) = (RowsByCase::new(), None, 0);
        for path in paths {
            let content =
                self.gather(&mut rows, path.as_ref(), columns.as_deref(), Ending::Whole)?;
            columns.get_or_insert(content.columns);
            files += 1;
        }
        let cases: Vec<_> = self.cases().filter(|case| !rows.contains_key(case)).collect();
        if !cases.is_empty() {
            let places: Vec<_> = cases.iter().filter_map(|&case| self.place(case)).collect();
            let shards = missing_shards(&places, self.cases().len(), files);
            return Err(SweepError::Missing { cases, shards }.into());
        }
        let columns = self.named(&columns.unwrap_or_default())?;
        Ok(self.tabled(columns, rows.into_values().map(|(row, _)| row).collect()))
    }

    /// Adds the rows of a file to `rows`.
    ///
    /// With [`Ending::Anywhere`], a row that is already there may occur again, in a file that was not
    /// removed.
    fn gather(
        &self,
        rows: &mut RowsByCase,
        path: &Path,
        columns: Option<&[String]>,
        ending: Ending,
    ) -> Result<Content> {
        let wanted = |case| self.place(case).is_some();
        let mut content = read(path, &self.grid, &wanted, columns, ending)?;
        for row in content.rows.drain(..) {
            match rows.entry(row.case) {
                Entry::Vacant(entry) => {
                    entry.insert((row, path.to_owned()));
                }
                Entry::Occupied(entry) => {
                    let (before, first) = entry.get();
                    if ending == Ending::Whole || *before != row {
                        let found = format!("here and in {}", name(first));
                        let case = format!("case {}", row.case);
                        let fault = FileFault::value(case, found, "in one place");
                        return Err(fault.of(name(path), 0));
                    }
                }
            }
        }
        Ok(content)
    }
}

/// Largest number of missing shards that an error lists; above, it lists cases.
const MOST_SHARDS: usize = 256;

/// The shards `[index, of]` whose cases are exactly the missing cases of `count`.
///
/// `files` is the number of other shards that are there.
fn missing_shards(missing: &[usize], count: usize, files: usize) -> Vec<[usize; 2]> {
    if files == 0 {
        return Vec::new();
    }
    for of in files + 1..=(files + missing.len().min(MOST_SHARDS)).min(count) {
        // Number of cases of a shard: count / of, or one more.
        let (shards, least) = (of - files, count / of);
        if !(shards * least..=shards * (least + 1)).contains(&missing.len()) {
            continue;
        }
        let mut found = vec![0; of];
        for place in missing {
            found[place % of] += 1;
        }
        let whole = |index: usize| count / of + usize::from(index < count % of);
        if (0..of).all(|index| found[index] == 0 || found[index] == whole(index)) {
            let lost = (0..of).filter(|&index| found[index] > 0);
            let lost: Vec<_> = lost.map(|index| [index, of]).collect();
            if lost.len() == shards {
                return lost;
            }
        }
    }
    Vec::new()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_that_are_missing() {
        let shard = |index: usize, of: usize| (index..10).step_by(of).collect::<Vec<_>>();
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
