//! Corrected records of CESMD: the COSMOS and CSMIP volume-2 formats.

use std::io::Read;

use super::fixed_columns::FixedColumns;
use super::lines::{Lines, Reason, count, number_after, read_numbers, record, scaled};
use super::{AccelerationUnit, Record, RecordFormat};
use crate::error::{RecordError, Result};

/// The `.V2` and `.V2c` files of the Center for Engineering Strong Motion Data.
///
/// Two layouts are understood; in both, a line says what the block of numbers under it is:
///
/// * COSMOS 1.20: `12091 acceleration pts, approx 120 secs, units=cm/s^2 (4), Format=(8F10.5)`,
///   with the sampling interval (ms) as 34th of the 100 real header values;
/// * CSMIP (California Geological Survey):
///   `15200 points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.6)`.
///
/// Numbers are read in the columns of the format that the line names, in which they may touch, and
/// free where a line does not keep to it or none is named. The unit is a whole word, such as
/// `cm/s^2`, `cm/sec/sec`, `gal` or `g`; anything else (counts, `mgal`) is refused, and so is a file
/// that does not name its unit, unless [`with_unit`](Self::with_unit) does.
///
/// A file may hold several channels one after the other, and blocks of velocity and displacement,
/// which are passed over: [`with_channel`](Self::with_channel) counts acceleration blocks.
///
/// ```
/// use basemat::motion::{CosmosFormat, Record};
/// let text = "Corrected accelerogram\n\
///     4 points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.3)\n\
///          1.000    -2.000     3.000-12345.678\n\
///     4 points of veloc data equally spaced at  .005 sec, in cm/sec.  (8f10.3)\n\
///     1.000    -2.000     3.000     4.000\n/&  ---- End of data for channel  1 ----\n";
/// let record = Record::from_reader("CE47380.V2", text.as_bytes(), &CosmosFormat::default())?;
/// assert_eq!((record.len(), record.time_step()), (4, 0.005));
/// assert!((record.accelerations()[3] + 123.45678).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CosmosFormat {
    channel: usize,
    unit: Option<AccelerationUnit>,
}

impl Default for CosmosFormat {
    /// The first channel, in the unit that the file names.
    fn default() -> Self {
        Self { channel: 1, unit: None }
    }
}

impl CosmosFormat {
    /// The acceleration block of this number, counted from 1 in the order of the file.
    #[must_use]
    pub fn with_channel(self, channel: usize) -> Self {
        Self { channel, ..self }
    }

    /// The unit of files that do not name one: those of the 1970s and 1980s end with
    /// `EQUALLY SPACED AT .010 SEC.`, and are in cm/s². What a file says goes before this.
    ///
    /// ```
    /// use basemat::motion::{AccelerationUnit, CosmosFormat, Record};
    /// let text = "2 POINTS OF ACCEL DATA EQUALLY SPACED AT  .010 SEC.   (8F10.3)\n 981.0 -490.5\n";
    /// let read = |format| Record::from_reader("old.V2", text.as_bytes(), &format);
    /// assert!(read(CosmosFormat::default()).is_err());
    /// let record = read(CosmosFormat::default().with_unit(AccelerationUnit::Gal))?;
    /// assert!((record.peak_acceleration() - 9.81).abs() < 1e-12);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    #[must_use]
    pub fn with_unit(self, unit: AccelerationUnit) -> Self {
        Self { unit: Some(unit), ..self }
    }
}

impl RecordFormat for CosmosFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        record(name, read(&mut Lines::new(source), self))
    }
}

/// Which of the real header values of COSMOS is the sampling interval, ms.
const SAMPLING_INTERVAL: usize = 33;

fn read(lines: &mut Lines, format: &CosmosFormat) -> Reason<(f64, Vec<f64>)> {
    let channel = format.channel;
    let mut found = 0;
    // Sampling interval of the last real header, s.
    let mut interval = None;
    while let Some(line) = lines.next()? {
        let lower = line.to_ascii_lowercase();
        if lower.contains("real-header values follow") {
            interval = real_header(lines, &lower)?;
            continue;
        }
        let csmip = lower.contains("points of accel data equally spaced at");
        let cosmos = lower.contains("acceleration pts");
        if !(csmip || cosmos) {
            continue;
        }
        found += 1;
        if found < channel || channel == 0 {
            continue;
        }
        let missing = |quantity| RecordError::Missing { quantity };
        let points = lower
            .split_whitespace()
            .next()
            .and_then(|field| count(field.parse().ok()?))
            .ok_or_else(|| lines.refuse(missing("number of points")))?;
        let step = if csmip { number_after(&lower, "equally spaced at") } else { interval };
        let step = step
            .filter(|&step| step > 0.0)
            .ok_or_else(|| lines.refuse(missing("sampling interval")))?;
        let Some(unit) = unit(&lower, format.unit) else {
            let text = line.chars().take(60).collect();
            return Err(lines.refuse(RecordError::NotAcceleration { text }));
        };
        let factor = unit.in_metres_per_second_squared();
        let values = read_numbers(lines, points, FixedColumns::find(&lower))?;
        return Ok((step, scaled(values, factor)));
    }
    Err(lines.refuse(RecordError::Channel { found, needed: channel }))
}

/// Sampling interval (s) of a block of real header values, if it has one.
fn real_header(lines: &mut Lines, title: &str) -> Reason<Option<f64>> {
    let points =
        title.split_whitespace().next().and_then(|field| count(field.parse().ok()?)).ok_or_else(
            || lines.refuse(RecordError::Missing { quantity: "number of header values" }),
        )?;
    let values = read_numbers(lines, points, FixedColumns::find(title))?;
    // Unknown values are −999.
    Ok(values.get(SAMPLING_INTERVAL).filter(|&&ms| ms > 0.0).map(|ms| ms * 1e-3))
}

/// Unit of the numbers under a title in lower case; `unnamed` if it names none.
fn unit(title: &str, unnamed: Option<AccelerationUnit>) -> Option<AccelerationUnit> {
    let csmip = || title.split_once("equally spaced at")?.1.split_once(" in ");
    let Some((_, after)) = title.split_once("units=").or_else(csmip) else {
        return unnamed;
    };
    // `cm/s^2 (4),Format=(8F10.5)`, `cm/sec2. (8f10.3)`
    AccelerationUnit::named(after.split([',', '(']).next()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_whole_words() {
        use AccelerationUnit::{Gal, MetrePerSecondSquared, StandardGravity};
        for (title, known) in [
            ("4 acceleration pts, approx 1 secs, units=cm/s^2 (4),format=(8f10.5)", Some(Gal)),
            ("4 acceleration pts, units=cm/sec2(04),format=(1e15.6)", Some(Gal)),
            ("4 acceleration pts, units= g,format=(8f10.5)", Some(StandardGravity)),
            ("4 points equally spaced at .01 sec, in cm/sec/sec. (8f10.3)", Some(Gal)),
            ("4 points equally spaced at .01 sec, in g. (8f10.3)", Some(StandardGravity)),
            ("4 points equally spaced at .01 sec, in m/s2 (8f10.3)", Some(MetrePerSecondSquared)),
            ("galileo street: 4 acceleration pts, units=gal", Some(Gal)),
            ("galileo street: 4 acceleration pts, units=mgal", None),
            ("galileo street: 4 acceleration pts, units=mg (8f10.3)", None),
            ("cm/sec2: 4 acceleration pts, units=counts (50),format=(10i8)", None),
            ("4 acceleration pts, units=", None),
            ("4 acceleration pts, units=cm/sec,", None),
            ("4 acceleration pts, in the gallery", Some(MetrePerSecondSquared)),
        ] {
            assert_eq!(unit(title, Some(MetrePerSecondSquared)), known, "{title}");
        }
        assert_eq!(unit("4 points equally spaced at .010 sec.", None), None);
        assert_eq!(unit("4 points equally spaced at .010 sec. (8f10.3)", Some(Gal)), Some(Gal));
    }
}
