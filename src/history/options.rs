//! Options of a ground's history, and the history made of them.

use std::sync::Arc;

use super::choice::{ChoiceReason, History, HistoryChoice};
use super::convolution::ExactHistory;
use super::convolution_weights::ConvolutionWeights;
use super::cost::Estimate;
use super::direct::DirectHistory;
use super::exponentials::{ExponentialHistory, LONGEST, MEMORY};
use super::relaxed_fft::{LEAF, RelaxedFftHistory};
use crate::error::Result;
use crate::error::memory;

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

/// A history that was made of them.
pub(super) enum Kept {
    Exact(Box<dyn ExactHistory>),
    Exponentials(Box<ExponentialHistory>),
}

impl Default for HistoryOptions {
    fn default() -> Self {
        Self { kind: History::Auto, tolerance: None, memory: MEMORY }
    }
}

impl HistoryOptions {
    /// An empty history for this many steps, if that is known, and why it is this one.
    pub(super) fn make(
        self,
        kernel: &Arc<dyn ConvolutionWeights>,
        steps: Option<usize>,
    ) -> Result<(Kept, HistoryChoice)> {
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
        let fit = |tolerance, reason, memory| {
            fits(if exponentials.cost.is_finite() { exponentials.memory } else { 0 })?;
            let horizon = expected.max(ExponentialHistory::HORIZON);
            let history = ExponentialHistory::within(own(), tolerance, horizon, memory)?;
            let choice = HistoryChoice {
                estimated_memory: history.memory(),
                error_bound: history.error_bound(),
                ..choice(History::Exponentials, reason, exponentials)
            };
            Ok((Kept::Exponentials(Box::new(history)), choice))
        };
        let asked = ChoiceReason::Asked;
        let tolerance = self.tolerance();
        let reason = match self.kind {
            History::Direct => {
                fits(Estimate::new(History::Direct, &**kernel, LEAF)?.memory)?;
                let choice = choice(History::Direct, asked, estimate(History::Direct)?);
                return Ok((Kept::Exact(Box::new(DirectHistory::new(own()))), choice));
            }
            History::Exponentials => return fit(tolerance, asked, self.memory),
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
                    if let Ok(made) = fit(tolerance, reason, usize::MAX) {
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
        let history = Kept::Exact(Box::new(RelaxedFftHistory::new(own())));
        Ok((history, choice(History::RelaxedFft, reason, exact)))
    }

    /// Tolerance of exponentials that are not taken for their speed.
    pub(super) fn tolerance(self) -> f64 {
        self.tolerance.unwrap_or(ExponentialHistory::TOLERANCE)
    }

    /// As many of these steps as a history of this kind holds in the memory allowed: a larger number
    /// may stand for a run without end.
    pub(crate) fn prepared_steps(
        self,
        kind: History,
        kernel: &dyn ConvolutionWeights,
        mut steps: usize,
    ) -> Result<usize> {
        if let History::Direct | History::RelaxedFft = kind {
            while steps > LEAF && Estimate::new(kind, kernel, steps)?.memory > self.memory {
                steps /= 2;
            }
        }
        Ok(steps)
    }
}
