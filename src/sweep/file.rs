//! Files of cases, read so that nothing is mistaken.

use std::path::Path;

use super::csv::{Record, Records, parsed};
use super::grid::{Grid, LAST_COLUMNS};
use super::replace::name;
use super::table::{Row, heading, parameter_cells};
use crate::error::{CaseFileError, Result, SweepError};
use crate::text::number::excerpt;

/// Columns and rows of a file, in its order.
pub(super) struct Content {
    pub(super) columns: Vec<String>,
    pub(super) rows: Vec<Row>,
    /// Bytes up to the end of the last whole row.
    pub(super) end: u64,
}

/// Permitted endings of a file.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Ending {
    /// With a whole line, as files do that were written to their end.
    Whole,
    /// Within a line or before the first one, as the process was killed.
    Anywhere,
}

/// Reads a file of rows of `grid`, of those cases that are `wanted`, with the results `columns` if
/// they are known.
pub(super) fn read(
    path: &Path,
    grid: &Grid,
    wanted: &dyn Fn(usize) -> bool,
    columns: Option<&[String]>,
    ending: Ending,
) -> Result<Content> {
    let bytes = std::fs::read(path)
        .map_err(|error| SweepError::Unreadable { file: name(path), reason: error.kind() })?;
    let fault = |(line, reason)| SweepError::File { file: name(path), line, reason };
    // A character may be cut as well as a line.
    let text = match std::str::from_utf8(&bytes) {
        Ok(text) => text,
        Err(error) if ending == Ending::Anywhere && error.error_len().is_none() => {
            std::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default()
        }
        Err(error) => {
            let line = bytes[..error.valid_up_to()].split(|&byte| byte == b'\n').count();
            return Err(fault((line, CaseFileError::NotText)).into());
        }
    };
    // A byte-order mark is passed over.
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
                    CaseFileError::Cut if holds_row(&rows[end..], &is_row) => {
                        return Err(fault((line, CaseFileError::Quote)).into());
                    }
                    CaseFileError::Cut if ending == Ending::Anywhere => break,
                    reason => return Err(fault((line, reason)).into()),
                }
            }
        }
    }
    if heading.is_none() && ending == Ending::Whole {
        return Err(fault((1, CaseFileError::Cut)).into());
    }
    let end = if end > 0 { (mark + end) as u64 } else { 0 };
    Ok(Content { columns: heading.unwrap_or_default(), rows: found, end })
}

/// Whether a whole row begins behind a line end of `text`, which ends within a cell: then a
/// quotation mark out of place has swallowed rows that were written, and nothing was cut there.
fn holds_row(text: &str, is_row: &dyn Fn(&Record) -> bool) -> bool {
    text.match_indices('\n').any(|(at, _)| {
        let next = Records::new(&text[at + 1..]).next();
        next.and_then(std::result::Result::ok).is_some_and(|record| is_row(&record))
    })
}

/// The results' columns of a heading.
fn headed(
    record: &Record,
    grid: &Grid,
    columns: Option<&[String]>,
) -> std::result::Result<Vec<String>, (usize, CaseFileError)> {
    let own = if let Some(columns) = columns {
        columns
    } else {
        // Those between the parameters and the last ones are the file's own.
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
            let (found, needed) = (found.to_owned(), needed.clone());
            let reason = CaseFileError::Heading { column: column + 1, found, needed };
            return Err((record.line, reason));
        }
    }
    let (found, needed) = (record.cells.len(), wanted.len());
    if found != needed {
        return Err((record.line, CaseFileError::Cells { found, needed }));
    }
    Ok(own.to_vec())
}

/// The case of a row, with the sweep's parameters, and its results or error.
fn row(
    record: &Record,
    grid: &Grid,
    wanted: &dyn Fn(usize) -> bool,
    columns: &[String],
) -> std::result::Result<Row, (usize, CaseFileError)> {
    let line = record.line;
    let (found, needed) = (record.cells.len(), 3 + grid.parameters.len() + columns.len());
    if found != needed {
        return Err((line, CaseFileError::Cells { found, needed }));
    }
    let (parameters, results) = record.cells[1..].split_at(grid.parameters.len());
    let (results, last) = results.split_at(columns.len());
    let (reason, check) = (&last[0], &last[1]);
    let text = &record.cells[0];
    let digits = !text.is_empty() && text.bytes().all(|sign| sign.is_ascii_digit());
    let case = digits.then(|| text.parse().ok()).flatten().filter(|&case| wanted(case));
    let case = case.ok_or_else(|| (line, CaseFileError::Case { text: excerpt(text) }))?;
    for (index, (cell, needed)) in parameters.iter().zip(parameter_cells(grid, case)).enumerate() {
        let parameter = &grid.parameters[index];
        // Numbers may have been printed by another program, but must be the same to the last bit.
        let same = match parameter.number(grid.place_of(case, index)) {
            Some(number) => parsed(cell).is_some_and(|found| found.to_bits() == number.to_bits()),
            None => *cell == needed,
        };
        if !same {
            let (parameter, found) = (parameter.name().to_owned(), excerpt(cell));
            return Err((line, CaseFileError::Parameter { case, parameter, found, needed }));
        }
    }
    let has_failed = !reason.is_empty();
    if has_failed && results.iter().any(|cell| !cell.is_empty()) {
        return Err((line, CaseFileError::ErrorAndResults { case }));
    }
    let number = |(cell, column): (&String, &String)| {
        let wrong = || CaseFileError::NotANumber { column: column.clone(), text: excerpt(cell) };
        parsed(cell).ok_or_else(|| (line, wrong()))
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
        Err((line, CaseFileError::Damaged { case }))
    }
}
