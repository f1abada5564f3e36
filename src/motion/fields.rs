//! Fields of a line of columns.

use super::lines::number;
use crate::error::RecordError;
use crate::text::number::{excerpt, finite};

/// The fields of a line: commas or else semicolons separate, and so does white space.
pub(super) struct Fields<'a> {
    line: &'a str,
    /// None: white space.
    pub(super) separator: Option<char>,
    pub(super) texts: Vec<&'a str>,
}

/// White space that separates. A carriage return within a line is what is left of a lost line end.
fn is_gap(sign: char) -> bool {
    sign == '\t' || sign.is_whitespace() && !sign.is_control()
}

impl<'a> Fields<'a> {
    pub(super) fn of(line: &'a str) -> Self {
        let separator = if line.contains(';') {
            // Beside semicolons a comma would be one of decimals: left in its field, which is no number.
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

    /// Finite number in a column, counted from 1.
    pub(super) fn number(&self, column: usize) -> Result<f64, RecordError> {
        let missing = RecordError::Column { found: self.texts.len(), needed: column };
        let index = column.checked_sub(1).filter(|&index| index < self.texts.len());
        let index = index.ok_or(missing)?;
        // The field before it, too, may be the other part of a number.
        for first in index.saturating_sub(1)..=index {
            if let Some(text) = self.decimal_comma_after(first) {
                return Err(RecordError::NotANumber { text: excerpt(&text) });
            }
        }
        number(self.texts[index])
    }

    /// The number whose parts are a field and the next one: `0,05`, as no whole number begins with
    /// a zero.
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

/// Whether white space alone parts two numbers: then commas in the same line are those of decimals.
fn has_gap_between_numbers(line: &str) -> bool {
    let mut words = line.split(is_gap).filter(|word| !word.is_empty());
    let Some(mut before) = words.next() else { return false };
    words.any(|word| {
        let ends = before.ends_with(|sign: char| sign.is_ascii_digit() || sign == '.');
        let begins = word.starts_with(|sign: char| sign.is_ascii_digit() || "+-.".contains(sign));
        before = word;
        ends && begins
    })
}

/// Whether a line is one of titles: of words, and nothing like a number that cannot be read.
pub(super) fn is_header(fields: &Fields) -> bool {
    let has_letters = |field: &&str| field.contains(char::is_alphabetic);
    fields.texts.iter().any(has_letters) && !fields.texts.iter().any(|field| is_like_number(field))
}

/// Words for a missing number, in lower case.
const MISSING: [&str; 8] = ["nan", "inf", "infinity", "na", "n/a", "null", "none", "missing"];

/// Whether a field is a number, or was meant as one.
fn is_like_number(field: &str) -> bool {
    let field = field.rsplit('=').next().unwrap_or(field);
    let bare =
        field.trim_start_matches(['"', '\'', '(', '[', '$', '~', '<', '>', '=', '+', '-', '.']);
    // An exponent alone: its digits were lost.
    let exponent =
        bare.strip_prefix(['e', 'E', 'd', 'D']).and_then(|rest| rest.strip_prefix(['+', '-']));
    let digit = |text: &str| text.starts_with(|sign: char| sign.is_numeric());
    finite(field).is_some()
        || digit(bare)
        || exponent.is_some_and(digit)
        || MISSING.contains(&bare.to_ascii_lowercase().as_str())
        || is_failure(field)
}

/// Whether a line consists of numbers and what a spreadsheet writes for those that it could not
/// compute, one of these first: no comment, though it begins like one.
pub(super) fn is_failure(line: &str) -> bool {
    let failed = |field: &str| {
        ["#N/A", "#VALUE!", "#DIV/0!", "#NUM!", "#REF!", "#NAME?", "#NULL!"].contains(&field)
    };
    let mut fields = line.split(|sign| is_gap(sign) || matches!(sign, ',' | ';'));
    fields.next().is_some_and(failed)
        && fields.all(|field| field.is_empty() || failed(field) || finite(field).is_some())
}
