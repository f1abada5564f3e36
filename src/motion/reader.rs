//! Reader of text files with columns of acceleration, usually with a column of time.
//!
//! Layout: none of an agency; comma-separated values after RFC 4180, and what spreadsheets and scripts print.

use std::io::Read;

use super::clock::Clock;
use super::fault::{along_lines, drifting, header_line, unequal_columns};
use super::header_line::{ColumnTitles, HeaderLines};
use super::lines::{
    Fields, Lines, Reason, Series, component, first_word, in_header, is_failure, is_header, record,
    records,
};
use super::number_table::NumberTable;
use super::{AccelerationUnit, Record, RecordFormat};
use crate::error::{FileFault, Result};

/// Largest difference of a sample from equal steps, relative to the step.
///
/// Wide enough for times printed with two digits of the step.
const STEP_TOLERANCE: f64 = 0.01;
/// Smallest step, in units of the last digit of the times, at which rounding explains unequal steps.
const COARSE: f64 = 3.0;

/// Layout of a record in a text file: its columns and its unit.
///
/// For values along the lines, several on each, see [`AlongLinesFormat`](super::AlongLinesFormat).
///
/// The reader accepts:
/// * lines of numbers separated by commas, semicolons, spaces or tabs (a comma with spaces around it is one
///   separator; two commas enclose an empty field), with a decimal `.` and the exponent after an `E` or a `D`. A
///   decimal comma is an error where it can be recognised: beside separating semicolons or spaces, or before a
///   zero, as in `0,05`;
/// * empty lines and comment lines that start with `#`, anywhere (`#N/A` and the like, which spreadsheets write
///   for a value, are errors);
/// * one header line of words before all numbers: no field is a number, or begins like one. Lines before it are
///   skipped if `header_lines` states their number;
/// * times in seconds, or times of day, `12:00:15.01`;
/// * line ends `\n` or `\r\n`, and a byte-order mark.
///
/// The time column must advance by equal steps, to 1 % of a step (for rounded print). The time step is their mean,
/// rounded to twelve digits, or the second time where all are exact multiples of it, as [`Record::csv`] writes
/// them. The first time may be any; the record starts there. If times are rounded too coarsely, for example 128
/// samples a second to 1 ms, set `time_step`. A title that names another unit, such as `time (ms)` or `a (cm/s2)`
/// in a file that is read in g, is an error. Every line before the numbers that has as many titles as there are
/// columns counts, comments included; of several lines that name a unit for a column, the last one counts.
/// [`equally_spaced`](Self::equally_spaced) reads files without a time column. All their lines must have equally many
/// columns. Without titles they may be one series along the lines: then one of them must count, have times or be
/// constant, or the numbers must jump from line to line, or `samples` be known. A file cut within its last number looks like a complete one: set `samples` where
/// their number is known.
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
/// assert_eq!(error.to_string(), "my.txt, line 3: time step is 0.02 s, but must be 0.01 s, as before");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ColumnFormat {
    /// Unit of the accelerations.
    pub unit: AccelerationUnit,
    /// Column of times (s), counted from 1; ignored if `time_step` is given.
    pub time_column: usize,
    /// Time step (s) of a file without times.
    pub time_step: Option<f64>,
    /// Column of accelerations, counted from 1; `None` if there is no other column.
    pub acceleration_column: Option<usize>,
    /// Number of samples of the file, if known; another number is an error.
    pub samples: Option<usize>,
    /// Number of lines at the beginning that are skipped; the last one may have titles.
    ///
    /// ```
    /// use basemat::motion::{AccelerationUnit, ColumnFormat, Record};
    /// let text = "Station 1\nPGA 2.0\nt a\n0.00 1\n0.01 2\n";
    /// let format = ColumnFormat::new(AccelerationUnit::Gal);
    /// assert!(Record::from_reader("a.txt", text.as_bytes(), &format).is_err());
    /// let format = ColumnFormat { header_lines: 3, ..format };
    /// assert_eq!(Record::from_reader("a.txt", text.as_bytes(), &format)?.len(), 2);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub header_lines: usize,
}

impl ColumnFormat {
    /// Time (s) in the first column, acceleration in `unit` in the second.
    pub fn new(unit: AccelerationUnit) -> Self {
        Self {
            unit,
            time_column: 1,
            time_step: None,
            acceleration_column: Some(2),
            samples: None,
            header_lines: 0,
        }
    }

    /// A single column of acceleration in `unit` every `time_step` (s).
    ///
    /// A line with more than one number is an error, unless `acceleration_column` selects one. A step that is not
    /// positive is an error when a file is read.
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

impl RecordFormat for ColumnFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        let columns = read(&mut Lines::new(source), self, false);
        record(name, component(1, columns))
    }

    /// All columns except the times, whatever `acceleration_column` is.
    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        records(name, read(&mut Lines::new(source), self, true))
    }
}

/// The columns of accelerations: all, or the one of the format.
fn read(lines: &mut Lines, format: &ColumnFormat, all: bool) -> Reason<Vec<Series>> {
    let table = Table::read(lines, format, all)?;
    let last_line = table.lines.last().copied().unwrap_or(0);
    let found = table.lines.len();
    if found < 2 {
        return Err((last_line, FileFault::count("samples", found, "at least 2")));
    }
    if let Some(needed) = format.samples.filter(|&needed| needed != found) {
        return Err((last_line, FileFault::count("samples", found, needed.to_string())));
    }
    let step = match format.time_step {
        Some(step) => {
            // A known number of samples confirms the columns.
            if format.samples.is_none() && table.is_one_series(all) {
                return Err((table.lines[0], along_lines(table.width)));
            }
            step
        }
        None => table.equal_step()?,
    };
    let columns = table.names.into_iter().zip(table.columns);
    Ok(columns.map(|(name, samples)| Series { name, step, samples }).collect())
}

/// Lines of numbers, column by column.
#[derive(Default)]
struct Table {
    /// Number of each line in the file.
    lines: Vec<usize>,
    /// Times of the lines, s.
    times: Vec<f64>,
    clock: Clock,
    names: Vec<String>,
    /// Accelerations, m/s².
    columns: Vec<Vec<f64>>,
    /// Number of fields in a line.
    width: usize,
    /// Whether titles or words in the lines show that the columns differ.
    has_words: bool,
    /// All numbers of lines without times.
    numbers: NumberTable,
}

impl Table {
    /// Whether lines without times may hold one series, of which a column would be a small part.
    ///
    /// Columns are accepted if they have titles, if one of them counts, has times or a constant, or if the numbers jump
    /// over the line ends, unless they continue there. If `all` columns are read, no number is lost.
    fn is_one_series(&self, all: bool) -> bool {
        let numbers = &self.numbers;
        let columns = all
            || self.has_words
            || numbers.even_column().is_some()
            || numbers.jumps_over_line_ends();
        self.width > 1 && (!columns || numbers.continues_along_lines())
    }

    /// All lines of numbers.
    fn read(lines: &mut Lines, format: &ColumnFormat, all: bool) -> Reason<Self> {
        let mut table = Self::default();
        let factor = format.unit.in_metres_per_second_squared();
        let mut header_may_come = true;
        let mut header = HeaderLines::default();
        let mut chosen = Vec::new();
        let mut columns = None;
        while let Some(text) = lines.next()? {
            let passed = lines.number <= format.header_lines;
            if text.is_empty() || passed || text.starts_with('#') && !is_failure(&text) {
                if columns.is_none() {
                    header.add(&text);
                }
                continue;
            }
            let fields = Fields::split(&text);
            let is_header = header_may_come && is_header(&fields);
            header_may_come = false;
            if is_header {
                header.add(&text);
                continue;
            }
            let found = fields.texts.len();
            let filled = fields.filled();
            let refuse = |why| lines.refuse(in_header(why, &fields, columns.is_none()));
            if columns.is_none() {
                chosen = chosen_columns(format, all, filled);
                // Without times, only this check distinguishes `Station 7` from a sample.
                if let Some(field) = first_word(&fields).filter(|_| format.time_step.is_some()) {
                    return Err(lines.refuse(header_line(field)));
                }
            }
            if format.time_step.is_none() {
                table
                    .times
                    .push(fields.time(format.time_column, &mut table.clock).map_err(refuse)?);
            }
            if !all && format.acceleration_column.is_none() && filled > 1 {
                let needed = "1 (name the column of the acceleration, or read the values along the lines: \
                     `AlongLinesFormat`, in Python `along_lines`)";
                return Err(refuse(FileFault::count("columns", filled, needed)));
            }
            for (k, &column) in chosen.iter().enumerate() {
                let value = fields.number(column).map_err(refuse)?;
                if k == table.columns.len() {
                    table.columns.push(Vec::new());
                }
                table.columns[k].push(value * factor);
            }
            if columns.is_none() {
                let titles = header.titles(&(filled..=found));
                table.names = names(format, &titles, &chosen).map_err(|why| lines.refuse(why))?;
                table.has_words = titles.name_all_columns();
                table.width = filled;
            }
            // The cells behind the last comma may be empty in all lines.
            let found = if all { filled } else { found };
            let expected = *columns.get_or_insert(found);
            let must_agree = all || format.time_step.is_some() || fields.may_be_shifted();
            if found != expected && must_agree {
                return Err(lines.refuse(unequal_columns(found, expected)));
            }
            if format.time_step.is_some() {
                let numbers: std::result::Result<Vec<f64>, FileFault> =
                    (1..=table.width).map(|column| fields.number(column)).collect();
                match numbers {
                    Ok(numbers) => table.numbers.push(&numbers),
                    Err(_) => table.has_words = true,
                }
            }
            table.lines.push(lines.number);
        }
        Ok(table)
    }

    /// The common time step.
    fn equal_step(&self) -> Reason<f64> {
        let times = &self.times;
        let first = times[1] - times[0];
        let last = times.len() - 1;
        let mean = (times[last] - times[0]) / last as f64;
        let unequal = |k: usize, why: FileFault| (self.lines[k], self.rounded(mean).unwrap_or(why));
        for k in 1..=last {
            let found = times[k] - times[k - 1];
            // the difference of huge times may be infinite
            if !(found > 0.0 && found < f64::INFINITY) {
                let why = time_step(found, "above zero".into());
                return Err(if found == 0.0 { unequal(k, why) } else { (self.lines[k], why) });
            }
            if (found - first).abs() > STEP_TOLERANCE * first {
                let needed = format!("{} s, as before", decimal(first));
                return Err(unequal(k, time_step(found, needed)));
            }
        }
        let exact = |(k, &time): (usize, &f64)| time == k as f64 * first;
        if times.iter().enumerate().all(exact) {
            return Ok(first);
        }
        // steps that drift slowly pass the test above
        for (k, &time) in times.iter().enumerate() {
            let expected = times[0] + k as f64 * mean;
            if (time - expected).abs() > STEP_TOLERANCE * mean {
                return Err(unequal(k, drifting(decimal(time), decimal(expected))));
            }
        }
        Ok(decimal(mean))
    }

    /// The error for times that are equally spaced up to rounding; `None` if they are not.
    fn rounded(&self, mean: f64) -> Option<FileFault> {
        let resolution = self.clock.resolution()?;
        let begin = self.times[0];
        let near = |(k, time): (usize, &f64)| {
            (time - begin - k as f64 * mean).abs() <= (1.0 + 1e-6) * resolution
        };
        let steps = self.times.windows(2).map(|pair| pair[1] - pair[0]);
        let (least, most) = steps
            .fold((f64::MAX, 0.0_f64), |(least, most), step| (least.min(step), most.max(step)));
        // Two times in one unit of the last digit, or several units in each step.
        let coarse = mean > 0.0 && least == 0.0 && resolution < 1.0;
        let equal = (coarse || mean > COARSE * resolution)
            && most - least <= (1.0 + 1e-6) * resolution
            && self.times.iter().enumerate().all(near);
        equal.then(|| {
            let needed =
                format!("given (`time_step`): times rounded to {resolution} s do not tell it");
            FileFault::value("time step", format!("near {} s", decimal(mean)), needed)
        })
    }
}

/// Columns of accelerations among the `found` ones of the first line.
fn chosen_columns(format: &ColumnFormat, all: bool, found: usize) -> Vec<usize> {
    if !all {
        return vec![format.acceleration_column.unwrap_or(1)];
    }
    let is_time = |column| format.time_step.is_none() && column == format.time_column;
    (1..=found).filter(|&column| !is_time(column)).collect()
}

/// Names of the chosen columns; an error if a title names another unit.
fn names(
    format: &ColumnFormat,
    titles: &ColumnTitles,
    chosen: &[usize],
) -> std::result::Result<Vec<String>, FileFault> {
    if format.time_step.is_none() {
        titles.check_time(format.time_column)?;
    }
    let name = |&column: &usize| {
        titles.check_acceleration(column, format.unit)?;
        Ok(titles.name(column).map_or_else(|| format!("column {column}"), str::to_owned))
    };
    chosen.iter().map(name).collect()
}

/// A time step (s) that is not as it must be.
fn time_step(found: f64, needed: String) -> FileFault {
    FileFault::value("time step", format!("{} s", decimal(found)), needed)
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
