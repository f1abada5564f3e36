//! Options of a ground's history, and the rule by which it is chosen.

use std::sync::Arc;

use super::chosen::{ChosenHistory, HistoryMethod};
use super::convolution_weights::ConvolutionWeights;
use super::direct::DirectHistory;
use super::exponentials::{DEFAULT_MEMORY, ExponentialHistory};
use super::relaxed_fft::{LEAF_STEPS, RelaxedFftHistory, bytes_of_blocks};
use crate::error::{Result, memory};

/// Sum of the late convolution weights that a ground in plan may neglect, relative to the sum of all.
const NEGLECTED_WEIGHT_FRACTION: f64 = 1e-8;
/// Tolerance of exponentials that the rule chooses: it changes results by rounding only.
const AUTO_EXPONENTIALS_TOLERANCE: f64 = 1e-12;
/// Longest window with which the rule chooses exponentials, lags.
///
/// The fit for such a window takes a few tenths of a second.
const MAX_AUTO_WINDOW_LAGS: usize = 1 << 14;

/// Options of a ground's history, given to [`ElasticGround::with_history`](crate::bem::ElasticGround::with_history).
///
/// ```
/// use basemat::Soil;
/// use basemat::bem::{ElasticGround, Strip};
/// use basemat::history::{HistoryMethod, HistoryOptions};
///
/// let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
/// let ground = || ElasticGround::new(soil, Strip::graded(-3.0..3.0, 8)?);
/// let direct_ground = ground()?.with_history(HistoryMethod::Direct)?;
/// let options = HistoryOptions { tolerance: Some(1e-6), ..HistoryOptions::default() };
/// let approximate_ground = ground()?.with_history(options)?;
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistoryOptions {
    /// Method; [`HistoryMethod::Auto`] by default.
    pub method: HistoryMethod,
    /// Relative error that convolution weights may have, 1e-12 to 1e-2.
    ///
    /// Exponentials, which only the half-plane's closed form has, use it in place of 1e-12 ([`HistoryMethod::Auto`]) or
    /// 1e-10 ([`HistoryMethod::Exponentials`]). In plan, [`HistoryMethod::Auto`] neglects late weights whose sum is
    /// less than this fraction of the sum of all weights, if half of the run, rounded up to a power of two, has all
    /// remaining lags. With `None` the fraction is 1e-8, or the [error](ConvolutionWeights::late_error) of late weights
    /// if that is larger.
    pub tolerance: Option<f64>,
    /// Memory that the history may use, bytes; 1 GiB by default.
    ///
    /// A run that needs more returns [`Error::Memory`](crate::Error::Memory) when its number of steps becomes known
    /// ([`expected_steps`](crate::coupled::SimulationBuilder::expected_steps), [`run`](crate::Simulation::run)), or
    /// else before the first step that needs more. A run can be continued from a checkpoint with more memory.
    pub memory: usize,
}

impl From<HistoryMethod> for HistoryOptions {
    fn from(method: HistoryMethod) -> Self {
        Self { method, ..Self::default() }
    }
}

impl Default for HistoryOptions {
    fn default() -> Self {
        Self { method: HistoryMethod::Auto, tolerance: None, memory: DEFAULT_MEMORY }
    }
}

impl HistoryOptions {
    /// Returns the options, or an error if the tolerance cannot be reached.
    pub(crate) fn checked(self) -> Result<Self> {
        self.tolerance.map_or(Ok(0.0), ExponentialHistory::check_tolerance)?;
        Ok(self)
    }

    /// Creates a history of `weights` without inputs.
    ///
    /// `steps`: number of steps of the run; `None` if unknown.
    pub(crate) fn history(
        self,
        weights: &Arc<dyn ConvolutionWeights>,
        steps: Option<usize>,
    ) -> Result<ChosenHistory> {
        let element_count = weights.classes().elements().len() as f64;
        memory::check("contact elements", element_count, bytes_of_blocks(&**weights, LEAF_STEPS)?)?;
        Ok(match self.method {
            HistoryMethod::Direct => {
                let history = DirectHistory::new(Arc::clone(weights)).within_memory(self.memory);
                ChosenHistory::direct(history, steps)
            }
            HistoryMethod::RelaxedFft => {
                ChosenHistory::transforms(self.transforms(weights), steps, 0.0)
            }
            HistoryMethod::Exponentials => {
                let tolerance = ExponentialHistory::DEFAULT_TOLERANCE;
                ChosenHistory::exponentials(self.exponentials(weights, steps, tolerance)?, steps)
            }
            HistoryMethod::Auto => self.history_by_rule(weights, steps),
        })
    }

    /// History by the rule of [`HistoryMethod::Auto`].
    fn history_by_rule(
        self,
        weights: &Arc<dyn ConvolutionWeights>,
        steps: Option<usize>,
    ) -> ChosenHistory {
        let has_short_window =
            weights.late_weights().is_some_and(|late| late.window() <= MAX_AUTO_WINDOW_LAGS);
        if has_short_window
            && let Ok(history) = self.exponentials(weights, steps, AUTO_EXPONENTIALS_TOLERANCE)
        {
            return ChosenHistory::exponentials(history, steps);
        }
        if weights.classes().plan().is_none() {
            return ChosenHistory::transforms(self.transforms(weights), steps, 0.0);
        }
        let default_fraction = NEGLECTED_WEIGHT_FRACTION.max(weights.late_error());
        let neglected_fraction = self.tolerance.unwrap_or(default_fraction);
        let history = self.transforms(weights).neglecting(neglected_fraction);
        ChosenHistory::transforms(history, steps, neglected_fraction)
    }

    /// History by relaxed transforms within the option's memory.
    fn transforms(self, weights: &Arc<dyn ConvolutionWeights>) -> RelaxedFftHistory {
        RelaxedFftHistory::new(Arc::clone(weights)).within_memory(self.memory)
    }

    /// History by exponentials within the option's tolerance, or else `default_tolerance`.
    fn exponentials(
        self,
        weights: &Arc<dyn ConvolutionWeights>,
        steps: Option<usize>,
        default_tolerance: f64,
    ) -> Result<ExponentialHistory> {
        let tolerance = self.tolerance.unwrap_or(default_tolerance);
        let horizon = steps.unwrap_or(0).max(ExponentialHistory::DEFAULT_HORIZON);
        ExponentialHistory::within_memory(Arc::clone(weights), tolerance, horizon, self.memory)
    }
}
