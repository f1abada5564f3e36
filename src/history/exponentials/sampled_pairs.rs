//! Error of the exponentials against the exact coefficients of sampled pairs.

use super::tail::{Measured, Tail};
use crate::error::Result;
use crate::history::convolution_weights::ConvolutionWeights;
use crate::history::pair_classes::KINDS;

/// Lags checked per octave: about two per period of the trapezoidal rule's error, which oscillates
/// with ln t, at phases that do not repeat.
const PER_OCTAVE: f64 = 7.3;
/// Number of pair classes checked; of more classes, an even sample. The error is a polynomial in
/// space.
const CLASSES: usize = 150;

/// Errors at one lag, their change to the next lag, and the largest coefficient.
struct Sample {
    error: f64,
    change: f64,
    relative: f64,
    largest: f64,
}

impl Measured {
    /// Measures the errors over the lags from `window` + 1 to `horizon`.
    pub(super) fn over(
        kernel: &dyn ConvolutionWeights,
        tail: &Tail,
        window: usize,
        horizon: usize,
    ) -> Result<Self> {
        let pairs = SampledPairs::new(kernel);
        let sample = |lag: usize| pairs.at(kernel, tail, lag, window);
        let mut lag = window + 1;
        let mut before = sample(lag)?;
        let mut found =
            Self { relative: before.relative, increments: before.error, last: before.largest };
        while lag < horizon {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a lag")]
            let next = (lag as f64 * (1.0 / PER_OCTAVE).exp2()).ceil() as usize;
            let next = next.clamp(lag + 1, horizon.max(lag + 1));
            let now = sample(next)?;
            found.increments += before.change.max(now.change) * (next - lag) as f64;
            found.relative = found.relative.max(now.relative);
            found.last = now.largest;
            (lag, before) = (next, now);
        }
        Ok(found)
    }
}

/// Pairs of elements on which errors are measured: places in the list of pairs, at most one for each class.
struct SampledPairs(Vec<usize>);

impl SampledPairs {
    fn new(kernel: &dyn ConvolutionWeights) -> Self {
        let mut first_pair = vec![None; kernel.classes().count()];
        for (place, pair) in kernel.classes().pairs().iter().enumerate() {
            first_pair[pair.class].get_or_insert(place);
        }
        let stride = kernel.classes().count().div_ceil(CLASSES);
        let places = first_pair.iter().flatten().copied().enumerate();
        let places =
            places.filter(|(k, _)| k % stride == 0 || k + 1 == first_pair.len()).map(|(_, at)| at);
        Self(places.collect())
    }

    /// Errors of the exponentials at a lag beyond the window.
    fn at(
        &self,
        kernel: &dyn ConvolutionWeights,
        tail: &Tail,
        lag: usize,
        window: usize,
    ) -> Result<Sample> {
        let count = kernel.classes().elements().len();
        let age = (lag - window - 1) as f64;
        let fits = [tail.at_age(age), tail.at_age(age + 1.0)];
        let mut sample = Sample { error: 0.0, change: 0.0, relative: 0.0, largest: 0.0 };
        let mut worst = [[0.0_f64; 2]; 2];
        for &place in &self.0 {
            let pair = kernel.classes().pairs()[place];
            let (p, q) = (place / count, place % count);
            let [mut zz, mut xx, mut zx] = [[0.0; 2]; KINDS];
            kernel.coefficients(pair.class, lag, [&mut zz, &mut xx, &mut zx])?;
            for (part, exact) in [zz, xx].iter().enumerate() {
                let error =
                    [0, 1].map(|k| pair.scale * (tail.of_pair(&fits[k][part], p, q) - exact[k]));
                let [worst_error, largest] = &mut worst[part];
                *worst_error = worst_error.max(error[0].abs());
                *largest = largest.max((pair.scale * exact[0]).abs());
                sample.change = sample.change.max((error[1] - error[0]).abs());
            }
        }
        for [error, largest] in worst {
            sample.error = sample.error.max(error);
            sample.largest = sample.largest.max(largest);
            sample.relative = sample.relative.max(error / largest);
        }
        Ok(sample)
    }
}
