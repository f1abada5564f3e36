//! Records of the PEER databases.
//!
//! Layout: Pacific Earthquake Engineering Research Center, *PEER Strong Motion Database* and *NGA-West2* (peer.berkeley.edu,
//! `.AT2`): four lines of header, of which the third names the unit and the fourth number of points and time step, then
//! five numbers a line as `5E15.7`; the headers of older files vary. Nothing is stated twice but the number of samples.

use std::io::Read;

use super::fault::{no_acceleration, not_in_header, unclear};
use super::header_number::{HeaderNumber, clause_end};
use super::lines::{Lines, Reason, Series, count, end_of_numbers, read_numbers, record, scaled};
use super::{AccelerationUnit, Record, RecordFormat, STANDARD_GRAVITY};
use crate::error::{FileFault, Result};
use crate::text::decimal::finite;

const G: AccelerationUnit = AccelerationUnit::StandardGravity;
/// Number of first lines that must contain the number of points and the time step.
const HEADER_LINES: usize = 12;

/// The `.AT2` files of the Pacific Earthquake Engineering Research Center.
///
/// A header of text, then the acceleration in units of g, several to a line. The last line of the header gives the
/// number of points and the time step, as `NPTS=  5372, DT=   .0100 SEC` or, in older files,
/// `5372  .0100  NPTS, DT`. Numbers may touch where the second is negative. The time step is in seconds unless
/// `MSEC` follows, and may be a fraction (`1/100 SEC`). A line of the header must state the unit g:
/// `ACCELERATION TIME SERIES IN UNITS OF G`, with or without text after it
/// (`. FILTER POINTS: HP=0.1 Hz LP=40.0 Hz`), or `ACCELERATION TIME HISTORY (G)`, `The units are (g)`. Errors: no
/// such line, velocity or displacement, other units, and fewer or more numbers than the header states.
///
/// ```
/// use basemat::motion::{PeerFormat, Record};
/// let text = "PEER NGA STRONG MOTION DATABASE RECORD\n\
///     Imperial Valley-02, 5/19/1940, El Centro Array #9, 180\n\
///     ACCELERATION TIME SERIES IN UNITS OF G\n\
///     NPTS=     6, DT=   .0100 SEC,\n\
///      .1E-02-.2E-02  .3E-02  .4E-02-.5E-02\n  .6E-02\n";
/// let record = Record::from_reader("RSN6.AT2", text.as_bytes(), &PeerFormat)?;
/// assert_eq!((record.len(), record.time_step()), (6, 0.01));
/// assert!((record.accelerations()[4] + 0.005 * 9.80665).abs() < 1e-15);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PeerFormat;

impl RecordFormat for PeerFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        record(name, read(&mut Lines::new(source)))
    }
}

fn read(lines: &mut Lines) -> Reason<Series> {
    let missing = || not_in_header("number of points and time step (NPTS, DT)");
    let mut in_g = false;
    let (points, step) = loop {
        let line = match lines.next()? {
            Some(line) if lines.number <= HEADER_LINES => line.to_ascii_uppercase(),
            _ => return Err(lines.refuse(missing())),
        };
        match acceleration_in_g(&line) {
            Some(false) => {
                return Err(lines.refuse(no_acceleration(&line)));
            }
            said => in_g |= said.is_some(),
        }
        if has_word(&line, "NPTS") && has_word(&line, "DT") {
            let header = header(&line).map_err(|reason| lines.refuse(reason))?;
            break header.ok_or_else(|| lines.refuse(missing()))?;
        }
    };
    if !in_g {
        return Err(lines.refuse(not_in_header("unit (UNITS OF G)")));
    }
    let factor = G.in_metres_per_second_squared();
    let values = read_numbers(lines, points, None)?;
    end_of_numbers(lines, points)?;
    Ok(Series { name: String::new(), step, samples: scaled(values, factor) })
}

/// Whether a line of the header, in upper case, states accelerations in g, or another quantity.
///
/// `None` if it states neither.
fn acceleration_in_g(line: &str) -> Option<bool> {
    let kind = ["ACCELERATION", "VELOCITY", "DISPLACEMENT"].map(|kind| line.contains(kind));
    // The text before `key`, the word after it, and the text after that word.
    let word = |key| {
        let (before, after) = line.split_once(key)?;
        // `UNITS ARE (G)`.
        let after = after.trim_start().trim_start_matches('(').trim_start();
        let end = after.find([' ', '\t', '.', ',', ';', '(', ')']).unwrap_or(after.len());
        Some((before, &after[..end], &after[end..]))
    };
    let stated =
        ["UNITS OF", "UNITS ARE", "UNITS=", "UNITS =", "UNITS:"].into_iter().find_map(word);
    let unit = match stated {
        None if kind[0] => word(" IN ").or_else(|| word("(")).filter(|(_, unit, _)| is_unit(unit)),
        stated => stated,
    };
    match (kind, unit) {
        ([_, false, false], Some((before, unit, rest))) => {
            let times = multiplies(before) || has_factor(rest);
            Some(AccelerationUnit::named(unit) == Some(G) && !times)
        }
        ([_, false, false], None) => None,
        // A title may well mention velocity.
        (_, unit) => (unit.is_some() || line.contains("TIME")).then_some(false),
    }
}

/// Whether the text behind a unit may state that numbers are a multiple of it.
///
/// By a number, by a word, or without a separator. Numbers of a filter, and gravity itself in brackets, do not
/// count.
fn has_factor(rest: &str) -> bool {
    let rest = rest.split_once("FILTER").map_or(rest, |(before, _)| before).trim();
    let gravity = rest.strip_prefix('(').and_then(|rest| rest.split_once(')'));
    if let Some((gravity, rest)) = gravity {
        let value = gravity.split_whitespace().next().and_then(finite);
        let known = value.is_some_and(|value| {
            let near = |unit: f64| (value * unit / STANDARD_GRAVITY - 1.0).abs() < 1e-2;
            near(1.0) || near(1e-2)
        });
        return !known || has_factor(rest);
    }
    let apart = rest.is_empty() || rest.starts_with(['.', ',', ';', ')']);
    // The number of points is read elsewhere.
    let rest = rest.split_once("NPTS").map_or(rest, |(before, _)| before);
    let other = |sign: char| sign.is_ascii_digit() || matches!(sign, '%' | '*');
    !apart || rest.contains(other) || multiplies(rest) || has_word(rest, "SCALE")
}

/// Whether a word after ACCELERATION may be meant as its unit.
fn is_unit(word: &str) -> bool {
    AccelerationUnit::named(word).is_some() || word.contains("/S")
}

/// Whether a text mentions multiplication: `TIMES`, `1000 X`.
fn multiplies(text: &str) -> bool {
    let words = ["TIMES", "SCALED", "FACTOR", "MULTIPLIED", "DIVIDED"];
    let number = |word: &str| finite(word).is_some();
    let mut pairs = text.split_whitespace().zip(text.split_whitespace().skip(1));
    let digit = |sign: char| sign.is_ascii_digit();
    let starred = text.match_indices('*').any(|(at, _)| {
        text[..at].trim_end().ends_with(digit) || text[at + 1..].trim_start().starts_with(digit)
    });
    starred
        || words.iter().any(|word| has_word(text, word))
        || pairs.any(|(a, b)| (number(a) && b == "X") || (a == "X" && number(b)))
}

/// Whether `word` is a word of `line`.
fn has_word(line: &str, word: &str) -> bool {
    line.split(|sign: char| !sign.is_alphanumeric()).any(|found| found == word)
}

/// Number of points and time step, s.
fn header(line: &str) -> std::result::Result<Option<(usize, f64)>, FileFault> {
    let (points, step) = if line.contains(['=', ':']) {
        (
            assigned(line, "NPTS", HeaderNumber::Points)?,
            assigned(line, "DT", HeaderNumber::TimeStep)?,
        )
    } else {
        listed(line)?
    };
    if multiplies(line) || has_word(line, "SCALE") {
        return Err(unclear("scale of the numbers", line));
    }
    let step = step.filter(|&step| step > 0.0);
    Ok(points.and_then(count).zip(step))
}

/// The value of a key in `NPTS= 4, DT= .01 SEC`; `ORIGINAL DT` is another key than `DT`.
fn assigned(
    line: &str,
    key: &str,
    quantity: HeaderNumber,
) -> std::result::Result<Option<f64>, FileFault> {
    let mut pieces = line.split(['=', ':']).peekable();
    let mut found = None;
    // The key at the end of the previous piece.
    let mut name = pieces.next().map_or("", last_clause);
    while let Some(piece) = pieces.next() {
        // The last piece contains only a value.
        let clause = clause_end(piece);
        let (value, next) = match (pieces.peek(), clause < piece.len()) {
            (None, _) => (&piece[..clause], ""),
            (Some(_), true) => (&piece[..clause], last_clause(piece)),
            // Without a separator the last word is the next key.
            (Some(_), false) => piece.trim_end().rsplit_once([' ', '\t']).unwrap_or((piece, "")),
        };
        if name == key
            && let Some(value) = quantity.read(value)?
            && let Some(before) = found.replace(value).filter(|&before| before != value)
        {
            return Err(unclear(quantity.name(), &format!("{before} and {value}")));
        }
        name = next;
    }
    Ok(found)
}

/// The last of several clauses.
fn last_clause(text: &str) -> &str {
    text.rsplit([',', ';']).next().unwrap_or(text).trim()
}

/// Points and step of `4  .01  NPTS, DT`, perhaps with the unit of time at the end.
fn listed(line: &str) -> std::result::Result<(Option<f64>, Option<f64>), FileFault> {
    const GAPS: [char; 3] = [' ', '\t', ','];
    let (values, keys) = line.split_once("NPTS").unwrap_or((line, ""));
    let values = values.trim_matches(GAPS);
    let (points, step) = values.split_once(GAPS).unwrap_or((values, ""));
    let not_understood = || unclear("order of number of points and time step", line);
    let unit = keys.trim_matches(GAPS).strip_prefix("DT").ok_or_else(not_understood)?;
    let step = format!("{} {}", step.trim_start_matches(GAPS), unit.trim_matches(GAPS));
    Ok((HeaderNumber::Points.read(points)?, HeaderNumber::TimeStep.read(&step)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_say_what_the_numbers_are() {
        for (line, known) in [
            ("ACCELERATION TIME SERIES IN UNITS OF G", Some(true)),
            ("ACCELERATION TIME HISTORY IN UNITS OF G.", Some(true)),
            (
                "ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 HZ LP=40.0 HZ",
                Some(true),
            ),
            ("ACCELERATION TIME HISTORY IN UNITS OF G (9.81)", Some(true)),
            ("ACCELERATION TIME SERIES (G)", Some(true)),
            ("ACCELERATION TIME SERIES IN G", Some(true)),
            ("ACCELERATION IN UNITS OF G'S", Some(true)),
            ("THE UNITS ARE (G)", Some(true)),
            ("THE UNITS ARE G.", Some(true)),
            ("THE UNITS ARE (CM/S/S)", Some(false)),
            ("THE UNITS ARE (G X 1000)", Some(false)),
            ("UNITS OF G", Some(true)),
            ("UNITS OF G X 1000", Some(false)),
            ("UNITS OF G (1000)", Some(false)),
            ("ACCELERATION (G)", Some(true)),
            ("UNITS OF GAL", Some(false)),
            ("ACCELERATION TIME SERIES IN UNITS OF CM/S/S", Some(false)),
            ("ACCELERATION TIME SERIES (CM/S/S)", Some(false)),
            ("ACCELERATION OF 5/19/40 (10/15/79)", None),
            ("VELOCITY TIME SERIES (CM/S)", Some(false)),
            ("VELOCITY TIME SERIES IN UNITS OF G", Some(false)),
            ("VELOCITY TIME HISTORY", Some(false)),
            ("DISPLACEMENT TIME SERIES IN UNITS OF CM", Some(false)),
            ("PEER NGA STRONG MOTION DATABASE RECORD", None),
            ("IMPERIAL VALLEY 10/15/79 2319, EL CENTRO ARRAY 6, 230 (G)", None),
            ("CORRECTED ACCELERATION (STATION 117)", None),
            ("STUDY OF VELOCITY PULSES", None),
            ("", None),
        ] {
            assert_eq!(acceleration_in_g(line), known, "{line}");
        }
    }
}
