//! Reader of text files with columns of acceleration, usually with a column of time.
//!
//! No agency defines this layout: comma-separated values after RFC 4180, and tables of spreadsheets and scripts.

use std::io::Read;

use super::clock::TimeColumn;
use super::fault::{FaultResult, may_be_one_series, unequal_columns, unexpected_header_line};
use super::header_line::HeaderLines;
use super::lines::{
    LineFields, LineResult, Lines, Series, first_word, has_spreadsheet_error, is_header,
    line_or_header_fault, select_component, to_record, to_records, wrong_count,
};
use super::number_table::NumberTable;
use super::{AccelerationUnit, Record, RecordFormat};
use crate::error::{FileFault, Result};

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
/// constant, or the numbers must jump from line to line, or `samples` be known. A file cut within its last number looks
/// like a complete one: set `samples` where their number is known.
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
        to_record(name, select_component(1, columns))
    }

    /// All columns except the times, whatever `acceleration_column` is.
    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        to_records(name, read(&mut Lines::new(source), self, true))
    }
}

/// Reads the columns of accelerations: all, or the one of the format.
fn read(lines: &mut Lines, format: &ColumnFormat, all: bool) -> LineResult<Vec<Series>> {
    let table = ColumnTable::read(lines, format, all)?;
    let last_line = table.lines.last().copied().unwrap_or(0);
    let found = table.lines.len();
    if found < 2 {
        return Err((last_line, FileFault::count("samples", found, "at least 2")));
    }
    if let Some(needed) = format.samples.filter(|&needed| needed != found) {
        return Err((last_line, wrong_count(found, needed)));
    }
    let step = match format.time_step {
        Some(step) => {
            // A known number of samples confirms the columns.
            if format.samples.is_none() && table.is_one_series(all) {
                return Err((table.lines[0], may_be_one_series(table.width)));
            }
            step
        }
        None => table.times.equal_step(&table.lines)?,
    };
    let columns = table.names.into_iter().zip(table.columns);
    Ok(columns.map(|(name, samples)| Series { name, step, samples }).collect())
}

/// Lines of numbers, column by column.
#[derive(Default)]
struct ColumnTable {
    /// Number of each line in the file.
    lines: Vec<usize>,
    times: TimeColumn,
    /// Numbers of the columns of accelerations, counted from 1.
    chosen: Vec<usize>,
    /// Names of the chosen columns.
    names: Vec<String>,
    /// Accelerations in the chosen columns, m/s².
    columns: Vec<Vec<f64>>,
    /// Number of fields in the first line, without the empty ones at its end.
    width: usize,
    /// Number of fields that all lines must have.
    expected_fields: Option<usize>,
    /// Whether titles or words in the lines show that the columns differ.
    has_words: bool,
    /// All numbers of lines without times.
    numbers: NumberTable,
}

impl ColumnTable {
    /// Whether lines without times may hold one series, of which a column would be a small part.
    ///
    /// Columns are accepted if they have titles, if one of them counts, has times or a constant, or if the numbers jump
    /// over the line ends, unless they continue there. If `all` columns are read, no number is lost.
    fn is_one_series(&self, all: bool) -> bool {
        let numbers = &self.numbers;
        let are_columns = all
            || self.has_words
            || numbers.even_column().is_some()
            || numbers.jumps_over_line_ends();
        self.width > 1 && (!are_columns || numbers.continues_along_lines())
    }

    /// Reads all lines.
    fn read(lines: &mut Lines, format: &ColumnFormat, all: bool) -> LineResult<Self> {
        let mut table = Self::default();
        let mut header = HeaderLines::default();
        let mut title_may_come = true;
        while let Some(text) = lines.next()? {
            let is_skipped = lines.number <= format.header_lines;
            let is_comment = text.starts_with('#') && !has_spreadsheet_error(&text);
            let is_first = table.expected_fields.is_none();
            if text.is_empty() || is_skipped || is_comment {
                if is_first {
                    header.add(&text);
                }
                continue;
            }
            let fields = LineFields::split(&text);
            let is_title = title_may_come && is_header(&fields);
            title_may_come = false;
            if is_title {
                header.add(&text);
                continue;
            }
            // Without times, only this check distinguishes `Station 7` from a sample.
            if is_first
                && format.time_step.is_some()
                && let Some(word) = first_word(&fields)
            {
                return Err(lines.fault(unexpected_header_line(word)));
            }
            let read = table.read_values(&fields, format, all);
            lines.with_line_number(
                read.map_err(|fault| line_or_header_fault(fault, &fields, is_first)),
            )?;
            if is_first {
                let titles = header.titles(&(fields.filled_count()..=fields.texts.len()));
                if format.time_step.is_none() {
                    lines.with_line_number(titles.check_time(format.time_column))?;
                }
                let names = titles.acceleration_names(&table.chosen, format.unit);
                table.names = lines.with_line_number(names)?;
                table.has_words = titles.name_all_columns();
            }
            lines.with_line_number(table.check_fields(&fields, format, all))?;
            table.lines.push(lines.number);
        }
        Ok(table)
    }

    /// Appends the time and the accelerations of a line.
    fn read_values(
        &mut self,
        fields: &LineFields,
        format: &ColumnFormat,
        all: bool,
    ) -> FaultResult<()> {
        let filled = fields.filled_count();
        if self.expected_fields.is_none() {
            self.width = filled;
            self.chosen = acceleration_columns(format, all, filled);
            self.columns = vec![Vec::new(); self.chosen.len()];
        }
        if format.time_step.is_none() {
            let time = fields.time(format.time_column, &mut self.times.clock)?;
            self.times.push(time);
        }
        if !all && format.acceleration_column.is_none() && filled > 1 {
            let needed = "1 (name the column of the acceleration, or read the values along the lines: \
                 `AlongLinesFormat`, in Python `along_lines`)";
            return Err(FileFault::count("columns", filled, needed));
        }
        let factor = format.unit.in_metres_per_second_squared();
        for (samples, &column) in self.columns.iter_mut().zip(&self.chosen) {
            samples.push(fields.number(column)? * factor);
        }
        Ok(())
    }

    /// Error if a line has another number of fields than the first one, where that may shift its columns.
    ///
    /// In a file without times it also collects the numbers of the line.
    fn check_fields(
        &mut self,
        fields: &LineFields,
        format: &ColumnFormat,
        all: bool,
    ) -> FaultResult<()> {
        let has_times = format.time_step.is_none();
        // The cells behind the last comma may be empty in all lines.
        let found = if all { fields.filled_count() } else { fields.texts.len() };
        let expected = *self.expected_fields.get_or_insert(found);
        let must_agree = all || !has_times || fields.may_be_shifted();
        if found != expected && must_agree {
            return Err(unequal_columns(found, expected));
        }
        if !has_times {
            let numbers: FaultResult<Vec<f64>> =
                (1..=self.width).map(|column| fields.number(column)).collect();
            match numbers {
                Ok(numbers) => self.numbers.push(&numbers),
                Err(_) => self.has_words = true,
            }
        }
        Ok(())
    }
}

/// Numbers of the columns of accelerations among the `found` ones of the first line.
fn acceleration_columns(format: &ColumnFormat, all: bool, found: usize) -> Vec<usize> {
    if !all {
        return vec![format.acceleration_column.unwrap_or(1)];
    }
    let time_column = format.time_step.is_none().then_some(format.time_column);
    (1..=found).filter(|&column| time_column != Some(column)).collect()
}

/// Record of El Centro, with times in s and accelerations in g.
const EL_CENTRO_CSV: &str = include_str!("../data/elcentro1940_NS_peknold_0319g.csv");

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
    Record::from_reader("El Centro 1940", EL_CENTRO_CSV.as_bytes(), &format)
        .expect("the embedded record is valid")
}
