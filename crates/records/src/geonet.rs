//! Records of New Zealand's network GeoNet.
//!
//! Layout: GNS Science, *Strong-motion data file formats* (geonet.org.nz), volumes 1 and 2: for each component 16 lines
//! of text, 40 integers as `10I8`, 60 reals as `10F8`, then acceleration, and in volume 2 velocity and displacement, as
//! `10F8.1` in mm/s², in which numbers may touch.

use std::io::Read;

use super::fault::{FaultResult, not_acceleration};
use super::fortran_format::FortranFormat;
use super::header_number::HeaderNumber;
use super::lines::{
    LineResult, Lines, Series, read_numbers, required, sample_count, scaled, select_component,
    to_record, to_records,
};
use super::unit_name::is_unit;
use super::{AccelerationUnit, Record, RecordFormat, agreement};
use crate::error::{FileFault, Result};
use crate::text::decimal::finite;

/// The `.V1A` and `.V2A` files of GeoNet (New Zealand).
///
/// One file has all components of a station, one after the other.
///
/// Samples are in mm/s² times the unit of the readings (`Raw readings in units of 1.00 mm/s/s`). The header states
/// interval, number of points and duration in words and in numbers, which must agree, and the peak of each
/// component. [`Record::read_all`] returns all components. Velocity and displacement are skipped.
///
/// ```no_run
/// use basemat::motion::{GeoNetFormat, Record};
/// let record = Record::read("20161113_110300_HSES_20.V2A", &GeoNetFormat { component: 2 })?;
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct GeoNetFormat {
    /// Number of the component, counted from 1 in the order of the file.
    pub component: usize,
}

impl Default for GeoNetFormat {
    /// The first component, a horizontal one.
    fn default() -> Self {
        Self { component: 1 }
    }
}

impl RecordFormat for GeoNetFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        to_record(name, select_component(self.component, read(&mut Lines::new(source))))
    }

    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        to_records(name, read(&mut Lines::new(source)))
    }
}

/// Number of lines of text at the beginning of a component.
const TEXT_LINES: usize = 16;
const INTEGER_FORMAT: FortranFormat = FortranFormat { repeat: 10, width: 8, decimals: 0, scale: 0 };
const REAL_FORMAT: FortranFormat = FortranFormat { repeat: 10, width: 8, decimals: 1, scale: 0 };
/// Numbers in a line of velocity or displacement.
const NUMBERS_PER_LINE: f64 = 10.0;

/// Quantities in the lines of text.
#[derive(Default)]
struct GeoNetHeader {
    /// Name of the component.
    name: String,
    /// Number of samples.
    points: Option<f64>,
    /// Duration, s.
    duration: Option<f64>,
    /// Time step, s.
    interval: Option<f64>,
    /// Unit of the numbers, mm/s².
    unit: Option<f64>,
    /// Peak acceleration, mm/s².
    peak: f64,
}

impl GeoNetHeader {
    /// Stores the quantities of a line.
    fn read(&mut self, line: &str) -> FaultResult<()> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let lower = line.to_ascii_lowercase();
        if lower.starts_with("number of points") {
            self.points = number_after("points", &words);
            self.duration = number_after("duration", &words);
        } else if lower.starts_with("component") {
            words.get(1).copied().unwrap_or("").clone_into(&mut self.name);
        } else if lower.starts_with("acceleration:") && lower.contains("mm/s/s") {
            self.peak = number_after("peak", &words).unwrap_or(0.0);
            self.unit.get_or_insert(1.0);
        } else if lower.starts_with("acceleration:") && words.iter().any(|word| is_unit(word)) {
            return Err(not_acceleration(line));
        } else if let Some((_, text)) = lower.split_once("in units of") {
            let value = text.split_once("mm/s/s").map_or("", |(value, _)| value);
            self.unit = HeaderNumber::Peak.read(value)?;
        }
        // `at intervals of 0.005 s`, `at 0.020 sec intervals`.
        if let Some((_, text)) = lower.split_once("intervals of") {
            self.interval = text.split_whitespace().next().and_then(finite);
        } else if lower.contains("intervals") {
            self.interval = number_after("at", &words);
        }
        Ok(())
    }

    /// Error unless the samples have the stated number, time step, duration and peak.
    fn check(&self, samples: &[f64], step: f64) -> FaultResult<()> {
        let points = samples.len();
        if let Some(stated) = self.points {
            agreement::number("number of points", points as f64, stated)?;
        }
        if let Some(stated) = self.interval {
            agreement::number("time step (s)", step, stated)?;
        }
        if let Some(stated) = self.duration {
            agreement::duration(points, step, stated, 0.0)?;
        }
        agreement::peak(samples, self.peak * 1e-3)
    }
}

/// The number behind a word of a line.
fn number_after(key: &str, words: &[&str]) -> Option<f64> {
    let index = words.iter().position(|word| word.eq_ignore_ascii_case(key))?;
    finite(words.get(index + 1)?)
}

/// Reads all components.
fn read(lines: &mut Lines) -> LineResult<Vec<Series>> {
    let mut components = Vec::new();
    while let Some(first_line) = lines.next()? {
        if first_line.is_empty() {
            continue;
        }
        if !first_line.to_ascii_lowercase().contains("accelerogram") {
            return Err(lines.fault(not_acceleration(&first_line)));
        }
        components.push(read_component(lines)?);
    }
    Ok(components)
}

/// Reads a component after its first line.
fn read_component(lines: &mut Lines) -> LineResult<Series> {
    let mut header = GeoNetHeader::default();
    for _ in 1..TEXT_LINES {
        let Some(line) = lines.next()? else {
            return Err(lines.fault(FileFault::missing("header of 16 lines")));
        };
        lines.with_line_number(header.read(&line))?;
    }
    let integers = read_numbers(lines, 40, Some(INTEGER_FORMAT))?;
    let reals = read_numbers(lines, 60, Some(REAL_FORMAT))?;
    let points = sample_count(integers[33]);
    let points = required(lines, points, "number of points (34th integer)")?;
    let step = Some(reals[25]).filter(|&step| step > 0.0);
    let step = required(lines, step, "sampling interval (26th real)")?;
    let unit = required(lines, header.unit.filter(|&unit| unit > 0.0), "unit (mm/s/s)")?;
    let factor = unit * AccelerationUnit::MillimetrePerSecondSquared.in_metres_per_second_squared();
    let samples = scaled(read_numbers(lines, points, Some(REAL_FORMAT))?, factor);
    lines.with_line_number(header.check(&samples, step))?;
    let velocity_count = integers[34];
    let displacement_count = integers[35];
    skip_numbers(lines, velocity_count)?;
    skip_numbers(lines, displacement_count)?;
    Ok(Series { name: header.name, step, samples })
}

/// Skips the lines of a block of `count` numbers.
fn skip_numbers(lines: &mut Lines, count: f64) -> LineResult<()> {
    let mut remaining = count;
    while remaining > 0.0
        && let Some(line) = lines.next()?
    {
        remaining -= if line.is_empty() { 0.0 } else { NUMBERS_PER_LINE };
    }
    Ok(())
}
