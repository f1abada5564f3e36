//! Columns of fixed width, as Fortran prints numbers.

use std::fmt;
use std::str::FromStr;

use crate::error::{Error, Result};
use crate::text::decimal::fortran_field_value;
use crate::text::words::unknown_word_error;

/// Largest number of fields in a line, and largest width of a field, in a format.
///
/// Formats of files have far smaller numbers; the limit keeps products of both in range.
const MAX_REPEAT_OR_WIDTH: usize = 1000;
/// Upper limit, excluded, of the decimals of a number: longer numbers exceed any field.
const DECIMALS_LIMIT: u16 = 1000;
/// Upper limit, excluded, of the k of `kP`.
///
/// Larger factors exceed the range of numbers in practice.
const SCALE_LIMIT: u16 = 100;

/// A Fortran format of one repeated item: columns of equal width.
///
/// Examples: `(8F10.5)`, `(1E15.6)`, `(1P8E10.3)`.
///
/// ```
/// use basemat::motion::FortranFormat;
/// let format: FortranFormat = "8F9.6".parse()?;
/// assert_eq!((format.numbers_per_line(), format.to_string()), (8, "(8F9.6)".to_owned()));
/// assert!("8F9.6,2X".parse::<FortranFormat>().is_err());
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "String", into = "String"))]
pub struct FortranFormat {
    /// Numbers in a full line.
    pub(super) repeat: usize,
    /// Characters of each number.
    pub(super) width: usize,
    /// Decimals of a number without a point.
    pub(super) decimals: u16,
    /// The k of `kP`: numbers without an exponent are 10ᵏ times the value.
    pub(super) scale: u16,
}

/// The line of a punched card: its numbers, and the card's sequence number.
///
/// A card has its sequence number after the numbers, in columns 73 to 80.
pub(super) struct Card {
    pub(super) numbers: Vec<f64>,
    pub(super) card_number: Option<u64>,
}

impl FortranFormat {
    /// Numbers in a full line.
    pub fn numbers_per_line(&self) -> usize {
        self.repeat
    }

    /// Reads the numbers of a line in these columns.
    ///
    /// `None` if the line does not match them.
    ///
    /// Only the number of a card may follow the columns.
    pub(super) fn read_card(self, line: &str) -> Option<Card> {
        let end = line.len().min(self.repeat * self.width);
        if !line.is_ascii() {
            return None;
        }
        let text_after = &line[end..];
        let fields = self.fields(line[..end].trim_end())?;
        if continues_number(text_after)
            && !fields.last().is_some_and(|field| self.ends_in_column(field))
        {
            return None;
        }
        let card_number = match text_after.trim() {
            "" => None,
            text => Some(text.parse().ok().filter(|_| !text.starts_with('+'))?),
        };
        Some(Card { numbers: self.numbers(&fields)?, card_number })
    }

    /// The numbers in the fields of a line; `None` unless all are finite.
    pub(super) fn numbers(self, fields: &[&str]) -> Option<Vec<f64>> {
        fields
            .iter()
            .map(|field| fortran_field_value(field, self.decimals, self.scale))
            .collect()
    }

    /// Whether numbers without a point have decimals.
    pub(super) fn has_implied_points(self) -> bool {
        self.decimals > 0
    }

    /// Whether a number ends where its column does.
    ///
    /// A number with a point must then have as many decimals as the format.
    fn ends_in_column(self, field: &str) -> bool {
        let mantissa = field.split(['E', 'e', 'D', 'd']).next().unwrap_or(field);
        let decimals = mantissa.split_once('.').map(|(_, decimals)| decimals.len());
        decimals.is_none_or(|decimals| decimals == usize::from(self.decimals))
    }

    /// The last format in brackets in a text, or the format after `format=`.
    ///
    /// `None` if it is not one repeated item.
    pub(super) fn find(text: &str) -> Option<Self> {
        for piece in text.rsplit('(') {
            if let Some((item, _)) = piece.split_once(')')
                && let Some(format) = Self::parse(item)
            {
                return Some(format);
            }
        }
        Self::parse(text.to_ascii_lowercase().split_once("format=")?.1)
    }

    /// Reads one item, such as `8F10.5`, `10I8`, `1E15.6E2` or `1P8E10.3`.
    fn parse(item: &str) -> Option<Self> {
        let (scale, item) = match item.trim().split_once(['P', 'p']) {
            Some((scale, item)) => (scale.parse().ok().filter(|&scale| scale < SCALE_LIMIT)?, item),
            None => (0, item.trim()),
        };
        let letter_position = item.find(|character: char| !character.is_ascii_digit())?;
        let repeat = &item[..letter_position];
        let letter_and_width = &item[letter_position..];
        let width =
            letter_and_width.strip_prefix(['F', 'f', 'E', 'e', 'G', 'g', 'D', 'd', 'I', 'i'])?;
        let is_integer_format = letter_and_width.starts_with(['I', 'i']);
        let (width, decimals) = width.split_once('.').unwrap_or((width, "0"));
        // Digits of the exponent follow an E.
        let (decimals, exponent) = decimals.split_once(['E', 'e']).unwrap_or((decimals, ""));
        if !exponent.bytes().all(|byte| byte.is_ascii_digit()) {
            return None;
        }
        let decimals = decimals.parse().ok().filter(|&decimals: &u16| decimals < DECIMALS_LIMIT)?;
        // In `I8.4` the 4 is the smallest number of digits; none of them are decimals.
        let decimals = if is_integer_format { 0 } else { decimals };
        let repeat = if repeat.is_empty() { 1 } else { repeat.parse().ok()? };
        let width = width.parse().ok()?;
        let is_in_range = (1..=MAX_REPEAT_OR_WIDTH).contains(&repeat)
            && (1..=MAX_REPEAT_OR_WIDTH).contains(&width);
        is_in_range.then_some(Self { repeat, width, decimals, scale })
    }

    /// Whether `text` is a format and nothing else, with or without `format=` and brackets.
    ///
    /// Whole numbers in brackets, which are codes of units, are allowed. `(*)` is a format that matches any line.
    pub(super) fn is_only_format(text: &str) -> bool {
        let mut remaining_text = text.trim_matches([' ', '\t', '.', ',', ';']).to_ascii_lowercase();
        loop {
            let text = remaining_text.trim_start_matches([' ', '\t', '.', ',', ';']);
            let text = match text.strip_prefix("format") {
                Some(text) => text.trim_start_matches([' ', '=', ':']),
                None => text,
            };
            let Some((item, text_after)) =
                text.strip_prefix('(').and_then(|text| text.split_once(')'))
            else {
                return text.is_empty() || Self::parse(text).is_some();
            };
            let is_unit_code = !item.is_empty() && item.bytes().all(|byte| byte.is_ascii_digit());
            if !(is_unit_code || item.trim() == "*" || Self::parse(item).is_some()) {
                return false;
            }
            remaining_text = text_after.to_owned();
        }
    }

    /// The fields of a line of the file, without white space at its end.
    ///
    /// `None` if the line does not match these columns: if it is longer or not ASCII, if a number contains white space,
    /// or if its decimals show that a number continues after the end of its column.
    pub(super) fn fields(self, line: &str) -> Option<Vec<&str>> {
        if !line.is_ascii() || line.len() > self.repeat * self.width {
            return None;
        }
        let mut fields = Vec::new();
        for start in (0..line.len()).step_by(self.width) {
            let end = line.len().min(start + self.width);
            let field = line[start..end].trim();
            let is_one_number = !field.is_empty() && !field.contains(char::is_whitespace);
            if !is_one_number || continues_number(&line[end..]) && !self.ends_in_column(field) {
                return None;
            }
            fields.push(field);
        }
        Some(fields)
    }
}

/// Whether the text after a column may continue the number in it.
fn continues_number(text: &str) -> bool {
    text.starts_with(|character: char| character.is_ascii_digit() || character == '.')
}

/// Accepts brackets around the format.
impl FromStr for FortranFormat {
    type Err = Error;

    /// # Errors
    /// [`Error::Name`] unless the text is one repeated item.
    fn from_str(text: &str) -> Result<Self> {
        let item = text.trim();
        let item_without_brackets =
            item.strip_prefix('(').and_then(|item| item.strip_suffix(')')).unwrap_or(item);
        let examples = &["8F10.5", "1E15.6", "1P8E10.3", "10I8"];
        Self::parse(item_without_brackets)
            .ok_or_else(|| unknown_word_error("Fortran format of one item", text, examples))
    }
}

impl fmt::Display for FortranFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { repeat, width, decimals, scale } = self;
        match scale {
            0 => write!(f, "({repeat}F{width}.{decimals})"),
            _ => write!(f, "({scale}P{repeat}F{width}.{decimals})"),
        }
    }
}

#[cfg(feature = "serde")]
impl TryFrom<String> for FortranFormat {
    type Error = Error;

    fn try_from(text: String) -> Result<Self> {
        text.parse()
    }
}

#[cfg(feature = "serde")]
impl From<FortranFormat> for String {
    fn from(format: FortranFormat) -> Self {
        format.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[expect(clippy::unnecessary_wraps, reason = "compared with an option")]
    fn format_of(scale: u16, repeat: usize, width: usize, decimals: u16) -> Option<FortranFormat> {
        Some(FortranFormat { repeat, width, decimals, scale })
    }

    #[test]
    fn formats_are_found() {
        for (text, expected) in [
            ("4 points, in cm/sec2. (8f10.6)", format_of(0, 8, 10, 6)),
            ("units=cm/s^2 (4),Format=(10F8.5)", format_of(0, 10, 8, 5)),
            ("units=cm/sec2(04),Format=(1E15.6)", format_of(0, 1, 15, 6)),
            ("Format= ( 6F13.6 )", format_of(0, 6, 13, 6)),
            ("(E15.7E3)", format_of(0, 1, 15, 7)),
            ("(1F15.6E)", format_of(0, 1, 15, 6)),
            ("(10I8)", format_of(0, 10, 8, 0)),
            ("(10I8.4)", format_of(0, 10, 8, 0)),
            ("(1P8E10.3)", format_of(1, 8, 10, 3)),
            ("(-1P8E10.3)", None),
            ("(8F10.5E2X)", None),
            ("(8F10.5,2X)", None),
            ("(*)", None),
            ("(4)", None),
            ("(0F8.5) (F0.5)", None),
            ("(99999999999999999999F8.5)", None),
            ("units=g,Format= 8F10.5", format_of(0, 8, 10, 5)),
            ("8F10.5", None),
            ("", None),
        ] {
            assert_eq!(FortranFormat::find(text), expected, "{text}");
        }
    }

    #[test]
    fn lines_are_split_into_fields() {
        let columns = FortranFormat { repeat: 3, width: 4, decimals: 1, scale: 0 };
        assert_eq!(columns.fields("12345678"), Some(vec!["1234", "5678"]));
        assert_eq!(columns.fields("   1-2.312"), Some(vec!["1", "-2.3", "12"]));
        assert_eq!(columns.fields(""), Some(vec![]));
        for unmatched_line in ["1 2 3", "1234        1", "123456781234 ", "é", "2.125", "1.25512"]
        {
            assert_eq!(columns.fields(unmatched_line), None, "{unmatched_line}");
        }
    }

    #[test]
    fn cards_have_a_number_after_their_columns() {
        let format: FortranFormat = "(2F9.6)".parse().unwrap();
        let read = |line: &str| format.read_card(line).map(|card| (card.numbers, card.card_number));
        assert_eq!(read("-0.276388-0.272017"), Some((vec![-0.276_388, -0.272_017], None)));
        assert_eq!(
            read("-0.276388-0.272017       2"),
            Some((vec![-0.276_388, -0.272_017], Some(2)))
        );
        assert_eq!(
            read("-0.276388-0.27201700000002"),
            Some((vec![-0.276_388, -0.272_017], Some(2)))
        );
        assert_eq!(read(" 0.276388               12"), Some((vec![0.276_388], Some(12))));
        for unmatched_line in
            ["-0.276388-0.2720170.1", "-0.276388-0.272017 1 2", "-10.000000-10.055655"]
        {
            assert_eq!(read(unmatched_line), None, "{unmatched_line}");
        }
    }

    #[test]
    fn formats_are_distinguished_from_other_text() {
        for text in [
            "",
            "Format: (8f9.6)",
            "Format = (8F9.5)",
            " (4),Format=(8F10.5)",
            ". (8f10.3)",
            "(04),format=8f10.5",
            " (*)",
            ",",
        ] {
            assert!(FortranFormat::is_only_format(text), "{text}");
        }
        for text in ["x 1000 (8f10.3)", "(8f10.3) x 10", "(x 10)", "()", "(", "(8f10.3,2x)", "8"] {
            assert!(!FortranFormat::is_only_format(text), "{text}");
        }
    }
}
