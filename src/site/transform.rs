//! Motions through transfer functions, by Fourier transform.
//!
//! All runs at Re s = η > 0: a window e^(−ηt) that makes what wraps around the transform negligible
//! and undamped profiles regular. The transform has four times the samples that matter, so the window
//! takes e^(−6) off the last of them and gives it back, with rounding e^6 times that of the transform.
//! Filters that are real at the highest frequency, with all their slopes along the contour even about
//! it, have responses that end; others would alternate and, without the window, grow.

use std::fmt;

use realfft::RealFftPlanner;
use realfft::num_complex::Complex64;

use crate::error::{Error, Result, finite, memory, positive, require, same_length};
use crate::linalg::{Complex, largest};

/// ηT: what wraps around is e^(−24).
const WINDOW: f64 = 24.0;
/// Samples that matter are this fraction of the transform's.
const PADDING: usize = 4;
/// Most samples of a motion, and time steps that waves take through a site.
const MOST_SAMPLES: usize = 1 << 24;
/// Share of the frequencies, the highest, over which filters become real: narrow, for the transfer
/// function holds below; not narrower, for responses last the longer.
pub(super) const BAND: f64 = 0.02;
/// Exponent of the transition's slope, e^(β(√(1 − x²) − 1)) over the band (Barnett, Magland & af
/// Klinteberg 2019): its transform is e^(−β) from 2β/(π · band) samples on.
const SHARPNESS: f64 = 24.0;
/// Frequency for zero, in steps of the transform's.
const BESIDE_REST: f64 = 1e-3;
/// Samples in which responses of the transition end.
const TRANSITION: usize = 2000;

/// A place on the contour.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) s: Complex,
    /// Share of the highest frequency's rule: 0 below the band, 1 there.
    pub(super) nearness: f64,
    /// Frequency over the highest.
    pub(super) ratio: f64,
}

impl Place {
    /// A frequency by itself, without samples.
    pub(super) fn alone(s: Complex) -> Self {
        Self { s, nearness: 0.0, ratio: 0.0 }
    }
}

/// The contour of a transform.
#[derive(Debug)]
pub(super) struct Contour {
    time_step: f64,
    length: usize,
    /// ηT and η.
    window: f64,
    decay: f64,
}

impl Contour {
    /// Contour for `samples`, `time_step` seconds apart, and waves that take `travel` seconds.
    pub(super) fn new(time_step: f64, samples: usize, travel: f64) -> Result<Self> {
        positive("time step of a motion", time_step)?;
        same_length("motion through a site", samples, samples.clamp(1, MOST_SAMPLES))?;
        let steps = travel / time_step;
        let quantity = "time that waves take through a site, in time steps of the motion";
        require(quantity, steps, (0.0..=MOST_SAMPLES as f64).contains(&steps), "at most 2^24")?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0..=2^24")]
        let travel = steps.ceil() as usize;
        // There and back, and later for damping that slows long waves.
        let length = (PADDING * (samples + 2 * travel + TRANSITION)).next_power_of_two();
        let decay = positive("decay of the window", WINDOW / (length as f64 * time_step))?;
        Ok(Self { time_step, length, window: WINDOW, decay })
    }

    /// This transform along real frequencies, for filters that exist there alone: motion that lasts longer than the
    /// quiet three quarters of the transform wraps around.
    pub(super) fn at_real_frequencies(self) -> Self {
        Self { window: 0.0, decay: 0.0, ..self }
    }

    /// End of the contour, the highest frequency.
    pub(super) fn end(&self) -> Result<Complex> {
        let highest =
            finite("highest frequency of a motion", std::f64::consts::PI / self.time_step)?;
        Ok(Complex::new(self.decay, highest))
    }

    /// Share of the highest frequency's rule at each frequency of the band, in order up to it.
    fn transition(&self) -> Vec<f64> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share")]
        let count = (BAND * (self.length / 2) as f64) as usize;
        let slope = |l: usize| {
            let x = 2.0 * (l as f64 + 0.5) / count as f64 - 1.0;
            (SHARPNESS * ((1.0 - x * x).sqrt() - 1.0)).exp()
        };
        let total: f64 = (0..count).map(slope).sum();
        let mut sum = 0.0;
        let add = |l: usize| {
            sum += slope(l);
            sum / total
        };
        (0..count).map(add).collect()
    }

    /// `motion` times each of N functions of s; with what follows its end, as far as the window reaches.
    pub(super) fn filtered<const N: usize>(
        &self,
        motion: &[f64],
        mut filters: impl FnMut(&Place) -> Result<[Complex; N]>,
    ) -> Result<[SiteMotion; N]> {
        let fill = |place: &Place, found: &mut [Complex]| {
            found.copy_from_slice(&filters(place)?);
            Ok(())
        };
        let mut found = self.filtered_by(motion, N, fill)?.into_iter();
        Ok(std::array::from_fn(|_| found.next().unwrap_or_default()))
    }

    /// Samples filtered by `count` functions, whose values `filters` writes.
    pub(super) fn filtered_by(
        &self,
        motion: &[f64],
        count: usize,
        mut filters: impl FnMut(&Place, &mut [Complex]) -> Result<()>,
    ) -> Result<Vec<SiteMotion>> {
        let Self { length, decay, .. } = *self;
        let needed = 12.0 * length as f64 * count as f64;
        memory::check("motions in a site", count as f64, needed)?;
        let end = self.end()?.im;
        let mut planner = RealFftPlanner::<f64>::new();
        let (forward, inverse) =
            (planner.plan_fft_forward(length), planner.plan_fft_inverse(length));
        let mut values = forward.make_input_vec();
        let window = |i: f64| (-self.window * i / length as f64).exp();
        for (i, (value, sample)) in values.iter_mut().zip(motion).enumerate() {
            *value = finite("sample of a motion", *sample)? * window(i as f64);
        }
        let size = values.iter().map(|value| value * value).sum::<f64>().sqrt();
        let quantity = "largest sample of a motion through a site";
        require(quantity, largest(motion), size.is_finite(), "at most 1e150")?;
        let mut spectrum = forward.make_output_vec();
        let failed = |_| Error::Singular { matrix: "spectrum of a motion", order: length };
        forward.process(&mut values, &mut spectrum).map_err(failed)?;
        let last = spectrum.len() - 1;
        let transition = self.transition();
        let below = last + 1 - transition.len();
        let mut spectra = vec![spectrum.clone(); count];
        let mut products = vec![Complex::default(); count];
        // Σ|F|² and Σ|FX|², for rounding.
        let mut sums = vec![[0.0; 2]; count];
        for (l, value) in spectrum.iter().enumerate() {
            let ratio = l as f64 / last as f64;
            let nearness = if l < below { 0.0 } else { transition[l - below] };
            // Beside s = 0, where strains are 0/0 and some laws have no modulus.
            let beside = if l == 0 && decay == 0.0 { BESIDE_REST / last as f64 } else { ratio };
            let place = Place { s: Complex::new(decay, end * beside), nearness, ratio };
            filters(&place, &mut products)?;
            for ((spectrum, filter), sums) in spectra.iter_mut().zip(&products).zip(&mut sums) {
                let product = Complex::new(value.re, value.im) * *filter;
                // Real by itself, but for rounding.
                let imaginary = if l == 0 || l == last { 0.0 } else { product.im };
                spectrum[l] = Complex64::new(product.re, imaginary);
                sums[0] += filter.square();
                sums[1] += product.square();
            }
        }
        let mut found = vec![SiteMotion::default(); count];
        for ((mut spectrum, [gain, power]), found) in spectra.into_iter().zip(sums).zip(&mut found)
        {
            let mut band = spectrum.clone();
            band[..below].fill(Complex64::default());
            for (value, nearness) in band[below..].iter_mut().zip(&transition) {
                *value *= nearness;
            }
            // At a time in samples, which may be before the first.
            let scale = 1.0 / length as f64;
            let at = |value: f64, time: f64| {
                finite("motion through a site", value * scale / window(time))
            };
            let count = motion.len();
            inverse.process(&mut band, &mut values).map_err(failed)?;
            for (i, value) in values[..count].iter().enumerate() {
                found.near_nyquist = found.near_nyquist.max(at(*value, i as f64)?.abs());
            }
            inverse.process(&mut spectrum, &mut values).map_err(failed)?;
            let (first, others) = values.split_at(length / 2);
            let first = first.iter().enumerate();
            found.samples = first.map(|(i, x)| at(*x, i as f64)).collect::<Result<_>>()?;
            for (i, value) in others.iter().rev().take(length / 4).enumerate() {
                found.before = found.before.max(at(*value, -1.0 - i as f64)?.abs());
            }
            let error = f64::EPSILON * (length as f64).log2().sqrt() * scale;
            let error = error * (size * gain.sqrt() + power.sqrt());
            found.rounding = error / window(count as f64);
        }
        Ok(found)
    }
}

/// A motion that went through a site, at the times of the one that was given, and the sizes of what
/// its samples do not hold.
///
/// Motions are taken to be zero outside their samples, so what is cut off here is missing on the way
/// back: [`Record::padded`](crate::motion::Record::padded) makes room for it. A record with quiet
/// time around it goes through a site and returns to 1e-9 of its peak, whatever its frequencies, if
/// [`SiteMotion::is_whole`] on both ways.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct SiteMotion {
    /// Samples of the motion.
    pub samples: Vec<f64>,
    /// Largest sample before the first one, cut off: on the way down motion comes earlier.
    pub before: f64,
    /// Largest sample after the last one, cut off: what is still on its way.
    pub after: f64,
    /// Largest sample of the part with the highest frequencies, the last 2 % below 1/2Δt, where layers
    /// delay by whole time steps: the error of that, which is at most half a step from the surface to
    /// any depth, to a factor of four.
    pub near_nyquist: f64,
    /// Rounding, estimated: large if damped layers amplify high frequencies on the way down.
    pub rounding: f64,
}

impl SiteMotion {
    /// Fraction of the peak below which motion counts as rest.
    pub const LIMIT: f64 = 1e-9;

    /// Largest sample.
    pub fn peak(&self) -> f64 {
        largest(&self.samples)
    }

    /// Whether nothing above [`SiteMotion::LIMIT`] of the peak is cut off or rounded away.
    pub fn is_whole(&self) -> bool {
        self.before.max(self.after).max(self.rounding) <= Self::LIMIT * self.peak()
    }

    /// Number of samples up to the last one that is something.
    pub(super) fn duration(&self) -> usize {
        let least = Self::LIMIT * self.peak();
        self.samples.iter().rposition(|x| x.abs() > least).map_or(0, |last| last + 1)
    }

    /// Leaves `count` samples.
    pub(super) fn cut(&mut self, count: usize) {
        let count = count.min(self.samples.len());
        self.after = largest(&self.samples[count..]);
        self.samples.truncate(count);
    }
}

/// Sizes relative to the peak.
impl fmt::Display for SiteMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let peak = self.peak();
        write!(
            f,
            "peak {peak:.3e}; of that cut off before {:.1e}, after {:.1e}, near the highest frequency \
             {:.1e}, rounding {:.1e}",
            self.before / peak,
            self.after / peak,
            self.near_nyquist / peak,
            self.rounding / peak
        )
    }
}
