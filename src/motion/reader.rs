//! Reader of text files with a column of acceleration, and mostly one of time.

use std::io::Read;

use super::lines::{Fields, Lines, Reason, Series, is_failure, is_header, record};
use super::{AccelerationUnit, Record, RecordFormat};
use crate::error::{RecordError, Result};

/// Largest departure of a sample from equal steps, relative to the step.
///
/// Wide enough for times printed with two digits of the step.
const STEP_TOLERANCE: f64 = 0.01;

/// Layout of a record in a text file: its columns and its unit.
///
/// Understood are:
/// * lines of numbers separated by commas, semicolons, spaces or tabs (a comma with spaces around it
///   is one separator; two commas enclose an empty field), the decimal point a `.`, the exponent
///   after an `E` or a `D`. A decimal comma is an error where it shows: beside semicolons or spaces
///   that separate, or before a zero, as in `0,05`;
/// * empty lines and comment lines that start with `#`, anywhere (`#N/A` and the like, which
///   spreadsheets write for a value, are errors);
/// * one header line, before all numbers, made of words: no field is a number, or begins like one;
/// * line ends `\n` or `\r\n`, and a byte-order mark.
///
/// The time column must advance by equal steps, to 1 % of a step (for rounded print); the time step is their mean,
/// rounded to twelve digits, or the second time where all are exact multiples of it, as [`Record::csv`] writes them.
/// The first time may be any: the record counts from there. Files without a time column are read by
/// [`equally_spaced`](Self::equally_spaced). A file cut within its last number cannot be distinguished from a whole
/// one: give `samples` where their number is known.
///
/// ```
/// use basemat::motion::{AccelerationUnit, ColumnFormat, Record};
/// let text = "1 0.00 0.0\n2 0.01 1.0\n3 0.03 2.0\n";
/// let format = ColumnFormat {
///     time_column: 2,
///     acceleration_column: Some(3),
///     ..ColumnFormat::new(AccelerationUnit::StandardGravity)
/// };
/// let error = Record::from_reader("my.txt", text.as_bytes(), &format).unwrap_err();
/// assert_eq!(error.to_string(), "my.txt, line 3: time advances by 0.02 s, but by 0.01 s before");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ColumnFormat {
    /// Unit of the accelerations.
    pub unit: AccelerationUnit,
    /// Column of times (s), counted from 1; it does not matter where `time_step` is given.
    pub time_column: usize,
    /// Time step (s) of a file without times.
    pub time_step: Option<f64>,
    /// Column of accelerations, counted from 1; `None`: there must be no other column.
    pub acceleration_column: Option<usize>,
    /// Number of samples that a file must have, if that is known.
    pub samples: Option<usize>,
}

impl ColumnFormat {
    /// Time (s) in the first column, acceleration in `unit` in the second.
    pub fn new(unit: AccelerationUnit) -> Self {
        Self { unit, time_column: 1, time_step: None, acceleration_column: Some(2), samples: None }
    }

    /// A single column of acceleration in `unit` every `time_step` (s): a line with more than one
    /// number is an error, unless `acceleration_column` says which counts. A step
    /// that is not positive is an error when a file is read.
    ///
    /// ```
    /// use basemat::motion::{AccelerationUnit, ColumnFormat, Record};
    /// let format = ColumnFormat::equally_spaced(AccelerationUnit::StandardGravity, 0.02);
    /// let record = Record::from_reader("a.txt", "0.0\n0.1\n-0.2\n".as_bytes(), &format)?;
    /// assert_eq!((record.len(), record.duration()), (3, 0.04));
    /// assert!(Record::from_reader("a.txt", "0 0\n0.02 0.1\n".as_bytes(), &format).is_err());
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn equally_spaced(unit: AccelerationUnit, time_step: f64) -> Self {
        let time_step = Some(time_step);
        Self { time_step, acceleration_column: None, ..Self::new(unit) }
    }
}

/// Line of numbers.
struct Sample {
    line: usize,
    time: f64,
    acceleration: f64,
}

impl RecordFormat for ColumnFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        record(name, read(&mut Lines::new(source), self))
    }
}

/// Time step (s) and samples (m/s²).
fn read(lines: &mut Lines, format: &ColumnFormat) -> Reason<Series> {
    let samples = read_samples(lines, format)?;
    let last_line = samples.last().map_or(0, |sample| sample.line);
    let found = samples.len();
    if found < 2 {
        return Err((last_line, RecordError::TooShort { found, needed: 2 }));
    }
    if let Some(needed) = format.samples.filter(|&needed| needed != found) {
        return Err((last_line, RecordError::SampleCount { found, needed }));
    }
    let step = match format.time_step {
        Some(step) => step,
        None => equal_step(&samples)?,
    };
    let factor = format.unit.in_metres_per_second_squared();
    let samples = samples.iter().map(|sample| sample.acceleration * factor).collect();
    Ok(Series { name: String::new(), step, samples })
}

/// All lines of numbers.
fn read_samples(lines: &mut Lines, format: &ColumnFormat) -> Reason<Vec<Sample>> {
    let mut samples = Vec::new();
    let mut header_may_come = true;
    let mut columns = None;
    while let Some(text) = lines.next()? {
        if text.is_empty() || text.starts_with('#') && !is_failure(&text) {
            continue;
        }
        let fields = Fields::of(&text);
        let is_header = header_may_come && is_header(&fields);
        header_may_come = false;
        if is_header {
            continue;
        }
        let value = |column| fields.number(column).map_err(|why| lines.refuse(why));
        let time = if format.time_step.is_some() { 0.0 } else { value(format.time_column)? };
        let found = fields.texts.len();
        if format.acceleration_column.is_none() && found > 1 {
            return Err(lines.refuse(RecordError::SeveralColumns { found }));
        }
        let acceleration = value(format.acceleration_column.unwrap_or(1))?;
        let expected = *columns.get_or_insert(found);
        // A comma of thousands, or an empty field between tabs, has moved the columns behind it.
        if found != expected && (fields.separator == Some(',') || text.contains("\t\t")) {
            return Err(lines.refuse(RecordError::UnequalColumns { found, expected }));
        }
        samples.push(Sample { line: lines.number, time, acceleration });
    }
    Ok(samples)
}

/// The common time step.
fn equal_step(samples: &[Sample]) -> Reason<f64> {
    let first = samples[1].time - samples[0].time;
    for pair in samples.windows(2) {
        let found = pair[1].time - pair[0].time;
        // the difference of huge times may be infinite
        if !(found > 0.0 && found < f64::INFINITY) {
            return Err((pair[1].line, RecordError::TimeNotIncreasing { found: decimal(found) }));
        }
        if (found - first).abs() > STEP_TOLERANCE * first {
            let (found, expected) = (decimal(found), decimal(first));
            return Err((pair[1].line, RecordError::UnequalStep { found, expected }));
        }
    }
    let exact = |(k, sample): (usize, &Sample)| sample.time == k as f64 * first;
    if samples.iter().enumerate().all(exact) {
        return Ok(first);
    }
    let last = samples.len() - 1;
    let mean = (samples[last].time - samples[0].time) / last as f64;
    // steps that drift slowly pass the test above
    for (index, sample) in samples.iter().enumerate() {
        let expected = samples[0].time + index as f64 * mean;
        if (sample.time - expected).abs() > STEP_TOLERANCE * mean {
            let (found, expected) = (decimal(sample.time), decimal(expected));
            return Err((sample.line, RecordError::DriftingStep { found, expected }));
        }
    }
    Ok(decimal(mean))
}

/// `value` rounded to twelve digits: differences of printed decimals are decimals.
fn decimal(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

const TEXT: &str = include_str!("../../data/elcentro1940_NS_peknold_0319g.csv");

/// El Centro 1940-05-18, component North–South, in the version of textbooks.
///
/// 1560 samples every 0.02 s, peak 0.31882 g at 2.04 s: the digitisation by Peknold, as tabulated
/// in Chopra, *Dynamics of Structures*, Appendix 6. No baseline treatment: it ends with a
/// velocity of 0.0007 m/s and a displacement of −5 mm.
///
/// ```
/// let record = basemat::motion::el_centro_1940();
/// assert_eq!(record.len(), 1560);
/// assert!((record.peaks().acceleration - 0.31882 * 9.80665).abs() < 1e-12);
/// ```
#[expect(clippy::missing_panics_doc, reason = "the embedded text is read by the tests")]
pub fn el_centro_1940() -> Record {
    let format = ColumnFormat {
        samples: Some(1560),
        ..ColumnFormat::new(AccelerationUnit::StandardGravity)
    };
    Record::from_reader("El Centro 1940", TEXT.as_bytes(), &format)
        .expect("the embedded record is valid")
}
