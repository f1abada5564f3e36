//! Reader of text files with a column of time and one of acceleration.

use std::io::{BufRead, BufReader, Read};

use super::AccelerationUnit;
use crate::error::{Error, RecordError, Result};

/// Longest line, bytes: a file without line ends must not fill the memory.
const LONGEST_LINE: u64 = 65_536;

/// Largest departure of a sample from equal steps, relative to the step.
///
/// Wide enough for times printed with two digits of the step.
const STEP_TOLERANCE: f64 = 0.01;

/// How a text file holds a record: which columns, which unit.
///
/// What is understood:
/// * lines of numbers separated by commas, spaces or tabs (a comma with spaces around it is one
///   separator; two commas enclose an empty field), the decimal point a `.`;
/// * empty lines and comment lines that start with `#`, anywhere;
/// * one header line, before all numbers, in which no field is a number;
/// * line ends `\n` or `\r\n`, and a byte-order mark.
///
/// The time column must advance by equal steps, to 1 % of a step (for rounded print); the time
/// step is their mean, rounded to twelve digits. The first time may be any: the record counts
/// from there. A file cut within its last number cannot be told from a whole one: give
/// [`with_samples`](Self::with_samples) where the count is known.
///
/// ```
/// use basemat::motion::{AccelerationUnit, ColumnFormat, Record};
/// let text = "1 0.00 0.0\n2 0.01 1.0\n3 0.03 2.0\n";
/// let format = ColumnFormat::new(AccelerationUnit::StandardGravity).with_columns(2, 3);
/// let error = Record::from_reader("my.txt", text.as_bytes(), &format).unwrap_err();
/// assert_eq!(error.to_string(), "my.txt, line 3: time advances by 0.02 s, but by 0.01 s before");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ColumnFormat {
    time: usize,
    acceleration: usize,
    unit: AccelerationUnit,
    samples: Option<usize>,
}

impl ColumnFormat {
    /// Time (s) in the first column, acceleration in `unit` in the second.
    pub fn new(unit: AccelerationUnit) -> Self {
        Self { time: 1, acceleration: 2, unit, samples: None }
    }

    /// Other columns, counted from 1; column 0 is refused when a file is read.
    #[must_use]
    pub fn with_columns(self, time: usize, acceleration: usize) -> Self {
        Self { time, acceleration, ..self }
    }

    /// Refuses files that have not exactly this number of samples.
    #[must_use]
    pub fn with_samples(self, samples: usize) -> Self {
        Self { samples: Some(samples), ..self }
    }
}

/// One line of numbers.
struct Sample {
    line: usize,
    time: f64,
    acceleration: f64,
}

/// Time step (s) and samples (m/s²).
pub(super) fn read(
    name: &str,
    source: impl Read,
    format: &ColumnFormat,
) -> Result<(f64, Vec<f64>)> {
    let refuse =
        |line: usize, reason: RecordError| Error::Record { file: name.to_owned(), line, reason };
    let samples = read_samples(source, format).map_err(|(line, reason)| refuse(line, reason))?;
    let last_line = samples.last().map_or(0, |sample| sample.line);
    let found = samples.len();
    if found < 2 {
        return Err(refuse(last_line, RecordError::TooShort { found, needed: 2 }));
    }
    if let Some(needed) = format.samples.filter(|&needed| needed != found) {
        return Err(refuse(last_line, RecordError::SampleCount { found, needed }));
    }
    let step = equal_step(&samples).map_err(|(line, reason)| refuse(line, reason))?;
    let factor = format.unit.in_metres_per_second_squared();
    Ok((step, samples.iter().map(|sample| sample.acceleration * factor).collect()))
}

type Reason<T> = std::result::Result<T, (usize, RecordError)>;

/// All lines of numbers.
fn read_samples(source: impl Read, format: &ColumnFormat) -> Reason<Vec<Sample>> {
    let mut source = BufReader::new(source);
    let mut samples = Vec::new();
    let mut bytes = Vec::new();
    let mut header_may_come = true;
    for line in 1.. {
        bytes.clear();
        let read = source.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut bytes);
        match read {
            Err(error) => return Err((line, RecordError::Unreadable(error.kind()))),
            Ok(0) => break,
            Ok(count) if count as u64 == LONGEST_LINE && bytes.last() != Some(&b'\n') => {
                return Err((line, RecordError::LineTooLong { bytes: count }));
            }
            Ok(_) => {}
        }
        // bytes that are not UTF-8 become signs that are no number; in comments they do not matter
        let lossy = String::from_utf8_lossy(&bytes);
        let mut text = lossy.trim();
        if line == 1 {
            text = text.trim_start_matches('\u{feff}').trim_start();
        }
        if text.is_empty() || text.starts_with('#') {
            continue;
        }
        let fields = fields(text);
        let is_header = header_may_come && fields.iter().all(|field| field.parse::<f64>().is_err());
        header_may_come = false;
        if !is_header {
            let number = |column| number(&fields, column).map_err(|reason| (line, reason));
            let (time, acceleration) = (number(format.time)?, number(format.acceleration)?);
            samples.push(Sample { line, time, acceleration });
        }
    }
    Ok(samples)
}

/// Fields of a line: commas separate, and so does white space between two fields.
fn fields(text: &str) -> Vec<&str> {
    let mut fields = Vec::new();
    for piece in text.split(',') {
        if piece.trim().is_empty() {
            fields.push("");
        } else {
            fields.extend(piece.split_whitespace());
        }
    }
    fields
}

/// Finite number in a column, counted from 1.
fn number(fields: &[&str], column: usize) -> std::result::Result<f64, RecordError> {
    let missing = RecordError::Column { found: fields.len(), needed: column };
    let field = column.checked_sub(1).and_then(|index| fields.get(index)).ok_or(missing)?;
    match field.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(RecordError::NotANumber { text: field.chars().take(40).collect() }),
    }
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
