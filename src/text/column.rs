//! Names of columns and numbers in cells, by the same rule for all files.

use std::collections::BTreeSet;
use std::fmt;
use std::fmt::Write;

/// Name of a quantity's column: its name in `snake_case`, then its unit in words.
///
/// Units are, for example, `_n_per_m`, `_m_per_s2`, `_rad`; a ratio has no unit.
pub(crate) fn column(name: &str, unit: &str) -> String {
    let mut text = snake(name);
    if text.is_empty() {
        text.push_str("unnamed");
    }
    let unit = snake(&spelled(unit));
    if !unit.is_empty() {
        text.push('_');
        text += &unit;
    }
    text
}

/// Makes `columns` different from each other and from `taken`.
///
/// Of equal names the second ends in `_2`, the third in `_3`.
pub(crate) fn distinct(taken: &[String], columns: impl Iterator<Item = String>) -> Vec<String> {
    let mut known: BTreeSet<String> = taken.iter().cloned().collect();
    let mut rename = |column: String| {
        let numbered = (2_usize..).map(|k| format!("{column}_{k}"));
        let free = std::iter::once(column.clone()).chain(numbered).find(|c| !known.contains(c));
        let free = free.unwrap_or(column);
        known.insert(free.clone());
        free
    };
    columns.map(&mut rename).collect()
}

/// Letters and digits in lower case, with an underscore for all characters between them.
fn snake(text: &str) -> String {
    let words = text.split(|sign: char| !sign.is_alphanumeric());
    let words = words.filter(|word| !word.is_empty()).map(str::to_lowercase);
    words.collect::<Vec<_>>().join("_")
}

/// A unit with its symbols as words.
fn spelled(unit: &str) -> String {
    let mut text = String::new();
    for sign in unit.chars() {
        match sign {
            '/' => text += " per ",
            '%' => text += " percent ",
            '°' => text += " deg ",
            '⁻' => text += " minus",
            '^' => {}
            '¹' => text.push('1'),
            '²' => text.push('2'),
            '³' => text.push('3'),
            '⁴' => text.push('4'),
            other => text.push(other),
        }
    }
    text
}

/// A number in a cell: the shortest decimal that reads back as the same number.
///
/// NaN is an empty cell, infinities are `inf` and `-inf`.
#[derive(Clone, Copy)]
pub(crate) struct Cell(pub(crate) f64);

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The debug format uses an exponent where it is shorter.
        if self.0.is_nan() { Ok(()) } else { write!(f, "{:?}", self.0) }
    }
}

/// Cells of one line.
pub(crate) fn line<T: fmt::Display>(cells: impl IntoIterator<Item = T>) -> String {
    let mut text = String::new();
    for (k, cell) in cells.into_iter().enumerate() {
        let comma = if k > 0 { "," } else { "" };
        // Writing to memory cannot fail.
        let _ = write!(text, "{comma}{cell}");
    }
    text.push('\n');
    text
}

// Decimal numbers in text files (this defines which text counts as a number), and numbers as engineers read
// them.

/// The finite number that the whole of `text` is; `None` for any other text.
///
/// The exponent may have the form of C or Fortran: `1.5`, `-2E+3`, `.5D-2`. A unit after the number, a
/// decimal comma and `inf` are not accepted.
pub(crate) fn finite(text: &str) -> Option<f64> {
    let known = |sign: u8| sign.is_ascii_digit() || b"+-.eEdD".contains(&sign);
    if !text.bytes().all(known) {
        return None;
    }
    let value: f64 = match text.find(['d', 'D']) {
        Some(_) => text.replace(['d', 'D'], "e").parse().ok()?,
        None => text.parse().ok()?,
    };
    value.is_finite().then_some(value)
}

/// An [`excerpt`] of a file in the quotation marks of messages.
pub(crate) fn quoted(text: &str) -> String {
    format!("'{}'", excerpt(text))
}

/// The number in a field of Fortran's format `kPFw.d`.
///
/// Without a decimal point, the last `decimals` digits are after the point. Without an exponent, 10ᵏ times
/// the value is printed.
pub(crate) fn in_field(text: &str, decimals: u16, scale: u16) -> Option<f64> {
    let (digits, exponent) = match text.find(['e', 'E', 'd', 'D']) {
        Some(at) => (&text[..at], Some(text[at + 1..].parse::<i32>().ok()?)),
        None => (text, None),
    };
    let implied = if has_implied_point(text) { i32::from(decimals) } else { 0 };
    let scale = if exponent.is_some() { 0 } else { i32::from(scale) };
    match exponent.unwrap_or(0).checked_sub(implied + scale)? {
        0 => finite(digits),
        exponent => finite(&format!("{digits}e{exponent}")),
    }
}

/// Whether a field has no decimal point, so that the format defines it.
pub(crate) fn has_implied_point(text: &str) -> bool {
    !text.contains('.')
}

/// The first 40 characters, for errors; invisible characters are escaped, as in `\u{feff}`.
pub(crate) fn excerpt(text: &str) -> String {
    let hidden =
        |sign: char| sign.is_control() || matches!(sign, '\u{feff}' | '\u{200b}'..='\u{200f}');
    let shown = |sign: char| {
        if hidden(sign) { sign.escape_unicode().to_string() } else { sign.to_string() }
    };
    text.chars().take(40).map(shown).collect()
}

// Numbers as engineers read them.

/// Factor from an SI unit to the printed unit, and the printed unit; other units are unchanged.
pub(crate) fn printed(unit: &str) -> (f64, &str) {
    match unit {
        "m" => (1e3, "mm"),
        "rad" => (1e3, "mrad"),
        "N/m" => (1e-3, "kN/m"),
        "N·m/m" => (1e-3, "kN·m/m"),
        other => (1.0, other),
    }
}

/// Converts a unit per metre of thickness to the unit of the whole body in plan.
pub(crate) fn of_body(unit: &str, in_plan: bool) -> &str {
    unit.strip_suffix("/m").filter(|_| in_plan).unwrap_or(unit)
}

/// Limit, in printed units, below which a number counts as rounding.
const NOTHING: f64 = 1e-9;

/// Prints five figures, with an exponent only for very small or large numbers, and no negative zero.
pub(crate) fn number(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude < NOTHING {
        "0".to_owned()
    } else if !(1e-3..1e6).contains(&magnitude) {
        format!("{value:.3e}")
    } else if magnitude >= 1e3 {
        format!("{value:.1}")
    } else if magnitude >= 1.0 {
        format!("{value:.3}")
    } else {
        format!("{value:.5}")
    }
}

/// A number with three decimals; no negative zero.
pub(crate) fn thousandths(value: f64) -> String {
    // A value that rounds to zero is written as zero.
    format!("{:.3}", if value.abs() < 0.5e-3 { 0.0 } else { value })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_units_by_one_rule() {
        for (name, unit, known) in [
            ("base shear", "N/m", "base_shear_n_per_m"),
            ("base moment", "N·m/m", "base_moment_n_m_per_m"),
            ("Roof, left (top)", "m/s²", "roof_left_top_m_per_s2"),
            ("roof", "m/s^2", "roof_m_per_s2"),
            ("roof", "m s⁻²", "roof_m_s_minus2"),
            ("rotation", "rad", "rotation_rad"),
            ("uplift", "%", "uplift_percent"),
            ("tilt", "°", "tilt_deg"),
            ("ratio", "", "ratio"),
            ("Größe", "kN/m", "größe_kn_per_m"),
            ("--", "m", "unnamed_m"),
            ("", "", "unnamed"),
            ("a,b\"c\nd", "", "a_b_c_d"),
        ] {
            assert_eq!(column(name, unit), known);
        }
    }

    #[test]
    fn equal_columns_are_numbered() {
        let names = ["time_s", "a", "a", "a_2", "b", "a"].map(str::to_owned);
        let found = distinct(&["time_s".to_owned()], names.into_iter());
        assert_eq!(found, ["time_s_2", "a", "a_2", "a_2_2", "b", "a_3"]);
    }

    #[test]
    fn cells_read_back_as_the_same_number() {
        for value in [0.1, -0.0, 1.0 / 3.0, 1e300, 5e-324, f64::INFINITY, -f64::INFINITY] {
            let text = Cell(value).to_string();
            assert_eq!(text.parse::<f64>().map(f64::to_bits), Ok(value.to_bits()), "{text}");
        }
        assert_eq!(line([1.0, f64::NAN, f64::INFINITY, 1e-9].map(Cell)), "1.0,,inf,1e-9\n");
    }
}

#[cfg(test)]
mod number_tests {
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
    fn fields_have_their_formats_point() {
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
            assert_eq!(in_field(text, decimals, scale), Some(value), "{text}");
        }
        for text in ["", "-", "E5", "1E", "1E9999999999", "1E-2147483648", "**", "1e2e3", "1,5"] {
            assert_eq!(in_field(text, 3, 0), None, "{text}");
        }
    }

    #[test]
    fn hidden_signs_show_in_errors() {
        assert_eq!(excerpt("\u{feff}1\r2 \u{2212}é"), "\\u{feff}1\\u{d}2 \u{2212}é");
        assert_eq!(excerpt(&"1".repeat(50)).len(), 40);
    }
}
