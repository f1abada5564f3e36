//! Records of CESMD: the COSMOS format, and a reader for COSMOS and CSMIP files.
//!
//! Layout: *COSMOS Strong Motion Data Format, Version 1.20*, Consortium of Organizations for Strong-Motion Observation
//! Systems, 15 August 2001, table of the real header and table 2 (units). The 34th real value is the interval of the
//! recorder in seconds, the 62nd the interval of the data below in milliseconds, the 63rd their length in seconds.

use std::io::Read;

use super::block::{self, Block};
use super::fault::{no_acceleration, out_of_range, unclear, unprocessed};
use super::lines::{Lines, Reason, Series, component, read_numbers, record, records};
use super::{AccelerationUnit, Record, RecordFormat, agreement, csmip};
use crate::error::{FileFault, Result};
use crate::text::decimal::finite;

/// The `.V2` and `.V2c` files of the Center for Engineering Strong Motion Data.
///
/// The reader accepts two layouts; in both, a line describes the block of numbers under it:
///
/// * COSMOS 1.20: `12091 acceleration pts, approx 120 secs, units=cm/s^2 (4), Format=(8F10.5)`, with the sampling
///   interval of the data (ms) as 62nd of the 100 real header values; if it is unknown there (−999), the 34th is
///   used, the interval of the recorder (s);
/// * CSMIP (California Geological Survey):
///   `15200 points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.6)`, in the 1980s
///   `(UNITS: CM/SEC/SEC)`, and volume 1,
///   `13200 Accelerogram points at 200 pts/sec in units of g .  Format: (8f9.6)`.
///
/// Header and title state interval, number of points, duration, unit and peak more than once. An error if they
/// disagree, if the block has more numbers than announced, and for raw counts (`.V0`) and uncorrected data in
/// unequal steps.
///
/// Numbers are read in the columns of the format that the line names, in which they may touch. They are read
/// without columns where a line does not match the format or none is named. In its column, a number without a
/// decimal point has the decimals of the format, as in Fortran: `12345` under `8F10.3` is 12.345. A format that is
/// not one repeated item is an error. The unit is a whole word, such as `cm/s^2`, `cm/sec/sec`, `gal` or `g`;
/// anything else (counts, `mgal`) is an error, and so is a file that does not name its unit, unless
/// [`CosmosFormat::unit`] does.
/// that does not name its unit, unless [`CosmosFormat::unit`] does.
///
/// A file may hold several channels one after the other. Blocks of velocity and displacement are skipped:
/// [`channel`](Self::channel) counts acceleration blocks. [`Record::read_all`] returns all channels.
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
    /// Unit for files that do not name one; a unit in the file has priority.
    ///
    /// Titles of the 1970s and 1980s end with `EQUALLY SPACED AT .010 SEC.`, without a unit; their numbers are in
    /// cm/s².
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
        let channels = read(&mut Lines::new(source), self, Some(self.channel));
        record(name, component(1, channels))
    }

    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        records(name, read(&mut Lines::new(source), self, None))
    }
}

/// Only the channel `wanted`, or all channels.
fn read(lines: &mut Lines, format: &CosmosFormat, wanted: Option<usize>) -> Reason<Vec<Series>> {
    let (mut found, mut channels) = (0, Vec::new());
    let (mut header, mut notes) = (Header::default(), csmip::Notes::default());
    let (mut uncorrected, mut other) = (None, None);
    // The line after a block.
    let mut next = None;
    while let Some(line) = match next.take() {
        Some(line) => Some(line),
        None => lines.next()?,
    } {
        let lower = line.to_ascii_lowercase();
        // A comment.
        if line.starts_with('|') || header.read(lines, &line, &lower)? {
            continue;
        }
        let block = if csmip::is_title(&lower) {
            notes.block(&line, format.unit)
        } else if is_title(&lower, &["accel"]) {
            header.block(&line, format.unit)
        } else {
            notes.read(&lower);
            if other.is_none()
                && (is_title(&lower, &["vel", "disp"]) || csmip::is_other_title(&lower))
            {
                other = Some(lines.refuse(no_acceleration(line.trim())));
            }
            if lines.number == 1 && lower.contains("uncorrected accelerogram") {
                uncorrected = Some(line);
            }
            continue;
        };
        found += 1;
        if wanted.is_none_or(|wanted| wanted == found) {
            let block = block.map_err(|reason| lines.refuse(reason))?;
            let (samples, after) = block.read(lines)?;
            let name = header.name.take().unwrap_or_else(|| format!("channel {found}"));
            channels.push(Series { name, step: block.step, samples });
            next = after;
        }
        if wanted.is_some_and(|wanted| wanted == found) {
            return Ok(channels);
        }
        (header, notes) = (Header::default(), csmip::Notes::default());
    }
    if let Some(other) = other.filter(|_| found == 0) {
        return Err(other);
    }
    match (uncorrected, wanted) {
        (Some(line), _) if found == 0 => {
            Err((1, unprocessed(&line, "uncorrected data in unequal steps")))
        }
        (_, None) if found > 0 => Ok(channels),
        (_, wanted) => Err(lines.refuse(out_of_range("channel", found, wanted.unwrap_or(1)))),
    }
}

/// Whether a line in lower case is the title of a block of acceleration.
///
/// Examples: `7000  acceleration pts,`, `42000 raw accel.   pts,`.
fn is_title(line: &str, quantities: &[&str]) -> bool {
    let mut words = line.split([' ', '\t', ',']).filter(|word| !word.is_empty());
    let mut before = "";
    words.any(|word| {
        let key = quantities.iter().any(|begin| before.starts_with(begin))
            && matches!(word, "pts" | "points");
        before = word;
        key
    })
}

/// Indices from 0 in the real header values.
///
/// Interval of the recorder (s), interval of the data (ms), their duration (s) and their peak.
const RECORDER: usize = 33;
const INTERVAL: usize = 61;
const DURATION: usize = 62;
const PEAK: usize = 63;
/// Header value that means unknown.
const UNKNOWN: f64 = -999.0;

/// Statements of the header of a channel.
#[derive(Default)]
struct Header {
    /// Name of the channel.
    name: Option<String>,
    /// Code of the unit.
    code: Option<i64>,
    reals: Vec<f64>,
}

impl Header {
    /// Reads a line of the header, with the numbers under it; `false` for any other line.
    fn read(&mut self, lines: &mut Lines, line: &str, lower: &str) -> Reason<bool> {
        if lower.contains("real-header values follow") {
            self.reals = reals(lines, lower)?;
        } else if lower.contains("integer-header values follow") {
            let Some(line) = lines.next_columns()? else { return Ok(true) };
            // The first of ten values is the stage of processing, the third the unit.
            let third = line.split_whitespace().nth(2).and_then(|field| field.parse().ok());
            self.code = third.filter(|&code| code > 0);
        } else if let Some(name) = channel_name(line) {
            self.name = Some(name);
        } else {
            return Ok(false);
        }
        Ok(true)
    }

    /// A real header value; `None` if it is unknown.
    fn real(&self, index: usize) -> Option<f64> {
        self.reals.get(index).copied().filter(|&value| value != UNKNOWN)
    }

    /// The block under a title; `unnamed` is the unit if the title names none.
    fn block(
        &self,
        line: &str,
        unnamed: Option<AccelerationUnit>,
    ) -> std::result::Result<Block, FileFault> {
        let title = line.to_ascii_lowercase();
        let title = title.as_str();
        let points = block::points(title, "number of points")?;
        let (unit, rest) = if let Some((_, text)) = title.split_once("units") {
            block::unit(line, text.trim_start_matches([' ', '=', ':']))?
        } else {
            let format = title.find("format").map_or("", |at| &title[at..]);
            (block::unnamed(title, unnamed)?, format)
        };
        if let Some(code) = self.code.filter(|&code| block::of_code(code) != Some(unit)) {
            return Err(unclear("unit", &format!("{unit}, and the code {code} of another one")));
        }
        let columns = block::columns(title, rest)?;
        let positive = |index| self.real(index).filter(|&value| value > 0.0);
        let interval = positive(INTERVAL).map(|ms| ms / 1e3);
        let step = block::step(interval.or_else(|| positive(RECORDER)))?;
        if let Some(stated) = positive(DURATION) {
            agreement::duration(points, step, stated, 0.0)?;
        }
        // `approx  120 secs`, without its fraction.
        let approximate = title.split_once("approx").and_then(|(_, text)| {
            finite(text.trim_start_matches(['.', ' ', '=']).split_whitespace().next()?)
        });
        if let Some(stated) = approximate {
            agreement::duration(points, step, stated, 1.0)?;
        }
        Ok(Block { points, step, unit, columns, peak: self.real(PEAK) })
    }
}

/// The values under a title of real header values.
fn reals(lines: &mut Lines, title: &str) -> Reason<Vec<f64>> {
    let number = block::points(title, "number of header values");
    let number = number.map_err(|reason| lines.refuse(reason))?;
    let format = title.split_once("format").map_or("", |(_, format)| format);
    let format = format.trim_start_matches([' ', '=', ':']);
    let columns = block::columns(title, format).map_err(|reason| lines.refuse(reason))?;
    read_numbers(lines, number, columns)
}

/// `Chan 1: 90 Deg` of `Sta Chan   1: 90 Deg (Rcrdr Chan  1) Location:Ground`, `CHAN  1:  90 DEG` or `COMP S58W`.
fn channel_name(line: &str) -> Option<String> {
    let text = line.strip_prefix("Sta ").unwrap_or(line);
    let begin = text.get(..4)?.to_ascii_lowercase();
    let named = begin == "chan" && text.contains(':') || begin == "comp" && text.contains(' ');
    let text = text.split(['(', '=']).next()?;
    // Digits after `COMP S58W` belong to the punched card.
    let most = if begin == "comp" { 2 } else { usize::MAX };
    let words: Vec<&str> = text.split_whitespace().take(most).collect();
    named.then(|| words.join(" "))
}
