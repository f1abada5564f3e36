//! Free field whose vertical and horizontal components are out of phase.
//!
//! | symbol | meaning |
//! |---|---|
//! | v | velocity of the prescribed component, zero outside the record |
//! | V = H\[v\], W = ∫₀ᵗ V | Hilbert transform of v, and its integral: every harmonic is delayed by a quarter of a period |
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

/// Free field of a record and a second component out of phase with it, the same at all points.
///
/// The second component is a complex ratio times the record. The real part is in phase, the imaginary part a quarter of
/// a period late.
pub(super) struct OutOfPhase {
    /// Record of the prescribed component.
    record: Record,
    is_record_vertical: bool,
    component_ratio: Complex,
    delayed_motion: DelayedMotion,
}

impl OutOfPhase {
    /// Field of a record, and of the second component by its ratio to the record.
    pub(super) fn new(
        record: &Record,
        is_record_vertical: bool,
        component_ratio: Complex,
    ) -> Result<Self> {
        let delayed_motion = DelayedMotion::new(record)?;
        Ok(Self { record: record.clone(), is_record_vertical, component_ratio, delayed_motion })
    }

    /// Horizontal and vertical component of the field.
    ///
    /// `prescribed`: displacement or velocity of the record; `delayed`: the corresponding W or V.
    fn components(&self, prescribed_motion: f64, delayed_motion: f64) -> [f64; 2] {
        let other_motion =
            self.component_ratio.re * prescribed_motion + self.component_ratio.im * delayed_motion;
        if self.is_record_vertical {
            [other_motion, prescribed_motion]
        } else {
            [prescribed_motion, other_motion]
        }
    }
}

impl FreeField for OutOfPhase {
    fn displacement(&self, _x: f64, time: f64) -> [f64; 2] {
        self.components(
            self.record.at(time).displacement,
            self.delayed_motion.at(time).displacement,
        )
    }

    fn velocity(&self, _x: f64, time: f64) -> [f64; 2] {
        self.components(self.record.at(time).velocity, self.delayed_motion.at(time).velocity)
    }

    fn records(&self) -> Vec<&Record> {
        vec![&self.record]
    }
}

/// W and V at one time.
#[derive(Clone, Copy)]
struct DelayedValues {
    /// W, m.
    displacement: f64,
    /// V, m/s.
    velocity: f64,
}

/// The delayed motion, W and V, at any time.
///
/// W and V are sampled during the record, and for its length before and after. At other times they are computed from the
/// moments of the record.
struct DelayedMotion {
    /// Time step of the record, s.
    time_step: f64,
    /// Number of samples of the record.
    sample_count: usize,
    /// V at the samples of the record, and at as many times before the record and after it.
    velocities: Vec<f64>,
    /// W at the same times.
    displacements: Vec<f64>,
    /// Moments of the record's velocity.
    moments: Moments,
    /// Constants of integration before and after the samples, which make W continuous.
    integration_constants: [f64; 2],
}

impl DelayedMotion {
    /// Delayed motion of a record that ends at rest.
    fn new(record: &Record) -> Result<Self> {
        let needed = "at most 1 % of its peak for components out of phase (see Baseline)";
        check_rest_at_end(record, needed)?;
        Self::from_velocity(record.time_step(), record.velocities())
    }

    /// Delayed motion of two or more samples of velocity (m/s).
    fn from_velocity(time_step: f64, record_velocities: &[f64]) -> Result<Self> {
        let sample_count = record_velocities.len();
        // The velocity is transformed, not the acceleration: the integral of a transformed acceleration would not include
        // the part before t = 0.
        let velocities = hilbert(record_velocities, sample_count)?;
        let displacements = cumulative_integral(&velocities, time_step, sample_count);
        let moments = Moments::new(record_velocities);
        let integration_constants = [0, displacements.len() - 1].map(|k| {
            displacements[k]
                - time_step
                    * moments
                        .transform(k as f64 - sample_count as f64 - moments.half_length)
                        .velocity_integral
        });
        Ok(Self {
            time_step,
            sample_count,
            velocities,
            displacements,
            moments,
            integration_constants,
        })
    }

    /// W and V at a time (s).
    fn at(&self, time: f64) -> DelayedValues {
        let last_index = self.velocities.len() - 1;
        let position = time / self.time_step + self.sample_count as f64;
        if !(position >= 0.0 && position < last_index as f64) {
            return self.beyond_samples(time);
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0..last")]
        let k = position as usize;
        let x = position - k as f64;
        // Cubic interpolation of W, with the values of W and the slopes V at both samples.
        let ends = [k, k + 1].map(|sample| [self.displacements[sample], self.velocities[sample]]);
        let [displacement, velocity] = cubic_at(self.time_step, ends, x);
        DelayedValues { displacement, velocity }
    }

    /// W and V at a time (s) far from the record, from its moments.
    fn beyond_samples(&self, time: f64) -> DelayedValues {
        let constant = self.integration_constants[usize::from(time >= 0.0)];
        let transform = self.moments.transform(time / self.time_step - self.moments.half_length);
        DelayedValues {
            displacement: constant + self.time_step * transform.velocity_integral,
            velocity: transform.velocity,
        }
    }
}

/// Returns an error unless a record ends at rest.
pub(super) fn check_rest_at_end(record: &Record, needed: &'static str) -> Result<()> {
    let end_velocity = record.at(record.duration()).velocity;
    let is_at_rest = end_velocity.abs() <= MAX_END_VELOCITY_RATIO * record.peaks().velocity;
    require("velocity at the end of the record", end_velocity, is_at_rest, needed).map(drop)
}

/// Displacement (m) and velocity (m/s) on the cubic between two samples of both.
///
/// `ends`: displacement and velocity at each sample. `fraction`: position between the samples, from 0 to 1.
pub(super) fn cubic_at(time_step: f64, ends: [[f64; 2]; 2], fraction: f64) -> [f64; 2] {
    let [[w0, v0], [w1, v1]] = ends;
    let x = fraction;
    let slope = (w1 - w0) / time_step;
    let b = 3.0 * slope - 2.0 * v0 - v1;
    let c = v0 + v1 - 2.0 * slope;
    [w0 + time_step * x * (v0 + x * (b + x * c)), v0 + x * (2.0 * b + 3.0 * x * c)]
}

/// Hilbert transform of samples at one time.
#[derive(Clone, Copy)]
struct TransformValues {
    /// ∫V ds.
    velocity_integral: f64,
    /// V.
    velocity: f64,
}

/// Moments of a record, from which its transform far from the record is computed.
///
/// The distance to sample j is s (1 − q yⱼ), hence
///
/// V = 1/π Σ vⱼ / (s (1 − q yⱼ)) = 1/(π s) Σ Mₖ qᵏ,
/// ∫V ds = 1/π Σ vⱼ ln |s (1 − q yⱼ)| = 1/π (M₀ ln |s| − Σ Mₖ qᵏ / k), k > 0.
struct Moments {
    /// h, in samples.
    half_length: f64,
    /// M₀, M₁, ….
    values: [f64; MOMENT_COUNT],
}

impl Moments {
    /// Moments of two or more samples.
    fn new(samples: &[f64]) -> Self {
        let half_length = 0.5 * (samples.len() as f64 - 1.0);
        let mut values = [0.0; MOMENT_COUNT];
        for (j, &v) in samples.iter().enumerate() {
            let y = (j as f64 - half_length) / half_length;
            let mut term = v;
            for moment in &mut values {
                *moment += term;
                term *= y;
            }
        }
        Self { half_length, values }
    }

    /// Transform at `s`, in samples from the middle of the record; |s| > 3h.
    fn transform(&self, s: f64) -> TransformValues {
        let q = self.half_length / s;
        let [zeroth_moment, higher_moments @ ..] = &self.values;
        let mut velocity_series = 0.0;
        let mut integral_series = 0.0;
        for (k, moment) in higher_moments.iter().enumerate().rev() {
            velocity_series = q * (velocity_series + moment);
            integral_series = q * (integral_series + moment / (k + 1) as f64);
        }
        TransformValues {
            velocity_integral: (zeroth_moment * s.abs().ln() - integral_series) / PI,
            velocity: (zeroth_moment + velocity_series) / (PI * s),
        }
    }
}

/// Integral of samples, which is zero at the sample `zero_index`.
///
/// Each interval is integrated under the cubic through the four samples around it.
fn cumulative_integral(samples: &[f64], time_step: f64, zero_index: usize) -> Vec<f64> {
    let last_index = samples.len() - 1;
    let mut sums = Vec::with_capacity(samples.len());
    let mut sum = 0.0;
    sums.push(sum);
    for k in 0..last_index {
        let inner_sum = samples[k] + samples[k + 1];
        let is_at_end = k == 0 || k + 1 == last_index;
        let outer_sum = if is_at_end { inner_sum } else { samples[k - 1] + samples[k + 2] };
        sum += time_step * (13.0 * inner_sum - outer_sum) / 24.0;
        sums.push(sum);
    }
    let offset = sums[zero_index];
    for sum in &mut sums {
        *sum -= offset;
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
        let delayed_motion = DelayedMotion::new(&record).unwrap();
        let direct_transform = hilbert(record.displacements(), count).unwrap();
        let differences = delayed_motion
            .displacements
            .iter()
            .zip(&direct_transform)
            .map(|(w, u)| w - (u - direct_transform[count]));
        let max_difference =
            differences.fold(0.0_f64, |max_difference, d| max_difference.max(d.abs()));
        // The corners of the record are above the highest frequency of its samples, and the two methods treat them
        // differently; displacements are 0.2 m.
        assert!(max_difference < 1e-4, "{max_difference:e}");
    }

    /// The sums over all samples that the moments replace.
    fn direct_sums(delayed_motion: &DelayedMotion, source: &[f64], time: f64) -> [f64; 2] {
        let last_index = delayed_motion.velocities.len() - 1;
        let index = if time < 0.0 { 0 } else { last_index };
        let edge = index as f64 - source.len() as f64;
        let mut sums = [0.0; 2];
        for (j, v) in source.iter().enumerate() {
            let distance = time / delayed_motion.time_step - j as f64;
            sums[0] += v * (distance / (edge - j as f64)).ln();
            sums[1] += v / distance;
        }
        [
            delayed_motion.displacements[index] + delayed_motion.time_step * sums[0] / PI,
            sums[1] / PI,
        ]
    }

    fn peak(samples: &[f64]) -> f64 {
        samples.iter().fold(0.0_f64, |peak, sample| peak.max(sample.abs()))
    }

    #[test]
    fn moments_give_the_sums_over_all_samples() {
        let record = el_centro_1940().with_baseline(Baseline::RestToRest { degree: 4 }).unwrap();
        let velocities = record.velocities();
        let even_count = velocities.len() / 2 * 2;
        let mut ends = [0.0; 101];
        ends[0] = 1.0;
        ends[100] = -0.5;
        let sources = [
            &velocities[..even_count],
            &velocities[..even_count - 1],
            // Samples that are not zero only at the ends, where the series converge slowest; without and with a mean.
            &ends[..],
            &[1.0, -1.0][..],
            &[0.0, 1.0],
            &[1.0, 1.0],
            &[1.0, 0.0, 1.0],
            &[-0.3, 0.0, 0.0, 1.0],
        ];
        let step = record.time_step();
        for source in sources {
            let delayed_motion = DelayedMotion::from_velocity(step, source).unwrap();
            let peaks = [peak(&delayed_motion.displacements), peak(&delayed_motion.velocities)];
            let count = source.len() as f64;
            let last_index = delayed_motion.velocities.len() - 1;
            let edges = [-count * step, (last_index as f64 - count) * step];
            let distances = [0.0, 1e-9, 1e-3, 0.013, 0.3, 1.0, 7.7, 31.0, 62.5, 400.0, 1e4, 1e6];
            for (edge, side) in edges.into_iter().zip([-1.0, 1.0]) {
                for time in distances.map(|t| edge + side * t) {
                    let values = delayed_motion.beyond_samples(time);
                    let moments = [values.displacement, values.velocity];
                    let sums = direct_sums(&delayed_motion, source, time);
                    for ((a, b), peak) in moments.iter().zip(sums).zip(peaks) {
                        let n = source.len();
                        assert!((a - b).abs() <= 1e-13 * peak, "{n} at {time}: {a} {b} of {peak}");
                    }
                }
                // W continues from its last sample.
                let sample = delayed_motion.displacements[if side < 0.0 { 0 } else { last_index }];
                assert!(
                    (delayed_motion.beyond_samples(edge).displacement - sample).abs()
                        <= 1e-14 * peaks[0]
                );
            }
        }
    }

    /// W and V are continuous where the moments replace the samples, and V is the slope of W everywhere.
    #[test]
    fn samples_and_moments_agree_at_their_boundary() {
        let record = el_centro_1940().with_baseline(Baseline::RestToRest { degree: 4 }).unwrap();
        let delayed_motion = DelayedMotion::new(&record).unwrap();
        let count = record.len() as f64;
        for position in [-count, 2.0 * count - 1.0] {
            for side in [-1e-3, 1e-3] {
                let time = (position + side) * record.time_step();
                let inner_values = delayed_motion.at(time);
                let outer_values = delayed_motion.beyond_samples(time);
                assert!((inner_values.displacement - outer_values.displacement).abs() < 1e-9);
                assert!((inner_values.velocity - outer_values.velocity).abs() < 1e-9);
            }
        }
        for time in [-300.0, -40.0, -31.3, -5.005, -0.003, 0.507, 12.301, 40.0, 62.4, 63.0, 500.0] {
            let h = 1e-4;
            let slope = (delayed_motion.at(time + h).displacement
                - delayed_motion.at(time - h).displacement)
                / (2.0 * h);
            let velocity = delayed_motion.at(time).velocity;
            assert!((slope - velocity).abs() < 1e-6, "{time}: {slope} {velocity}");
        }
    }
}
