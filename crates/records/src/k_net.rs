//! Records of the Japanese networks K-NET and KiK-net, as ASCII.
//!
//! Layout: National Research Institute for Earth Science and Disaster Resilience, *About K-NET ASCII format* and
//! *About KiK-net ASCII format* (kyoshin.bosai.go.jp, `man/knetform_en.html`).

use super::column_title::check_acceleration;
use super::fault::{FaultResult, unclear};
use super::format::read_one_component;
use super::header_number::HeaderNumber;
use super::lines::{LineResult, Lines, push_numbers, required};
use super::series::{Series, check_sample_count, multiplied};
use super::{AccelerationUnit, agreement};
use crate::error::FileFault;
use crate::text::decimal::finite;

/// The ASCII files of the Japanese networks K-NET and KiK-net.
///
/// The file has seventeen header lines with a key each, the last one `Memo.`, then counts of the recorder. The
/// acceleration is the count times the `Scale Factor`, such as `3920(gal)/6182761`. The number of samples must be
/// `Duration Time(s)` times `Sampling Freq(Hz)`, and the peak must be `Max. Acc. (gal)`, up to a change of the
/// baseline. [`KNetCsvFormat`](super::KNetCsvFormat) reads the files with commas. Counts have an offset: call
/// [`Record::with_baseline`](super::Record::with_baseline) afterwards, at least with
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

read_one_component!(KNetFormat);

/// Values of a header that describe its samples.
#[derive(Default)]
struct KNetHeader {
    /// Sampling frequency, Hz.
    sampling_frequency: Option<f64>,
    /// Duration, s.
    duration: Option<f64>,
    /// Acceleration of one count of the recorder, gal.
    gal_per_count: Option<f64>,
    /// Peak of the record without its mean, gal.
    peak_in_gal: Option<f64>,
    /// `N-S`, `E-W` and `U-D`, or a channel of KiK-net from 1 to 6.
    direction: String,
}

/// Reads the component of a file.
fn read(lines: &mut Lines) -> LineResult<Series> {
    let mut header = KNetHeader::default();
    loop {
        let Some(line) = lines.next()? else {
            return Err(lines.fault(FileFault::missing("line `Memo.`")));
        };
        if line.to_ascii_lowercase().starts_with("memo") {
            break;
        }
        lines.with_line_number(header.read(&line))?;
    }
    let frequency =
        required(lines, header.sampling_frequency, "sampling frequency (`Sampling Freq(Hz)`)")?;
    let duration = required(lines, header.duration, "duration (`Duration Time(s)`)")?;
    let gal_per_count =
        required(lines, header.gal_per_count, "scale (`Scale Factor`, gal per count)")?;

    let mut counts = Vec::new();
    while let Some(line) = lines.next()? {
        lines.with_line_number(push_numbers(&line, &mut counts))?;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let expected_count = (duration * frequency).round() as usize;
    check_sample_count(lines, counts.len(), expected_count)?;
    if counts.len() < 2 {
        return Err(lines.fault(FileFault::count("samples", counts.len(), "at least 2")));
    }
    let gal = AccelerationUnit::Gal.in_metres_per_second_squared();
    let samples = multiplied(counts, gal_per_count * gal);
    let peak = header.peak_in_gal.unwrap_or(0.0) * gal;
    lines.with_line_number(agreement::check_peak(&samples, peak))?;
    Ok(Series { name: header.direction, time_step: 1.0 / frequency, samples })
}

impl KNetHeader {
    /// Stores the value of a header line whose key is used.
    fn read(&mut self, line: &str) -> FaultResult<()> {
        let lower_case_line = line.to_ascii_lowercase();
        if lower_case_line.starts_with("sampling freq") {
            let frequency = positive_after("(hz)", line, HeaderNumber::Frequency)?;
            store(&mut self.sampling_frequency, frequency, line)
        } else if lower_case_line.starts_with("duration time") {
            let duration = positive_after("(s)", line, HeaderNumber::Duration)?;
            store(&mut self.duration, duration, line)
        } else if lower_case_line.starts_with("scale factor") {
            let scale = gal_per_count(line["scale factor".len()..].trim())?;
            store(&mut self.gal_per_count, scale, line)
        } else if lower_case_line.starts_with("max") && lower_case_line.contains("acc") {
            check_acceleration(line, AccelerationUnit::Gal)?;
            let peak = positive_after("(gal)", line, HeaderNumber::Peak)?;
            store(&mut self.peak_in_gal, peak, line)
        } else if lower_case_line.starts_with("dir.") {
            line["dir.".len()..].trim().clone_into(&mut self.direction);
            Ok(())
        } else {
            Ok(())
        }
    }
}

/// The positive number that follows a `unit` of a line, if any.
///
/// `unit`: in lower case.
fn positive_after(unit: &str, line: &str, quantity: HeaderNumber) -> FaultResult<Option<f64>> {
    let Some(position) = line.to_ascii_lowercase().find(unit) else {
        return Ok(None);
    };
    let value = quantity.read(&line[position + unit.len()..])?;
    Ok(value.filter(|&value| value > 0.0))
}

/// Stores a value of the header.
///
/// Returns an error if a previous line had another value.
fn store(entry: &mut Option<f64>, value: Option<f64>, line: &str) -> FaultResult<()> {
    if entry.is_some() && *entry != value {
        return Err(unclear("repeated line", line));
    }
    *entry = value;
    Ok(())
}

/// Gal per count of `3920(gal)/6182761`; `None` for another form or no scale.
fn gal_per_count(text: &str) -> FaultResult<Option<f64>> {
    let Some(position) = text.to_ascii_lowercase().find("(gal)/") else {
        return Ok(None);
    };
    let gal = finite(text[..position].trim());
    let gal = gal.ok_or_else(|| unclear("scale factor", text))?;
    let counts = finite(text[position + "(gal)/".len()..].trim());
    let counts = counts.ok_or_else(|| unclear("scale factor", text))?;
    let gal_per_count = gal / counts;
    Ok((gal_per_count.is_finite() && gal_per_count != 0.0).then_some(gal_per_count))
}
