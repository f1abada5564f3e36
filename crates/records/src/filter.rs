//! Filters and tapers.

use super::Record;
use crate::error::{Error, Result, not_negative, positive, require};
use basemat_fourier::RealPlanner;
use basemat_fourier::num_complex::Complex;

/// Highest order of a filter: filters of higher order ring for long.
const MAX_FILTER_ORDER: u32 = 8;
/// Quiet time on either side of a filtered record.
///
/// It is relative to the filter's order over its corner frequency.
const PAD_LENGTH_FACTOR: f64 = 1.5;

/// Largest excess of both tapers over the duration because of rounding, relative to the duration.
const TAPER_SUM_TOLERANCE: f64 = 1e-12;

impl Record {
    /// Removes motion below the `corner` frequency (Hz).
    ///
    /// A Butterworth filter of `order` (1 to 8) forwards and backwards: gain 1/(1 + (corner/f)^(2 order)), no
    /// phase.
    ///
    /// The record gets longer. A filter without phase extends the motion to earlier times, and needs quiet time of 1.5
    /// order/corner on either side (Converse & Brady, *BAP: basic strong-motion accelerogram processing software*, USGS
    /// Open-File Report 92-296A, 1992). Keep this quiet time: without it, velocity and displacement do not return to
    /// zero (Boore, "On pads and filters: processing strong-motion data", Bull. Seism. Soc. Am. 95 (2005), 745–750). If
    /// a record does not begin or end near zero, taper it with [`Record::tapered`] before.
    ///
    /// ```
    /// use basemat::motion::el_centro_1940;
    /// let record = el_centro_1940();
    /// let filtered = record.high_pass(0.1, 4)?;
    /// assert!((filtered.duration() - record.duration() - 2.0 * 60.0).abs() < 0.05);
    /// // The drift is removed: the ground returns to its place.
    /// assert!(filtered.at(filtered.duration()).displacement.abs() < 1e-5);
    /// assert!(record.at(record.duration()).displacement.abs() > 5e-3);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`] unless `corner` is above zero and below the highest frequency of the samples, and `order`
    /// is from 1 to 8; [`Error::Memory`] for more quiet time than fits into memory.
    pub fn high_pass(&self, corner: f64, order: u32) -> Result<Self> {
        // At zero the ratio is infinite, and the gain zero.
        self.filtered(corner, order, |frequency| corner / frequency)
    }

    /// Removes motion above the `corner` frequency (Hz).
    ///
    /// A Butterworth filter of `order` (1 to 8) forwards and backwards: gain 1/(1 + (f/corner)^(2 order)), no
    /// phase. Deconvolution through soft soil needs it, since it amplifies noise at high frequencies. The record
    /// gets longer by quiet time of 1.5 order/corner on either side, as by [`Record::high_pass`].
    ///
    /// ```
    /// use basemat::motion::el_centro_1940;
    /// let record = el_centro_1940();
    /// let [low, high] = [record.low_pass(10.0, 4)?, record.high_pass(10.0, 4)?];
    /// // The two gains add up to one.
    /// let padded_record = record.padded(0.6, 0.6)?;
    /// for (k, original) in padded_record.accelerations().iter().enumerate() {
    ///     assert!((low.accelerations()[k] + high.accelerations()[k] - original).abs() < 1e-13);
    /// }
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`Record::high_pass`].
    pub fn low_pass(&self, corner: f64, order: u32) -> Result<Self> {
        self.filtered(corner, order, |frequency| frequency / corner)
    }

    /// Record with quiet time, filtered by the gain 1/(1 + `frequency_ratio`^(2 order)) at each frequency.
    fn filtered(
        &self,
        corner: f64,
        order: u32,
        frequency_ratio: impl Fn(f64) -> f64,
    ) -> Result<Self> {
        positive("corner frequency", corner)?;
        let needed = "below half the sampling frequency";
        require("corner frequency", corner, corner < 0.5 / self.time_step(), needed)?;
        let quantity = "order of the filter";
        let needed = "from 1 to 8";
        require(quantity, f64::from(order), (1..=MAX_FILTER_ORDER).contains(&order), needed)?;
        let quiet_time = PAD_LENGTH_FACTOR * f64::from(order) / corner;
        let padded_record = self.padded(quiet_time, quiet_time)?;
        // The transform is circular: only the quiet pads wrap around.
        let transform_length = padded_record.len().next_power_of_two();
        let frequency_step = 1.0 / (transform_length as f64 * self.time_step());
        let exponent = f64::from(2 * order);
        let mut coefficients = spectrum(padded_record.accelerations(), transform_length)?;
        for (k, value) in coefficients.iter_mut().enumerate() {
            *value /= 1.0 + frequency_ratio(k as f64 * frequency_step).powf(exponent);
        }
        let mut filtered_samples = signal(coefficients, transform_length)?;
        filtered_samples.truncate(padded_record.len());
        Self::new(self.time_step(), filtered_samples)
    }

    /// Tapers the first `beginning` and the last `end` seconds.
    ///
    /// The acceleration rises from zero and falls to zero along half a period of a cosine.
    ///
    /// ```
    /// use basemat::motion::Record;
    /// let record = Record::new(0.1, vec![1.0; 11])?.tapered(0.4, 0.2)?;
    /// let a = record.accelerations();
    /// assert_eq!((a[0], a[5], a[10]), (0.0, 1.0, 0.0));
    /// assert!((a[2] - 0.5).abs() < 1e-15 && (a[9] - 0.5).abs() < 1e-15);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`] unless both are finite, not negative, and together at most the duration.
    pub fn tapered(&self, beginning: f64, end: f64) -> Result<Self> {
        not_negative("taper at the beginning", beginning)?;
        not_negative("taper at the end", end)?;
        let duration = self.duration();
        let quantity = "length of both tapers";
        let needed = "at most the duration";
        require(
            quantity,
            beginning + end,
            beginning + end <= duration * (1.0 + TAPER_SUM_TOLERANCE),
            needed,
        )?;
        let mut tapered_samples = Vec::with_capacity(self.len());
        for (k, value) in self.accelerations().iter().enumerate() {
            let time = k as f64 * self.time_step();
            let beginning_weight = cosine_rise(time, beginning);
            tapered_samples.push(value * beginning_weight * cosine_rise(duration - time, end));
        }
        Self::new(self.time_step(), tapered_samples)
    }
}

/// Weight that rises from 0 to 1 along half a period of a cosine.
///
/// The half period has this `length` (s).
fn cosine_rise(time: f64, length: f64) -> f64 {
    if time < length {
        0.5 - 0.5 * (std::f64::consts::PI * time.max(0.0) / length).cos()
    } else {
        1.0
    }
}

/// Fourier coefficients of samples, padded with zeros to `length`.
pub(super) fn spectrum(samples: &[f64], length: usize) -> Result<Vec<Complex<f64>>> {
    let transform = RealPlanner::new().plan_fft_forward(length);
    let mut signal = transform.make_input_vec();
    let mut spectrum = transform.make_output_vec();
    signal[..samples.len()].copy_from_slice(samples);
    transform.process(&mut signal, &mut spectrum).map_err(|_| failed_transform(length))?;
    Ok(spectrum)
}

/// The real signal of this length with these Fourier coefficients.
pub(super) fn signal(mut spectrum: Vec<Complex<f64>>, length: usize) -> Result<Vec<f64>> {
    let transform = RealPlanner::new().plan_fft_inverse(length);
    let mut signal = transform.make_output_vec();
    spectrum[0].im = 0.0;
    if let Some(last_coefficient) = spectrum.last_mut() {
        last_coefficient.im = 0.0;
    }
    transform.process(&mut spectrum, &mut signal).map_err(|_| failed_transform(length))?;
    let scale = 1.0 / length as f64;
    for value in &mut signal {
        *value *= scale;
    }
    Ok(signal)
}

/// Error of a length that the Fourier transform does not accept.
fn failed_transform(length: usize) -> Error {
    let quantity = "number of samples of a Fourier transform";
    Error::Input { quantity, value: length as f64, needed: "one that can be transformed" }
}
