//! Ratio r of a series, which measures its frequency, and samples of the ground between steps.
//!
//! The module [`resolution`](super::resolution) defines r.

use std::f64::consts::PI;
use std::ops::Range;

use crate::bem::Ground;
use crate::geometry::{COMPONENTS_IN_SPACE, ContactElement, ContactLayout};
use crate::motion::FreeField;

/// Largest r if the structure vibrates freely, with a longer period than the ground.
pub(crate) const MAX_FREE_VIBRATION_RATIO: f64 = 0.25;
/// Squared difference of the free field at which waves run along the base.
///
/// It is the difference between the ends of the base, relative to the square of the free field.
const RUNNING_WAVE_THRESHOLD: f64 = 0.1;
/// Largest ratio of r for half the sample interval to r, of samples that resolve the motion.
///
/// For resolved motions the ratio is near a half.
const MAX_HALVING_RATIO: f64 = 0.75;
/// Number of instants at which the ground is sampled.
const SAMPLED_INSTANT_COUNT: usize = 256;
/// Largest number of sample intervals, each half of the previous one.
const MAX_SAMPLE_INTERVALS: usize = 12;

/// Sums of a series from which its ratio r follows.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Variation {
    /// Sum of the squared differences of neighbouring samples.
    pub(crate) changes: f64,
    /// Sum of the squared sums of neighbouring samples.
    pub(crate) sums: f64,
}

impl Variation {
    /// Adds a pair of neighbouring samples.
    pub(crate) fn update(&mut self, sample: f64, next_sample: f64) {
        self.changes += (next_sample - sample).powi(2);
        self.sums += (next_sample + sample).powi(2);
    }

    /// The ratio r; NaN for a series of zeros.
    pub(crate) fn ratio(self) -> f64 {
        (self.changes / self.sums).sqrt()
    }
}

/// The ground's motion at instants spread over a run.
pub(crate) struct Sampler<'a> {
    pub(crate) ground: &'a dyn Ground,
    pub(crate) motion: &'a dyn FreeField,
    pub(crate) times: Range<f64>,
    pub(crate) time_step: f64,
}

impl Sampler<'_> {
    /// Instants spread evenly over the run, independent of the time step.
    fn instants(&self) -> impl Iterator<Item = f64> {
        let start = self.times.start;
        let interval = (self.times.end - start) / SAMPLED_INSTANT_COUNT as f64;
        (0..SAMPLED_INSTANT_COUNT).map(move |instant| start + (instant as f64 + 0.5) * interval)
    }

    /// Whether the free field differs between the first element and the last.
    pub(crate) fn has_running_waves(&self) -> bool {
        let elements = self.ground.elements();
        let element_count = elements.len();
        // Motion differs between walls and floor without any waves along the base.
        let floor = ContactElement::faces(elements).floor;
        let layout = ContactLayout::for_elements(elements);
        let mut field = vec![0.0; layout.len()];
        let mut squared_difference = 0.0;
        let mut mean_square = 0.0;
        for time in self.instants() {
            self.ground.free_field(self.motion, time, &mut field);
            for component in field.chunks_exact(element_count) {
                let left_value = component[floor.start];
                let right_value = component[floor.end - 1];
                squared_difference += (right_value - left_value).powi(2);
                mean_square += 0.5 * (left_value * left_value + right_value * right_value);
            }
        }
        squared_difference > RUNNING_WAVE_THRESHOLD * mean_square
    }

    /// Frequency of the ground's acceleration under the middle element, Hz.
    pub(crate) fn frequency(&self) -> Option<f64> {
        let mut interval = 0.5 * self.time_step;
        let mut ratio = self.acceleration_ratio(interval);
        for _ in 1..MAX_SAMPLE_INTERVALS {
            let halved_ratio = self.acceleration_ratio(0.5 * interval);
            // Samples at intervals of one period may vary slowly, but samples at half this interval do not.
            if ratio <= MAX_FREE_VIBRATION_RATIO && halved_ratio <= MAX_HALVING_RATIO * ratio {
                return Some(ratio / (PI * interval));
            }
            interval *= 0.5;
            ratio = halved_ratio;
        }
        None
    }

    /// Ratio r of the ground's acceleration under the middle element, from samples at this `interval`, s.
    fn acceleration_ratio(&self, interval: f64) -> f64 {
        let elements = self.ground.elements();
        let layout = ContactLayout::for_elements(elements);
        let mut field = vec![0.0; layout.len()];
        let mut variation = Variation::default();
        for time in self.instants() {
            let samples = [-1.5, -0.5, 0.5, 1.5].map(|shift| {
                self.ground.free_field(self.motion, time + shift * interval, &mut field);
                let sample: [f64; COMPONENTS_IN_SPACE] = std::array::from_fn(|k| {
                    field.get(layout.index_of(k, elements.len() / 2)).copied().unwrap_or(0.0)
                });
                sample
            });
            for k in 0..layout.components() {
                let difference = samples[2][k] - 2.0 * samples[1][k] + samples[0][k];
                let next_difference = samples[3][k] - 2.0 * samples[2][k] + samples[1][k];
                variation.update(difference, next_difference);
            }
        }
        variation.ratio()
    }
}
