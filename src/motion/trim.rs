//! Parts of records.

use super::Record;
use crate::error::{Error, Result};

/// Steps by which a time may miss a sample and still be that of the sample, for rounding.
const SLACK: f64 = 1e-6;

impl Record {
    /// The part between two times (s), from the last sample not after `start` to the first one not
    /// before `end`; its first sample is at zero.
    ///
    /// Samples of acceleration stay as they are, to the last bit. Velocity and displacement that the record
    /// had at `start` are lost: the part begins at rest, as every record does, so that its velocity
    /// differs by a constant and its displacement by a ramp. Cut where the ground is nearly still, and
    /// treat the [`Baseline`](super::Baseline) afterwards.
    ///
    /// ```
    /// use basemat::motion::Record;
    /// let record = Record::new(0.5, vec![0.0, 1.0, 2.0, 3.0, 4.0])?;
    /// assert_eq!(record.trimmed(0.5, 1.5)?.accelerations(), [1.0, 2.0, 3.0]);
    /// // Times between samples: the samples around them stay.
    /// assert_eq!(record.trimmed(0.7, 1.2)?.accelerations(), [1.0, 2.0, 3.0]);
    /// assert!(record.trimmed(1.0, 2.5).is_err());
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`] unless 0 ≤ `start` < `end` and `end` is not after the last sample.
    pub fn trimmed(&self, start: f64, end: f64) -> Result<Self> {
        let (step, last) = (self.time_step(), self.len() - 1);
        if !(start >= 0.0 && start < self.duration()) {
            let needed = "from zero to before the last sample";
            return Err(Error::Input { quantity: "start of the part", value: start, needed });
        }
        if !(end > start && end / step <= last as f64 + SLACK) {
            let needed = "after its start, not after the last sample";
            return Err(Error::Input { quantity: "end of the part", value: end, needed });
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0..=last")]
        let (first, end) = {
            let first = ((start / step + SLACK).floor() as usize).min(last - 1);
            (first, ((end / step - SLACK).ceil().max(0.0) as usize).clamp(first + 1, last))
        };
        Self::new(step, self.accelerations()[first..=end].to_vec())
    }

    /// The part in which the Arias intensity grows from the fraction `from` to the fraction `to` of its
    /// final value, 0.05 and 0.95 as a rule: [`Record::trimmed`] at [`Record::significant_times`].
    ///
    /// ```
    /// let record = basemat::motion::el_centro_1940();
    /// let strong = record.trimmed_to_significant_duration(0.05, 0.95)?;
    /// // 1.67 s to 25.51 s, and the samples around, from 83 times 0.02 s on.
    /// assert!((strong.duration() - 23.86).abs() < 1e-9);
    /// assert_eq!(strong.accelerations()[0], record.accelerations()[83]);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`] as for both of them.
    pub fn trimmed_to_significant_duration(&self, from: f64, to: f64) -> Result<Self> {
        let [start, end] = self.significant_times(from, to)?;
        self.trimmed(start, end)
    }
}
