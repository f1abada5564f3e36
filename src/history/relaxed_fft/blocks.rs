//! Blocks of inputs and outputs, over pairs of elements or over wavenumbers.

use crate::error::{ProgressReporter, Result};
use crate::history::convolution_weights::ConvolutionWeights;

/// Number of parts in which the computation of spectra is observed.
pub(super) const SPECTRA_PROGRESS_PARTS: usize = 100;

/// Inputs and outputs so far, and the computation of blocks of outputs from blocks of inputs.
pub(crate) trait HistoryBlocks: Send {
    /// Number of steps for which memory and all levels are ready.
    ///
    /// If it is not a power of two, the outputs of the last blocks end there: they are missing when the capacity grows.
    fn capacity(&self) -> usize;

    /// Number of real numbers stored.
    fn numbers(&self) -> usize;

    /// Makes the blocks ready for at least `steps` steps; `reporter` is notified in [`SPECTRA_PROGRESS_PARTS`].
    ///
    /// Inputs and outputs are unchanged on an error.
    fn grow(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        steps: usize,
        reporter: &mut ProgressReporter,
    ) -> Result<()>;

    /// Makes the blocks ready for any number of steps, in memory that does not grow.
    ///
    /// The coefficients after d = `last_delay`, a leaf times a power of two, must be zero; of a lattice they are ignored.
    /// Call this before the first step, in place of [`HistoryBlocks::grow`], or while the capacity is at most
    /// 2 `last_delay`.
    fn bound(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        last_delay: usize,
        reporter: &mut ProgressReporter,
    ) -> Result<()>;

    /// Adds the effect of the last input, so that the output of `now` is complete.
    ///
    /// The last input is of step `now` − 1.
    fn add_effects(&mut self, now: usize);

    /// Accepts the input of step `now`.
    fn write(&mut self, now: usize, traction: &[f64]);

    /// Number of values that store the input of a step.
    fn width(&self) -> usize;

    /// Appends the stored input of `step`; the effects of inputs before `effects_end` have been added.
    fn input(&self, step: usize, effects_end: usize, values: &mut Vec<f64>);

    /// Accepts for step `now` an input returned by [`HistoryBlocks::input`].
    fn write_input(&mut self, now: usize, input: &[f64]);

    /// Removes all inputs and outputs.
    fn clear(&mut self);

    /// Overwrites `displacement` with the output of step `now`.
    fn read(&mut self, now: usize, displacement: &mut [f64]);
}

/// Writes `inputs` from step `first` on into empty blocks, and adds their effects.
///
/// The effect of the last input is still to be added.
pub(super) fn replay_inputs(blocks: &mut dyn HistoryBlocks, first: usize, inputs: &[f64]) {
    for (input_index, input) in inputs.chunks_exact(blocks.width()).enumerate() {
        let now = first + input_index;
        if input_index > 0 {
            blocks.add_effects(now);
        }
        blocks.write_input(now, input);
    }
}
