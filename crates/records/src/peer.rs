//! Records of the PEER databases.
//!
//! Layout: Pacific Earthquake Engineering Research Center, *PEER Strong Motion Database* and *NGA-West2* (peer.berkeley.edu,
//! `.AT2`): four lines of header, of which the third names the unit and the fourth number of points and time step, then
//! five numbers a line as `5E15.7`; the headers of older files vary. Only the number of samples is stated twice.

use std::io::Read;

use super::fault::{FaultResult, not_acceleration, not_in_header, unclear};
use super::header_number::{HeaderNumber, clause_end};
use super::lines::{
    LineResult, Lines, Series, end_of_numbers, read_numbers, required, sample_count, scaled,
    to_record,
};
use super::{AccelerationUnit, Record, RecordFormat, STANDARD_GRAVITY};
use crate::error::Result;
use crate::text::decimal::finite;

/// Unit of the samples.
const SAMPLE_UNIT: AccelerationUnit = AccelerationUnit::StandardGravity;
/// Number of first lines that must contain the number of points and the time step.
const MAX_HEADER_LINES: usize = 12;
/// Largest relative difference of a value of gravity in a header from standard gravity.
const GRAVITY_TOLERANCE: f64 = 1e-2;

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
        to_record(name, read(&mut Lines::new(source)))
    }
}

/// Reads the component.
fn read(lines: &mut Lines) -> LineResult<Series> {
    let header = read_header(lines)?;
    let factor = SAMPLE_UNIT.in_metres_per_second_squared();
    let values = read_numbers(lines, header.points, None)?;
    end_of_numbers(lines, header.points)?;
    Ok(Series { name: String::new(), step: header.step, samples: scaled(values, factor) })
}

/// Quantities in the last line of the header.
struct PeerHeader {
    /// Number of samples.
    points: usize,
    /// Time step, s.
    step: f64,
}

/// Reads the lines of the header; an error unless they state that the accelerations are in g.
fn read_header(lines: &mut Lines) -> LineResult<PeerHeader> {
    let quantities = "number of points and time step (NPTS, DT)";
    let mut is_in_g = false;
    loop {
        let line = match lines.next()? {
            Some(line) if lines.number <= MAX_HEADER_LINES => line.to_ascii_uppercase(),
            _ => return Err(lines.fault(not_in_header(quantities))),
        };
        match acceleration_in_g(&line) {
            Some(false) => return Err(lines.fault(not_acceleration(&line))),
            Some(true) => is_in_g = true,
            None => {}
        }
        if has_word(&line, "NPTS") && has_word(&line, "DT") {
            let header = lines.with_line_number(points_and_step(&line))?;
            let header = required(lines, header, quantities)?;
            if is_in_g {
                return Ok(header);
            }
            return Err(lines.fault(not_in_header("unit (UNITS OF G)")));
        }
    }
}

/// A unit in a line of the header, with the text around it.
struct StatedUnit<'a> {
    before: &'a str,
    name: &'a str,
    after: &'a str,
}

/// The unit behind a key: `UNITS OF G`, `UNITS ARE (G)`.
fn unit_behind<'a>(key: &str, line: &'a str) -> Option<StatedUnit<'a>> {
    let (before, rest) = line.split_once(key)?;
    let rest = rest.trim_start().trim_start_matches('(').trim_start();
    let end = rest.find([' ', '\t', '.', ',', ';', '(', ')']).unwrap_or(rest.len());
    Some(StatedUnit { before, name: &rest[..end], after: &rest[end..] })
}

/// Whether a line of the header, in upper case, states accelerations in g, or another quantity.
///
/// `None` if it states neither.
fn acceleration_in_g(line: &str) -> Option<bool> {
    let keys = ["UNITS OF", "UNITS ARE", "UNITS=", "UNITS =", "UNITS:"];
    let mut unit = keys.into_iter().find_map(|key| unit_behind(key, line));
    if unit.is_none() && line.contains("ACCELERATION") {
        unit = unit_behind(" IN ", line).or_else(|| unit_behind("(", line));
        unit = unit.filter(|unit| may_be_unit(unit.name));
    }
    if line.contains("VELOCITY") || line.contains("DISPLACEMENT") {
        // A title may well mention velocity.
        return (unit.is_some() || line.contains("TIME")).then_some(false);
    }
    let unit = unit?;
    let is_multiple = mentions_factor(unit.before) || has_factor(unit.after);
    Some(AccelerationUnit::named(unit.name) == Some(SAMPLE_UNIT) && !is_multiple)
}

/// Whether the text behind a unit may state that numbers are a multiple of it.
///
/// By a number, by a word, or without a separator. Numbers of a filter, and gravity itself in brackets, do not
/// count.
fn has_factor(rest: &str) -> bool {
    let rest = rest.split_once("FILTER").map_or(rest, |(before, _)| before).trim();
    let in_brackets = rest.strip_prefix('(').and_then(|rest| rest.split_once(')'));
    if let Some((text, rest)) = in_brackets {
        let value = text.split_whitespace().next().and_then(finite);
        return !value.is_some_and(is_gravity) || has_factor(rest);
    }
    let is_separate = rest.is_empty() || rest.starts_with(['.', ',', ';', ')']);
    // The number of points is read elsewhere.
    let rest = rest.split_once("NPTS").map_or(rest, |(before, _)| before);
    !is_separate
        || rest.contains(|sign: char| sign.is_ascii_digit() || matches!(sign, '%' | '*'))
        || mentions_factor(rest)
        || has_word(rest, "SCALE")
}

/// Whether a value is gravity, in m/s² or in cm/s².
fn is_gravity(value: f64) -> bool {
    [1.0, 1e-2]
        .iter()
        .any(|unit| (value * unit / STANDARD_GRAVITY - 1.0).abs() < GRAVITY_TOLERANCE)
}

/// Whether a word after ACCELERATION may be meant as its unit.
fn may_be_unit(word: &str) -> bool {
    AccelerationUnit::named(word).is_some() || word.contains("/S")
}

/// Whether a text mentions a factor: `TIMES`, `1000 X`, `* 10`.
fn mentions_factor(text: &str) -> bool {
    let words = ["TIMES", "SCALED", "FACTOR", "MULTIPLIED", "DIVIDED"];
    if words.iter().any(|word| has_word(text, word)) {
        return true;
    }
    for (position, _) in text.match_indices('*') {
        let before = text[..position].trim_end();
        let after = text[position + 1..].trim_start();
        if before.ends_with(|sign: char| sign.is_ascii_digit())
            || after.starts_with(|sign: char| sign.is_ascii_digit())
        {
            return true;
        }
    }
    let mut pairs = text.split_whitespace().zip(text.split_whitespace().skip(1));
    pairs.any(|(first, second)| {
        finite(first).is_some() && second == "X" || first == "X" && finite(second).is_some()
    })
}

/// Whether `word` is a word of `line`.
fn has_word(line: &str, word: &str) -> bool {
    line.split(|character: char| !character.is_alphanumeric()).any(|found| found == word)
}

/// Number of points and time step in the last line of the header.
fn points_and_step(line: &str) -> FaultResult<Option<PeerHeader>> {
    let (points, step) = if line.contains(['=', ':']) {
        let points = assigned_value(line, "NPTS", HeaderNumber::Points)?;
        (points, assigned_value(line, "DT", HeaderNumber::TimeStep)?)
    } else {
        listed_values(line)?
    };
    if mentions_factor(line) || has_word(line, "SCALE") {
        return Err(unclear("scale of the numbers", line));
    }
    let header = points.and_then(sample_count).zip(step.filter(|&step| step > 0.0));
    Ok(header.map(|(points, step)| PeerHeader { points, step }))
}

/// The value of a key in `NPTS= 4, DT= .01 SEC`; `ORIGINAL DT` is another key than `DT`.
fn assigned_value(line: &str, key: &str, quantity: HeaderNumber) -> FaultResult<Option<f64>> {
    let mut pieces = line.split(['=', ':']).peekable();
    let mut found = None;
    // The key at the end of the previous piece.
    let mut name = pieces.next().map_or("", last_clause);
    while let Some(piece) = pieces.next() {
        let clause = clause_end(piece);
        let is_last = pieces.peek().is_none();
        let (value, next_name) = if is_last {
            (&piece[..clause], "")
        } else if clause < piece.len() {
            (&piece[..clause], last_clause(piece))
        } else {
            // Without a separator the last word is the next key.
            piece.trim_end().rsplit_once([' ', '\t']).unwrap_or((piece, ""))
        };
        if name == key
            && let Some(value) = quantity.read(value)?
            && let Some(other) = found.replace(value).filter(|&previous| previous != value)
        {
            return Err(unclear(quantity.name(), &format!("{other} and {value}")));
        }
        name = next_name;
    }
    Ok(found)
}

/// The last of several clauses.
fn last_clause(text: &str) -> &str {
    text.rsplit([',', ';']).next().unwrap_or(text).trim()
}

/// Points and step of `4  .01  NPTS, DT`, perhaps with the unit of time at the end.
fn listed_values(line: &str) -> FaultResult<(Option<f64>, Option<f64>)> {
    let separators = [' ', '\t', ','];
    let (values, keys) = line.split_once("NPTS").unwrap_or((line, ""));
    let values = values.trim_matches(separators);
    let (points, step) = values.split_once(separators).unwrap_or((values, ""));
    let unit = keys.trim_matches(separators).strip_prefix("DT");
    let unit = unit.ok_or_else(|| unclear("order of number of points and time step", line))?;
    let step = step.trim_start_matches(separators);
    let step = format!("{step} {}", unit.trim_matches(separators));
    Ok((HeaderNumber::Points.read(points)?, HeaderNumber::TimeStep.read(&step)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_say_what_the_numbers_are() {
        for (line, expected) in [
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
            assert_eq!(acceleration_in_g(line), expected, "{line}");
        }
    }
}
