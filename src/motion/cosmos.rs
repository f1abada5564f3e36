//! Corrected records of CESMD: the COSMOS and CSMIP volume-2 formats.

use std::io::Read;

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
/// A file may hold several channels one after the other, and blocks of velocity and displacement,
/// which are passed over: [`with_channel`](Self::with_channel) counts acceleration blocks. Units
/// are cm/s² or g, anything else (counts, say) is refused.
///
/// ```
/// use basemat::motion::{CosmosFormat, Record};
/// let text = "Corrected accelerogram\n\
///     4 points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.3)\n\
///     1.000    -2.000     3.000-12345.678\n\
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
}

impl Default for CosmosFormat {
    /// The first channel.
    fn default() -> Self {
        Self { channel: 1 }
    }
}

impl CosmosFormat {
    /// The acceleration block of this number, counted from 1 in the order of the file.
    #[must_use]
    pub fn with_channel(self, channel: usize) -> Self {
        Self { channel }
    }
}

impl RecordFormat for CosmosFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        record(name, read(&mut Lines::new(source), self.channel))
    }
}

/// Which of the real header values of COSMOS is the sampling interval, ms.
const SAMPLING_INTERVAL: usize = 33;

fn read(lines: &mut Lines, channel: usize) -> Reason<(f64, Vec<f64>)> {
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
        let Some(unit) = unit(&lower) else {
            let text = line.chars().take(60).collect();
            return Err(lines.refuse(RecordError::NotAcceleration { text }));
        };
        let factor = unit.in_metres_per_second_squared();
        let values = read_numbers(lines, points)?;
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
    let values = read_numbers(lines, points)?;
    // Unknown values are −999.
    Ok(values.get(SAMPLING_INTERVAL).filter(|&&ms| ms > 0.0).map(|ms| ms * 1e-3))
}

/// Unit of the numbers under a title in lower case.
fn unit(title: &str) -> Option<AccelerationUnit> {
    if ["cm/sec2", "cm/s^2", "cm/sec/sec", "cm/sec^2", "cm/s2", "cm/s/s", "gal"]
        .iter()
        .any(|unit| title.contains(unit))
    {
        return Some(AccelerationUnit::Gal);
    }
    let after = title.split_once("units=").or_else(|| title.split_once(", in "))?.1.trim_start();
    let word = after.split([' ', ',', '(', '.']).next()?;
    (word == "g").then_some(AccelerationUnit::StandardGravity)
}
