//! A block of numbers under a title that describes them, in COSMOS and CSMIP files.

use super::fault::{FaultResult, not_acceleration, not_in_header, unclear, unprocessed};
use super::fortran_format::FortranFormat;
use super::lines::{LineResult, Lines, line_after_block, read_numbers, sample_count, scaled};
use super::{AccelerationUnit, agreement};
use crate::text::decimal::finite;

/// Description of a block of numbers by its title.
pub(super) struct DataBlock {
    /// Number of samples.
    pub(super) points: usize,
    /// Time step, s.
    pub(super) step: f64,
    pub(super) unit: AccelerationUnit,
    /// Columns of the numbers; `None` if white space separates them.
    pub(super) format: Option<FortranFormat>,
    /// Peak that the header states, in the unit of the block.
    pub(super) peak: Option<f64>,
}

impl DataBlock {
    /// The samples (m/s²), and the line after them.
    pub(super) fn read(&self, lines: &mut Lines) -> LineResult<(Vec<f64>, Option<String>)> {
        let values = read_numbers(lines, self.points, self.format)?;
        let factor = self.unit.in_metres_per_second_squared();
        let samples = scaled(values, factor);
        if let Some(peak) = self.peak {
            lines.with_line_number(agreement::peak(&samples, peak * factor))?;
        }
        let next_line = line_after_block(lines, self.points)?;
        Ok((samples, next_line))
    }
}

/// The count at the beginning of a title; an error names its `quantity`.
pub(super) fn leading_count(title: &str, quantity: &'static str) -> FaultResult<usize> {
    let first = title.split_whitespace().next();
    first
        .and_then(|field| sample_count(finite(field)?))
        .ok_or_else(|| not_in_header(quantity))
}

/// A time step, which must be there and above zero.
pub(super) fn positive_step(value: Option<f64>) -> FaultResult<f64> {
    value.filter(|&step| step > 0.0).ok_or_else(|| not_in_header("sampling interval"))
}

/// The Fortran format that a title names, if any.
///
/// An error if `rest`, the text after the unit, contains more than a format.
pub(super) fn format_of_title(title: &str, rest: &str) -> FaultResult<Option<FortranFormat>> {
    if !FortranFormat::is_all_of(rest) {
        return Err(unclear("unit or format", rest.trim()));
    }
    Ok(FortranFormat::find(title))
}

/// The unit at the beginning of `text`, and the text behind it.
///
/// `text`: the part of a title from the unit's name on.
pub(super) fn unit_and_rest<'a>(
    title: &str,
    text: &'a str,
) -> FaultResult<(AccelerationUnit, &'a str)> {
    let separator = text.find([',', '(', ')']).unwrap_or(text.len());
    let end = text.find("format").unwrap_or(text.len()).min(separator);
    let rest = &text[end..];
    let name = text[..end].trim_matches([' ', '\t', '.']);
    if is_raw_unit(name) {
        return Err(unprocessed(title, RAW_COUNTS_TEXT));
    }
    let code = rest.trim_start_matches([' ', ',']).strip_prefix('(');
    let code = code.and_then(|rest| rest.split_once(')')?.0.trim().parse().ok());
    let unit = AccelerationUnit::named(name);
    let unit = unit.filter(|&unit| code.is_none_or(|code| unit_of_code(code) == Some(unit)));
    let unit = unit.ok_or_else(|| not_acceleration(title))?;
    Ok((unit, rest.trim_start_matches(')')))
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

/// Unit for a title without one: `expected`, unless the title contains another one.
pub(super) fn unit_of_untitled(
    title: &str,
    expected: Option<AccelerationUnit>,
) -> FaultResult<AccelerationUnit> {
    let words = title.split([' ', '\t', ',', '(', ')']);
    let mut units_in_title = words.filter_map(AccelerationUnit::named);
    let unit = expected.filter(|&expected| units_in_title.all(|unit| unit == expected));
    unit.ok_or_else(|| not_acceleration(title))
}

/// Description of data in counts, for errors.
const RAW_COUNTS_TEXT: &str = "raw counts of a recorder";

/// Whether a unit belongs to numbers without a recorder's sensitivity.
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
            let (found, rest) = unit_and_rest("title", text).unwrap();
            assert!(found == expected && FortranFormat::is_all_of(rest), "{text}");
        }
        for text in ["mgal", "mg (8f10.3)", "", "cm/sec,", "g (4)", "cm/s^2 (25)", "cm/s^2 (50)"] {
            let error = unit_and_rest("title", text).unwrap_err();
            assert_eq!(error, not_acceleration("title"), "{text}");
        }
        for text in ["counts (50),format=(10i8)", "volts", "counts(50)"] {
            let error = unit_and_rest("title", text).unwrap_err();
            assert_eq!(error, unprocessed("title", RAW_COUNTS_TEXT), "{text}");
        }
        assert_eq!(
            unit_of_untitled("4 points equally spaced at .010 sec. (8f10.3)", Some(Gal)),
            Ok(Gal)
        );
        assert_eq!(unit_of_untitled("4 points, in the gallery", Some(Gal)), Ok(Gal));
        assert!(unit_of_untitled("4 points equally spaced at .010 sec.", None).is_err());
        assert!(
            unit_of_untitled("4 points equally spaced at .010 sec. g (8f10.3)", Some(Gal)).is_err()
        );
    }
}
