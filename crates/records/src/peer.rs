//! Records of the PEER databases.
//!
//! Layout: Pacific Earthquake Engineering Research Center, *PEER Strong Motion Database* and *NGA-West2*
//! (peer.berkeley.edu, `.AT2`): four lines of header, of which the third names the unit and the fourth number of points
//! and time step, then five numbers per line as `5E15.7`; the headers of older files vary. Only the number of samples is
//! stated twice.

use std::io::Read;

use super::fault::{FaultResult, not_acceleration, not_in_header, unclear};
use super::header_number::{HeaderNumber, clause_end};
use super::lines::{LineResult, Lines, check_end_of_numbers, read_numbers, required};
use super::series::{Series, multiplied, to_record, whole_sample_count};
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
/// The file has a header of text, then the acceleration in units of g, several values on each line. The last line of
/// the header gives the number of points and the time step, as `NPTS=  5372, DT=   .0100 SEC` or, in older files, `5372
/// .0100  NPTS, DT`. Two numbers may touch if the second is negative. The time step is in seconds unless `MSEC`
/// follows, and may be a fraction (`1/100 SEC`). A line of the header must state the unit g: `ACCELERATION TIME SERIES
/// IN UNITS OF G`, with or without text after it (`. FILTER POINTS: HP=0.1 Hz LP=40.0 Hz`), or `ACCELERATION TIME
/// HISTORY (G)`, `The units are (g)`. Reading returns an error without such a line, for velocity or displacement, for
/// other units, and for fewer or more numbers than the header states.
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

/// Reads the component of a file.
fn read(lines: &mut Lines) -> LineResult<Series> {
    let header = read_header(lines)?;
    let factor = SAMPLE_UNIT.in_metres_per_second_squared();
    let values = read_numbers(lines, header.sample_count, None)?;
    check_end_of_numbers(lines, header.sample_count)?;
    Ok(Series {
        name: String::new(),
        time_step: header.time_step,
        samples: multiplied(values, factor),
    })
}

/// Quantities in the last line of the header.
struct PeerHeader {
    /// Number of samples.
    sample_count: usize,
    /// Time step, s.
    time_step: f64,
}

/// Reads the lines of the header.
///
/// Returns an error unless they state that the accelerations are in g.
fn read_header(lines: &mut Lines) -> LineResult<PeerHeader> {
    let quantities = "number of points and time step (NPTS, DT)";
    let mut states_unit = false;
    loop {
        let line = match lines.next()? {
            Some(line) if lines.number <= MAX_HEADER_LINES => line.to_ascii_uppercase(),
            _ => return Err(lines.fault(not_in_header(quantities))),
        };
        match acceleration_in_g(&line) {
            Some(false) => return Err(lines.fault(not_acceleration(&line))),
            Some(true) => states_unit = true,
            None => {}
        }
        if has_word(&line, "NPTS") && has_word(&line, "DT") {
            let header = lines.with_line_number(count_and_time_step(&line))?;
            let header = required(lines, header, quantities)?;
            if states_unit {
                return Ok(header);
            }
            return Err(lines.fault(not_in_header("unit (UNITS OF G)")));
        }
    }
}

/// A unit in a line of the header, with the text around it.
struct StatedUnit<'a> {
    text_before: &'a str,
    name: &'a str,
    text_after: &'a str,
}

/// The unit after a key: `UNITS OF G`, `UNITS ARE (G)`.
fn unit_after_key<'a>(key: &str, line: &'a str) -> Option<StatedUnit<'a>> {
    let (text_before, text) = line.split_once(key)?;
    let text = text.trim_start().trim_start_matches('(').trim_start();
    let end = text.find([' ', '\t', '.', ',', ';', '(', ')']).unwrap_or(text.len());
    Some(StatedUnit { text_before, name: &text[..end], text_after: &text[end..] })
}

/// Whether a line in upper case states accelerations in g (`true`) or another quantity (`false`).
///
/// `None` for a line that states neither.
fn acceleration_in_g(line: &str) -> Option<bool> {
    let keys = ["UNITS OF", "UNITS ARE", "UNITS=", "UNITS =", "UNITS:"];
    let mut unit = keys.into_iter().find_map(|key| unit_after_key(key, line));
    if unit.is_none() && line.contains("ACCELERATION") {
        unit = unit_after_key(" IN ", line).or_else(|| unit_after_key("(", line));
        unit = unit.filter(|unit| may_be_unit(unit.name));
    }
    if line.contains("VELOCITY") || line.contains("DISPLACEMENT") {
        // A title may well mention velocity.
        return (unit.is_some() || line.contains("TIME")).then_some(false);
    }
    let unit = unit?;
    let states_multiple = mentions_factor(unit.text_before) || has_factor(unit.text_after);
    Some(AccelerationUnit::named(unit.name) == Some(SAMPLE_UNIT) && !states_multiple)
}

/// Whether the text after a unit may state a factor of the numbers.
///
/// A number, a word or a missing separator may state one. Numbers of a filter do not, nor does gravity in brackets.
fn has_factor(text: &str) -> bool {
    let text = text.split_once("FILTER").map_or(text, |(text_before, _)| text_before).trim();
    let bracket = text.strip_prefix('(').and_then(|text_inside| text_inside.split_once(')'));
    if let Some((bracketed_text, text_after)) = bracket {
        let value = bracketed_text.split_whitespace().next().and_then(finite);
        return !value.is_some_and(is_gravity) || has_factor(text_after);
    }
    let is_separate = text.is_empty() || text.starts_with(['.', ',', ';', ')']);
    // The number of points is read elsewhere.
    let text = text.split_once("NPTS").map_or(text, |(text_before, _)| text_before);
    !is_separate
        || text.contains(|sign: char| sign.is_ascii_digit() || matches!(sign, '%' | '*'))
        || mentions_factor(text)
        || has_word(text, "SCALE")
}

/// Whether a value is gravity, in m/s² or in cm/s².
fn is_gravity(value: f64) -> bool {
    [1.0, 1e-2]
        .iter()
        .any(|unit| (value * unit / STANDARD_GRAVITY - 1.0).abs() < GRAVITY_TOLERANCE)
}

/// Whether a word after `ACCELERATION` may be its unit.
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
        let text_before = text[..position].trim_end();
        let text_after = text[position + 1..].trim_start();
        if text_before.ends_with(|sign: char| sign.is_ascii_digit())
            || text_after.starts_with(|sign: char| sign.is_ascii_digit())
        {
            return true;
        }
    }
    let mut pairs = text.split_whitespace().zip(text.split_whitespace().skip(1));
    pairs.any(|(word, next_word)| {
        finite(word).is_some() && next_word == "X" || word == "X" && finite(next_word).is_some()
    })
}

/// Whether `word` is a word of `line`.
fn has_word(line: &str, word: &str) -> bool {
    line.split(|character: char| !character.is_alphanumeric())
        .any(|line_word| line_word == word)
}

/// Number of samples and time step in the last line of a header.
fn count_and_time_step(line: &str) -> FaultResult<Option<PeerHeader>> {
    let (sample_count, time_step) = if line.contains(['=', ':']) {
        let sample_count = assigned_value(line, "NPTS", HeaderNumber::Points)?;
        (sample_count, assigned_value(line, "DT", HeaderNumber::TimeStep)?)
    } else {
        listed_values(line)?
    };
    if mentions_factor(line) || has_word(line, "SCALE") {
        return Err(unclear("scale of the numbers", line));
    }
    let header = sample_count
        .and_then(whole_sample_count)
        .zip(time_step.filter(|&time_step| time_step > 0.0));
    Ok(header.map(|(sample_count, time_step)| PeerHeader { sample_count, time_step }))
}

/// The value of a key in `NPTS= 4, DT= .01 SEC`.
///
/// `ORIGINAL DT` is another key than `DT`.
fn assigned_value(line: &str, key: &str, quantity: HeaderNumber) -> FaultResult<Option<f64>> {
    let mut pieces = line.split(['=', ':']).peekable();
    let mut stored_value = None;
    // The key at the end of the previous piece.
    let mut piece_key = pieces.next().map_or("", last_clause);
    while let Some(piece) = pieces.next() {
        let value_end = clause_end(piece);
        let is_last = pieces.peek().is_none();
        let (value_text, next_key) = if is_last {
            (&piece[..value_end], "")
        } else if value_end < piece.len() {
            (&piece[..value_end], last_clause(piece))
        } else {
            // Without a separator the last word of the piece is the next key.
            piece.trim_end().rsplit_once([' ', '\t']).unwrap_or((piece, ""))
        };
        if piece_key == key
            && let Some(value) = quantity.read(value_text)?
            && let Some(previous_value) =
                stored_value.replace(value).filter(|&previous| previous != value)
        {
            return Err(unclear(quantity.name(), &format!("{previous_value} and {value}")));
        }
        piece_key = next_key;
    }
    Ok(stored_value)
}

/// The last of several clauses.
fn last_clause(text: &str) -> &str {
    text.rsplit([',', ';']).next().unwrap_or(text).trim()
}

/// Number of samples and time step of `4  .01  NPTS, DT`, in this order.
///
/// A unit of time may follow the keys.
fn listed_values(line: &str) -> FaultResult<(Option<f64>, Option<f64>)> {
    let separators = [' ', '\t', ','];
    let (value_text, key_text) = line.split_once("NPTS").unwrap_or((line, ""));
    let value_text = value_text.trim_matches(separators);
    let (count_text, step_text) = value_text.split_once(separators).unwrap_or((value_text, ""));
    let unit_text = key_text.trim_matches(separators).strip_prefix("DT");
    let unit_text =
        unit_text.ok_or_else(|| unclear("order of number of points and time step", line))?;
    let step_text = step_text.trim_start_matches(separators);
    let step_text = format!("{step_text} {}", unit_text.trim_matches(separators));
    Ok((HeaderNumber::Points.read(count_text)?, HeaderNumber::TimeStep.read(&step_text)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_state_quantity_and_unit() {
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
