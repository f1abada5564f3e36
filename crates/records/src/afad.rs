//! Records of the Turkish national strong-motion network (AFAD).
//!
//! Layout: the `.txt` files of the Turkish National Strong-Motion Network, Disaster and Emergency Management Presidency
//! (AFAD), with the heading `STRONG GROUND MOTION RECORDS OF TURKIYE`: lines `KEY : value`, a line with the names of
//! the components, then a line a time step, in gal.

use std::io::Read;

use super::column_title::check_acceleration;
use super::fault::{FaultResult, unclear, unequal_columns};
use super::header_line::titles_of_words;
use super::header_number::HeaderNumber;
use super::lines::{
    LineResult, Lines, Series, is_like_number, push_numbers, required, sample_count,
    select_component, to_record, to_records, wrong_count,
};
use super::{AccelerationUnit, Record, RecordFormat, agreement};
use crate::error::{FileFault, Result};
use crate::text::decimal::finite;

/// The text files of the Turkish network (AFAD).
///
/// One file has all components of a station, side by side.
///
/// A header of lines `KEY : value`, among them `NUMBER OF DATA` and `SAMPLING INTERVAL (sec)`; a line with the
/// names of the components, `N-S  E-W  U-D`; then the samples in gal. [`Record::read_all`] returns all components.
/// An error if samples or peaks (`RAW PGA VALUES (gal)`) differ from the header, or if the header names a unit of
/// acceleration other than gal. Newer files of AFAD (`.asc`) have the layout of [`EsmFormat`](super::EsmFormat).
///
/// ```
/// use basemat::motion::{AfadFormat, Record};
/// let text = "STRONG GROUND MOTION RECORDS OF TURKIYE\nSTATION ID              : 0001\n\
///     NUMBER OF DATA          : 3\nSAMPLING INTERVAL (sec) : 0.01\n\
///     RAW PGA VALUES (gal)    : (N-S) 0.12 (E-W) 0.22 (U-D) 0.32\n\
///     \x20      N-S          E-W          U-D\n\
///     0.10     0.20    0.30\n0.11     0.21    0.31\n0.12     0.22    0.32\n";
/// let record = Record::from_reader("0001.txt", text.as_bytes(), &AfadFormat { component: 2 })?;
/// assert_eq!((record.time_step(), record.accelerations()[2]), (0.01, 0.0022));
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct AfadFormat {
    /// Number of the component, counted from 1 in the order of the file.
    pub component: usize,
}

impl Default for AfadFormat {
    /// The first component, mostly north–south.
    fn default() -> Self {
        Self { component: 1 }
    }
}

impl RecordFormat for AfadFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        to_record(name, select_component(self.component, read(&mut Lines::new(source))))
    }

    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        to_records(name, read(&mut Lines::new(source)))
    }
}

/// Unit of the samples and of their peaks.
const SAMPLE_UNIT: AccelerationUnit = AccelerationUnit::Gal;

/// Entries of the header that are used.
#[derive(Default)]
struct AfadHeader {
    /// Time step, s.
    interval: Option<f64>,
    /// Number of samples.
    points: Option<usize>,
    /// Text of the peaks, gal.
    peaks: String,
}

impl AfadHeader {
    /// Stores the value of a line `KEY : value`.
    fn read(&mut self, key: &str, value: &str) -> FaultResult<()> {
        let upper = key.to_ascii_uppercase();
        if upper.starts_with("NUMBER OF DATA") {
            self.points = HeaderNumber::Points.read(value)?.and_then(sample_count);
        } else if let Some(unit) = upper.strip_prefix("SAMPLING INTERVAL") {
            self.interval = HeaderNumber::TimeStep.read(&format!("{value} {}", unit.trim()))?;
        } else if upper.contains("PGA") {
            check_acceleration(key, SAMPLE_UNIT)?;
            self.peaks = value.to_ascii_uppercase();
        }
        Ok(())
    }

    /// Peak of a component, gal; zero if there is none: `(N-S) 13.2 (E-W) 12.2`.
    fn peak(&self, name: &str) -> FaultResult<f64> {
        let name = name.split(['(', '[']).next().unwrap_or(name).trim().to_ascii_uppercase();
        let text = self.peaks.split_once(&format!("({name})")).map_or("", |(_, text)| text);
        match text.split_whitespace().next() {
            Some(word) => finite(word).ok_or_else(|| unclear("peak acceleration", word)),
            None => Ok(0.0),
        }
    }
}

/// Reads all components.
fn read(lines: &mut Lines) -> LineResult<Vec<Series>> {
    let AfadHead { header, names, first_row } = read_head(lines)?;
    let step = header.interval.filter(|&step| step > 0.0);
    let step = required(lines, step, "sampling interval (SAMPLING INTERVAL)")?;
    let needed = required(lines, header.points, "number of samples (NUMBER OF DATA)")?;
    let factor = SAMPLE_UNIT.in_metres_per_second_squared();
    let mut columns = vec![Vec::new(); names.len()];
    let mut row = first_row;
    while !row.is_empty() {
        if row.len() != names.len() {
            return Err(lines.fault(unequal_columns(row.len(), names.len())));
        }
        for (column, value) in columns.iter_mut().zip(&row) {
            column.push(value * factor);
        }
        row = next_row(lines)?;
    }
    let found = columns[0].len();
    if found != needed {
        return Err(lines.fault(wrong_count(found, needed)));
    }
    let mut components = Vec::new();
    for (name, samples) in names.into_iter().zip(columns) {
        let peak = lines.with_line_number(header.peak(&name))?;
        lines.with_line_number(agreement::peak(&samples, peak * factor))?;
        components.push(Series { name, step, samples });
    }
    Ok(components)
}

/// The numbers of the next line that is not empty; none at the end of the file.
fn next_row(lines: &mut Lines) -> LineResult<Vec<f64>> {
    let mut row = Vec::new();
    while row.is_empty() {
        let Some(line) = lines.next()? else { break };
        lines.with_line_number(push_numbers(&line, &mut row))?;
    }
    Ok(row)
}

/// The lines of a file up to the first line of numbers.
struct AfadHead {
    header: AfadHeader,
    /// Names of the components.
    names: Vec<String>,
    /// Numbers of the first line.
    first_row: Vec<f64>,
}

fn read_head(lines: &mut Lines) -> LineResult<AfadHead> {
    let mut header = AfadHeader::default();
    let mut previous_line = String::new();
    while let Some(line) = lines.next()? {
        if let Some((key, value)) = line.split_once(':') {
            lines.with_line_number(header.read(key.trim(), value.trim()))?;
        } else if !line.is_empty() && line.split_whitespace().all(is_like_number) {
            let mut first_row = Vec::new();
            lines.with_line_number(push_numbers(&line, &mut first_row))?;
            let names = titles_of_words(&previous_line);
            if names.is_empty() {
                break;
            }
            for name in &names {
                lines.with_line_number(check_acceleration(name, SAMPLE_UNIT))?;
            }
            return Ok(AfadHead { header, names, first_row });
        }
        if !line.is_empty() {
            previous_line = line;
        }
    }
    let quantity = "line with the names of the components, and numbers below it";
    Err(lines.fault(FileFault::missing(quantity)))
}
