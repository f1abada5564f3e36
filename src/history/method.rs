//! Methods by which a ground sums the effect of all past tractions.

/// Convolution history of a ground: the method by which it sums the effect of all past tractions.
///
/// Q elements, N steps, C classes of pairs (Q on a uniform strip, about Q²/4 on a graded one), W
/// the lags before the exponentials (on the half-plane, the power of two at or above the steps in
/// which the Rayleigh wave crosses the patch three times), M the power of two at or above N; for a coupling that ends
/// after few lags, as on the half-plane:
///
/// | | result | multiply–adds per step | bytes |
/// |---|---|---|---|
/// | direct | exact to rounding | Q² N on average | 16 (C + Q) N |
/// | relaxed transforms, pairs of elements | exact to rounding | 64 Q² + log₂(N/64) (16 Q² + 5 Q log₂ N) | (32 C + 24 Q + 16) M |
/// | relaxed transforms, wavenumbers | exact to rounding | 128 Q + log₂(N/32) (8 Q + 5 Q log₂ 2N) | (64 Q + 32) M |
/// | exponentials | within a tolerance | as the transforms, with W for N, and about 3000 | as the transforms, with W for M, and 32 Q W |
///
/// Wavenumbers take the place of pairs from eight equal elements on. A processor makes 4 to 7 of
/// these multiply–adds in a nanosecond.
///
/// See [`RelaxedFftHistory`](super::RelaxedFftHistory) and
/// [`ExponentialHistory`](super::ExponentialHistory) for more.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum HistoryMethod {
    /// Direct sum, [`DirectHistory`](super::DirectHistory): for checks.
    Direct,
    /// Transforms of blocks, [`RelaxedFftHistory`](super::RelaxedFftHistory).
    RelaxedFft,
    /// A window of exact lags and a sum of exponentials,
    /// [`ExponentialHistory`](super::ExponentialHistory): memory that does not grow, small
    /// checkpoints. The kernel has to know its [late lags](super::ConvolutionWeights::late_weights).
    Exponentials,
    /// One of the above by one rule, whatever the number of steps:
    ///
    /// * exponentials, on a half-plane under strips: within the tolerance of
    ///   [`HistoryOptions`](super::HistoryOptions) or else 1e-12, which is rounding; unless the step is so short that
    ///   they begin after 16 384 lags, or they would take more memory than is allowed, or are not accurate or passive;
    /// * relaxed transforms otherwise, in plan up to the last lag that counts.
    ///
    /// How a run is cut, and which number of steps is announced, changes no bit up to 2²⁰ steps.
    #[default]
    Auto,
}

words! { pub(crate) HistoryMethod, "history", {
    Direct = "direct",
    RelaxedFft = "relaxed_fft",
    Exponentials = "exponentials",
    Auto = "auto",
} }
