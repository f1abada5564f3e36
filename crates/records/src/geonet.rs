//! Records of New Zealand's network GeoNet.
//!
//! Layout: GNS Science, *Strong-motion data file formats* (geonet.org.nz), volumes 1 and 2: for each component 16 lines
//! of text, 40 integers as `10I8`, 60 reals as `10F8`, then acceleration, and in volume 2 velocity and displacement, as
//! `10F8.1` in mm/s², in which numbers may touch.

use super::fault::{FaultResult, not_acceleration};
use super::format::read_components;
use super::fortran_format::FortranFormat;
use super::header_number::HeaderNumber;
use super::lines::{LineResult, Lines, read_numbers, required};
use super::series::{Series, multiplied, whole_sample_count};
use super::unit_name::is_unit;
use super::{AccelerationUnit, agreement};
use crate::error::FileFault;
use crate::text::decimal::finite;

/// The `.V1A` and `.V2A` files of GeoNet (New Zealand).
///
/// One file has all components of a station, one after the other.
///
/// Samples are in mm/s² times the unit of the readings (`Raw readings in units of 1.00 mm/s/s`). The header states
/// interval, number of points and duration in words and in numbers, which must agree, and the peak of each component.
/// [`Record::read_all`](super::Record::read_all) returns all components. Velocity and displacement are skipped.
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

read_components!(GeoNetFormat);

/// Number of lines of text at the beginning of a component.
const TEXT_LINE_COUNT: usize = 16;
/// Number of whole numbers after the text.
const INTEGER_COUNT: usize = 40;
/// Number of real numbers after the whole ones.
const REAL_COUNT: usize = 60;
/// Index, from 0, of the number of samples in the whole numbers.
const SAMPLE_COUNT_INDEX: usize = 33;
/// Index, from 0, of the number of velocities in the whole numbers.
const VELOCITY_COUNT_INDEX: usize = 34;
/// Index, from 0, of the number of displacements in the whole numbers.
const DISPLACEMENT_COUNT_INDEX: usize = 35;
/// Index, from 0, of the time step (s) in the real numbers.
const TIME_STEP_INDEX: usize = 25;
/// Columns of the whole numbers.
const INTEGER_FORMAT: FortranFormat = FortranFormat { repeat: 10, width: 8, decimals: 0, scale: 0 };
/// Columns of the real numbers and of the samples.
const REAL_FORMAT: FortranFormat = FortranFormat { repeat: 10, width: 8, decimals: 1, scale: 0 };
/// Unit in which the text states readings and peaks.
const TEXT_UNIT: AccelerationUnit = AccelerationUnit::MillimetrePerSecondSquared;
/// Numbers in a line of velocity or displacement.
const NUMBERS_PER_LINE: f64 = 10.0;

/// Quantities that the lines of text state.
#[derive(Default)]
struct GeoNetHeader {
    /// Name of the component.
    name: String,
    /// Number of samples.
    sample_count: Option<f64>,
    /// Duration, s.
    duration: Option<f64>,
    /// Time step, s.
    time_step: Option<f64>,
    /// Unit of the samples, mm/s².
    unit: Option<f64>,
    /// Peak acceleration, mm/s²; zero if the text states none.
    peak: f64,
}

impl GeoNetHeader {
    /// Stores the quantities of a line.
    fn read(&mut self, line: &str) -> FaultResult<()> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let lower_case_line = line.to_ascii_lowercase();
        if lower_case_line.starts_with("number of points") {
            self.sample_count = number_after("points", &words);
            self.duration = number_after("duration", &words);
        } else if lower_case_line.starts_with("component") {
            words.get(1).copied().unwrap_or("").clone_into(&mut self.name);
        } else if lower_case_line.starts_with("acceleration:") && lower_case_line.contains("mm/s/s")
        {
            self.peak = number_after("peak", &words).unwrap_or(0.0);
            self.unit.get_or_insert(1.0);
        } else if lower_case_line.starts_with("acceleration:")
            && words.iter().any(|word| is_unit(word))
        {
            return Err(not_acceleration(line));
        } else if let Some((_, text)) = lower_case_line.split_once("in units of") {
            let value = text.split_once("mm/s/s").map_or("", |(value, _)| value);
            self.unit = HeaderNumber::Peak.read(value)?;
        }
        // `at intervals of 0.005 s`, `at 0.020 sec intervals`.
        if let Some((_, text)) = lower_case_line.split_once("intervals of") {
            self.time_step = text.split_whitespace().next().and_then(finite);
        } else if lower_case_line.contains("intervals") {
            self.time_step = number_after("at", &words);
        }
        Ok(())
    }

    /// Returns an error unless the samples have the stated number, time step, duration and peak.
    fn check(&self, samples: &[f64], time_step: f64) -> FaultResult<()> {
        let sample_count = samples.len();
        if let Some(stated_count) = self.sample_count {
            agreement::check_number("number of points", sample_count as f64, stated_count)?;
        }
        if let Some(stated_step) = self.time_step {
            agreement::check_number("time step (s)", time_step, stated_step)?;
        }
        if let Some(stated_duration) = self.duration {
            agreement::check_duration(sample_count, time_step, stated_duration, 0.0)?;
        }
        agreement::check_peak(samples, self.peak * TEXT_UNIT.in_metres_per_second_squared())
    }
}

/// The number behind a word of a line.
fn number_after(key: &str, words: &[&str]) -> Option<f64> {
    let index = words.iter().position(|word| word.eq_ignore_ascii_case(key))?;
    finite(words.get(index + 1)?)
}

/// Reads all components of a file.
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
    for _ in 1..TEXT_LINE_COUNT {
        let Some(line) = lines.next()? else {
            return Err(lines.fault(FileFault::missing("header of 16 lines")));
        };
        lines.with_line_number(header.read(&line))?;
    }
    let integers = read_numbers(lines, INTEGER_COUNT, Some(INTEGER_FORMAT))?;
    let reals = read_numbers(lines, REAL_COUNT, Some(REAL_FORMAT))?;
    let sample_count = whole_sample_count(integers[SAMPLE_COUNT_INDEX]);
    let sample_count = required(lines, sample_count, "number of points (34th integer)")?;
    let time_step = Some(reals[TIME_STEP_INDEX]).filter(|&time_step| time_step > 0.0);
    let time_step = required(lines, time_step, "sampling interval (26th real)")?;
    let unit = required(lines, header.unit.filter(|&unit| unit > 0.0), "unit (mm/s/s)")?;
    let factor = unit * TEXT_UNIT.in_metres_per_second_squared();
    let samples = multiplied(read_numbers(lines, sample_count, Some(REAL_FORMAT))?, factor);
    lines.with_line_number(header.check(&samples, time_step))?;
    let velocity_count = integers[VELOCITY_COUNT_INDEX];
    let displacement_count = integers[DISPLACEMENT_COUNT_INDEX];
    skip_numbers(lines, velocity_count)?;
    skip_numbers(lines, displacement_count)?;
    Ok(Series { name: header.name, time_step, samples })
}

/// Skips the lines of a block of `count` numbers, in full lines of ten.
fn skip_numbers(lines: &mut Lines, count: f64) -> LineResult<()> {
    let mut remaining_count = count;
    while remaining_count > 0.0
        && let Some(line) = lines.next()?
    {
        remaining_count -= if line.is_empty() { 0.0 } else { NUMBERS_PER_LINE };
    }
    Ok(())
}
