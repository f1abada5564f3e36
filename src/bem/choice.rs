//! Which history a half-plane keeps, and why.

use std::fmt;
use std::sync::Arc;

use super::PatchKernel;
use crate::error::{CheckpointError, Result};
use crate::history::{ConvolutionHistory, DirectHistory, ExponentialHistory, RelaxedFftHistory};

/// How the half-plane sums what all past tractions give.
///
/// Q elements, N steps, C classes of pairs (Q on a uniform strip, about Q²/4 on a graded one), W
/// the steps in which the Rayleigh wave crosses the patch three times, b about 4√W, M the power of
/// two at or above N:
///
/// | | result | multiply–adds per step | bytes |
/// |---|---|---|---|
/// | direct | exact to rounding | Q² N on average | 16 (C + Q) N |
/// | relaxed transforms, pairs of elements | exact to rounding | 64 Q² + log₂(N/64) (16 Q² + 5 Q log₂ N) | (32 C + 24 Q + 16) M |
/// | relaxed transforms, wavenumbers | exact to rounding | 128 Q + log₂(N/32) (8 Q + 5 Q log₂ 2N) | (64 Q + 32) M |
/// | exponentials | within a tolerance | 2 Q² b + 16 Q² W/b + 20 Q log₂ 2b + about 3000 | 16 C b + 48 C W + 64 Q W |
///
/// Wavenumbers take the place of pairs from eight equal elements on. A processor makes 4 to 7 of
/// these multiply–adds in a nanosecond (`docs/performance.md`): the estimates tell factors of two
/// apart, not more.
///
/// See [`RelaxedFftHistory`] and [`ExponentialHistory`] for more.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[non_exhaustive]
pub enum History {
    /// The sum as it is, [`DirectHistory`]: for checks, and very short runs.
    Direct,
    /// Transforms of blocks, [`RelaxedFftHistory`].
    RelaxedFft,
    /// A window of exact lags and a sum of exponentials, [`ExponentialHistory`]: memory that does
    /// not grow, small checkpoints.
    Exponentials,
    /// One of the above, chosen when the number of steps is known or the first step is made:
    ///
    /// 1. up to 64 steps the direct sum;
    /// 2. the exponentials, if a tolerance was allowed (`with_history_tolerance`) and they are
    ///    estimated to be cheaper than the transforms;
    /// 3. the relaxed transforms, if they fit into the memory that a history may take
    ///    (`with_history_memory`, 1 GiB unless given), or if the number of steps is not known;
    /// 4. otherwise the exponentials, with their own tolerance; or the transforms all the same,
    ///    where the exponentials cannot be had.
    #[default]
    Auto,
}

/// What a half-plane was told about its history.
#[derive(Debug, Clone, Copy)]
pub(super) struct HistoryOptions {
    pub(super) kind: History,
    pub(super) tolerance: Option<f64>,
    /// Bytes.
    pub(super) memory: usize,
}

impl Default for HistoryOptions {
    fn default() -> Self {
        Self { kind: History::Auto, tolerance: None, memory: 1 << 30 }
    }
}

/// Why a history was chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ChoiceReason {
    /// It was asked for.
    Asked,
    /// So few steps are summed as fast in any way.
    FewSteps,
    /// It is exact, and fits into the memory allowed.
    Exact,
    /// It is exact, and nothing is known of the number of steps.
    UnknownLength,
    /// The tolerance allowed makes it the cheapest.
    ToleranceAllowed,
    /// An exact history would take more memory than is allowed.
    MemoryLimit,
    /// An exact history takes more memory than is allowed, but the exponentials cannot be had.
    NoExponentials,
}

impl fmt::Display for ChoiceReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Asked => "as asked",
            Self::FewSteps => "few steps",
            Self::Exact => "exact, and within the memory allowed",
            Self::UnknownLength => "exact, and the number of steps is not known",
            Self::ToleranceAllowed => "cheapest within the tolerance allowed",
            Self::MemoryLimit => "an exact history would need more memory than allowed",
            Self::NoExponentials => "more memory than allowed, but exponentials cannot be had here",
        })
    }
}

/// The history that a ground keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
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
}

/// What a checkpoint says of a choice: with the same options, the same is chosen again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct SavedChoice {
    /// [`History::Auto`] where none was made, or the history is one of the user's own.
    pub(super) kind: History,
    pub(super) steps: Option<usize>,
}

impl SavedChoice {
    /// Kinds by their number in a checkpoint.
    const KINDS: [History; 4] =
        [History::Auto, History::Direct, History::RelaxedFft, History::Exponentials];

    pub(super) fn new(choice: Option<HistoryChoice>) -> Self {
        let (kind, steps) = choice.map_or((History::Auto, None), |c| (c.kind, c.steps));
        Self { kind, steps }
    }

    /// Number of the kind, and steps that were expected or −1.
    pub(super) fn numbers(self) -> [f64; 2] {
        let kind = Self::KINDS.iter().take_while(|kind| **kind != self.kind).count();
        [kind as f64, self.steps.map_or(-1.0, |steps| steps as f64)]
    }

    /// From the first of `values`, and what follows.
    pub(super) fn read(values: &[f64]) -> Result<(Self, &[f64])> {
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
        if self.error_bound > 0.0 {
            write!(f, ", coefficients within {:.1e}", self.error_bound)?;
        }
        Ok(())
    }
}

/// Steps that are estimated for where nothing is known.
const UNKNOWN_STEPS: usize = 100_000;
/// Runs up to here are summed directly.
const FEW_STEPS: usize = 64;

impl HistoryOptions {
    /// An empty history, and why it is this one.
    pub(super) fn make(
        self,
        kernel: &Arc<PatchKernel>,
        steps: Option<usize>,
    ) -> Result<(Box<dyn ConvolutionHistory>, HistoryChoice)> {
        let expected = steps.unwrap_or(UNKNOWN_STEPS);
        let of = |kind| Estimate::new(kind, kernel, expected);
        let exact = of(History::RelaxedFft);
        let (kind, reason) = if self.kind != History::Auto {
            (self.kind, ChoiceReason::Asked)
        } else if steps.is_some_and(|steps| steps <= FEW_STEPS) {
            (History::Direct, ChoiceReason::FewSteps)
        } else if self.tolerance.is_some() && of(History::Exponentials).cost < exact.cost {
            (History::Exponentials, ChoiceReason::ToleranceAllowed)
        } else if steps.is_none() {
            (History::RelaxedFft, ChoiceReason::UnknownLength)
        } else if exact.memory <= self.memory {
            (History::RelaxedFft, ChoiceReason::Exact)
        } else {
            (History::Exponentials, ChoiceReason::MemoryLimit)
        };
        let Estimate { memory, cost } = of(kind);
        let mut choice = HistoryChoice {
            kind,
            reason,
            steps,
            estimated_memory: memory,
            estimated_cost: cost,
            error_bound: 0.0,
        };
        let own = Arc::clone(kernel);
        let history: Box<dyn ConvolutionHistory> = match kind {
            History::Direct => Box::new(DirectHistory::new(own)),
            History::RelaxedFft | History::Auto => Box::new(RelaxedFftHistory::new(own)),
            History::Exponentials => {
                let tolerance = self.tolerance.unwrap_or(ExponentialHistory::TOLERANCE);
                let horizon = expected.max(ExponentialHistory::HORIZON);
                match ExponentialHistory::with_horizon(own, tolerance, horizon) {
                    Ok(history) => {
                        choice.estimated_memory = history.memory();
                        choice.error_bound = history.error_bound();
                        Box::new(history)
                    }
                    Err(error) if self.kind == History::Exponentials => return Err(error),
                    Err(_) => {
                        choice = HistoryChoice {
                            kind: History::RelaxedFft,
                            reason: ChoiceReason::NoExponentials,
                            estimated_memory: exact.memory,
                            estimated_cost: exact.cost,
                            ..choice
                        };
                        Box::new(RelaxedFftHistory::new(Arc::clone(kernel)))
                    }
                }
            }
        };
        Ok((history, choice))
    }
}

/// What the table of [`History`] says.
struct Estimate {
    memory: usize,
    cost: f64,
}

impl Estimate {
    fn new(kind: History, kernel: &PatchKernel, steps: usize) -> Self {
        let (q, classes) = (kernel.elements().len() as f64, kernel.classes() as f64);
        let n = steps as f64;
        let (cost, memory) = match kind {
            History::Direct => (q * q * n, 16.0 * (classes + q) * n),
            History::RelaxedFft | History::Auto if RelaxedFftHistory::takes_wavenumbers(kernel) => {
                let length = n.max(64.0).log2().ceil().exp2();
                let levels = (length / 32.0).log2();
                // Transforms of all lengths from 64 to M.
                let transforms = 5.0 * q * (2.0 * length).log2();
                (128.0 * q + levels * (8.0 * q + transforms), (64.0 * q + 32.0) * length)
            }
            History::RelaxedFft | History::Auto => {
                let length = n.max(64.0).log2().ceil().exp2();
                let levels = (length / 64.0).log2();
                (
                    64.0 * q * q + levels * (16.0 * q * q + 5.0 * q * length.log2()),
                    (32.0 * classes + 24.0 * q + 16.0) * length,
                )
            }
            History::Exponentials => {
                let window = ExponentialHistory::window_of(kernel);
                let block = 4.0 * window.sqrt();
                (
                    2.0 * q * q * block
                        + 16.0 * q * q * window / block
                        + 20.0 * q * (2.0 * block).log2()
                        + 3000.0,
                    16.0 * classes * block + 48.0 * classes * window + 64.0 * q * window,
                )
            }
        };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let memory = memory as usize;
        Self { memory, cost }
    }
}
