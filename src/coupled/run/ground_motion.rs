//! The ground motion of a run, for its page.

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
    /// Of the records at their samples; without records, of the free field under the base at the run's steps.
    pub peak: f64,
    /// Time of the last sample of the longest record, s; `None` without records.
    pub duration: Option<f64>,
    /// Longest time step of the records, s; `None` without records.
    pub time_step: Option<f64>,
    /// Fraction of the strongest record's Arias intensity that had passed at the end of the run.
    ///
    /// `None` without records and for records of zeros.
    pub passed: Option<f64>,
}

impl GroundMotion {
    /// The motion of a run that ended at `end` (s); `seen`: largest acceleration at its steps (m/s²).
    pub(crate) fn new(motion: &dyn FreeField, end: f64, seen: f64) -> Self {
        let records = motion.records();
        let largest = |of: fn(&Record) -> f64| records.iter().map(|own| of(own)).reduce(f64::max);
        let intensity = |own: &Record| own.accelerations().iter().map(|a| a * a).sum::<f64>();
        let strongest = records.iter().max_by(|a, b| intensity(a).total_cmp(&intensity(b)));
        let passed = strongest.and_then(|own| {
            let samples = own.accelerations().iter().enumerate();
            let before = samples.filter(|(k, _)| *k as f64 * own.time_step() <= end);
            let before: f64 = before.map(|(_, a)| a * a).sum();
            Some(before / intensity(own)).filter(|passed| passed.is_finite())
        });
        Self {
            peak: largest(|own| own.accelerations().iter().fold(0.0, |m: f64, a| m.max(a.abs())))
                .unwrap_or(seen),
            duration: largest(Record::duration),
            time_step: largest(Record::time_step),
            passed,
        }
    }
}

/// Writes one line: peak in m/s² and in g, duration and time step of its records.
impl fmt::Display for GroundMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.peak == 0.0 {
            return write!(f, "Ground motion: none");
        }
        let (peak, of_gravity) = (number(self.peak), number(self.peak / STANDARD_GRAVITY));
        write!(f, "Ground motion: peak {peak} m/s² ({of_gravity} g)")?;
        match (self.duration, self.time_step) {
            (Some(duration), Some(time_step)) => {
                let [duration, time_step] = [duration, time_step].map(seconds);
                write!(f, ", record of {duration} s in steps of {time_step} s")
            }
            _ => write!(f, " at the steps of the run, no record"),
        }
    }
}

/// A time in s without trailing zeros.
pub(crate) fn seconds(time: f64) -> String {
    if time < 1e-4 {
        return number(time);
    }
    format!("{time:.6}").trim_end_matches('0').trim_end_matches('.').to_owned()
}
