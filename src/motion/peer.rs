//! Records of the PEER databases.

use std::io::Read;

use super::lines::{
    Lines, Reason, count, end_of_numbers, number_after, read_numbers, record, scaled,
};
use super::{AccelerationUnit, Record, RecordFormat};
use crate::error::{RecordError, Result};

const G: AccelerationUnit = AccelerationUnit::StandardGravity;
/// Lines among which the number of points and the time step must stand.
const HEADER_LINES: usize = 12;

/// The `.AT2` files of the Pacific Earthquake Engineering Research Center.
///
/// A header of text, of which the last line gives the number of points and the time step, as
/// `NPTS=  5372, DT=   .0100 SEC` or, in older files, `5372  .0100  NPTS, DT`; then the
/// acceleration in units of g, several to a line. Numbers may touch where the second is negative.
/// A line of the header must say that the unit is g: `ACCELERATION TIME SERIES IN UNITS OF G`, with
/// or without text behind it (`. FILTER POINTS: HP=0.1 Hz LP=40.0 Hz`), or
/// `ACCELERATION TIME HISTORY (G)`. Files that do not, files of velocity or displacement, other
/// units, and fewer or more numbers than a file says are refused.
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
pub struct PeerFormat;

impl RecordFormat for PeerFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        record(name, read(&mut Lines::new(source)))
    }
}

fn read(lines: &mut Lines) -> Reason<(f64, Vec<f64>)> {
    let missing = RecordError::Missing { quantity: "number of points and time step (NPTS, DT)" };
    let mut in_g = false;
    let (points, step) = loop {
        let line = match lines.next()? {
            Some(line) if lines.number <= HEADER_LINES => line.to_ascii_uppercase(),
            _ => return Err(lines.refuse(missing)),
        };
        match acceleration_in_g(&line) {
            Some(false) => {
                let text = line.chars().take(60).collect();
                return Err(lines.refuse(RecordError::NotAcceleration { text }));
            }
            said => in_g |= said.is_some(),
        }
        if line.contains("NPTS") && line.contains("DT") {
            break header(&line).ok_or_else(|| lines.refuse(missing))?;
        }
    };
    if !in_g {
        return Err(lines.refuse(RecordError::Missing { quantity: "unit (UNITS OF G)" }));
    }
    let factor = G.in_metres_per_second_squared();
    let values = read_numbers(lines, points, None)?;
    end_of_numbers(lines, points)?;
    Ok((step, scaled(values, factor)))
}

/// Whether a line of the header, in upper case, says that the numbers are accelerations in g, or
/// something else; none if it says neither.
fn acceleration_in_g(line: &str) -> Option<bool> {
    let kind = ["ACCELERATION", "VELOCITY", "DISPLACEMENT"].map(|kind| line.contains(kind));
    // The word after `key`, whatever follows it.
    let word = |key| {
        let after = line.split_once(key)?.1.trim_start();
        after.split([' ', '\t', '.', ',', ';', '(', ')']).next()
    };
    let unit = match word("UNITS OF") {
        None if kind[0] => word(" IN ").or_else(|| word("(")).filter(|&unit| is_unit(unit)),
        stated => stated,
    };
    match (kind, unit) {
        ([_, false, false], Some(unit)) => Some(AccelerationUnit::named(unit) == Some(G)),
        ([_, false, false], None) => None,
        // A title may well speak of velocity.
        (_, unit) => (unit.is_some() || line.contains("TIME")).then_some(false),
    }
}

/// Whether a word after ACCELERATION may be meant as its unit.
fn is_unit(word: &str) -> bool {
    AccelerationUnit::named(word).is_some() || word.contains("/S")
}

/// Number of points and time step.
fn header(line: &str) -> Option<(usize, f64)> {
    let (points, step) = if line.contains("NPTS=") || line.contains("NPTS =") {
        (number_after(line, "NPTS")?, number_after(line, "DT")?)
    } else {
        let mut fields = line.split([' ', '\t', ',']).filter(|field| !field.is_empty());
        (fields.next()?.parse().ok()?, fields.next()?.parse().ok()?)
    };
    Some((count(points)?, Some(step).filter(|&step| step > 0.0 && step.is_finite())?))
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
            ("UNITS OF G", Some(true)),
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
