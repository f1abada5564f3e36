//! Hilbert transform of samples over all time, not of their periodic continuation.
//!
//! (H f)(t) = 1/π ⨍ f(τ)/(t − τ) dτ takes cos to sin. For samples f_j with the step h, zero outside,
//! it is at the samples
//!
//! (H f)_k = Σ_j f_j (1 − cos π(k−j))/(π(k−j)),
//!
//! exact if f is the band-limited function through them (Kak, "The discrete Hilbert transform", Proc. IEEE 58 (1970),
//! 585–586). The linear convolution is computed by Fourier transforms, which are so long that nothing wraps around.

use std::f64::consts::PI;

use super::Record;
use super::filter::{signal, spectrum};
use super::record::check_sample_memory;
use crate::error::{Result, not_negative};

impl Record {
    /// Record with zero acceleration for at least `leading_time` (s) before and `trailing_time` (s) after it.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless both are finite and not negative,
    /// [`Error::Memory`](crate::Error::Memory) for more samples than fit into memory.
    pub fn padded(&self, leading_time: f64, trailing_time: f64) -> Result<Self> {
        let leading_count =
            self.quiet_sample_count("quiet time before the record", leading_time)?;
        let trailing_count =
            self.quiet_sample_count("quiet time after the record", trailing_time)?;
        check_sample_memory((leading_count + self.len() + trailing_count) as f64)?;
        let mut padded_samples = vec![0.0; leading_count];
        padded_samples.extend_from_slice(self.accelerations());
        padded_samples.resize(padded_samples.len() + trailing_count, 0.0);
        Self::new(self.time_step(), padded_samples)
    }

    /// Number of samples of a quiet time (s).
    fn quiet_sample_count(&self, quantity: &'static str, time: f64) -> Result<usize> {
        let count = (not_negative(quantity, time)? / self.time_step()).ceil();
        check_sample_memory(count + self.len() as f64)?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
        Ok(count as usize)
    }

    /// Shifts every harmonic of the acceleration by a quarter of a period: cos becomes sin.
    ///
    /// Exact for the band-limited function through the samples, zero outside them. The transform begins before the
    /// record and ends after it. The part outside the record is lost, so add quiet time with [`Record::padded`].
    /// Like every record the result is integrated from rest, so its displacement lacks the earlier motion:
    /// `PlaneWave::field_from_horizontal` computes displacements.
    ///
    /// # Errors
    /// [`Error::NotFinite`](crate::Error::NotFinite) if a sample of the transform is not finite,
    /// [`Error::Input`](crate::Error::Input) for a velocity or displacement.
    pub fn hilbert_transform(&self) -> Result<Self> {
        Self::new(self.time_step(), hilbert(self.accelerations(), 0)?)
    }
}

/// The Hilbert transform at the samples, and at `padding` more times before and after.
#[doc(hidden)]
pub fn hilbert(samples: &[f64], padding: usize) -> Result<Vec<f64>> {
    let output_count = samples.len() + 2 * padding;
    // Entry k of the kernel is the weight at a distance of k − `zero_distance` samples between output and input.
    let zero_distance = padding + samples.len() - 1;
    let distance_count = output_count + samples.len() - 1;
    let transform_length = distance_count.next_power_of_two();
    let mut kernel = vec![0.0; distance_count];
    for (index, weight) in kernel.iter_mut().enumerate() {
        if index.abs_diff(zero_distance) % 2 == 1 {
            *weight = 2.0 / (PI * (index as f64 - zero_distance as f64));
        }
    }
    let kernel_spectrum = spectrum(&kernel, transform_length)?;
    let mut product_spectrum = spectrum(samples, transform_length)?;
    for (value, factor) in product_spectrum.iter_mut().zip(&kernel_spectrum) {
        *value *= factor;
    }
    let outputs = signal(product_spectrum, transform_length)?;
    // The first outputs contain the part that wraps around.
    Ok(outputs[samples.len() - 1..][..output_count].to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// H[1/(1+t²)] = t/(1+t²), and its tails outside the samples.
    #[test]
    fn lorentzian_has_its_closed_form() {
        let half_count = 16_000;
        let step = 0.125;
        let times: Vec<f64> = (-half_count..=half_count).map(|k| f64::from(k) * step).collect();
        let samples: Vec<f64> = times.iter().map(|t| 1.0 / (1.0 + t * t)).collect();
        let computed = hilbert(&samples, 0).unwrap();
        for (t, computed) in times.iter().zip(&computed).filter(|(t, _)| t.abs() < 200.0) {
            // The tails beyond T = 2000 s that the samples lack: 2t/(3πT³) at most.
            // The part above the highest frequency of the samples: exp(−π/step).
            let tolerance =
                2.0 * (-PI / step).exp() + 2.1 * t.abs() / (3.0 * PI * 2000.0_f64.powi(3));
            assert!((computed - t / (1.0 + t * t)).abs() < tolerance, "{t}: {computed}");
        }
    }

    /// REFERENCE: the sum of the definition, at the samples and around them.
    #[test]
    fn convolution_is_the_sum() {
        let samples: Vec<f64> = (0..37).map(|k| f64::from(k * k % 17) - 7.0).collect();
        for padding in [0, 1, 50] {
            let computed = hilbert(&samples, padding).unwrap();
            assert_eq!(computed.len(), 37 + 2 * padding);
            for (k, computed) in computed.iter().enumerate() {
                let terms = samples.iter().enumerate().map(|(j, f)| {
                    let distance = k as f64 - padding as f64 - j as f64;
                    if distance == 0.0 {
                        0.0
                    } else {
                        f * (1.0 - (PI * distance).cos()) / (PI * distance)
                    }
                });
                assert!((computed - terms.sum::<f64>()).abs() < 1e-12, "{padding} {k}");
            }
        }
    }
}
