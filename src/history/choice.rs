//! The kinds of histories, which one a ground keeps, and why.

use std::fmt;

use crate::error::{CheckpointError, Result};

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
/// these multiply–adds in a nanosecond: the estimates tell factors of two apart, not more.
///
/// See [`RelaxedFftHistory`](super::RelaxedFftHistory) and
/// [`ExponentialHistory`](super::ExponentialHistory) for more.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum History {
    /// The sum as it is, [`DirectHistory`](super::DirectHistory): for checks.
    Direct,
    /// Transforms of blocks, [`RelaxedFftHistory`](super::RelaxedFftHistory).
    RelaxedFft,
    /// A window of exact lags and a sum of exponentials,
    /// [`ExponentialHistory`](super::ExponentialHistory): memory that does not grow, small
    /// checkpoints. The kernel has to know its [late lags](super::ConvolutionWeights::late_weights).
    Exponentials,
    /// One of the above, chosen when the number of steps is known or the first step is made:
    ///
    /// 1. the exponentials, if they are estimated to take less time over the run than the
    ///    transforms, their making included: with the tolerance allowed (`with_history_tolerance`),
    ///    or with 1e-12, which is rounding, if the number of steps is known. Memory is not asked for
    ///    then;
    /// 2. the relaxed transforms, if they fit into the memory that a history may take
    ///    (`with_history_memory`, 1 GiB unless given), or if the number of steps is not known, as
    ///    long as they do;
    /// 3. otherwise the exponentials, with their own tolerance; or the transforms all the same,
    ///    where the exponentials cannot be had.
    ///
    /// Runs that go on beyond the steps known keep an exact history only up to the memory allowed, and
    /// then the exponentials (3.), which take over all that was before.
    ///
    /// The choice is made once: from the steps that a simulation was told to
    /// [expect](crate::coupled::SimulationBuilder::expected_steps), or else from those of the first
    /// run. Runs that follow keep it. Both give the same bits however a run is cut, but they differ
    /// from each other by their errors: say what to expect, and the choice is the same for every cut.
    #[default]
    Auto,
}

words! { History, "history", {
    Direct = "direct",
    RelaxedFft = "relaxed_fft",
    Exponentials = "exponentials",
    Auto = "auto",
} }

/// Why a history was chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum ChoiceReason {
    /// It was asked for.
    Asked,
    /// It is exact, and fits into the memory allowed.
    Exact,
    /// It is exact, and nothing is known of the number of steps.
    UnknownLength,
    /// The tolerance allowed makes it the cheapest.
    ToleranceAllowed,
    /// It takes least time, and its coefficients err by rounding: 1e-12 at most.
    Rounding,
    /// An exact history would take more memory than is allowed.
    MemoryLimit,
    /// An exact history takes more memory than is allowed, but the exponentials cannot be had, or
    /// would take more still.
    NoExponentials,
}

impl fmt::Display for ChoiceReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Asked => "as asked",
            Self::Exact => "exact, and within the memory allowed",
            Self::UnknownLength => "exact, and the number of steps is not known",
            Self::ToleranceAllowed => "cheapest within the tolerance allowed",
            Self::Rounding => "cheapest, with an error at rounding",
            Self::MemoryLimit => "an exact history would need more memory than allowed",
            Self::NoExponentials => {
                "more memory than allowed, but exponentials cannot be had or take more"
            }
        })
    }
}

/// The history that a ground keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct HistoryChoice {
    /// Which one; never [`History::Auto`].
    pub kind: History,
    /// Why.
    pub reason: ChoiceReason,
    /// Steps that were expected; `None` if nothing was known.
    pub steps: Option<usize>,
    /// Bytes that it is estimated to take by then.
    pub estimated_memory: usize,
    /// Multiply–adds per step, averaged over the run.
    pub estimated_cost: f64,
    /// Relative error of its coefficients, measured; zero if it is exact.
    pub error_bound: f64,
    /// Runge–Kutta stages of the convolution quadrature that its coefficients come from; `None` for
    /// closed forms.
    pub stages: Option<usize>,
}

/// A choice as a checkpoint has it: with the same options, the same is chosen again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SavedChoice {
    /// [`History::Auto`] where none was made, or the history is one of the user's own.
    pub(crate) kind: History,
    pub(crate) steps: Option<usize>,
}

impl SavedChoice {
    /// Kinds by their number in a checkpoint.
    const KINDS: [History; 4] =
        [History::Auto, History::Direct, History::RelaxedFft, History::Exponentials];

    pub(crate) fn new(choice: Option<HistoryChoice>) -> Self {
        let (kind, steps) = choice.map_or((History::Auto, None), |c| (c.kind, c.steps));
        Self { kind, steps }
    }

    /// Number of the kind, and steps that were expected or −1.
    pub(crate) fn numbers(self) -> [f64; 2] {
        let kind = Self::KINDS.iter().take_while(|kind| **kind != self.kind).count();
        [kind as f64, self.steps.map_or(-1.0, |steps| steps as f64)]
    }

    /// From the first of `values`, and what follows.
    pub(crate) fn read(values: &[f64]) -> Result<(Self, &[f64])> {
        let corrupt = CheckpointError::Corrupt { quantity: "choice of the history" };
        let [kind, steps, rest @ ..] = values else { return Err(corrupt.into()) };
        let kind = (0_u8..).zip(Self::KINDS).find(|(number, _)| f64::from(*number) == *kind);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
        let steps = match *steps {
            -1.0 => Some(None),
            n if n >= 0.0 && n <= usize::MAX as f64 && n.fract() == 0.0 => Some(Some(n as usize)),
            _ => None,
        };
        match (kind, steps) {
            (Some((_, kind)), Some(steps)) => Ok((Self { kind, steps }, rest)),
            _ => Err(corrupt.into()),
        }
    }
}

impl fmt::Display for HistoryChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self.kind {
            History::Direct => "direct sum",
            History::RelaxedFft => "relaxed transforms",
            History::Exponentials => "exponentials",
            History::Auto => "not chosen yet",
        };
        write!(f, "history: {name} ({}); ", self.reason)?;
        match self.steps {
            Some(steps) => write!(f, "{steps} steps, ")?,
            None => write!(f, "unknown number of steps, ")?,
        }
        write!(
            f,
            "about {:.1} MB and {:.1e} multiply–adds per step",
            self.estimated_memory as f64 / 1e6,
            self.estimated_cost
        )?;
        if let Some(stages) = self.stages {
            write!(f, ", coefficients by Radau IIA of {stages} stages")?;
        }
        if self.error_bound > 0.0 {
            write!(f, ", coefficients within {:.1e}", self.error_bound)?;
        }
        Ok(())
    }
}
