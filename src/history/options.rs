//! Options of a ground's history, and the history made of them.

use std::sync::Arc;

use super::choice::{ChoiceReason, History, HistoryChoice};
use super::convolution::ConvolutionHistory;
use super::cost::Estimate;
use super::direct::DirectHistory;
use super::exponentials::{ExponentialHistory, LONGEST};
use super::lag_kernel::LagKernel;
use super::relaxed_fft::RelaxedFftHistory;
use crate::error::Result;

/// Steps that are estimated for where nothing is known.
const UNKNOWN_STEPS: usize = 100_000;

/// Error of coefficients that is taken without being allowed: results then differ by rounding.
const ROUNDING: f64 = 1e-12;

/// Options of a ground's history.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HistoryOptions {
    pub(crate) kind: History,
    pub(crate) tolerance: Option<f64>,
    /// Bytes.
    pub(crate) memory: usize,
}

impl Default for HistoryOptions {
    fn default() -> Self {
        Self { kind: History::Auto, tolerance: None, memory: 1 << 30 }
    }
}

impl HistoryOptions {
    /// An empty history for this many steps, if that is known, and why it is this one.
    pub(crate) fn make(
        self,
        kernel: &Arc<dyn LagKernel>,
        steps: Option<usize>,
    ) -> Result<(Box<dyn ConvolutionHistory>, HistoryChoice)> {
        // No run lasts so long: an observer is meant to stop it, nobody knows when.
        let steps = steps.filter(|steps| *steps < LONGEST);
        let expected = steps.unwrap_or(UNKNOWN_STEPS);
        let exact = Estimate::new(History::RelaxedFft, &**kernel, expected)?;
        let exponentials = Estimate::new(History::Exponentials, &**kernel, expected)?;
        let shorter = exponentials.of_run(expected) < exact.of_run(expected);
        let (kind, reason) = if self.kind != History::Auto {
            (self.kind, ChoiceReason::Asked)
        } else if self.tolerance.is_some() && shorter {
            (History::Exponentials, ChoiceReason::ToleranceAllowed)
        } else if steps.is_none() {
            (History::RelaxedFft, ChoiceReason::UnknownLength)
        } else if shorter {
            (History::Exponentials, ChoiceReason::Rounding)
        } else if exact.memory <= self.memory {
            (History::RelaxedFft, ChoiceReason::Exact)
        } else {
            (History::Exponentials, ChoiceReason::MemoryLimit)
        };
        let Estimate { memory, cost, .. } = match kind {
            History::Direct => Estimate::new(kind, &**kernel, expected)?,
            History::Exponentials => exponentials,
            History::RelaxedFft | History::Auto => exact,
        };
        let mut choice = HistoryChoice {
            kind,
            reason,
            steps,
            estimated_memory: memory,
            estimated_cost: cost,
            error_bound: 0.0,
            stages: None,
        };
        let own = Arc::clone(kernel);
        let history: Box<dyn ConvolutionHistory> = match kind {
            History::Direct => Box::new(DirectHistory::new(own)),
            History::RelaxedFft | History::Auto => Box::new(RelaxedFftHistory::new(own)),
            History::Exponentials => {
                let unasked = match reason {
                    ChoiceReason::Rounding => ROUNDING,
                    _ => ExponentialHistory::TOLERANCE,
                };
                let tolerance = self.tolerance.unwrap_or(unasked);
                let horizon = expected.max(ExponentialHistory::HORIZON);
                match ExponentialHistory::with_horizon(own, tolerance, horizon) {
                    Ok(history) => {
                        choice.estimated_memory = history.memory();
                        choice.error_bound = history.error_bound();
                        Box::new(history)
                    }
                    Err(error) if self.kind == History::Exponentials => return Err(error),
                    Err(_) => {
                        let reason = match reason {
                            ChoiceReason::MemoryLimit => ChoiceReason::NoExponentials,
                            _ => ChoiceReason::Exact,
                        };
                        choice = HistoryChoice {
                            kind: History::RelaxedFft,
                            reason,
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
