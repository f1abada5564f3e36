//! Ground motions whose components are out of phase.
//!
//! | symbol | meaning |
//! |---|---|
//! | v | velocity of the prescribed component, zero outside the record |
//! | V = H\[v\], W = ∫₀ᵗ V | velocity and displacement, every harmonic delayed by a quarter of a period |
//! | h, y | half of the record's length, and position from its middle as a fraction of h, −1 … 1 |
//! | s, q = h/s | time from the record's middle, in samples, and its inverse relative to h |
//! | Mₖ | moments Σ vⱼ yⱼᵏ of the record |

use std::f64::consts::PI;

use basemat_records::hilbert;

use super::{FreeField, Record};
use crate::error::{Result, require};
use crate::linalg::Complex;

/// Largest velocity at the end of a record, relative to its peak, that counts as rest.
const MAX_END_VELOCITY_RATIO: f64 = 0.01;

/// Number of moments of a record.
///
/// W and V are sampled up to (3n − 1)/2 samples from the middle of a record of n samples, h = (n − 1)/2. Beyond,
/// |q| < 1/3, and the neglected moments contribute less than 1.5 · 3⁻³² < 10⁻¹⁵.
const MOMENT_COUNT: usize = 32;

/// Free field of a record and a component out of phase with it, the same at all points.
///
/// The component is a complex `ratio` times the record: the real part is in phase, the imaginary part a quarter of
/// a period late.
pub(super) struct OutOfPhase {
    record: Record,
    record_is_vertical: bool,
    ratio: Complex,
    delayed: DelayedMotion,
}

impl OutOfPhase {
    pub(super) fn new(record: &Record, record_is_vertical: bool, ratio: Complex) -> Result<Self> {
        let delayed = DelayedMotion::new(record)?;
        Ok(Self { record: record.clone(), record_is_vertical, ratio, delayed })
    }

    /// Both components, from the component of the record and the delayed W or V.
    fn both(&self, prescribed: f64, delayed: f64) -> [f64; 2] {
        let other = self.ratio.re * prescribed + self.ratio.im * delayed;
        if self.record_is_vertical { [other, prescribed] } else { [prescribed, other] }
    }
}

impl FreeField for OutOfPhase {
    fn displacement(&self, _x: f64, time: f64) -> [f64; 2] {
        self.both(self.record.at(time).displacement, self.delayed.at(time)[0])
    }

    fn velocity(&self, _x: f64, time: f64) -> [f64; 2] {
        self.both(self.record.at(time).velocity, self.delayed.at(time)[1])
    }

    fn records(&self) -> Vec<&Record> {
        vec![&self.record]
    }
}

/// W and V at any time.
///
/// They are sampled during the record and for its length before and after. Beyond, where the record is far away,
/// they are computed from its moments.
struct DelayedMotion {
    step: f64,
    /// Number of samples of the record.
    count: usize,
    /// V at the samples of the record, and at as many times before the record and after it.
    velocity: Vec<f64>,
    /// W at the same times.
    displacement: Vec<f64>,
    moments: Moments,
    /// Constants of integration before and after the samples, which make W continuous.
    constants: [f64; 2],
}

impl DelayedMotion {
    fn new(record: &Record) -> Result<Self> {
        let end = record.at(record.duration()).velocity;
        let is_at_rest = end.abs() <= MAX_END_VELOCITY_RATIO * record.peaks().velocity;
        let needed = "at most 1 % of its peak for components out of phase (see Baseline)";
        require("velocity at the end of the record", end, is_at_rest, needed)?;
        Self::from_velocity(record.time_step(), record.velocities())
    }

    /// Transform of two or more samples of the record's velocity.
    fn from_velocity(step: f64, source: &[f64]) -> Result<Self> {
        let count = source.len();
        // Velocity and displacement, not acceleration, are transformed: integrals of a transformed acceleration
        // would miss its part before t = 0.
        let velocity = hilbert(source, count)?;
        let displacement = integral(&velocity, step, count);
        let moments = Moments::new(source);
        let constants = [0, displacement.len() - 1].map(|k| {
            displacement[k] - step * moments.transform(k as f64 - count as f64 - moments.half)[0]
        });
        Ok(Self { step, count, velocity, displacement, moments, constants })
    }

    /// `[W, V]`.
    fn at(&self, time: f64) -> [f64; 2] {
        let last = self.velocity.len() - 1;
        let position = time / self.step + self.count as f64;
        if !(position >= 0.0 && position < last as f64) {
            return self.beyond_samples(time);
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0..last")]
        let k = position as usize;
        let x = position - k as f64;
        // The cubic with these values and slopes.
        let w0 = self.displacement[k];
        let v0 = self.velocity[k];
        let v1 = self.velocity[k + 1];
        let slope = (self.displacement[k + 1] - w0) / self.step;
        let b = 3.0 * slope - 2.0 * v0 - v1;
        let c = v0 + v1 - 2.0 * slope;
        let displacement = w0 + self.step * x * (v0 + x * (b + x * c));
        [displacement, v0 + x * (2.0 * b + 3.0 * x * c)]
    }

    /// `[W, V]` at times where 1/(t − τ) hardly changes from sample to sample.
    fn beyond_samples(&self, time: f64) -> [f64; 2] {
        let constant = self.constants[usize::from(time >= 0.0)];
        let integrals = self.moments.transform(time / self.step - self.moments.half);
        [constant + self.step * integrals[0], integrals[1]]
    }
}

/// Moments of a record, which give its transform far from the record.
///
/// The distance to sample j is s (1 − q yⱼ), hence
///
/// V = 1/π Σ vⱼ / (s (1 − q yⱼ)) = 1/(π s) Σ Mₖ qᵏ,
/// ∫V ds = 1/π Σ vⱼ ln |s (1 − q yⱼ)| = 1/π (M₀ ln |s| − Σ Mₖ qᵏ / k), k > 0.
struct Moments {
    /// h, in samples.
    half: f64,
    values: [f64; MOMENT_COUNT],
}

impl Moments {
    /// Moments of two or more samples.
    fn new(source: &[f64]) -> Self {
        let half = 0.5 * (source.len() as f64 - 1.0);
        let mut values = [0.0; MOMENT_COUNT];
        for (j, &v) in source.iter().enumerate() {
            let y = (j as f64 - half) / half;
            let mut term = v;
            for moment in &mut values {
                *moment += term;
                term *= y;
            }
        }
        Self { half, values }
    }

    /// `[∫V ds, V]` at `s`, |s| > 3h.
    fn transform(&self, s: f64) -> [f64; 2] {
        let q = self.half / s;
        let [first, others @ ..] = &self.values;
        let mut series = 0.0;
        let mut primitive = 0.0;
        for (k, moment) in others.iter().enumerate().rev() {
            series = q * (series + moment);
            primitive = q * (primitive + moment / (k + 1) as f64);
        }
        [(first * s.abs().ln() - primitive) / PI, (first + series) / (PI * s)]
    }
}

/// Integral of samples from sample `zero` on; each interval under the cubic through four samples.
fn integral(samples: &[f64], step: f64, zero: usize) -> Vec<f64> {
    let last = samples.len() - 1;
    let mut sums = Vec::with_capacity(samples.len());
    let mut sum = 0.0;
    sums.push(sum);
    for k in 0..last {
        let inner = samples[k] + samples[k + 1];
        let is_at_end = k == 0 || k + 1 == last;
        let outer = if is_at_end { inner } else { samples[k - 1] + samples[k + 2] };
        sum += step * (13.0 * inner - outer) / 24.0;
        sums.push(sum);
    }
    let start = sums[zero];
    for sum in &mut sums {
        *sum -= start;
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Baseline, el_centro_1940};

    /// W, an integral of the transformed velocity, is the transformed displacement.
    #[test]
    fn displacement_is_the_transform_of_the_displacement() {
        let record = el_centro_1940().with_baseline(Baseline::RestToRest { degree: 4 }).unwrap();
        let count = record.len();
        let delayed = DelayedMotion::new(&record).unwrap();
        let direct = hilbert(record.displacements(), count).unwrap();
        let differences =
            delayed.displacement.iter().zip(&direct).map(|(w, u)| w - (u - direct[count]));
        let largest = differences.fold(0.0_f64, |largest, d| largest.max(d.abs()));
        // The corners of the record are above the highest frequency of its samples, and the two methods treat them
        // differently; displacements are 0.2 m.
        assert!(largest < 1e-4, "{largest:e}");
    }

    /// The sums over all samples that the moments replace.
    fn direct_sums(delayed: &DelayedMotion, source: &[f64], time: f64) -> [f64; 2] {
        let last = delayed.velocity.len() - 1;
        let index = if time < 0.0 { 0 } else { last };
        let edge = index as f64 - source.len() as f64;
        let mut sums = [0.0; 2];
        for (j, v) in source.iter().enumerate() {
            let distance = time / delayed.step - j as f64;
            sums[0] += v * (distance / (edge - j as f64)).ln();
            sums[1] += v / distance;
        }
        [delayed.displacement[index] + delayed.step * sums[0] / PI, sums[1] / PI]
    }

    fn peak(samples: &[f64]) -> f64 {
        samples.iter().fold(0.0_f64, |peak, sample| peak.max(sample.abs()))
    }

    #[test]
    fn moments_give_the_sums_over_all_samples() {
        let record = el_centro_1940().with_baseline(Baseline::RestToRest { degree: 4 }).unwrap();
        let velocities = record.velocities();
        let even = velocities.len() / 2 * 2;
        let mut ends = [0.0; 101];
        ends[0] = 1.0;
        ends[100] = -0.5;
        let sources = [
            &velocities[..even],
            &velocities[..even - 1],
            // All at the ends, where the series converge slowest; without and with a mean.
            &ends[..],
            &[1.0, -1.0][..],
            &[0.0, 1.0],
            &[1.0, 1.0],
            &[1.0, 0.0, 1.0],
            &[-0.3, 0.0, 0.0, 1.0],
        ];
        let step = record.time_step();
        for source in sources {
            let delayed = DelayedMotion::from_velocity(step, source).unwrap();
            let peaks = [peak(&delayed.displacement), peak(&delayed.velocity)];
            let count = source.len() as f64;
            let last = delayed.velocity.len() - 1;
            let edges = [-count * step, (last as f64 - count) * step];
            let beyond = [0.0, 1e-9, 1e-3, 0.013, 0.3, 1.0, 7.7, 31.0, 62.5, 400.0, 1e4, 1e6];
            for (edge, side) in edges.into_iter().zip([-1.0, 1.0]) {
                for time in beyond.map(|t| edge + side * t) {
                    let moments = delayed.beyond_samples(time);
                    let sums = direct_sums(&delayed, source, time);
                    for ((a, b), peak) in moments.iter().zip(sums).zip(peaks) {
                        let n = source.len();
                        assert!((a - b).abs() <= 1e-13 * peak, "{n} at {time}: {a} {b} of {peak}");
                    }
                }
                // W continues from its last sample.
                let sample = delayed.displacement[if side < 0.0 { 0 } else { last }];
                assert!((delayed.beyond_samples(edge)[0] - sample).abs() <= 1e-14 * peaks[0]);
            }
        }
    }

    /// GOAL: no seam where the moments take over, and V is the slope of W everywhere.
    #[test]
    fn far_and_near_meet() {
        let record = el_centro_1940().with_baseline(Baseline::RestToRest { degree: 4 }).unwrap();
        let delayed = DelayedMotion::new(&record).unwrap();
        let count = record.len() as f64;
        for position in [-count, 2.0 * count - 1.0] {
            for side in [-1e-3, 1e-3] {
                let time = (position + side) * record.time_step();
                let within = delayed.at(time);
                let beyond = delayed.beyond_samples(time);
                for k in [0, 1] {
                    assert!((within[k] - beyond[k]).abs() < 1e-9);
                }
            }
        }
        for time in [-300.0, -40.0, -31.3, -5.005, -0.003, 0.507, 12.301, 40.0, 62.4, 63.0, 500.0] {
            let h = 1e-4;
            let slope = (delayed.at(time + h)[0] - delayed.at(time - h)[0]) / (2.0 * h);
            let velocity = delayed.at(time)[1];
            assert!((slope - velocity).abs() < 1e-6, "{time}: {slope} {velocity}");
        }
    }
}
