//! Decimal numbers in text files.
//!
//! [`finite`] defines which text counts as a number.

/// The number in a text that is one finite decimal number; `None` otherwise.
///
/// The exponent may have the form of C or Fortran: `1.5`, `-2E+3`, `.5D-2`. A unit after the number, a
/// decimal comma and `inf` are not accepted.
pub fn finite(text: &str) -> Option<f64> {
    if !text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eEdD".contains(&byte)) {
        return None;
    }
    let value: f64 = match text.find(['d', 'D']) {
        Some(_) => text.replace(['d', 'D'], "e").parse().ok()?,
        None => text.parse().ok()?,
    };
    value.is_finite().then_some(value)
}

/// An [`excerpt`] of a text in quotation marks, for messages.
pub fn quoted(text: &str) -> String {
    format!("'{}'", excerpt(text))
}

/// The number in a field of Fortran's format `kPFw.d`.
///
/// `None` if it is no number.
///
/// `scale` is k, and `decimals` is d.
/// Without a decimal point in the field, the last d digits are decimals. Without an exponent, the field contains 10ᵏ
/// times the value.
pub fn fortran_field_value(text: &str, decimals: u16, scale: u16) -> Option<f64> {
    let (digits, exponent) = match text.find(['e', 'E', 'd', 'D']) {
        Some(position) => (&text[..position], Some(text[position + 1..].parse::<i32>().ok()?)),
        None => (text, None),
    };
    let implied_decimals = if has_implied_point(text) { i32::from(decimals) } else { 0 };
    let implied_scale = if exponent.is_some() { 0 } else { i32::from(scale) };
    match exponent.unwrap_or(0).checked_sub(implied_decimals + implied_scale)? {
        0 => finite(digits),
        total_exponent => finite(&format!("{digits}e{total_exponent}")),
    }
}

/// Whether a field has no decimal point, so that the format defines the number of decimals.
pub fn has_implied_point(text: &str) -> bool {
    !text.contains('.')
}

/// Largest number of characters of an [`excerpt`]: enough to find the place in the file.
const MAX_EXCERPT_CHARACTERS: usize = 40;

/// The first characters of a text, for errors; invisible characters are escaped, as in `\u{feff}`.
pub fn excerpt(text: &str) -> String {
    let mut excerpt = String::new();
    for character in text.chars().take(MAX_EXCERPT_CHARACTERS) {
        if character.is_control() || matches!(character, '\u{feff}' | '\u{200b}'..='\u{200f}') {
            excerpt.extend(character.escape_unicode());
        } else {
            excerpt.push(character);
        }
    }
    excerpt
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_whole_texts() {
        for (text, value) in [
            ("1.5", 1.5),
            ("+.5", 0.5),
            ("5.", 5.0),
            ("-2E+3", -2e3),
            ("1.0D-2", 0.01),
            ("3d0", 3.0),
            ("007", 7.0),
            ("1e-999", 0.0),
        ] {
            assert_eq!(finite(text), Some(value), "{text}");
        }
        for text in [
            "",
            " 1",
            "1 ",
            "1,5",
            "inf",
            "nan",
            "1e999",
            "1D",
            "D1",
            "1D2D3",
            "1E2D3",
            ".",
            "-",
            "1-2",
            "0x1",
            "1_0",
            "1.2.3",
            "\u{2212}1",
            "\u{feff}1",
            "1\0",
            "1m",
            "1/2",
            "٣",
        ] {
            assert_eq!(finite(text), None, "{text:?}");
        }
    }

    #[test]
    fn fields_have_the_decimals_of_their_format() {
        for (text, decimals, scale, value) in [
            ("12345", 3, 0, 12.345),
            ("-2345", 3, 0, -2.345),
            ("12.5", 3, 0, 12.5),
            ("12345E1", 3, 0, 123.45),
            ("12345D-01", 3, 0, 1.2345),
            ("5", 0, 0, 5.0),
            ("12.5", 3, 1, 1.25),
            ("12345", 3, 1, 1.2345),
            ("12.5E0", 3, 1, 12.5),
        ] {
            assert_eq!(fortran_field_value(text, decimals, scale), Some(value), "{text}");
        }
        for text in ["", "-", "E5", "1E", "1E9999999999", "1E-2147483648", "**", "1e2e3", "1,5"] {
            assert_eq!(fortran_field_value(text, 3, 0), None, "{text}");
        }
    }

    #[test]
    fn excerpts_escape_invisible_characters() {
        assert_eq!(excerpt("\u{feff}1\r2 \u{2212}é"), "\\u{feff}1\\u{d}2 \u{2212}é");
        assert_eq!(excerpt(&"1".repeat(50)).len(), 40);
    }
}
