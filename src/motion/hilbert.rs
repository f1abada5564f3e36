//! Hilbert transform of records, and quiet time around them.

use realfft::num_complex::Complex;

use super::Record;
use super::filter::transformed;
use crate::error::{Error, Result, not_negative};

/// Most samples that a record may grow to.
const MOST_SAMPLES: f64 = 1e8;

impl Record {
    /// Record with zero acceleration for at least `before` and `after` (s) around it.
    ///
    /// # Errors
    /// [`Error::Input`] unless both are finite and not negative, and give at most 10⁸ samples.
    pub fn padded(&self, before: f64, after: f64) -> Result<Self> {
        let samples = |quantity, time: f64| -> Result<usize> {
            let count = (not_negative(quantity, time)? / self.time_step()).ceil();
            if count > MOST_SAMPLES {
                return Err(Error::Input { quantity, value: time, needed: "at most 1e8 samples" });
            }
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0..=1e8")]
            Ok(count as usize)
        };
        let mut padded = vec![0.0; samples("quiet time before the record", before)?];
        padded.extend_from_slice(self.accelerations());
        padded.resize(padded.len() + samples("quiet time after the record", after)?, 0.0);
        Self::new(self.time_step(), padded)
    }

    /// Every harmonic of the acceleration a quarter of a period later: cos becomes sin.
    ///
    /// By Fourier transform over four times the record's length, zero outside it; the part of the
    /// transform outside the record is lost, so give the record quiet time with
    /// [`Record::padded`].
    ///
    /// # Errors
    /// [`Error::Input`] if a value is not finite.
    pub fn hilbert_transform(&self) -> Result<Self> {
        let length = (4 * self.len()).next_power_of_two();
        let shifted = transformed(self.accelerations(), length, |k, last, value| {
            // Times −i; the mean and the highest harmonic have no quarter of a period.
            if k == 0 || k == last { Complex::default() } else { Complex::new(value.im, -value.re) }
        })?;
        Self::new(self.time_step(), shifted)
    }
}
