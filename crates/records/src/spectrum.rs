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

/// Smallest number of substeps in a period: peaks between substeps are then found to 2e-6.
const MIN_SUBSTEPS_PER_PERIOD: f64 = 40.0;
/// Largest number of substeps for one period, some seconds of work.
///
/// A period that needs more is an error.
const MAX_SUBSTEPS: f64 = 1e9;

/// Number of substeps between two reports of progress, some milliseconds of work.
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
///
/// Linear interpolation reduces a harmonic of ten time steps by 3 %.
const MIN_STEPS_PER_PERIOD: f64 = 10.0;

/// Relative excess of a number of time steps that is rounding of the period.
const PERIOD_ROUNDING: f64 = 1e-9;

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
        let min_period = MIN_STEPS_PER_PERIOD * time_step;
        write!(
            f,
            "below a period of {min_period:.3} s the spectrum is not exact, least of all at {period:.3} s: the record has fewer \
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
        let is_coarse = period < MIN_STEPS_PER_PERIOD * time_step * (1.0 - PERIOD_ROUNDING);
        is_coarse.then_some(CoarseSpectrum { period, time_step })
    }

    /// Elastic response spectrum at `periods` (s) with the damping ratio `damping`.
    ///
    /// The acceleration is linear between samples, for which the oscillator's motion is known exactly (Nigam &
    /// Jennings, "Calculation of response spectra from strong-motion earthquake records", Bull. Seism. Soc. Am. 59
    /// (1969), 909–922). Peaks between samples are found to 2e-6. Peaks of the free vibration in the period after the
    /// last sample count too. The spectrum of a floor's acceleration is a floor spectrum. [`Record::coarse_spectrum`]
    /// warns of periods that are too short for the record's time step. The observer's parts are samples of the record,
    /// counted again for every period.
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
        let part_count = self.len().saturating_mul(periods.len());
        let progress = &mut ProgressReporter::new("response spectrum", part_count, observer);
        damping_ratio("damping ratio of a response spectrum", damping)?;
        let mut spectrum = Vec::with_capacity(periods.len());
        for (period_index, &period) in periods.iter().enumerate() {
            let mut report = |sample: usize| progress.reach(self.len() * period_index + sample);
            spectrum.push(self.spectral_ordinate(period, damping, &mut report)?);
            report(self.len())?;
        }
        Ok(spectrum)
    }

    /// Largest responses of one oscillator.
    ///
    /// `report` is called after each block of substeps with the number of samples done.
    fn spectral_ordinate(
        &self,
        period: f64,
        damping: f64,
        report: &mut dyn FnMut(usize) -> Result<()>,
    ) -> Result<SpectralOrdinate> {
        positive("period of a response spectrum", period)?;
        let substep_ratio = (MIN_SUBSTEPS_PER_PERIOD * self.time_step() / period).ceil().max(1.0);
        let circular_frequency = std::f64::consts::TAU / period;
        let total_substeps = substep_ratio * (self.len() as f64 + period / self.time_step());
        let is_computable =
            total_substeps < MAX_SUBSTEPS && (circular_frequency * circular_frequency).is_finite();
        let needed = "a period that needs at most 1e9 substeps: neither too short nor too long";
        require("period of a response spectrum", period, is_computable, needed)?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 1e9")]
        let substeps_per_step = substep_ratio as usize;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 1e9")]
        let free_step_count = (period / self.time_step()).ceil() as usize;
        let mut response = OscillatorResponse {
            oscillator: Oscillator::new(
                circular_frequency,
                damping,
                self.time_step() / substeps_per_step as f64,
            ),
            substeps_per_step,
            substeps_done: 0,
            motion: RelativeMotion { displacement: 0.0, velocity: 0.0 },
            max_displacement: 0.0,
            max_acceleration: 0.0,
        };
        for (index, pair) in self.accelerations().windows(2).enumerate() {
            response.step(pair[0], pair[1] - pair[0], &mut || report(index))?;
        }
        for _ in 0..free_step_count {
            response.step(0.0, 0.0, &mut || report(self.len()))?;
        }
        let displacement = response.max_displacement;
        Ok(SpectralOrdinate {
            period,
            displacement,
            pseudo_velocity: circular_frequency * displacement,
            pseudo_acceleration: circular_frequency * circular_frequency * displacement,
            acceleration: response.max_acceleration,
        })
    }
}

/// Motion of an oscillator through a record, and its largest responses so far.
struct OscillatorResponse {
    oscillator: Oscillator,
    /// Number of substeps in a time step of the record.
    substeps_per_step: usize,
    /// Number of substeps so far.
    substeps_done: usize,
    motion: RelativeMotion,
    /// Largest relative displacement so far, m.
    max_displacement: f64,
    /// Largest total acceleration so far, m/s².
    max_acceleration: f64,
}

impl OscillatorResponse {
    /// Advances by one time step of the record.
    ///
    /// The ground's acceleration is `ground_acceleration` (m/s²) at the start of the step, and grows linearly by
    /// `acceleration_growth`.
    fn step(
        &mut self,
        ground_acceleration: f64,
        acceleration_growth: f64,
        report: &mut dyn FnMut() -> Result<()>,
    ) -> Result<()> {
        let oscillator = &self.oscillator;
        let substep_growth = acceleration_growth / self.substeps_per_step as f64;
        for k in 0..self.substeps_per_step {
            self.substeps_done += 1;
            if self.substeps_done.is_multiple_of(SUBSTEPS_PER_REPORT) {
                report()?;
            }
            let ground_at_start = ground_acceleration
                + acceleration_growth * (k as f64 / self.substeps_per_step as f64);
            let ground_at_end = ground_at_start + substep_growth;
            let next_motion = oscillator.next(self.motion, ground_at_start, substep_growth);
            let displacements = [self.motion, next_motion]
                .map(|motion| [motion.displacement, oscillator.substep * motion.velocity]);
            let accelerations = [
                oscillator.total_acceleration(self.motion, ground_at_start),
                oscillator.total_acceleration(next_motion, ground_at_end),
            ];
            self.max_displacement = self.max_displacement.max(max_of_cubic(displacements));
            self.max_acceleration = self.max_acceleration.max(max_of_cubic(accelerations));
            self.motion = next_motion;
        }
        Ok(())
    }
}

/// Motion of an oscillator relative to the ground.
#[derive(Clone, Copy)]
struct RelativeMotion {
    /// u, m.
    displacement: f64,
    /// v, m/s.
    velocity: f64,
}

/// Oscillator with the exact recurrence of its motion over one substep.
struct Oscillator {
    /// ω, rad/s.
    circular_frequency: f64,
    /// ζ.
    damping: f64,
    /// Substep h, s.
    substep: f64,
    /// e^{−ζωh} cos ω_d h.
    cosine: f64,
    /// e^{−ζωh} sin(ω_d h)/ω_d.
    sine: f64,
}

impl Oscillator {
    /// Oscillator of natural circular frequency (rad/s), damping ratio and substep (s).
    fn new(circular_frequency: f64, damping: f64, substep: f64) -> Self {
        let damped_frequency = circular_frequency * (1.0 - damping * damping).sqrt();
        let decay = (-damping * circular_frequency * substep).exp();
        let cosine = decay * (damped_frequency * substep).cos();
        let sine = decay * (damped_frequency * substep).sin() / damped_frequency;
        Self { circular_frequency, damping, substep, cosine, sine }
    }

    /// Motion one substep later.
    ///
    /// The ground's acceleration is `ground_acceleration` (m/s²) at the start of the substep, and grows linearly by
    /// `acceleration_growth`.
    fn next(
        &self,
        motion: RelativeMotion,
        ground_acceleration: f64,
        acceleration_growth: f64,
    ) -> RelativeMotion {
        let Self { circular_frequency, damping, substep, cosine, sine } = *self;
        let squared_frequency = circular_frequency * circular_frequency;
        let decay_rate = damping * circular_frequency;
        // Particular solution u = p + q t of the linear load, and the vibration about it.
        let q = -acceleration_growth / substep / squared_frequency;
        let p = -ground_acceleration / squared_frequency - 2.0 * damping * q / circular_frequency;
        let u = motion.displacement - p;
        let v = motion.velocity - q;
        let damped_velocity = v + decay_rate * u;
        let displacement = cosine * u + sine * damped_velocity;
        let velocity = cosine * v - sine * (decay_rate * v + squared_frequency * u);
        RelativeMotion { displacement: displacement + p + q * substep, velocity: velocity + q }
    }

    /// Total acceleration, and its rate times the substep.
    fn total_acceleration(&self, motion: RelativeMotion, ground_acceleration: f64) -> [f64; 2] {
        let RelativeMotion { displacement: u, velocity: v } = motion;
        let squared_frequency = self.circular_frequency * self.circular_frequency;
        let total_acceleration =
            -squared_frequency * u - 2.0 * self.damping * self.circular_frequency * v;
        let relative_acceleration = total_acceleration - ground_acceleration;
        [
            total_acceleration,
            -self.substep
                * (squared_frequency * v
                    + 2.0 * self.damping * self.circular_frequency * relative_acceleration),
        ]
    }
}

/// Largest magnitude of a cubic over [0, 1].
///
/// The cubic has the values and slopes `[value, slope]` at its two ends.
fn max_of_cubic(ends: [[f64; 2]; 2]) -> f64 {
    let [[f0, s0], [f1, s1]] = ends;
    let max_of_ends = f0.abs().max(f1.abs());
    if s0 * s1 >= 0.0 {
        return max_of_ends;
    }
    // f = f0 + s0 x + b x² + c x³ has an extreme between the ends, since its slopes there differ in sign.
    let b = 3.0 * (f1 - f0) - 2.0 * s0 - s1;
    let c = 2.0 * (f0 - f1) + s0 + s1;
    super::quadratic_roots_within(s0, 2.0 * b, 3.0 * c, 1.0)
        .into_iter()
        .flatten()
        .map(|x| (f0 + x * (s0 + x * (b + x * c))).abs())
        .fold(max_of_ends, f64::max)
}
