//! Names of units in headers and titles of files.

use std::str::FromStr;

use super::AccelerationUnit;
use crate::error::{Error, Result};
use crate::text::decimal::finite;
use crate::text::words::unknown_word_error;

/// Names of the second, in lower case.
pub(super) const SECOND_NAMES: [&str; 5] = ["s", "sec", "secs", "second", "seconds"];

/// Names of lengths, in lower case, and the units of acceleration with these lengths.
const LENGTH_NAMES: [(&str, AccelerationUnit); 14] = [
    ("m", AccelerationUnit::MetrePerSecondSquared),
    ("meter", AccelerationUnit::MetrePerSecondSquared),
    ("meters", AccelerationUnit::MetrePerSecondSquared),
    ("metre", AccelerationUnit::MetrePerSecondSquared),
    ("metres", AccelerationUnit::MetrePerSecondSquared),
    ("cm", AccelerationUnit::Gal),
    ("cms", AccelerationUnit::Gal),
    ("mm", AccelerationUnit::MillimetrePerSecondSquared),
    ("ft", AccelerationUnit::FootPerSecondSquared),
    ("foot", AccelerationUnit::FootPerSecondSquared),
    ("feet", AccelerationUnit::FootPerSecondSquared),
    ("in", AccelerationUnit::InchPerSecondSquared),
    ("inch", AccelerationUnit::InchPerSecondSquared),
    ("inches", AccelerationUnit::InchPerSecondSquared),
];

/// Names of units of other quantities, and of multiples of g and gal.
///
/// They are in lower case, and separated by `|`.
const OTHER_UNIT_NAMES: &str = "s|sec|secs|second|seconds|ms|msec|msecs|millisecond|milliseconds|µs|μs|min|mins|minute|\
    minutes|h|hr|hrs|hour|hours|day|days|sample|samples|hz|m|cm|mm|km|in|inch|inches|ft|feet|mg|milli-g|millig|\
    milli g|mgal|mgals|milligal|%|%g|count|counts|cnt|cnts|v|volt|volts|mv|mvolts|kine|kines";

/// Largest length of a unit's name, bytes; longer texts are not compared.
pub(super) const MAX_UNIT_NAME_BYTES: usize = 48;

impl AccelerationUnit {
    /// The unit with this whole name in files, in upper or lower case.
    ///
    /// Examples: `cm/s2`, `m s^-2`, `g`.
    pub(super) fn named(name: &str) -> Option<Self> {
        if name.len() > MAX_UNIT_NAME_BYTES {
            return None;
        }
        match name.trim().trim_end_matches('.').to_lowercase().as_str() {
            "g" | "g's" | "gs" => Some(Self::StandardGravity),
            "gal" | "gals" => Some(Self::Gal),
            _ => length_per_time(name).filter(|&(_, power)| power == 2).map(|(unit, _)| unit),
        }
    }
}

/// Also accepts the names in files: `cm/s2`, `m/s^2`, `m/sec/sec`, `m s-2`, in upper or lower case.
///
/// ```
/// use basemat::motion::AccelerationUnit;
/// assert_eq!("cm/s^2".parse(), Ok(AccelerationUnit::Gal));
/// assert_eq!("m/s²".parse(), Ok(AccelerationUnit::MetrePerSecondSquared));
/// assert!("mg".parse::<AccelerationUnit>().is_err());
/// ```
impl FromStr for AccelerationUnit {
    type Err = Error;

    /// # Errors
    /// [`Error::Name`] with the known units.
    fn from_str(text: &str) -> Result<Self> {
        let known_units = &["m/s²", "mm/s²", "g", "Gal", "cm/s²", "ft/s²", "in/s²"];
        Self::named(text)
            .ok_or_else(|| unknown_word_error("unit of acceleration", text, known_units))
    }
}

/// Whether a text is the name of a unit, of any quantity.
///
/// A single letter is a unit of another quantity only in lower case.
pub(super) fn is_unit(text: &str) -> bool {
    let text = text.trim().trim_end_matches('.');
    if text.len() > MAX_UNIT_NAME_BYTES {
        return false;
    }
    let lower_case_text = text.to_lowercase();
    let is_other_quantity =
        is_other_unit(&lower_case_text) && (text.len() > 1 || lower_case_text == text);
    is_other_quantity
        || AccelerationUnit::named(text).is_some()
        || is_ratio_of_units(text)
        || is_multiple(text)
}

/// Whether a name in lower case is among [`OTHER_UNIT_NAMES`].
fn is_other_unit(name: &str) -> bool {
    OTHER_UNIT_NAMES.split('|').any(|other| other == name)
}

/// Whether a text is a ratio of units: `cm/s`, `m/s3`, `rad/s2`, `V/g`.
pub(super) fn is_ratio_of_units(text: &str) -> bool {
    if text.len() > MAX_UNIT_NAME_BYTES {
        return false;
    }
    let lower_case_text = text.to_lowercase();
    length_per_time(text).is_some()
        || lower_case_text.contains('/') && lower_case_text.split('/').all(is_unit_power)
}

/// Whether a text in lower case is a unit or its square or cube.
fn is_unit_power(text: &str) -> bool {
    let unit = text.trim().trim_end_matches(['2', '3', '²', '³']).trim_end_matches('^');
    // `H/V` is a ratio of components.
    unit != "h" && (is_other_unit(unit) || ["g", "gal", "rad", "deg"].contains(&unit))
}

/// Reads a length over a power of the second.
///
/// Returns the unit of acceleration with this length, and the power.
fn length_per_time(name: &str) -> Option<(AccelerationUnit, u32)> {
    let name = name.trim().trim_end_matches('.');
    let mut compact_name = String::new();
    let spelled_name = name.to_lowercase().replace("**", "");
    let spelled_name =
        ["_per_", " per "].iter().fold(spelled_name, |text, word| text.replace(word, "/"));
    let mut has_separator = false;
    for character in spelled_name.chars() {
        match character {
            // A `²` that is not in UTF-8 is read as U+FFFD.
            '²' | '\u{fffd}' => compact_name.push('2'),
            '³' => compact_name.push('3'),
            '¹' => compact_name.push('1'),
            '⁻' | '−' => compact_name.push('-'),
            ' ' | '\t' | '_' | '.' | '·' | '⋅' | '*' => has_separator = true,
            '^' | '(' | ')' | '{' | '}' | '$' => {}
            other => compact_name.push(other),
        }
    }
    // `MS-2` is a channel, `ms-2` a unit.
    let is_lower_case = spelled_name == name;
    LENGTH_NAMES.iter().find_map(|&(length, unit)| {
        let divisor = compact_name.strip_prefix(length)?;
        let power = match divisor.strip_prefix('/') {
            Some(time) => power_of_divisor(time),
            None => match divisor.strip_prefix('p').filter(|_| is_lower_case) {
                Some(time) => power_of_divisor(time),
                None if has_separator || is_lower_case && length.len() <= 2 && length != "in" => {
                    negative_power(divisor)
                }
                None => None,
            },
        };
        Some((unit, power?))
    })
}

/// The power of the second by which a length is divided.
///
/// It is 2 for `s2`, `s/s` or `s-2`.
fn power_of_divisor(text: &str) -> Option<u32> {
    SECOND_NAMES.iter().find_map(|second| match text.strip_prefix(second)? {
        "" => Some(1),
        "2" | "-2" => Some(2),
        "3" | "-3" => Some(3),
        product => SECOND_NAMES.contains(&product.trim_start_matches('/')).then_some(2),
    })
}

/// The power of the second that multiplies a length, with its sign changed: 2 of `s-2`.
fn negative_power(text: &str) -> Option<u32> {
    SECOND_NAMES.iter().find_map(|second| match text.strip_prefix(second)? {
        "-1" => Some(1),
        "2" | "-2" => Some(2),
        "3" | "-3" => Some(3),
        _ => None,
    })
}

/// Whether a text is a unit of acceleration with a factor.
///
/// Examples: `10^-3 g`, `g/1000`, `m/s2 x 100`, `% of g`.
fn is_multiple(text: &str) -> bool {
    let lower_case_text = text.to_lowercase();
    for word in ["%", "percent", "per cent", "milli"] {
        if let Some(text_after_word) = lower_case_text.strip_prefix(word) {
            let text_after_word = text_after_word.trim_start();
            let unit = text_after_word.strip_prefix("of ").unwrap_or(text_after_word);
            if AccelerationUnit::named(unit).is_some() {
                return true;
            }
        }
    }
    lower_case_text.char_indices().skip(1).any(|(position, _)| {
        let head = &lower_case_text[..position];
        let tail = &lower_case_text[position..];
        // A large number before `g`, as in `50g`, is the acceleration level of a centrifuge test.
        let is_small_factor = finite(head.trim()).is_some_and(|factor| factor.abs() < 1.0);
        let has_factor_before = is_small_factor || is_factor(head, &[]);
        let has_factor_after = is_factor(tail, &['/', '*', 'x', '×', '·']);
        AccelerationUnit::named(tail).is_some() && has_factor_before
            || AccelerationUnit::named(head).is_some() && has_factor_after
    })
}

/// Whether a text is a number that begins with one of the `operators`, or contains one.
fn is_factor(text: &str, operators: &[char]) -> bool {
    let text = text.trim();
    text.contains(|character: char| character.is_ascii_digit())
        && text.chars().all(|sign| sign.is_ascii_digit() || "+-.^*/x×·e ".contains(sign))
        && (text.starts_with(operators) || text.contains(['^', '*', 'x', '×']))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_accelerations_are_read() {
        use AccelerationUnit::{
            FootPerSecondSquared, Gal, InchPerSecondSquared, MetrePerSecondSquared,
            MillimetrePerSecondSquared, StandardGravity,
        };
        for (unit, names) in [
            (
                MetrePerSecondSquared,
                "m/s2|m/s²|m/s^2|m/s**2|m/s/s|m/sec2|M/SEC/SEC|m/sec²|m s-2|m s^-2|m s⁻²|m·s⁻²|m.s-2|m*s^-2|ms-2|\
                 ms^-2|ms2|m/s^-2|m/(s^2)|m/(s s)|m_per_s2|m per s2|m_s2|mps2|meters/second^2|metre/s2|m/s^{2}|\
                 m/s\u{fffd}|m / s 2|M S-2",
            ),
            (Gal, "gal|Gal.|gals|cm/s2|cms/sec/sec|cm/sec²|cm s-2|cm/ss|cm/sec**2|CM/SEC2|cmps2"),
            (MillimetrePerSecondSquared, "mm/s2|mm/s/s|mm s⁻²|mm/sec^2"),
            (StandardGravity, "g|G|g's|gs|g."),
            (FootPerSecondSquared, "ft/s2|ft/sec/sec|feet/s^2"),
            (InchPerSecondSquared, "in/s2|in/sec2|inches/sec^2"),
        ] {
            for name in names.split('|') {
                assert_eq!(AccelerationUnit::named(name), Some(unit), "{name}");
            }
        }
        let other_names = "|m|s|ms|m/s|m/s3|mg|mgal|g2|MS-2|MS2|mss|cms|m s|gal/s|km/s2|m/s2/s|ins2|gallery|1 g|m/min2";
        for name in other_names.split('|') {
            assert_eq!(AccelerationUnit::named(name), None, "{name}");
        }
    }

    #[test]
    fn units_are_distinguished_from_other_text() {
        let units = "mg|%g|% g|% of g|percent g|milli-g|mgal|10^-3 g|1e-3 g|0.001 g|0.01g|.1 gal|g/1000|g*1000|\
            g x 1000|cm/s2 x 10|cm/s|m/s3|m s-1|rad/s2|V/g|counts|ms|MS|sec.|µs|samples|mps";
        for text in units.split('|') {
            assert!(is_unit(text), "{text}");
        }
        let other_texts = "|NS|EW|UD|S|N|V|H|H/V|N/S|H1|G1|S2|MS2|Z|up|ch 1|1|50g|2g|filtered|corrected|360|90 deg|5 m|\
            HNE|/|e g|hh:mm:ss|x|US";
        for text in other_texts.split('|') {
            assert!(!is_unit(text), "{text}");
        }
    }
}
