//! The title of a column, and the unit that it names.

use super::AccelerationUnit;
use super::fault::{FaultResult, other_unit_in_title};
use super::unit_name::{MAX_UNIT_NAME_BYTES, SECOND_NAMES, is_ratio_of_units, is_unit};

/// Names of units, in lower case, with another meaning where they are not in brackets.
///
/// `min` is then the minimum, `in` the input, `ms` the main shock.
const AMBIGUOUS_UNIT_NAMES: [&str; 11] =
    ["s", "ms", "min", "h", "v", "in", "%", "day", "days", "sample", "samples"];
/// First words, in lower case, in titles of quantities other than acceleration.
const OTHER_QUANTITY_WORDS: [&str; 5] = ["time", "vel", "velocity", "disp", "displacement"];

/// Returns an error if the title of a column of times names a unit other than the second.
pub(super) fn check_time(title: &str) -> FaultResult<()> {
    match time_unit(title) {
        Some(unit) if !SECOND_NAMES.contains(&unit.to_lowercase().trim_end_matches('.')) => {
            Err(other_unit_in_title(title, "s"))
        }
        _ => Ok(()),
    }
}

/// Returns an error if the title of a column of accelerations names another unit or quantity.
pub(super) fn check_acceleration(title: &str, expected_unit: AccelerationUnit) -> FaultResult<()> {
    let word = first_word(title);
    // `T` may be the transverse component.
    let is_time = word == "t" && title.trim_start_matches(['"', '\'']).starts_with('t');
    let names_other_quantity = (OTHER_QUANTITY_WORDS.contains(&word.as_str()) || is_time)
        && !title.to_lowercase().contains("acc");
    let names_other_unit = acceleration_unit(title)
        .is_some_and(|unit| AccelerationUnit::named(unit) != Some(expected_unit));
    if names_other_quantity || names_other_unit {
        return Err(other_unit_in_title(title, &expected_unit.to_string()));
    }
    Ok(())
}

/// The first word of a title, in lower case.
pub(super) fn first_word(title: &str) -> String {
    let title = title.trim_start_matches(['"', '\'']);
    let word = title.split(|character: char| !character.is_alphanumeric()).next();
    word.unwrap_or(title).to_lowercase()
}

/// The unit that the title of a column of times names, if any.
pub(super) fn time_unit(title: &str) -> Option<&str> {
    bracketed_unit(title).or_else(|| {
        endings(title).find(|&ending| {
            let may_be_unit = ending == title || ending.len() > 1 || ending == "s";
            is_unit(ending) && ending != "in" && may_be_unit
        })
    })
}

/// The unit that the title of a column of accelerations names, if any.
pub(super) fn acceleration_unit(title: &str) -> Option<&str> {
    bracketed_unit(title).or_else(|| {
        endings(title).find(|&ending| {
            // After a name, `m` may mean the middle.
            let is_unambiguous = !AMBIGUOUS_UNIT_NAMES.contains(&ending.to_lowercase().as_str())
                && (ending == title || ending.len() > 1);
            AccelerationUnit::named(ending).is_some()
                || is_ratio_of_units(ending)
                || is_unambiguous && is_unit(ending)
        })
    })
}

/// Whether a title is the name of a unit alone, in brackets or not.
pub(super) fn is_unit_alone(title: &str) -> bool {
    let unbracketed_title =
        title.trim_matches(['(', ')', '[', ']', '{', '}', '（', '）', '"', '\'', ' ']);
    is_unit(unbracketed_title) || AccelerationUnit::named(unbracketed_title).is_some()
}

/// The last unit in brackets in a title: `a (cm/s2)`, `acc[g] filtered`, `a (in cm/s2, corrected)`.
fn bracketed_unit(title: &str) -> Option<&str> {
    let texts = bracketed_texts(title);
    let parts = texts.iter().rev().flat_map(|text| text.split([',', ';']));
    parts.map(without_unit_words).find(|part| is_unit(part))
}

/// A text without the words before a unit: `unit: g`, `in cm/s2`.
fn without_unit_words(text: &str) -> &str {
    let text = text.trim();
    let words = ["in units of ", "units of ", "units: ", "unit: ", "units ", "unit ", "in "];
    words.iter().find_map(|word| text.strip_prefix(word)).unwrap_or(text).trim()
}

/// The texts in the outer brackets of a title; the last one need not be closed.
fn bracketed_texts(title: &str) -> Vec<&str> {
    let mut texts = Vec::new();
    let mut depth = 0;
    let mut text_start = 0;
    for (position, character) in title.char_indices() {
        match character {
            '(' | '[' | '{' | '（' => {
                if depth == 0 {
                    text_start = position + character.len_utf8();
                }
                depth += 1;
            }
            ')' | ']' | '}' | '）' if depth > 0 => {
                depth -= 1;
                if depth == 0 {
                    texts.push(&title[text_start..position]);
                }
            }
            _ => {}
        }
    }
    if depth > 0 {
        texts.push(&title[text_start..]);
    }
    texts
}

/// The title and its parts after each separator, the longest first.
///
/// Example: `a in cm/s2`, `in cm/s2`, `cm/s2`. Texts longer than any unit are skipped.
fn endings(title: &str) -> impl Iterator<Item = &str> {
    let title = title.trim_matches(['"', '\'', ' ']);
    let separators = title.match_indices([' ', '_', ',', '=', '/', '-']);
    let endings =
        separators.map(|(position, separator)| title[position + separator.len()..].trim());
    std::iter::once(title)
        .chain(endings)
        .filter(|text| text.len() <= MAX_UNIT_NAME_BYTES)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_of_times_name_units() {
        let titles_in_seconds = "t|time (s)|time[sec]|Zeit|time_s|TIME (SEC)|t (corrected)|s|t / s|Time, s|t (sec.)|S|T|\
            time (hh:mm:ss)|hh:mm:ss|\"time (s)\"|t [s] (UTC)";
        for title in titles_in_seconds.split('|') {
            assert_eq!(check_time(title), Ok(()), "{title}");
        }
        let other_titles = "time(ms)|t [msec]|time_ms|time (min)|t (g)|a (cm/s2)|ms|t / ms|cm/s2|Time, ms|h|\"ms\"|\
            t (milliseconds)|t (µs)|sample";
        for title in other_titles.split('|') {
            assert!(check_time(title).is_err(), "{title}");
        }
    }

    #[test]
    fn titles_of_accelerations_name_units() {
        use AccelerationUnit::{Gal, MetrePerSecondSquared, StandardGravity};
        for (titles, unit) in [
            (
                "a|N-S|N_S|acc (S)|a (cm/s2)|a [gal]|a (filtered)|a (NS)|a (H1)|a (MS-2)|S|H/V|a_min|a_in|in|min",
                Gal,
            ),
            (
                "a (cm/s2) filtered|a (cm/s2, filtered)|a (in cm/s2)|acc (NS, gal)|a, gal|cm/sec²|a_cm_s2|a/Gal",
                Gal,
            ),
            (
                "acceleration_m_per_s2|(m/s^2)|a (m s-2)|a / (m/s^2)|a (m/(s^2))|a (m/s\u{fffd})|ms-2|acc_m_s2",
                MetrePerSecondSquared,
            ),
            ("acc_g|Acc. in g|g|T|V|\"g\"|a (g)|a [G]|N_G|50g (NS)|a_ms", StandardGravity),
        ] {
            for title in titles.split('|') {
                assert_eq!(check_acceleration(title, unit), Ok(()), "{title}");
            }
        }
        for (titles, unit) in [
            (
                "a (cm/s2)|cm/s2|a, gal|a_cm_s2|cm/sec²|acc (gal, NS)|a (cm/s\u{fffd})",
                MetrePerSecondSquared,
            ),
            (
                "a (mg)|a (%g)|mg|%g|a_mg|a (m s-2)|a (cm/sec²)|a (ms-2)|acceleration_m_per_s2|ms-2|a (10^-3 g)",
                StandardGravity,
            ),
            (
                "acc[g]|acc_g|v (cm/s)|velocity_m_per_s|time (s)|t|Time|u (m)|disp_cm|counts|a (counts)|velocity|acc (G)",
                Gal,
            ),
            ("a (g, filtered|a (unit: g)|a (in g)|a (mm/s2)|a (m/s^-2)|cm/s|a/g|\"t\"", Gal),
        ] {
            for title in titles.split('|') {
                assert!(check_acceleration(title, unit).is_err(), "{title}");
            }
        }
    }
}
