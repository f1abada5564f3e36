//! Check that a window and its exponentials create no energy.
//!
//! Over any run the work of the tractions τ is Σ τ·L Δs, with the displacements s = Ĝ τ and the diagonal matrix L of
//! element lengths. By Parseval the work is never negative if H(ω) = Re[(1−ζ) L Ĝ(ζ)], ζ = e^(iω), has no negative
//! eigenvalue at any ω. L Gⁿ is symmetric by reciprocity, so H is the Hermitian part of the operator. Near ω = 0 the
//! power radiated by all motions but a translation is proportional to ω². Eigenvalues are therefore divided by
//! (1−cos ω) times the diagonal of L G¹, the value for an immediate displacement. The window is a finite sum, and each
//! pole is a geometric series, so that no sum is truncated.

use super::exact_lags::Lags;
use super::tail::Tail;
use crate::history::convolution_weights::ConvolutionWeights;
use crate::history::pair_classes::STRIP_KINDS;

/// Number of frequencies per decade below one radian per step.
const FREQUENCIES_PER_DECADE: f64 = 8.0;
/// Number of equally spaced frequencies up to π.
const EVEN_FREQUENCY_COUNT: usize = 48;
/// Lowest frequency, relative to the frequency of the horizon.
const LOWEST_FREQUENCY_RATIO: f64 = 0.1;
/// Largest order of H for which all frequencies are tried: the eigenvalues of a larger H take long.
const MAX_DENSE_SEARCH_ORDER: usize = 100;
/// One of this many frequencies is tried, if the order of H is above `MAX_DENSE_SEARCH_ORDER`.
const COARSE_SEARCH_STRIDE: f64 = 3.0;

/// Smallest scaled eigenvalue of H, and its frequency in radians per step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PassivityMargin {
    pub(super) min_eigenvalue: f64,
    pub(super) frequency: f64,
}

/// Smallest eigenvalue of H/(1−cos ω), scaled by the diagonal of L G¹, over all frequencies tried.
pub(super) fn margin(
    kernel: &dyn ConvolutionWeights,
    lags: &Lags,
    tail: &Tail,
    horizon: f64,
) -> PassivityMargin {
    let order = kernel.classes().layout().len();
    let stride = if order > MAX_DENSE_SEARCH_ORDER { COARSE_SEARCH_STRIDE } else { 1.0 };
    let mut frequencies = Vec::new();
    let mut omega = LOWEST_FREQUENCY_RATIO / horizon;
    while omega < 1.0 {
        frequencies.push(omega);
        omega *= 10.0_f64.powf(stride / FREQUENCIES_PER_DECADE);
    }
    let mut frequency_number = 1.0;
    while frequency_number <= EVEN_FREQUENCY_COUNT as f64 {
        frequencies.push(std::f64::consts::PI * frequency_number / EVEN_FREQUENCY_COUNT as f64);
        frequency_number += stride;
    }
    let mut min_margin = PassivityMargin { min_eigenvalue: f64::INFINITY, frequency: 0.0 };
    for frequency in frequencies {
        let min_eigenvalue = min_eigenvalue_at(kernel, lags, tail, frequency);
        // NaN must not pass.
        if min_eigenvalue.is_nan() || min_eigenvalue < min_margin.min_eigenvalue {
            min_margin = PassivityMargin { min_eigenvalue, frequency };
        }
        if min_eigenvalue.is_nan() {
            break;
        }
    }
    min_margin
}

/// Smallest eigenvalue at one frequency.
fn min_eigenvalue_at(kernel: &dyn ConvolutionWeights, lags: &Lags, tail: &Tail, omega: f64) -> f64 {
    let classes = kernel.classes();
    let window_lags = lags.length();
    // Re (1−ζ) ζ^d = cos dω − cos (d+1)ω over 1 − cos ω = 2 sin² ω/2.
    let half_angle = 0.5 * omega;
    let lag_factors: Vec<f64> = (0..window_lags)
        .map(|d| ((d as f64 + 0.5) * omega).sin() / half_angle.sin())
        .collect();
    let one_minus_cosine = 2.0 * half_angle.sin() * half_angle.sin();
    let tail_sums = tail.pole_sums_at_frequency(window_lags as f64, omega);
    let mut window_sums = Vec::with_capacity(classes.count());
    for class in 0..classes.count() {
        window_sums.push(lags.kinds.each_ref().map(|kind| {
            kind[class]
                .iter()
                .zip(&lag_factors)
                .map(|(weight, factor)| weight * factor)
                .sum::<f64>()
        }));
    }
    classes.smallest_eigenvalue(
        |class, component| lags.kinds[component][class][0],
        |[receiver, source], pair| {
            let mut values: [f64; STRIP_KINDS] = window_sums[pair.class];
            for (value, sums) in values.iter_mut().zip(&tail_sums) {
                *value += tail.pair_integral(sums, receiver, source) / one_minus_cosine;
            }
            values
        },
    )
}

#[cfg(test)]
mod tests {
    use super::super::tail::Tail;
    use super::*;
    use crate::bem::{PatchKernel, Strip};
    use crate::history::{ExponentialSum, LateWeights};
    use crate::soil::Soil;

    fn patch() -> PatchKernel {
        let soil = Soil::new(1.0, 0.3, 1.0).unwrap();
        PatchKernel::new(soil, Strip::uniform(-1.0..1.0, 4).unwrap().elements(), 0.2).unwrap()
    }

    /// The correct tail times `factor`.
    fn tail(kernel: &PatchKernel, window: usize, factor: f64) -> Tail {
        let tail = kernel.exponentials(window, 1_000_000, 1e-9).unwrap();
        let mut products = tail.products.clone();
        for weight in products.iter_mut().flat_map(|p| p.normal.iter_mut().chain(&mut p.tangential))
        {
            *weight *= factor;
        }
        let tail = ExponentialSum::new(tail.rates, tail.functions, products).unwrap();
        Tail::new(tail, kernel.classes().elements()).unwrap()
    }

    #[test]
    fn a_tail_that_does_not_continue_the_window_is_not_passive() {
        let kernel = patch();
        let window = 48;
        let lags = Lags::new(&kernel, window).unwrap();
        let margins = [1.0, 3.0, -1.0].map(|factor| {
            margin(&kernel, &lags, &tail(&kernel, window, factor), 1e6).min_eigenvalue
        });
        println!("{margins:?}");
        assert!(margins[0] > 1e-3);
        assert!(margins[1] < 0.0);
        assert!(margins[2] < 0.0);
    }

    /// The closed form in ζ against the sum over the ages; summation by parts makes the sum converge.
    #[test]
    fn closed_form_is_the_sum() {
        let kernel = patch();
        let window = 48;
        let tail = tail(&kernel, window, 1.0);
        let age_sums: Vec<_> =
            (0..20_000).map(|age| tail.pole_sums_at_age(f64::from(age))).collect();
        for omega in [0.02, 0.3, 3.0] {
            let frequency_sums = tail.pole_sums_at_frequency(window as f64, omega);
            for (component, closed_forms) in frequency_sums.iter().enumerate() {
                for (index, closed_form) in closed_forms.iter().enumerate() {
                    let value_at = |age: usize| age_sums[age][component][index];
                    let mut sum = value_at(0) * (window as f64 * omega).cos();
                    for age in 1..age_sums.len() {
                        let angle = (window + age) as f64 * omega;
                        sum += (value_at(age) - value_at(age - 1)) * angle.cos();
                    }
                    let scale = age_sums[0][component][0].abs();
                    assert!(
                        (sum - closed_form).abs() < 1e-5 * scale,
                        "{omega}: {sum} {closed_form}"
                    );
                }
            }
        }
    }
}
