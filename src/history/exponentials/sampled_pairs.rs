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

/// Largest errors of the sampled coefficients at one lag.
#[derive(Default)]
struct LagErrors {
    /// m/Pa.
    absolute: f64,
    /// Change of an error from this lag to the next, m/Pa.
    change: f64,
    /// Relative to the largest coefficient of the same components.
    relative: f64,
    /// Largest coefficient, m/Pa.
    coefficient: f64,
}

/// Largest error and largest coefficient of the normal or of the tangential components, m/Pa.
#[derive(Clone, Copy, Default)]
struct ComponentErrors {
    error: f64,
    coefficient: f64,
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
        let mut measured = Self {
            largest_relative: errors.relative,
            increment_sum: errors.absolute,
            last_coefficient: errors.coefficient,
        };
        while lag < horizon {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a lag")]
            let next = (lag as f64 * (1.0 / CHECKED_LAGS_PER_OCTAVE).exp2()).ceil() as usize;
            let next = next.clamp(lag + 1, horizon.max(lag + 1));
            let next_errors = pairs.errors_at(kernel, tail, next, window)?;
            measured.increment_sum += errors.change.max(next_errors.change) * (next - lag) as f64;
            measured.largest_relative = measured.largest_relative.max(next_errors.relative);
            measured.last_coefficient = next_errors.coefficient;
            lag = next;
            errors = next_errors;
        }
        Ok(measured)
    }
}

/// Places in the list of pairs at which errors are measured, at most one for each class.
struct SampledPairs {
    places: Vec<usize>,
}

impl SampledPairs {
    fn new(kernel: &dyn ConvolutionWeights) -> Self {
        let mut first_pair = vec![None; kernel.classes().count()];
        for (place, pair) in kernel.classes().pairs().iter().enumerate() {
            first_pair[pair.class].get_or_insert(place);
        }
        let stride = kernel.classes().count().div_ceil(MAX_CHECKED_CLASSES);
        let mut places = vec![];
        for (k, place) in first_pair.iter().flatten().enumerate() {
            if k % stride == 0 || k + 1 == first_pair.len() {
                places.push(*place);
            }
        }
        Self { places }
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
        let mut errors = LagErrors::default();
        // Of the normal and of the tangential components.
        let mut components = [ComponentErrors::default(); 2];
        for &place in &self.places {
            let pair = kernel.classes().pairs()[place];
            let receiver = place / count;
            let source = place % count;
            let mut exact = [[0.0; 2]; STRIP_KINDS];
            let mut slices = exact.each_mut().map(<[f64; 2]>::as_mut_slice);
            kernel.coefficients(pair.class, lag, &mut slices)?;
            for (part, (exact, found)) in exact.iter().zip(&mut components).enumerate() {
                let error = [0, 1].map(|k| {
                    pair.scale * (tail.of_pair(&fits[k][part], receiver, source) - exact[k])
                });
                found.error = found.error.max(error[0].abs());
                found.coefficient = found.coefficient.max((pair.scale * exact[0]).abs());
                errors.change = errors.change.max((error[1] - error[0]).abs());
            }
        }
        for ComponentErrors { error, coefficient } in components {
            errors.absolute = errors.absolute.max(error);
            errors.coefficient = errors.coefficient.max(coefficient);
            errors.relative = errors.relative.max(error / coefficient);
        }
        Ok(errors)
    }
}
