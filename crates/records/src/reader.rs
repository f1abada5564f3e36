//! Reader of text files with columns of acceleration, usually with a column of time.
//!
//! No agency defines this layout: comma-separated values after RFC 4180, and tables of spreadsheets and scripts.

use std::io::Read;

use super::clock::TimeColumn;
use super::fault::{
    FaultResult, may_be_one_series, unequal_columns, unexpected_header_line, wrong_sample_count,
};
use super::header_line::HeaderLines;
use super::lines::{
    LineFields, LineResult, Lines, first_word, has_spreadsheet_error, is_header,
    line_or_header_fault,
};
use super::number_table::NumberTable;
use super::series::{Series, select_component, to_record, to_records};
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
///
/// [`equally_spaced`](Self::equally_spaced) reads files without a time column. All their lines must have equally many
/// columns. Without titles the lines may be one series along the lines. To be read as columns, one column must then
/// have counts, times or a constant, or the numbers must jump from line to line, or `samples` must be set. A file that
/// was cut within its last number looks like a complete one: set `samples` if you know their number.
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
    /// Number of samples of the file, if you know it; another number is an error.
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
        let columns = read(&mut Lines::new(source), self, ColumnSelection::OfFormat);
        to_record(name, select_component(1, columns))
    }

    /// All columns except the times, whatever `acceleration_column` is.
    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        to_records(name, read(&mut Lines::new(source), self, ColumnSelection::All))
    }
}

/// Reads the selected columns of accelerations.
fn read(
    lines: &mut Lines,
    format: &ColumnFormat,
    selection: ColumnSelection,
) -> LineResult<Vec<Series>> {
    let table = ColumnTable::read(lines, format, selection)?;
    let last_line_number = table.line_numbers.last().copied().unwrap_or(0);
    let sample_count = table.line_numbers.len();
    if sample_count < 2 {
        return Err((last_line_number, FileFault::count("samples", sample_count, "at least 2")));
    }
    if let Some(expected_count) = format.samples.filter(|&count| count != sample_count) {
        return Err((last_line_number, wrong_sample_count(sample_count, expected_count)));
    }
    let time_step = match format.time_step {
        Some(time_step) => {
            // A stated number of samples confirms the columns.
            if format.samples.is_none() && table.is_one_series(selection) {
                return Err((table.line_numbers[0], may_be_one_series(table.field_count)));
            }
            time_step
        }
        None => table.times.equal_step(&table.line_numbers)?,
    };
    let components = table.names.into_iter().zip(table.samples);
    Ok(components.map(|(name, samples)| Series { name, time_step, samples }).collect())
}

/// Columns of accelerations that are read.
#[derive(Clone, Copy, PartialEq)]
enum ColumnSelection {
    /// All columns but the times.
    All,
    /// The column that the format names.
    OfFormat,
}

/// Lines of numbers, column by column.
#[derive(Default)]
struct ColumnTable {
    /// Number of each line in the file.
    line_numbers: Vec<usize>,
    times: TimeColumn,
    /// Numbers of the columns of accelerations, counted from 1.
    column_numbers: Vec<usize>,
    /// Names of these columns.
    names: Vec<String>,
    /// Accelerations in these columns, m/s².
    samples: Vec<Vec<f64>>,
    /// Number of fields in the first line, without the empty ones at its end.
    field_count: usize,
    /// Number of fields that all lines must have.
    expected_field_count: Option<usize>,
    /// Whether titles or words in the lines show that the columns differ.
    has_words: bool,
    /// All numbers of lines without times.
    numbers: NumberTable,
}

impl ColumnTable {
    /// Whether lines without times may be one series, of which a column is a small part.
    ///
    /// Lines have columns if titles name them, if a column has counts, times or a constant, or if the numbers jump over
    /// the line ends. Numbers that continue over the line ends are one series. A selection of all columns omits no
    /// number.
    fn is_one_series(&self, selection: ColumnSelection) -> bool {
        let numbers = &self.numbers;
        let has_columns = selection == ColumnSelection::All
            || self.has_words
            || numbers.equal_step_column().is_some()
            || numbers.jumps_over_line_ends();
        self.field_count > 1 && (!has_columns || numbers.continues_along_lines())
    }

    /// Reads all lines.
    fn read(
        lines: &mut Lines,
        format: &ColumnFormat,
        selection: ColumnSelection,
    ) -> LineResult<Self> {
        let mut table = Self::default();
        let mut header = HeaderLines::default();
        let mut may_be_title = true;
        while let Some(text) = lines.next()? {
            let is_skipped = lines.number <= format.header_lines;
            let is_comment = text.starts_with('#') && !has_spreadsheet_error(&text);
            let is_first_line = table.expected_field_count.is_none();
            if text.is_empty() || is_skipped || is_comment {
                if is_first_line {
                    header.add(&text);
                }
                continue;
            }
            let fields = LineFields::split(&text);
            let is_title = may_be_title && is_header(&fields);
            may_be_title = false;
            if is_title {
                header.add(&text);
                continue;
            }
            // Without times, only the first word distinguishes `Station 7` from a sample.
            if is_first_line
                && format.time_step.is_some()
                && let Some(word) = first_word(&fields)
            {
                return Err(lines.fault(unexpected_header_line(word)));
            }
            let result = table.read_values(&fields, format, selection);
            lines.with_line_number(
                result.map_err(|fault| line_or_header_fault(fault, &fields, is_first_line)),
            )?;
            if is_first_line {
                let titles = header.titles(&(fields.filled_count()..=fields.texts.len()));
                if format.time_step.is_none() {
                    lines.with_line_number(titles.check_time(format.time_column))?;
                }
                let names = titles.acceleration_names(&table.column_numbers, format.unit);
                table.names = lines.with_line_number(names)?;
                table.has_words = titles.name_all_columns();
            }
            lines.with_line_number(table.check_fields(&fields, format, selection))?;
            table.line_numbers.push(lines.number);
        }
        Ok(table)
    }

    /// Appends the time and the accelerations of a line.
    fn read_values(
        &mut self,
        fields: &LineFields,
        format: &ColumnFormat,
        selection: ColumnSelection,
    ) -> FaultResult<()> {
        let filled_count = fields.filled_count();
        if self.expected_field_count.is_none() {
            self.field_count = filled_count;
            self.column_numbers = acceleration_columns(format, selection, filled_count);
            self.samples = vec![Vec::new(); self.column_numbers.len()];
        }
        if format.time_step.is_none() {
            let time = fields.time(format.time_column, &mut self.times.clock)?;
            self.times.push(time);
        }
        if selection == ColumnSelection::OfFormat
            && format.acceleration_column.is_none()
            && filled_count > 1
        {
            let needed = "1 (name the column of the acceleration, or read the values along the lines: \
                 `AlongLinesFormat`, in Python `along_lines`)";
            return Err(FileFault::count("columns", filled_count, needed));
        }
        let factor = format.unit.in_metres_per_second_squared();
        for (samples, &column_number) in self.samples.iter_mut().zip(&self.column_numbers) {
            samples.push(fields.number(column_number)? * factor);
        }
        Ok(())
    }

    /// Returns an error if a line has another number of fields than the first one.
    ///
    /// Its columns may then be shifted.
    ///
    /// In a file without times, this function also stores all numbers of the line.
    fn check_fields(
        &mut self,
        fields: &LineFields,
        format: &ColumnFormat,
        selection: ColumnSelection,
    ) -> FaultResult<()> {
        let has_times = format.time_step.is_none();
        // The cells behind the last comma may be empty in all lines.
        let field_count = if selection == ColumnSelection::All {
            fields.filled_count()
        } else {
            fields.texts.len()
        };
        let expected_count = *self.expected_field_count.get_or_insert(field_count);
        let must_agree = selection == ColumnSelection::All || !has_times || fields.may_be_shifted();
        if field_count != expected_count && must_agree {
            return Err(unequal_columns(field_count, expected_count));
        }
        if !has_times {
            let numbers: FaultResult<Vec<f64>> =
                (1..=self.field_count).map(|column| fields.number(column)).collect();
            match numbers {
                Ok(numbers) => self.numbers.push(&numbers),
                Err(_) => self.has_words = true,
            }
        }
        Ok(())
    }
}

/// Numbers, from 1, of the selected columns of accelerations.
fn acceleration_columns(
    format: &ColumnFormat,
    selection: ColumnSelection,
    column_count: usize,
) -> Vec<usize> {
    if selection == ColumnSelection::OfFormat {
        return vec![format.acceleration_column.unwrap_or(1)];
    }
    let time_column = format.time_step.is_none().then_some(format.time_column);
    (1..=column_count).filter(|&column| time_column != Some(column)).collect()
}

/// Table of the El Centro record, with times in s and accelerations in g.
const EL_CENTRO_CSV: &str = include_str!("../data/elcentro1940_NS_peknold_0319g.csv");

/// Number of samples of the El Centro record.
const EL_CENTRO_SAMPLE_COUNT: usize = 1560;

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
        samples: Some(EL_CENTRO_SAMPLE_COUNT),
        ..ColumnFormat::new(AccelerationUnit::StandardGravity)
    };
    Record::from_reader("El Centro 1940", EL_CENTRO_CSV.as_bytes(), &format)
        .expect("the embedded record is valid")
}
