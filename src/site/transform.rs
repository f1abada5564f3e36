//! Filters motions by transfer functions, with Fourier transforms.
//!
//! Transforms run along Re s = η > 0, except for damping laws that exist only at real frequencies, for which η is zero.
//! The window e^(−ηt) makes wrap-around negligible, and the transfer functions of undamped profiles are finite for
//! η > 0. The transform has four times the samples of the motion. The window therefore reduces the last sample of the
//! motion by e^(−6), and the removal of the window increases the transform's rounding errors by e^6.
//!
//! The response of a filter ends in time if the filter is real at the highest frequency, and if all its derivatives along
//! the contour are even about that frequency. Responses of other filters alternate and, without the window, grow.

use std::sync::Arc;

use basemat_fourier::num_complex::Complex64;
use basemat_fourier::{ComplexToReal, RealPlanner};

use super::part_progress::{FILTER_PROGRESS_FRACTION, PartProgress};
use super::site_motion::{SiteMotion, SpectrumSums};
use crate::error::{Error, Result, finite, memory, positive, require, same_length};
use crate::linalg::{Complex, largest};

/// Exponent ηT of the window at the end of the transform, which reduces wrap-around to e^(−24).
const WINDOW_EXPONENT: f64 = 24.0;
/// Number of samples of the transform for each sample of the motion, so that three quarters of the transform are quiet.
const LENGTH_PER_SAMPLE: usize = 4;
/// Largest number of samples of a motion, and of time steps of waves through a site.
///
/// A transform of such a motion has 2²⁶ samples or more, some gigabytes.
const MAX_SAMPLES: usize = 1 << 24;
/// Fraction of the frequencies, below the highest, over which filters become real.
///
/// The transfer function is exact only below this band. A narrower band would make responses last longer.
pub(super) const BAND_FRACTION: f64 = 0.02;
/// Exponent β of the transition's slope, which is e^(β(√(1 − x²) − 1)) over the band.
///
/// The transform of the slope is about e^(−β) after 2β/(π · band) samples (Barnett, Magland & af Klinteberg 2019).
const TRANSITION_SHARPNESS: f64 = 24.0;
/// Frequency in place of zero, in frequency steps of the transform; it is small beside the next frequency.
const ZERO_FREQUENCY_STEPS: f64 = 1e-3;
/// Number of frequencies in one call of a filter, whose values stay in the processor's cache.
const FREQUENCIES_PER_BLOCK: usize = 64;
/// Bytes of a filtered spectrum, and of one value of the filters, for each sample of the transform.
const BYTES_PER_FILTERED_SAMPLE: f64 = 12.0;
/// Number of samples after which the responses of the transition band end.
const TRANSITION_SAMPLES: usize = 2000;

/// A point on the contour of a transform.
#[derive(Debug, Clone, Copy)]
pub(super) struct ContourPoint {
    /// Laplace variable, 1/s.
    pub(super) s: Complex,
    /// Weight of the layers modified for samples: 0 below the transition band, 1 at its end.
    pub(super) modified_weight: f64,
    /// Frequency relative to the highest one.
    pub(super) frequency_ratio: f64,
}

impl ContourPoint {
    /// A point of a motion without samples, at a single frequency.
    pub(super) fn at_frequency(s: Complex) -> Self {
        Self { s, modified_weight: 0.0, frequency_ratio: 0.0 }
    }
}

/// The contour of a transform.
#[derive(Debug, PartialEq)]
pub(super) struct Contour {
    /// Time step of the motion, s.
    time_step: f64,
    /// Number of samples of the transform.
    length: usize,
    /// Exponent ηT of the window.
    window_exponent: f64,
    /// Decay rate η of the window, 1/s.
    decay_rate: f64,
}

impl Contour {
    /// Contour for a motion and a site.
    ///
    /// `time_step`: s. `travel_time`: time (s) of waves through the site.
    pub(super) fn new(time_step: f64, sample_count: usize, travel_time: f64) -> Result<Self> {
        positive("time step of a motion", time_step)?;
        same_length("motion through a site", sample_count, sample_count.clamp(1, MAX_SAMPLES))?;
        let travel_ratio = travel_time / time_step;
        let quantity = "time that waves take through a site, in time steps of the motion";
        require(
            quantity,
            travel_ratio,
            (0.0..=MAX_SAMPLES as f64).contains(&travel_ratio),
            "at most 2^24",
        )?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0..=2^24")]
        let travel_steps = travel_ratio.ceil() as usize;
        // Waves travel up and down, and damping delays low frequencies further.
        let length = (LENGTH_PER_SAMPLE * (sample_count + 2 * travel_steps + TRANSITION_SAMPLES))
            .next_power_of_two();
        let decay_rate =
            positive("decay of the window", WINDOW_EXPONENT / (length as f64 * time_step))?;
        Ok(Self { time_step, length, window_exponent: WINDOW_EXPONENT, decay_rate })
    }

    /// This contour along real frequencies, for filters that exist only there.
    ///
    /// A motion that lasts longer than the quiet three quarters of the transform wraps around.
    pub(super) fn at_real_frequencies(self) -> Self {
        Self { window_exponent: 0.0, decay_rate: 0.0, ..self }
    }

    /// Laplace variable (1/s) at the end of the contour, of the highest frequency.
    pub(super) fn end(&self) -> Result<Complex> {
        let highest_frequency =
            finite("highest frequency of a motion", std::f64::consts::PI / self.time_step)?;
        Ok(Complex::new(self.decay_rate, highest_frequency))
    }

    /// Value of the window at a time, which is counted in samples.
    fn window_at(&self, time: f64) -> f64 {
        (-self.window_exponent * time / self.length as f64).exp()
    }

    /// Error of a transform that failed.
    fn transform_error(&self) -> Error {
        Error::Singular { matrix: "spectrum of a motion", order: self.length }
    }

    /// Weight of the modified layers at each frequency of the band, in ascending order.
    fn transition_weights(&self) -> Vec<f64> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a fraction")]
        let band_count = (BAND_FRACTION * (self.length / 2) as f64) as usize;
        let slopes: Vec<f64> = (0..band_count)
            .map(|index| {
                let x = 2.0 * (index as f64 + 0.5) / band_count as f64 - 1.0;
                (TRANSITION_SHARPNESS * ((1.0 - x * x).sqrt() - 1.0)).exp()
            })
            .collect();
        let slope_sum: f64 = slopes.iter().sum();
        let mut weight_sum = 0.0;
        let mut weights = Vec::with_capacity(band_count);
        for slope in slopes {
            weight_sum += slope;
            weights.push(weight_sum / slope_sum);
        }
        weights
    }

    /// Filters a motion by N functions of s, including the time after its end.
    ///
    /// `filters` writes the values of the first function at all points, then those of the next one. Each result has the
    /// length of the transform.
    pub(super) fn filtered<const N: usize>(
        self,
        motion: &[f64],
        progress: &mut PartProgress<'_, '_>,
        filters: impl FnMut(&[ContourPoint], &mut [Complex]) -> Result<()>,
    ) -> Result<[SiteMotion; N]> {
        let mut transform = Transform::new(self, motion)?;
        transform.filter(N, true, progress, filters)?;
        let mut motions = [(); N].map(|()| SiteMotion::default());
        for (index, result) in motions.iter_mut().enumerate() {
            *result = transform.motion(index)?;
        }
        progress.report(1.0)?;
        Ok(motions)
    }
}

/// Spectrum of a motion along a contour, and its products with functions of s.
pub(super) struct Transform {
    contour: Contour,
    /// Number of samples of the motion.
    sample_count: usize,
    /// Spectrum of the windowed motion.
    spectrum: Vec<Complex64>,
    /// √Σx² of the windowed samples, for the estimate of rounding.
    norm: f64,
    /// Weight of the modified layers at each frequency of the transition band.
    transition_weights: Vec<f64>,
    /// Plan of the inverse transform.
    inverse: Arc<dyn ComplexToReal<f64>>,
    /// Windowed samples of the last motion that was transformed back.
    windowed_samples: Vec<f64>,
    /// Temporary memory of the inverse transform.
    scratch: Vec<Complex64>,
    /// Spectrum of the product with each function.
    filtered_spectra: Vec<Vec<Complex64>>,
    /// Sums over the spectrum of the product with each function.
    spectrum_sums: Vec<SpectrumSums>,
}

impl Transform {
    /// Spectrum of a `motion` along a contour.
    pub(super) fn new(contour: Contour, motion: &[f64]) -> Result<Self> {
        let length = contour.length;
        let mut planner = RealPlanner::new();
        let forward = planner.plan_fft_forward(length);
        let inverse = planner.plan_fft_inverse(length);
        let mut windowed_samples = forward.make_input_vec();
        for (i, (value, sample)) in windowed_samples.iter_mut().zip(motion).enumerate() {
            *value = finite("sample of a motion", *sample)? * contour.window_at(i as f64);
        }
        let norm = windowed_samples.iter().map(|value| value * value).sum::<f64>().sqrt();
        let quantity = "largest sample of a motion through a site";
        require(quantity, largest(motion), norm.is_finite(), "at most 1e150")?;
        let mut spectrum = forward.make_output_vec();
        forward
            .process(&mut windowed_samples, &mut spectrum)
            .map_err(|_| contour.transform_error())?;
        Ok(Self {
            transition_weights: contour.transition_weights(),
            contour,
            sample_count: motion.len(),
            spectrum,
            norm,
            scratch: inverse.make_scratch_vec(),
            inverse,
            windowed_samples,
            filtered_spectra: vec![],
            spectrum_sums: vec![],
        })
    }

    /// Contour of the spectrum.
    pub(super) fn contour(&self) -> &Contour {
        &self.contour
    }

    /// Multiplies the spectrum by functions of s, for which [`motion`](Self::motion) then returns the products.
    ///
    /// `filters` writes the values of the first function at all points, then those of the next one.
    /// `computes_losses`: whether rounding and amplification of the motions are computed too.
    pub(super) fn filter(
        &mut self,
        function_count: usize,
        computes_losses: bool,
        progress: &mut PartProgress<'_, '_>,
        mut filters: impl FnMut(&[ContourPoint], &mut [Complex]) -> Result<()>,
    ) -> Result<()> {
        let memory_bytes =
            BYTES_PER_FILTERED_SAMPLE * self.contour.length as f64 * function_count as f64;
        memory::check("motions in a site", function_count as f64, memory_bytes)?;
        let highest_frequency = self.contour.end()?.im;
        let last_index = self.spectrum.len() - 1;
        self.filtered_spectra.resize(function_count, vec![]);
        for spectrum in &mut self.filtered_spectra {
            spectrum.resize(last_index + 1, Complex64::default());
        }
        self.spectrum_sums.clear();
        self.spectrum_sums.resize(function_count, SpectrumSums::default());
        let mut filter_values = vec![Complex::default(); function_count * FREQUENCIES_PER_BLOCK];
        let mut points = Vec::with_capacity(FREQUENCIES_PER_BLOCK);
        for start in (0..=last_index).step_by(FREQUENCIES_PER_BLOCK) {
            let stop = (start + FREQUENCIES_PER_BLOCK).min(last_index + 1);
            points.clear();
            points.extend((start..stop).map(|index| self.point(index, highest_frequency)));
            let block_values = &mut filter_values[..function_count * points.len()];
            filters(&points, block_values)?;
            let functions = block_values.chunks_exact(points.len()).zip(&mut self.filtered_spectra);
            for ((values, filtered), sums) in functions.zip(&mut self.spectrum_sums) {
                let inputs = self.spectrum[start..stop].iter().zip(values).zip(&points);
                for (((input, filter), point), output) in inputs.zip(&mut filtered[start..stop]) {
                    let product = Complex::new(input.re, input.im) * *filter;
                    *output = Complex64::new(product.re, product.im);
                    if computes_losses {
                        sums.add(*filter, product, point.s.im);
                    }
                }
            }
            progress.report(FILTER_PROGRESS_FRACTION * stop as f64 / (last_index + 1) as f64)?;
        }
        // The first and the last value are real except for rounding errors, which are removed here.
        for spectrum in &mut self.filtered_spectra {
            spectrum[0].im = 0.0;
            spectrum[last_index].im = 0.0;
        }
        Ok(())
    }

    /// Point on the contour of the frequency with this index; `highest_frequency`: rad/s.
    fn point(&self, index: usize, highest_frequency: f64) -> ContourPoint {
        let decay_rate = self.contour.decay_rate;
        let last_index = self.spectrum.len() - 1;
        let band_begin = last_index + 1 - self.transition_weights.len();
        let frequency_ratio = index as f64 / last_index as f64;
        // At s = 0 strains are 0/0 and some laws have no modulus: a frequency slightly above zero replaces it.
        let is_zero_frequency = index == 0 && decay_rate == 0.0;
        let nonzero_ratio = if is_zero_frequency {
            ZERO_FREQUENCY_STEPS / last_index as f64
        } else {
            frequency_ratio
        };
        let band_index = index.checked_sub(band_begin);
        ContourPoint {
            s: Complex::new(decay_rate, highest_frequency * nonzero_ratio),
            modified_weight: band_index.map_or(0.0, |index| self.transition_weights[index]),
            frequency_ratio,
        }
    }

    /// Samples of a filtered motion during the original motion; call it once for each motion.
    pub(super) fn samples(&mut self, motion_index: usize) -> Result<Vec<f64>> {
        self.invert(motion_index)?;
        let windowed_samples = self.windowed_samples[..self.sample_count].iter().enumerate();
        windowed_samples.map(|(i, value)| self.unwindowed(*value, i as f64)).collect()
    }

    /// Largest sample of a filtered motion, also after the original motion; call it once for each motion.
    pub(super) fn peak(&mut self, motion_index: usize) -> Result<f64> {
        let length = self.contour.length;
        self.invert(motion_index)?;
        let first_half = &self.windowed_samples[..length / 2];
        let peak = largest(first_half) / length as f64;
        if first_half.iter().all(|value| value.is_finite()) && peak.is_finite() {
            Ok(peak)
        } else {
            finite("motion through a site", f64::NAN)
        }
    }

    /// A filtered motion, also after the original motion; call it once for each motion.
    pub(super) fn motion(&mut self, motion_index: usize) -> Result<SiteMotion> {
        let mut motion = SiteMotion::default();
        let length = self.contour.length;
        let band_begin = self.spectrum.len() - self.transition_weights.len();
        // The part of the motion in the transition band.
        let mut band_spectrum = self.filtered_spectra[motion_index].clone();
        band_spectrum[..band_begin].fill(Complex64::default());
        for (value, modified_weight) in
            band_spectrum[band_begin..].iter_mut().zip(&self.transition_weights)
        {
            *value *= modified_weight;
        }
        std::mem::swap(&mut band_spectrum, &mut self.filtered_spectra[motion_index]);
        self.invert(motion_index)?;
        for (i, value) in self.windowed_samples[..self.sample_count].iter().enumerate() {
            motion.near_nyquist = motion.near_nyquist.max(self.unwindowed(*value, i as f64)?.abs());
        }
        // The whole motion.
        self.filtered_spectra[motion_index] = band_spectrum;
        self.invert(motion_index)?;
        let first_half = self.windowed_samples[..length / 2].iter().enumerate();
        motion.samples =
            first_half.map(|(i, x)| self.unwindowed(*x, i as f64)).collect::<Result<_>>()?;
        // The end of the transform is the time before the first sample, since the transform is periodic.
        for (i, value) in
            self.windowed_samples[length / 2..].iter().rev().take(length / 4).enumerate()
        {
            motion.before = motion.before.max(self.unwindowed(*value, -1.0 - i as f64)?.abs());
        }
        let sums = self.spectrum_sums[motion_index];
        let is_mostly_amplified = sums.amplified_power > 0.5 * sums.power;
        motion.amplified_from = sums.lowest_amplified_frequency.filter(|_| is_mostly_amplified);
        let relative_error = f64::EPSILON * (length as f64).log2().sqrt() / length as f64;
        let windowed_error =
            relative_error * (self.norm * sums.squared_gain.sqrt() + sums.power.sqrt());
        motion.rounding = windowed_error / self.contour.window_at(self.sample_count as f64);
        Ok(motion)
    }

    /// Sample of a motion from its windowed value.
    ///
    /// `time`: counted in samples, negative before the first sample.
    fn unwindowed(&self, value: f64, time: f64) -> Result<f64> {
        let scale = 1.0 / self.contour.length as f64;
        finite("motion through a site", value * scale / self.contour.window_at(time))
    }

    /// Overwrites the windowed samples with a filtered motion, and destroys its spectrum.
    fn invert(&mut self, motion_index: usize) -> Result<()> {
        let Self { filtered_spectra, windowed_samples, scratch, .. } = self;
        let spectrum = &mut filtered_spectra[motion_index];
        let result = self.inverse.process_with_scratch(spectrum, windowed_samples, scratch);
        result.map_err(|_| self.contour.transform_error())
    }
}
