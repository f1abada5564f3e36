//! Records of the PEER databases.

use std::io::Read;

use super::lines::{
    Lines, Reason, count, end_of_numbers, number_after, read_numbers, record, scaled,
};
use super::{AccelerationUnit, Record, RecordFormat};
use crate::error::{RecordError, Result};

/// Lines among which the number of points and the time step must stand.
const HEADER_LINES: usize = 12;

/// The `.AT2` files of the Pacific Earthquake Engineering Research Center.
///
/// A header of text, of which the last line gives the number of points and the time step, as
/// `NPTS=  5372, DT=   .0100 SEC` or, in older files, `5372  .0100  NPTS, DT`; then the
/// acceleration in units of g, several to a line. Numbers may touch where the second is negative.
/// Files of velocity or displacement, and other units than g, are refused, and so is a file with
/// fewer or more numbers than it says.
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
    let (points, step) = loop {
        let line = match lines.next()? {
            Some(line) if lines.number <= HEADER_LINES => line.to_ascii_uppercase(),
            _ => return Err(lines.refuse(missing)),
        };
        if let Some((_, unit)) = line.split_once("UNITS OF") {
            let unit = unit.trim().trim_end_matches('.');
            let acceleration = !(line.contains("VELOCITY") || line.contains("DISPLACEMENT"));
            if !(acceleration && matches!(unit, "G" | "G'S")) {
                let text = line.chars().take(60).collect();
                return Err(lines.refuse(RecordError::NotAcceleration { text }));
            }
        }
        if line.contains("NPTS") && line.contains("DT") {
            break header(&line).ok_or_else(|| lines.refuse(missing))?;
        }
    };
    let factor = AccelerationUnit::StandardGravity.in_metres_per_second_squared();
    let values = read_numbers(lines, points)?;
    end_of_numbers(lines, points)?;
    Ok((step, scaled(values, factor)))
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
