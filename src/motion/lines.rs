//! Lines, fields and numbers of text files, including damaged files.

use std::io::Read;

use super::clock::Clock;
use super::fault::{header_line, not_a_number, off_columns, out_of_range};
use super::fortran_format::FortranFormat;
use crate::error::{Error, FileFault, Result};
use crate::text::bounded_line;
use crate::text::column::distinct;
use crate::text::decimal::{finite, has_implied_point, in_field};

/// Contents of lines, or the number and the fault of a line that cannot be read.
pub(super) type Reason<T> = std::result::Result<T, (usize, FileFault)>;

/// The lines of a text.
pub(super) type Lines<'a> = bounded_line::Lines<&'a mut dyn Read>;

/// Converts a line's fault to an error that names `file`.
pub(super) fn refused(file: &str) -> impl Fn((usize, FileFault)) -> Error {
    move |(line, fault)| fault.of(file, line)
}

/// A finite number.
pub(super) fn number(field: &str) -> std::result::Result<f64, FileFault> {
    finite(field).ok_or_else(|| not_a_number(field))
}

/// The numbers of a line; a sign may begin a number right after another.
///
/// Example: `-0.12E-03-0.34E-03`.
fn free_fields(line: &str) -> Vec<&str> {
    let mut fields = Vec::new();
    for field in line.split_whitespace() {
        let mut begin = 0;
        let mut before = 'E';
        for (at, sign) in field.char_indices() {
            let part_of_number = matches!(before, 'E' | 'e' | 'D' | 'd' | '-' | '+');
            if matches!(sign, '-' | '+') && !part_of_number {
                fields.push(&field[begin..at]);
                begin = at;
            }
            before = sign;
        }
        fields.push(&field[begin..]);
    }
    fields
}

/// Appends the numbers of a line.
pub(super) fn push_numbers(
    line: &str,
    values: &mut Vec<f64>,
) -> std::result::Result<(), FileFault> {
    for field in free_fields(line) {
        values.push(number(field)?);
    }
    Ok(())
}

/// Readings of numbers without a decimal point so far.
#[derive(Default)]
struct Points {
    /// Some with the decimals that the format implies.
    implied: bool,
    /// Some as whole numbers, in lines that do not match the format.
    whole: bool,
}

/// Appends the numbers of a line in these columns, or without columns if the line does not match them.
fn push_columns(
    line: &str,
    columns: FortranFormat,
    points: &mut Points,
    values: &mut Vec<f64>,
) -> std::result::Result<(), FileFault> {
    let value = |field: &&str| in_field(field, columns.decimals, columns.scale);
    let in_columns = columns.fields(line).and_then(|fields| {
        let numbers: Option<Vec<f64>> = fields.iter().map(value).collect();
        Some((fields, numbers?))
    });
    let kept = in_columns.is_some();
    let (fields, numbers) = if let Some(found) = in_columns {
        found
    } else {
        let mut numbers = Vec::new();
        push_numbers(line, &mut numbers)?;
        (free_fields(line), numbers)
    };
    // A zero is the same with and without a point.
    let pointless = |(field, value): (&&str, &f64)| has_implied_point(field) && *value != 0.0;
    if columns.decimals > 0 && fields.iter().zip(&numbers).any(pointless) {
        let seen = if kept { &mut points.implied } else { &mut points.whole };
        *seen = true;
    }
    values.extend(numbers);
    // A scale factor applies only to lines that match the format.
    if points.implied && points.whole || columns.scale > 0 && !kept {
        return Err(off_columns(line));
    }
    Ok(())
}

/// Reads exactly `needed` numbers, from the next line on.
pub(super) fn read_numbers(
    lines: &mut Lines,
    needed: usize,
    columns: Option<FortranFormat>,
) -> Reason<Vec<f64>> {
    let mut values = Vec::new();
    let mut points = Points::default();
    while values.len() < needed {
        let Some(line) = lines.next_columns()? else {
            let found = values.len();
            return Err(lines.refuse(FileFault::count("samples", found, needed.to_string())));
        };
        let pushed = match columns {
            Some(columns) => push_columns(&line, columns, &mut points, &mut values),
            None => push_numbers(&line, &mut values),
        };
        pushed.map_err(|reason| lines.refuse(reason))?;
    }
    if values.len() > needed {
        let found = values.len();
        return Err(lines.refuse(FileFault::count("samples", found, needed.to_string())));
    }
    Ok(values)
}

/// Error for text after the numbers.
pub(super) fn end_of_numbers(lines: &mut Lines, needed: usize) -> Reason<()> {
    while let Some(line) = lines.next()? {
        if !line.is_empty() {
            return Err(lines.refuse(FileFault::count("samples", needed + 1, needed.to_string())));
        }
    }
    Ok(())
}

/// The line after the numbers of a block; an error for more numbers than announced.
pub(super) fn line_after_block(lines: &mut Lines, needed: usize) -> Reason<Option<String>> {
    let of_numbers = |sign: u8| sign.is_ascii_digit() || b"+-.eEdD* \t".contains(&sign);
    while let Some(line) = lines.next()? {
        if line.bytes().any(|sign| !of_numbers(sign)) {
            return Ok(Some(line));
        }
        if !line.is_empty() {
            let found = needed + free_fields(&line).len();
            return Err(lines.refuse(FileFault::count("samples", found, needed.to_string())));
        }
    }
    Ok(None)
}

/// A number of samples: a whole number, at least two; otherwise `None`.
pub(super) fn count(value: f64) -> Option<usize> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in 2..=1e9")]
    (value.fract() == 0.0 && (2.0..=1e9).contains(&value)).then_some(value as usize)
}

/// All values times `factor`.
pub(super) fn scaled(values: Vec<f64>, factor: f64) -> Vec<f64> {
    values.into_iter().map(|value| value * factor).collect()
}

/// The samples of one component.
pub(super) struct Series {
    /// Name of the component in the file.
    pub(super) name: String,
    /// Time step, s.
    pub(super) step: f64,
    /// Acceleration, m/s².
    pub(super) samples: Vec<f64>,
}

/// Converts a component to a record; errors name `file`.
pub(super) fn record(file: &str, parsed: Reason<Series>) -> Result<super::Record> {
    let series = parsed.map_err(refused(file))?;
    // Faults of the whole file.
    let reason = |error| FileFault::Unusable(Box::new(error));
    super::Record::new(series.step, series.samples)
        .map_err(|error| refused(file)((0, reason(error))))
}

/// Converts several components to records with unique names.
pub(super) fn records(
    file: &str,
    parsed: Reason<Vec<Series>>,
) -> Result<Vec<(String, super::Record)>> {
    let parsed = parsed.map_err(refused(file))?;
    let names = distinct(&[], parsed.iter().map(|series| series.name.clone()));
    let record = |(name, series)| Ok((name, record(file, Ok(series))?));
    names.into_iter().zip(parsed).map(record).collect()
}

/// The component with a number from 1.
pub(super) fn component(number: usize, parsed: Reason<Vec<Series>>) -> Reason<Series> {
    let parsed = parsed?;
    let found = parsed.len();
    let index = number.checked_sub(1);
    let series = index.and_then(|index| parsed.into_iter().nth(index));
    series.ok_or_else(|| (0, out_of_range("channel", found, number)))
}

/// The fields of a line, separated by commas, or else semicolons, or else white space.
pub(super) struct Fields<'a> {
    line: &'a str,
    /// Separator of columns; `None` for white space.
    pub(super) separator: Option<char>,
    pub(super) texts: Vec<&'a str>,
}

/// Whether a character is separating white space.
///
/// A carriage return within a line is the rest of a damaged line end.
fn is_gap(sign: char) -> bool {
    sign == '\t' || sign.is_whitespace() && !sign.is_control()
}

impl<'a> Fields<'a> {
    pub(super) fn split(line: &'a str) -> Self {
        let separator = if line.contains(';') {
            // Beside semicolons a comma would be a decimal comma: it stays in its field, which is then not a number.
            Some(';')
        } else if line.contains(',') && !has_gap_between_numbers(line) {
            Some(',')
        } else {
            None
        };
        let texts = match separator {
            Some(separator) => {
                line.split(separator).map(|field| field.trim_matches(is_gap)).collect()
            }
            None => line.split(is_gap).filter(|field| !field.is_empty()).collect(),
        };
        Self { line, separator, texts }
    }

    /// Number of fields without the empty ones at the end of the line.
    pub(super) fn filled(&self) -> usize {
        self.texts.iter().rposition(|field| !field.is_empty()).map_or(0, |last| last + 1)
    }

    /// Whether a comma of thousands, or an empty field between tabs, may have shifted the following columns.
    pub(super) fn may_be_shifted(&self) -> bool {
        self.separator == Some(',') || self.line.contains("\t\t")
    }

    /// Time (s) in a column, counted from 1: seconds or a time of day.
    pub(super) fn time(
        &self,
        column: usize,
        clock: &mut Clock,
    ) -> std::result::Result<f64, FileFault> {
        let field = column.checked_sub(1).and_then(|index| self.texts.get(index));
        let of_day = field.filter(|field| field.contains(':'));
        if let Some(time) = of_day.and_then(|field| clock.read(field)) {
            return Ok(time);
        }
        let time = self.number(column)?;
        clock.read(field.unwrap_or(&""));
        Ok(time)
    }

    /// Finite number in a column, counted from 1.
    pub(super) fn number(&self, column: usize) -> std::result::Result<f64, FileFault> {
        let found = self.texts.len();
        let index = column.checked_sub(1).filter(|&index| index < found);
        let index = index.ok_or_else(|| out_of_range("column", found, column))?;
        // The previous field, too, may be the other part of a number.
        for first in index.saturating_sub(1)..=index {
            if let Some(text) = self.decimal_comma_after(first) {
                return Err(not_a_number(&text));
            }
        }
        number(self.texts[index])
    }

    /// The number that a field and the next one would form with a decimal comma.
    ///
    /// Example: `0,05`, since no whole number begins with a zero.
    fn decimal_comma_after(&self, index: usize) -> Option<String> {
        let (whole, decimals) = (self.texts.get(index)?, self.texts.get(index + 1)?);
        let digits =
            |text: &str| !text.is_empty() && text.bytes().all(|sign| sign.is_ascii_digit());
        let parts = self.separator == Some(',')
            && digits(whole.trim_start_matches(['-', '+']))
            && digits(decimals)
            && decimals.len() > 1
            && decimals.starts_with('0');
        let text = format!("{whole},{decimals}");
        (parts && self.line.contains(&text)).then_some(text)
    }
}

/// Whether white space separates two numbers: commas in the same line are then decimal commas.
fn has_gap_between_numbers(line: &str) -> bool {
    let mut words = line.split(is_gap).filter(|word| !word.is_empty());
    let Some(mut before) = words.next() else { return false };
    words.any(|word| {
        let ends = before.ends_with(|sign: char| sign.is_ascii_digit() || sign == '.');
        // A time of day follows its date.
        let begins = word.starts_with(|sign: char| sign.is_ascii_digit() || "+-.".contains(sign))
            && !word.contains(':');
        before = word;
        ends && begins
    })
}

/// Whether a line is a header: it has words, and no field that looks like a number.
pub(super) fn is_header(fields: &Fields) -> bool {
    let has_letters = |field: &&str| field.contains(char::is_alphabetic);
    fields.texts.iter().any(has_letters) && !fields.texts.iter().any(|field| is_like_number(field))
}

/// The first field of a line; `None` unless it is a word.
pub(super) fn first_word<'a>(fields: &Fields<'a>) -> Option<&'a str> {
    let first = fields.texts.first().copied();
    first.filter(|field| field.contains(char::is_alphabetic) && !is_like_number(field))
}

/// Turns a line's fault into a header's fault, for a line before all numbers that starts with a word.
pub(super) fn in_header(why: FileFault, fields: &Fields, no_number_yet: bool) -> FileFault {
    first_word(fields).filter(|_| no_number_yet).map_or(why, header_line)
}

/// Words for a missing number, in lower case.
const MISSING: [&str; 8] = ["nan", "inf", "infinity", "na", "n/a", "null", "none", "missing"];

/// Whether a field is, or looks like, a number.
pub(super) fn is_like_number(field: &str) -> bool {
    let field = field.rsplit('=').next().unwrap_or(field);
    let bare =
        field.trim_start_matches(['"', '\'', '(', '[', '$', '~', '<', '>', '=', '+', '-', '.']);
    // An exponent alone, whose digits were lost.
    let exponent =
        bare.strip_prefix(['e', 'E', 'd', 'D']).and_then(|rest| rest.strip_prefix(['+', '-']));
    let digit = |text: &str| text.starts_with(|sign: char| sign.is_numeric());
    finite(field).is_some()
        || digit(bare)
        || exponent.is_some_and(digit)
        || MISSING.contains(&bare.to_ascii_lowercase().as_str())
        || is_failure(field)
}

/// Whether a line consists of numbers and error values of a spreadsheet, one of these first.
///
/// It begins like a comment, but is not one.
pub(super) fn is_failure(line: &str) -> bool {
    let failed = |field: &str| {
        ["#N/A", "#VALUE!", "#DIV/0!", "#NUM!", "#REF!", "#NAME?", "#NULL!"].contains(&field)
    };
    let mut fields = line.split(|sign| is_gap(sign) || matches!(sign, ',' | ';'));
    fields.next().is_some_and(failed)
        && fields.all(|field| field.is_empty() || failed(field) || finite(field).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_touch_are_parted() {
        let mut values = Vec::new();
        push_numbers(" -.12E-03-3.4e+02+5 6.-7.0", &mut values).unwrap();
        assert_eq!(values, [-0.12e-3, -3.4e2, 5.0, 6.0, -7.0]);
        for bad in ["1--2", "1.2.3", "x", "-", "1E", "1-", "nan", "1e400"] {
            assert!(push_numbers(bad, &mut values).is_err(), "{bad}");
        }
    }
}
