//! Lines, fields and numbers of text files, including damaged files.

use std::io::Read;

use super::clock::Clock;
use super::fault::{
    FaultResult, not_a_number, not_in_format, not_in_header, out_of_range, unexpected_header_line,
};
use super::fortran_format::FortranFormat;
use crate::error::{FileFault, Result};
use crate::text::bounded_line;
pub(super) use crate::text::bounded_line::LineResult;
use crate::text::column::distinct;
use crate::text::decimal::{finite, has_implied_point};

/// The lines of a text.
pub(super) type Lines<'a> = bounded_line::Lines<&'a mut dyn Read>;

/// The finite number in a field.
pub(super) fn finite_number(field: &str) -> FaultResult<f64> {
    finite(field).ok_or_else(|| not_a_number(field))
}

/// Splits a line at white space, and before a sign that begins a number right after another.
///
/// Example: `-0.12E-03-0.34E-03`.
fn split_touching(line: &str) -> Vec<&str> {
    let mut fields = Vec::new();
    for field in line.split_whitespace() {
        let mut begin = 0;
        let mut previous = 'E';
        for (position, character) in field.char_indices() {
            let continues_number = matches!(previous, 'E' | 'e' | 'D' | 'd' | '-' | '+');
            if matches!(character, '-' | '+') && !continues_number {
                fields.push(&field[begin..position]);
                begin = position;
            }
            previous = character;
        }
        fields.push(&field[begin..]);
    }
    fields
}

/// Appends the numbers of a line, which may touch.
pub(super) fn push_numbers(line: &str, values: &mut Vec<f64>) -> FaultResult<()> {
    for field in split_touching(line) {
        values.push(finite_number(field)?);
    }
    Ok(())
}

/// Readings of the numbers without a decimal point so far.
#[derive(Default)]
struct PointlessNumbers {
    /// Some have the decimals that the format implies.
    have_implied_decimals: bool,
    /// Some are whole numbers, in lines that do not match the format.
    are_whole: bool,
}

/// Appends the numbers of a line in the columns of a format.
///
/// A line that does not match the columns is read without them.
fn push_columns(
    line: &str,
    format: FortranFormat,
    pointless: &mut PointlessNumbers,
    values: &mut Vec<f64>,
) -> FaultResult<()> {
    let in_columns = format.fields(line).and_then(|fields| {
        let numbers = format.numbers(&fields)?;
        Some((fields, numbers))
    });
    let matches_format = in_columns.is_some();
    let (fields, numbers) = if let Some(fields_and_numbers) = in_columns {
        fields_and_numbers
    } else {
        let mut numbers = Vec::new();
        push_numbers(line, &mut numbers)?;
        (split_touching(line), numbers)
    };
    for (field, &number) in fields.iter().zip(&numbers) {
        // A zero is the same with and without a point.
        if format.has_implied_points() && has_implied_point(field) && number != 0.0 {
            pointless.have_implied_decimals |= matches_format;
            pointless.are_whole |= !matches_format;
        }
    }
    values.extend(numbers);
    // A scale factor applies only to lines that match the format.
    let lacks_scale = format.scale > 0 && !matches_format;
    if pointless.have_implied_decimals && pointless.are_whole || lacks_scale {
        return Err(not_in_format(line));
    }
    Ok(())
}

/// Reads exactly `needed` numbers, from the next line on.
///
/// `format`: the columns of the lines; `None` for numbers that white space or a sign separates.
pub(super) fn read_numbers(
    lines: &mut Lines,
    needed: usize,
    format: Option<FortranFormat>,
) -> LineResult<Vec<f64>> {
    let mut values = Vec::new();
    let mut pointless = PointlessNumbers::default();
    while values.len() < needed {
        let Some(line) = lines.next_indented()? else {
            return Err(lines.fault(wrong_count(values.len(), needed)));
        };
        lines.with_line_number(match format {
            Some(format) => push_columns(&line, format, &mut pointless, &mut values),
            None => push_numbers(&line, &mut values),
        })?;
    }
    if values.len() > needed {
        return Err(lines.fault(wrong_count(values.len(), needed)));
    }
    Ok(values)
}

/// Fault of a file with `found` samples instead of the number that its header states.
pub(super) fn wrong_count(found: usize, needed: usize) -> FileFault {
    FileFault::count("samples", found, needed.to_string())
}

/// Error for text after the numbers of a file with `needed` samples.
pub(super) fn end_of_numbers(lines: &mut Lines, needed: usize) -> LineResult<()> {
    while let Some(line) = lines.next()? {
        if !line.is_empty() {
            return Err(lines.fault(wrong_count(needed + 1, needed)));
        }
    }
    Ok(())
}

/// The line after a block of `needed` numbers; an error for more numbers.
pub(super) fn line_after_block(lines: &mut Lines, needed: usize) -> LineResult<Option<String>> {
    while let Some(line) = lines.next()? {
        if !line.bytes().all(is_of_numbers) {
            return Ok(Some(line));
        }
        if !line.is_empty() {
            let found = needed + split_touching(&line).len();
            return Err(lines.fault(wrong_count(found, needed)));
        }
    }
    Ok(None)
}

/// Whether a byte may stand in a line of numbers.
fn is_of_numbers(byte: u8) -> bool {
    byte.is_ascii_digit() || b"+-.eEdD* \t".contains(&byte)
}

/// Number of samples: a whole number of at least two; otherwise `None`.
pub(super) fn sample_count(value: f64) -> Option<usize> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in 2..=1e9")]
    (value.fract() == 0.0 && (2.0..=1e9).contains(&value)).then_some(value as usize)
}

/// A value of the header that must be there; an error names its `quantity`.
pub(super) fn required<T>(lines: &Lines, value: Option<T>, quantity: &str) -> LineResult<T> {
    value.ok_or_else(|| lines.fault(not_in_header(quantity)))
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

/// Record of one component; errors name `file`.
pub(super) fn to_record(file: &str, series: LineResult<Series>) -> Result<super::Record> {
    let series = series.map_err(|(line, fault)| fault.of(file, line))?;
    super::Record::new(series.step, series.samples)
        .map_err(|error| FileFault::Unusable(Box::new(error)).of(file, 0))
}

/// Records of several components, with unique names; errors name `file`.
pub(super) fn to_records(
    file: &str,
    series: LineResult<Vec<Series>>,
) -> Result<Vec<(String, super::Record)>> {
    let all_series = series.map_err(|(line, fault)| fault.of(file, line))?;
    let names = distinct(&[], all_series.iter().map(|series| series.name.clone()));
    let mut records = Vec::with_capacity(names.len());
    for (name, series) in names.into_iter().zip(all_series) {
        records.push((name, to_record(file, Ok(series))?));
    }
    Ok(records)
}

/// The component with this number, counted from 1.
pub(super) fn select_component(
    number: usize,
    components: LineResult<Vec<Series>>,
) -> LineResult<Series> {
    let components = components?;
    let found = components.len();
    let selected = number.checked_sub(1).and_then(|index| components.into_iter().nth(index));
    selected.ok_or_else(|| (0, out_of_range("channel", found, number)))
}

/// The fields of a line, separated by commas, or else semicolons, or else white space.
pub(super) struct LineFields<'a> {
    line: &'a str,
    /// Separator of columns; `None` for white space.
    pub(super) separator: Option<char>,
    pub(super) texts: Vec<&'a str>,
}

/// Whether a character is separating white space.
///
/// A carriage return within a line is the rest of a damaged line end.
fn is_space(character: char) -> bool {
    character == '\t' || character.is_whitespace() && !character.is_control()
}

impl<'a> LineFields<'a> {
    pub(super) fn split(line: &'a str) -> Self {
        let separator = if line.contains(';') {
            // Beside semicolons a comma would be a decimal comma: it stays in its field, which is then not a number.
            Some(';')
        } else if line.contains(',') && !has_space_between_numbers(line) {
            Some(',')
        } else {
            None
        };
        let texts = match separator {
            Some(separator) => {
                line.split(separator).map(|field| field.trim_matches(is_space)).collect()
            }
            None => line.split(is_space).filter(|field| !field.is_empty()).collect(),
        };
        Self { line, separator, texts }
    }

    /// Number of fields without the empty ones at the end of the line.
    pub(super) fn filled_count(&self) -> usize {
        self.texts.iter().rposition(|field| !field.is_empty()).map_or(0, |last| last + 1)
    }

    /// Whether a comma of thousands, or an empty field between tabs, may have shifted the following columns.
    pub(super) fn may_be_shifted(&self) -> bool {
        self.separator == Some(',') || self.line.contains("\t\t")
    }

    /// Time (s) in a column, counted from 1: seconds or a time of day.
    pub(super) fn time(&self, column: usize, clock: &mut Clock) -> FaultResult<f64> {
        let field = column.checked_sub(1).and_then(|index| self.texts.get(index));
        let time_of_day = field.filter(|field| field.contains(':'));
        if let Some(time) = time_of_day.and_then(|field| clock.read(field)) {
            return Ok(time);
        }
        let time = self.number(column)?;
        clock.read(field.unwrap_or(&""));
        Ok(time)
    }

    /// Finite number in a column, counted from 1.
    pub(super) fn number(&self, column: usize) -> FaultResult<f64> {
        let found = self.texts.len();
        let index = column.checked_sub(1).filter(|&index| index < found);
        let index = index.ok_or_else(|| out_of_range("column", found, column))?;
        // The previous field, too, may be the other part of a number.
        for first in index.saturating_sub(1)..=index {
            if let Some(text) = self.decimal_comma_after(first) {
                return Err(not_a_number(&text));
            }
        }
        finite_number(self.texts[index])
    }

    /// The number that a field and the next one would form with a decimal comma.
    ///
    /// Example: `0,05`, since no whole number begins with a zero.
    fn decimal_comma_after(&self, index: usize) -> Option<String> {
        let whole = self.texts.get(index)?;
        let decimals = self.texts.get(index + 1)?;
        let is_one_number = self.separator == Some(',')
            && is_all_digits(whole.trim_start_matches(['-', '+']))
            && is_all_digits(decimals)
            && decimals.len() > 1
            && decimals.starts_with('0');
        let text = format!("{whole},{decimals}");
        (is_one_number && self.line.contains(&text)).then_some(text)
    }
}

/// Whether a text consists of digits.
pub(super) fn is_all_digits(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// Whether white space separates two numbers: commas in the same line are then decimal commas.
fn has_space_between_numbers(line: &str) -> bool {
    let mut words = line.split(is_space).filter(|word| !word.is_empty());
    let Some(mut previous) = words.next() else { return false };
    for word in words {
        let previous_ends =
            previous.ends_with(|character: char| character.is_ascii_digit() || character == '.');
        let word_begins = word
            .starts_with(|character: char| character.is_ascii_digit() || "+-.".contains(character));
        // A time of day follows its date.
        if previous_ends && word_begins && !word.contains(':') {
            return true;
        }
        previous = word;
    }
    false
}

/// Whether a line is a header: it has words, and no field that looks like a number.
pub(super) fn is_header(fields: &LineFields) -> bool {
    fields.texts.iter().any(|field| field.contains(char::is_alphabetic))
        && !fields.texts.iter().any(|field| is_like_number(field))
}

/// The first field of a line; `None` unless it is a word.
pub(super) fn first_word<'a>(fields: &LineFields<'a>) -> Option<&'a str> {
    let first = fields.texts.first().copied();
    first.filter(|field| field.contains(char::is_alphabetic) && !is_like_number(field))
}

/// Fault of a line; of a header line if it starts with a word before all numbers.
pub(super) fn line_or_header_fault(
    fault: FileFault,
    fields: &LineFields,
    is_before_numbers: bool,
) -> FileFault {
    let word = first_word(fields).filter(|_| is_before_numbers);
    word.map_or(fault, unexpected_header_line)
}

/// Words for a missing number, in lower case.
const MISSING_NUMBER_WORDS: [&str; 8] =
    ["nan", "inf", "infinity", "na", "n/a", "null", "none", "missing"];

/// Values that spreadsheets write for a number that cannot be computed.
const SPREADSHEET_ERRORS: [&str; 7] =
    ["#N/A", "#VALUE!", "#DIV/0!", "#NUM!", "#REF!", "#NAME?", "#NULL!"];

/// Whether a field is, or looks like, a number.
pub(super) fn is_like_number(field: &str) -> bool {
    let field = field.rsplit('=').next().unwrap_or(field);
    let bare =
        field.trim_start_matches(['"', '\'', '(', '[', '$', '~', '<', '>', '=', '+', '-', '.']);
    // An exponent alone, whose digits were lost.
    let exponent = bare
        .strip_prefix(['e', 'E', 'd', 'D'])
        .and_then(|rest| rest.strip_prefix(['+', '-']));
    finite(field).is_some()
        || bare.starts_with(char::is_numeric)
        || exponent.is_some_and(|digits| digits.starts_with(char::is_numeric))
        || MISSING_NUMBER_WORDS.contains(&bare.to_ascii_lowercase().as_str())
        || has_spreadsheet_error(field)
}

/// Whether a line consists of numbers and spreadsheet errors, with an error first.
///
/// It begins like a comment, but is not one.
pub(super) fn has_spreadsheet_error(line: &str) -> bool {
    let mut fields = line.split(|character| is_space(character) || matches!(character, ',' | ';'));
    let first_is_error = fields.next().is_some_and(|field| SPREADSHEET_ERRORS.contains(&field));
    first_is_error
        && fields.all(|field| {
            field.is_empty() || SPREADSHEET_ERRORS.contains(&field) || finite(field).is_some()
        })
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
