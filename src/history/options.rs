//! Options of a ground's history, and the history made of them.

use std::sync::Arc;

use super::choice::{ChoiceReason, History, HistoryChoice};
use super::convolution::ConvolutionHistory;
use super::cost::Estimate;
use super::direct::DirectHistory;
use super::exponentials::{ExponentialHistory, LONGEST};
use super::lag_kernel::LagKernel;
use super::relaxed_fft::{LEAF, RelaxedFftHistory};
use crate::error::Result;
use crate::memory;

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
        let estimate = |kind| Estimate::new(kind, &**kernel, expected);
        let (exact, exponentials) =
            (estimate(History::RelaxedFft)?, estimate(History::Exponentials)?);
        let fits = |needed: usize| {
            let count = kernel.classes().elements().len();
            memory::check("contact elements", count as f64, needed as f64)
        };
        let choice = |kind, reason, Estimate { memory, cost, .. }| HistoryChoice {
            kind,
            reason,
            steps,
            estimated_memory: memory,
            estimated_cost: cost,
            error_bound: 0.0,
            stages: None,
        };
        let own = || Arc::clone(kernel);
        let fit = |tolerance, reason| {
            fits(if exponentials.cost.is_finite() { exponentials.memory } else { 0 })?;
            let horizon = expected.max(ExponentialHistory::HORIZON);
            let history = ExponentialHistory::with_horizon(own(), tolerance, horizon)?;
            let choice = HistoryChoice {
                estimated_memory: history.memory(),
                error_bound: history.error_bound(),
                ..choice(History::Exponentials, reason, exponentials)
            };
            Ok((Box::new(history) as Box<dyn ConvolutionHistory>, choice))
        };
        let asked = ChoiceReason::Asked;
        let tolerance = self.tolerance.unwrap_or(ExponentialHistory::TOLERANCE);
        let reason = match self.kind {
            History::Direct => {
                fits(Estimate::new(History::Direct, &**kernel, LEAF)?.memory)?;
                let choice = choice(History::Direct, asked, estimate(History::Direct)?);
                return Ok((Box::new(DirectHistory::new(own())), choice));
            }
            History::Exponentials => return fit(tolerance, asked),
            History::RelaxedFft => asked,
            History::Auto => {
                let known = steps.map(|_| (ROUNDING, ChoiceReason::Rounding));
                let allowed = self.tolerance.map(|it| (it, ChoiceReason::ToleranceAllowed));
                let shorter = exponentials.of_run(expected) < exact.of_run(expected);
                let affordable = exact.memory <= self.memory;
                let smaller = steps.is_some() && !affordable && exponentials.memory < exact.memory;
                let attempts = [
                    allowed.or(known).filter(|_| shorter),
                    smaller.then_some((tolerance, ChoiceReason::MemoryLimit)),
                ];
                for (tolerance, reason) in attempts.into_iter().flatten() {
                    if let Ok(made) = fit(tolerance, reason) {
                        return Ok(made);
                    }
                }
                match (steps, affordable) {
                    (None, _) => ChoiceReason::UnknownLength,
                    (_, true) => ChoiceReason::Exact,
                    (_, false) => ChoiceReason::NoExponentials,
                }
            }
        };
        fits(Estimate::new(History::RelaxedFft, &**kernel, LEAF)?.memory)?;
        let history = Box::new(RelaxedFftHistory::new(own()));
        Ok((history, choice(History::RelaxedFft, reason, exact)))
    }

    /// As many of these steps as a history of this kind holds in the memory allowed: a larger number
    /// may stand for a run without end. All where the history is one of the user's own.
    pub(crate) fn prepared_steps(
        self,
        kind: Option<History>,
        kernel: &dyn LagKernel,
        mut steps: usize,
    ) -> Result<usize> {
        if let Some(kind @ (History::Direct | History::RelaxedFft)) = kind {
            while steps > LEAF && Estimate::new(kind, kernel, steps)?.memory > self.memory {
                steps /= 2;
            }
        }
        Ok(steps)
    }
}
