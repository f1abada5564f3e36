//! Last lag that is not negligible, on a ground in plan.
//!
//! On such a ground the effect of a traction decays to zero.

use super::convolution_weights::ConvolutionWeights;
use crate::error::{Observer, Progress, Result};
use crate::geometry::{COMPLIANCES_PER_OFFSET, COMPONENTS_IN_SPACE, Lattice};

/// Smallest number of lags that are not neglected, and number of lags that are summed together.
const MIN_KEPT_LAGS: usize = 64;
/// Sum of the coefficients beyond lag 2M, relative to the sum over the lags M + 1 … 2M.
///
/// For a coupling that decays like n⁻³ the ratio is 1/3; all other coefficients decay faster.
const REMAINDER_RATIO: f64 = 1.0 / 3.0;

/// Lag after which the coefficients of a kernel are neglected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LastLag {
    /// Last lag that is not neglected, a power of two.
    pub(super) lag: usize,
    /// Bound of the neglected displacement's change in a step, per traction, m/Pa.
    ///
    /// It is the sum of |Gⁿ − Gⁿ⁻¹| over the neglected lags, with zero in place of the weights of the last lag.
    pub(super) change: f64,
}

impl LastLag {
    /// Smallest power of two after which the coefficients' sum is at most `tolerance` of the total.
    ///
    /// `None` if no such lag is up to half of `max_lags`. The returned lag does not depend on `max_lags`. The observer is
    /// notified of the number of computed lags, out of `max_lags`; the search may end before.
    pub(super) fn find(
        kernel: &dyn ConvolutionWeights,
        tolerance: f64,
        max_lags: usize,
        observer: &mut Observer<'_>,
    ) -> Result<Option<Self>> {
        let Some((lattice, _)) = kernel.classes().plan() else { return Ok(None) };
        let area = lattice.pitch[0] * lattice.pitch[1];
        // Σ |G| for each class and kind.
        let mut sums = vec![[0.0; COMPLIANCES_PER_OFFSET]; kernel.classes().count()];
        let mut kind_lags = [(); COMPLIANCES_PER_OFFSET].map(|()| vec![0.0; MIN_KEPT_LAGS]);
        let mut summed_lags = 0;
        let mut lag = MIN_KEPT_LAGS;
        while lag <= max_lags / 2 {
            kernel.prepare(2 * lag, &mut |Progress { task, done, total, .. }| {
                let done_lags = summed_lags + (2 * lag - summed_lags) * done / total.max(1);
                observer(Progress::new(task, done_lags, max_lags))
            })?;
            let mut late_sums = vec![[0.0; COMPLIANCES_PER_OFFSET]; sums.len()];
            let mut change_sums = late_sums.clone();
            let mut previous_values = late_sums.clone();
            for skipped_lags in (summed_lags..2 * lag).step_by(MIN_KEPT_LAGS) {
                let is_late = skipped_lags >= lag;
                let class_sums = if is_late { &mut late_sums } else { &mut sums };
                for (class, kind_sums) in class_sums.iter_mut().enumerate() {
                    let mut slices = kind_lags.each_mut().map(Vec::as_mut_slice);
                    kernel.coefficients(class, skipped_lags + 1, &mut slices)?;
                    for (sum, lags) in kind_sums.iter_mut().zip(&kind_lags) {
                        *sum += lags.iter().map(|value| value.abs()).sum::<f64>();
                    }
                    if !is_late {
                        continue;
                    }
                    let kinds = change_sums[class].iter_mut().zip(&mut previous_values[class]);
                    for ((change_sum, previous_value), lags) in kinds.zip(&kind_lags) {
                        for value in lags {
                            *change_sum += (value - *previous_value).abs();
                            *previous_value = *value;
                        }
                    }
                }
            }
            let remainder = (1.0 + REMAINDER_RATIO) * max_row_sum(lattice, &late_sums);
            let late_sums = late_sums.as_flattened();
            for (sum, late_sum) in sums.as_flattened_mut().iter_mut().zip(late_sums) {
                *sum += late_sum;
            }
            if remainder <= tolerance * max_row_sum(lattice, &sums) {
                let change = (1.0 + REMAINDER_RATIO) * max_row_sum(lattice, &change_sums) / area;
                return Ok(Some(Self { lag, change }));
            }
            summed_lags = 2 * lag;
            lag *= 2;
        }
        Ok(None)
    }
}

/// Largest row sum of the matrix, from sums for each class and kind.
fn max_row_sum(lattice: &Lattice, sums: &[[f64; COMPLIANCES_PER_OFFSET]]) -> f64 {
    let offsets = (0..lattice.counts[0]).flat_map(|i| (0..lattice.counts[1]).map(move |j| [i, j]));
    let mut row_sums = [0.0; COMPONENTS_IN_SPACE];
    for offset in offsets {
        let image_count: f64 = offset.map(|n| if n == 0 { 1.0 } else { 2.0 }).iter().product();
        let block = lattice.block(sums, offset.map(usize::cast_signed));
        for (row_sum, values) in row_sums.iter_mut().zip(block) {
            *row_sum += image_count * values.map(f64::abs).iter().sum::<f64>();
        }
    }
    row_sums.into_iter().fold(0.0, f64::max)
}
