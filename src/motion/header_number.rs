//! Numbers with units in the headers of records.

use super::fault::unclear;
use crate::error::FileFault;
use crate::text::decimal::finite;

/// Characters around a quantity that have no meaning.
const PADDING: [char; 6] = [' ', '\t', ',', ';', '=', ':'];

/// Names of units, in lower case, and their values in SI units.
type Units = &'static [(&'static str, f64)];

const TIME: Units = &[
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

const FREQUENCY: Units = &[("hz", 1.0), ("", 1.0)];

const NUMBER: Units = &[("", 1.0)];

/// Quantities in the header of a file, and their names in errors.
#[derive(Debug, Clone, Copy)]
pub(super) enum HeaderNumber {
    /// Time step, s.
    TimeStep,
    /// Duration, s.
    Duration,
    /// Frequency, Hz.
    Frequency,
    Points,
    /// Largest acceleration, in the unit of its line.
    Peak,
}

impl HeaderNumber {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::TimeStep => "time step",
            Self::Duration => "duration",
            Self::Frequency => "sampling frequency",
            Self::Points => "number of points",
            Self::Peak => "peak acceleration",
        }
    }

    fn units(self) -> Units {
        match self {
            Self::TimeStep | Self::Duration => TIME,
            Self::Frequency => FREQUENCY,
            Self::Points | Self::Peak => NUMBER,
        }
    }

    /// The value of `text` in SI units: a number or a fraction, with or without a unit.
    ///
    /// `None` if the text is empty; an error unless all of it is understood.
    pub(super) fn read(self, text: &str) -> std::result::Result<Option<f64>, FileFault> {
        let text = text.trim_matches(PADDING);
        if text.is_empty() {
            return Ok(None);
        }
        let value = self.parse(text).ok_or_else(|| unclear(self.name(), text))?;
        Ok(Some(value))
    }

    fn parse(self, text: &str) -> Option<f64> {
        // An `E` may begin the exponent or the unit; the first split with a known unit decides.
        let starts = text.char_indices().filter(|(_, sign)| sign.is_alphabetic() || *sign == '(');
        starts.map(|(at, _)| at).chain([text.len()]).find_map(|at| {
            let (number, unit) = text.split_at(at);
            let number = number.trim_end();
            let unit =
                unit.strip_prefix('(').and_then(|unit| unit.strip_suffix(')')).unwrap_or(unit);
            let unit = unit.strip_suffix('.').unwrap_or(unit).to_ascii_lowercase();
            let per = self.units().iter().find(|(name, _)| *name == unit)?.1;
            Some(number_or_fraction(number)? / per)
        })
    }
}

/// `0.01`, `1/100`.
fn number_or_fraction(text: &str) -> Option<f64> {
    let value = match text.split_once('/') {
        Some((above, below)) => finite(above.trim_end())? / finite(below.trim_start())?,
        None => finite(text)?,
    };
    value.is_finite().then_some(value)
}

/// Place of the comma or semicolon that ends the first clause, or the text's end.
///
/// A separator with a digit behind it is part of a number.
pub(super) fn clause_end(text: &str) -> usize {
    let separators = text.match_indices([',', ';']).map(|(at, _)| at);
    let mut ends =
        separators.filter(|at| !text[at + 1..].starts_with(|sign: char| sign.is_ascii_digit()));
    ends.next().unwrap_or(text.len())
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
