//! The history of a ground: its methods, and a description of the method in use.

use std::fmt;

use super::convolution::ConvolutionHistory;
use super::direct::DirectHistory;
use super::exponentials::ExponentialHistory;
use super::relaxed_fft::RelaxedFftHistory;
use crate::error::{CheckpointError, Result};

/// Method by which a ground sums the effect of all past tractions.
///
/// The table counts Q elements, N steps and C classes of pairs (Q on a uniform strip, about Q²/4 on a graded one). W is
/// the number of lags before the exponentials: on the half-plane, the power of two at or above the steps in which the
/// Rayleigh wave crosses the patch three times. M is the power of two at or above N. The costs are for a coupling that
/// ends after few lags, as on the half-plane:
///
/// | | result | multiply–adds per step | bytes |
/// |---|---|---|---|
/// | direct | exact to rounding | Q² N on average | 16 (C + Q) N |
/// | relaxed transforms, pairs of elements | exact to rounding | 32 Q² + log₂(N/32) (4 Q² + 2.5 Q log₂ 64N) | (32 C + 24 Q + 16) M |
/// | relaxed transforms, wavenumbers | exact to rounding | 128 Q + log₂(N/32) (8 Q + 5 Q log₂ 64N) | (64 Q + 32) M |
/// | exponentials | within a tolerance | as the transforms, with W for N, and about 3000 | as the transforms, with W for M, and 32 Q W |
///
/// For eight or more equal elements, transforms over wavenumbers replace those over pairs. A processor performs 4 to 7
/// of these multiply–adds in a nanosecond.
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
    /// A window of exact lags and a sum of exponentials, [`ExponentialHistory`](super::ExponentialHistory).
    ///
    /// Its memory does not grow with the number of steps, and its checkpoints are small. The kernel must provide its
    /// [late lags](super::ConvolutionWeights::late_weights).
    Exponentials,
    /// One of these methods, by a rule that does not depend on the number of steps:
    ///
    /// * exponentials for a half-plane under strips, within the tolerance of [`HistoryOptions`](super::HistoryOptions)
    ///   or else 1e-12, which is rounding; unless the step is so short that they begin after 16 384 lags, or they need
    ///   more memory than allowed, or are not accurate or passive;
    /// * relaxed transforms otherwise, in plan up to the last lag that is not negligible.
    ///
    /// Up to 2²⁰ steps, the results are the same to the last bit for any division of a run into parts, and for any
    /// announced number of steps.
    #[default]
    Auto,
}

words! { pub(crate) HistoryMethod, "history", {
    Direct = "direct",
    RelaxedFft = "relaxed_fft",
    Exponentials = "exponentials",
    Auto = "auto",
} }

/// Convolution history of a ground: its method, memory and accuracy.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct HistoryChoice {
    /// Method; never [`HistoryMethod::Auto`].
    pub kind: HistoryMethod,
    /// Number of steps for which the ground was prepared; `None` if the end of the run is unknown.
    pub steps: Option<usize>,
    /// Memory used now, bytes.
    pub memory: usize,
    /// Bound of the relative error of the coefficients; zero if the method is exact.
    ///
    /// For exponentials the measured error; for transforms the fraction of the coefficients' sum that may be neglected.
    pub error_bound: f64,
    /// Number of Runge–Kutta stages of the convolution quadrature; `None` for closed forms.
    pub stages: Option<usize>,
}

impl fmt::Display for HistoryChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let method_name = match self.kind {
            HistoryMethod::Direct => "direct sum",
            HistoryMethod::RelaxedFft => "relaxed transforms",
            HistoryMethod::Exponentials => "exponentials",
            HistoryMethod::Auto => "chosen by rule",
        };
        write!(f, "history: {method_name}, ")?;
        match self.steps {
            Some(steps) => write!(f, "{steps} steps")?,
            None => write!(f, "no known end of the run")?,
        }
        write!(f, ", {:.1} MB", self.memory as f64 / 1e6)?;
        if let Some(stages) = self.stages {
            write!(f, ", coefficients by Radau IIA of {stages} stages")?;
        }
        if self.error_bound > 0.0 {
            write!(f, ", coefficients within {:.1e}", self.error_bound)?;
        }
        Ok(())
    }
}

/// History of a ground, created from its options or supplied by the caller.
pub(crate) struct ChosenHistory {
    pub(crate) history: Box<dyn ConvolutionHistory>,
    /// Description; `None` for a history that the caller supplied.
    choice: Option<HistoryChoice>,
    /// Number that identifies the history in a checkpoint.
    ///
    /// It is a constant, or the horizon (steps) of exponentials.
    identity: usize,
}

impl ChosenHistory {
    /// Identities of histories without a horizon; every horizon is a larger number.
    const SUPPLIED_IDENTITY: usize = 0;
    const DIRECT_IDENTITY: usize = 1;
    const TRANSFORMS_IDENTITY: usize = 2;

    fn new(
        history: impl ConvolutionHistory + 'static,
        kind: HistoryMethod,
        steps: Option<usize>,
        error_bound: f64,
        identity: usize,
    ) -> Self {
        let choice = HistoryChoice { kind, steps, memory: 0, error_bound, stages: None };
        Self { history: Box::new(history), choice: Some(choice), identity }
    }

    /// Wraps a history that the caller supplied.
    pub(crate) fn supplied(history: Box<dyn ConvolutionHistory>) -> Self {
        Self { history, choice: None, identity: Self::SUPPLIED_IDENTITY }
    }

    pub(super) fn direct(history: DirectHistory, steps: Option<usize>) -> Self {
        Self::new(history, HistoryMethod::Direct, steps, 0.0, Self::DIRECT_IDENTITY)
    }

    /// Wraps transforms that neglect up to the fraction `neglected` of the coefficients' sum.
    pub(super) fn transforms(
        history: RelaxedFftHistory,
        steps: Option<usize>,
        neglected: f64,
    ) -> Self {
        Self::new(history, HistoryMethod::RelaxedFft, steps, neglected, Self::TRANSFORMS_IDENTITY)
    }

    pub(super) fn exponentials(history: ExponentialHistory, steps: Option<usize>) -> Self {
        let error_bound = history.error_bound();
        let horizon = history.horizon();
        Self::new(history, HistoryMethod::Exponentials, steps, error_bound, horizon)
    }

    /// Description of the history; `None` for a history that the caller supplied.
    pub(crate) fn choice(&self) -> Option<HistoryChoice> {
        self.choice.map(|choice| HistoryChoice { memory: self.history.memory(), ..choice })
    }

    /// Saves the identity of the history, and its state.
    pub(crate) fn save(&self) -> Result<Vec<f64>> {
        let mut values = vec![self.identity as f64];
        values.extend(self.history.save()?);
        Ok(values)
    }

    /// Restores the state at `steps` steps, if this history saved `values`.
    ///
    /// If exponentials with another horizon saved `values`, returns that horizon and restores nothing.
    ///
    /// # Errors
    /// [`CheckpointError::OtherScene`] for a history of another kind; as for [`ConvolutionHistory::restore`].
    pub(crate) fn restore(&mut self, steps: usize, values: &[f64]) -> Result<Option<usize>> {
        let corrupt_error = CheckpointError::Corrupt { quantity: "kind of history" };
        let [identity, values @ ..] = values else { return Err(corrupt_error.into()) };
        if *identity == self.identity as f64 {
            self.history.restore(steps, values)?;
            return Ok(None);
        }
        let horizon_range =
            ExponentialHistory::DEFAULT_HORIZON as f64..=ExponentialHistory::MAX_HORIZON as f64;
        let is_horizon = horizon_range.contains(identity) && identity.fract() == 0.0;
        if is_horizon && self.identity > Self::TRANSFORMS_IDENTITY {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
            return Ok(Some(*identity as usize));
        }
        let constant_identities =
            [Self::SUPPLIED_IDENTITY, Self::DIRECT_IDENTITY, Self::TRANSFORMS_IDENTITY];
        let is_valid_identity = is_horizon
            || constant_identities.iter().any(|valid_identity| *valid_identity as f64 == *identity);
        let other_scene_error = CheckpointError::OtherScene { quantity: "kind of history" };
        Err(if is_valid_identity { other_scene_error } else { corrupt_error }.into())
    }
}
