//! Lines, fields and numbers of text files, including damaged files.

use std::io::Read;

use super::clock::Clock;
use super::fault::{
    FaultResult, not_a_number, not_in_format, not_in_header, out_of_range, unexpected_header_line,
    wrong_sample_count,
};
use super::fortran_format::FortranFormat;
use crate::error::FileFault;
use crate::text::bounded_line;
pub(super) use crate::text::bounded_line::LineResult;
use crate::text::decimal::{finite, has_implied_point};

/// The lines of a text.
pub(super) type Lines<'a> = bounded_line::Lines<&'a mut dyn Read>;

/// The finite number in a field.
pub(super) fn finite_number(field: &str) -> FaultResult<f64> {
    finite(field).ok_or_else(|| not_a_number(field))
}

/// Splits a line into its numbers, which may touch.
///
/// Numbers end at white space, or before the sign of the next number.
/// Example: `-0.12E-03-0.34E-03`.
fn split_touching_numbers(line: &str) -> Vec<&str> {
    let mut fields = Vec::new();
    for field in line.split_whitespace() {
        let mut field_start = 0;
        let mut previous_character = 'E';
        for (position, character) in field.char_indices() {
            let continues_number = matches!(previous_character, 'E' | 'e' | 'D' | 'd' | '-' | '+');
            if matches!(character, '-' | '+') && !continues_number {
                fields.push(&field[field_start..position]);
                field_start = position;
            }
            previous_character = character;
        }
        fields.push(&field[field_start..]);
    }
    fields
}

/// Appends the numbers of a line, which may touch.
pub(super) fn push_numbers(line: &str, values: &mut Vec<f64>) -> FaultResult<()> {
    for field in split_touching_numbers(line) {
        values.push(finite_number(field)?);
    }
    Ok(())
}

/// How the lines so far were read where numbers have no decimal point.
#[derive(Default)]
struct NumbersWithoutPoint {
    /// Whether some have the decimals that the format implies.
    have_implied_decimals: bool,
    /// Whether some are whole numbers, in lines that do not match the format.
    are_whole: bool,
}

/// Appends the numbers of a line whose columns a format describes.
///
/// A line that does not match the columns is read without them.
fn push_numbers_in_columns(
    line: &str,
    format: FortranFormat,
    without_point: &mut NumbersWithoutPoint,
    values: &mut Vec<f64>,
) -> FaultResult<()> {
    let column_reading = format.fields(line).and_then(|fields| {
        let numbers = format.numbers(&fields)?;
        Some((fields, numbers))
    });
    let matches_format = column_reading.is_some();
    let (fields, numbers) = if let Some(reading) = column_reading {
        reading
    } else {
        let mut numbers = Vec::new();
        push_numbers(line, &mut numbers)?;
        (split_touching_numbers(line), numbers)
    };
    for (field, &number) in fields.iter().zip(&numbers) {
        // A zero is the same with and without a point.
        if format.has_implied_points() && has_implied_point(field) && number != 0.0 {
            without_point.have_implied_decimals |= matches_format;
            without_point.are_whole |= !matches_format;
        }
    }
    values.extend(numbers);
    // A scale factor applies only to lines that match the format.
    let lacks_scale = format.scale > 0 && !matches_format;
    if without_point.have_implied_decimals && without_point.are_whole || lacks_scale {
        return Err(not_in_format(line));
    }
    Ok(())
}

/// Reads exactly `expected_count` numbers, from the next line on.
///
/// `format`: columns of the lines; `None` for numbers that white space or a sign separates.
pub(super) fn read_numbers(
    lines: &mut Lines,
    expected_count: usize,
    format: Option<FortranFormat>,
) -> LineResult<Vec<f64>> {
    let mut values = Vec::new();
    let mut without_point = NumbersWithoutPoint::default();
    while values.len() < expected_count {
        let Some(line) = lines.next_indented()? else {
            return Err(lines.fault(wrong_sample_count(values.len(), expected_count)));
        };
        lines.with_line_number(match format {
            Some(format) => push_numbers_in_columns(&line, format, &mut without_point, &mut values),
            None => push_numbers(&line, &mut values),
        })?;
    }
    if values.len() > expected_count {
        return Err(lines.fault(wrong_sample_count(values.len(), expected_count)));
    }
    Ok(values)
}

/// Returns an error for text after the numbers of a file with `expected_count` samples.
pub(super) fn check_end_of_numbers(lines: &mut Lines, expected_count: usize) -> LineResult<()> {
    while let Some(line) = lines.next()? {
        if !line.is_empty() {
            return Err(lines.fault(wrong_sample_count(expected_count + 1, expected_count)));
        }
    }
    Ok(())
}

/// The line after a block of `expected_count` numbers; an error for more numbers.
pub(super) fn line_after_block(
    lines: &mut Lines,
    expected_count: usize,
) -> LineResult<Option<String>> {
    while let Some(line) = lines.next()? {
        if !line.bytes().all(may_be_in_number) {
            return Ok(Some(line));
        }
        if !line.is_empty() {
            let number_count = expected_count + split_touching_numbers(&line).len();
            return Err(lines.fault(wrong_sample_count(number_count, expected_count)));
        }
    }
    Ok(None)
}

/// Whether a byte may stand in a line of numbers.
fn may_be_in_number(byte: u8) -> bool {
    byte.is_ascii_digit() || b"+-.eEdD* \t".contains(&byte)
}

/// The value of a header, or an error that names its missing `quantity`.
pub(super) fn required<T>(lines: &Lines, value: Option<T>, quantity: &str) -> LineResult<T> {
    value.ok_or_else(|| lines.fault(not_in_header(quantity)))
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
    /// Fields of a line.
    pub(super) fn split(line: &'a str) -> Self {
        let separator = if line.contains(';') {
            // Beside semicolons a comma is a decimal comma. The comma stays in its field, which is then not a number.
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
        self.texts.iter().rposition(|field| !field.is_empty()).map_or(0, |index| index + 1)
    }

    /// Whether a missing field may have shifted the columns after it.
    ///
    /// A comma may separate thousands, and two tabs enclose an empty field.
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
        let field_count = self.texts.len();
        let index = column.checked_sub(1).filter(|&index| index < field_count);
        let index = index.ok_or_else(|| out_of_range("column", field_count, column))?;
        // A decimal comma may separate this field from the previous one, or from the next one.
        for first_index in index.saturating_sub(1)..=index {
            if let Some(text) = self.decimal_comma_after(first_index) {
                return Err(not_a_number(&text));
            }
        }
        finite_number(self.texts[index])
    }

    /// The number that a field and the next one would form with a decimal comma.
    ///
    /// Example: `0,05`, since no whole number begins with a zero.
    fn decimal_comma_after(&self, index: usize) -> Option<String> {
        let whole_part = self.texts.get(index)?;
        let decimals = self.texts.get(index + 1)?;
        let is_one_number = self.separator == Some(',')
            && is_all_digits(whole_part.trim_start_matches(['-', '+']))
            && is_all_digits(decimals)
            && decimals.len() > 1
            && decimals.starts_with('0');
        let number = format!("{whole_part},{decimals}");
        (is_one_number && self.line.contains(&number)).then_some(number)
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
        let previous_ends_number =
            previous.ends_with(|character: char| character.is_ascii_digit() || character == '.');
        let word_begins_number = word
            .starts_with(|character: char| character.is_ascii_digit() || "+-.".contains(character));
        // A time of day follows its date.
        if previous_ends_number && word_begins_number && !word.contains(':') {
            return true;
        }
        previous = word;
    }
    false
}

/// Whether a line has words, and no field that looks like a number.
pub(super) fn is_header(fields: &LineFields) -> bool {
    fields.texts.iter().any(|field| field.contains(char::is_alphabetic))
        && !fields.texts.iter().any(|field| is_like_number(field))
}

/// The first field of a line; `None` unless it is a word.
pub(super) fn first_word<'a>(fields: &LineFields<'a>) -> Option<&'a str> {
    let first_field = fields.texts.first().copied();
    first_field.filter(|field| field.contains(char::is_alphabetic) && !is_like_number(field))
}

/// Fault of a line.
///
/// A line that starts with a word before all numbers has the fault of a header line.
pub(super) fn line_or_header_fault(
    fault: FileFault,
    fields: &LineFields,
    is_before_numbers: bool,
) -> FileFault {
    let word = first_word(fields).filter(|_| is_before_numbers);
    word.map_or(fault, unexpected_header_line)
}

/// Words that files contain in place of a missing number, in lower case.
const MISSING_NUMBER_WORDS: [&str; 8] =
    ["nan", "inf", "infinity", "na", "n/a", "null", "none", "missing"];

/// Values that spreadsheets write for a number that cannot be computed.
const SPREADSHEET_ERRORS: [&str; 7] =
    ["#N/A", "#VALUE!", "#DIV/0!", "#NUM!", "#REF!", "#NAME?", "#NULL!"];

/// Whether a field is, or looks like, a number.
pub(super) fn is_like_number(field: &str) -> bool {
    let field = field.rsplit('=').next().unwrap_or(field);
    let unsigned_text =
        field.trim_start_matches(['"', '\'', '(', '[', '$', '~', '<', '>', '=', '+', '-', '.']);
    // An exponent alone, whose digits were lost.
    let exponent = unsigned_text
        .strip_prefix(['e', 'E', 'd', 'D'])
        .and_then(|text| text.strip_prefix(['+', '-']));
    finite(field).is_some()
        || unsigned_text.starts_with(char::is_numeric)
        || exponent.is_some_and(|digits| digits.starts_with(char::is_numeric))
        || MISSING_NUMBER_WORDS.contains(&unsigned_text.to_ascii_lowercase().as_str())
        || has_spreadsheet_error(field)
}

/// Whether a line has numbers and spreadsheet errors, with an error first.
///
/// Such a line begins with `#` like a comment, but contains data.
pub(super) fn has_spreadsheet_error(line: &str) -> bool {
    let mut fields = line.split(|character| is_space(character) || matches!(character, ',' | ';'));
    let starts_with_error = fields.next().is_some_and(|field| SPREADSHEET_ERRORS.contains(&field));
    starts_with_error
        && fields.all(|field| {
            field.is_empty() || SPREADSHEET_ERRORS.contains(&field) || finite(field).is_some()
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_touch_are_separated() {
        let mut values = Vec::new();
        push_numbers(" -.12E-03-3.4e+02+5 6.-7.0", &mut values).unwrap();
        assert_eq!(values, [-0.12e-3, -3.4e2, 5.0, 6.0, -7.0]);
        for invalid_line in ["1--2", "1.2.3", "x", "-", "1E", "1-", "nan", "1e400"] {
            assert!(push_numbers(invalid_line, &mut values).is_err(), "{invalid_line}");
        }
    }
}
