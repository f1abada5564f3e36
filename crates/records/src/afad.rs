//! Records of the Turkish national strong-motion network (AFAD).
//!
//! Layout: the `.txt` files of the Turkish National Strong-Motion Network, Disaster and Emergency Management Presidency
//! (AFAD), with the heading `STRONG GROUND MOTION RECORDS OF TURKIYE`: lines `KEY : value`, a line with the names of
//! the components, then one line of samples in gal for each time step.

use super::column_title::check_acceleration;
use super::fault::{FaultResult, unclear, unequal_columns};
use super::format::read_components;
use super::header_line::titles_of_words;
use super::header_number::HeaderNumber;
use super::lines::{LineResult, Lines, is_like_number, push_numbers, required};
use super::series::{Series, check_sample_count, whole_sample_count};
use super::{AccelerationUnit, agreement};
use crate::error::FileFault;
use crate::text::decimal::finite;

/// The text files of the Turkish network (AFAD).
///
/// One file has all components of a station, side by side.
///
/// The file has a header of lines `KEY : value`, among them `NUMBER OF DATA` and `SAMPLING INTERVAL (sec)`. A line with
/// the names of the components, `N-S  E-W  U-D`, and the samples in gal follow.
/// [`Record::read_all`](super::Record::read_all) returns all components. Reading returns an error if the number of samples or the peaks
/// (`RAW PGA VALUES (gal)`) differ from the header, or if the header names a unit of acceleration other than gal. Newer
/// files of AFAD (`.asc`) have the layout of [`EsmFormat`](super::EsmFormat).
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

read_components!(AfadFormat);

/// Unit of the samples and of their peaks.
const SAMPLE_UNIT: AccelerationUnit = AccelerationUnit::Gal;

/// Values of a header that describe its samples.
#[derive(Default)]
struct AfadHeader {
    /// Time step, s.
    time_step: Option<f64>,
    /// Number of samples.
    sample_count: Option<usize>,
    /// Text of the peaks (gal), in upper case: `(N-S) 13.2 (E-W) 12.2`.
    peaks_text: String,
}

impl AfadHeader {
    /// Stores the value of a line `KEY : value`.
    fn read(&mut self, key: &str, value: &str) -> FaultResult<()> {
        let upper_case_key = key.to_ascii_uppercase();
        if upper_case_key.starts_with("NUMBER OF DATA") {
            self.sample_count = HeaderNumber::Points.read(value)?.and_then(whole_sample_count);
        } else if let Some(unit) = upper_case_key.strip_prefix("SAMPLING INTERVAL") {
            self.time_step = HeaderNumber::TimeStep.read(&format!("{value} {}", unit.trim()))?;
        } else if upper_case_key.contains("PGA") {
            check_acceleration(key, SAMPLE_UNIT)?;
            self.peaks_text = value.to_ascii_uppercase();
        }
        Ok(())
    }

    /// Peak of a component, gal; zero if the header states none.
    fn peak_in_gal(&self, name: &str) -> FaultResult<f64> {
        let name = name.split(['(', '[']).next().unwrap_or(name).trim().to_ascii_uppercase();
        let peak_text =
            self.peaks_text.split_once(&format!("({name})")).map_or("", |(_, text)| text);
        match peak_text.split_whitespace().next() {
            Some(word) => finite(word).ok_or_else(|| unclear("peak acceleration", word)),
            None => Ok(0.0),
        }
    }
}

/// Reads all components of a file.
fn read(lines: &mut Lines) -> LineResult<Vec<Series>> {
    let AfadPreamble { header, names, first_row } = read_preamble(lines)?;
    let time_step = header.time_step.filter(|&time_step| time_step > 0.0);
    let time_step = required(lines, time_step, "sampling interval (SAMPLING INTERVAL)")?;
    let expected_count =
        required(lines, header.sample_count, "number of samples (NUMBER OF DATA)")?;
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
    check_sample_count(lines, columns[0].len(), expected_count)?;
    let mut components = Vec::new();
    for (name, samples) in names.into_iter().zip(columns) {
        let peak = lines.with_line_number(header.peak_in_gal(&name))?;
        lines.with_line_number(agreement::check_peak(&samples, peak * factor))?;
        components.push(Series { name, time_step, samples });
    }
    Ok(components)
}

/// Numbers of the next line that is not empty; no numbers at the file's end.
fn next_row(lines: &mut Lines) -> LineResult<Vec<f64>> {
    let mut row = Vec::new();
    while row.is_empty() {
        let Some(line) = lines.next()? else { break };
        lines.with_line_number(push_numbers(&line, &mut row))?;
    }
    Ok(row)
}

/// Contents of the lines up to the first line of numbers.
struct AfadPreamble {
    header: AfadHeader,
    /// Names of the components.
    names: Vec<String>,
    /// Numbers of the first line.
    first_row: Vec<f64>,
}

/// Reads the lines up to the first line of numbers, this line included.
fn read_preamble(lines: &mut Lines) -> LineResult<AfadPreamble> {
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
            return Ok(AfadPreamble { header, names, first_row });
        }
        if !line.is_empty() {
            previous_line = line;
        }
    }
    let quantity = "line with the names of the components, and numbers below it";
    Err(lines.fault(FileFault::missing(quantity)))
}
