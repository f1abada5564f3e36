//! Artificial ground motions: filtered noise from a seed, the same in every run.

use std::f64::consts::TAU;

use basemat::Result;
use basemat::motion::Record;
use basemat_problems::random::Random;
use basemat_problems::series::nearest_integer;

/// Time step and duration of a record, s; damping ratio of the ground's filter.
const TIME_STEP: f64 = 0.005;
const RECORD_DURATION: f64 = 20.0;
const FILTER_DAMPING: f64 = 0.6;
/// Frequency (Hz) of the high-pass filter; the motion ends near rest.
const LOWEST_FREQUENCY: f64 = 0.15;
/// Begin and end of the strong part, s; decay afterwards, 1/s.
const STRONG_PART_BEGIN: f64 = 2.0;
const STRONG_PART_END: f64 = 8.0;
const DECAY_RATE: f64 = 0.35;

/// Noise of `seed` through the ground's filter at `frequency` (Hz) and a high-pass filter (Kanai–Tajimi with the factor of
/// Clough and Penzien), under an envelope; peak 1 m/s².
pub(crate) fn artificial_motion(frequency: f64, seed: u64) -> Result<Record> {
    let mut random = Random(seed);
    let mut ground = FilterOscillator::new(TAU * frequency);
    let mut high_pass = FilterOscillator::new(TAU * LOWEST_FREQUENCY);
    let samples: Vec<f64> = (0..=nearest_integer(RECORD_DURATION / TIME_STEP))
        .map(|k| {
            let time = k as f64 * TIME_STEP;
            let envelope = (time / STRONG_PART_BEGIN).min(1.0).powi(2)
                * (-DECAY_RATE * (time - STRONG_PART_END).max(0.0)).exp();
            // Nearly normal: a sum of twelve uniform numbers.
            let noise: f64 = (0..12).map(|_| random.within(-0.5, 0.5)).sum();
            let surface = ground.total_acceleration(envelope * noise);
            high_pass.relative_acceleration(surface)
        })
        .collect();
    Record::new(TIME_STEP, samples)?.scaled_to_peak(1.0)
}

/// Oscillator on a base that accelerates, by semi-implicit steps.
struct FilterOscillator {
    rate: f64,
    displacement: f64,
    velocity: f64,
}

impl FilterOscillator {
    fn new(rate: f64) -> Self {
        Self { rate, displacement: 0.0, velocity: 0.0 }
    }

    /// Acceleration relative to the base.
    fn relative_acceleration(&mut self, base: f64) -> f64 {
        self.total_acceleration(base) - base
    }

    fn total_acceleration(&mut self, base: f64) -> f64 {
        let total = -2.0 * FILTER_DAMPING * self.rate * self.velocity
            - self.rate * self.rate * self.displacement;
        self.velocity += TIME_STEP * (total - base);
        self.displacement += TIME_STEP * self.velocity;
        total
    }
}
