//! Rows of several files, each case once.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};

use super::file::{Ending, name};
use super::table::Row;
use crate::error::{FileFault, Result};

/// Rows by their cases, each with the file that contains it.
pub(super) type RowsByCase = BTreeMap<usize, (Row, PathBuf)>;

/// Adds the rows of a file to `gathered`.
///
/// Of a file that ends anywhere, a row that is already there may occur again: the file was not removed.
pub(super) fn gather(
    gathered: &mut RowsByCase,
    rows: impl IntoIterator<Item = Row>,
    path: &Path,
    ending: Ending<'_>,
) -> Result<()> {
    for row in rows {
        match gathered.entry(row.case) {
            Entry::Vacant(entry) => {
                entry.insert((row, path.to_owned()));
            }
            Entry::Occupied(entry) => {
                let (before, first) = entry.get();
                if ending == Ending::Whole || *before != row {
                    let found = format!("here and in {}", name(first));
                    let case = format!("case {}", row.case);
                    return Err(FileFault::value(case, found, "in one place").of(name(path), 0));
                }
            }
        }
    }
    Ok(())
}
