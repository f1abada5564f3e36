//! Measured error of the exponentials against the exact coefficients of sampled pairs.

use super::tail::{MeasuredErrors, Tail};
use crate::error::Result;
use crate::history::convolution_weights::ConvolutionWeights;
use crate::history::pair_classes::STRIP_KINDS;

/// Number of lags checked per octave.
///
/// The trapezoidal rule's error oscillates with ln t. The number gives about two lags in a period of this oscillation, and
/// their phases do not repeat.
const CHECKED_LAGS_PER_OCTAVE: f64 = 7.3;
/// Largest number of pair classes checked; of more classes, evenly spaced ones are checked.
///
/// A sample is sufficient because the error is a polynomial in space.
const MAX_CHECKED_CLASSES: usize = 150;

/// Largest errors of the sampled coefficients at one lag.
#[derive(Default)]
struct LagErrors {
    /// Largest error, m/Pa.
    absolute_error: f64,
    /// Largest change of an error from this lag to the next, m/Pa.
    error_change: f64,
    /// Largest error relative to the largest coefficient of the same components.
    relative_error: f64,
    /// Largest coefficient, m/Pa.
    max_coefficient: f64,
}

/// Largest error and largest coefficient of the normal or of the tangential components, m/Pa.
#[derive(Clone, Copy, Default)]
struct ComponentErrors {
    max_error: f64,
    max_coefficient: f64,
}

impl MeasuredErrors {
    /// Measures the errors over the lags from `window` + 1 to `horizon`.
    pub(super) fn measure(
        kernel: &dyn ConvolutionWeights,
        tail: &Tail,
        window: usize,
        horizon: usize,
    ) -> Result<Self> {
        let pairs = SampledPairs::new(kernel);
        let mut lag = window + 1;
        let mut errors = pairs.errors_at(kernel, tail, lag, window)?;
        let mut measured_errors = Self {
            largest_relative: errors.relative_error,
            increment_sum: errors.absolute_error,
            last_coefficient: errors.max_coefficient,
        };
        while lag < horizon {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a lag")]
            let proposed_lag =
                (lag as f64 * (1.0 / CHECKED_LAGS_PER_OCTAVE).exp2()).ceil() as usize;
            let next_lag = proposed_lag.clamp(lag + 1, horizon.max(lag + 1));
            let next_errors = pairs.errors_at(kernel, tail, next_lag, window)?;
            measured_errors.increment_sum +=
                errors.error_change.max(next_errors.error_change) * (next_lag - lag) as f64;
            measured_errors.largest_relative =
                measured_errors.largest_relative.max(next_errors.relative_error);
            measured_errors.last_coefficient = next_errors.max_coefficient;
            lag = next_lag;
            errors = next_errors;
        }
        Ok(measured_errors)
    }
}

/// Indices of the pairs whose errors are measured, at most one for each class.
struct SampledPairs {
    pair_indices: Vec<usize>,
}

impl SampledPairs {
    fn new(kernel: &dyn ConvolutionWeights) -> Self {
        let mut first_pair = vec![None; kernel.classes().count()];
        for (pair_index, pair) in kernel.classes().pairs().iter().enumerate() {
            first_pair[pair.class].get_or_insert(pair_index);
        }
        let class_stride = kernel.classes().count().div_ceil(MAX_CHECKED_CLASSES);
        let mut pair_indices = vec![];
        for (k, pair_index) in first_pair.iter().flatten().enumerate() {
            if k % class_stride == 0 || k + 1 == first_pair.len() {
                pair_indices.push(*pair_index);
            }
        }
        Self { pair_indices }
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
        let fits = [tail.pole_sums_at_age(age), tail.pole_sums_at_age(age + 1.0)];
        let mut errors = LagErrors::default();
        // Errors of the normal and of the tangential components.
        let mut components = [ComponentErrors::default(); 2];
        for &pair_index in &self.pair_indices {
            let pair = kernel.classes().pairs()[pair_index];
            let receiver = pair_index / count;
            let source = pair_index % count;
            let mut exact_values = [[0.0; 2]; STRIP_KINDS];
            let mut slices = exact_values.each_mut().map(<[f64; 2]>::as_mut_slice);
            kernel.coefficients(pair.class, lag, &mut slices)?;
            for (kind, (exact, component)) in exact_values.iter().zip(&mut components).enumerate() {
                let error = [0, 1].map(|k| {
                    pair.scale * (tail.pair_integral(&fits[k][kind], receiver, source) - exact[k])
                });
                component.max_error = component.max_error.max(error[0].abs());
                let coefficient = (pair.scale * exact[0]).abs();
                component.max_coefficient = component.max_coefficient.max(coefficient);
                errors.error_change = errors.error_change.max((error[1] - error[0]).abs());
            }
        }
        for ComponentErrors { max_error, max_coefficient } in components {
            errors.absolute_error = errors.absolute_error.max(max_error);
            errors.max_coefficient = errors.max_coefficient.max(max_coefficient);
            errors.relative_error = errors.relative_error.max(max_error / max_coefficient);
        }
        Ok(errors)
    }
}
