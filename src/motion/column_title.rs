//! Titles of columns, and the units that they name.

use super::AccelerationUnit;
use crate::error::RecordError;
use crate::text::column::excerpt;

/// Units in brackets of a title that are no units of acceleration.
const OTHERS: [&str; 30] = [
    "s", "sec", "secs", "second", "seconds", "ms", "msec", "min", "h", "hz", "m", "cm", "mm", "in",
    "ft", "m/s", "cm/s", "mm/s", "in/s", "ft/s", "cm/sec", "m/sec", "mg", "mgal", "milli-g", "%g",
    "count", "counts", "v", "mv",
];
/// Names of the second, the unit of a column of times.
const SECONDS: [&str; 5] = ["s", "sec", "secs", "second", "seconds"];

/// The titles in the fields of a line; a unit in brackets belongs to the title before it.
pub(super) fn titles(fields: &[&str]) -> Vec<String> {
    let mut titles: Vec<String> = Vec::new();
    for field in fields {
        let field = field.trim_start_matches('#').trim();
        match titles.last_mut() {
            Some(title) if field.starts_with(['(', '[']) => {
                title.push(' ');
                title.push_str(field);
            }
            _ if field.is_empty() => {}
            _ => titles.push(field.to_owned()),
        }
    }
    titles
}

/// Error if the title of a column of times names a unit other than the second.
pub(super) fn check_time(title: &str) -> Result<(), RecordError> {
    let fault = || Err(RecordError::TitleUnit { text: excerpt(title), unit: "s".into() });
    match bracketed(title).or_else(|| appended(title).filter(|unit| unit.len() > 1)) {
        Some(unit) if SECONDS.contains(&unit.to_ascii_lowercase().as_str()) => Ok(()),
        Some(unit) if is_unit(&unit) => fault(),
        _ => Ok(()),
    }
}

/// Error if the title of a column of accelerations names a unit other than `expected`, or times.
pub(super) fn check_acceleration(
    title: &str,
    expected: AccelerationUnit,
) -> Result<(), RecordError> {
    let name = title.split(['(', '[', '_', ' ']).next().unwrap_or(title).to_ascii_lowercase();
    if name == "t" || name == "time" {
        let unit = expected.to_string();
        return Err(RecordError::TitleUnit { text: excerpt(title), unit });
    }
    let known = |unit: String| AccelerationUnit::named(&unit).is_some();
    // After a name without brackets `s` may mean South.
    let unit = bracketed(title).or_else(|| appended(title).filter(|unit| known(unit.clone())));
    match unit {
        Some(unit) if AccelerationUnit::named(&unit) == Some(expected) => Ok(()),
        Some(unit) if is_unit(&unit) => {
            Err(RecordError::TitleUnit { text: excerpt(title), unit: expected.to_string() })
        }
        _ => Ok(()),
    }
}

/// Whether a text is a unit of acceleration or another unit; a single letter only in lower case.
fn is_unit(text: &str) -> bool {
    let lower = text.to_ascii_lowercase();
    let other = OTHERS.contains(&lower.as_str()) && (text.len() > 1 || lower == text);
    other || AccelerationUnit::named(text).is_some()
}

/// The text in the last brackets of a title: `a (cm/s2)`, `acc[g]`.
fn bracketed(title: &str) -> Option<String> {
    let (_, text) = title.rsplit_once(['(', '['])?;
    let (text, _) = text.split_once([')', ']'])?;
    Some(text.trim().to_owned())
}

/// The unit behind the name in a title: `time_ms`, `acceleration_m_per_s2`, `acc in g`.
fn appended(title: &str) -> Option<String> {
    if let Some((name, below)) = title.rsplit_once("_per_") {
        let (_, above) = name.rsplit_once('_')?;
        return Some(format!("{above}/{below}"));
    }
    Some(title.rsplit_once(['_', ' '])?.1.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_name_units() {
        use AccelerationUnit::{Gal, MetrePerSecondSquared, StandardGravity};
        for title in ["t", "time (s)", "time[sec]", "Zeit", "time_s", "TIME (SEC)", "t (corrected)"]
        {
            assert_eq!(check_time(title), Ok(()), "{title}");
        }
        for title in ["time(ms)", "t [msec]", "time_ms", "time (min)", "t (g)", "a (cm/s2)"] {
            assert!(check_time(title).is_err(), "{title}");
        }
        for (title, unit) in [
            ("a", Gal),
            ("N-S", Gal),
            ("N_S", Gal),
            ("acc (S)", Gal),
            ("a (cm/s2)", Gal),
            ("a [gal]", Gal),
            ("acceleration_m_per_s2", MetrePerSecondSquared),
            ("(m/s^2)", MetrePerSecondSquared),
            ("acc_g", StandardGravity),
            ("Acc. in g", StandardGravity),
            ("a (filtered)", Gal),
        ] {
            assert_eq!(check_acceleration(title, unit), Ok(()), "{title}");
        }
        for (title, unit) in [
            ("a (cm/s2)", MetrePerSecondSquared),
            ("acc[g]", Gal),
            ("acc_g", Gal),
            ("a (mg)", StandardGravity),
            ("v (cm/s)", Gal),
            ("time (s)", Gal),
            ("u (m)", Gal),
            ("t", Gal),
            ("Time", Gal),
            ("acceleration_m_per_s2", StandardGravity),
        ] {
            assert!(check_acceleration(title, unit).is_err(), "{title}");
        }
        assert_eq!(titles(&["#time", "(ms)", "a", "[cm/s2]"]), ["time (ms)", "a [cm/s2]"]);
        assert_eq!(titles(&["#", "t", "a"]), ["t", "a"]);
    }
}
