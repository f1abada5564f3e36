//! Error of the exponentials against the exact coefficients of sampled pairs.

use super::tail::{MeasuredErrors, Tail};
use crate::error::Result;
use crate::history::convolution_weights::ConvolutionWeights;
use crate::history::pair_classes::STRIP_KINDS;

/// Number of lags checked per octave.
///
/// The trapezoidal rule's error oscillates with ln t: this is about two lags a period, at phases that do not repeat.
const CHECKED_LAGS_PER_OCTAVE: f64 = 7.3;
/// Largest number of pair classes checked; of more classes, an even sample.
///
/// The error is a polynomial in space.
const MAX_CHECKED_CLASSES: usize = 150;

/// Errors at one lag, their change to the next lag, and the largest coefficient.
struct LagErrors {
    error: f64,
    change: f64,
    relative: f64,
    largest: f64,
}

impl MeasuredErrors {
    /// Measures the errors over the lags from `window` + 1 to `horizon`.
    pub(super) fn over(
        kernel: &dyn ConvolutionWeights,
        tail: &Tail,
        window: usize,
        horizon: usize,
    ) -> Result<Self> {
        let pairs = SampledPairs::new(kernel);
        let mut lag = window + 1;
        let mut errors = pairs.errors_at(kernel, tail, lag, window)?;
        let mut found =
            Self { relative: errors.relative, increments: errors.error, last: errors.largest };
        while lag < horizon {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a lag")]
            let next = (lag as f64 * (1.0 / CHECKED_LAGS_PER_OCTAVE).exp2()).ceil() as usize;
            let next = next.clamp(lag + 1, horizon.max(lag + 1));
            let next_errors = pairs.errors_at(kernel, tail, next, window)?;
            found.increments += errors.change.max(next_errors.change) * (next - lag) as f64;
            found.relative = found.relative.max(next_errors.relative);
            found.last = next_errors.largest;
            lag = next;
            errors = next_errors;
        }
        Ok(found)
    }
}

/// Pairs of elements on which errors are measured.
///
/// They are places in the list of pairs, at most one for each class.
struct SampledPairs(Vec<usize>);

impl SampledPairs {
    fn new(kernel: &dyn ConvolutionWeights) -> Self {
        let mut first_pair = vec![None; kernel.classes().count()];
        for (place, pair) in kernel.classes().pairs().iter().enumerate() {
            first_pair[pair.class].get_or_insert(place);
        }
        let stride = kernel.classes().count().div_ceil(MAX_CHECKED_CLASSES);
        let places = first_pair.iter().flatten().copied().enumerate();
        let places =
            places.filter(|(k, _)| k % stride == 0 || k + 1 == first_pair.len()).map(|(_, at)| at);
        Self(places.collect())
    }

    /// Errors of the exponentials at a lag beyond the window.
    fn errors_at(
        &self,
        kernel: &dyn ConvolutionWeights,
        tail: &Tail,
        lag: usize,
        window: usize,
    ) -> Result<LagErrors> {
        let count = kernel.classes().elements().len();
        let age = (lag - window - 1) as f64;
        let fits = [tail.at_age(age), tail.at_age(age + 1.0)];
        let mut errors = LagErrors { error: 0.0, change: 0.0, relative: 0.0, largest: 0.0 };
        // Largest error and coefficient of the normal and of the tangential components.
        let mut worst = [[0.0_f64; 2]; 2];
        for &place in &self.0 {
            let pair = kernel.classes().pairs()[place];
            let receiver = place / count;
            let source = place % count;
            let mut exact = [[0.0; 2]; STRIP_KINDS];
            let slices = exact.each_mut().map(<[f64; 2]>::as_mut_slice);
            kernel.coefficients(pair.class, lag, slices)?;
            for (part, (exact, worst)) in exact.iter().zip(&mut worst).enumerate() {
                let error = [0, 1].map(|k| {
                    pair.scale * (tail.of_pair(&fits[k][part], receiver, source) - exact[k])
                });
                worst[0] = worst[0].max(error[0].abs());
                worst[1] = worst[1].max((pair.scale * exact[0]).abs());
                errors.change = errors.change.max((error[1] - error[0]).abs());
            }
        }
        for [error, largest] in worst {
            errors.error = errors.error.max(error);
            errors.largest = errors.largest.max(largest);
            errors.relative = errors.relative.max(error / largest);
        }
        Ok(errors)
    }
}
