//! Blocks of inputs and outputs, over pairs of elements or over wavenumbers.

use crate::error::{ProgressReporter, Result};
use crate::history::convolution_weights::ConvolutionWeights;

/// Largest number of progress notifications while spectra are computed.
pub(super) const SPECTRA_PROGRESS_PARTS: usize = 100;

/// Inputs and outputs so far, and the computation of blocks of outputs from blocks of inputs.
pub(crate) trait HistoryBlocks: Send {
    /// Number of steps for which memory and all levels are ready.
    ///
    /// If the capacity is not a power of two, the last blocks compute outputs only up to it. When the capacity grows,
    /// the further outputs must be computed again from the inputs.
    fn capacity(&self) -> usize;

    /// Number of stored real values.
    fn stored_value_count(&self) -> usize;

    /// Extends the blocks to at least `steps` steps.
    ///
    /// `reporter` is notified up to [`SPECTRA_PROGRESS_PARTS`] times. Inputs and outputs are unchanged on an error.
    fn extend_capacity(
        &mut self,
        weights: &dyn ConvolutionWeights,
        steps: usize,
        reporter: &mut ProgressReporter,
    ) -> Result<()>;

    /// Prepares the blocks for any number of steps, in memory that does not grow.
    ///
    /// Weights after `last_delay` (`LEAF_STEPS` times a power of two) must be zero; lattice blocks ignore later weights.
    /// Call this before the first step, in place of [`HistoryBlocks::extend_capacity`], or while the capacity is at most
    /// 2 `last_delay`.
    fn limit_history(
        &mut self,
        weights: &dyn ConvolutionWeights,
        last_delay: usize,
        reporter: &mut ProgressReporter,
    ) -> Result<()>;

    /// Adds the effect of the last input, so that the output of `step` is complete.
    ///
    /// The last input is that of step `step` − 1.
    fn add_effects(&mut self, step: usize);

    /// Accepts the input of `step`.
    fn write_traction(&mut self, step: usize, traction: &[f64]);

    /// Number of values that store the input of a step.
    fn values_per_step(&self) -> usize;

    /// Appends the stored input of `step`; the effects of inputs before `effects_end` have been added.
    fn input(&self, step: usize, effects_end: usize, values: &mut Vec<f64>);

    /// Accepts for `step` an input returned by [`HistoryBlocks::input`].
    fn write_input(&mut self, step: usize, input: &[f64]);

    /// Removes all inputs and outputs.
    fn clear(&mut self);

    /// Overwrites `displacement` with the output of `step`.
    fn read_displacement(&mut self, step: usize, displacement: &mut [f64]);
}

/// Writes `inputs` from `first_step` on into empty blocks, and adds their effects.
///
/// The effect of the last input is still to be added.
pub(super) fn replay_inputs(blocks: &mut dyn HistoryBlocks, first_step: usize, inputs: &[f64]) {
    for (input_index, input) in inputs.chunks_exact(blocks.values_per_step()).enumerate() {
        let step = first_step + input_index;
        if input_index > 0 {
            blocks.add_effects(step);
        }
        blocks.write_input(step, input);
    }
}
