//! Tables of a sweep: computed, stored in a file while they are computed, merged from shards.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fmt::Display;
use std::fs::{OpenOptions, remove_file};
use std::io::{ErrorKind, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use super::file::{Content, Ending, read};
use super::run::{Sweep, SweepCase};
use super::table::{CaseTable, Row, heading, name};
use super::{Parameter, check_names};
use crate::error::{CaseError, Error, FileFault, Result, SweepError, same_length};
use crate::text::csv::csv_line;
use crate::text::file::{make_folder_of, replaced, unwritten};

/// Rows by their cases, each with the file that contains it.
type Rows = BTreeMap<usize, (Row, PathBuf)>;

/// Row of a case from its result.
fn row<const N: usize, E: Display>(
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
    /// assert!(table.csv().starts_with("case,width_m,area_m2,error,check\n0,4.0,16.0,,"));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// Errors of cases are not returned. [`Error::DuplicateName`](crate::Error::DuplicateName) if two columns
    /// (parameters, `case`, `error` and `check` among them) have the same name, [`Error::Scene`] if
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

    /// Runs a [`Sweep::table`] and stores its rows in a file, so that it can be restarted.
    ///
    /// A process that was killed and started again continues where it stopped; if the table is complete, it
    /// is only read.
    ///
    /// While cases run, their rows are in the file `path` with `.part` at its end. When all rows are there,
    /// `path` itself is written at once and the other file removed. Cases with a row in either file are not
    /// run again, nor are failed cases. To run a case again, delete its row. After a change of the
    /// computation itself, delete both files. Two processes must not use the same file. Progress
    /// ([`Sweep::on_progress`]) counts the cases that run, not the rows that are read.
    ///
    /// # Errors
    /// As for [`Sweep::table`]; [`Error::File`] if the file of rows cannot be opened.
    /// [`SweepError::Unwritten`] if a row cannot be written: it holds all computed rows, and no further case
    /// is started. [`Error::File`] if an existing file has other columns, other values of parameters or
    /// cases outside this shard, or if a row does not agree with its check sum.
    pub fn table_in<const N: usize, E: Display + Send>(
        &self,
        path: impl AsRef<Path>,
        columns: [&str; N],
        run: impl Fn(&SweepCase<'_>) -> std::result::Result<[f64; N], E> + Sync,
    ) -> Result<CaseTable> {
        let (path, columns) = (path.as_ref(), self.named(&columns)?);
        let part = PathBuf::from([path.as_os_str(), ".part".as_ref()].join("".as_ref()));
        let mut there = Rows::new();
        if path.exists() {
            self.gather(&mut there, path, Some(&columns), Ending::Whole)?;
        }
        let mut begun = 0;
        if part.exists() {
            begun = self.gather(&mut there, &part, Some(&columns), Ending::Anywhere)?.end;
        }
        let left: Vec<_> = self.cases().filter(|case| !there.contains_key(case)).collect();
        let mut rows: Vec<_> = there.into_values().map(|(row, _)| row).collect();
        make_folder_of(path)?;
        if !left.is_empty() {
            let open = || {
                let mut file = OpenOptions::new().create(true).append(true).open(&part)?;
                // The line within which a process was killed is deleted.
                file.set_len(begun)?;
                if begun == 0 {
                    file.write_all(csv_line(&heading(&self.grid, &columns)).as_bytes())?;
                }
                Ok(file)
            };
            let mut file = open().map_err(unwritten(&part))?;
            let mut fault = None;
            self.run_each(left.len(), &|place| left[place], run, |case, result| {
                let row = row(case, result);
                // After a failed write nothing more is written, so that only the last line can be incomplete.
                if fault.is_none() {
                    fault = file.write_all(row.csv(&self.grid, &columns).as_bytes()).err();
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
    /// one or other values of parameters than this sweep, bit for bit, or has a row that does not agree with
    /// its check sum, or has a case that another file has; [`SweepError::Missing`] for cases in no file.
    pub fn merge(&self, paths: impl IntoIterator<Item = impl AsRef<Path>>) -> Result<CaseTable> {
        let (mut rows, mut columns, mut files) = (Rows::new(), None, 0);
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

    /// Table of cases that another program ran.
    ///
    /// `columns` are the names of the results. `outcomes` has for each case of [`Sweep::cases`] its results
    /// or the text of its error.
    ///
    /// # Errors
    /// [`Error::Size`] if the number of outcomes differs from the number of cases, or the number of results
    /// from the number of columns; the errors of [`Sweep::table`].
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
    fn named<S: AsRef<str>>(&self, columns: &[S]) -> Result<Vec<String>> {
        let own = || columns.iter().map(AsRef::as_ref);
        check_names(self.grid.parameters.iter().map(Parameter::name).chain(own()))?;
        Ok(own().map(str::to_owned).collect())
    }

    fn tabled(&self, columns: Vec<String>, mut rows: Vec<Row>) -> CaseTable {
        rows.sort_unstable_by_key(|row| row.case);
        CaseTable { grid: self.grid.clone(), columns, rows }
    }

    /// Adds the rows of a file to `rows`.
    ///
    /// With [`Ending::Anywhere`], a row that is already there may occur again, in a file that was not
    /// removed.
    fn gather(
        &self,
        rows: &mut Rows,
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
