//! Files of cases: a line with format and check sum, a heading, and a row for each case.

use std::path::Path;

use csv::{ReaderBuilder, StringRecord};

use super::columns::Columns;
use super::table::{FIRST, Row, first_lines, heading, heading_sum, parameter_cells};
use super::{ERROR, Grid, WARNINGS};
use crate::error::{FileFault, Result};
use crate::text::check_sum::CheckSum;
use crate::text::decimal::{excerpt, quoted};

/// Columns and rows of a file, in the file's order.
pub(super) struct Content {
    pub(super) columns: Columns,
    pub(super) rows: Vec<Row>,
    /// Check sum of these rows.
    pub(super) sum: CheckSum,
    /// Number of bytes up to the end of the last of these rows.
    pub(super) end: u64,
}

/// Permitted endings of a file.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Ending<'a> {
    /// The file ends with the last row of its check sum, as a file that was written to its end.
    Whole,
    /// The file ends anywhere, as when the process was killed: behind the rows of its check sum, or within the
    /// `heading` with which it was begun.
    Anywhere { heading: &'a Columns },
}

/// Fault of a line, numbered from 1.
type Fault = (usize, FileFault);

/// The path as text.
pub(super) fn name(path: &Path) -> String {
    path.display().to_string()
}

/// Reads a file with rows of `grid`, for the cases that are `wanted`.
///
/// `columns`: the columns of results, if they are known. A file whose cases all failed may have no names of results.
pub(super) fn read(
    path: &Path,
    grid: &Grid,
    wanted: &dyn Fn(usize) -> bool,
    columns: Option<&Columns>,
    ending: Ending<'_>,
) -> Result<Content> {
    let bytes = std::fs::read(path)
        .map_err(|error| FileFault::Unreadable(error.kind()).of(name(path), 0))?;
    let fault = |(line, fault): Fault| fault.of(name(path), line);
    if let Ending::Anywhere { heading } = ending {
        let sum = heading_sum(grid, heading);
        if first_lines(grid, heading, sum).as_bytes().starts_with(&bytes) {
            // Not even the heading was written.
            return Ok(Content { columns: heading.clone(), rows: vec![], sum, end: 0 });
        }
    }
    // A byte-order mark is skipped.
    let text = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(&bytes);
    let first = text.split_inclusive(|&byte| byte == b'\n').next().unwrap_or_default();
    let stored = stored_sum(first, ending).map_err(fault)?;
    let start = bytes.len() - text.len() + first.len();
    let mut reader =
        ReaderBuilder::new().has_headers(false).flexible(true).from_reader(&bytes[start..]);
    let mut found_columns: Option<Columns> = None;
    let (mut found, mut sum) = (Vec::new(), CheckSum::default());
    // Sum, number of rows and end of the longest part of the file that agrees with the check sum.
    let mut intact = None;
    let mut record = StringRecord::new();
    loop {
        let line = usize::try_from(reader.position().line()).map_or(usize::MAX, |line| line + 1);
        let read = match reader.read_record(&mut record) {
            Ok(false) => break,
            Ok(true) => match &found_columns {
                Some(names) => row(&record, grid, wanted, names).map(|row| found.push(row)),
                None => headed(&record, grid, columns).map(|own| found_columns = Some(own)),
            },
            Err(_) => Err(FileFault::format("other bytes", "UTF-8")),
        };
        match (read, found.last(), &found_columns) {
            (Ok(()), None, Some(names)) => sum = heading_sum(grid, names),
            (Ok(()), Some(row), Some(names)) => row.add_to(grid, names, &mut sum),
            (Err(_), ..) if ending != Ending::Whole && intact.is_some() => break,
            (Err(reason), ..) => return Err(fault((line, reason))),
            (Ok(()), _, None) => {}
        }
        if stored.is_none_or(|stored| stored == sum.value()) {
            intact = Some((sum, found.len(), start as u64 + reader.position().byte()));
        }
    }
    let Some((sum, count, end)) = intact else {
        return Err(fault((0, FileFault::Damaged { quantity: "the table".into() })));
    };
    if ending == Ending::Whole && count < found.len() {
        return Err(fault((0, FileFault::Damaged { quantity: "the table".into() })));
    }
    found.truncate(count);
    Ok(Content { columns: found_columns.unwrap_or_default(), rows: found, sum, end })
}

/// The check sum in the first line of a file; `None` if it was deleted from a whole file, to change rows by hand.
fn stored_sum(line: &[u8], ending: Ending<'_>) -> std::result::Result<Option<u64>, Fault> {
    let line = String::from_utf8_lossy(line);
    // A program for tables adds empty cells.
    let line = line.trim_end_matches(['\n', '\r', ',']);
    let Some(sum) = line.strip_prefix(FIRST.trim_end()) else {
        return Err((1, FileFault::format(excerpt(line), format!("'{FIRST}…'"))));
    };
    let sum = Some(sum.trim()).filter(|sum| !sum.is_empty() || ending != Ending::Whole);
    let wrong = |sum| FileFault::value("check sum", quoted(sum), "a hexadecimal number");
    let value = |sum| u64::from_str_radix(sum, 16).map_err(|_| (1, wrong(sum)));
    sum.map(value).transpose()
}

/// The columns that a heading names.
fn headed(
    record: &StringRecord,
    grid: &Grid,
    columns: Option<&Columns>,
) -> std::result::Result<Columns, FileFault> {
    let cells: Vec<_> = record.iter().map(str::to_owned).collect();
    // The names between the parameters and the last column belong to the file.
    let names = cells.get(1 + grid.parameters.len()..).unwrap_or_default();
    let names = names.strip_suffix(&[ERROR.to_owned()]).unwrap_or(names);
    let results = names.strip_suffix(&[WARNINGS.to_owned()]);
    let with_warnings = results.is_some();
    let mut names = results.unwrap_or(names);
    if let Some(columns) = columns
        && !names.is_empty()
    {
        names = &columns.names;
    }
    let own = Columns { names: names.to_vec(), with_warnings };
    let wanted = heading(grid, &own);
    for (column, needed) in wanted.iter().enumerate() {
        let found = cells.get(column).map_or("", String::as_str);
        if found != needed {
            let quantity = format!("heading of column {}", column + 1);
            return Err(FileFault::value(quantity, quoted(found), format!("'{needed}'")));
        }
    }
    if cells.len() != wanted.len() {
        return Err(FileFault::count("cells", cells.len(), wanted.len().to_string()));
    }
    Ok(own)
}

/// The case of a row with its results or error; checks the parameters against the sweep.
fn row(
    record: &StringRecord,
    grid: &Grid,
    wanted: &dyn Fn(usize) -> bool,
    columns: &Columns,
) -> std::result::Result<Row, FileFault> {
    let cells: Vec<_> = record.iter().collect();
    let needed = heading(grid, columns).len();
    let [text, cells @ .., reason] = &cells[..] else {
        return Err(FileFault::count("cells", cells.len(), needed.to_string()));
    };
    if cells.len() + 2 != needed {
        return Err(FileFault::count("cells", cells.len() + 2, needed.to_string()));
    }
    let (parameters, results) = cells.split_at(grid.parameters.len());
    let (results, warnings) = results.split_at(columns.names.len());
    let warnings = warnings.concat();
    let digits = !text.is_empty() && text.bytes().all(|sign| sign.is_ascii_digit());
    let case = digits.then(|| text.parse().ok()).flatten().filter(|&case| wanted(case));
    let case =
        case.ok_or_else(|| FileFault::value("case", quoted(text), "one of this sweep, in digits"))?;
    for (index, (cell, needed)) in parameters.iter().zip(parameter_cells(grid, case)).enumerate() {
        let parameter = &grid.parameters[index];
        // Another program may have printed the numbers, but they must be the same to the last bit.
        let same = match parameter.number(grid.place_of(case, index)) {
            Some(number) => parsed(cell).is_some_and(|found| found.to_bits() == number.to_bits()),
            None => *cell == needed,
        };
        if !same {
            let quantity = format!("{} of case {case}", parameter.name());
            return Err(FileFault::value(quantity, quoted(cell), format!("'{needed}'")));
        }
    }
    if reason.is_empty() {
        let number = |(cell, column): (&&str, &String)| {
            parsed(cell).ok_or_else(|| FileFault::value(column, quoted(cell), "a number"))
        };
        let numbers = results.iter().zip(&columns.names).map(number);
        let numbers = numbers.collect::<std::result::Result<_, _>>()?;
        return Ok(Row { warnings, ..Row::new(case, Ok(numbers)) });
    }
    if results.iter().any(|cell| !cell.is_empty()) {
        let found = "a row with an error and results";
        return Err(FileFault::value(format!("case {case}"), found, "a row with either"));
    }
    Ok(Row { warnings, ..Row::new(case, Err((*reason).to_owned())) })
}

/// The number in a cell, as [`Cell`](crate::text::column::Cell) writes it or in any other decimal form.
fn parsed(cell: &str) -> Option<f64> {
    match cell {
        "" => Some(f64::NAN),
        "inf" => Some(f64::INFINITY),
        "-inf" => Some(f64::NEG_INFINITY),
        cell => crate::text::decimal::finite(cell),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::column::Cell;

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
            assert_eq!(Cell(value).to_string(), text);
            assert_eq!(parsed(text).map(f64::to_bits), Some(value.to_bits()));
        }
        assert_eq!(parsed("0.20"), Some(0.2));
        for text in ["nan", " ", "1 ", "0,2", "1e999", "infinity"] {
            assert_eq!(parsed(text), None, "{text}");
        }
    }
}
