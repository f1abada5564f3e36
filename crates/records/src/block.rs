//! A block of numbers under a title that describes them, in COSMOS and CSMIP files.

use super::fault::{FaultResult, not_acceleration, not_in_header, unclear, unprocessed};
use super::fortran_format::FortranFormat;
use super::lines::{LineResult, Lines, line_after_block, read_numbers};
use super::series::{multiplied, whole_sample_count};
use super::{AccelerationUnit, agreement};
use crate::text::decimal::finite;

/// A block of accelerations as its title describes it.
pub(super) struct DataBlock {
    /// Number of samples.
    pub(super) sample_count: usize,
    /// Time step, s.
    pub(super) time_step: f64,
    pub(super) unit: AccelerationUnit,
    /// Columns of the numbers; `None` if white space separates them.
    pub(super) format: Option<FortranFormat>,
    /// Peak acceleration that the header states, in the unit of the block.
    pub(super) peak: Option<f64>,
}

impl DataBlock {
    /// Reads the samples (m/s²), and the line after them.
    pub(super) fn read(&self, lines: &mut Lines) -> LineResult<(Vec<f64>, Option<String>)> {
        let values = read_numbers(lines, self.sample_count, self.format)?;
        let factor = self.unit.in_metres_per_second_squared();
        let samples = multiplied(values, factor);
        if let Some(peak) = self.peak {
            lines.with_line_number(agreement::check_peak(&samples, peak * factor))?;
        }
        let next_line = line_after_block(lines, self.sample_count)?;
        Ok((samples, next_line))
    }
}

/// The count that begins a title; an error names its `quantity`.
pub(super) fn leading_count(title: &str, quantity: &'static str) -> FaultResult<usize> {
    let first_word = title.split_whitespace().next();
    first_word
        .and_then(|field| whole_sample_count(finite(field)?))
        .ok_or_else(|| not_in_header(quantity))
}

/// The time step (s), or an error if it is missing or not positive.
pub(super) fn positive_time_step(value: Option<f64>) -> FaultResult<f64> {
    value
        .filter(|&time_step| time_step > 0.0)
        .ok_or_else(|| not_in_header("sampling interval"))
}

/// The Fortran format that a title names, if any.
///
/// Returns an error if `text_after_unit` contains more than a format.
pub(super) fn format_of_title(
    title: &str,
    text_after_unit: &str,
) -> FaultResult<Option<FortranFormat>> {
    if !FortranFormat::is_only_format(text_after_unit) {
        return Err(unclear("unit or format", text_after_unit.trim()));
    }
    Ok(FortranFormat::find(title))
}

/// The unit at the beginning of `text`, and the text after it.
///
/// `text`: part of the `title` that begins with the name of the unit.
pub(super) fn unit_and_text_after<'a>(
    title: &str,
    text: &'a str,
) -> FaultResult<(AccelerationUnit, &'a str)> {
    let separator_position = text.find([',', '(', ')']).unwrap_or(text.len());
    let name_end = text.find("format").unwrap_or(text.len()).min(separator_position);
    let text_after_unit = &text[name_end..];
    let name = text[..name_end].trim_matches([' ', '\t', '.']);
    if is_raw_unit(name) {
        return Err(unprocessed(title, RAW_COUNTS_TEXT));
    }
    let code = text_after_unit.trim_start_matches([' ', ',']).strip_prefix('(');
    let code = code.and_then(|bracket| bracket.split_once(')')?.0.trim().parse().ok());
    let unit = AccelerationUnit::named(name);
    let unit = unit.filter(|&unit| code.is_none_or(|code| unit_of_code(code) == Some(unit)));
    let unit = unit.ok_or_else(|| not_acceleration(title))?;
    Ok((unit, text_after_unit.trim_start_matches(')')))
}

/// The unit of a code of COSMOS (format 1.20, table 2).
pub(super) fn unit_of_code(code: i64) -> Option<AccelerationUnit> {
    match code {
        2 => Some(AccelerationUnit::StandardGravity),
        4 | 10 => Some(AccelerationUnit::Gal),
        7 => Some(AccelerationUnit::InchPerSecondSquared),
        _ => None,
    }
}

/// The `expected` unit of a title that names no unit, or an error.
///
/// A title that contains another unit is an error.
pub(super) fn unit_without_name(
    title: &str,
    expected: Option<AccelerationUnit>,
) -> FaultResult<AccelerationUnit> {
    let words = title.split([' ', '\t', ',', '(', ')']);
    let mut units_in_title = words.filter_map(AccelerationUnit::named);
    let unit = expected.filter(|&expected| units_in_title.all(|unit| unit == expected));
    unit.ok_or_else(|| not_acceleration(title))
}

/// Name of data without a recorder's sensitivity, in errors.
const RAW_COUNTS_TEXT: &str = "raw counts of a recorder";

/// Whether a unit is one of raw counts or volts of a recorder.
pub(super) fn is_raw_unit(name: &str) -> bool {
    matches!(name, "count" | "counts" | "cnt" | "cnts" | "volt" | "volts" | "mvolts" | "mv" | "v")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_whole_words() {
        use AccelerationUnit::{Gal, InchPerSecondSquared, StandardGravity};
        for (text, expected) in [
            ("cm/s^2 (4),format=(8f10.5)", Gal),
            ("cm/sec2(04),format=(1e15.6)", Gal),
            ("gal (10)", Gal),
            ("g,format=(8f10.5)", StandardGravity),
            ("g.     (02)format=(8f9.6)", StandardGravity),
            ("g .      format: (8f9.6)", StandardGravity),
            ("in/sec2 (07)", InchPerSecondSquared),
            ("cms/sec/sec)   (8f10.3)", Gal),
        ] {
            let (unit, rest) = unit_and_text_after("title", text).unwrap();
            assert!(unit == expected && FortranFormat::is_only_format(rest), "{text}");
        }
        for text in ["mgal", "mg (8f10.3)", "", "cm/sec,", "g (4)", "cm/s^2 (25)", "cm/s^2 (50)"] {
            let error = unit_and_text_after("title", text).unwrap_err();
            assert_eq!(error, not_acceleration("title"), "{text}");
        }
        for text in ["counts (50),format=(10i8)", "volts", "counts(50)"] {
            let error = unit_and_text_after("title", text).unwrap_err();
            assert_eq!(error, unprocessed("title", RAW_COUNTS_TEXT), "{text}");
        }
        assert_eq!(
            unit_without_name("4 points equally spaced at .010 sec. (8f10.3)", Some(Gal)),
            Ok(Gal)
        );
        assert_eq!(unit_without_name("4 points, in the gallery", Some(Gal)), Ok(Gal));
        assert!(unit_without_name("4 points equally spaced at .010 sec.", None).is_err());
        assert!(
            unit_without_name("4 points equally spaced at .010 sec. g (8f10.3)", Some(Gal))
                .is_err()
        );
    }
}
