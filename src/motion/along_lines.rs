//! Reader of text files with the values of one series along the lines, several on each.
//!
//! Layout: none of an agency; what SHAKE (Idriss & Sun, *User's manual for SHAKE91*, 1992: cards of `8F9.6`),
//! OpenSees and scripts read and print.

use std::io::Read;

use super::fault::{columns_of_table, header_line, off_columns, unequal_columns};
use super::fortran_format::FortranFormat;
use super::header_line::HeaderLines;
use super::lines::{
    Fields, Lines, Reason, Series, first_word, in_header, is_failure, is_header, push_numbers,
    record, records, scaled,
};
use super::number_table::NumberTable;
use super::{AccelerationUnit, Record, RecordFormat};
use crate::error::{FileFault, Result};
use crate::text::decimal::has_implied_point;

/// Smallest number of lines that show a column of times.
const LINES_WITH_TIMES: usize = 4;

/// Layout of a record whose values follow each other along the lines, several on each line.
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
/// All lines have equally many values, except for the last one, which may have fewer. A column that counts or has
/// times is an error, since tables have such columns: see [`ColumnFormat`](super::ColumnFormat).
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
    /// Fortran format of the lines; `None`: numbers apart, or in columns that the header names.
    pub layout: Option<FortranFormat>,
    /// Number of samples of the file, if known; another number is an error.
    pub samples: Option<usize>,
    /// Number of lines at the beginning that are skipped.
    pub header_lines: usize,
}

impl AlongLinesFormat {
    /// Acceleration in `unit` every `time_step` (s), numbers apart.
    ///
    /// A step that is not positive is an error when a file is read.
    pub fn new(unit: AccelerationUnit, time_step: f64) -> Self {
        Self { unit, time_step, layout: None, samples: None, header_lines: 0 }
    }
}

impl RecordFormat for AlongLinesFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        record(name, read(&mut Lines::new(source), self))
    }

    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        records(name, read(&mut Lines::new(source), self).map(|series| vec![series]))
    }
}

fn read(lines: &mut Lines, format: &AlongLinesFormat) -> Reason<Series> {
    let mut header = HeaderLines::default();
    let mut header_layout = None;
    let mut header_may_come = true;
    let mut series = LineSeries::default();
    while let Some(line) = lines.next_columns()? {
        let text = line.trim_start();
        let skipped = lines.number <= format.header_lines;
        let comment = text.starts_with('#') && !is_failure(text);
        let fields = Fields::split(text);
        let title = header_may_come && !skipped && is_header(&fields);
        if text.is_empty() || skipped || comment || title {
            header_may_come &= text.is_empty() || skipped || comment;
            if series.values.is_empty() {
                header.add(text);
                header_layout = FortranFormat::find(text).or(header_layout);
            }
            continue;
        }
        header_may_come = false;
        if series.values.is_empty() {
            series.begin(&line, format.layout, header_layout, lines.number);
            if let Some(word) = first_word(&fields) {
                return Err(lines.refuse(header_line(word)));
            }
            let unit = header.titles(&(1..=1)).check_acceleration(1, format.unit);
            unit.map_err(|why| lines.refuse(why))?;
        }
        let first = series.values.is_empty();
        let added = series.add(&line, &fields, lines.number);
        added.map_err(|(number, why)| (number, in_header(why, &fields, first)))?;
    }
    let found = series.values.len();
    match format.samples {
        Some(needed) if needed != found => {
            return Err(lines.refuse(FileFault::count("samples", found, needed.to_string())));
        }
        // A known number of samples confirms the series.
        Some(_) => {}
        None => series.check()?,
    }
    let samples = scaled(series.values, format.unit.in_metres_per_second_squared());
    Ok(Series { name: String::new(), step: format.time_step, samples })
}

/// Values of all lines so far.
#[derive(Default)]
struct LineSeries {
    values: Vec<f64>,
    /// Columns that all lines must have.
    layout: Option<FortranFormat>,
    /// Whether the header names a format with implied decimal points, which the lines do not match.
    off_implied_points: bool,
    /// Number of the first line in the file.
    first_line: usize,
    /// Number of values in a full line; zero before the first line.
    per_line: usize,
    /// Number of a shorter line, and of its values.
    short: Option<(usize, usize)>,
    /// Number of the card before.
    card: Option<u64>,
    full_lines: NumberTable,
    full_count: usize,
}

impl LineSeries {
    /// Decides, by the first line of numbers, whether lines are in columns.
    fn begin(
        &mut self,
        line: &str,
        layout: Option<FortranFormat>,
        header: Option<FortranFormat>,
        number: usize,
    ) {
        self.first_line = number;
        let matching = header.filter(|header| header.card(line).is_some());
        self.layout = layout.or(matching);
        self.per_line = self.layout.map_or(0, |layout| layout.numbers_per_line());
        self.off_implied_points =
            self.layout.is_none() && header.is_some_and(FortranFormat::has_implied_points);
    }

    /// Appends the values of a line.
    fn add(&mut self, line: &str, fields: &Fields, number: usize) -> Reason<()> {
        if let Some((short, found)) = self.short {
            return Err((short, unequal_columns(found, self.per_line)));
        }
        let numbers = match self.layout {
            Some(layout) => self.in_columns(layout, line),
            None => self.apart(line, fields),
        };
        let numbers = numbers.map_err(|why| (number, why))?;
        if self.per_line == 0 {
            self.per_line = numbers.len();
        }
        if numbers.len() > self.per_line {
            return Err((number, unequal_columns(numbers.len(), self.per_line)));
        }
        if numbers.len() < self.per_line {
            self.short = Some((number, numbers.len()));
        } else {
            self.full_lines.push(&numbers);
            self.full_count += 1;
        }
        self.values.extend(numbers);
        Ok(())
    }

    /// Numbers of a line in columns; numbers of cards must rise.
    fn in_columns(
        &mut self,
        layout: FortranFormat,
        line: &str,
    ) -> std::result::Result<Vec<f64>, FileFault> {
        let card = layout.card(line).ok_or_else(|| off_columns(line))?;
        if let Some(number) = card.card {
            if self.card.is_some_and(|before| before >= number) {
                return Err(off_columns(line));
            }
            self.card = Some(number);
        }
        Ok(card.numbers)
    }

    /// Numbers of a line that are apart.
    fn apart(&self, line: &str, fields: &Fields) -> std::result::Result<Vec<f64>, FileFault> {
        let mut numbers = Vec::new();
        if fields.separator.is_none() {
            push_numbers(line, &mut numbers)?;
        } else {
            for column in 1..=fields.filled() {
                numbers.push(fields.number(column)?);
            }
        }
        let pointless = |field: &&str| has_implied_point(field) && field.contains(nonzero_digit);
        if self.off_implied_points && fields.texts.iter().any(pointless) {
            return Err(off_columns(line));
        }
        Ok(numbers)
    }

    /// Error if a column counts or has times.
    fn check(&self) -> Reason<()> {
        match self.full_lines.even_column() {
            Some((column, step))
                if step > 0.0 && (step == 1.0 || self.full_count >= LINES_WITH_TIMES) =>
            {
                Err((self.first_line, columns_of_table(column)))
            }
            _ => Ok(()),
        }
    }
}

fn nonzero_digit(sign: char) -> bool {
    sign.is_ascii_digit() && sign != '0'
}
