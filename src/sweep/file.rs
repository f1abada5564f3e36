//! Reads files of cases, and detects damaged rows.

use std::path::Path;

use super::table::{Row, heading, name, parameter_cells};
use super::{Grid, LAST_COLUMNS};
use crate::error::{FileFault, Result};
use crate::text::decimal::quoted;

/// Columns and rows of a file, in the file's order.
pub(super) struct Content {
    pub(super) columns: Vec<String>,
    pub(super) rows: Vec<Row>,
    /// Number of bytes up to the end of the last complete row.
    pub(super) end: u64,
}

/// Permitted endings of a file.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Ending {
    /// The file ends with a complete line, as a file that was written to its end.
    Whole,
    /// The file ends anywhere, as when the process was killed.
    Anywhere,
}

/// Reads a file with rows of `grid`, for the cases that are `wanted`.
///
/// `columns`: the names of the results if they are known.
pub(super) fn read(
    path: &Path,
    grid: &Grid,
    wanted: &dyn Fn(usize) -> bool,
    columns: Option<&[String]>,
    ending: Ending,
) -> Result<Content> {
    let bytes = std::fs::read(path)
        .map_err(|error| FileFault::Unreadable(error.kind()).of(name(path), 0))?;
    let fault = |(line, fault): (usize, FileFault)| fault.of(name(path), line);
    // The file may end within a character as well as within a line.
    let text = match std::str::from_utf8(&bytes) {
        Ok(text) => text,
        Err(error) if ending == Ending::Anywhere && error.error_len().is_none() => {
            std::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default()
        }
        Err(error) => {
            let line = bytes[..error.valid_up_to()].split(|&byte| byte == b'\n').count();
            return Err(fault((line, FileFault::format("other bytes", "UTF-8"))));
        }
    };
    // A byte-order mark is skipped.
    let rows = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mark = text.len() - rows.len();
    let records = Records::new(rows);
    let mut heading: Option<Vec<String>> = None;
    let (mut found, mut end) = (Vec::new(), 0);
    for record in records {
        match record {
            Ok(record) => {
                end = record.end;
                match &heading {
                    Some(names) => found.push(row(&record, grid, wanted, names).map_err(fault)?),
                    None => heading = Some(headed(&record, grid, columns).map_err(fault)?),
                }
            }
            Err((line, reason)) => {
                let names = heading.as_deref().or(columns).unwrap_or_default();
                let is_row = |record: &Record| row(record, grid, wanted, names).is_ok();
                match reason {
                    FileFault::Cut if holds_row(&rows[end..], &is_row) => {
                        return Err(fault((line, misplaced_quote())));
                    }
                    FileFault::Cut if ending == Ending::Anywhere => break,
                    reason => return Err(fault((line, reason))),
                }
            }
        }
    }
    if heading.is_none() && ending == Ending::Whole {
        return Err(fault((1, FileFault::Cut)));
    }
    let end = if end > 0 { (mark + end) as u64 } else { 0 };
    Ok(Content { columns: heading.unwrap_or_default(), rows: found, end })
}

/// Whether a complete row begins after a line end of `text`, which ends within a cell.
///
/// If so, a misplaced quotation mark joined rows that were written completely, and the file was not cut
/// there.
fn holds_row(text: &str, is_row: &dyn Fn(&Record) -> bool) -> bool {
    text.match_indices('\n').any(|(at, _)| {
        let next = Records::new(&text[at + 1..]).next();
        next.and_then(std::result::Result::ok).is_some_and(|record| is_row(&record))
    })
}

/// The names of the results in a heading.
fn headed(
    record: &Record,
    grid: &Grid,
    columns: Option<&[String]>,
) -> std::result::Result<Vec<String>, (usize, FileFault)> {
    let own = if let Some(columns) = columns {
        columns
    } else {
        // The names between the parameters and the last columns belong to the file.
        let mut own = record.cells.get(1 + grid.parameters.len()..).unwrap_or_default();
        for last in LAST_COLUMNS.iter().rev() {
            own = own.strip_suffix(&[(*last).to_owned()]).unwrap_or(own);
        }
        own
    };
    let wanted = heading(grid, own);
    for (column, needed) in wanted.iter().enumerate() {
        let found = record.cells.get(column).map_or("", String::as_str);
        if found != needed {
            let quantity = format!("heading of column {}", column + 1);
            let fault = FileFault::value(quantity, quoted(found), format!("'{needed}'"));
            return Err((record.line, fault));
        }
    }
    let (found, needed) = (record.cells.len(), wanted.len());
    if found != needed {
        return Err((record.line, FileFault::count("cells", found, needed.to_string())));
    }
    Ok(own.to_vec())
}

/// The case of a row with its results or error; checks the parameters against the sweep.
fn row(
    record: &Record,
    grid: &Grid,
    wanted: &dyn Fn(usize) -> bool,
    columns: &[String],
) -> std::result::Result<Row, (usize, FileFault)> {
    let line = record.line;
    let (found, needed) = (record.cells.len(), 3 + grid.parameters.len() + columns.len());
    if found != needed {
        return Err((line, FileFault::count("cells", found, needed.to_string())));
    }
    let (parameters, results) = record.cells[1..].split_at(grid.parameters.len());
    let (results, last) = results.split_at(columns.len());
    let (reason, check) = (&last[0], &last[1]);
    let text = &record.cells[0];
    let digits = !text.is_empty() && text.bytes().all(|sign| sign.is_ascii_digit());
    let case = digits.then(|| text.parse().ok()).flatten().filter(|&case| wanted(case));
    let case = case.ok_or_else(|| {
        (line, FileFault::value("case", quoted(text), "one of this sweep, in digits"))
    })?;
    for (index, (cell, needed)) in parameters.iter().zip(parameter_cells(grid, case)).enumerate() {
        let parameter = &grid.parameters[index];
        // Another program may have printed the numbers, but they must be the same to the last bit.
        let same = match parameter.number(grid.place_of(case, index)) {
            Some(number) => parsed(cell).is_some_and(|found| found.to_bits() == number.to_bits()),
            None => *cell == needed,
        };
        if !same {
            let quantity = format!("{} of case {case}", parameter.name());
            return Err((line, FileFault::value(quantity, quoted(cell), format!("'{needed}'"))));
        }
    }
    let has_failed = !reason.is_empty();
    if has_failed && results.iter().any(|cell| !cell.is_empty()) {
        let found = "a row with an error and results";
        return Err((line, FileFault::value(format!("case {case}"), found, "a row with either")));
    }
    let number = |(cell, column): (&String, &String)| {
        parsed(cell).ok_or_else(|| (line, FileFault::value(column, quoted(cell), "a number")))
    };
    let outcome = if has_failed {
        Err(reason.clone())
    } else {
        Ok(results.iter().zip(columns).map(number).collect::<std::result::Result<_, _>>()?)
    };
    let row = Row::new(case, outcome);
    if row.check(grid, columns) == *check {
        Ok(row)
    } else {
        Err((line, FileFault::Damaged { quantity: format!("case {case}") }))
    }
}

/// A quotation mark within a cell without quotes, or text behind a cell with them.
fn misplaced_quote() -> FileFault {
    FileFault::value("quotation mark", "out of place", "around a whole cell")
}

/// The number in a cell, as [`Cell`](crate::text::column::Cell) writes it or in any other decimal form.
pub(super) fn parsed(cell: &str) -> Option<f64> {
    match cell {
        "" => Some(f64::NAN),
        "inf" => Some(f64::INFINITY),
        "-inf" => Some(f64::NEG_INFINITY),
        cell => crate::text::decimal::finite(cell),
    }
}

/// A row of cells.
pub(super) struct Record {
    /// Number of its first line, from 1.
    pub(super) line: usize,
    pub(super) cells: Vec<String>,
    /// Number of bytes of the text up to the end of this row.
    pub(super) end: usize,
}

/// The rows of a text in order; a fault ends them and is returned with its line.
pub(super) struct Records<'a> {
    text: &'a str,
    at: usize,
    line: usize,
}

impl<'a> Records<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, at: 0, line: 1 }
    }

    /// The next cell and whether it ends the row; moves past the comma or line end.
    fn cell(&mut self) -> std::result::Result<(String, bool), FileFault> {
        let rest = &self.text[self.at..];
        let (cell, length) = if let Some(quoted) = rest.strip_prefix('"') {
            let (cell, length) = unquoted(quoted).ok_or(FileFault::Cut)?;
            (cell, length + 1)
        } else {
            let length = rest.find([',', '\n']).ok_or(FileFault::Cut)?;
            let (cell, behind) = rest.split_at(length);
            let windows = behind.starts_with('\n').then(|| cell.strip_suffix('\r')).flatten();
            let cell = windows.unwrap_or(cell);
            if cell.contains('"') {
                return Err(misplaced_quote());
            }
            (cell.to_owned(), length)
        };
        let behind = &rest[length..];
        let (signs, ends) = match behind.as_bytes() {
            [b',', ..] => (1, false),
            [b'\n', ..] => (1, true),
            [b'\r', b'\n', ..] => (2, true),
            [] | [b'\r'] => return Err(FileFault::Cut),
            _ => return Err(misplaced_quote()),
        };
        self.at += length + signs;
        Ok((cell, ends))
    }
}

/// Text up to the closing quotation mark, with doubled marks made single, and its length in bytes with that
/// mark.
fn unquoted(text: &str) -> Option<(String, usize)> {
    let mut cell = String::new();
    let mut at = 0;
    loop {
        let length = text[at..].find('"')?;
        cell += &text[at..at + length];
        at += length + 1;
        if !text[at..].starts_with('"') {
            return Some((cell, at));
        }
        cell.push('"');
        at += 1;
    }
}

impl Iterator for Records<'_> {
    type Item = std::result::Result<Record, (usize, FileFault)>;

    fn next(&mut self) -> Option<Self::Item> {
        let (start, line) = (self.at, self.line);
        if start == self.text.len() {
            return None;
        }
        let mut cells = Vec::new();
        loop {
            match self.cell() {
                Ok((cell, ends)) => {
                    cells.push(cell);
                    if ends {
                        break;
                    }
                }
                Err(fault) => {
                    self.at = self.text.len();
                    return Some(Err((line, fault)));
                }
            }
        }
        self.line += self.text[start..self.at].matches('\n').count();
        Some(Ok(Record { line, cells, end: self.at }))
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

    #[test]
    fn rows_and_their_faults() {
        let rows = |text: &str| {
            Records::new(text)
                .map(|r| r.map(|r| (r.line, r.cells)))
                .collect::<std::result::Result<Vec<_>, _>>()
        };
        let found = rows("a,\"b\"\"c\r\n,\",\r\n1,,2\n").unwrap();
        assert_eq!(found[0], (1, ["a", "b\"c\r\n,", ""].map(str::to_owned).to_vec()));
        assert_eq!(found[1], (3, ["1", "", "2"].map(str::to_owned).to_vec()));
        assert_eq!(rows("").unwrap(), []);
        for (text, line, fault) in [
            ("a,b\n1", 2, FileFault::Cut),
            ("a,b\n1,2\r", 2, FileFault::Cut),
            ("a,b\n1,\"2", 2, FileFault::Cut),
            ("a,b\n1,\"2\"", 2, FileFault::Cut),
            ("\"x\ny\",b\n1,\"2\"3\n", 3, misplaced_quote()),
            ("a\"\n", 1, misplaced_quote()),
        ] {
            assert_eq!(rows(text).unwrap_err(), (line, fault), "{text:?}");
        }
    }
}
