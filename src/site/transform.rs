//! Motions through transfer functions, by Fourier transform.
//!
//! All transforms run at Re s = η > 0: the window e^(−ηt) makes wrap-around negligible and undamped profiles
//! regular. The transform has four times the samples of the motion. The window therefore reduces the last of these
//! samples by e^(−6). Undoing the window increases the transform's rounding by e^6. A filter has a response that ends
//! if it is real at the highest frequency, and if all its slopes along the contour are even about that frequency. Other
//! responses would alternate and, without the window, grow.

use std::sync::Arc;

use basemat_fourier::num_complex::Complex64;
use basemat_fourier::{ComplexToReal, RealPlanner};

use super::site_motion::{AMPLIFICATION_LIMIT, SiteMotion};
use crate::error::{
    Error, ProgressReporter, Result, finite, memory, positive, require, same_length,
};
use crate::linalg::{Complex, largest};

/// ηT: wrap-around is reduced to e^(−24).
const WINDOW_EXPONENT: f64 = 24.0;
/// Length of the transform, relative to the number of samples of the motion.
const LENGTH_PER_SAMPLE: usize = 4;
/// Largest number of samples of a motion, and of time steps of waves through a site.
const MAX_SAMPLES: usize = 1 << 24;
/// Fraction of the frequencies, below the highest, over which filters become real.
///
/// The transfer function is exact only below this band. A narrower band would make responses last longer.
pub(super) const BAND_FRACTION: f64 = 0.02;
/// Exponent β of the transition's slope, e^(β(√(1 − x²) − 1)) over the band.
///
/// Its transform is e^(−β) from 2β/(π · band) samples on (Barnett, Magland & af Klinteberg 2019).
const TRANSITION_SHARPNESS: f64 = 24.0;
/// Frequency used in place of zero, in frequency steps of the transform.
const ZERO_FREQUENCY_STEPS: f64 = 1e-3;
/// Number of frequencies per call of a filter.
const FREQUENCIES_PER_BLOCK: usize = 64;
/// Number of samples after which responses of the transition end.
const TRANSITION_SAMPLES: usize = 2000;

/// A place on the contour.
#[derive(Debug, Clone, Copy)]
pub(super) struct ContourPoint {
    pub(super) s: Complex,
    /// Weight of the modified layers of the highest frequency: 0 below the band, 1 at its end.
    pub(super) nearness: f64,
    /// Frequency over the highest.
    pub(super) ratio: f64,
}

impl ContourPoint {
    /// A single frequency, without samples.
    pub(super) fn at_frequency(s: Complex) -> Self {
        Self { s, nearness: 0.0, ratio: 0.0 }
    }
}

/// The contour of a transform.
#[derive(Debug, PartialEq)]
pub(super) struct Contour {
    time_step: f64,
    length: usize,
    /// ηT and η.
    window: f64,
    decay: f64,
}

impl Contour {
    /// Contour for `samples`, `time_step` seconds apart, and waves that take `travel` seconds through the site.
    pub(super) fn new(time_step: f64, samples: usize, travel: f64) -> Result<Self> {
        positive("time step of a motion", time_step)?;
        same_length("motion through a site", samples, samples.clamp(1, MAX_SAMPLES))?;
        let steps = travel / time_step;
        let quantity = "time that waves take through a site, in time steps of the motion";
        require(quantity, steps, (0.0..=MAX_SAMPLES as f64).contains(&steps), "at most 2^24")?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0..=2^24")]
        let travel = steps.ceil() as usize;
        // There and back, and longer for damping that slows long waves.
        let length =
            (LENGTH_PER_SAMPLE * (samples + 2 * travel + TRANSITION_SAMPLES)).next_power_of_two();
        let decay = positive("decay of the window", WINDOW_EXPONENT / (length as f64 * time_step))?;
        Ok(Self { time_step, length, window: WINDOW_EXPONENT, decay })
    }

    /// This transform along real frequencies, for filters that exist only there.
    ///
    /// Motion that lasts longer than the quiet three quarters of the transform wraps around.
    pub(super) fn at_real_frequencies(self) -> Self {
        Self { window: 0.0, decay: 0.0, ..self }
    }

    /// End of the contour, the highest frequency.
    pub(super) fn end(&self) -> Result<Complex> {
        let highest =
            finite("highest frequency of a motion", std::f64::consts::PI / self.time_step)?;
        Ok(Complex::new(self.decay, highest))
    }

    /// Window at a time in samples.
    fn window_at(&self, time: f64) -> f64 {
        (-self.window * time / self.length as f64).exp()
    }

    fn failed(&self) -> Error {
        Error::Singular { matrix: "spectrum of a motion", order: self.length }
    }

    /// Weight of the modified layers at each frequency of the band, in ascending order.
    fn transition(&self) -> Vec<f64> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a fraction")]
        let count = (BAND_FRACTION * (self.length / 2) as f64) as usize;
        let slopes: Vec<f64> = (0..count)
            .map(|l| {
                let x = 2.0 * (l as f64 + 0.5) / count as f64 - 1.0;
                (TRANSITION_SHARPNESS * ((1.0 - x * x).sqrt() - 1.0)).exp()
            })
            .collect();
        let total: f64 = slopes.iter().sum();
        let mut sum = 0.0;
        let mut weights = Vec::with_capacity(count);
        for slope in slopes {
            sum += slope;
            weights.push(sum / total);
        }
        weights
    }

    /// `motion` times each of N functions of s, including the motion after its end.
    ///
    /// `filters` writes the values of the first function at all places, then of the next. The result has the length of
    /// the window.
    pub(super) fn filtered<const N: usize>(
        self,
        motion: &[f64],
        progress: &mut PartProgress<'_, '_>,
        filters: impl FnMut(&[ContourPoint], &mut [Complex]) -> Result<()>,
    ) -> Result<[SiteMotion; N]> {
        let mut transform = Transform::new(self, motion)?;
        transform.filter(N, true, progress, filters)?;
        let mut found = [(); N].map(|()| SiteMotion::default());
        for (k, found) in found.iter_mut().enumerate() {
            *found = transform.motion(k)?;
        }
        progress.reach(1.0)?;
        Ok(found)
    }
}

/// Spectrum of a motion along a contour, and the spectra of its products with functions of s.
pub(super) struct Transform {
    contour: Contour,
    /// Number of samples of the motion.
    samples: usize,
    spectrum: Vec<Complex64>,
    /// √Σx² of the windowed samples, for the estimate of rounding.
    norm: f64,
    /// Weight of the modified layers at each frequency of the band.
    transition: Vec<f64>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    /// Windowed samples of the motion that was transformed last.
    values: Vec<f64>,
    scratch: Vec<Complex64>,
    /// Spectrum of the product with each function.
    filtered: Vec<Vec<Complex64>>,
    /// Sums over the spectrum of each product.
    sums: Vec<SpectrumSums>,
}

impl Transform {
    /// Spectrum of `motion`.
    pub(super) fn new(contour: Contour, motion: &[f64]) -> Result<Self> {
        let length = contour.length;
        let mut planner = RealPlanner::new();
        let forward = planner.plan_fft_forward(length);
        let inverse = planner.plan_fft_inverse(length);
        let mut values = forward.make_input_vec();
        for (i, (value, sample)) in values.iter_mut().zip(motion).enumerate() {
            *value = finite("sample of a motion", *sample)? * contour.window_at(i as f64);
        }
        let norm = values.iter().map(|value| value * value).sum::<f64>().sqrt();
        let quantity = "largest sample of a motion through a site";
        require(quantity, largest(motion), norm.is_finite(), "at most 1e150")?;
        let mut spectrum = forward.make_output_vec();
        forward.process(&mut values, &mut spectrum).map_err(|_| contour.failed())?;
        Ok(Self {
            transition: contour.transition(),
            contour,
            samples: motion.len(),
            spectrum,
            norm,
            scratch: inverse.make_scratch_vec(),
            inverse,
            values,
            filtered: vec![],
            sums: vec![],
        })
    }

    /// Contour of the spectrum.
    pub(super) fn contour(&self) -> &Contour {
        &self.contour
    }

    /// Multiplies the spectrum by `count` functions.
    ///
    /// `filters` writes the values of the first function at all places, then of the next. With `measured`, rounding and
    /// amplification of the motions are computed too.
    pub(super) fn filter(
        &mut self,
        count: usize,
        measured: bool,
        progress: &mut PartProgress<'_, '_>,
        mut filters: impl FnMut(&[ContourPoint], &mut [Complex]) -> Result<()>,
    ) -> Result<()> {
        let Contour { length, decay, .. } = self.contour;
        let needed = 12.0 * length as f64 * count as f64;
        memory::check("motions in a site", count as f64, needed)?;
        let end = self.contour.end()?.im;
        let last = self.spectrum.len() - 1;
        let below = last + 1 - self.transition.len();
        self.filtered.resize(count, vec![]);
        for filtered in &mut self.filtered {
            filtered.resize(last + 1, Complex64::default());
        }
        self.sums.clear();
        self.sums.resize(count, SpectrumSums::default());
        let mut products = vec![Complex::default(); count * FREQUENCIES_PER_BLOCK];
        let mut places = Vec::with_capacity(FREQUENCIES_PER_BLOCK);
        for begin in (0..=last).step_by(FREQUENCIES_PER_BLOCK) {
            let stop = (begin + FREQUENCIES_PER_BLOCK).min(last + 1);
            places.clear();
            for l in begin..stop {
                let ratio = l as f64 / last as f64;
                let nearness = if l < below { 0.0 } else { self.transition[l - below] };
                // Slightly above s = 0, where strains are 0/0 and some laws have no modulus.
                let is_singular = l == 0 && decay == 0.0;
                let shifted = if is_singular { ZERO_FREQUENCY_STEPS / last as f64 } else { ratio };
                places.push(ContourPoint {
                    s: Complex::new(decay, end * shifted),
                    nearness,
                    ratio,
                });
            }
            let products = &mut products[..count * places.len()];
            filters(&places, products)?;
            let functions = products.chunks_exact(places.len()).zip(&mut self.filtered);
            for ((products, filtered), sums) in functions.zip(&mut self.sums) {
                let inputs = self.spectrum[begin..stop].iter().zip(products).zip(&places);
                for (((value, filter), place), filtered) in inputs.zip(&mut filtered[begin..stop]) {
                    let product = Complex::new(value.re, value.im) * *filter;
                    *filtered = Complex64::new(product.re, product.im);
                    if measured {
                        sums.add(*filter, product, place.s.im);
                    }
                }
            }
            progress.reach(0.5 * stop as f64 / (last + 1) as f64)?;
        }
        // Real in theory; this removes rounding.
        for filtered in &mut self.filtered {
            filtered[0].im = 0.0;
            filtered[last].im = 0.0;
        }
        Ok(())
    }

    /// Samples of motion `k`, as many as the original motion has; call it once.
    pub(super) fn samples(&mut self, k: usize) -> Result<Vec<f64>> {
        self.invert(k)?;
        let values = self.values[..self.samples].iter().enumerate();
        values.map(|(i, value)| self.unwindowed(*value, i as f64)).collect()
    }

    /// Largest sample of motion `k`, including the time after the end of the original motion; call it once.
    pub(super) fn peak(&mut self, k: usize) -> Result<f64> {
        let length = self.contour.length;
        self.invert(k)?;
        let first = &self.values[..length / 2];
        let peak = largest(first) / length as f64;
        if first.iter().all(|value| value.is_finite()) && peak.is_finite() {
            Ok(peak)
        } else {
            finite("motion through a site", f64::NAN)
        }
    }

    /// Motion `k`, including the time after the end of the original motion; call it once.
    pub(super) fn motion(&mut self, k: usize) -> Result<SiteMotion> {
        let mut found = SiteMotion::default();
        let length = self.contour.length;
        let below = self.spectrum.len() - self.transition.len();
        // The part of the motion in the band alone.
        let mut band = self.filtered[k].clone();
        band[..below].fill(Complex64::default());
        for (value, nearness) in band[below..].iter_mut().zip(&self.transition) {
            *value *= nearness;
        }
        std::mem::swap(&mut band, &mut self.filtered[k]);
        self.invert(k)?;
        for (i, value) in self.values[..self.samples].iter().enumerate() {
            found.near_nyquist = found.near_nyquist.max(self.unwindowed(*value, i as f64)?.abs());
        }
        // The whole motion.
        self.filtered[k] = band;
        self.invert(k)?;
        let first_half = self.values[..length / 2].iter().enumerate();
        found.samples =
            first_half.map(|(i, x)| self.unwindowed(*x, i as f64)).collect::<Result<_>>()?;
        // Wrapped around: the end of the transform is the time before the first sample.
        for (i, value) in self.values[length / 2..].iter().rev().take(length / 4).enumerate() {
            found.before = found.before.max(self.unwindowed(*value, -1.0 - i as f64)?.abs());
        }
        let SpectrumSums { gain, power, amplified, lowest } = self.sums[k];
        let is_mostly_amplified = amplified > 0.5 * power;
        found.amplified_from = lowest.filter(|_| is_mostly_amplified);
        let error = f64::EPSILON * (length as f64).log2().sqrt() / length as f64;
        let error = error * (self.norm * gain.sqrt() + power.sqrt());
        found.rounding = error / self.contour.window_at(self.samples as f64);
        Ok(found)
    }

    /// Sample of a motion at a time in samples, which may be before the first sample.
    fn unwindowed(&self, value: f64, time: f64) -> Result<f64> {
        let scale = 1.0 / self.contour.length as f64;
        finite("motion through a site", value * scale / self.contour.window_at(time))
    }

    /// Overwrites the values with motion `k`, and its spectrum with scratch of the transform.
    fn invert(&mut self, k: usize) -> Result<()> {
        let Self { filtered, values, scratch, .. } = self;
        let result = self.inverse.process_with_scratch(&mut filtered[k], values, scratch);
        result.map_err(|_| self.contour.failed())
    }
}

/// Σ|F|² and Σ|FX|² of a function and the spectrum.
#[derive(Debug, Clone, Copy, Default)]
struct SpectrumSums {
    gain: f64,
    power: f64,
    /// Part of the power at frequencies with |F| above the limit of amplification.
    amplified: f64,
    /// Lowest of these frequencies, Hz.
    lowest: Option<f64>,
}

impl SpectrumSums {
    /// Adds the next frequency, ω in rad/s.
    fn add(&mut self, filter: Complex, product: Complex, omega: f64) {
        let gain = filter.square();
        let power = product.square();
        self.gain += gain;
        self.power += power;
        if gain > AMPLIFICATION_LIMIT * AMPLIFICATION_LIMIT {
            self.amplified += power;
            self.lowest.get_or_insert(omega / std::f64::consts::TAU);
        }
    }
}

/// One of the equal parts of a call through a site, for its observer.
pub(super) struct PartProgress<'p, 'w> {
    watch: &'p mut ProgressReporter<'w>,
    begin: usize,
}

impl<'p, 'w> PartProgress<'p, 'w> {
    /// Number of steps that the observer counts in each part.
    pub(super) const STEPS_PER_PART: usize = 1000;

    /// A call of one part.
    pub(super) fn whole(watch: &'p mut ProgressReporter<'w>) -> Self {
        Self::part(watch, 0)
    }

    /// The part with this number, from 0.
    pub(super) fn part(watch: &'p mut ProgressReporter<'w>, number: usize) -> Self {
        Self { watch, begin: number.saturating_mul(Self::STEPS_PER_PART) }
    }

    /// Reports the fraction of the part that is done.
    pub(super) fn reach(&mut self, fraction: f64) -> Result<()> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1000")]
        let done = (Self::STEPS_PER_PART as f64 * fraction.clamp(0.0, 1.0)) as usize;
        self.watch.reach(self.begin.saturating_add(done))
    }
}
