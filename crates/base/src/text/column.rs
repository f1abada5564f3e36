//! Column names and cells of numbers, by the same rules for all files.

use std::collections::BTreeSet;
use std::fmt;
use std::fmt::Write;

/// Name of a quantity's column: its name in `snake_case`, then its unit in words.
///
/// Units are, for example, `_n_per_m`, `_m_per_s2`, `_rad`; a ratio has no unit.
pub fn column(name: &str, unit: &str) -> String {
    let mut text = snake_case(name);
    if text.is_empty() {
        text.push_str("unnamed");
    }
    let unit = snake_case(&unit_in_words(unit));
    if !unit.is_empty() {
        text.push('_');
        text += &unit;
    }
    text
}

/// Makes the names of `columns` different from each other and from `existing_names`.
///
/// The second of equal names ends in `_2`, the third in `_3`.
pub fn distinct(existing_names: &[String], columns: impl Iterator<Item = String>) -> Vec<String> {
    let mut used_names: BTreeSet<String> = existing_names.iter().cloned().collect();
    let mut distinct_names = Vec::new();
    for column in columns {
        let mut name = column.clone();
        let mut number = 1_usize;
        while used_names.contains(&name) {
            number += 1;
            name = format!("{column}_{number}");
        }
        used_names.insert(name.clone());
        distinct_names.push(name);
    }
    distinct_names
}

/// Letters and digits in lower case, with an underscore for all characters between them.
fn snake_case(text: &str) -> String {
    let parts = text.split(|character: char| !character.is_alphanumeric());
    let words = parts.filter(|part| !part.is_empty()).map(str::to_lowercase);
    words.collect::<Vec<_>>().join("_")
}

/// A unit with its symbols as words.
fn unit_in_words(unit: &str) -> String {
    let mut text = String::new();
    for character in unit.chars() {
        match character {
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

/// Number in a cell: prints the shortest decimal that reads back as the same number.
///
/// NaN is an empty cell, infinities are `inf` and `-inf`.
#[derive(Clone, Copy)]
pub struct NumberCell(pub f64);

impl fmt::Display for NumberCell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The debug format uses an exponent where it is shorter.
        if self.0.is_nan() { Ok(()) } else { write!(f, "{:?}", self.0) }
    }
}

/// Line of cells, separated by commas, with its line end.
pub fn cell_line<T: fmt::Display>(cells: impl IntoIterator<Item = T>) -> String {
    let mut text = String::new();
    for (k, cell) in cells.into_iter().enumerate() {
        let comma = if k > 0 { "," } else { "" };
        // Writing to memory cannot fail.
        let _ = write!(text, "{comma}{cell}");
    }
    text.push('\n');
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_have_names_and_units() {
        for (name, unit, expected) in [
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
            assert_eq!(column(name, unit), expected);
        }
    }

    #[test]
    fn equal_columns_are_numbered() {
        let names = ["time_s", "a", "a", "a_2", "b", "a"].map(str::to_owned);
        let distinct_names = distinct(&["time_s".to_owned()], names.into_iter());
        assert_eq!(distinct_names, ["time_s_2", "a", "a_2", "a_2_2", "b", "a_3"]);
    }

    #[test]
    fn cells_read_back_as_the_same_number() {
        for value in [0.1, -0.0, 1.0 / 3.0, 1e300, 5e-324, f64::INFINITY, -f64::INFINITY] {
            let text = NumberCell(value).to_string();
            assert_eq!(text.parse::<f64>().map(f64::to_bits), Ok(value.to_bits()), "{text}");
        }
        assert_eq!(
            cell_line([1.0, f64::NAN, f64::INFINITY, 1e-9].map(NumberCell)),
            "1.0,,inf,1e-9\n"
        );
    }
}
