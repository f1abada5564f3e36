//! Classes of values and their colours.

use super::drawing::is_drawable;
use super::key::KeySample;
use super::ticks::{mark_text, rounded_step};
use plotters::style::RGBColor;

/// Approximate number of classes from zero to the value of largest magnitude.
const CLASS_COUNT: f64 = 6.0;
/// Colour of zero, as red, green and blue.
const ZERO_COLOR: [f64; 3] = [250.0, 240.0, 222.0];
/// Colour of the largest value.
const POSITIVE_COLOR: [f64; 3] = [150.0, 20.0, 30.0];
/// Colour of the most negative value.
const NEGATIVE_COLOR: [f64; 3] = [20.0, 60.0, 140.0];

/// Classes of equal width on both sides of zero.
pub(super) struct Classes {
    /// Width of a class.
    step: f64,
    /// Number of classes below zero.
    negative_count: f64,
    /// Number of classes above zero.
    positive_count: f64,
}

impl Classes {
    /// Classes from the lowest value, at most zero, to the highest value, at least zero.
    pub(super) fn between(ends: [f64; 2]) -> Self {
        let ends = ends.map(|end| if is_drawable(end) { end } else { 0.0 });
        let max_magnitude = ends[1].max(-ends[0]);
        let step =
            rounded_step(if max_magnitude > 0.0 { max_magnitude } else { 1.0 } / CLASS_COUNT);
        let negative_count = (-ends[0] / step).ceil().max(0.0);
        let mut positive_count = (ends[1] / step).ceil().max(0.0);
        // Values of zero need a class.
        if negative_count <= 0.0 {
            positive_count = positive_count.max(1.0);
        }
        Self { step, negative_count, positive_count }
    }

    /// The colour of a value; a value outside the classes has the colour of the nearest class.
    pub(super) fn color(&self, value: f64) -> RGBColor {
        let class = (value / self.step)
            .floor()
            .clamp(-self.negative_count, (self.positive_count - 1.0).max(-1.0));
        let max_count = self.positive_count.max(self.negative_count);
        let (ratio, end_color) = if class < 0.0 {
            (-class / max_count, NEGATIVE_COLOR)
        } else if class.is_nan() {
            (0.0, POSITIVE_COLOR)
        } else {
            (class / (max_count - 1.0).max(1.0), POSITIVE_COLOR)
        };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
        let [red, green, blue] =
            [0, 1, 2].map(|k| (ZERO_COLOR[k] + ratio * (end_color[k] - ZERO_COLOR[k])) as u8);
        RGBColor(red, green, blue)
    }

    /// Names of the classes, times `factor` and with a `unit`, with their colours, the largest first.
    pub(super) fn key(&self, factor: f64, unit: &str) -> Vec<(String, KeySample)> {
        let step = factor * self.step;
        let mut key = Vec::new();
        let mut class = self.positive_count - 1.0;
        while class >= -self.negative_count {
            let lower_end = mark_text(step * class, step);
            let upper_end = mark_text(step * (class + 1.0), step);
            let color = self.color((class + 0.5) * self.step);
            key.push((format!("{lower_end} to {upper_end}{unit}"), KeySample::Area(color)));
            class -= 1.0;
        }
        key
    }
}
