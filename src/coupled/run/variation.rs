//! Rate at which a series varies, and the ground's motion between steps.

use std::f64::consts::PI;
use std::ops::Range;

use crate::bem::Ground;
use crate::geometry::{COMPONENTS_IN_SPACE, ContactElement, ContactLayout};
use crate::motion::FreeField;

/// Largest r if the structure vibrates freely, with another period than the ground.
pub(crate) const MAX_FREE_VIBRATION_RATIO: f64 = 0.25;
/// Squared difference of the free field between the ends of the base, relative to its square, that shows running
/// waves.
const RUNNING_WAVE_THRESHOLD: f64 = 0.1;
/// Largest ratio of r at half a distance to r at the distance, where samples follow the motion: it is near a half.
const CONSISTENT_RATIO: f64 = 0.75;
/// Number of instants at which the ground is sampled.
const SAMPLED_INSTANTS: usize = 256;
/// Largest number of distances between samples, each half of the one before.
const MAX_SAMPLE_DISTANCES: usize = 12;

/// Sums of squares of the changes and of the sums of neighbouring samples.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Variation {
    pub(crate) changes: f64,
    pub(crate) sums: f64,
}

impl Variation {
    /// Adds a pair of neighbouring samples.
    pub(crate) fn update(&mut self, before: f64, after: f64) {
        self.changes += (after - before).powi(2);
        self.sums += (after + before).powi(2);
    }

    /// r; NaN for a series of zeros.
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
    /// Instants spread over the run, whatever its steps.
    fn instants(&self) -> impl Iterator<Item = f64> {
        let start = self.times.start;
        let interval = (self.times.end - start) / SAMPLED_INSTANTS as f64;
        (0..SAMPLED_INSTANTS).map(move |instant| start + (instant as f64 + 0.5) * interval)
    }

    /// Whether the free field differs between the first element and the last.
    pub(crate) fn is_running(&self) -> bool {
        let elements = self.ground.elements();
        let count = elements.len();
        // Walls of a base do not count.
        let floor = ContactElement::faces(elements).floor;
        let layout = ContactLayout::for_elements(elements);
        let mut field = vec![0.0; layout.len()];
        let mut difference = 0.0;
        let mut sum = 0.0;
        for time in self.instants() {
            self.ground.free_field(self.motion, time, &mut field);
            for component in field.chunks_exact(count) {
                let first = component[floor.start];
                let last = component[floor.end - 1];
                difference += (last - first).powi(2);
                sum += 0.5 * (first * first + last * last);
            }
        }
        difference > RUNNING_WAVE_THRESHOLD * sum
    }

    /// Frequency of the ground's acceleration under the middle element, Hz.
    pub(crate) fn frequency(&self) -> Option<f64> {
        let mut distance = 0.5 * self.time_step;
        let mut ratio = self.ratio(distance);
        for _ in 1..MAX_SAMPLE_DISTANCES {
            let halved = self.ratio(0.5 * distance);
            // Samples one period apart vary slowly, and those half as far apart do not.
            if ratio <= MAX_FREE_VIBRATION_RATIO && halved <= CONSISTENT_RATIO * ratio {
                return Some(ratio / (PI * distance));
            }
            distance *= 0.5;
            ratio = halved;
        }
        None
    }

    /// r of the ground's acceleration under the middle element, in samples with this distance (s).
    fn ratio(&self, distance: f64) -> f64 {
        let count = self.ground.elements().len();
        let layout = ContactLayout::for_elements(self.ground.elements());
        let mut field = vec![0.0; layout.len()];
        let mut variation = Variation::default();
        for time in self.instants() {
            let samples = [-1.5, -0.5, 0.5, 1.5].map(|shift| {
                self.ground.free_field(self.motion, time + shift * distance, &mut field);
                let sample: [f64; COMPONENTS_IN_SPACE] = std::array::from_fn(|k| {
                    field.get(layout.place(k, count / 2)).copied().unwrap_or(0.0)
                });
                sample
            });
            for k in 0..layout.components() {
                let before = samples[2][k] - 2.0 * samples[1][k] + samples[0][k];
                let after = samples[3][k] - 2.0 * samples[2][k] + samples[1][k];
                variation.update(before, after);
            }
        }
        variation.ratio()
    }
}
