//! Files of cases, read so that nothing is mistaken.

use std::path::Path;

use super::csv::{Record, Records, parsed};
use super::grid::Grid;
use super::replace::name;
use super::table::{Row, heading, parameter_cells};
use crate::error::{CaseFileError, Result, SweepError};
use crate::number::excerpt;

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
    let mut records = Records::new(rows);
    let mut content = Content { columns: Vec::new(), rows: Vec::new(), end: 0 };
    let is_cut = |fault: &(usize, CaseFileError)| {
        ending == Ending::Anywhere && fault.1 == CaseFileError::Cut
    };
    match records.next().unwrap_or(Err((1, CaseFileError::Cut))) {
        Ok(record) => {
            content.end = (mark + record.end) as u64;
            content.columns = headed(record, grid, columns).map_err(fault)?;
        }
        Err(reason) if is_cut(&reason) => return Ok(content),
        Err(reason) => return Err(fault(reason).into()),
    }
    for record in records {
        match record {
            Ok(record) => {
                content.end = (mark + record.end) as u64;
                let row = row(&record, grid, wanted, &content.columns);
                content.rows.push(row.map_err(fault)?);
            }
            Err(reason) if is_cut(&reason) => break,
            Err(reason) => return Err(fault(reason).into()),
        }
    }
    Ok(content)
}

/// The results' columns of a heading.
fn headed(
    record: Record,
    grid: &Grid,
    columns: Option<&[String]>,
) -> std::result::Result<Vec<String>, (usize, CaseFileError)> {
    let fixed = 2 + grid.parameters.len();
    let found = record.cells.len();
    let own = match columns {
        Some(columns) => columns.to_vec(),
        // Those between the parameters and the error are the file's own.
        None => record.cells.get(fixed - 1..found.saturating_sub(1)).unwrap_or_default().to_vec(),
    };
    let wanted = heading(grid, &own);
    let pairs = record.cells.into_iter().zip(&wanted).enumerate();
    for (column, (found, needed)) in pairs {
        if found != *needed {
            let needed = needed.clone();
            let reason = CaseFileError::Heading { column: column + 1, found, needed };
            return Err((record.line, reason));
        }
    }
    if found != wanted.len() {
        return Err((record.line, CaseFileError::Cells { found, needed: wanted.len() }));
    }
    Ok(own)
}

/// The case of a row, with the sweep's parameters, and its results or error.
fn row(
    record: &Record,
    grid: &Grid,
    wanted: &dyn Fn(usize) -> bool,
    columns: &[String],
) -> std::result::Result<Row, (usize, CaseFileError)> {
    let line = record.line;
    let (found, needed) = (record.cells.len(), 2 + grid.parameters.len() + columns.len());
    if found != needed {
        return Err((line, CaseFileError::Cells { found, needed }));
    }
    let (parameters, results) = record.cells[1..].split_at(grid.parameters.len());
    let (results, error) = results.split_at(columns.len());
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
    let reason = &error[0];
    if !reason.is_empty() {
        if results.iter().any(|cell| !cell.is_empty()) {
            return Err((line, CaseFileError::ErrorAndResults { case }));
        }
        return Ok(Row::new(case, Err(reason.clone())));
    }
    let number = |(cell, column): (&String, &String)| {
        let wrong = || CaseFileError::NotANumber { column: column.clone(), text: excerpt(cell) };
        parsed(cell).ok_or_else(|| (line, wrong()))
    };
    let results = results.iter().zip(columns).map(number).collect::<std::result::Result<_, _>>()?;
    Ok(Row::new(case, Ok(results)))
}
