//! History by Fourier transforms of blocks: exact to rounding, O(log² N) per step.

mod blocks;
mod coefficients;
mod element_grid;
mod leaf;
mod level;
mod memory;
mod pairs;
mod plan_spectra;
mod ring;
mod saved_state;
mod wave_level;
mod waves;

use std::sync::Arc;

use self::element_grid::{ElementGrid, MIN_WAVENUMBER_ELEMENTS};
pub(crate) use self::memory::bytes_of_blocks;
use self::memory::max_steps;
use self::pairs::PairBlocks;
use self::saved_state::SavedState;
use self::waves::WaveBlocks;
use super::convolution::{ConvolutionHistory, check_inputs};
use super::convolution_weights::ConvolutionWeights;
use super::last_lag::LastLag;
use crate::error::{
    Error, MemoryError, Observer, Progress, ProgressReporter, Result, memory_limit, same_length,
    unobserved,
};
pub(crate) use crate::history::relaxed_fft::blocks::HistoryBlocks;
use crate::history::relaxed_fft::blocks::{SPECTRA_PROGRESS_PARTS, replay_inputs};
pub(crate) use crate::history::relaxed_fft::ring::LEAF_STEPS;

/// Number of lags of one class in a unit of progress: their spectra take as long as one sample of a layered ground.
const LAGS_PER_PROGRESS_UNIT: usize = 8192;

/// Relaxed blocked convolution: equal to [`DirectHistory`](super::DirectHistory) within rounding.
///
/// The number of steps need not be known in advance.
///
/// Time is divided into leaves of 32 steps. Within a leaf, the effects of inputs on outputs are summed directly. After
/// i steps, i a multiple of 32, let b be the largest number of the form 32 · 2ᵏ that divides i. The effect of the last
/// b inputs on the next b outputs is one convolution of length 2b, computed by transforms (Hairer, Lubich & Schlichte
/// 1985, SIAM J. Sci. Stat. Comput. 6, 532–541). Every pair of input and output is in exactly one leaf or block, so the
/// result is complete and exact.
///
/// Each component is transformed once per block. Products are summed over the sources in the frequency domain, with one
/// spectrum per pair *class*: on a uniform patch Q offsets instead of Q² pairs. The coupling of normal and tangential
/// components ends when the Rayleigh wave has crossed the patch. A coupling of few steps is summed directly; a longer
/// one by blocks that cover its length.
///
/// With 8 or more equal elements on a lattice (a uniform strip, or several strips of one pitch), the tractions of each
/// step are also padded with zeros and transformed along the surface. Every wavenumber is then a separate convolution in
/// time, without products over pairs.
///
/// # Cost
///
/// Q elements, N steps, C classes (Q on a uniform strip, about Q²/4 on a graded one), and
/// log₂(N/32) sizes of blocks:
///
/// | | direct sum | relaxed transforms | with wavenumbers |
/// |---|---|---|---|
/// | multiply–adds per step | 2Q² · N/2 on average | 2Q² · 16 in the leaf; per size 4Q² for products and about 5Q log₂ 2b for transforms | 8Q · 16 in the leaf; per size 8Q for products and about 10Q log₂ 2b for transforms |
/// | coefficients, bytes | 16 C N | 32 C M, M the power of two at or above N | 32 Q M |
/// | tractions, bytes | 16 Q N | 16 Q M | 32 Q M |
/// | scratch, bytes | none | 8 (Q + 2) M | 32 M |
///
/// The cost of steps differs: the step that completes a block of b computes the whole block, 4Q transforms of length
/// 2b.
///
/// All histories of one kernel share its [spectra](ConvolutionWeights::spectra), if the kernel stores them: the first
/// history that needs the spectra computes them, on any thread.
///
/// Memory is allocated by [`prepare`](ConvolutionHistory::prepare). If more steps follow, the memory doubles, as far as
/// [`memory_limit`](crate::memory_limit) allows. Results may differ in the last digits between processors, because the
/// transforms use the widest vector instructions of the processor.
pub struct RelaxedFftHistory {
    kernel: Arc<dyn ConvolutionWeights>,
    /// Blocks; `None` until they are needed.
    blocks: Option<Box<dyn HistoryBlocks>>,
    /// Whether to transform along the surface; `None` to do so where it is faster.
    transforms_surface: Option<bool>,
    /// Number of inputs so far.
    steps: usize,
    /// Whether the effect of the last input is still to be added.
    input_is_pending: bool,
    /// Scratch for tractions of which entries are missing.
    padded_traction: Vec<f64>,
    /// Error of an input that was not accepted.
    input_error: Option<Error>,
    /// Memory allowed, bytes.
    memory_limit: f64,
    /// Fraction of the coefficients' sum that may be neglected; `None` to neglect no lag.
    neglected_fraction: Option<f64>,
    /// Last lag that is not neglected, once found.
    last_lag: Option<LastLag>,
    /// Largest traction so far, Pa; updated only if late lags may be neglected.
    max_traction: f64,
}

short_debug! {
    RelaxedFftHistory; self; elements: self.kernel.classes().elements().len(), steps: self.steps
}

impl RelaxedFftHistory {
    /// Creates a history of `kernel` without inputs.
    pub fn new(kernel: Arc<dyn ConvolutionWeights>) -> Self {
        let padded_traction = vec![0.0; kernel.classes().layout().len()];
        Self {
            kernel,
            blocks: None,
            transforms_surface: None,
            steps: 0,
            input_is_pending: false,
            padded_traction,
            input_error: None,
            memory_limit: memory_limit() as f64,
            neglected_fraction: None,
            last_lag: None,
            max_traction: 0.0,
        }
    }

    /// Sets whether to transform along the surface, where elements are equal and on a lattice.
    ///
    /// By default this is done where it was measured to be faster. Call this before the first step.
    #[must_use]
    pub fn with_surface_transform(mut self, enabled: bool) -> Self {
        self.transforms_surface = Some(enabled);
        self
    }

    /// Limits the memory to `bytes`; steps that need more return [`Error::Memory`].
    pub(super) fn within_memory(mut self, bytes: usize) -> Self {
        self.memory_limit = self.memory_limit.min(bytes as f64);
        self
    }

    /// Neglects late lags in plan whose coefficients' sum is at most `tolerance` of the total.
    pub(super) fn neglecting(mut self, tolerance: f64) -> Self {
        self.neglected_fraction = Some(tolerance);
        self
    }

    /// First input that blocks still need after `steps` steps, if lags after `last_lag` are neglected.
    fn first_needed_input(last_lag: Option<usize>, steps: usize) -> usize {
        last_lag.map_or(0, |last_lag| (steps / last_lag).saturating_sub(1) * last_lag)
    }

    /// Number of lags that blocks for `steps` steps need, a power of two.
    ///
    /// If late lags may be neglected, at most as many as fit into memory.
    ///
    /// # Errors
    /// [`Error::Memory`] for steps that need more memory than allowed.
    fn block_lags(&self, steps: usize) -> Result<usize> {
        let padded_steps = steps.checked_next_power_of_two().unwrap_or(usize::MAX).max(1);
        let needed_lags =
            self.last_lag.map_or(padded_steps, |last_lag| padded_steps.min(2 * last_lag.lag));
        let max_lags = max_steps(&*self.kernel, self.memory_limit)?;
        if needed_lags <= max_lags || (self.neglected_fraction.is_some() && max_lags > 0) {
            return Ok(needed_lags.min(max_lags));
        }
        Err(self.memory_error(steps)?)
    }

    /// Error for a number of steps that need too much memory.
    fn memory_error(&self, steps: usize) -> Result<Error> {
        Ok(Error::Memory(MemoryError {
            quantity: "steps of the convolution history",
            asked: steps as f64,
            needed: bytes_of_blocks(&*self.kernel, steps)?,
            limit: self.memory_limit,
            remedy: "take fewer steps or larger elements, or allow more with \
                     `HistoryOptions::memory`: a run can continue there from a checkpoint",
        }))
    }

    /// Extends the blocks to at least `steps` steps, and returns them.
    fn grow(
        &mut self,
        steps: usize,
        reporter: &mut ProgressReporter,
    ) -> Result<&mut dyn HistoryBlocks> {
        if steps > self.blocks.as_ref().map_or(0, |blocks| blocks.capacity())
            && self.last_lag.is_none()
        {
            let lags = self.block_lags(steps)?;
            if let Some(tolerance) = self.neglected_fraction {
                self.last_lag = LastLag::find(&*self.kernel, tolerance, lags, &mut unobserved)?;
            }
            if self.last_lag.is_none() && lags < steps {
                return Err(self.memory_error(steps)?);
            }
        }
        let kernel = &*self.kernel;
        let blocks: Box<dyn HistoryBlocks> = if let Some(blocks) = self.blocks.take() {
            blocks
        } else {
            let classes = kernel.classes();
            let transforms_surface = self
                .transforms_surface
                .unwrap_or(classes.elements().len() >= MIN_WAVENUMBER_ELEMENTS)
                || classes.plan().is_some();
            match ElementGrid::from_pairs(classes).filter(|_| transforms_surface) {
                Some(grid) => Box::new(WaveBlocks::new(grid, kernel)?),
                None => Box::new(PairBlocks::new(kernel)?),
            }
        };
        let blocks = self.blocks.insert(blocks);
        let capacity = blocks.capacity();
        if capacity < steps {
            let mut inputs = Vec::new();
            let effects_end = self.steps - usize::from(self.input_is_pending);
            if !capacity.is_power_of_two() {
                (0..self.steps).for_each(|step| blocks.input(step, effects_end, &mut inputs));
            }
            match self.last_lag {
                Some(LastLag { lag, .. }) => blocks.limit_history(kernel, lag, reporter)?,
                None => blocks.extend_capacity(kernel, steps, reporter)?,
            }
            if !inputs.is_empty() {
                blocks.clear();
                replay_inputs(&mut **blocks, 0, &inputs);
                if !self.input_is_pending {
                    blocks.add_effects(self.steps);
                }
            }
        }
        Ok(&mut **blocks)
    }

    /// Adds the effect of the last input, so that the next output is complete.
    fn complete_output(&mut self) -> Result<&mut dyn HistoryBlocks> {
        let step = self.steps;
        let input_was_pending = self.input_is_pending;
        self.grow(step.saturating_add(1), &mut ProgressReporter::unobserved())?;
        self.input_is_pending = false;
        let blocks = self.grow(0, &mut ProgressReporter::unobserved())?;
        if input_was_pending {
            blocks.add_effects(step);
        }
        Ok(blocks)
    }
}

impl ConvolutionHistory for RelaxedFftHistory {
    fn steps(&self) -> usize {
        self.steps
    }

    /// Computes weights and spectra, and reports the progress of both.
    fn prepare(&mut self, steps: usize, observer: &mut Observer<'_>) -> Result<()> {
        let kernel = Arc::clone(&self.kernel);
        let lags = self.block_lags(steps)?;
        let spectra_units =
            lags.saturating_mul(kernel.classes().count()) / LAGS_PER_PROGRESS_UNIT + 1;
        let mut progress = Progress::new("convolution weights", 0, spectra_units);
        let mut report_weights = |Progress { done, total, task, .. }: Progress| {
            progress = Progress::new(task, done, total + spectra_units);
            observer(progress)
        };
        let weights_result = match self.neglected_fraction.filter(|_| self.last_lag.is_none()) {
            // In plan the weights are computed up to the last lag that is not neglected.
            Some(tolerance) => LastLag::find(&*kernel, tolerance, lags, &mut report_weights)
                .map(|last_lag| self.last_lag = last_lag),
            None => kernel.prepare(lags, &mut report_weights),
        };
        let weights_units = progress.total - spectra_units;
        let result = weights_result.and_then(|()| {
            let mut report = |spectra_progress: Progress| {
                progress.done =
                    weights_units + spectra_units * spectra_progress.done / SPECTRA_PROGRESS_PARTS;
                observer(progress)
            };
            let mut reporter =
                ProgressReporter::new("spectra", SPECTRA_PROGRESS_PARTS, &mut report);
            self.grow(steps, &mut reporter)?;
            reporter.reach(SPECTRA_PROGRESS_PARTS)
        });
        result.map_err(|error| match error {
            Error::Stopped(_) => Error::Stopped(progress),
            other => other,
        })
    }

    fn evaluate(&mut self, displacement: &mut [f64]) -> Result<()> {
        let traction_count = self.kernel.classes().layout().len();
        same_length("displacement of the history", displacement.len(), traction_count)?;
        if let Some(error) = &self.input_error {
            return Err(error.clone());
        }
        let step = self.steps;
        self.complete_output()?.read_displacement(step, displacement);
        Ok(())
    }

    /// Bound of the change in one step of the displacement due to the neglected lags.
    fn increment_error_bound(&self) -> f64 {
        let passed_last_lag = self.last_lag.filter(|last_lag| self.steps > last_lag.lag);
        passed_last_lag.map_or(0.0, |last_lag| last_lag.change * self.max_traction)
    }

    fn memory(&self) -> usize {
        self.blocks.as_ref().map_or(0, |blocks| blocks.stored_value_count()) * size_of::<f64>()
    }

    fn push(&mut self, traction: &[f64]) {
        if self.input_error.is_none() {
            let step = self.steps;
            let mut padded_traction = std::mem::take(&mut self.padded_traction);
            let count = traction.len().min(padded_traction.len());
            padded_traction[..count].copy_from_slice(&traction[..count]);
            padded_traction[count..].fill(0.0);
            if self.neglected_fraction.is_some() {
                self.max_traction = padded_traction
                    .iter()
                    .fold(self.max_traction, |max_traction, x| max_traction.max(x.abs()));
            }
            match self.complete_output() {
                Ok(blocks) => {
                    blocks.write_traction(step, &padded_traction);
                    self.input_is_pending = true;
                }
                Err(error) => self.input_error = Some(error),
            }
            self.padded_traction = padded_traction;
        }
        self.steps += 1;
    }

    /// Returns all inputs that blocks still need, step by step; `restore` computes their effects again.
    fn save(&self) -> Result<Vec<f64>> {
        if let Some(error) = &self.input_error {
            return Err(error.clone());
        }
        let mut values = Vec::new();
        if let Some(blocks) = &self.blocks {
            let effects_end = self.steps - usize::from(self.input_is_pending);
            let last_lag = self.last_lag.map(|last_lag| last_lag.lag);
            let first_input = Self::first_needed_input(last_lag, self.steps);
            (first_input..self.steps).for_each(|step| blocks.input(step, effects_end, &mut values));
        }
        if self.neglected_fraction.is_some() {
            values.extend([
                self.max_traction,
                self.last_lag.map_or(0.0, |last_lag| last_lag.lag as f64),
            ]);
        }
        Ok(values)
    }

    fn restore(&mut self, steps: usize, values: &[f64]) -> Result<()> {
        // The inputs are checked before memory is allocated: a damaged number of steps may need any amount.
        let input_width = self.grow(1, &mut ProgressReporter::unobserved())?.values_per_step();
        let saved_state = SavedState::new(values, self.neglected_fraction.is_some())?;
        let first_saved = Self::first_needed_input(saved_state.last_lag, steps);
        check_inputs(steps - first_saved, input_width, saved_state.inputs)?;
        self.grow(steps, &mut ProgressReporter::unobserved())?;
        // The last lag may not be determined yet, in this history or in the saved one.
        let last_lag = self.last_lag.map(|last_lag| last_lag.lag);
        let first_input = Self::first_needed_input(last_lag, steps);
        let lags_differ =
            last_lag.zip(saved_state.last_lag).is_some_and(|(lag, saved_lag)| lag != saved_lag);
        if lags_differ || first_input < first_saved {
            return Err(SavedState::CORRUPT_STATE.into());
        }
        let blocks = self.grow(0, &mut ProgressReporter::unobserved())?;
        blocks.clear();
        let needed_inputs = &saved_state.inputs[(first_input - first_saved) * input_width..];
        replay_inputs(blocks, first_input, needed_inputs);
        self.max_traction = saved_state.max_traction;
        self.steps = steps;
        self.input_is_pending = steps > 0;
        self.input_error = None;
        Ok(())
    }
}

/// Creates empty blocks for any number of steps, for coefficients that end at a delay.
///
/// The coefficients of `kernel` must be zero after the delay d = `last_delay`, a leaf times a power of two.
pub(super) fn bounded_blocks(
    kernel: &dyn ConvolutionWeights,
    last_delay: usize,
) -> Result<Box<dyn HistoryBlocks>> {
    let classes = kernel.classes();
    let grid = ElementGrid::from_pairs(classes)
        .filter(|_| classes.elements().len() >= MIN_WAVENUMBER_ELEMENTS);
    let mut blocks: Box<dyn HistoryBlocks> = match grid {
        Some(grid) => Box::new(WaveBlocks::new(grid, kernel)?),
        None => Box::new(PairBlocks::bounded(kernel)?),
    };
    blocks.limit_history(kernel, last_delay, &mut ProgressReporter::unobserved())?;
    Ok(blocks)
}
