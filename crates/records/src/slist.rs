//! Records as sample lists in text, of the FDSN web services and ObsPy.
//!
//! Layout: EarthScope Data Services, *Simple ASCII time series formats* (service.iris.edu/irisws/timeseries/docs): for
//! each series a line `TIMESERIES network_station_location_channel_quality, 200 samples, 100 sps, start, SLIST, FLOAT,
//! units`, then the samples along the lines, six on each.

use std::io::Read;

use super::block::is_raw_unit;
use super::fault::{FaultResult, not_acceleration, not_in_header, unprocessed};
use super::lines::{LineResult, Lines, push_numbers};
use super::series::{
    Series, check_sample_count, multiplied, select_component, to_record, to_records,
    whole_sample_count,
};
use super::{AccelerationUnit, Record, RecordFormat};
use crate::error::{FileFault, Result};
use crate::text::decimal::{finite, quoted};

/// The `SLIST` files of the FDSN web services and of ObsPy.
///
/// Each series has a header with the number of samples, the samples per second and the unit. The samples follow along
/// the lines.
/// [`Record::read_all`] returns all series. Counts of a recorder, pairs of time and sample (`TSPAIR`) and series in
/// several pieces are errors.
///
/// ```
/// use basemat::motion::{Record, SlistFormat};
/// let text = "TIMESERIES XX_STA1_00_HNE_D, 4 samples, 100 sps, 2020-01-01T00:00:00.000000, SLIST, FLOAT, M/S**2\n\
///     0.0\t0.5\t-0.2\n0.1\n";
/// let record = Record::from_reader("sta1.txt", text.as_bytes(), &SlistFormat::default())?;
/// assert_eq!((record.time_step(), record.accelerations()), (0.01, &[0.0, 0.5, -0.2, 0.1][..]));
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct SlistFormat {
    /// Number of the series, counted from 1 in the order of the file.
    pub component: usize,
    /// Unit of files whose header has none.
    pub unit: Option<AccelerationUnit>,
}

impl Default for SlistFormat {
    /// The first series, in the unit of its header.
    fn default() -> Self {
        Self { component: 1, unit: None }
    }
}

impl RecordFormat for SlistFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        to_record(name, select_component(self.component, read(&mut Lines::new(source), self.unit)))
    }

    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        to_records(name, read(&mut Lines::new(source), self.unit))
    }
}

/// Contents of the line before the samples of a series.
struct SlistHeader {
    name: String,
    /// Number of samples.
    sample_count: usize,
    /// Time step, s.
    time_step: f64,
    unit: AccelerationUnit,
}

impl SlistHeader {
    /// Reads the line `TIMESERIES …`.
    ///
    /// `expected_unit`: unit of a line that names none, and the only unit that a line may name.
    fn read(line: &str, expected_unit: Option<AccelerationUnit>) -> FaultResult<Self> {
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        let name = fields[0].strip_prefix("TIMESERIES").map(str::trim);
        let name = name.ok_or_else(|| FileFault::format(quoted(line), "a line `TIMESERIES …`"))?;
        let sample_count = number_before("samples", fields.get(1)).and_then(whole_sample_count);
        let sample_count = sample_count.ok_or_else(|| not_in_header("number of samples"))?;
        let sampling_rate =
            number_before("sps", fields.get(2)).filter(|&sampling_rate| sampling_rate > 0.0);
        let sampling_rate =
            sampling_rate.ok_or_else(|| not_in_header("number of samples a second (sps)"))?;
        let layout = fields.get(4).copied().unwrap_or("");
        if layout != "SLIST" {
            return Err(FileFault::format(quoted(layout), "SLIST, samples along the lines"));
        }
        let unit = match fields.get(6).copied().unwrap_or("") {
            "" => expected_unit.ok_or_else(|| not_in_header("unit"))?,
            name if is_raw_unit(&name.to_lowercase()) => {
                return Err(unprocessed(line, "counts of a recorder"));
            }
            name => {
                let unit = AccelerationUnit::named(name);
                let unit =
                    unit.filter(|unit| expected_unit.is_none_or(|expected| expected == *unit));
                unit.ok_or_else(|| not_acceleration(name))?
            }
        };
        Ok(Self { name: name.to_owned(), sample_count, time_step: 1.0 / sampling_rate, unit })
    }
}

/// The number before a word that ends a field: `4 samples`.
fn number_before(word: &str, field: Option<&&str>) -> Option<f64> {
    finite(field?.strip_suffix(word)?.trim_end())
}

/// Reads all series of a file.
///
/// `expected_unit`: unit of headers that name none.
fn read(lines: &mut Lines, expected_unit: Option<AccelerationUnit>) -> LineResult<Vec<Series>> {
    let mut all_series: Vec<Series> = Vec::new();
    let mut next_line = lines.next()?;
    while let Some(line) = next_line {
        if line.is_empty() {
            next_line = lines.next()?;
            continue;
        }
        let header = lines.with_line_number(SlistHeader::read(&line, expected_unit))?;
        if all_series.iter().any(|series| series.name == header.name) {
            let found = format!("second piece of {}", quoted(&header.name));
            let needed = "series without gaps: one piece of each";
            return Err(lines.fault(FileFault::format(found, needed)));
        }
        let mut values = Vec::new();
        next_line = lines.next()?;
        while let Some(line) = next_line.take_if(|line| !line.starts_with("TIMESERIES")) {
            lines.with_line_number(push_numbers(&line, &mut values))?;
            next_line = lines.next()?;
        }
        check_sample_count(lines, values.len(), header.sample_count)?;
        let samples = multiplied(values, header.unit.in_metres_per_second_squared());
        all_series.push(Series { name: header.name, time_step: header.time_step, samples });
    }
    Ok(all_series)
}
