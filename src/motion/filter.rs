//! Filters, tapers and the Hilbert transform.

use std::f64::consts::PI;

use super::Record;
use super::record::check_samples;
use crate::error::{Error, Result, not_negative, positive, require};
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

/// Highest order of a filter.
const HIGHEST_ORDER: u32 = 8;
/// Quiet time on either side of a filtered record, in units of the order divided by the corner frequency.
const PADS: f64 = 1.5;

impl Record {
    /// Removes motion slower than the `corner` frequency (Hz).
    ///
    /// A Butterworth filter of `order` (1 to 8) forwards and backwards: gain 1/(1 + (corner/f)^(2 order)), no
    /// phase.
    ///
    /// The record gets longer. A filter without phase extends the motion to earlier times, and needs quiet time of
    /// 1.5 order/corner on either side (Converse & Brady, *BAP: basic strong-motion accelerogram processing
    /// software*, USGS Open-File Report 92-296A, 1992). Keep it: without it, velocity and displacement do not
    /// return to zero (Boore, "On pads and filters: processing strong-motion data", Bull. Seism. Soc. Am. 95
    /// (2005), 745–750). If a record does not begin or end near zero, taper it with [`Record::tapered`] before.
    ///
    /// ```
    /// use basemat::motion::el_centro_1940;
    /// let record = el_centro_1940();
    /// let filtered = record.high_pass(0.1, 4)?;
    /// assert!((filtered.duration() - record.duration() - 2.0 * 60.0).abs() < 0.05);
    /// // Nothing is left of the drift: the ground comes back to where it was.
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

    /// Removes motion faster than the `corner` frequency (Hz).
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
    /// let whole = record.padded(0.6, 0.6)?;
    /// for (k, given) in whole.accelerations().iter().enumerate() {
    ///     assert!((low.accelerations()[k] + high.accelerations()[k] - given).abs() < 1e-13);
    /// }
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`Record::high_pass`].
    pub fn low_pass(&self, corner: f64, order: u32) -> Result<Self> {
        self.filtered(corner, order, |frequency| frequency / corner)
    }

    /// Record with quiet time, filtered by the gain 1/(1 + `ratio`^(2 order)) at each frequency.
    fn filtered(&self, corner: f64, order: u32, ratio: impl Fn(f64) -> f64) -> Result<Self> {
        positive("corner frequency", corner)?;
        let needed = "below half the sampling frequency";
        require("corner frequency", corner, corner < 0.5 / self.time_step(), needed)?;
        let quantity = "order of the filter";
        let needed = "from 1 to 8";
        require(quantity, f64::from(order), (1..=HIGHEST_ORDER).contains(&order), needed)?;
        let quiet = PADS * f64::from(order) / corner;
        let padded = self.padded(quiet, quiet)?;
        // The transform is circular: only the quiet pads wrap around.
        let length = padded.len().next_power_of_two();
        let step = 1.0 / (length as f64 * self.time_step());
        let exponent = f64::from(2 * order);
        let mut coefficients = spectrum(padded.accelerations(), length)?;
        for (k, value) in coefficients.iter_mut().enumerate() {
            *value /= 1.0 + ratio(k as f64 * step).powf(exponent);
        }
        let mut filtered = signal(coefficients, length)?;
        filtered.truncate(padded.len());
        Self::new(self.time_step(), filtered)
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
        require(quantity, beginning + end, beginning + end <= duration * (1.0 + 1e-12), needed)?;
        let rise = |time: f64, length: f64| {
            if time < length {
                0.5 - 0.5 * (std::f64::consts::PI * time.max(0.0) / length).cos()
            } else {
                1.0
            }
        };
        let taper = |(k, value): (usize, &f64)| {
            let time = k as f64 * self.time_step();
            value * rise(time, beginning) * rise(duration - time, end)
        };
        Self::new(self.time_step(), self.accelerations().iter().enumerate().map(taper).collect())
    }
}

/// Fourier coefficients of samples with zeros up to `length`.
fn spectrum(samples: &[f64], length: usize) -> Result<Vec<Complex<f64>>> {
    let forward = RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let (mut signal, mut spectrum) = (forward.make_input_vec(), forward.make_output_vec());
    signal[..samples.len()].copy_from_slice(samples);
    forward.process(&mut signal, &mut spectrum).map_err(|_| untransformed(length))?;
    Ok(spectrum)
}

/// The real signal of this length with these coefficients.
fn signal(mut spectrum: Vec<Complex<f64>>, length: usize) -> Result<Vec<f64>> {
    let inverse = RealFftPlanner::<f64>::new().plan_fft_inverse(length);
    let mut signal = inverse.make_output_vec();
    spectrum[0].im = 0.0;
    if let Some(last) = spectrum.last_mut() {
        last.im = 0.0;
    }
    inverse.process(&mut spectrum, &mut signal).map_err(|_| untransformed(length))?;
    let scale = 1.0 / length as f64;
    for value in &mut signal {
        *value *= scale;
    }
    Ok(signal)
}

fn untransformed(length: usize) -> Error {
    let quantity = "number of samples of a Fourier transform";
    Error::Input { quantity, value: length as f64, needed: "one that can be transformed" }
}

// Hilbert transform of samples, over all time: neither periodic nor cut.
//
// (H f)(t) = 1/π ⨍ f(τ)/(t − τ) dτ takes cos to sin. For samples f_j with the step h, zero outside,
// it is at the samples
//
// (H f)_k = Σ_j f_j (1 − cos π(k−j))/(π(k−j)),
//
// exact if f is the band-limited function through them (Kak, "The discrete Hilbert transform", Proc. IEEE 58
// (1970), 585–586). A linear convolution, computed by Fourier transforms long enough that nothing wraps around.

impl Record {
    /// Record with zero acceleration for at least `before` and `after` (s) around it.
    ///
    /// # Errors
    /// [`Error::Input`] unless both are finite and not negative, [`Error::Memory`] for more samples than fit into
    /// memory.
    pub fn padded(&self, before: f64, after: f64) -> Result<Self> {
        let samples = |quantity, time: f64| -> Result<usize> {
            let count = (not_negative(quantity, time)? / self.time_step()).ceil();
            check_samples(count + self.len() as f64)?;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
            Ok(count as usize)
        };
        let before = samples("quiet time before the record", before)?;
        let after = samples("quiet time after the record", after)?;
        check_samples((before + self.len() + after) as f64)?;
        let mut padded = vec![0.0; before];
        padded.extend_from_slice(self.accelerations());
        padded.resize(padded.len() + after, 0.0);
        Self::new(self.time_step(), padded)
    }

    /// Shifts every harmonic of the acceleration by a quarter of a period: cos becomes sin.
    ///
    /// Exact for the band-limited function through the samples, zero outside them. The transform begins before the
    /// record and ends after it. The part outside the record is lost, so add quiet time with [`Record::padded`].
    /// As every record it is integrated from rest, so its displacement lacks the earlier motion:
    /// [`PlaneWave::field_from_horizontal`] computes displacements.
    ///
    /// [`PlaneWave::field_from_horizontal`]: super::PlaneWave::field_from_horizontal
    ///
    /// # Errors
    /// [`Error::Input`] if a value is not finite.
    pub fn hilbert_transform(&self) -> Result<Self> {
        Self::new(self.time_step(), hilbert(self.accelerations(), 0)?)
    }
}

/// The transform at the samples, and at `around` more times before and after.
pub(super) fn hilbert(samples: &[f64], around: usize) -> Result<Vec<f64>> {
    let count = samples.len() + 2 * around;
    // The kernel is indexed by the distance of output and input, starting at the smallest.
    let least = around + samples.len() - 1;
    let distances = count + samples.len() - 1;
    let length = distances.next_power_of_two();
    let weight = |index: usize| {
        let is_odd = index.abs_diff(least) % 2 == 1;
        if is_odd { 2.0 / (PI * (index as f64 - least as f64)) } else { 0.0 }
    };
    let kernel = spectrum(&(0..distances).map(weight).collect::<Vec<_>>(), length)?;
    let mut product = spectrum(samples, length)?;
    for (value, factor) in product.iter_mut().zip(&kernel) {
        *value *= factor;
    }
    let signal = signal(product, length)?;
    // The first outputs contain the part that wraps around.
    Ok(signal[samples.len() - 1..][..count].to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// H[1/(1+t²)] = t/(1+t²), and its tails outside the samples.
    #[test]
    fn lorentzian_has_its_closed_form() {
        let (half, step) = (16_000, 0.125);
        let times: Vec<f64> = (-half..=half).map(|k| f64::from(k) * step).collect();
        let samples: Vec<f64> = times.iter().map(|t| 1.0 / (1.0 + t * t)).collect();
        let found = hilbert(&samples, 0).unwrap();
        for (t, found) in times.iter().zip(&found).filter(|(t, _)| t.abs() < 200.0) {
            // The tails beyond T = 2000 s that the samples lack: 2t/(3πT³) at most.
            // The part above the highest frequency of the samples: exp(−π/step).
            let slack = 2.0 * (-PI / step).exp() + 2.1 * t.abs() / (3.0 * PI * 2000.0_f64.powi(3));
            assert!((found - t / (1.0 + t * t)).abs() < slack, "{t}: {found}");
        }
    }

    /// Against the sum itself, at the samples and around them.
    #[test]
    fn convolution_is_the_sum() {
        let samples: Vec<f64> = (0..37).map(|k| f64::from(k * k % 17) - 7.0).collect();
        for around in [0, 1, 50] {
            let found = hilbert(&samples, around).unwrap();
            assert_eq!(found.len(), 37 + 2 * around);
            for (k, found) in found.iter().enumerate() {
                let terms = samples.iter().enumerate().map(|(j, f)| {
                    let distance = k as f64 - around as f64 - j as f64;
                    if distance == 0.0 {
                        0.0
                    } else {
                        f * (1.0 - (PI * distance).cos()) / (PI * distance)
                    }
                });
                assert!((found - terms.sum::<f64>()).abs() < 1e-12, "{around} {k}");
            }
        }
    }
}
