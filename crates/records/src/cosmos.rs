//! Records of CESMD: the COSMOS format, and a reader for COSMOS and CSMIP files.
//!
//! Layout: *COSMOS Strong Motion Data Format, Version 1.20*, Consortium of Organizations for Strong-Motion Observation
//! Systems, 15 August 2001, table of the real header and table 2 (units). The 34th real value is the interval of the
//! recorder in seconds, the 62nd the interval of the data below in milliseconds, the 63rd their length in seconds.

use std::io::Read;

use super::block::{self, DataBlock};
use super::csmip::{self, CsmipHeader};
use super::fault::{FaultResult, not_acceleration, out_of_range, unclear, unprocessed};
use super::lines::{LineResult, Lines, read_numbers};
use super::series::{Series, select_component, to_record, to_records};
use super::{AccelerationUnit, Record, RecordFormat, agreement};
use crate::error::{FileFault, Result};
use crate::text::decimal::finite;

/// The `.V2` and `.V2c` files of the Center for Engineering Strong Motion Data.
///
/// The reader accepts two layouts; in both, a line describes the block of numbers under it:
///
/// * COSMOS 1.20: `12091 acceleration pts, approx 120 secs, units=cm/s^2 (4), Format=(8F10.5)`, with the sampling
///   interval of the data (ms) as the 62nd of the 100 real header values; if this value is unknown (−999), the 34th
///   value is used, the interval of the recorder (s);
/// * CSMIP (California Geological Survey):
///   `15200 points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.6)`, in the 1980s
///   `(UNITS: CM/SEC/SEC)`, and volume 1,
///   `13200 Accelerogram points at 200 pts/sec in units of g .  Format: (8f9.6)`.
///
/// Header and title state interval, number of points, duration, unit and peak more than once. Reading returns an error
/// if these values disagree, if the block has more numbers than announced, and for raw counts (`.V0`) and uncorrected
/// data in unequal steps.
///
/// Numbers are read in the columns of the format that the line names, in which they may touch. They are read
/// without columns where a line does not match the format or none is named. In its column, a number without a
/// decimal point has the decimals of the format, as in Fortran: `12345` under `8F10.3` is 12.345. A format that is
/// not one repeated item is an error. The unit is a whole word, such as `cm/s^2`, `cm/sec/sec`, `gal` or `g`;
/// anything else (counts, `mgal`) is an error, and so is a file that does not name its unit, unless
/// [`CosmosFormat::unit`] does.
///
/// A file may hold several channels one after the other. Blocks of velocity and displacement are skipped:
/// [`channel`](Self::channel) counts acceleration blocks. [`Record::read_all`] returns all channels.
///
/// ```
/// use basemat::motion::{CosmosFormat, Record};
/// let text = "Corrected accelerogram\n\
///     4 points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.3)\n\
///          1.000    -2.000     3.000-12345.678\n\
///     4 points of veloc data equally spaced at  .005 sec, in cm/sec.  (8f10.3)\n\
///     1.000    -2.000     3.000     4.000\n/&  ---- End of data for channel  1 ----\n";
/// let record = Record::from_reader("CE47380.V2", text.as_bytes(), &CosmosFormat::default())?;
/// assert_eq!((record.len(), record.time_step()), (4, 0.005));
/// assert!((record.accelerations()[3] + 123.45678).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct CosmosFormat {
    /// Number of the acceleration block, counted from 1 in the order of the file.
    pub channel: usize,
    /// Unit for files that do not name one; a unit in the file has priority.
    ///
    /// Titles of the 1970s and 1980s end with `EQUALLY SPACED AT .010 SEC.`, without a unit; their numbers are in
    /// cm/s².
    ///
    /// ```
    /// use basemat::motion::{AccelerationUnit, CosmosFormat, Record};
    /// let text = "2 POINTS OF ACCEL DATA EQUALLY SPACED AT  .010 SEC.   (8F10.3)\n 981.0 -490.5\n";
    /// let read = |format| Record::from_reader("old.V2", text.as_bytes(), &format);
    /// assert!(read(CosmosFormat::default()).is_err());
    /// let unit = Some(AccelerationUnit::Gal);
    /// let record = read(CosmosFormat { unit, ..CosmosFormat::default() })?;
    /// assert!((record.peaks().acceleration - 9.81).abs() < 1e-12);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub unit: Option<AccelerationUnit>,
}

impl Default for CosmosFormat {
    /// The first channel, in the unit that the file names.
    fn default() -> Self {
        Self { channel: 1, unit: None }
    }
}

impl RecordFormat for CosmosFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        let channels = read(&mut Lines::new(source), self, Some(self.channel));
        to_record(name, select_component(1, channels))
    }

    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        to_records(name, read(&mut Lines::new(source), self, None))
    }
}

/// Reads the selected channel, or all channels.
///
/// `selected_channel`: number of a block of acceleration, counted from 1; `None` for all.
fn read(
    lines: &mut Lines,
    format: &CosmosFormat,
    selected_channel: Option<usize>,
) -> LineResult<Vec<Series>> {
    let mut channel_count = 0;
    let mut channels = Vec::new();
    let mut cosmos_header = CosmosHeader::default();
    let mut csmip_header = CsmipHeader::default();
    let mut other_titles = OtherTitles::default();
    let mut next_line = None;
    while let Some(line) = match next_line.take() {
        Some(line) => Some(line),
        None => lines.next()?,
    } {
        let lower_case_line = line.to_ascii_lowercase();
        let is_comment = line.starts_with('|');
        if is_comment || cosmos_header.read(lines, &line, &lower_case_line)? {
            continue;
        }
        let block = if csmip::is_title(&lower_case_line) {
            csmip_header.block(&line, format.unit)
        } else if is_title_of(&lower_case_line, &["accel"]) {
            cosmos_header.block(&line, format.unit)
        } else {
            csmip_header.read(&lower_case_line);
            other_titles.read(lines, &line, &lower_case_line);
            continue;
        };
        channel_count += 1;
        if selected_channel.is_none_or(|number| number == channel_count) {
            let block = lines.with_line_number(block)?;
            let (samples, line_after_block) = block.read(lines)?;
            let name = cosmos_header.channel_name.take();
            let name = name.unwrap_or_else(|| format!("channel {channel_count}"));
            channels.push(Series { name, time_step: block.time_step, samples });
            next_line = line_after_block;
        }
        if selected_channel.is_some_and(|number| number == channel_count) {
            return Ok(channels);
        }
        cosmos_header = CosmosHeader::default();
        csmip_header = CsmipHeader::default();
    }
    if channel_count > 0 && selected_channel.is_none() {
        return Ok(channels);
    }
    let missing_channel = out_of_range("channel", channel_count, selected_channel.unwrap_or(1));
    let explanation = if channel_count == 0 { other_titles.fault() } else { None };
    Err(explanation.unwrap_or_else(|| lines.fault(missing_channel)))
}

/// Titles that explain why a file has no block of acceleration.
#[derive(Default)]
struct OtherTitles {
    /// Fault of the first title of another quantity, with its line number.
    other_quantity_fault: Option<(usize, FileFault)>,
    /// First line of a file of uncorrected data.
    uncorrected_title: Option<String>,
}

impl OtherTitles {
    /// Reads a line that is no title of a block of acceleration.
    fn read(&mut self, lines: &Lines, line: &str, lower_case_line: &str) {
        let is_other_quantity = is_title_of(lower_case_line, &["vel", "disp"])
            || csmip::is_other_title(lower_case_line);
        if self.other_quantity_fault.is_none() && is_other_quantity {
            self.other_quantity_fault = Some(lines.fault(not_acceleration(line.trim())));
        }
        if lines.number == 1 && lower_case_line.contains("uncorrected accelerogram") {
            self.uncorrected_title = Some(line.to_owned());
        }
    }

    /// Fault of the file, with its line number, if a title explains it.
    fn fault(self) -> Option<(usize, FileFault)> {
        self.other_quantity_fault.or_else(|| {
            let title = self.uncorrected_title?;
            Some((1, unprocessed(&title, "uncorrected data in unequal steps")))
        })
    }
}

/// Whether a line is the title of a block of one of the `quantities`.
///
/// The line is in lower case. Examples for `accel`: `7000  acceleration pts,`, `42000 raw accel.   pts,`.
fn is_title_of(line: &str, quantities: &[&str]) -> bool {
    let mut previous_word = "";
    for word in line.split([' ', '\t', ',']).filter(|word| !word.is_empty()) {
        let is_count_unit = matches!(word, "pts" | "points");
        if is_count_unit && quantities.iter().any(|quantity| previous_word.starts_with(quantity)) {
            return true;
        }
        previous_word = word;
    }
    false
}

/// Index, from 0, of the recorder's sampling interval (s) in the real header values.
const RECORDER_INTERVAL_INDEX: usize = 33;
/// Index, from 0, of the data's sampling interval (ms).
const DATA_INTERVAL_INDEX: usize = 61;
/// Index, from 0, of the data's duration (s).
const DATA_DURATION_INDEX: usize = 62;
/// Index, from 0, of the data's peak, in their unit.
const DATA_PEAK_INDEX: usize = 63;
/// Real header value that means unknown.
const UNKNOWN_REAL_VALUE: f64 = -999.0;

/// Values of a channel's header that describe its samples.
#[derive(Default)]
struct CosmosHeader {
    /// Name of the channel, if the header states one.
    channel_name: Option<String>,
    /// Code of the unit, if the header states one.
    unit_code: Option<i64>,
    /// Real header values.
    real_values: Vec<f64>,
}

impl CosmosHeader {
    /// Reads a line of the header, with the numbers under it.
    ///
    /// `false` for any other line.
    fn read(&mut self, lines: &mut Lines, line: &str, lower_case_line: &str) -> LineResult<bool> {
        if lower_case_line.contains("real-header values follow") {
            self.real_values = read_real_values(lines, lower_case_line)?;
        } else if lower_case_line.contains("integer-header values follow") {
            let Some(line) = lines.next_indented()? else { return Ok(true) };
            // The first of ten values is the stage of processing, the third one the code of the unit.
            let unit_code = line.split_whitespace().nth(2).and_then(|field| field.parse().ok());
            self.unit_code = unit_code.filter(|&code| code > 0);
        } else if let Some(name) = channel_name(line) {
            self.channel_name = Some(name);
        } else {
            return Ok(false);
        }
        Ok(true)
    }

    /// A real header value; `None` if it is unknown.
    fn real(&self, index: usize) -> Option<f64> {
        self.real_values.get(index).copied().filter(|&value| value != UNKNOWN_REAL_VALUE)
    }

    /// A real header value; `None` if it is unknown or not positive.
    fn positive_real(&self, index: usize) -> Option<f64> {
        self.real(index).filter(|&value| value > 0.0)
    }

    /// Description of the block under a title.
    ///
    /// `default_unit`: unit of a title that names none.
    fn block(&self, line: &str, default_unit: Option<AccelerationUnit>) -> FaultResult<DataBlock> {
        let title = line.to_ascii_lowercase();
        let title = title.as_str();
        let sample_count = block::leading_count(title, "number of points")?;
        let (unit, text_after_unit) = if let Some((_, text)) = title.split_once("units") {
            block::unit_and_text_after(line, text.trim_start_matches([' ', '=', ':']))?
        } else {
            let format = title.find("format").map_or("", |position| &title[position..]);
            (block::unit_without_name(title, default_unit)?, format)
        };
        let contradicting_code =
            self.unit_code.filter(|&code| block::unit_of_code(code) != Some(unit));
        if let Some(code) = contradicting_code {
            return Err(unclear("unit", &format!("{unit}, and the code {code} of another one")));
        }
        let format = block::format_of_title(title, text_after_unit)?;
        let data_interval =
            self.positive_real(DATA_INTERVAL_INDEX).map(|milliseconds| milliseconds / 1e3);
        let sampling_interval =
            data_interval.or_else(|| self.positive_real(RECORDER_INTERVAL_INDEX));
        let time_step = block::positive_time_step(sampling_interval)?;
        if let Some(stated_duration) = self.positive_real(DATA_DURATION_INDEX) {
            agreement::check_duration(sample_count, time_step, stated_duration, 0.0)?;
        }
        // `approx  120 secs`: the stated duration has no decimals.
        let approximate_duration = title.split_once("approx").and_then(|(_, text)| {
            finite(text.trim_start_matches(['.', ' ', '=']).split_whitespace().next()?)
        });
        if let Some(stated_duration) = approximate_duration {
            agreement::check_duration(sample_count, time_step, stated_duration, 1.0)?;
        }
        Ok(DataBlock { sample_count, time_step, unit, format, peak: self.real(DATA_PEAK_INDEX) })
    }
}

/// Reads the values under a title of real header values.
fn read_real_values(lines: &mut Lines, title: &str) -> LineResult<Vec<f64>> {
    let value_count =
        lines.with_line_number(block::leading_count(title, "number of header values"))?;
    let format_text = title.split_once("format").map_or("", |(_, text)| text);
    let format_text = format_text.trim_start_matches([' ', '=', ':']);
    let format = lines.with_line_number(block::format_of_title(title, format_text))?;
    read_numbers(lines, value_count, format)
}

/// The name of a channel in a line of the header, if any.
///
/// `Chan 1: 90 Deg` of `Sta Chan   1: 90 Deg (Rcrdr Chan  1) Location:Ground`, `CHAN  1:  90 DEG` or `COMP S58W`.
fn channel_name(line: &str) -> Option<String> {
    let text = line.strip_prefix("Sta ").unwrap_or(line);
    let lower_case_key = text.get(..4)?.to_ascii_lowercase();
    let is_name = lower_case_key == "chan" && text.contains(':')
        || lower_case_key == "comp" && text.contains(' ');
    let text = text.split(['(', '=']).next()?;
    // Digits after `COMP S58W` belong to the punched card.
    let max_words = if lower_case_key == "comp" { 2 } else { usize::MAX };
    let words: Vec<&str> = text.split_whitespace().take(max_words).collect();
    is_name.then(|| words.join(" "))
}
