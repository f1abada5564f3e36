//! Elastic response spectra.
//!
//! | symbol | meaning |
//! |---|---|
//! | ω, ζ | natural circular frequency, damping ratio |
//! | ω_d | ω √(1−ζ²) |
//! | u, v | displacement and velocity relative to the ground: u'' + 2ζω u' + ω² u = −a(t) |
//! | h | substep: the record's interval divided so that a period has at least 40 substeps |

use std::fmt;

use super::Record;
use crate::error::{Observer, ProgressReporter, Result, damping_ratio, positive, require};

/// Smallest number of substeps in a period.
const SUBSTEPS_PER_PERIOD: f64 = 40.0;
/// Largest number of substeps in all; shorter periods are an error.
const MAX_SUBSTEPS: f64 = 1e9;

/// Number of substeps between two calls of an observer.
const SUBSTEPS_PER_REPORT: usize = 1 << 20;

/// Largest response of one oscillator during a record and one period after it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct SpectralOrdinate {
    /// Natural period T, s.
    pub period: f64,
    /// Largest displacement relative to the ground S_d, m.
    pub displacement: f64,
    /// Pseudo-velocity ω S_d, m/s.
    pub pseudo_velocity: f64,
    /// Pseudo-acceleration ω² S_d, m/s².
    pub pseudo_acceleration: f64,
    /// Largest total acceleration, m/s².
    pub acceleration: f64,
}

/// Smallest number of a record's time steps in a period of its spectrum.
const SAMPLES_PER_PERIOD: f64 = 10.0;

/// Warning: a period of a response spectrum has fewer than ten time steps.
///
/// The record is linear between samples. This reduces a harmonic with n samples in its period by the factor (sin
/// x/x)², x = π/n: 0.97 at ten samples, 0.88 at five, 0.57 at two and a half. A floor's accelerations may be means
/// over steps, which reduces them by a further sin x/x.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct CoarseSpectrum {
    /// Shortest period of the spectrum, s.
    pub period: f64,
    /// Time step of the record, s.
    pub time_step: f64,
}

impl fmt::Display for CoarseSpectrum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { period, time_step } = self;
        let min_period = SAMPLES_PER_PERIOD * time_step;
        write!(
            f,
            "below a period of {min_period:.3} s the spectrum is not exact, at {period:.3} s by far: the record has fewer \
             than ten time steps of {time_step} s in a period; a floor's spectrum needs a run with a shorter step"
        )
    }
}

impl Record {
    /// Warns if the shortest of these `periods` (s) has fewer than ten time steps.
    ///
    /// ```
    /// // Samples of 0.02 s.
    /// let record = basemat::motion::el_centro_1940();
    /// assert!(record.coarse_spectrum(&[0.2, 1.0]).is_none());
    /// let warning = record.coarse_spectrum(&[0.05, 1.0]).ok_or("periods are too short")?;
    /// assert_eq!(warning.period, 0.05);
    /// println!("{warning}");
    /// # Ok::<(), &str>(())
    /// ```
    pub fn coarse_spectrum(&self, periods: &[f64]) -> Option<CoarseSpectrum> {
        let period = periods.iter().copied().reduce(f64::min)?;
        let time_step = self.time_step();
        let is_coarse = period < SAMPLES_PER_PERIOD * time_step * (1.0 - 1e-9);
        is_coarse.then_some(CoarseSpectrum { period, time_step })
    }

    /// Elastic response spectrum at `periods` (s) with the damping ratio `damping`.
    ///
    /// The acceleration is linear between samples, for which the oscillator's motion is known exactly (Nigam &
    /// Jennings, "Calculation of response spectra from strong-motion earthquake records", Bull. Seism. Soc. Am. 59
    /// (1969), 909–922). Peaks between samples are found to 2e-6. Peaks of the free vibration in the period after the last
    /// sample count too. The spectrum of a floor's acceleration is a floor spectrum. [`Record::coarse_spectrum`] warns of
    /// periods that are too short for the record's time step. The observer's parts are samples of the record, counted
    /// again for every period.
    ///
    /// ```
    /// let record = basemat::motion::el_centro_1940();
    /// let spectrum = record.response_spectrum(&[0.5, 1.0], 0.05, &mut basemat::unobserved)?;
    /// let in_g = spectrum[0].pseudo_acceleration / 9.80665;
    /// assert!((in_g - 0.9187).abs() < 1e-4);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 ≤ `damping` < 1 and every period is positive and needs at
    /// most 10⁹ substeps; [`Error::Stopped`](crate::Error::Stopped) by the observer.
    pub fn response_spectrum(
        &self,
        periods: &[f64],
        damping: f64,
        observer: &mut Observer<'_>,
    ) -> Result<Vec<SpectralOrdinate>> {
        let total = self.len().saturating_mul(periods.len());
        let progress = &mut ProgressReporter::new("response spectrum", total, observer);
        damping_ratio("damping ratio of a response spectrum", damping)?;
        let mut spectrum = Vec::with_capacity(periods.len());
        for (number, &period) in periods.iter().enumerate() {
            let mut report = |sample: usize| progress.reach(self.len() * number + sample);
            spectrum.push(self.spectral_ordinate(period, damping, &mut report)?);
            report(self.len())?;
        }
        Ok(spectrum)
    }

    /// Response of one oscillator.
    ///
    /// After each block of substeps it calls `report` with the number of samples done.
    fn spectral_ordinate(
        &self,
        period: f64,
        damping: f64,
        report: &mut dyn FnMut(usize) -> Result<()>,
    ) -> Result<SpectralOrdinate> {
        positive("period of a response spectrum", period)?;
        let substeps = (SUBSTEPS_PER_PERIOD * self.time_step() / period).ceil().max(1.0);
        let frequency = std::f64::consts::TAU / period;
        let total = substeps * (self.len() as f64 + period / self.time_step());
        let is_possible = total < MAX_SUBSTEPS && (frequency * frequency).is_finite();
        let needed = "neither so short nor so long that 1e9 substeps would not do";
        require("period of a response spectrum", period, is_possible, needed)?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 1e9")]
        let substeps = substeps as usize;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 1e9")]
        let free_steps = (period / self.time_step()).ceil() as usize;
        let mut march = OscillatorMarch {
            oscillator: Oscillator::new(frequency, damping, self.time_step() / substeps as f64),
            substeps,
            substeps_done: 0,
            motion: RelativeMotion { displacement: 0.0, velocity: 0.0 },
            max_displacement: 0.0,
            max_acceleration: 0.0,
        };
        for (sample, pair) in self.accelerations().windows(2).enumerate() {
            march.step(pair[0], pair[1] - pair[0], &mut || report(sample))?;
        }
        for _ in 0..free_steps {
            march.step(0.0, 0.0, &mut || report(self.len()))?;
        }
        let displacement = march.max_displacement;
        Ok(SpectralOrdinate {
            period,
            displacement,
            pseudo_velocity: frequency * displacement,
            pseudo_acceleration: frequency * frequency * displacement,
            acceleration: march.max_acceleration,
        })
    }
}

/// Motion of an oscillator through a record, and its largest responses so far.
struct OscillatorMarch {
    oscillator: Oscillator,
    /// Number of substeps in a time step of the record.
    substeps: usize,
    substeps_done: usize,
    motion: RelativeMotion,
    max_displacement: f64,
    max_acceleration: f64,
}

impl OscillatorMarch {
    /// Advances by one time step, in which the ground's acceleration grows from `ground` by `growth`.
    fn step(
        &mut self,
        ground: f64,
        growth: f64,
        report: &mut dyn FnMut() -> Result<()>,
    ) -> Result<()> {
        let oscillator = &self.oscillator;
        let substep_growth = growth / self.substeps as f64;
        for k in 0..self.substeps {
            self.substeps_done += 1;
            if self.substeps_done.is_multiple_of(SUBSTEPS_PER_REPORT) {
                report()?;
            }
            let ground_at_start = ground + growth * (k as f64 / self.substeps as f64);
            let ground_at_end = ground_at_start + substep_growth;
            let next = oscillator.next(self.motion, ground_at_start, substep_growth);
            let displacements = [self.motion, next]
                .map(|motion| [motion.displacement, oscillator.step * motion.velocity]);
            let accelerations = [
                oscillator.total_acceleration(self.motion, ground_at_start),
                oscillator.total_acceleration(next, ground_at_end),
            ];
            self.max_displacement = self.max_displacement.max(max_of_cubic(displacements));
            self.max_acceleration = self.max_acceleration.max(max_of_cubic(accelerations));
            self.motion = next;
        }
        Ok(())
    }
}

/// Motion of an oscillator relative to the ground.
#[derive(Clone, Copy)]
struct RelativeMotion {
    displacement: f64,
    velocity: f64,
}

/// Exact recurrence over one substep.
struct Oscillator {
    frequency: f64,
    damping: f64,
    /// Substep h, s.
    step: f64,
    /// e^{−ζωh} cos ω_d h.
    cosine: f64,
    /// e^{−ζωh} sin(ω_d h)/ω_d.
    sine: f64,
}

impl Oscillator {
    fn new(frequency: f64, damping: f64, step: f64) -> Self {
        let damped = frequency * (1.0 - damping * damping).sqrt();
        let decay = (-damping * frequency * step).exp();
        let cosine = decay * (damped * step).cos();
        let sine = decay * (damped * step).sin() / damped;
        Self { frequency, damping, step, cosine, sine }
    }

    /// Motion a substep later; the ground's acceleration is `ground` now and grows by `growth`.
    fn next(&self, motion: RelativeMotion, ground: f64, growth: f64) -> RelativeMotion {
        let Self { frequency, damping, step, cosine, sine } = *self;
        let square = frequency * frequency;
        let half_width = damping * frequency;
        // Particular solution u = p + q t of the linear load, and the vibration about it.
        let q = -growth / step / square;
        let p = -ground / square - 2.0 * damping * q / frequency;
        let u = motion.displacement - p;
        let v = motion.velocity - q;
        let damped_velocity = v + half_width * u;
        let displacement = cosine * u + sine * damped_velocity;
        let velocity = cosine * v - sine * (half_width * v + square * u);
        RelativeMotion { displacement: displacement + p + q * step, velocity: velocity + q }
    }

    /// Total acceleration, and its rate times the substep.
    fn total_acceleration(&self, motion: RelativeMotion, ground: f64) -> [f64; 2] {
        let RelativeMotion { displacement: u, velocity: v } = motion;
        let square = self.frequency * self.frequency;
        let total = -square * u - 2.0 * self.damping * self.frequency * v;
        let relative = total - ground;
        [total, -self.step * (square * v + 2.0 * self.damping * self.frequency * relative)]
    }
}

/// Largest magnitude of a cubic over [0, 1].
///
/// The cubic has the values and slopes `[value, slope]` at its two ends.
fn max_of_cubic(ends: [[f64; 2]; 2]) -> f64 {
    let [[f0, s0], [f1, s1]] = ends;
    let at_ends = f0.abs().max(f1.abs());
    if s0 * s1 >= 0.0 {
        return at_ends;
    }
    // f = f0 + s0 x + b x² + c x³; one root of f' lies between.
    let b = 3.0 * (f1 - f0) - 2.0 * s0 - s1;
    let c = 2.0 * (f0 - f1) + s0 + s1;
    super::quadratic_roots_within(s0, 2.0 * b, 3.0 * c, 1.0)
        .into_iter()
        .flatten()
        .map(|x| (f0 + x * (s0 + x * (b + x * c))).abs())
        .fold(at_ends, f64::max)
}
