//! Names of units in headers and titles of files.

use std::str::FromStr;

use super::AccelerationUnit;
use crate::error::{Error, Result};
use crate::text::decimal::finite;
use crate::text::words::unknown;

/// Names of the second, in lower case.
pub(super) const SECONDS: [&str; 5] = ["s", "sec", "secs", "second", "seconds"];

/// Names of the lengths in units of acceleration, in lower case.
const LENGTHS: [(&str, AccelerationUnit); 14] = [
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

/// Units of other quantities than acceleration, and multiples of g and gal, in lower case, between strokes.
const OTHERS: &str = "s|sec|secs|second|seconds|ms|msec|msecs|millisecond|milliseconds|µs|μs|min|mins|minute|\
    minutes|h|hr|hrs|hour|hours|day|days|sample|samples|hz|m|cm|mm|km|in|inch|inches|ft|feet|mg|milli-g|millig|\
    milli g|mgal|mgals|milligal|%|%g|count|counts|cnt|cnts|v|volt|volts|mv|mvolts|kine|kines";

/// Longest name of a unit, bytes.
///
/// Longer texts are not compared with the names.
pub(super) const LONGEST: usize = 48;

impl AccelerationUnit {
    /// The unit with this whole name in files, in upper or lower case: `cm/s2`, `m s^-2`, `g`.
    pub(super) fn named(name: &str) -> Option<Self> {
        if name.len() > LONGEST {
            return None;
        }
        match name.trim().trim_end_matches('.').to_lowercase().as_str() {
            "g" | "g's" | "gs" => Some(Self::StandardGravity),
            "gal" | "gals" => Some(Self::Gal),
            _ => rate(name).filter(|&(_, power)| power == 2).map(|(unit, _)| unit),
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
        let known = &["m/s²", "mm/s²", "g", "Gal", "cm/s²", "ft/s²", "in/s²"];
        Self::named(text).ok_or_else(|| unknown("unit of acceleration", text, known))
    }
}

/// Whether a text is the name of a unit, of acceleration or another one; a letter alone only in lower case.
pub(super) fn is_unit(text: &str) -> bool {
    let text = text.trim().trim_end_matches('.');
    if text.len() > LONGEST {
        return false;
    }
    let lower = text.to_lowercase();
    let other = is_other(&lower) && (text.len() > 1 || lower == text);
    other || AccelerationUnit::named(text).is_some() || is_ratio(text) || is_multiple(text)
}

fn is_other(name: &str) -> bool {
    OTHERS.split('|').any(|other| other == name)
}

/// Whether a text is a ratio of units: `cm/s`, `m/s3`, `rad/s2`, `V/g`.
pub(super) fn is_ratio(text: &str) -> bool {
    if text.len() > LONGEST {
        return false;
    }
    let lower = text.to_lowercase();
    let known = |part: &str| {
        let part = part.trim().trim_end_matches(['2', '3', '²', '³']).trim_end_matches('^');
        // `H/V` is a ratio of components.
        part != "h" && (is_other(part) || ["g", "gal", "rad", "deg"].contains(&part))
    };
    rate(text).is_some() || lower.contains('/') && lower.split('/').all(known)
}

/// A length over a power of the second: the unit of acceleration with this length, and the power.
fn rate(name: &str) -> Option<(AccelerationUnit, u32)> {
    let name = name.trim().trim_end_matches('.');
    let mut joined = String::new();
    let spelled = name.to_lowercase().replace("**", "");
    let spelled = ["_per_", " per "].iter().fold(spelled, |text, per| text.replace(per, "/"));
    let mut parted = false;
    for sign in spelled.chars() {
        match sign {
            // A `²` that is not in UTF-8 is read as U+FFFD.
            '²' | '\u{fffd}' => joined.push('2'),
            '³' => joined.push('3'),
            '¹' => joined.push('1'),
            '⁻' | '−' => joined.push('-'),
            ' ' | '\t' | '_' | '.' | '·' | '⋅' | '*' => parted = true,
            '^' | '(' | ')' | '{' | '}' | '$' => {}
            other => joined.push(other),
        }
    }
    // `MS-2` is a channel, `ms-2` a unit.
    let bare = spelled == name;
    LENGTHS.iter().find_map(|&(length, unit)| {
        let rest = joined.strip_prefix(length)?;
        let power = match rest.strip_prefix('/') {
            Some(rest) => divided(rest),
            None => match rest.strip_prefix('p').filter(|_| bare) {
                Some(rest) => divided(rest),
                None if parted || bare && length.len() <= 2 && length != "in" => multiplied(rest),
                None => None,
            },
        };
        Some((unit, power?))
    })
}

/// The power of the second behind a length and a stroke: 2 of `s2`, `s/s` or `s-2`.
fn divided(text: &str) -> Option<u32> {
    SECONDS.iter().find_map(|second| match text.strip_prefix(second)? {
        "" => Some(1),
        "2" | "-2" => Some(2),
        "3" | "-3" => Some(3),
        rest => SECONDS.contains(&rest.trim_start_matches('/')).then_some(2),
    })
}

/// The power of the second that multiplies a length, with its sign changed: 2 of `s-2`.
fn multiplied(text: &str) -> Option<u32> {
    SECONDS.iter().find_map(|second| match text.strip_prefix(second)? {
        "-1" => Some(1),
        "2" | "-2" => Some(2),
        "3" | "-3" => Some(3),
        _ => None,
    })
}

/// Whether a text is a unit of acceleration with a factor: `10^-3 g`, `g/1000`, `m/s2 x 100`, `% of g`.
fn is_multiple(text: &str) -> bool {
    let lower = text.to_lowercase();
    let words = ["%", "percent", "per cent", "milli"];
    let named = words.iter().filter_map(|word| lower.strip_prefix(word)).any(|rest| {
        let rest = rest.trim_start();
        AccelerationUnit::named(rest.strip_prefix("of ").unwrap_or(rest)).is_some()
    });
    let signs = |text: &str, first: &[char]| {
        let text = text.trim();
        text.contains(|sign: char| sign.is_ascii_digit())
            && text.chars().all(|sign| sign.is_ascii_digit() || "+-.^*/x×·e ".contains(sign))
            && (text.starts_with(first) || text.contains(['^', '*', 'x', '×']))
    };
    named
        || lower.char_indices().skip(1).any(|(at, _)| {
            let (head, tail) = lower.split_at(at);
            // `50g` is the level of a centrifuge.
            let small = finite(head.trim()).is_some_and(|factor| factor.abs() < 1.0);
            AccelerationUnit::named(tail).is_some() && (small || signs(head, &[]))
                || AccelerationUnit::named(head).is_some()
                    && signs(tail, &['/', '*', 'x', '×', '·'])
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accelerations_are_known_by_all_their_names() {
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
        let others = "|m|s|ms|m/s|m/s3|mg|mgal|g2|MS-2|MS2|mss|cms|m s|gal/s|km/s2|m/s2/s|ins2|gallery|1 g|m/min2";
        for name in others.split('|') {
            assert_eq!(AccelerationUnit::named(name), None, "{name}");
        }
    }

    #[test]
    fn units_are_told_from_other_text() {
        let units = "mg|%g|% g|% of g|percent g|milli-g|mgal|10^-3 g|1e-3 g|0.001 g|0.01g|.1 gal|g/1000|g*1000|\
            g x 1000|cm/s2 x 10|cm/s|m/s3|m s-1|rad/s2|V/g|counts|ms|MS|sec.|µs|samples|mps";
        for text in units.split('|') {
            assert!(is_unit(text), "{text}");
        }
        let others = "|NS|EW|UD|S|N|V|H|H/V|N/S|H1|G1|S2|MS2|Z|up|ch 1|1|50g|2g|filtered|corrected|360|90 deg|5 m|\
            HNE|/|e g|hh:mm:ss|x|US";
        for text in others.split('|') {
            assert!(!is_unit(text), "{text}");
        }
    }
}
