//! Records of K-NET and KiK-net with commas.
//!
//! Layout: the CSV files of the National Research Institute for Earth Science and Disaster Resilience
//! (kyoshin.bosai.go.jp), whose header has the keys of the ASCII files (`man/knetform_en.html`) behind `#`; the last
//! line of the header names the columns, of which the first is the time of day.

use super::clock::Clock;
use super::column_title::check_acceleration;
use super::fault::{FaultResult, not_a_number, not_in_header, unequal_columns, unequal_time_step};
use super::format::read_components;
use super::header_number::HeaderNumber;
use super::lines::{LineResult, Lines, finite_number};
use super::series::Series;
use super::{AccelerationUnit, agreement};

/// Unit of the samples and of their peaks.
const SAMPLE_UNIT: AccelerationUnit = AccelerationUnit::Gal;
/// Largest difference of a time from equal steps because of rounding.
///
/// It is in units of the times' last digit.
///
/// Rounding changes this time and the first one by half a unit each; the sum of both is excluded.
const TIME_ROUNDING_DIGITS: f64 = 0.99;
/// Largest difference of an exact time from equal steps, relative to the step.
const TIME_STEP_TOLERANCE: f64 = 0.01;

/// The CSV files of the Japanese networks K-NET and KiK-net.
///
/// One file has all components of a station, side by side.
///
/// The file has a header of lines `#Key,value`, among them `#Sampling Freq(Hz),100`, and a line with the names of the
/// columns, `#Time,NS,EW,UD`. Lines with the time of day (or seconds) and the components in gal follow. The times must
/// advance by the sampling interval. [`Record::read_all`](super::Record::read_all) returns all components. If the
/// samples have an offset, call [`Record::with_baseline`](super::Record::with_baseline) afterwards.
/// [`KNetFormat`](super::KNetFormat) reads the ASCII files.
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

read_components!(KNetCsvFormat);

/// Values of a header that describe its samples.
#[derive(Default)]
struct KNetCsvHeader {
    /// Sampling frequency, Hz.
    sampling_frequency: Option<f64>,
    /// Duration, s.
    duration: Option<f64>,
    /// Peaks, gal.
    peaks_in_gal: Vec<f64>,
    /// Fields of the last line, which names the columns.
    column_names: Vec<String>,
}

impl KNetCsvHeader {
    /// Stores the values of a line `#Key,value`.
    fn read(&mut self, fields: &[&str]) -> FaultResult<()> {
        let Some((key, values)) = fields.split_first() else { return Ok(()) };
        let value = values.first().copied().unwrap_or("");
        let key = key.trim_start_matches('#').trim_start().to_ascii_lowercase();
        if key.starts_with("sampling freq") {
            self.sampling_frequency = HeaderNumber::Frequency.read(value)?;
        } else if key.starts_with("duration time") {
            self.duration = HeaderNumber::Duration.read(value)?;
        } else if key.starts_with("max") && key.contains("acc") {
            check_acceleration(&key, SAMPLE_UNIT)?;
            self.peaks_in_gal.clear();
            for value in values {
                self.peaks_in_gal.extend(HeaderNumber::Peak.read(value)?);
            }
        }
        self.column_names = fields.iter().map(|&name| name.to_owned()).collect();
        Ok(())
    }

    /// Peak of a component, gal; zero if the header states none.
    ///
    /// `index`: of the component, from 0.
    fn peak_in_gal(&self, index: usize) -> f64 {
        // Fewer peaks than components do not show to which component each belongs.
        let has_all_peaks = self.peaks_in_gal.len() + 1 == self.column_names.len();
        self.peaks_in_gal.get(index).copied().filter(|_| has_all_peaks).unwrap_or(0.0)
    }
}

/// Reads all components of a file.
fn read(lines: &mut Lines) -> LineResult<Vec<Series>> {
    let mut header = KNetCsvHeader::default();
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
                lines.with_line_number(header.read(&fields))?;
                continue;
            }
            return Err(lines.fault(not_a_number(fields[0])));
        };
        let column_count = header.column_names.len();
        if columns.is_empty() {
            columns.resize(column_count.saturating_sub(1), Vec::new());
        }
        if fields.len() != column_count || column_count < 2 {
            return Err(lines.fault(unequal_columns(fields.len(), column_count)));
        }
        times.push(time);
        for (column, field) in columns.iter_mut().zip(&fields[1..]) {
            let value = lines.with_line_number(finite_number(field))?;
            column.push(value * SAMPLE_UNIT.in_metres_per_second_squared());
        }
    }
    lines.with_line_number(components(&header, &times, clock.resolution().unwrap_or(0.0), &columns))
}

/// Makes the components; an error unless header, times and samples agree.
///
/// `resolution`: unit of the last digit of the times, s.
fn components(
    header: &KNetCsvHeader,
    times: &[f64],
    resolution: f64,
    columns: &[Vec<f64>],
) -> FaultResult<Vec<Series>> {
    let frequency = header.sampling_frequency.filter(|&frequency| frequency > 0.0);
    let frequency =
        frequency.ok_or_else(|| not_in_header("sampling frequency (`Sampling Freq(Hz)`)"))?;
    let time_step = 1.0 / frequency;
    for (index, &time) in times.iter().enumerate() {
        let expected_time = times[0] + index as f64 * time_step;
        if (time - expected_time).abs()
            > TIME_ROUNDING_DIGITS * resolution + TIME_STEP_TOLERANCE * time_step
        {
            return Err(unequal_time_step(time, expected_time));
        }
    }
    if let Some(stated_duration) = header.duration {
        agreement::check_duration(times.len(), time_step, stated_duration, 0.0)?;
    }
    let mut components = Vec::new();
    for (index, samples) in columns.iter().enumerate() {
        let name = &header.column_names[index + 1];
        check_acceleration(name, SAMPLE_UNIT)?;
        let peak = header.peak_in_gal(index) * SAMPLE_UNIT.in_metres_per_second_squared();
        agreement::check_peak(samples, peak)?;
        components.push(Series { name: name.clone(), time_step, samples: samples.clone() });
    }
    Ok(components)
}
