//! Files of cases: a line with format and check sum, a heading, and a row for each case.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};

use csv::{ReaderBuilder, StringRecord};

use super::table::{
    Columns, FILE_BEGINNING, TableRow, first_lines, heading, heading_sum, parameter_cells,
};
use super::{CaseGrid, ERROR_COLUMN, WARNINGS_COLUMN};
use crate::error::{FileFault, Result};
use crate::text::bounded_line::LineResult;
use crate::text::check_sum::CheckSum;
use crate::text::decimal::{excerpt, quoted};

/// Columns and rows of a file, in the file's order.
pub(super) struct FileContent {
    pub(super) columns: Columns,
    pub(super) rows: Vec<TableRow>,
    /// Check sum of these rows.
    pub(super) sum: CheckSum,
    /// Number of bytes up to the end of the last of these rows.
    pub(super) end: u64,
}

/// Where a file may end.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Ending<'a> {
    /// The file ends with the last row of its check sum, as a file that was written to its end.
    Whole,
    /// The file ends anywhere, as when the process was killed: behind the rows of its check sum, or within the
    /// `heading` with which it was begun.
    Anywhere { heading: &'a Columns },
}

/// The path as text.
pub(super) fn name(path: &Path) -> String {
    path.display().to_string()
}

/// Reads a file with rows of `grid`; an error for cases that are not `wanted`.
///
/// `columns`: the columns of results, if they are known. A file whose cases all failed may have no names of results.
pub(super) fn read(
    path: &Path,
    grid: &CaseGrid,
    wanted: &dyn Fn(usize) -> bool,
    columns: Option<&Columns>,
    ending: Ending<'_>,
) -> Result<FileContent> {
    let bytes = std::fs::read(path)
        .map_err(|error| FileFault::Unreadable(error.kind()).of(name(path), 0))?;
    if let Ending::Anywhere { heading } = ending {
        let sum = heading_sum(grid, heading);
        if first_lines(grid, heading, sum).as_bytes().starts_with(&bytes) {
            // The process was killed before the whole heading was written.
            return Ok(FileContent { columns: heading.clone(), rows: vec![], sum, end: 0 });
        }
    }
    read_lines(&bytes, grid, wanted, columns, ending)
        .map_err(|(line, fault)| fault.of(name(path), line))
}

/// A part of a file that agrees with its check sum.
struct IntactPart {
    sum: CheckSum,
    /// Number of rows.
    rows: usize,
    /// Number of bytes up to its end.
    end: u64,
}

/// Reads the content of a file whose heading is complete.
fn read_lines(
    bytes: &[u8],
    grid: &CaseGrid,
    wanted: &dyn Fn(usize) -> bool,
    columns: Option<&Columns>,
    ending: Ending<'_>,
) -> LineResult<FileContent> {
    // A byte-order mark is skipped.
    let text = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    let first_line = text.split_inclusive(|&byte| byte == b'\n').next().unwrap_or_default();
    let stored_sum = stored_sum(first_line, ending)?;
    let start = bytes.len() - text.len() + first_line.len();
    let mut reader =
        ReaderBuilder::new().has_headers(false).flexible(true).from_reader(&bytes[start..]);
    let mut file_columns: Option<Columns> = None;
    let mut rows = Vec::new();
    let mut sum = CheckSum::default();
    let mut longest_intact: Option<IntactPart> = None;
    let mut record = StringRecord::new();
    loop {
        let line = usize::try_from(reader.position().line()).map_or(usize::MAX, |line| line + 1);
        let read = match reader.read_record(&mut record) {
            Ok(false) => break,
            Ok(true) => match &file_columns {
                Some(columns) => table_row(&record, grid, wanted, columns).map(|row| {
                    row.add_to(grid, columns, &mut sum);
                    rows.push(row);
                }),
                None => columns_of_heading(&record, grid, columns).map(|columns| {
                    sum = heading_sum(grid, &columns);
                    file_columns = Some(columns);
                }),
            },
            Err(_) => Err(FileFault::format("other bytes", "UTF-8")),
        };
        if let Err(fault) = read {
            let was_cut = ending != Ending::Whole && longest_intact.is_some();
            if was_cut {
                break;
            }
            return Err((line, fault));
        }
        if stored_sum.is_none_or(|stored| stored == sum.value()) {
            let end = start as u64 + reader.position().byte();
            longest_intact = Some(IntactPart { sum, rows: rows.len(), end });
        }
    }
    match longest_intact {
        Some(intact) if ending != Ending::Whole || intact.rows == rows.len() => {
            rows.truncate(intact.rows);
            let columns = file_columns.unwrap_or_default();
            Ok(FileContent { columns, rows, sum: intact.sum, end: intact.end })
        }
        _ => Err((0, FileFault::Damaged { quantity: "the table".into() })),
    }
}

/// The check sum in the first line of a file; `None` if it was deleted from a whole file, to change rows by hand.
fn stored_sum(line: &[u8], ending: Ending<'_>) -> LineResult<Option<u64>> {
    let line = String::from_utf8_lossy(line);
    // A program for tables adds empty cells.
    let line = line.trim_end_matches(['\n', '\r', ',']);
    let Some(sum) = line.strip_prefix(FILE_BEGINNING.trim_end()) else {
        return Err((1, FileFault::format(excerpt(line), format!("'{FILE_BEGINNING}…'"))));
    };
    let sum = sum.trim();
    if sum.is_empty() && ending == Ending::Whole {
        return Ok(None);
    }
    if let Ok(value) = u64::from_str_radix(sum, 16) {
        Ok(Some(value))
    } else {
        let fault = FileFault::value("check sum", quoted(sum), "a hexadecimal number");
        Err((1, fault))
    }
}

/// The columns that a heading names.
fn columns_of_heading(
    record: &StringRecord,
    grid: &CaseGrid,
    columns: Option<&Columns>,
) -> std::result::Result<Columns, FileFault> {
    let cells: Vec<_> = record.iter().map(str::to_owned).collect();
    // The names between the parameters and the last column belong to the file.
    let names = cells.get(1 + grid.parameters.len()..).unwrap_or_default();
    let names = names.strip_suffix(&[ERROR_COLUMN.to_owned()]).unwrap_or(names);
    let results = names.strip_suffix(&[WARNINGS_COLUMN.to_owned()]);
    let with_warnings = results.is_some();
    let mut names = results.unwrap_or(names);
    if let Some(columns) = columns
        && !names.is_empty()
    {
        names = &columns.names;
    }
    let file_columns = Columns { names: names.to_vec(), with_warnings };
    let expected = heading(grid, &file_columns);
    for (column, needed) in expected.iter().enumerate() {
        let found = cells.get(column).map_or("", String::as_str);
        if found != needed {
            let quantity = format!("heading of column {}", column + 1);
            return Err(FileFault::value(quantity, quoted(found), format!("'{needed}'")));
        }
    }
    if cells.len() != expected.len() {
        return Err(FileFault::count("cells", cells.len(), expected.len().to_string()));
    }
    Ok(file_columns)
}

/// Reads a row; an error unless its case is wanted and has the parameters of the sweep.
fn table_row(
    record: &StringRecord,
    grid: &CaseGrid,
    wanted: &dyn Fn(usize) -> bool,
    columns: &Columns,
) -> std::result::Result<TableRow, FileFault> {
    let cells: Vec<_> = record.iter().collect();
    let needed = heading(grid, columns).len();
    let [case_text, cells @ .., reason] = &cells[..] else {
        return Err(FileFault::count("cells", cells.len(), needed.to_string()));
    };
    if cells.len() + 2 != needed {
        return Err(FileFault::count("cells", cells.len() + 2, needed.to_string()));
    }
    let results_begin = grid.parameters.len();
    let results_end = results_begin + columns.names.len();
    let parameters = &cells[..results_begin];
    let results = &cells[results_begin..results_end];
    let warnings = cells[results_end..].concat();
    let is_in_digits = case_text.bytes().all(|byte| byte.is_ascii_digit());
    let case = case_text.parse().ok().filter(|&case| is_in_digits && wanted(case));
    let case = case.ok_or_else(|| {
        FileFault::value("case", quoted(case_text), "one of this sweep, in digits")
    })?;
    for (index, (cell, needed)) in parameters.iter().zip(parameter_cells(grid, case)).enumerate() {
        let parameter = &grid.parameters[index];
        // Another program may have printed the numbers, but they must be the same to the last bit.
        let is_same = match parameter.number(grid.place_of(case, index)) {
            Some(number) => {
                cell_number(cell).is_some_and(|found| found.to_bits() == number.to_bits())
            }
            None => *cell == needed,
        };
        if !is_same {
            let quantity = format!("{} of case {case}", parameter.name());
            return Err(FileFault::value(quantity, quoted(cell), format!("'{needed}'")));
        }
    }
    if reason.is_empty() {
        let mut numbers = Vec::with_capacity(results.len());
        for (cell, column) in results.iter().zip(&columns.names) {
            let number = cell_number(cell);
            numbers.push(number.ok_or_else(|| FileFault::value(column, quoted(cell), "a number"))?);
        }
        return Ok(TableRow { warnings, ..TableRow::new(case, Ok(numbers)) });
    }
    if results.iter().any(|cell| !cell.is_empty()) {
        let found = "a row with an error and results";
        return Err(FileFault::value(format!("case {case}"), found, "a row with either"));
    }
    Ok(TableRow { warnings, ..TableRow::new(case, Err((*reason).to_owned())) })
}

/// The number in a cell, as [`NumberCell`](crate::text::column::NumberCell) writes it or in any other decimal form.
fn cell_number(cell: &str) -> Option<f64> {
    match cell {
        "" => Some(f64::NAN),
        "inf" => Some(f64::INFINITY),
        "-inf" => Some(f64::NEG_INFINITY),
        cell => crate::text::decimal::finite(cell),
    }
}

/// A row, and the file that contains it.
pub(super) struct StoredRow {
    pub(super) row: TableRow,
    pub(super) path: PathBuf,
}

/// Rows by their cases.
pub(super) type RowsByCase = BTreeMap<usize, StoredRow>;

/// Adds the rows of a file; an error for a case that has a row already.
///
/// Of a file that ends anywhere, a row that is already there may occur again: the file was not removed.
pub(super) fn add_rows(
    rows_by_case: &mut RowsByCase,
    rows: impl IntoIterator<Item = TableRow>,
    path: &Path,
    ending: Ending<'_>,
) -> Result<()> {
    for row in rows {
        match rows_by_case.entry(row.case) {
            Entry::Vacant(entry) => {
                entry.insert(StoredRow { row, path: path.to_owned() });
            }
            Entry::Occupied(entry) => {
                let stored = entry.get();
                if ending == Ending::Whole || stored.row != row {
                    let found = format!("here and in {}", name(&stored.path));
                    let case = format!("case {}", row.case);
                    return Err(FileFault::value(case, found, "in one place").of(name(path), 0));
                }
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::column::NumberCell;

    #[test]
    fn numbers_read_back() {
        for (value, text) in [
            (0.2, "0.2"),
            (4.0, "4.0"),
            (-0.0, "-0.0"),
            (1e300, "1e300"),
            (5e-324, "5e-324"),
            (f64::MAX, "1.7976931348623157e308"),
            (f64::INFINITY, "inf"),
            (f64::NEG_INFINITY, "-inf"),
            (f64::NAN, ""),
        ] {
            assert_eq!(NumberCell(value).to_string(), text);
            assert_eq!(cell_number(text).map(f64::to_bits), Some(value.to_bits()));
        }
        assert_eq!(cell_number("0.20"), Some(0.2));
        for text in ["nan", " ", "1 ", "0,2", "1e999", "infinity"] {
            assert_eq!(cell_number(text), None, "{text}");
        }
    }
}
