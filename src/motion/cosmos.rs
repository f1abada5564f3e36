//! Corrected records of CESMD: the COSMOS and CSMIP volume-2 formats.

use std::io::Read;

use super::format::FixedColumns;
use super::lines::{Lines, Reason, count, push_numbers, read_numbers, record, scaled};
use super::unit::{HeaderNumber, clause_end, unclear};
use super::{AccelerationUnit, Record, RecordFormat};
use crate::error::{RecordError, Result};
use crate::text::column::finite;

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
/// free where a line does not keep to it or none is named. In its column, a number without a
/// decimal point has the decimals of the format, as in Fortran: `12345` under `8F10.3` is 12.345. A
/// format that is not one repeated item is an error. The unit is a whole word, such as
/// `cm/s^2`, `cm/sec/sec`, `gal` or `g`; anything else (counts, `mgal`) is an error, and so is a file
/// that does not name its unit, unless [`CosmosFormat::unit`] does.
///
/// A file may hold several channels one after the other, and blocks of velocity and displacement,
/// which are passed over: [`channel`](Self::channel) counts acceleration blocks.
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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct CosmosFormat {
    /// Number of the acceleration block, counted from 1 in the order of the file.
    pub channel: usize,
    /// Unit of files that do not name one: those of the 1970s and 1980s end with `EQUALLY SPACED AT .010 SEC.`, and are
    /// in cm/s². What a file says goes before this.
    ///
    /// ```
    /// use basemat::motion::{AccelerationUnit, CosmosFormat, Record};
    /// let text = "2 POINTS OF ACCEL DATA EQUALLY SPACED AT  .010 SEC.   (8F10.3)\n 981.0 -490.5\n";
    /// let read = |format| Record::from_reader("old.V2", text.as_bytes(), &format);
    /// assert!(read(CosmosFormat::default()).is_err());
    /// let unit = Some(AccelerationUnit::Gal);
    /// let record = read(CosmosFormat { unit, ..CosmosFormat::default() })?;
    /// assert!((record.peaks().acceleration - 9.81).abs() < 1e-12);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub unit: Option<AccelerationUnit>,
}

impl Default for CosmosFormat {
    /// The first channel, in the unit that the file names.
    fn default() -> Self {
        Self { channel: 1, unit: None }
    }
}

impl RecordFormat for CosmosFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        record(name, read(&mut Lines::new(source), self))
    }
}

/// Place of the sampling interval (ms) among the real header values of COSMOS.
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
        let titles = ["points of accel data equally spaced at", "acceleration pts"];
        if !titles.iter().any(|title| lower.contains(title)) {
            continue;
        }
        found += 1;
        if found < channel || channel == 0 {
            continue;
        }
        let block = Block::read(&line, interval, format.unit);
        let block = block.map_err(|reason| lines.refuse(reason))?;
        let values = read_numbers(lines, block.points, block.columns)?;
        return Ok((block.step, scaled(values, block.unit.in_metres_per_second_squared())));
    }
    Err(lines.refuse(RecordError::Channel { found, needed: channel }))
}

/// Numbers of a block as its title announces them.
struct Block {
    points: usize,
    /// s.
    step: f64,
    unit: AccelerationUnit,
    columns: Option<FixedColumns>,
}

impl Block {
    /// COSMOS has the sampling interval (s) somewhere else than in the title; `unnamed` is the unit
    /// if the title names none.
    fn read(
        line: &str,
        interval: Option<f64>,
        unnamed: Option<AccelerationUnit>,
    ) -> std::result::Result<Self, RecordError> {
        let title = line.to_ascii_lowercase();
        let title = title.as_str();
        let points = points(title, "number of points")?;
        let step = match csmip(title) {
            Some(text) => HeaderNumber::TimeStep.read(&text[..time_end(text)])?,
            None => interval,
        };
        let missing = RecordError::Missing { quantity: "sampling interval" };
        let step = step.filter(|&step| step > 0.0).ok_or(missing)?;
        let not_acceleration =
            || RecordError::NotAcceleration { text: line.chars().take(60).collect() };
        let unit = unit(title, unnamed).ok_or_else(not_acceleration)?;
        let rest = after_unit(title);
        if !FixedColumns::is_all_of(rest) {
            return Err(unclear("unit or format", rest.trim()));
        }
        Ok(Self { points, step, unit, columns: FixedColumns::find(title) })
    }
}

/// Sampling interval (s) of a block of real header values, if it has one.
fn real_header(lines: &mut Lines, title: &str) -> Reason<Option<f64>> {
    let points = points(title, "number of header values").map_err(|reason| lines.refuse(reason))?;
    let columns = FixedColumns::find(title);
    if let Some((_, format)) = title.split_once("format=")
        && !FixedColumns::is_all_of(format)
    {
        return Err(lines.refuse(unclear("format", format.trim())));
    }
    let values = read_numbers(lines, points, columns)?;
    // Unknown values are −999.
    Ok(values.get(SAMPLING_INTERVAL).filter(|&&ms| ms > 0.0).map(|ms| ms / 1e3))
}

/// The number that a title begins with.
fn points(title: &str, quantity: &'static str) -> std::result::Result<usize, RecordError> {
    let first = title.split_whitespace().next();
    first.and_then(|field| count(finite(field)?)).ok_or(RecordError::Missing { quantity })
}

/// The text of a CSMIP title after its key: time step, unit and format.
fn csmip(title: &str) -> Option<&str> {
    Some(title.split_once("equally spaced at")?.1)
}

/// End of the time step in a title of CSMIP.
fn time_end(text: &str) -> usize {
    let keys = [" in ", "units=", "format="].map(|key| text.find(key));
    // A bracket may hold the unit of time.
    let bracket = text
        .match_indices('(')
        .map(|(at, _)| at)
        .find(|&at| text[at + 1..].starts_with(|sign: char| sign.is_ascii_digit() || sign == '*'));
    let first = keys.into_iter().chain([bracket]).flatten().min().unwrap_or(text.len());
    first.min(clause_end(text))
}

/// The unit in a title, from its first letter on.
fn unit_text(title: &str) -> Option<&str> {
    let csmip = || csmip(title)?.split_once(" in ");
    Some(title.split_once("units=").or_else(csmip)?.1)
}

/// End of the name of a unit: `cm/s^2 (4),Format=(8F10.5)`, `cm/sec2. (8f10.3)`.
fn name_end(text: &str) -> usize {
    text.find([',', '(']).unwrap_or(text.len())
}

/// The text after unit or, without one, time step.
fn after_unit(title: &str) -> &str {
    if let Some(text) = unit_text(title) {
        return &text[name_end(text)..];
    }
    match csmip(title) {
        Some(text) => &text[time_end(text)..],
        None => title.find("format=").map_or("", |at| &title[at..]),
    }
}

/// Unit of the numbers under a title in lower case; `unnamed` if it names none.
fn unit(title: &str, unnamed: Option<AccelerationUnit>) -> Option<AccelerationUnit> {
    let Some(text) = unit_text(title) else {
        // A unit among other words contradicts another one.
        let mut words = title.split([' ', '\t', ',', '(', ')']).filter_map(AccelerationUnit::named);
        return unnamed.filter(|&unit| words.all(|word| word == unit));
    };
    let (name, rest) = text.split_at(name_end(text));
    let unit = AccelerationUnit::named(name)?;
    // The code of cm/s² is 4.
    let code = rest
        .trim_start_matches([' ', ','])
        .strip_prefix('(')
        .and_then(|rest| rest.split_once(')')?.0.parse::<u8>().ok());
    let agrees = code.is_none_or(|code| (code == 4) == (unit == AccelerationUnit::Gal));
    agrees.then_some(unit)
}

// Records of K-NET and KiK-net.

/// The ASCII files of the Japanese networks K-NET and KiK-net.
///
/// Seventeen header lines with a key each, the last one `Memo.`, then counts of the recorder; the
/// acceleration is the count times the `Scale Factor`, such as `3920(gal)/6182761`. The number of
/// samples must be `Duration Time(s)` times `Sampling Freq(Hz)`. Counts have an offset: follow with
/// [`Record::with_baseline`], at least
/// [`Baseline::RemoveMean`](super::Baseline::RemoveMean).
///
/// ```
/// use basemat::motion::{KNetFormat, Record};
/// let text = "Origin Time       2011/03/11 14:46:00\nStation Code      MYG004\n\
///     Sampling Freq(Hz) 2Hz\nDuration Time(s)  3\nDir.              N-S\n\
///     Scale Factor      2000(gal)/1000\nMemo.\n 1 2 3 4\n 5 -6\n";
/// let record = Record::from_reader("MYG004.NS", text.as_bytes(), &KNetFormat)?;
/// assert_eq!((record.len(), record.time_step()), (6, 0.5));
/// assert!((record.accelerations()[5] + 0.12).abs() < 1e-15);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct KNetFormat;

impl RecordFormat for KNetFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        record(name, read_k_net(&mut Lines::new(source)))
    }
}

/// Entries that the header must have.
#[derive(Default)]
struct Header {
    frequency: Option<f64>,
    duration: Option<f64>,
    /// Gal in a count.
    scale: Option<f64>,
}

fn read_k_net(lines: &mut Lines) -> Reason<(f64, Vec<f64>)> {
    let mut header = Header::default();
    loop {
        let Some(line) = lines.next()? else {
            return Err(lines.refuse(RecordError::Missing { quantity: "line `Memo.`" }));
        };
        if line.starts_with("Memo") {
            break;
        }
        let understood = header.read(&line);
        understood.map_err(|reason| lines.refuse(reason))?;
    }
    let need = |value: Option<f64>, quantity| {
        value.ok_or_else(|| lines.refuse(RecordError::Missing { quantity }))
    };
    let frequency = need(header.frequency, "sampling frequency (`Sampling Freq(Hz)`)")?;
    let duration = need(header.duration, "duration (`Duration Time(s)`)")?;
    let scale = need(header.scale, "scale (`Scale Factor`, gal per count)")?;

    let mut values = Vec::new();
    while let Some(line) = lines.next()? {
        push_numbers(&line, &mut values).map_err(|reason| lines.refuse(reason))?;
    }
    let found = values.len();
    let needed = (duration * frequency).round();
    if needed != found as f64 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let needed = needed as usize;
        return Err(lines.refuse(RecordError::SampleCount { found, needed }));
    }
    if found < 2 {
        return Err(lines.refuse(RecordError::TooShort { found, needed: 2 }));
    }
    let factor = scale * AccelerationUnit::Gal.in_metres_per_second_squared();
    Ok((1.0 / frequency, scaled(values, factor)))
}

impl Header {
    /// Notes what a line of the header says, if it is one of those that are needed.
    fn read(&mut self, line: &str) -> std::result::Result<(), RecordError> {
        let positive = |quantity: HeaderNumber, unit| match line.split_once(unit) {
            Some((_, text)) => Ok(quantity.read(text)?.filter(|&value| value > 0.0)),
            None => Ok::<_, RecordError>(None),
        };
        let (known, value) = if line.starts_with("Sampling Freq") {
            (&mut self.frequency, positive(HeaderNumber::Frequency, "(Hz)")?)
        } else if line.starts_with("Duration Time") {
            (&mut self.duration, positive(HeaderNumber::Duration, "(s)")?)
        } else if let Some(factor) = line.strip_prefix("Scale Factor") {
            (&mut self.scale, scale(factor.trim())?)
        } else {
            return Ok(());
        };
        if known.is_some() && *known != value {
            return Err(unclear("repeated line", line));
        }
        *known = value;
        Ok(())
    }
}

/// Gal in a count: `3920(gal)/6182761`. None if the text is not of that kind, or no scale.
fn scale(text: &str) -> std::result::Result<Option<f64>, RecordError> {
    let Some((range, counts)) = text.split_once("(gal)/") else { return Ok(None) };
    let value = |side: &str| finite(side.trim()).ok_or_else(|| unclear("scale factor", text));
    let scale = value(range)? / value(counts)?;
    Ok((scale.is_finite() && scale != 0.0).then_some(scale))
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
