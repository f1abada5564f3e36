//! Classes of values and their colours.

use super::axes::{drawable, nice};
use super::key::Sample;
use super::text_width::short;
use plotters::style::RGBColor;

/// Approximate number of classes from zero to the value of largest magnitude.
const CLASSES: f64 = 6.0;
/// Colours of zero, of the largest and of the least value.
const PALE: [f64; 3] = [250.0, 240.0, 222.0];
const DARK: [f64; 3] = [150.0, 20.0, 30.0];
const COLD: [f64; 3] = [20.0, 60.0, 140.0];

/// Classes of one width on both sides of zero.
pub(super) struct Classes {
    step: f64,
    /// Numbers of classes below and above zero.
    below: f64,
    above: f64,
}

impl Classes {
    /// Classes from the lowest value, at most zero, to the highest value, at least zero.
    pub(super) fn between(ends: [f64; 2]) -> Self {
        let [low, high] = ends.map(|end| if drawable(end) { end } else { 0.0 });
        let largest = high.max(-low);
        let step = nice(if largest > 0.0 { largest } else { 1.0 } / CLASSES);
        let [below, above] = [-low, high].map(|end| (end / step).ceil().max(0.0));
        // Zero has a class if nothing else has one.
        Self { step, below, above: if below > 0.0 { above } else { above.max(1.0) } }
    }

    /// The colour of a value; values beyond the classes have the colour of the next one.
    pub(super) fn color(&self, value: f64) -> RGBColor {
        let class = (value / self.step).floor().clamp(-self.below, (self.above - 1.0).max(-1.0));
        let most = self.above.max(self.below);
        let (ratio, end) = if class < 0.0 {
            (-class / most, COLD)
        } else if class.is_nan() {
            (0.0, DARK)
        } else {
            (class / (most - 1.0).max(1.0), DARK)
        };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
        let [red, green, blue] = [0, 1, 2].map(|k| (PALE[k] + ratio * (end[k] - PALE[k])) as u8);
        RGBColor(red, green, blue)
    }

    /// Names of the classes, times `factor` and with a `unit`, with their colours, the largest first.
    pub(super) fn key(&self, factor: f64, unit: &str) -> Vec<(String, Sample)> {
        let mut key = Vec::new();
        let mut class = self.above - 1.0;
        while class >= -self.below {
            let [from, to] = [class, class + 1.0].map(|limit| short(factor * self.step * limit));
            let color = self.color((class + 0.5) * self.step);
            key.push((format!("{from} to {to}{unit}"), Sample::Area(color)));
            class -= 1.0;
        }
        key
    }
}
