//! Records of the Turkish national strong-motion network (AFAD).
//!
//! Layout: the `.txt` files of the Turkish National Strong-Motion Network, Disaster and Emergency Management Presidency
//! (AFAD), with the heading `STRONG GROUND MOTION RECORDS OF TURKIYE`: lines `KEY : value`, a line with the names of
//! the components, then a line a time step, in gal.

use std::io::Read;

use super::column_title::check_acceleration;
use super::fault::{not_in_header, unclear, unequal_columns};
use super::header_line::titles_of_words;
use super::header_number::HeaderNumber;
use super::lines::{
    Lines, Reason, Series, component, count, is_like_number, push_numbers, record, records,
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
        record(name, component(self.component, read(&mut Lines::new(source))))
    }

    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        records(name, read(&mut Lines::new(source)))
    }
}

const GAL: AccelerationUnit = AccelerationUnit::Gal;

/// Entries of the header that are used.
#[derive(Default)]
struct Header {
    interval: Option<f64>,
    points: Option<usize>,
    /// Text of the peaks, gal.
    peaks: String,
}

impl Header {
    fn read(&mut self, key: &str, value: &str) -> std::result::Result<(), FileFault> {
        let upper = key.to_ascii_uppercase();
        if upper.starts_with("NUMBER OF DATA") {
            self.points = HeaderNumber::Points.read(value)?.and_then(count);
        } else if let Some(unit) = upper.strip_prefix("SAMPLING INTERVAL") {
            self.interval = HeaderNumber::TimeStep.read(&format!("{value} {}", unit.trim()))?;
        } else if upper.contains("PGA") {
            check_acceleration(key, GAL)?;
            self.peaks = value.to_ascii_uppercase();
        }
        Ok(())
    }

    /// Peak of a component, gal; zero if there is none: `(N-S) 13.2 (E-W) 12.2`.
    fn peak(&self, name: &str) -> std::result::Result<f64, FileFault> {
        let name = name.split(['(', '[']).next().unwrap_or(name).trim().to_ascii_uppercase();
        let text = self.peaks.split_once(&format!("({name})")).map_or("", |(_, text)| text);
        match text.split_whitespace().next() {
            Some(word) => finite(word).ok_or_else(|| unclear("peak acceleration", word)),
            None => Ok(0.0),
        }
    }
}

fn read(lines: &mut Lines) -> Reason<Vec<Series>> {
    let (header, names, first) = head(lines)?;
    let missing = |quantity| lines.refuse(not_in_header(quantity));
    let step = header.interval.filter(|&step| step > 0.0);
    let step = step.ok_or_else(|| missing("sampling interval (SAMPLING INTERVAL)"))?;
    let needed = header.points.ok_or_else(|| missing("number of samples (NUMBER OF DATA)"))?;
    let gal = GAL.in_metres_per_second_squared();
    let mut columns = vec![Vec::new(); names.len()];
    let mut row = first;
    loop {
        if row.len() != names.len() {
            let (found, expected) = (row.len(), names.len());
            return Err(lines.refuse(unequal_columns(found, expected)));
        }
        for (column, value) in columns.iter_mut().zip(&row) {
            column.push(value * gal);
        }
        row.clear();
        while row.is_empty() {
            let Some(line) = lines.next()? else { break };
            push_numbers(&line, &mut row).map_err(|reason| lines.refuse(reason))?;
        }
        if row.is_empty() {
            break;
        }
    }
    let found = columns[0].len();
    if found != needed {
        return Err(lines.refuse(FileFault::count("samples", found, needed.to_string())));
    }
    let mut components = Vec::new();
    for (name, samples) in names.into_iter().zip(columns) {
        let peak = header.peak(&name);
        peak.and_then(|peak| agreement::peak(&samples, peak * gal))
            .map_err(|reason| lines.refuse(reason))?;
        components.push(Series { name, step, samples });
    }
    Ok(components)
}

/// The header, the names of the components, and the first line of numbers.
fn head(lines: &mut Lines) -> Reason<(Header, Vec<String>, Vec<f64>)> {
    let mut header = Header::default();
    // The line before the numbers.
    let mut title = String::new();
    while let Some(line) = lines.next()? {
        let mut row = Vec::new();
        if let Some((key, value)) = line.split_once(':') {
            let understood = header.read(key.trim(), value.trim());
            understood.map_err(|reason| lines.refuse(reason))?;
        } else if !line.is_empty() && line.split_whitespace().all(is_like_number) {
            push_numbers(&line, &mut row).map_err(|reason| lines.refuse(reason))?;
            let names = titles_of_words(&title);
            if names.is_empty() {
                break;
            }
            let units = names.iter().try_for_each(|name| check_acceleration(name, GAL));
            units.map_err(|reason| lines.refuse(reason))?;
            return Ok((header, names, row));
        }
        if !line.is_empty() {
            title = line;
        }
    }
    let quantity = "line with the names of the components, and numbers below it";
    Err(lines.refuse(FileFault::missing(quantity)))
}
