//! Records of the European (ESM) and the Italian (ITACA) strong-motion databases.
//!
//! Layout: header format DYNA 1.2 of the Engineering Strong-Motion Database (esm-db.eu; L. Luzi et al., *The
//! Engineering Strong-Motion Database*, Seismological Research Letters 87, 2016) and of ITACA (itaca.mi.ingv.it):
//! lines `KEY: value`, then one sample per line. Turkey's archive (AFAD) gives files in this layout, too.

use super::fault::{FaultResult, not_acceleration};
use super::format::read_one_component;
use super::header_number::HeaderNumber;
use super::lines::{LineResult, Lines, push_numbers, required};
use super::series::{Series, check_sample_count, multiplied, whole_sample_count};
use super::{AccelerationUnit, agreement};

/// The ASCII files of ESM and ITACA (`.ASC`), one component a file.
///
/// The file has a header of lines `KEY: value`, among them `SAMPLING_INTERVAL_S`, `NDATA` and `UNITS`, then the
/// samples. Reading returns an error if samples, duration (`DURATION_S`) or peak (`PGA_CM/S^2`) differ from the header,
/// and for velocity or displacement (`DATA_TYPE`).
///
/// ```
/// use basemat::motion::{EsmFormat, Record};
/// let text = "EVENT_NAME: TEST\nSAMPLING_INTERVAL_S: 0.005000\nNDATA: 4\nDURATION_S: 0.020\n\
///     STREAM: HNE\nUNITS: cm/s^2\nPGA_CM/S^2: 2.0\nDATA_TYPE: ACCELERATION\nUSER5:\n\
///     0.0\n1.0\n-2.0\n0.5\n";
/// let record = Record::from_reader("HNE.ASC", text.as_bytes(), &EsmFormat)?;
/// assert_eq!((record.time_step(), record.accelerations()[2]), (0.005, -0.02));
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EsmFormat;

read_one_component!(EsmFormat);

/// Values of a header that describe its samples.
#[derive(Default)]
struct EsmHeader {
    /// Time step, s.
    time_step: Option<f64>,
    /// Number of samples.
    sample_count: Option<usize>,
    /// Duration, s.
    duration: Option<f64>,
    unit: Option<AccelerationUnit>,
    /// Peak acceleration, m/s²; zero if the header states none.
    peak: f64,
    /// Name of the component.
    stream: String,
}

impl EsmHeader {
    /// Stores the value of a line `KEY: value`.
    fn read(&mut self, key: &str, value: &str) -> FaultResult<()> {
        let entry = format!("{key}: {value}");
        match key.to_ascii_uppercase().as_str() {
            "SAMPLING_INTERVAL_S" => self.time_step = HeaderNumber::TimeStep.read(value)?,
            "NDATA" => {
                self.sample_count = HeaderNumber::Points.read(value)?.and_then(whole_sample_count);
            }
            "DURATION_S" => self.duration = HeaderNumber::Duration.read(value)?,
            "UNITS" => {
                let unit = AccelerationUnit::named(value);
                self.unit = Some(unit.ok_or_else(|| not_acceleration(&entry))?);
            }
            "DATA_TYPE" if !value.to_ascii_uppercase().contains("ACC") && !value.is_empty() => {
                return Err(not_acceleration(&entry));
            }
            "STREAM" => value.clone_into(&mut self.stream),
            key => {
                let unit = key.strip_prefix("PGA_").and_then(AccelerationUnit::named);
                if let Some(unit) = unit
                    && let Some(value) = HeaderNumber::Peak.read(value)?
                {
                    self.peak = value * unit.in_metres_per_second_squared();
                }
            }
        }
        Ok(())
    }

    /// Returns an error unless the samples have the stated duration and peak.
    fn check(&self, samples: &[f64], time_step: f64) -> FaultResult<()> {
        if let Some(stated_duration) = self.duration {
            agreement::check_duration(samples.len(), time_step, stated_duration, 0.0)?;
        }
        agreement::check_peak(samples, self.peak)
    }
}

/// Reads the component of a file.
fn read(lines: &mut Lines) -> LineResult<Series> {
    let mut header = EsmHeader::default();
    let mut values = Vec::new();
    while let Some(line) = lines.next()? {
        lines.with_line_number(match line.split_once(':') {
            Some((key, value)) if values.is_empty() => header.read(key.trim(), value.trim()),
            _ => push_numbers(&line, &mut values),
        })?;
    }
    let time_step = header.time_step.filter(|&time_step| time_step > 0.0);
    let time_step = required(lines, time_step, "sampling interval (SAMPLING_INTERVAL_S)")?;
    let expected_count = required(lines, header.sample_count, "number of samples (NDATA)")?;
    let unit = required(lines, header.unit, "unit (UNITS)")?;
    check_sample_count(lines, values.len(), expected_count)?;
    let samples = multiplied(values, unit.in_metres_per_second_squared());
    lines.with_line_number(header.check(&samples, time_step))?;
    Ok(Series { name: header.stream, time_step, samples })
}
