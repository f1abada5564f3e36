//! Records of the Japanese networks K-NET and KiK-net, as ASCII.
//!
//! Layout: National Research Institute for Earth Science and Disaster Resilience, *About K-NET ASCII format* and
//! *About KiK-net ASCII format* (kyoshin.bosai.go.jp, `man/knetform_en.html`).

use std::io::Read;

use super::column_title::check_acceleration;
use super::fault::{not_in_header, unclear};
use super::header_number::HeaderNumber;
use super::lines::{Lines, Reason, Series, push_numbers, record, records, scaled};
use super::{AccelerationUnit, Record, RecordFormat, agreement};
use crate::error::{FileFault, Result};
use crate::text::decimal::finite;

/// The ASCII files of the Japanese networks K-NET and KiK-net.
///
/// Seventeen header lines with a key each, the last one `Memo.`, then counts of the recorder. The acceleration is
/// the count times the `Scale Factor`, such as `3920(gal)/6182761`. The number of samples must be
/// `Duration Time(s)` times `Sampling Freq(Hz)`, and the peak `Max. Acc. (gal)`, up to the baseline.
/// [`KNetCsvFormat`](super::KNetCsvFormat) reads the files with commas. Counts have an offset: call
/// [`Record::with_baseline`] afterwards, at least with [`Baseline::RemoveMean`](super::Baseline::RemoveMean).
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
        record(name, read(&mut Lines::new(source)))
    }

    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        records(name, read(&mut Lines::new(source)).map(|series| vec![series]))
    }
}

/// Entries that the header must have.
#[derive(Default)]
struct Header {
    frequency: Option<f64>,
    duration: Option<f64>,
    /// Gal per count.
    scale: Option<f64>,
    /// Peak after the mean was removed, gal.
    peak: Option<f64>,
    /// `N-S`, `E-W` and `U-D`, or a channel of KiK-net from 1 to 6.
    direction: String,
}

fn read(lines: &mut Lines) -> Reason<Series> {
    let mut header = Header::default();
    loop {
        let Some(line) = lines.next()? else {
            return Err(lines.refuse(FileFault::missing("line `Memo.`")));
        };
        if line.to_ascii_lowercase().starts_with("memo") {
            break;
        }
        let understood = header.read(&line);
        understood.map_err(|reason| lines.refuse(reason))?;
    }
    let need =
        |value: Option<f64>, quantity| value.ok_or_else(|| lines.refuse(not_in_header(quantity)));
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
        return Err(lines.refuse(FileFault::count("samples", found, needed.to_string())));
    }
    if found < 2 {
        return Err(lines.refuse(FileFault::count("samples", found, "at least 2")));
    }
    let gal = AccelerationUnit::Gal.in_metres_per_second_squared();
    let samples = scaled(values, scale * gal);
    let peak = header.peak.unwrap_or(0.0) * gal;
    agreement::peak(&samples, peak).map_err(|reason| lines.refuse(reason))?;
    Ok(Series { name: header.direction, step: 1.0 / frequency, samples })
}

impl Header {
    /// Stores the value of a header line with a needed key.
    fn read(&mut self, line: &str) -> std::result::Result<(), FileFault> {
        let lower = line.to_ascii_lowercase();
        let positive = |quantity: HeaderNumber, unit: &str| match lower.find(unit) {
            Some(at) => {
                let value = quantity.read(&line[at + unit.len()..])?;
                Ok(value.filter(|&value| value > 0.0))
            }
            None => Ok::<_, FileFault>(None),
        };
        let (known, value) = if lower.starts_with("sampling freq") {
            (&mut self.frequency, positive(HeaderNumber::Frequency, "(hz)")?)
        } else if lower.starts_with("duration time") {
            (&mut self.duration, positive(HeaderNumber::Duration, "(s)")?)
        } else if lower.starts_with("scale factor") {
            (&mut self.scale, scale(line["scale factor".len()..].trim())?)
        } else if lower.starts_with("max") && lower.contains("acc") {
            check_acceleration(line, AccelerationUnit::Gal)?;
            (&mut self.peak, positive(HeaderNumber::Peak, "(gal)")?)
        } else if lower.starts_with("dir.") {
            line["dir.".len()..].trim().clone_into(&mut self.direction);
            return Ok(());
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

/// Gal per count: `3920(gal)/6182761`. `None` if the text has another form or is not a scale.
fn scale(text: &str) -> std::result::Result<Option<f64>, FileFault> {
    let Some(at) = text.to_ascii_lowercase().find("(gal)/") else { return Ok(None) };
    let (range, counts) = (&text[..at], &text[at + "(gal)/".len()..]);
    let value = |side: &str| finite(side.trim()).ok_or_else(|| unclear("scale factor", text));
    let scale = value(range)? / value(counts)?;
    Ok((scale.is_finite() && scale != 0.0).then_some(scale))
}
