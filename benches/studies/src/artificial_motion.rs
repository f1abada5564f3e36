//! Artificial ground motions: filtered noise from a seed, the same in every run.

use std::f64::consts::TAU;

use basemat::Result;
use basemat::motion::Record;
use basemat_problems::random::Random;
use basemat_problems::series::whole;

/// Step, length (s), and damping of the ground's filter.
const STEP: f64 = 0.005;
const LENGTH: f64 = 20.0;
const DAMPING: f64 = 0.6;
/// Frequency (Hz) below which the motion is taken off, so that it ends near rest.
const LOWEST: f64 = 0.15;
/// Rise and end of the strong part, s; decay afterwards, 1/s.
const STRONG: [f64; 2] = [2.0, 8.0];
const DECAY: f64 = 0.35;

/// Noise of `seed` through the ground's filter at `frequency` (Hz) and a high-pass filter (Kanai–Tajimi with the factor of
/// Clough and Penzien), under an envelope; peak 1 m/s².
pub(crate) fn artificial_motion(frequency: f64, seed: u64) -> Result<Record> {
    let mut random = Random(seed);
    let mut ground = Oscillator::new(TAU * frequency);
    let mut high_pass = Oscillator::new(TAU * LOWEST);
    let samples: Vec<f64> = (0..=whole(LENGTH / STEP))
        .map(|k| {
            let time = k as f64 * STEP;
            let envelope =
                (time / STRONG[0]).min(1.0).powi(2) * (-DECAY * (time - STRONG[1]).max(0.0)).exp();
            // Nearly normal: a sum of twelve uniform numbers.
            let noise: f64 = (0..12).map(|_| random.within(-0.5, 0.5)).sum();
            let surface = ground.total_acceleration(envelope * noise);
            high_pass.relative_acceleration(surface)
        })
        .collect();
    Record::new(STEP, samples)?.scaled_to_peak(1.0)
}

/// Oscillator on a base that accelerates, by semi-implicit steps.
struct Oscillator {
    rate: f64,
    displacement: f64,
    velocity: f64,
}

impl Oscillator {
    fn new(rate: f64) -> Self {
        Self { rate, displacement: 0.0, velocity: 0.0 }
    }

    /// Acceleration relative to the base.
    fn relative_acceleration(&mut self, base: f64) -> f64 {
        self.total_acceleration(base) - base
    }

    fn total_acceleration(&mut self, base: f64) -> f64 {
        let total =
            -2.0 * DAMPING * self.rate * self.velocity - self.rate * self.rate * self.displacement;
        self.velocity += STEP * (total - base);
        self.displacement += STEP * self.velocity;
        total
    }
}
