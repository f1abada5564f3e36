//! Kernel and history of a ground for one time step.

use std::sync::Arc;

use crate::error::{Error, Observer, Progress, Result, Watch};
use crate::history::{
    ChosenHistory, ConvolutionHistory, ConvolutionWeights, HistoryChoice, HistoryMethod,
    HistoryOptions, RESERVED_STEPS,
};

/// Lags of a class of which spectra are made in the time of a sample of layered ground.
const SPECTRA: usize = 8192;

/// A kernel and the history made of it.
pub(super) struct Prepared {
    pub(super) kernel: Arc<dyn ConvolutionWeights>,
    /// Left open until the number of steps is known or the first step is made.
    pub(super) history: Option<Kept>,
}

pub(super) enum Kept {
    Chosen(ChosenHistory),
    Own(Box<dyn ConvolutionHistory>),
}

impl Kept {
    pub(super) fn any(&self) -> &dyn ConvolutionHistory {
        match self {
            Self::Chosen(history) => history,
            Self::Own(history) => &**history,
        }
    }

    pub(super) fn any_mut(&mut self) -> &mut dyn ConvolutionHistory {
        match self {
            Self::Chosen(history) => history,
            Self::Own(history) => &mut **history,
        }
    }
}

impl Prepared {
    /// The history, made now if it has not been.
    pub(super) fn history(
        &mut self,
        options: HistoryOptions,
        steps: Option<usize>,
    ) -> Result<&mut dyn ConvolutionHistory> {
        let history = match self.history.take() {
            Some(history) => history,
            None => Kept::Chosen(ChosenHistory::new(options, &self.kernel, steps)?),
        };
        let history = self.history.insert(history);
        if let (Kept::Chosen(history), Some(steps)) = (&mut *history, steps) {
            history.expect_steps(steps);
        }
        Ok(history.any_mut())
    }

    /// Makes ready for `steps` steps, weights and spectra. What is stopped leaves no trace but weights.
    pub(super) fn expect_steps(
        &mut self,
        options: HistoryOptions,
        steps: usize,
        observer: Option<&mut Observer<'_>>,
    ) -> Result<()> {
        let Some(observer) = observer else { return self.reserve(options, steps, None) };
        let exponentials =
            self.choice().is_some_and(|choice| choice.kind == HistoryMethod::Exponentials);
        let kernel = Arc::clone(&self.kernel);
        let method = HistoryMethod::RelaxedFft;
        let lags = options.prepared_steps(method, &*kernel, steps.max(1))?;
        // As many as a history takes, by a power of two.
        let lags = lags.checked_next_power_of_two().unwrap_or(lags);
        let spectra = lags.saturating_mul(kernel.classes().count()) / SPECTRA + 1;
        let mut whole = Progress { task: "convolution weights", done: 0, total: spectra };
        // Exponentials have all weights that they need.
        let weights = if exponentials {
            Ok(())
        } else {
            kernel.prepare_observed(lags, &mut |Progress { done, total, task }| {
                whole = Progress { task, done, total: total + spectra };
                observer(whole)
            })
        };
        let done = whole.total - spectra;
        let outcome = weights.and_then(|()| {
            self.reserve(
                options,
                steps,
                Some(&mut |part| {
                    whole.done = done + spectra * part.done / part.total.max(1);
                    observer(whole)
                }),
            )
        });
        outcome.map_err(|error| match error {
            Error::Stopped(_) => Error::Stopped(whole),
            other => other,
        })
    }

    /// Makes the history ready for `steps` steps.
    fn reserve(
        &mut self,
        options: HistoryOptions,
        steps: usize,
        observer: Option<&mut Observer<'_>>,
    ) -> Result<()> {
        let before = self.history.as_mut().map(|history| match history {
            Kept::Chosen(history) => *history.expected(),
            Kept::Own(_) => None,
        });
        let mut watch = observer.map_or_else(Watch::nobody, |observer| Watch::new("", 1, observer));
        let mut outcome = Ok(());
        if steps > 0 {
            let history = self.history(options, Some(steps))?;
            if steps <= history.steps().saturating_add(RESERVED_STEPS) {
                outcome = match watch.observer() {
                    Some(observer) => history.reserve_observed(steps, observer),
                    None => history.reserve(steps),
                };
            }
        }
        let outcome = outcome.and_then(|()| watch.reach(1));
        if let Err(Error::Stopped(_)) = outcome {
            match (before, &mut self.history) {
                (Some(before), Some(Kept::Chosen(history))) => *history.expected() = before,
                (Some(_), _) => {}
                (None, history) => *history = None,
            }
        }
        outcome
    }

    /// Choice of the history; `None` before one is made, and for one of the user's own.
    pub(super) fn choice(&self) -> Option<HistoryChoice> {
        match &self.history {
            Some(Kept::Chosen(history)) => Some(history.choice()),
            _ => None,
        }
    }
}
