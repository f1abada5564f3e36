//! Files of cases: a line with format and check sum, a heading, and a row for each case.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};

use csv::{ReaderBuilder, StringRecord};

use super::table::{
    Columns, FILE_BEGINNING, TableRow, first_lines, heading, heading_check_sum, parameter_cells,
};
use super::{CaseGrid, ERROR_COLUMN, WARNINGS_COLUMN};
use crate::error::{FileFault, Result};
use crate::text::bounded_line::LineResult;
use crate::text::check_sum::CheckSum;
use crate::text::decimal::{excerpt, quoted};

/// Columns and rows of a file.
pub(super) struct FileContent {
    /// Columns of results and warnings.
    pub(super) columns: Columns,
    /// Rows, in the order of the file.
    pub(super) rows: Vec<TableRow>,
    /// Check sum of these rows.
    pub(super) check_sum: CheckSum,
    /// Number of bytes up to the end of the last of these rows.
    pub(super) end_byte: u64,
}

/// Where a file may end.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Ending<'a> {
    /// The file is complete: it ends with the last row of its check sum.
    Whole,
    /// The process may have been killed while it wrote the file.
    ///
    /// The file may then end after the rows of its check sum, or within its first `heading`.
    Anywhere { heading: &'a Columns },
}

/// The path as text.
pub(super) fn path_text(path: &Path) -> String {
    path.display().to_string()
}

/// Reads a file with rows of `grid`; an error for a case that is not expected.
///
/// `columns`: the columns of results that the file must have, if any. A file whose cases all failed may have no names of
/// results.
pub(super) fn read_file(
    path: &Path,
    grid: &CaseGrid,
    is_expected_case: &dyn Fn(usize) -> bool,
    columns: Option<&Columns>,
    ending: Ending<'_>,
) -> Result<FileContent> {
    let bytes = std::fs::read(path)
        .map_err(|error| FileFault::Unreadable(error.kind()).of(path_text(path), 0))?;
    if let Ending::Anywhere { heading } = ending {
        let check_sum = heading_check_sum(grid, heading);
        if first_lines(grid, heading, check_sum).as_bytes().starts_with(&bytes) {
            // The process was killed before the whole heading was written.
            return Ok(FileContent {
                columns: heading.clone(),
                rows: vec![],
                check_sum,
                end_byte: 0,
            });
        }
    }
    read_lines(&bytes, grid, is_expected_case, columns, ending)
        .map_err(|(line, fault)| fault.of(path_text(path), line))
}

/// The beginning of a file, up to a row, that agrees with the check sum.
struct IntactPart {
    check_sum: CheckSum,
    /// Number of rows.
    row_count: usize,
    /// Number of bytes up to its end.
    end_byte: u64,
}

/// Reads the content of a file whose heading is complete.
fn read_lines(
    bytes: &[u8],
    grid: &CaseGrid,
    is_expected_case: &dyn Fn(usize) -> bool,
    columns: Option<&Columns>,
    ending: Ending<'_>,
) -> LineResult<FileContent> {
    // A byte-order mark is skipped.
    let bytes_without_mark = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    let first_line =
        bytes_without_mark.split_inclusive(|&byte| byte == b'\n').next().unwrap_or_default();
    let stored_sum = stored_sum(first_line, ending)?;
    let table_start = bytes.len() - bytes_without_mark.len() + first_line.len();
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .from_reader(&bytes[table_start..]);
    let mut file_columns: Option<Columns> = None;
    let mut rows = Vec::new();
    let mut check_sum = CheckSum::default();
    let mut longest_intact: Option<IntactPart> = None;
    let mut record = StringRecord::new();
    loop {
        let line = usize::try_from(reader.position().line()).map_or(usize::MAX, |line| line + 1);
        let result = match reader.read_record(&mut record) {
            Ok(false) => break,
            Ok(true) => match &file_columns {
                Some(columns) => table_row(&record, grid, is_expected_case, columns).map(|row| {
                    row.add_to_check_sum(grid, columns, &mut check_sum);
                    rows.push(row);
                }),
                None => columns_of_heading(&record, grid, columns).map(|columns| {
                    check_sum = heading_check_sum(grid, &columns);
                    file_columns = Some(columns);
                }),
            },
            Err(_) => Err(FileFault::format("other bytes", "UTF-8")),
        };
        if let Err(fault) = result {
            let may_be_incomplete = ending != Ending::Whole && longest_intact.is_some();
            if may_be_incomplete {
                break;
            }
            return Err((line, fault));
        }
        if stored_sum.is_none_or(|stored| stored == check_sum.value()) {
            let end_byte = table_start as u64 + reader.position().byte();
            longest_intact = Some(IntactPart { check_sum, row_count: rows.len(), end_byte });
        }
    }
    intact_content(longest_intact, file_columns.unwrap_or_default(), rows, ending)
}

/// Content of the part of a file that agrees with its check sum; an error if the file is damaged.
fn intact_content(
    longest_intact: Option<IntactPart>,
    columns: Columns,
    mut rows: Vec<TableRow>,
    ending: Ending<'_>,
) -> LineResult<FileContent> {
    match longest_intact {
        Some(intact) if ending != Ending::Whole || intact.row_count == rows.len() => {
            rows.truncate(intact.row_count);
            Ok(FileContent {
                columns,
                rows,
                check_sum: intact.check_sum,
                end_byte: intact.end_byte,
            })
        }
        _ => Err((0, FileFault::Damaged { quantity: "the table".into() })),
    }
}

/// The check sum in the first line of a file, if it has one.
///
/// A user may delete the check sum of a complete file to change rows by hand.
fn stored_sum(line: &[u8], ending: Ending<'_>) -> LineResult<Option<u64>> {
    let text = String::from_utf8_lossy(line);
    // A spreadsheet adds empty cells.
    let line = text.trim_end_matches(['\n', '\r', ',']);
    let Some(sum_text) = line.strip_prefix(FILE_BEGINNING.trim_end()) else {
        return Err((1, FileFault::format(excerpt(line), format!("'{FILE_BEGINNING}…'"))));
    };
    let sum_text = sum_text.trim();
    if sum_text.is_empty() && ending == Ending::Whole {
        return Ok(None);
    }
    if let Ok(value) = u64::from_str_radix(sum_text, 16) {
        Ok(Some(value))
    } else {
        let fault = FileFault::value("check sum", quoted(sum_text), "a hexadecimal number");
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
    // Names of results stand between the parameters and the last columns.
    let names_and_error = cells.get(1 + grid.parameters.len()..).unwrap_or_default();
    let names = names_and_error.strip_suffix(&[ERROR_COLUMN.to_owned()]).unwrap_or(names_and_error);
    let names_before_warnings = names.strip_suffix(&[WARNINGS_COLUMN.to_owned()]);
    let with_warnings = names_before_warnings.is_some();
    let mut result_names = names_before_warnings.unwrap_or(names);
    if let Some(columns) = columns
        && !result_names.is_empty()
    {
        result_names = &columns.names;
    }
    let file_columns = Columns { names: result_names.to_vec(), with_warnings };
    let expected_cells = heading(grid, &file_columns);
    for (index, expected_cell) in expected_cells.iter().enumerate() {
        let found_name = cells.get(index).map_or("", String::as_str);
        if found_name != expected_cell {
            let quantity = format!("heading of column {}", index + 1);
            return Err(FileFault::value(
                quantity,
                quoted(found_name),
                format!("'{expected_cell}'"),
            ));
        }
    }
    if cells.len() != expected_cells.len() {
        return Err(FileFault::count("cells", cells.len(), expected_cells.len().to_string()));
    }
    Ok(file_columns)
}

/// Reads a row; an error unless its case is expected and has the parameters of the sweep.
fn table_row(
    record: &StringRecord,
    grid: &CaseGrid,
    is_expected_case: &dyn Fn(usize) -> bool,
    columns: &Columns,
) -> std::result::Result<TableRow, FileFault> {
    let cells: Vec<_> = record.iter().collect();
    let cell_count = heading(grid, columns).len();
    if cells.len() != cell_count {
        return Err(FileFault::count("cells", cells.len(), cell_count.to_string()));
    }
    let [case_text, inner_cells @ .., reason] = &cells[..] else {
        return Err(FileFault::count("cells", cells.len(), cell_count.to_string()));
    };
    let results_begin = grid.parameters.len();
    let results_end = results_begin + columns.names.len();
    let parameters = &inner_cells[..results_begin];
    let results = &inner_cells[results_begin..results_end];
    let warnings = inner_cells[results_end..].concat();
    let has_only_digits = case_text.bytes().all(|byte| byte.is_ascii_digit());
    let case = case_text.parse().ok().filter(|&case| has_only_digits && is_expected_case(case));
    let case = case.ok_or_else(|| {
        FileFault::value("case", quoted(case_text), "one of this sweep, in digits")
    })?;
    for (index, (cell, expected_cell)) in
        parameters.iter().zip(parameter_cells(grid, case)).enumerate()
    {
        let parameter = &grid.parameters[index];
        // Another program may have printed the numbers in another form, but their bits must be the same.
        let is_same = match parameter.number(grid.value_index(case, index)) {
            Some(number) => {
                cell_number(cell).is_some_and(|value| value.to_bits() == number.to_bits())
            }
            None => *cell == expected_cell,
        };
        if !is_same {
            let quantity = format!("{} of case {case}", parameter.name());
            return Err(FileFault::value(quantity, quoted(cell), format!("'{expected_cell}'")));
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
        let found_text = "a row with an error and results";
        return Err(FileFault::value(format!("case {case}"), found_text, "a row with either"));
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
/// A file of an unfinished process may repeat the same row, since a complete file may exist beside it.
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
                let stored_row = entry.get();
                if ending == Ending::Whole || stored_row.row != row {
                    let found_places = format!("here and in {}", path_text(&stored_row.path));
                    let case = format!("case {}", row.case);
                    return Err(
                        FileFault::value(case, found_places, "in one place").of(path_text(path), 0)
                    );
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
