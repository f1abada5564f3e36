//! Methods by which a ground sums the effect of all past tractions.

/// Method by which a ground sums the effect of all past tractions.
///
/// The table counts Q elements, N steps and C classes of pairs (Q on a uniform strip, about Q²/4 on a graded one). W is
/// the number of lags before the exponentials: on the half-plane, the power of two at or above the steps in which the
/// Rayleigh wave crosses the patch three times. M is the power of two at or above N. The coupling ends after few lags,
/// as on the half-plane:
///
/// | | result | multiply–adds per step | bytes |
/// |---|---|---|---|
/// | direct | exact to rounding | Q² N on average | 16 (C + Q) N |
/// | relaxed transforms, pairs of elements | exact to rounding | 64 Q² + log₂(N/64) (16 Q² + 5 Q log₂ N) | (32 C + 24 Q + 16) M |
/// | relaxed transforms, wavenumbers | exact to rounding | 128 Q + log₂(N/32) (8 Q + 5 Q log₂ 2N) | (64 Q + 32) M |
/// | exponentials | within a tolerance | as the transforms, with W for N, and about 3000 | as the transforms, with W for M, and 32 Q W |
///
/// From eight equal elements on, wavenumbers replace pairs. A processor makes 4 to 7 of these multiply–adds in a
/// nanosecond.
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
    /// A window of exact lags and a sum of exponentials, [`ExponentialHistory`](super::ExponentialHistory): memory that
    /// does not grow, small checkpoints. The kernel must provide its [late lags](super::ConvolutionWeights::late_weights).
    Exponentials,
    /// One of the above by one rule, whatever the number of steps:
    ///
    /// * exponentials for a half-plane under strips, within the tolerance of [`HistoryOptions`](super::HistoryOptions)
    ///   or else 1e-12, which is rounding; unless the step is so short that they begin after 16 384 lags, or they need
    ///   more memory than allowed, or are not accurate or passive;
    /// * relaxed transforms otherwise, in plan up to the last lag that counts.
    ///
    /// The division of a run into parts, and the number of steps announced, change no bit up to 2²⁰ steps.
    #[default]
    Auto,
}

words! { pub(crate) HistoryMethod, "history", {
    Direct = "direct",
    RelaxedFft = "relaxed_fft",
    Exponentials = "exponentials",
    Auto = "auto",
} }
