//! The history that a ground keeps, within the memory that it may take, and its options.

use std::sync::Arc;

use super::choice::{ChoiceReason, Estimate, HistoryChoice, HistoryMethod};
use super::convolution::{ConvolutionHistory, ConvolutionWeights, ExactHistory};
use super::direct::DirectHistory;
use super::exponentials::{ExponentialHistory, LONGEST, MEMORY};
use super::last_lag::LastLag;
use super::relaxed_fft::{LEAF, RelaxedFftHistory};
use crate::error::{Error, MemoryError, Observer, Result, memory};

/// Steps for which exponentials are made that take over, times those that are behind them.
const AHEAD: usize = 64;

/// A history by [`HistoryOptions`], and why it is this one.
///
/// An exact one may take the memory allowed, or what it needs for the steps that were announced.
/// Where steps go on beyond, it gives way to the exponentials if it was chosen and not asked for,
/// at a step that depends on options and announcement alone; otherwise the step returns [`Error::Memory`].
pub(crate) struct ChosenHistory {
    kernel: Arc<dyn ConvolutionWeights>,
    options: HistoryOptions,
    choice: HistoryChoice,
    announced: Option<usize>,
    /// Steps whose memory is allowed.
    room: usize,
    kept: Kept,
}

/// Steps that a history of this kind holds in the memory allowed.
fn room(
    options: HistoryOptions,
    kind: HistoryMethod,
    kernel: &dyn ConvolutionWeights,
) -> Result<usize> {
    let mut most = 0;
    // Memory grows by doubling, so that a power of two fills it.
    for power in LEAF.ilog2() + 1..usize::BITS {
        let estimate = Estimate::new(kind, kernel, 1 << power)?;
        if estimate.memory > options.memory {
            break;
        }
        most = 1 << power;
    }
    Ok(most)
}

impl ChosenHistory {
    /// An empty history for this many steps, if that is known.
    pub(crate) fn new(
        options: HistoryOptions,
        kernel: &Arc<dyn ConvolutionWeights>,
        steps: Option<usize>,
    ) -> Result<Self> {
        let (kept, choice) = options.make(kernel, steps)?;
        let (announced, room) = (choice.steps, room(options, choice.kind, &**kernel)?);
        Ok(Self { kernel: Arc::clone(kernel), options, choice, announced, room, kept })
    }

    /// Method chosen, and why.
    pub(crate) fn choice(&self) -> HistoryChoice {
        self.choice
    }

    /// Notes the steps to come for a history that was asked for before they were known.
    pub(crate) fn expect_steps(&mut self, steps: usize) {
        if self.choice.reason == ChoiceReason::Asked {
            self.announced = self.announced.or(Some(steps).filter(|steps| *steps < LONGEST));
        }
    }

    /// Steps that an exact history is kept for.
    fn most(&self) -> usize {
        self.announced.map_or(self.room, |announced| self.room.max(announced))
    }

    /// Steps that are made ready for if so many come.
    fn ready(&self, steps: usize) -> Result<usize> {
        let steps = steps.min(self.most());
        self.options.prepared_steps(self.choice.kind, &*self.kernel, steps)
    }

    /// Steps that are expected of it, to be put back.
    pub(crate) fn expected(&mut self) -> &mut Option<usize> {
        &mut self.announced
    }

    /// Makes the exponentials, without what came before.
    fn successor(&self, most: usize) -> Result<(Box<ExponentialHistory>, HistoryChoice)> {
        let estimate = |kind, steps| Estimate::new(kind, &*self.kernel, steps);
        let next = most.saturating_add(1);
        let grown = next.checked_next_power_of_two().unwrap_or(next);
        let exact = estimate(self.choice.kind, grown)?;
        let refused = Error::Memory(MemoryError {
            quantity: "steps of the convolution history",
            asked: next as f64,
            needed: exact.memory as f64,
            limit: self.options.memory as f64,
            remedy: "announce the steps with `expected_steps`, or allow more with \
                     `HistoryOptions::memory`: a checkpoint can go on there",
        });
        let exponentials = estimate(HistoryMethod::Exponentials, most)?;
        if self.options.method != HistoryMethod::Auto || exponentials.memory >= exact.memory {
            return Err(refused);
        }
        let horizon = ExponentialHistory::HORIZON.max(most.saturating_mul(AHEAD));
        let (kernel, tolerance) = (Arc::clone(&self.kernel), self.options.tolerance());
        let made = ExponentialHistory::within(kernel, tolerance, horizon, usize::MAX);
        let history = Box::new(made.map_err(|_| refused)?);
        let choice = HistoryChoice {
            kind: HistoryMethod::Exponentials,
            reason: ChoiceReason::MemoryLimit,
            estimated_memory: history.memory(),
            estimated_cost: exponentials.cost,
            error_bound: history.error_bound(),
            ..self.choice
        };
        Ok((history, choice))
    }

    /// Gives way to the exponentials where the next step would take more memory than allowed.
    fn bound(&mut self) -> Result<()> {
        let Kept::Exact(exact) = &self.kept else { return Ok(()) };
        let steps = exact.steps();
        // Steps within the smallest blocks, and within those there is room for, cost no look.
        if !steps.is_power_of_two() && self.announced != Some(steps) {
            return Ok(());
        }
        if exact.has_ended() {
            self.room = usize::MAX;
        }
        let most = self.most();
        if steps < most {
            return Ok(());
        }
        let (mut history, choice) = self.successor(most)?;
        let Kept::Exact(exact) = &mut self.kept else { return Ok(()) };
        history.take_over(steps, |step, traction| exact.traction(step, traction));
        (self.kept, self.choice) = (Kept::Exponentials(history), choice);
        Ok(())
    }

    /// The exponentials that this history gives way to before `steps` steps, without earlier tractions;
    /// `None` if it would not have.
    pub(crate) fn succeeded(&self, steps: usize) -> Result<Option<Self>> {
        let most = self.most();
        if matches!(self.kept, Kept::Exponentials(_)) || steps < most {
            return Ok(None);
        }
        let (history, choice) = self.successor(most)?;
        let (kernel, kept) = (Arc::clone(&self.kernel), Kept::Exponentials(history));
        let Self { options, announced, room, .. } = *self;
        Ok(Some(Self { kernel, options, choice, announced, room, kept }))
    }

    fn any(&self) -> &dyn ConvolutionHistory {
        match &self.kept {
            Kept::Exact(history) => &**history,
            Kept::Exponentials(history) => &**history,
        }
    }

    fn any_mut(&mut self) -> &mut dyn ConvolutionHistory {
        match &mut self.kept {
            Kept::Exact(history) => &mut **history,
            Kept::Exponentials(history) => &mut **history,
        }
    }
}

impl ConvolutionHistory for ChosenHistory {
    forward! {
        self.any();
        fn steps(&self) -> usize;
        fn memory(&self) -> usize;
        fn increment_error_bound(&self) -> f64;
        fn save(&self) -> Result<Vec<f64>>;
    }

    forward! {
        self.any_mut();
        fn push(&mut self, traction: &[f64]);
        fn restore(&mut self, steps: usize, values: &[f64]) -> Result<()>;
    }

    /// Reserves memory, only for the steps for which the history is kept.
    fn reserve(&mut self, steps: usize) -> Result<()> {
        let ready = self.ready(steps)?;
        self.any_mut().reserve(ready)
    }

    fn reserve_observed(&mut self, steps: usize, observer: &mut Observer<'_>) -> Result<()> {
        let ready = self.ready(steps)?;
        self.any_mut().reserve_observed(ready, observer)
    }

    fn evaluate(&mut self, displacement: &mut [f64]) -> Result<()> {
        self.bound()?;
        self.any_mut().evaluate(displacement)
    }
}

// Options of a ground's history, and the history made of them.

/// Steps that are estimated for where nothing is known.
const UNKNOWN_STEPS: usize = 100_000;

/// All late coefficients of a ground in plan that may be left out, of all.
const FORGOTTEN: f64 = 1e-8;

/// Error of coefficients that is taken without being allowed: results then differ by rounding.
const ROUNDING: f64 = 1e-12;

/// Options of a ground's history, given to [`ElasticGround::with_history`](crate::bem::ElasticGround::with_history).
///
/// ```
/// use basemat::Soil;
/// use basemat::bem::{ElasticGround, Strip};
/// use basemat::history::{HistoryMethod, HistoryOptions};
///
/// let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
/// let ground = || ElasticGround::new(soil, Strip::graded(-3.0..3.0, 8)?);
/// let direct = ground()?.with_history(HistoryMethod::Direct)?;
/// let coarse = HistoryOptions { tolerance: Some(1e-6), ..HistoryOptions::default() };
/// let approximate = ground()?.with_history(coarse)?;
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistoryOptions {
    /// Method; [`HistoryMethod::Auto`] by default.
    pub method: HistoryMethod,
    /// Relative error that coefficients may have, 1e-12 to 1e-2. Exponentials, which only the half-plane's closed form
    /// has, use it in place of 1e-12 ([`HistoryMethod::Auto`]) or 1e-10 ([`HistoryMethod::Exponentials`]). In plan,
    /// [`HistoryMethod::Auto`] drops late coefficients whose sum is less than this part of the sum of all, once a run
    /// is twice as long as the others: 1e-8 unless given, or their [error](ConvolutionWeights::late_error) if that is
    /// larger.
    pub tolerance: Option<f64>,
    /// Memory that the history may take, bytes; 1 GiB by default.
    ///
    /// [`HistoryMethod::Auto`] goes by it and by the expected steps: those of
    /// [`expected_steps`](crate::coupled::SimulationBuilder::expected_steps) or of the first run. Beyond them, or where
    /// none are known, it holds for every history: a history that was chosen is replaced by exponentials when it
    /// reaches the limit; without exponentials, or with an exact history as the method, the step returns
    /// [`Error::Memory`] and is not made.
    pub memory: usize,
}

impl From<HistoryMethod> for HistoryOptions {
    fn from(method: HistoryMethod) -> Self {
        Self { method, ..Self::default() }
    }
}

/// A history that was made of them.
pub(super) enum Kept {
    Exact(Box<dyn ExactHistory>),
    Exponentials(Box<ExponentialHistory>),
}

impl Default for HistoryOptions {
    fn default() -> Self {
        Self { method: HistoryMethod::Auto, tolerance: None, memory: MEMORY }
    }
}

impl HistoryOptions {
    /// The options, if the tolerance can be reached.
    pub(crate) fn checked(self) -> Result<Self> {
        self.tolerance.map_or(Ok(0.0), ExponentialHistory::check_tolerance)?;
        Ok(self)
    }

    /// An empty history for this many steps, if that is known, and why it is this one.
    pub(super) fn make(
        self,
        kernel: &Arc<dyn ConvolutionWeights>,
        steps: Option<usize>,
    ) -> Result<(Kept, HistoryChoice)> {
        // No run lasts so long: an observer is meant to stop it at an unknown time.
        let steps = steps.filter(|steps| *steps < LONGEST);
        let expected = steps.unwrap_or(UNKNOWN_STEPS);
        let estimate = |kind| Estimate::new(kind, &**kernel, expected);
        let (exact, exponentials) =
            (estimate(HistoryMethod::RelaxedFft)?, estimate(HistoryMethod::Exponentials)?);
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
                ..choice(HistoryMethod::Exponentials, reason, exponentials)
            };
            Ok((Kept::Exponentials(Box::new(history)), choice))
        };
        let asked = ChoiceReason::Asked;
        let tolerance = self.tolerance();
        let reason = match self.method {
            HistoryMethod::Direct => {
                fits(Estimate::new(HistoryMethod::Direct, &**kernel, LEAF)?.memory)?;
                let choice = choice(HistoryMethod::Direct, asked, estimate(HistoryMethod::Direct)?);
                return Ok((Kept::Exact(Box::new(DirectHistory::new(own()))), choice));
            }
            HistoryMethod::Exponentials => return fit(tolerance, asked, self.memory),
            HistoryMethod::RelaxedFft => asked,
            HistoryMethod::Auto => {
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
        fits(Estimate::new(HistoryMethod::RelaxedFft, &**kernel, LEAF)?.memory)?;
        let history = RelaxedFftHistory::new(own());
        if self.method != HistoryMethod::Auto || kernel.classes().plan().is_none() {
            let choice = choice(HistoryMethod::RelaxedFft, reason, exact);
            return Ok((Kept::Exact(Box::new(history)), choice));
        }
        // In plan the soil forgets; what does not fit into memory has to end before.
        let error_bound = self.tolerance.unwrap_or(FORGOTTEN.max(kernel.late_error()));
        let (mut ended, mut reason) = (exact, reason);
        if reason == ChoiceReason::NoExponentials {
            let lags = room(self, HistoryMethod::RelaxedFft, &**kernel)?;
            let Some(end) = LastLag::of(&**kernel, error_bound, lags)? else {
                return Err(Error::Memory(MemoryError {
                    quantity: "steps of the convolution history",
                    asked: expected as f64,
                    needed: exact.memory as f64,
                    limit: self.memory as f64,
                    remedy: "take larger cells or fewer steps, or allow more with `HistoryOptions::memory`",
                }));
            };
            ended = Estimate::new(HistoryMethod::RelaxedFft, &**kernel, 2 * end.lag)?;
            reason = ChoiceReason::WithoutLateLags;
        }
        let choice = choice(HistoryMethod::RelaxedFft, reason, ended);
        let kept = Kept::Exact(Box::new(history.forgetting(error_bound)));
        Ok((kept, HistoryChoice { error_bound, ..choice }))
    }

    /// Tolerance of exponentials that are not taken for their speed.
    pub(super) fn tolerance(self) -> f64 {
        self.tolerance.unwrap_or(ExponentialHistory::TOLERANCE)
    }

    /// Number of these steps that a history of this kind holds in the memory allowed: a larger number
    /// may stand for a run without end.
    pub(crate) fn prepared_steps(
        self,
        kind: HistoryMethod,
        kernel: &dyn ConvolutionWeights,
        mut steps: usize,
    ) -> Result<usize> {
        if let HistoryMethod::Direct | HistoryMethod::RelaxedFft = kind {
            while steps > LEAF && Estimate::new(kind, kernel, steps)?.memory > self.memory {
                steps /= 2;
            }
        }
        Ok(steps)
    }
}
