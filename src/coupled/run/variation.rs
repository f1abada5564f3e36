//! Rate at which a series varies, and the ground's motion between steps.

use std::f64::consts::PI;
use std::ops::Range;

use crate::bem::Ground;
use crate::geometry::{COMPONENTS_IN_SPACE, ContactElement, ContactLayout};
use crate::motion::FreeField;

/// Largest r if the structure vibrates with a period of its own.
pub(crate) const OWN: f64 = 0.25;
/// Squared difference of the free field between the ends of the base, relative to its square, that shows running
/// waves.
const RUNNING: f64 = 0.1;
/// Largest ratio of r at half a distance to r at the distance, where samples follow the motion: it is near a half.
const CONSISTENT_RATIO: f64 = 0.75;
/// Number of instants at which the ground is sampled, and how often their distance is halved.
const INSTANTS: usize = 256;
const HALVINGS: usize = 12;

/// Sums of squares of the changes and of the sums of neighbouring samples.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Variation {
    pub(crate) changes: f64,
    pub(crate) sums: f64,
}

impl Variation {
    pub(crate) fn see(&mut self, before: f64, after: f64) {
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
        let interval = (self.times.end - start) / INSTANTS as f64;
        (0..INSTANTS).map(move |instant| start + (instant as f64 + 0.5) * interval)
    }

    /// Whether the free field differs between the first element and the last.
    pub(crate) fn is_running(&self) -> bool {
        let elements = self.ground.elements();
        let count = elements.len();
        // Walls of a base do not count.
        let [_, floor, _] = ContactElement::faces(elements);
        let layout = ContactLayout::for_elements(elements);
        let mut field = vec![0.0; layout.len()];
        let [mut difference, mut sum] = [0.0; 2];
        for time in self.instants() {
            self.ground.free_field(self.motion, time, &mut field);
            for component in field.chunks_exact(count) {
                let (first, last) = (component[floor.start], component[floor.end - 1]);
                difference += (last - first).powi(2);
                sum += 0.5 * (first * first + last * last);
            }
        }
        difference > RUNNING * sum
    }

    /// Frequency of the ground's acceleration under the middle element, Hz.
    pub(crate) fn frequency(&self) -> Option<f64> {
        let mut distance = 0.5 * self.time_step;
        let mut ratio = self.ratio(distance);
        for _ in 1..HALVINGS {
            let halved = self.ratio(0.5 * distance);
            // Samples one period apart vary slowly, and those half as far apart do not.
            if ratio <= OWN && halved <= CONSISTENT_RATIO * ratio {
                return Some(ratio / (PI * distance));
            }
            (distance, ratio) = (0.5 * distance, halved);
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
            let mut at = |k: f64| {
                self.ground.free_field(self.motion, time + k * distance, &mut field);
                std::array::from_fn(|k| field.get(layout.place(k, count / 2)).copied())
                    .map(|value| value.unwrap_or(0.0))
            };
            let samples: [[f64; COMPONENTS_IN_SPACE]; 4] = [at(-1.5), at(-0.5), at(0.5), at(1.5)];
            for k in 0..layout.components() {
                let [before, after] =
                    [0, 1].map(|j| samples[j + 2][k] - 2.0 * samples[j + 1][k] + samples[j][k]);
                variation.see(before, after);
            }
        }
        variation.ratio()
    }
}
