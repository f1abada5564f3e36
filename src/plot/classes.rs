//! Classes of values and their colours.

use super::drawing::is_drawable;
use super::key::KeySample;
use super::ticks::{mark_text, rounded_step};
use plotters::style::RGBColor;

/// Approximate number of classes from zero to the value of largest magnitude, unless a picture sets another number.
const CLASS_COUNT: f64 = 6.0;
/// Excess over the end of a class that is rounding, relative to the width of a class.
///
/// A mobilised strength of 1 + 10⁻¹⁶, for example, needs no class above 1.
const CLASS_ROUNDING: f64 = 1e-9;
/// Colour of zero, as red, green and blue.
const ZERO_COLOR: [f64; 3] = [250.0, 240.0, 222.0];
/// Colours of values above zero: of the middle of the classes, and of the largest value.
///
/// Two hues make ten classes distinct.
const POSITIVE_COLORS: [[f64; 3]; 2] = [[242.0, 150.0, 80.0], [150.0, 20.0, 30.0]];
/// Colours of values below zero: of the middle of the classes, and of the most negative value.
const NEGATIVE_COLORS: [[f64; 3]; 2] = [[115.0, 180.0, 215.0], [20.0, 60.0, 140.0]];

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
        Self::with_count(ends, CLASS_COUNT)
    }

    /// Classes as by [`Classes::between`], with about `count` of them up to the largest magnitude.
    pub(super) fn with_count(ends: [f64; 2], count: f64) -> Self {
        let ends = ends.map(|end| if is_drawable(end) { end } else { 0.0 });
        let max_magnitude = ends[1].max(-ends[0]);
        let step = rounded_step(if max_magnitude > 0.0 { max_magnitude } else { 1.0 } / count);
        let negative_count = (-ends[0] / step - CLASS_ROUNDING).ceil().max(0.0);
        let mut positive_count = (ends[1] / step - CLASS_ROUNDING).ceil().max(0.0);
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
        if class < 0.0 {
            mixed_color(NEGATIVE_COLORS, -class / max_count)
        } else if class.is_nan() {
            mixed_color(POSITIVE_COLORS, 0.0)
        } else {
            mixed_color(POSITIVE_COLORS, class / (max_count - 1.0).max(1.0))
        }
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

/// Colour at a ratio: from the colour of zero at 0, through `middle_color`, to `end_color` at 1.
fn mixed_color([middle_color, end_color]: [[f64; 3]; 2], ratio: f64) -> RGBColor {
    let is_pale = ratio < 0.5;
    let start = if is_pale { ZERO_COLOR } else { middle_color };
    let end = if is_pale { middle_color } else { end_color };
    let fraction = if is_pale { 2.0 * ratio } else { 2.0 * ratio - 1.0 };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let [red, green, blue] = [0, 1, 2].map(|k| (start[k] + fraction * (end[k] - start[k])) as u8);
    RGBColor(red, green, blue)
}
