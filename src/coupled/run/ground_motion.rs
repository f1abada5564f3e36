//! Peak and records of the ground motion in a run, for the printed report.

use std::fmt;

use crate::motion::{FreeField, Record, STANDARD_GRAVITY};
use crate::text::readable_number::number;

/// Ground motion of a run: its peak, and the sampling of its records.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[non_exhaustive]
pub struct GroundMotion {
    /// Largest component of the acceleration, m/s².
    ///
    /// It is the peak of the records at their samples; without records, of the free field under the base at the run's steps.
    pub peak: f64,
    /// Time of the last sample of the longest record, s; `None` without records.
    pub duration: Option<f64>,
    /// Longest time step of the records, s; `None` without records.
    pub time_step: Option<f64>,
    /// Fraction of the strongest record's Arias intensity up to the end of the run.
    ///
    /// `None` without records and for records of zeros.
    pub passed: Option<f64>,
}

impl GroundMotion {
    /// The motion of a run that ended at `end`, s.
    ///
    /// `max_acceleration_at_steps`: largest acceleration at the steps of the run, m/s².
    pub(crate) fn new(motion: &dyn FreeField, end: f64, max_acceleration_at_steps: f64) -> Self {
        let records = motion.records();
        let strongest = records.iter().max_by(|a, b| squared_sum(a).total_cmp(&squared_sum(b)));
        Self {
            peak: records
                .iter()
                .map(|record| peak_acceleration(record))
                .reduce(f64::max)
                .unwrap_or(max_acceleration_at_steps),
            duration: records.iter().map(|record| record.duration()).reduce(f64::max),
            time_step: records.iter().map(|record| record.time_step()).reduce(f64::max),
            passed: strongest.and_then(|record| passed_intensity(record, end)),
        }
    }
}

/// Largest acceleration of a record, m/s².
fn peak_acceleration(record: &Record) -> f64 {
    record.accelerations().iter().fold(0.0, |peak: f64, a| peak.max(a.abs()))
}

/// Sum of the squared accelerations of a record, which is proportional to its Arias intensity.
fn squared_sum(record: &Record) -> f64 {
    record.accelerations().iter().map(|a| a * a).sum()
}

/// Fraction of a record's Arias intensity until the time `end`, s.
///
/// `None` for a record of zeros.
fn passed_intensity(record: &Record, end: f64) -> Option<f64> {
    let samples = record.accelerations().iter().enumerate();
    let passed_samples = samples.filter(|(k, _)| *k as f64 * record.time_step() <= end);
    let passed_sum: f64 = passed_samples.map(|(_, a)| a * a).sum();
    Some(passed_sum / squared_sum(record)).filter(|passed| passed.is_finite())
}

/// Writes one line: peak in m/s² and in g, duration and time step of its records.
impl fmt::Display for GroundMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.peak == 0.0 {
            return write!(f, "Ground motion: none");
        }
        let peak = number(self.peak);
        let peak_in_g = number(self.peak / STANDARD_GRAVITY);
        write!(f, "Ground motion: peak {peak} m/s² ({peak_in_g} g)")?;
        match (self.duration, self.time_step) {
            (Some(duration), Some(time_step)) => {
                let duration = seconds(duration);
                let time_step = seconds(time_step);
                write!(f, ", record of {duration} s in steps of {time_step} s")
            }
            _ => write!(f, " at the steps of the run, no record"),
        }
    }
}

/// Time below which six decimals would not be enough, s.
const MIN_DECIMAL_TIME: f64 = 1e-4;

/// Text of a time in s, without trailing zeros.
pub(crate) fn seconds(time: f64) -> String {
    if time < MIN_DECIMAL_TIME {
        return number(time);
    }
    format!("{time:.6}").trim_end_matches('0').trim_end_matches('.').to_owned()
}
