//! Last lag that counts of a kernel in plan: the effect of a traction dies out.

use super::convolution_weights::ConvolutionWeights;
use crate::error::{Observer, Progress, Result};
use crate::geometry::{Lattice, SERIES_PER_OFFSET};

/// Smallest number of lags that are kept.
const SHORTEST: usize = 64;
/// Sum of the lags beyond 2M, relative to the sum of the lags M + 1 … 2M: coupling falls like n⁻³, all else faster.
const BEYOND: f64 = 1.0 / 3.0;

/// Lag after which the coefficients of a kernel are neglected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LastLag {
    /// Last lag that is not neglected, a power of two.
    pub(super) lag: usize,
    /// Bound of the change in a step of the displacement neglected by dropping later lags, per pascal of traction, m/Pa.
    ///
    /// The sum of |Gⁿ − Gⁿ⁻¹| with zero at the last lag: late coefficients change slowly.
    pub(super) change: f64,
}

impl LastLag {
    /// Smallest power of two after which the coefficients' sum is at most `tolerance` of the total.
    ///
    /// `None` if the lags up to `most` do not reach it. The lag found does not depend on `most`. The observer counts
    /// lags; the search ends early where the last lag is found.
    pub(super) fn find(
        kernel: &dyn ConvolutionWeights,
        tolerance: f64,
        most: usize,
        observer: &mut Observer<'_>,
    ) -> Result<Option<Self>> {
        let Some((lattice, _)) = kernel.classes().plan() else { return Ok(None) };
        let area = lattice.pitch[0] * lattice.pitch[1];
        // Σ |G| for each class and kind.
        let mut all = vec![[0.0; SERIES_PER_OFFSET]; kernel.classes().count()];
        let mut lags = [(); SERIES_PER_OFFSET].map(|()| vec![0.0; SHORTEST]);
        let mut done = 0;
        let mut lag = SHORTEST;
        while lag <= most / 2 {
            kernel.prepare(2 * lag, &mut |Progress { task, done: parts, total }| {
                let lags = done + (2 * lag - done) * parts / total.max(1);
                observer(Progress { task, done: lags, total: most })
            })?;
            let [mut late, mut changes, mut before] =
                [(); 3].map(|()| vec![[0.0; SERIES_PER_OFFSET]; all.len()]);
            for begin in (done..2 * lag).step_by(SHORTEST) {
                let sums = if begin < lag { &mut all } else { &mut late };
                for (class, sums) in sums.iter_mut().enumerate() {
                    let values = lags.each_mut().map(Vec::as_mut_slice);
                    kernel.coefficients_in_plan(class, begin + 1, values)?;
                    for (sum, lags) in sums.iter_mut().zip(&lags) {
                        *sum += lags.iter().map(|value| value.abs()).sum::<f64>();
                    }
                    if begin < lag {
                        continue;
                    }
                    let own = changes[class].iter_mut().zip(&mut before[class]);
                    for ((change, before), lags) in own.zip(&lags) {
                        for value in lags {
                            *change += (value - *before).abs();
                            *before = *value;
                        }
                    }
                }
            }
            let rest = (1.0 + BEYOND) * largest_row(lattice, &late);
            for (all, late) in all.as_flattened_mut().iter_mut().zip(late.as_flattened()) {
                *all += late;
            }
            if rest <= tolerance * largest_row(lattice, &all) {
                let change = (1.0 + BEYOND) * largest_row(lattice, &changes) / area;
                return Ok(Some(Self { lag, change }));
            }
            done = 2 * lag;
            lag *= 2;
        }
        Ok(None)
    }
}

/// Largest sum of a displacement component over a row of the matrix, from sums for each class and kind.
fn largest_row(lattice: &Lattice, sums: &[[f64; SERIES_PER_OFFSET]]) -> f64 {
    let offsets = (0..lattice.counts[0]).flat_map(|i| (0..lattice.counts[1]).map(move |j| [i, j]));
    let mut rows = [0.0; 3];
    for offset in offsets {
        let images: f64 = offset.map(|n| if n == 0 { 1.0 } else { 2.0 }).iter().product();
        let block = lattice.block(sums, offset.map(usize::cast_signed));
        for (row, values) in rows.iter_mut().zip(block) {
            *row += images * values.map(f64::abs).iter().sum::<f64>();
        }
    }
    rows.into_iter().fold(0.0, f64::max)
}
