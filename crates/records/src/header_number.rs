//! Numbers with units in the headers of records.

use super::fault::{FaultResult, unclear};
use crate::text::decimal::finite;

/// Characters that separate a quantity from the text around it.
const SURROUNDING_CHARACTERS: [char; 6] = [' ', '\t', ',', ';', '=', ':'];

/// Names of units, in lower case, each with the number of units in an SI unit.
type UnitTable = &'static [(&'static str, f64)];

/// Units of times.
const TIME_UNITS: UnitTable = &[
    ("s", 1.0),
    ("", 1.0),
    ("sec", 1.0),
    ("secs", 1.0),
    ("second", 1.0),
    ("seconds", 1.0),
    ("ms", 1e3),
    ("msec", 1e3),
    ("msecs", 1e3),
    ("millisecond", 1e3),
    ("milliseconds", 1e3),
];

/// Units of frequencies.
const FREQUENCY_UNITS: UnitTable = &[("hz", 1.0), ("", 1.0)];

/// Table for quantities without a unit.
const NO_UNITS: UnitTable = &[("", 1.0)];

/// Quantity that the header of a file states as a number.
#[derive(Debug, Clone, Copy)]
pub(super) enum HeaderNumber {
    /// Time step, s.
    TimeStep,
    /// Duration, s.
    Duration,
    /// Frequency, Hz.
    Frequency,
    /// Number of samples.
    Points,
    /// Largest acceleration, in the unit of its line.
    Peak,
}

impl HeaderNumber {
    /// Name for errors.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::TimeStep => "time step",
            Self::Duration => "duration",
            Self::Frequency => "sampling frequency",
            Self::Points => "number of points",
            Self::Peak => "peak acceleration",
        }
    }

    fn units(self) -> UnitTable {
        match self {
            Self::TimeStep | Self::Duration => TIME_UNITS,
            Self::Frequency => FREQUENCY_UNITS,
            Self::Points | Self::Peak => NO_UNITS,
        }
    }

    /// Reads the value (SI) of a number or a fraction, with or without a unit.
    ///
    /// `None` if the text is empty; an error unless all of it is understood.
    pub(super) fn read(self, text: &str) -> FaultResult<Option<f64>> {
        let text = text.trim_matches(SURROUNDING_CHARACTERS);
        if text.is_empty() {
            return Ok(None);
        }
        let value = self.parse(text).ok_or_else(|| unclear(self.name(), text))?;
        Ok(Some(value))
    }

    /// The value of a number or fraction with one of the units.
    fn parse(self, text: &str) -> Option<f64> {
        // An `E` may begin the exponent or the unit. The unit begins at the first letter or bracket from which on the
        // text is a known unit.
        for (position, character) in text.char_indices() {
            if (character.is_alphabetic() || character == '(')
                && let Some(value) = self.parse_split(text, position)
            {
                return Some(value);
            }
        }
        self.parse_split(text, text.len())
    }

    /// The value of a text whose unit begins at `position`.
    fn parse_split(self, text: &str, position: usize) -> Option<f64> {
        let number_text = &text[..position];
        let unit_text = &text[position..];
        let unit_name = unit_text
            .strip_prefix('(')
            .and_then(|unit| unit.strip_suffix(')'))
            .unwrap_or(unit_text);
        let lower_case_name = unit_name.strip_suffix('.').unwrap_or(unit_name).to_ascii_lowercase();
        let units_per_si_unit = self.units().iter().find(|(unit, _)| *unit == lower_case_name)?.1;
        Some(number_or_fraction(number_text.trim_end())? / units_per_si_unit)
    }
}

/// The value of `0.01` or `1/100`.
fn number_or_fraction(text: &str) -> Option<f64> {
    let value = match text.split_once('/') {
        Some((numerator, denominator)) => {
            finite(numerator.trim_end())? / finite(denominator.trim_start())?
        }
        None => finite(text)?,
    };
    value.is_finite().then_some(value)
}

/// Position of the comma or semicolon that ends the first clause, or the text's end.
///
/// A separator before a digit is part of a number.
pub(super) fn clause_end(text: &str) -> usize {
    for (position, _) in text.match_indices([',', ';']) {
        if !text[position + 1..].starts_with(|character: char| character.is_ascii_digit()) {
            return position;
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_are_whole_texts() {
        for (text, value) in [
            (" .01", 0.01),
            ("= .0100 SEC,", 0.01),
            ("1.0E-02SEC", 0.01),
            ("5.0D-03", 0.005),
            ("1/100 s.", 0.01),
            ("10 (msec)", 0.01),
            ("1E1MS", 0.01),
        ] {
            assert_eq!(HeaderNumber::TimeStep.read(text), Ok(Some(value)), "{text}");
        }
        assert_eq!(HeaderNumber::TimeStep.read(" = "), Ok(None));
        for text in ["x", ".01E", "1,5", "1 2", "1/0", "5 sec sec", "5 (sec", "5 hz", "s", "é"] {
            assert!(HeaderNumber::TimeStep.read(text).is_err(), "{text}");
        }
        assert_eq!(HeaderNumber::Frequency.read("100Hz"), Ok(Some(100.0)));
        assert!(HeaderNumber::Frequency.read("100 s").is_err());
        assert!(HeaderNumber::Points.read("100 s").is_err());
    }

    #[test]
    fn clauses_end_at_separators() {
        for (text, clause) in [
            (" .01, x", " .01"),
            ("1,5 s; x", "1,5 s"),
            ("4,DT", "4"),
            ("4,000,", "4,000"),
            ("", ""),
        ] {
            assert_eq!(&text[..clause_end(text)], clause, "{text}");
        }
    }
}
