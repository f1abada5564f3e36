//! Reader of text files with several values of one series on each line.
//!
//! No agency defines this layout: SHAKE (Idriss & Sun, *User's manual for SHAKE91*, 1992: cards of `8F9.6`), OpenSees
//! and scripts read and print it.

use std::io::Read;

use super::fault::{
    FaultResult, may_be_table, not_in_format, unequal_columns, unexpected_header_line,
};
use super::fortran_format::FortranFormat;
use super::header_line::HeaderLines;
use super::lines::{
    LineFields, LineResult, Lines, first_word, has_spreadsheet_error, is_header,
    line_or_header_fault, push_numbers,
};
use super::number_table::NumberTable;
use super::series::{Series, check_sample_count, multiplied, to_record, to_records};
use super::{AccelerationUnit, Record, RecordFormat};
use crate::error::Result;
use crate::text::decimal::has_implied_point;

/// Number of lines from which a column with equal steps counts as times.
///
/// In fewer lines equal steps may be chance.
const MIN_LINES_WITH_TIMES: usize = 4;

/// Layout of a record with several successive values on each line.
///
/// The reader accepts:
/// * numbers separated by white space, commas or semicolons; a sign may begin a number right after another;
/// * numbers in the columns of a Fortran format: `layout`, or one that the header names in brackets, such as
///   `(8F9.6)`, if the first line of numbers matches it. Numbers may then touch, and the number of a card may stand
///   behind the columns;
/// * empty lines, comments that start with `#`, and one line of words before all numbers; more lines before the
///   numbers are skipped if `header_lines` states their number. A title or comment that names another unit is an
///   error.
///
/// All lines have equally many values; the last line may have fewer. A column of counts or times is an error, since
/// tables have such columns: see [`ColumnFormat`](super::ColumnFormat).
///
/// ```
/// use basemat::motion::{AccelerationUnit, AlongLinesFormat, Record};
/// let text = "0.0 0.1 0.3 0.2\n0.1 -0.1 -0.2 -0.3\n-0.1 0.0\n";
/// let format = AlongLinesFormat::new(AccelerationUnit::StandardGravity, 0.01);
/// let record = Record::from_reader("motion.txt", text.as_bytes(), &format)?;
/// assert_eq!((record.len(), record.duration()), (10, 0.09));
/// // A value is lost.
/// let error = Record::from_reader("motion.txt", text.replace("-0.2 ", "").as_bytes(), &format).unwrap_err();
/// assert_eq!(error.to_string(), "motion.txt, line 2: number of columns is 3, but must be 4, as before");
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct AlongLinesFormat {
    /// Unit of the accelerations.
    pub unit: AccelerationUnit,
    /// Time step, s.
    pub time_step: f64,
    /// Fortran format of the lines; `None`: separated numbers, or columns that the header names.
    pub layout: Option<FortranFormat>,
    /// Number of samples of the file, if known; another number is an error.
    pub samples: Option<usize>,
    /// Number of lines at the beginning that are skipped.
    pub header_lines: usize,
}

impl AlongLinesFormat {
    /// Layout of separated accelerations in `unit`, one every `time_step` (s).
    ///
    /// A step that is not positive is an error when a file is read.
    pub fn new(unit: AccelerationUnit, time_step: f64) -> Self {
        Self { unit, time_step, layout: None, samples: None, header_lines: 0 }
    }
}

impl RecordFormat for AlongLinesFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        to_record(name, read(&mut Lines::new(source), self))
    }

    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        to_records(name, read(&mut Lines::new(source), self).map(|series| vec![series]))
    }
}

/// Reads the series of a file.
fn read(lines: &mut Lines, format: &AlongLinesFormat) -> LineResult<Series> {
    let mut header = HeaderLines::default();
    let mut header_format = None;
    let mut may_be_title = true;
    let mut series = SeriesInLines::default();
    while let Some(line) = lines.next_indented()? {
        let text = line.trim_start();
        let is_skipped = lines.number <= format.header_lines;
        let is_comment = text.starts_with('#') && !has_spreadsheet_error(text);
        let fields = LineFields::split(text);
        let is_title = may_be_title && !is_skipped && is_header(&fields);
        let is_before_numbers = series.values.is_empty();
        if text.is_empty() || is_skipped || is_comment || is_title {
            may_be_title &= text.is_empty() || is_skipped || is_comment;
            if is_before_numbers {
                header.add(text);
                header_format = FortranFormat::find(text).or(header_format);
            }
            continue;
        }
        may_be_title = false;
        if is_before_numbers {
            series.begin(&line, format.layout, header_format, lines.number);
            if let Some(word) = first_word(&fields) {
                return Err(lines.fault(unexpected_header_line(word)));
            }
            lines.with_line_number(header.titles(&(1..=1)).check_acceleration(1, format.unit))?;
        }
        let result = series.add(&line, &fields, lines.number);
        result.map_err(|(number, fault)| {
            (number, line_or_header_fault(fault, &fields, is_before_numbers))
        })?;
    }
    // A stated number of samples confirms that the lines are one series.
    match format.samples {
        Some(expected_count) => check_sample_count(lines, series.values.len(), expected_count)?,
        None => series.check()?,
    }
    let samples = multiplied(series.values, format.unit.in_metres_per_second_squared());
    Ok(Series { name: String::new(), time_step: format.time_step, samples })
}

/// The values of the lines read so far.
#[derive(Default)]
struct SeriesInLines {
    values: Vec<f64>,
    /// Fortran format that all lines must match.
    format: Option<FortranFormat>,
    /// Whether the lines do not match the header's format, which has implied decimal points.
    ignores_implied_points: bool,
    /// Number of the first line of values in the file.
    first_line_number: usize,
    /// Number of values in a full line; zero before the first line.
    values_per_line: usize,
    /// The last line, if it has fewer values than the others.
    short_line: Option<ShortLine>,
    /// Number of the previous card.
    previous_card_number: Option<u64>,
    /// Values of the full lines.
    full_lines: NumberTable,
    full_line_count: usize,
}

/// A line with fewer values than the others, which must be the last one.
struct ShortLine {
    /// Number of the line in the file.
    line_number: usize,
    value_count: usize,
}

impl SeriesInLines {
    /// Determines from the first line of values whether the lines have a Fortran format.
    ///
    /// `format`: format that the caller states. `header_format`: format that the header names; it applies if the line
    /// matches it.
    fn begin(
        &mut self,
        line: &str,
        format: Option<FortranFormat>,
        header_format: Option<FortranFormat>,
        line_number: usize,
    ) {
        self.first_line_number = line_number;
        let matching_format = header_format.filter(|format| format.read_card(line).is_some());
        self.format = format.or(matching_format);
        self.values_per_line = self.format.map_or(0, |format| format.numbers_per_line());
        self.ignores_implied_points =
            self.format.is_none() && header_format.is_some_and(FortranFormat::has_implied_points);
    }

    /// Appends the values of a line.
    fn add(&mut self, line: &str, fields: &LineFields, line_number: usize) -> LineResult<()> {
        if let Some(short) = &self.short_line {
            let fault = unequal_columns(short.value_count, self.values_per_line);
            return Err((short.line_number, fault));
        }
        let values = match self.format {
            Some(format) => self.values_in_columns(format, line),
            None => self.separate_values(line, fields),
        };
        let values = values.map_err(|fault| (line_number, fault))?;
        if self.values_per_line == 0 {
            self.values_per_line = values.len();
        }
        if values.len() > self.values_per_line {
            return Err((line_number, unequal_columns(values.len(), self.values_per_line)));
        }
        if values.len() < self.values_per_line {
            self.short_line = Some(ShortLine { line_number, value_count: values.len() });
        } else {
            self.full_lines.push(&values);
            self.full_line_count += 1;
        }
        self.values.extend(values);
        Ok(())
    }

    /// Values of a line in the columns of a format.
    ///
    /// The numbers of successive cards must increase.
    fn values_in_columns(&mut self, format: FortranFormat, line: &str) -> FaultResult<Vec<f64>> {
        let card = format.read_card(line).ok_or_else(|| not_in_format(line))?;
        if let Some(card_number) = card.card_number {
            if self
                .previous_card_number
                .is_some_and(|previous_number| previous_number >= card_number)
            {
                return Err(not_in_format(line));
            }
            self.previous_card_number = Some(card_number);
        }
        Ok(card.numbers)
    }

    /// Values of a line between separators or signs.
    fn separate_values(&self, line: &str, fields: &LineFields) -> FaultResult<Vec<f64>> {
        let mut values = Vec::new();
        if fields.separator.is_none() {
            push_numbers(line, &mut values)?;
        } else {
            for column in 1..=fields.filled_count() {
                values.push(fields.number(column)?);
            }
        }
        if self.ignores_implied_points && fields.texts.iter().any(|text| lacks_point(text)) {
            return Err(not_in_format(line));
        }
        Ok(values)
    }

    /// Returns an error if a column of counts or times shows that the lines are a table.
    fn check(&self) -> LineResult<()> {
        if let Some(column) = self.full_lines.equal_step_column() {
            let is_count = column.step == 1.0;
            let is_time = column.step > 0.0 && self.full_line_count >= MIN_LINES_WITH_TIMES;
            if is_count || is_time {
                return Err((self.first_line_number, may_be_table(column.number)));
            }
        }
        Ok(())
    }
}

/// Whether a field is a nonzero number without a decimal point.
///
/// Its value then depends on the format.
fn lacks_point(field: &str) -> bool {
    let is_nonzero = field.contains(|character: char| matches!(character, '1'..='9'));
    has_implied_point(field) && is_nonzero
}
