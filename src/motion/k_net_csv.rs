//! Records of K-NET and KiK-net with commas.
//!
//! Layout: the CSV files of the National Research Institute for Earth Science and Disaster Resilience
//! (kyoshin.bosai.go.jp), whose header has the keys of the ASCII files (`man/knetform_en.html`) behind `#`; the last line
//! of the header names the columns, of which the first is the time of day.

use std::io::Read;

use super::clock::Clock;
use super::column_title::check_acceleration;
use super::fault::{drifting, not_a_number, not_in_header, unequal_columns};
use super::header_number::HeaderNumber;
use super::lines::{Lines, Reason, Series, component, number, record, records};
use super::{AccelerationUnit, Record, RecordFormat, agreement};
use crate::error::{FileFault, Result};

const GAL: AccelerationUnit = AccelerationUnit::Gal;
/// Difference of a time from equal steps that counts as rounding, in units of the times' last digit.
///
/// Half a unit for this time and half a unit for the first time, but less than both together.
const ROUNDING: f64 = 0.99;

/// The CSV files of the Japanese networks K-NET and KiK-net.
///
/// One file has all components of a station, side by side.
///
/// A header of lines `#Key,value`, among them `#Sampling Freq(Hz),100`, and one with the names of the columns,
/// `#Time,NS,EW,UD`; then the time of day (or seconds) and the components in gal. The times must advance by the
/// sampling interval. [`Record::read_all`] returns all components. If the samples have an offset, call
/// [`Record::with_baseline`] afterwards. [`KNetFormat`](super::KNetFormat) reads the ASCII files.
///
/// ```
/// use basemat::motion::{KNetCsvFormat, Record};
/// let text = "#Origin Time,2024/01/01 12:00:00\n#Sampling Freq(Hz),100\n#Time,NS,EW,UD\n\
///     12:00:15.00,0.10,0.20,0.30\n12:00:15.01,0.11,0.21,0.31\n";
/// let record = Record::from_reader("X.csv", text.as_bytes(), &KNetCsvFormat { component: 2 })?;
/// assert_eq!((record.time_step(), record.accelerations()), (0.01, &[0.002, 0.0021][..]));
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct KNetCsvFormat {
    /// Number of the component, counted from 1 in the order of the file.
    pub component: usize,
}

impl Default for KNetCsvFormat {
    /// The first component, mostly north–south.
    fn default() -> Self {
        Self { component: 1 }
    }
}

impl RecordFormat for KNetCsvFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        record(name, component(self.component, read(&mut Lines::new(source))))
    }

    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        records(name, read(&mut Lines::new(source)))
    }
}

/// Entries of the header that are used.
#[derive(Default)]
struct Header {
    frequency: Option<f64>,
    duration: Option<f64>,
    /// Peaks, gal.
    peaks: Vec<f64>,
    /// Names of the columns.
    names: Vec<String>,
}

impl Header {
    fn read(&mut self, fields: &[&str]) -> std::result::Result<(), FileFault> {
        let [key, values @ ..] = fields else { return Ok(()) };
        let value = values.first().copied().unwrap_or("");
        let key = key.trim_start_matches('#').trim_start().to_ascii_lowercase();
        if key.starts_with("sampling freq") {
            self.frequency = HeaderNumber::Frequency.read(value)?;
        } else if key.starts_with("duration time") {
            self.duration = HeaderNumber::Duration.read(value)?;
        } else if key.starts_with("max") && key.contains("acc") {
            check_acceleration(&key, GAL)?;
            self.peaks.clear();
            for value in values {
                self.peaks.extend(HeaderNumber::Peak.read(value)?);
            }
        }
        self.names = fields.iter().map(|&name| name.to_owned()).collect();
        Ok(())
    }

    /// Peak of the component in a column from 1, gal; zero if there is none.
    fn peak(&self, column: usize) -> f64 {
        // A single peak may belong to any component.
        let index = column.checked_sub(1).filter(|_| self.peaks.len() + 1 == self.names.len());
        index.and_then(|index| self.peaks.get(index).copied()).unwrap_or(0.0)
    }
}

fn read(lines: &mut Lines) -> Reason<Vec<Series>> {
    let mut header = Header::default();
    let mut clock = Clock::default();
    let mut times = Vec::new();
    let mut columns: Vec<Vec<f64>> = Vec::new();
    while let Some(line) = lines.next()? {
        // A spreadsheet fills short lines with empty cells.
        let line = line.trim_end_matches([',', ' ', '\t']);
        if line.is_empty() {
            continue;
        }
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        let time = if line.starts_with('#') { None } else { clock.read(fields[0]) };
        let Some(time) = time else {
            if columns.is_empty() {
                header.read(&fields).map_err(|reason| lines.refuse(reason))?;
                continue;
            }
            return Err(lines.refuse(not_a_number(fields[0])));
        };
        if columns.is_empty() {
            columns.resize(header.names.len().saturating_sub(1), Vec::new());
        }
        let (found, expected) = (fields.len(), header.names.len());
        if found != expected || expected < 2 {
            return Err(lines.refuse(unequal_columns(found, expected)));
        }
        times.push(time);
        for (k, column) in columns.iter_mut().enumerate() {
            let value = number(fields[k + 1]).map_err(|reason| lines.refuse(reason))?;
            column.push(value * GAL.in_metres_per_second_squared());
        }
    }
    check(&header, &times, clock.resolution().unwrap_or(0.0), &columns)
        .map_err(|reason| lines.refuse(reason))
}

/// Error unless header, times and samples agree; returns the components.
fn check(
    header: &Header,
    times: &[f64],
    resolution: f64,
    columns: &[Vec<f64>],
) -> std::result::Result<Vec<Series>, FileFault> {
    let missing = || not_in_header("sampling frequency (`Sampling Freq(Hz)`)");
    let frequency = header.frequency.filter(|&frequency| frequency > 0.0).ok_or_else(missing)?;
    let step = 1.0 / frequency;
    for (k, &time) in times.iter().enumerate() {
        let expected = times[0] + k as f64 * step;
        if (time - expected).abs() > ROUNDING * resolution + 0.01 * step {
            return Err(drifting(time, expected));
        }
    }
    if let Some(stated) = header.duration {
        agreement::duration(times.len(), step, stated, 0.0)?;
    }
    let mut components = Vec::new();
    for (k, samples) in columns.iter().enumerate() {
        let name = &header.names[k + 1];
        check_acceleration(name, GAL)?;
        agreement::peak(samples, header.peak(k + 1) * GAL.in_metres_per_second_squared())?;
        components.push(Series { name: name.clone(), step, samples: samples.clone() });
    }
    Ok(components)
}
