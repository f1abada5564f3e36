//! Records of ground acceleration at equal time steps.

use super::Baseline;
use super::integral::{Integrals, Motion, integrate};
use crate::error::{MemoryError, Result, all_finite, at_least, finite, memory, positive, require};
use crate::text::column::{NumberCell, cell_line};
use crate::text::csv::Csv;

/// Bytes of a sample: the acceleration, its two integrals, and two temporary copies.
const BYTES_PER_SAMPLE: f64 = 40.0;

/// Returns an error for more samples, with their two integrals, than fit into memory.
pub(super) fn check_sample_memory(sample_count: f64) -> std::result::Result<(), MemoryError> {
    memory::check("samples of the record", sample_count, BYTES_PER_SAMPLE * sample_count)
}

/// Ground acceleration at equal time steps, with its velocity and displacement.
///
/// The acceleration is linear between samples, so the velocity is piecewise quadratic and the displacement piecewise
/// cubic. Both are integrated exactly from rest at t = 0; [`Record::at`] returns them at any time. Before t = 0 all
/// three are zero. After the last sample the acceleration is zero and the velocity keeps its last value. That value is
/// zero only if a [`Baseline`] made it so.
///
/// ```
/// use basemat::motion::Record;
/// // a = t for one second: v = t²/2, u = t³/6
/// let record = Record::new(0.5, vec![0.0, 0.5, 1.0])?;
/// assert!((record.at(0.8).velocity - 0.32).abs() < 1e-15);
/// assert!((record.at(0.9).displacement - 0.1215).abs() < 1e-15);
/// assert_eq!(record.at(2.0).velocity, 0.5);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "RecordForm"))]
pub struct Record {
    #[cfg_attr(feature = "serde", serde(rename = "time_step"))]
    step: f64,
    acceleration: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(skip))]
    velocity: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(skip))]
    displacement: Vec<f64>,
}

validated! {
    Record as RecordForm { time_step: f64, acceleration: Vec<f64> }
    => Record::new(time_step, acceleration)
}

impl Record {
    /// Record from its time step (s) and at least two samples of acceleration (m/s²).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the time step is positive and all slopes, velocities and
    /// displacements are finite; [`Error::NotFinite`](crate::Error::NotFinite) for a sample that is not finite;
    /// [`Error::Size`](crate::Error::Size) for fewer than two samples.
    pub fn new(time_step: f64, acceleration: Vec<f64>) -> Result<Self> {
        positive("time step of the record", time_step)?;
        at_least("samples of the record", acceleration.len(), 2)?;
        all_finite("acceleration of the record", &acceleration)?;
        let Integrals { velocity, displacement } = integrate(time_step, &acceleration);
        for pair in acceleration.windows(2) {
            let rate = (pair[1] - pair[0]) / time_step;
            finite("rate of change of the record's acceleration", rate)?;
        }
        for (&v, &u) in velocity.iter().zip(&displacement) {
            finite("velocity of the record", v)?;
            finite("displacement of the record", u)?;
        }
        Ok(Self { step: time_step, acceleration, velocity, displacement })
    }

    /// Record of `duration` (s) from a function of time.
    ///
    /// The acceleration (m/s²) is sampled every `time_step` (s) from 0 on.
    ///
    /// ```
    /// use basemat::motion::Record;
    /// // One cycle of sine, 2 m/s² and half a second.
    /// let pulse = Record::from_fn(0.005, 0.5, |t| 2.0 * (std::f64::consts::TAU * t / 0.5).sin())?;
    /// assert_eq!(pulse.accelerations().len(), 101);
    /// assert!((pulse.peaks().acceleration - 2.0).abs() < 1e-12);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`Record::new`]; [`Error::Input`](crate::Error::Input) for a duration that is not positive,
    /// [`Error::Memory`](crate::Error::Memory) for more samples than fit into memory.
    pub fn from_fn(
        time_step: f64,
        duration: f64,
        acceleration: impl Fn(f64) -> f64,
    ) -> Result<Self> {
        positive("time step of the record", time_step)?;
        positive("duration of the record", duration)?;
        let step_ratio = (duration / time_step).round();
        // Infinity is an error as well.
        check_sample_memory(step_ratio)?;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let step_count = step_ratio as usize;
        Self::new(time_step, (0..=step_count).map(|k| acceleration(k as f64 * time_step)).collect())
    }

    /// Time step, s.
    pub fn time_step(&self) -> f64 {
        self.step
    }

    /// Number of samples, at least two.
    #[expect(clippy::len_without_is_empty, reason = "a record is never empty")]
    pub fn len(&self) -> usize {
        self.acceleration.len()
    }

    /// Time of the last sample, s; the first is at zero.
    pub fn duration(&self) -> f64 {
        (self.len() - 1) as f64 * self.step
    }

    /// Acceleration at the samples, m/s².
    pub fn accelerations(&self) -> &[f64] {
        &self.acceleration
    }

    /// Velocity at the samples, m/s.
    pub fn velocities(&self) -> &[f64] {
        &self.velocity
    }

    /// Displacement at the samples, m.
    pub fn displacements(&self) -> &[f64] {
        &self.displacement
    }

    /// Record with its samples every `time_step` (s).
    ///
    /// The acceleration is linear between the old samples. If the old step is a multiple of the new one, the
    /// record stays the same function of time; otherwise the old corners are cut. For the motion at other times
    /// use [`Record::at`], which is exact at any time. The last sample is the first one not before the end of the
    /// old record.
    ///
    /// ```
    /// let record = basemat::motion::el_centro_1940();
    /// let fine = record.resampled(0.005)?;
    /// assert_eq!(fine.len(), 4 * 1559 + 1);
    /// assert!((fine.displacements()[6236] - record.displacements()[1559]).abs() < 1e-12);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the step is positive, [`Error::Memory`](crate::Error::Memory) for
    /// more samples than fit into memory.
    pub fn resampled(&self, time_step: f64) -> Result<Self> {
        positive("new time step of the record", time_step)?;
        let duration = self.duration();
        // A step that divides the duration up to rounding adds no interval.
        let interval_ratio = (duration / time_step - INTERVAL_ROUNDING).ceil().max(1.0);
        check_sample_memory(interval_ratio)?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
        let interval_count = interval_ratio as usize;
        let mut samples = Vec::with_capacity(interval_count + 1);
        for k in 0..=interval_count {
            let time = k as f64 * time_step;
            let is_within = time - duration < END_ROUNDING * time_step;
            samples.push(self.at(if is_within { time.min(duration) } else { time }).acceleration);
        }
        Self::new(time_step, samples)
    }

    /// Record with all samples multiplied by `factor`, which may be negative.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) if the factor, or a velocity or displacement of the new record, is not
    /// finite; [`Error::NotFinite`](crate::Error::NotFinite) for a sample of the new record.
    pub fn scaled(&self, factor: f64) -> Result<Self> {
        finite("scale factor of the record", factor)?;
        Self::new(self.step, self.acceleration.iter().map(|a| a * factor).collect())
    }

    /// Record scaled to a peak ground acceleration (m/s²); the factor is positive.
    ///
    /// ```
    /// let record = basemat::motion::el_centro_1940().scaled_to_peak(5.0)?;
    /// assert!((record.peaks().acceleration - 5.0).abs() < 1e-15);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `peak` is positive and the record is not zero throughout.
    pub fn scaled_to_peak(&self, peak: f64) -> Result<Self> {
        positive("peak acceleration of the scaled record", peak)?;
        let original_peak = positive("peak acceleration of the record", self.peak_acceleration())?;
        self.scaled(peak / original_peak)
    }

    /// Record with its baseline treated.
    ///
    /// ```
    /// use basemat::motion::{Baseline, el_centro_1940};
    /// let record = el_centro_1940().with_baseline(Baseline::RestToRest { degree: 4 })?;
    /// let end = record.duration();
    /// assert!(record.at(end).velocity.abs() < 1e-12);
    /// assert!(record.at(end + 100.0).displacement.abs() < 1e-10);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a degree out of its range, or too high for the number of samples.
    pub fn with_baseline(&self, baseline: Baseline) -> Result<Self> {
        Self::new(self.step, baseline.apply(&self.acceleration)?)
    }

    /// Motion at any `time` (s).
    ///
    /// Between samples the acceleration is linear. After the last sample it is zero, the velocity constant and the
    /// displacement linear in time. Before t = 0 all are zero.
    pub fn at(&self, time: f64) -> Motion {
        let last_index = self.len() - 1;
        if time.is_nan() || time <= 0.0 {
            let acceleration = if time == 0.0 { self.acceleration[0] } else { 0.0 };
            return Motion { acceleration, velocity: 0.0, displacement: 0.0 };
        }
        let duration = self.duration();
        if time > duration {
            let end = Motion { acceleration: 0.0, ..self.sample(last_index) };
            return end.after(time - duration, 0.0);
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0..=last")]
        let index = ((time / self.step) as usize).min(last_index - 1);
        self.sample(index).after(time - index as f64 * self.step, self.jerk(index))
    }

    /// Motion at a sample.
    pub(super) fn sample(&self, index: usize) -> Motion {
        Motion {
            acceleration: self.acceleration[index],
            velocity: self.velocity[index],
            displacement: self.displacement[index],
        }
    }

    /// Rate of the acceleration (m/s³) in the interval after a sample.
    pub(super) fn jerk(&self, index: usize) -> f64 {
        (self.acceleration[index + 1] - self.acceleration[index]) / self.step
    }
}

/// Largest excess of the duration over whole intervals because of rounding, in intervals.
const INTERVAL_ROUNDING: f64 = 1e-9;
/// Largest time after the last sample because of rounding, in time steps.
///
/// It is larger than [`INTERVAL_ROUNDING`].
const END_ROUNDING: f64 = 1e-8;
/// Largest distance of a time from a sample, in steps, that counts as rounding.
const SAMPLE_TIME_TOLERANCE: f64 = 1e-6;

impl Record {
    /// The part between two times (s).
    ///
    /// It runs from the last sample not after `start` to the first sample not before `end`; its first sample is at
    /// zero. Samples of acceleration stay as they are, to the last bit. The part begins at rest, as every record
    /// does: its velocity differs from the record's by a constant and its displacement by a ramp. Cut where the
    /// ground is nearly still, and treat the [`Baseline`](super::Baseline) afterwards.
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
    /// [`Error::Input`](crate::Error::Input) unless 0 ≤ `start` < `end` and `end` is not after the last sample.
    pub fn trimmed(&self, start: f64, end: f64) -> Result<Self> {
        let time_step = self.time_step();
        let last_index = self.len() - 1;
        let needed = "from zero to before the last sample";
        require("start of the part", start, start >= 0.0 && start < self.duration(), needed)?;
        let is_inside = end > start && end / time_step <= last_index as f64 + SAMPLE_TIME_TOLERANCE;
        require("end of the part", end, is_inside, "after its start, not after the last sample")?;
        let first_position = (start / time_step + SAMPLE_TIME_TOLERANCE).floor();
        let end_position = (end / time_step - SAMPLE_TIME_TOLERANCE).ceil().max(0.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0..=last")]
        let first_index = (first_position as usize).min(last_index - 1);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0..=last")]
        let end_index = (end_position as usize).clamp(first_index + 1, last_index);
        Self::new(time_step, self.accelerations()[first_index..=end_index].to_vec())
    }
}

impl Record {
    /// Time and acceleration as CSV: a heading and a line for every sample.
    ///
    /// Numbers have all digits, so that [`ColumnFormat`](super::ColumnFormat) reads the same record to the last
    /// bit.
    ///
    /// ```
    /// use basemat::motion::{AccelerationUnit, ColumnFormat, Record};
    /// let record = Record::new(1.0 / 3.0, vec![0.0, 0.1, -2.5])?;
    /// let text = record.csv();
    /// assert!(text.starts_with("time_s,acceleration_m_per_s2\n0.0,0.0\n0.3333333333333333,0.1\n"));
    /// let format = ColumnFormat::new(AccelerationUnit::MetrePerSecondSquared);
    /// assert_eq!(Record::from_reader("text", text.as_bytes(), &format)?, record);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn csv(&self) -> Csv {
        let mut text = "time_s,acceleration_m_per_s2\n".to_owned();
        for (k, acceleration) in self.accelerations().iter().enumerate() {
            text += &cell_line([k as f64 * self.time_step(), *acceleration].map(NumberCell));
        }
        Csv(text)
    }
}
