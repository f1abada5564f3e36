//! Blocks of lags, each twice as long as all before it.

use super::contour::Circle;

/// Number of lags of the first block.
pub(crate) const FIRST_BLOCK_LAGS: usize = 128;
/// Largest number of blocks: lags up to 2³¹.
pub(crate) const MAX_BLOCK_COUNT: usize = 25;
/// Number of points of the circle per N, for lags N+1 … 2N; the first block has 2N points.
const POINTS_PER_LAG: usize = 4;

/// Weights of consecutive lags, for all classes.
#[derive(Debug)]
pub(crate) struct LagBlock {
    /// One list of lags for each class and kind, class by class.
    pub(crate) values: Vec<Vec<f64>>,
}

impl LagBlock {
    /// Number of the block that contains `lag` ≥ 1.
    pub(crate) fn number_of(lag: usize) -> usize {
        let index = lag - 1;
        if index < FIRST_BLOCK_LAGS { 0 } else { (index / FIRST_BLOCK_LAGS).ilog2() as usize + 1 }
    }

    /// The first lag in block `number`.
    pub(crate) fn first_lag(number: usize) -> usize {
        if number == 0 { 1 } else { (FIRST_BLOCK_LAGS << (number - 1)) + 1 }
    }

    /// Number of lags in block `number`.
    pub(crate) fn lags(number: usize) -> usize {
        FIRST_BLOCK_LAGS << number.saturating_sub(1)
    }

    /// Circle for the transform of block `number`, for a relative accuracy of F.
    pub(crate) fn circle(number: usize, tolerance: f64) -> Circle {
        let length = POINTS_PER_LAG * Self::lags(number) / if number == 0 { 2 } else { 1 };
        Circle::new(length, tolerance)
    }

    /// The last lag in block `number`.
    pub(crate) fn last_lag(number: usize) -> usize {
        FIRST_BLOCK_LAGS << number
    }

    /// Weights of one class from a position in the block to its end.
    pub(crate) fn lags_from<const KINDS: usize>(
        &self,
        class: usize,
        position: usize,
    ) -> [&[f64]; KINDS] {
        std::array::from_fn(|kind| &self.values[class * KINDS + kind][position..])
    }
}
