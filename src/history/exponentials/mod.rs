//! History in constant memory: a window of exact lags, and exponentials for later lags.

mod exact_lags;
mod fit;
mod passivity;
mod sampled_pairs;
mod tail;

use std::sync::Arc;

use self::exact_lags::WindowedWeights;
use self::fit::{FitRequest, StoredFit, TailFit, store_fit};
use self::tail::Tail;
use super::convolution::ConvolutionHistory;
use super::convolution_weights::{ConvolutionWeights, LateWeights};
use super::relaxed_fft::{HistoryBlocks, LEAF_STEPS, bounded_blocks, bytes_of_blocks};
use super::shared_spectra::{SharedSpectra, lock};
use crate::error::{
    CheckpointError, Error, MemoryError, Observer, ProgressReporter, Result, require, same_length,
};

/// Longest window, lags.
///
/// With a longer window the step is so short that the window may cover the whole run.
const MAX_WINDOW_LAGS: usize = 1_000_000;
/// Tolerances that a user may require: smaller ones are below rounding, larger ones are of no use.
const TOLERANCE_RANGE: std::ops::RangeInclusive<f64> = 1e-12..=1e-2;
/// Default memory limit, bytes.
pub(super) const DEFAULT_MEMORY: usize = 1 << 30;

/// Window of exact lags and a sum of exponentials for later lags: O(1) memory and time per step.
///
/// The convolution weights of the lags 2 to W are exact. They act in the blocks of
/// [`RelaxedFftHistory`](super::RelaxedFftHistory) up to length W. Later weights are sums of decaying exponentials in
/// time with a common set of poles, and of a few functions over the patch in space. The effect of all tractions before
/// the last 2W steps is stored in a few hundred numbers, for any number of steps.
///
/// The kernel must provide its [late lags](ConvolutionWeights::late_weights). On the half-plane they begin when the
/// Rayleigh wave has crossed the patch three times. By then the coupling is zero. The normal and tangential weights are
/// integrals of decaying exponentials, which the trapezoidal rule in the logarithm of the rate approximates by sums. The
/// functions in space are Legendre polynomials over the patch.
///
/// # Accuracy
///
/// Every coefficient is within `tolerance` of the exact one, relative to the largest coefficient of the same lag, up to
/// a horizon: 2²⁰ steps, unless another horizon is set. The number of steps need not be known in advance. Beyond the
/// horizon the relative error grows in proportion to the lag, because the slowest pole stays the same. When the history
/// is created, the error is measured against the exact coefficients ([`ExponentialFit::error_bound`]), and the spacing of
/// the poles is reduced until the error is within the tolerance. The energy balance contains a bound of the error's
/// effect on a run's energies ([`EnergyBalance::soil_error_bound`](crate::coupled::EnergyBalance::soil_error_bound)).
///
/// # Passivity
///
/// The exact operator creates no energy; a fit that creates energy could make a run unstable. When the history is
/// created, the smallest eigenvalue of the Hermitian part of (1−ζ)Ĝ(ζ) on |ζ| = 1 is computed, with the window and the
/// exponentials in closed form. If the eigenvalue is negative, fits with more and closer poles are tried. If all of them
/// fail, the error is [`Error::NotPassive`]. The margin of the discrete operator is large
/// ([`ExponentialFit::passivity_margin`]): about a tenth of the immediate displacement. Only coarse tolerances with
/// windows of thousands of steps (nearly incompressible soil, very short steps) need the additional poles.
pub struct ExponentialHistory {
    kernel: Arc<dyn ConvolutionWeights>,
    fit: Arc<TailFit>,
    /// Blocks of the exact lags.
    window_blocks: Box<dyn HistoryBlocks>,
    /// Exponentials of the later lags, and their state.
    tail: Tail,
    /// The last 2W inputs, input m in slot m mod 2W.
    recent_inputs: Vec<f64>,
    steps: usize,
    /// Whether the effect of the last input is still to be added.
    input_is_pending: bool,
    /// Largest Σ|τ| in any step so far, Pa.
    largest_traction: f64,
}

/// Size, accuracy and passivity of the fit of an [`ExponentialHistory`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ExponentialFit {
    /// Number of exact lags.
    pub window: usize,
    /// Number of exponentials for later lags.
    pub poles: usize,
    /// Number of functions over the patch for later lags.
    pub functions: usize,
    /// Largest error of any coefficient up to the horizon, relative to the largest coefficient of its lag.
    ///
    /// The error is measured when the history is created, and is at most the required tolerance.
    pub error_bound: f64,
    /// Margin against the creation of energy, relative to the immediate displacement; not negative.
    ///
    /// The margin is the smallest eigenvalue of the Hermitian part of (1−ζ)Ĝ(ζ) on |ζ| = 1, divided by the value for an
    /// immediate displacement (G¹ alone, element by element).
    pub passivity_margin: f64,
}

short_debug! {
    ExponentialHistory;
    self;
    elements: self.kernel.classes().elements().len(),
    steps: self.steps,
    lags: self.window_lags(),
    horizon: self.fit.request.horizon,
    tolerance: self.fit.request.tolerance,
}

impl ExponentialHistory {
    /// Default tolerance.
    pub(crate) const DEFAULT_TOLERANCE: f64 = 1e-10;
    /// Default horizon, the number of steps over which the tolerance is satisfied.
    pub(crate) const DEFAULT_HORIZON: usize = 1 << 20;
    /// Longest horizon, steps.
    ///
    /// It is far below the largest integer of 64 bits, or of a processor with shorter integers.
    pub(crate) const MAX_HORIZON: usize = match 1_usize.checked_shl(40) {
        Some(steps) => steps,
        None => usize::MAX >> 4,
    };

    /// Creates a history without inputs, with the coefficients of `kernel` within `tolerance`.
    ///
    /// The error of a coefficient is relative to the largest coefficient of its lag.
    ///
    /// # Errors
    /// [`Error::Scene`] for a kernel without late lags, or whose coupling has not ended before them;
    /// [`Error::Input`] for a tolerance not between 1e-12 and 1e-2; [`Error::Memory`] for a time step so short that the
    /// window would take more than 1 GiB; [`Error::Accuracy`] if the tolerance was not reached; [`Error::NotPassive`]
    /// if the fit creates energy.
    pub fn new(kernel: Arc<dyn ConvolutionWeights>, tolerance: f64) -> Result<Self> {
        Self::with_horizon(kernel, tolerance, Self::DEFAULT_HORIZON)
    }

    /// Creates a history without inputs whose `tolerance` is satisfied up to `horizon` steps.
    ///
    /// # Errors
    /// As for [`ExponentialHistory::new`].
    pub fn with_horizon(
        kernel: Arc<dyn ConvolutionWeights>,
        tolerance: f64,
        horizon: usize,
    ) -> Result<Self> {
        Self::within_memory(kernel, tolerance, horizon, DEFAULT_MEMORY)
    }

    /// Creates the history as [`ExponentialHistory::with_horizon`] does, within `memory` bytes including the fit.
    pub(crate) fn within_memory(
        kernel: Arc<dyn ConvolutionWeights>,
        tolerance: f64,
        horizon: usize,
        memory: usize,
    ) -> Result<Self> {
        Self::check_tolerance(tolerance)?;
        let Some(late) = kernel.late_weights() else { return Err(NO_LATE_LAGS) };
        let elements = kernel.classes().elements();
        let lags = whole_block_lags(late)?;
        let needed_bytes = window_bytes(&*kernel, lags)?;
        if needed_bytes > memory as f64 {
            return Err(Error::Memory(MemoryError {
                quantity: "lags before a history by exponentials",
                asked: lags as f64,
                needed: needed_bytes,
                limit: memory as f64,
                remedy: "take a longer time step or fewer elements, or allow more with \
                         `HistoryOptions::memory`",
            }));
        }
        let horizon = horizon.clamp(2 * lags, Self::MAX_HORIZON);
        let request = FitRequest { lags, horizon, tolerance };
        let store = kernel.spectra().filter(|spectra| spectra.belong_to(elements));
        let store = store.map(SharedSpectra::tables::<Vec<StoredFit>>);
        let stored = store.as_deref().and_then(|store| {
            lock(store).iter().find(|stored| stored.fit.request == request).cloned()
        });
        let StoredFit { fit, spectra } = if let Some(stored) = stored {
            stored
        } else {
            // The fit is made while the store is not locked: threads of the kernel must not wait for the lock.
            let fit = Arc::new(TailFit::new(&*kernel, late, request)?);
            match store.as_deref() {
                Some(store) => store_fit(&mut lock(store), fit),
                None => StoredFit { fit, spectra: SharedSpectra::default() },
            }
        };
        let window_blocks =
            bounded_blocks(&WindowedWeights { kernel: &*kernel, lags, spectra: &spectra }, lags)?;
        Ok(Self {
            window_blocks,
            recent_inputs: vec![0.0; 2 * lags * kernel.classes().layout().len()],
            tail: fit.tail.clone(),
            fit,
            steps: 0,
            input_is_pending: false,
            largest_traction: 0.0,
            kernel,
        })
    }

    /// Describes the fit: exact lags, exponentials, and their errors.
    pub fn fit(&self) -> ExponentialFit {
        ExponentialFit {
            window: self.window_lags(),
            poles: self.tail.pole_count(),
            functions: self.tail.function_count(),
            error_bound: self.error_bound(),
            passivity_margin: self.fit.passivity_margin,
        }
    }

    pub(crate) fn error_bound(&self) -> f64 {
        self.fit.errors.largest_relative
    }

    pub(crate) fn horizon(&self) -> usize {
        self.fit.request.horizon
    }

    fn window_lags(&self) -> usize {
        self.fit.request.lags
    }

    /// Returns `tolerance`, or an error if no fit can reach it.
    pub(crate) fn check_tolerance(tolerance: f64) -> Result<f64> {
        let is_in_range = TOLERANCE_RANGE.contains(&tolerance);
        require("tolerance of the history", tolerance, is_in_range, "from 1e-12 to 1e-2")
    }

    /// Number of tractions in one step.
    fn traction_count(&self) -> usize {
        self.kernel.classes().layout().len()
    }

    /// Range of input `m` in `recent_inputs`.
    fn input_range(&self, m: usize) -> std::ops::Range<usize> {
        let traction_count = self.traction_count();
        let slot = m % (2 * self.window_lags());
        slot * traction_count..(slot + 1) * traction_count
    }

    /// Inputs that the window needs for outputs from `steps` on; the first begins a block.
    fn window_inputs(&self, steps: usize) -> std::ops::Range<usize> {
        let lags = self.window_lags();
        (steps / lags * lags).saturating_sub(lags)..steps
    }

    /// Adds the effect of the last input, so that the next output is complete.
    fn complete_output(&mut self) {
        if std::mem::take(&mut self.input_is_pending) {
            self.window_blocks.add_effects(self.steps);
        }
    }

    /// Stores the input of one step, and adds the input that leaves the window to the exponentials.
    fn store_input(&mut self, write_input: impl FnOnce(&mut [f64])) {
        let input_range = self.input_range(self.steps);
        let stored = &mut self.recent_inputs[input_range];
        write_input(stored);
        self.largest_traction = self.largest_traction.max(stored.iter().map(|t| t.abs()).sum());
        self.steps += 1;
        let leaving_range = self.steps.checked_sub(self.window_lags()).map(|m| self.input_range(m));
        self.tail.advance(leaving_range.map(|range| &self.recent_inputs[range]));
    }

    /// Writes the last inputs into the window.
    fn refill_window(&mut self) {
        self.window_blocks.clear();
        let window_inputs = self.window_inputs(self.steps);
        let first_input = window_inputs.start;
        for m in window_inputs {
            if m > first_input {
                self.window_blocks.add_effects(m);
            }
            let input_range = self.input_range(m);
            self.window_blocks.write_traction(m, &self.recent_inputs[input_range]);
        }
        self.input_is_pending = self.steps > 0;
    }
}

/// Bytes of a window of `lags` with its inputs, and of the coefficients during the fit.
fn window_bytes(kernel: &dyn ConvolutionWeights, lags: usize) -> Result<f64> {
    let classes = kernel.classes();
    let numbers_per_lag = 4 * classes.elements().len() + 2 * classes.count();
    Ok(bytes_of_blocks(kernel, lags)? + (8 * numbers_per_lag) as f64 * lags as f64)
}

/// Number of lags in the window, a whole block of the transforms.
///
/// A part of a block would take as much time as a whole block.
fn whole_block_lags(late_weights: &dyn LateWeights) -> Result<usize> {
    let lags = late_weights.window();
    let needed = "a million or fewer for a history by exponentials";
    require("lags before the exponentials", lags as f64, lags <= MAX_WINDOW_LAGS, needed)?;
    Ok(lags.next_power_of_two().max(LEAF_STEPS))
}

/// Error for convolution weights without late lags.
const NO_LATE_LAGS: Error = Error::Scene {
    quantity: "history by exponentials",
    needed: "convolution weights that are sums of exponentials at late lags",
};

impl ConvolutionHistory for ExponentialHistory {
    fn steps(&self) -> usize {
        self.steps
    }

    /// Does nothing: memory does not grow.
    fn prepare(&mut self, _steps: usize, observer: &mut Observer<'_>) -> Result<()> {
        ProgressReporter::new("history by exponentials", 1, observer).reach(1)
    }

    fn evaluate(&mut self, displacement: &mut [f64]) -> Result<()> {
        same_length("displacement of the history", displacement.len(), self.traction_count())?;
        self.complete_output();
        self.window_blocks.read_displacement(self.steps, displacement);
        self.tail.add_displacement(displacement);
        Ok(())
    }

    fn memory(&self) -> usize {
        self.tail.memory()
            + (self.window_blocks.stored_value_count() + self.recent_inputs.len())
                * size_of::<f64>()
    }

    fn push(&mut self, traction: &[f64]) {
        self.complete_output();
        let step = self.steps;
        self.store_input(|stored| {
            for (i, value) in stored.iter_mut().enumerate() {
                *value = traction.get(i).copied().unwrap_or(0.0);
            }
        });
        let input_range = self.input_range(step);
        self.window_blocks.write_traction(step, &self.recent_inputs[input_range]);
        self.input_is_pending = true;
    }

    fn increment_error_bound(&self) -> f64 {
        // Beyond the horizon the error may be as large as the remaining coefficients.
        let TailFit { request, errors, .. } = &*self.fit;
        let late_error =
            if self.steps > request.horizon { 2.0 * errors.last_coefficient } else { 0.0 };
        (errors.increment_sum + late_error) * self.largest_traction
    }

    /// Returns the largest traction, the exponentials' state, and the last inputs.
    fn save(&self) -> Result<Vec<f64>> {
        let mut values = vec![self.largest_traction];
        values.extend(self.tail.state());
        for m in self.window_inputs(self.steps) {
            values.extend_from_slice(&self.recent_inputs[self.input_range(m)]);
        }
        Ok(values)
    }

    fn restore(&mut self, steps: usize, values: &[f64]) -> Result<()> {
        let state_length = self.tail.state_length();
        let window_inputs = self.window_inputs(steps);
        if values.len() != 1 + state_length + window_inputs.len() * self.traction_count() {
            return Err(CheckpointError::Corrupt { quantity: "history by exponentials" }.into());
        }
        self.steps = steps;
        self.largest_traction = values[0];
        self.tail.set_state(&values[1..=state_length]);
        let traction_count = self.traction_count();
        for (m, input) in window_inputs.zip(values[state_length + 1..].chunks_exact(traction_count))
        {
            let input_range = self.input_range(m);
            self.recent_inputs[input_range].copy_from_slice(input);
        }
        self.refill_window();
        Ok(())
    }
}
