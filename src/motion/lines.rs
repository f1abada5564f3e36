//! Lines and numbers of text files, however bad.

use std::io::{BufReader, Read};

use super::fixed_columns::FixedColumns;
use crate::bounded_line::read_line;
use crate::error::{Error, RecordError, Result};

/// Why a line is refused, and which.
pub(super) type Reason<T> = std::result::Result<T, (usize, RecordError)>;

/// The lines of a text, without white space at their ends.
pub(super) struct Lines<'a> {
    source: BufReader<&'a mut dyn Read>,
    bytes: Vec<u8>,
    /// Number of the last line given, from 1.
    pub(super) number: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn new(source: &'a mut dyn Read) -> Self {
        Self { source: BufReader::new(source), bytes: Vec::new(), number: 0 }
    }

    /// The next line, or none at the end.
    pub(super) fn next(&mut self) -> Reason<Option<String>> {
        Ok(self.next_columns()?.map(|line| line.trim_start().to_owned()))
    }

    /// The next line with the white space at its beginning.
    fn next_columns(&mut self) -> Reason<Option<String>> {
        let line = self.number + 1;
        if !read_line(&mut self.source, &mut self.bytes).map_err(|unread| (line, unread.into()))? {
            return Ok(None);
        }
        self.number = line;
        // Bytes that are not UTF-8 become signs that are no number; in comments they do not matter.
        let lossy = String::from_utf8_lossy(&self.bytes);
        let text = if line == 1 { lossy.trim_start_matches('\u{feff}') } else { &lossy };
        Ok(Some(text.trim_end().to_owned()))
    }

    /// The error for the last line given.
    pub(super) fn refuse(&self, reason: RecordError) -> (usize, RecordError) {
        (self.number, reason)
    }
}

/// The refusal of a line of `file`.
pub(super) fn refused(file: &str) -> impl Fn((usize, RecordError)) -> Error {
    move |(line, reason)| Error::Record { file: file.to_owned(), line, reason }
}

/// A finite number.
pub(super) fn number(field: &str) -> std::result::Result<f64, RecordError> {
    match field.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(RecordError::NotANumber { text: field.chars().take(40).collect() }),
    }
}

/// Appends the numbers of a line of fixed columns, where a sign may begin a number right after
/// another: `-0.12E-03-0.34E-03`.
pub(super) fn push_numbers(
    line: &str,
    values: &mut Vec<f64>,
) -> std::result::Result<(), RecordError> {
    for field in line.split_whitespace() {
        let mut begin = 0;
        let mut before = 'E';
        for (at, sign) in field.char_indices() {
            if matches!(sign, '-' | '+') && !matches!(before, 'E' | 'e' | '-' | '+') {
                values.push(number(&field[begin..at])?);
                begin = at;
            }
            before = sign;
        }
        values.push(number(&field[begin..])?);
    }
    Ok(())
}

/// Appends the numbers of a line of these columns; free ones if it does not keep to them.
fn push_columns(
    line: &str,
    columns: Option<FixedColumns>,
    values: &mut Vec<f64>,
) -> std::result::Result<(), RecordError> {
    // Double precision prints 1.5D+02.
    let value = |field: &str| number(&field.replace(['D', 'd'], "E")).ok();
    let fields = columns.and_then(|columns| columns.fields(line));
    let numbers =
        fields.and_then(|fields| fields.into_iter().map(value).collect::<Option<Vec<_>>>());
    match numbers {
        Some(numbers) => values.extend(numbers),
        None => push_numbers(line, values)?,
    }
    Ok(())
}

/// Reads exactly `needed` numbers, from the next line on.
pub(super) fn read_numbers(
    lines: &mut Lines,
    needed: usize,
    columns: Option<FixedColumns>,
) -> Reason<Vec<f64>> {
    let mut values = Vec::new();
    while values.len() < needed {
        let Some(line) = lines.next_columns()? else {
            let found = values.len();
            return Err(lines.refuse(RecordError::SampleCount { found, needed }));
        };
        push_columns(&line, columns, &mut values).map_err(|reason| lines.refuse(reason))?;
    }
    if values.len() > needed {
        let found = values.len();
        return Err(lines.refuse(RecordError::SampleCount { found, needed }));
    }
    Ok(values)
}

/// Refuses text after the numbers.
pub(super) fn end_of_numbers(lines: &mut Lines, needed: usize) -> Reason<()> {
    while let Some(line) = lines.next()? {
        if !line.is_empty() {
            return Err(lines.refuse(RecordError::SampleCount { found: needed + 1, needed }));
        }
    }
    Ok(())
}

/// The number that follows `key` in `text`, after spaces and equality signs.
pub(super) fn number_after(text: &str, key: &str) -> Option<f64> {
    let rest = text[text.find(key)? + key.len()..].trim_start_matches([' ', '\t', '=', ':']);
    let end = rest
        .find(|sign: char| !matches!(sign, '0'..='9' | '.' | '-' | '+' | 'E' | 'e'))
        .unwrap_or(rest.len());
    // An `E` may be the beginning of a word.
    let digits = rest[..end].trim_end_matches(['E', 'e', '-', '+', '.']);
    let value = rest[..end].parse().or_else(|_| digits.parse()).ok()?;
    f64::is_finite(value).then_some(value)
}

/// A number of samples: a whole number, at least two, or none.
pub(super) fn count(value: f64) -> Option<usize> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in 2..=1e9")]
    (value.fract() == 0.0 && (2.0..=1e9).contains(&value)).then_some(value as usize)
}

/// All values times `factor`.
pub(super) fn scaled(values: Vec<f64>, factor: f64) -> Vec<f64> {
    values.into_iter().map(|value| value * factor).collect()
}

/// Time step and acceleration as a record, errors named after `file`.
pub(super) fn record(file: &str, parsed: Reason<(f64, Vec<f64>)>) -> Result<super::Record> {
    let (step, samples) = parsed.map_err(refused(file))?;
    // What no single line is to blame for.
    let reason = |error| RecordError::Unusable(Box::new(error));
    super::Record::new(step, samples).map_err(|error| refused(file)((0, reason(error))))
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

    #[test]
    fn numbers_are_found_after_keys() {
        assert_eq!(number_after("NPTS=  12, DT= .0100 SEC", "DT"), Some(0.01));
        assert_eq!(number_after("NPTS=  12, DT= .0100SEC", "NPTS"), Some(12.0));
        assert_eq!(number_after("DT=1.0E-02SEC", "DT"), Some(0.01));
        assert_eq!(number_after("DT=.01E", "DT"), Some(0.01));
        assert_eq!(number_after("DT= x", "DT"), None);
        assert_eq!(number_after("", "DT"), None);
    }
}
