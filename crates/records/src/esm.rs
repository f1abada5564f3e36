//! Records of the European (ESM) and the Italian (ITACA) strong-motion databases.
//!
//! Layout: header format DYNA 1.2 of the Engineering Strong-Motion Database (esm-db.eu; L. Luzi et al., *The
//! Engineering Strong-Motion Database*, Seismological Research Letters 87, 2016) and of ITACA (itaca.mi.ingv.it):
//! lines `KEY: value`, then one sample a line. Turkey's archive (AFAD) gives files in this layout, too.

use std::io::Read;

use super::fault::{FaultResult, not_acceleration};
use super::header_number::HeaderNumber;
use super::lines::{
    LineResult, Lines, Series, push_numbers, required, sample_count, scaled, to_record, to_records,
    wrong_count,
};
use super::{AccelerationUnit, Record, RecordFormat, agreement};
use crate::error::Result;

/// The ASCII files of ESM and ITACA (`.ASC`), one component a file.
///
/// A header of lines `KEY: value`, among them `SAMPLING_INTERVAL_S`, `NDATA` and `UNITS`, then the samples. An
/// error if samples, duration (`DURATION_S`) or peak (`PGA_CM/S^2`) differ from the header, and for velocity or
/// displacement (`DATA_TYPE`).
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

impl RecordFormat for EsmFormat {
    fn parse(&self, name: &str, source: &mut dyn Read) -> Result<Record> {
        to_record(name, read(&mut Lines::new(source)))
    }

    fn parse_all(&self, name: &str, source: &mut dyn Read) -> Result<Vec<(String, Record)>> {
        to_records(name, read(&mut Lines::new(source)).map(|series| vec![series]))
    }
}

/// Entries of the header that are used.
#[derive(Default)]
struct EsmHeader {
    /// Time step, s.
    interval: Option<f64>,
    /// Number of samples.
    points: Option<usize>,
    /// Duration, s.
    duration: Option<f64>,
    unit: Option<AccelerationUnit>,
    /// Peak acceleration, m/s²; zero if there is none.
    peak: f64,
    /// Name of the component.
    stream: String,
}

impl EsmHeader {
    /// Stores the value of a line `KEY: value`.
    fn read(&mut self, key: &str, value: &str) -> FaultResult<()> {
        let entry = format!("{key}: {value}");
        match key.to_ascii_uppercase().as_str() {
            "SAMPLING_INTERVAL_S" => self.interval = HeaderNumber::TimeStep.read(value)?,
            "NDATA" => self.points = HeaderNumber::Points.read(value)?.and_then(sample_count),
            "DURATION_S" => self.duration = HeaderNumber::Duration.read(value)?,
            "UNITS" => {
                let unit = AccelerationUnit::named(value);
                self.unit = Some(unit.ok_or_else(|| not_acceleration(&entry))?);
            }
            "DATA_TYPE" if !value.to_ascii_uppercase().contains("ACC") && !value.is_empty() => {
                return Err(not_acceleration(&entry));
            }
            "STREAM" => value.clone_into(&mut self.stream),
            other => {
                let unit = other.strip_prefix("PGA_").and_then(AccelerationUnit::named);
                if let Some(unit) = unit
                    && let Some(value) = HeaderNumber::Peak.read(value)?
                {
                    self.peak = value * unit.in_metres_per_second_squared();
                }
            }
        }
        Ok(())
    }

    /// Error unless the samples have the stated duration and peak.
    fn check(&self, samples: &[f64], step: f64) -> FaultResult<()> {
        if let Some(stated) = self.duration {
            agreement::duration(samples.len(), step, stated, 0.0)?;
        }
        agreement::peak(samples, self.peak)
    }
}

/// Reads the component.
fn read(lines: &mut Lines) -> LineResult<Series> {
    let mut header = EsmHeader::default();
    let mut values = Vec::new();
    while let Some(line) = lines.next()? {
        lines.with_line_number(match line.split_once(':') {
            Some((key, value)) if values.is_empty() => header.read(key.trim(), value.trim()),
            _ => push_numbers(&line, &mut values),
        })?;
    }
    let step = header.interval.filter(|&step| step > 0.0);
    let step = required(lines, step, "sampling interval (SAMPLING_INTERVAL_S)")?;
    let needed = required(lines, header.points, "number of samples (NDATA)")?;
    let unit = required(lines, header.unit, "unit (UNITS)")?;
    let found = values.len();
    if found != needed {
        return Err(lines.fault(wrong_count(found, needed)));
    }
    let samples = scaled(values, unit.in_metres_per_second_squared());
    lines.with_line_number(header.check(&samples, step))?;
    Ok(Series { name: header.stream, step, samples })
}
