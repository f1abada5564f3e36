//! Blocks of inputs and outputs, over pairs of elements or over wavenumbers.

use crate::error::Result;
use crate::history::convolution_weights::ConvolutionWeights;

/// Steps that are summed directly before the smallest block is transformed. Measured with 10 and
/// 14 elements: 16 takes as long, 64 a fifth longer by pairs; by wavenumbers it hardly matters.
pub(crate) const LEAF: usize = 32;

/// Inputs and outputs so far, and how blocks of one give blocks of the other.
pub(crate) trait Blocks: Send {
    /// Steps for which there is room and for which all levels are ready. Where it is no power of
    /// two, the outputs of the last blocks end with it, and are missing when it grows.
    fn capacity(&self) -> usize;

    /// Real numbers held.
    fn numbers(&self) -> usize;

    /// Makes ready for at least `steps` steps. Inputs and outputs stay as they are on an error.
    fn grow(&mut self, kernel: &dyn ConvolutionWeights, steps: usize) -> Result<()>;

    /// Makes ready for any number of steps, in memory that does not grow: no coefficient is other
    /// than zero beyond d = `reach`, a leaf times a power of two. To be called before the first step,
    /// in the place of [`Blocks::grow`].
    fn bound(&mut self, kernel: &dyn ConvolutionWeights, reach: usize) -> Result<()>;

    /// Works the input of step `now` − 1 in, so that the output of `now` is complete.
    fn work_in(&mut self, now: usize);

    /// Accepts the input of step `now`.
    fn write(&mut self, now: usize, traction: &[f64]);

    /// Numbers in which the input of a step is kept.
    fn width(&self) -> usize;

    /// Appends what is kept of the input of `step`; inputs before `worked_in` were worked in.
    fn input(&self, step: usize, worked_in: usize, values: &mut Vec<f64>);

    /// Overwrites `traction` with that of which [`Blocks::input`] gave `input`.
    fn traction(&mut self, input: &[f64], traction: &mut [f64]);

    /// Accepts for step `now` what [`Blocks::input`] gave.
    fn write_input(&mut self, now: usize, input: &[f64]);

    /// Forgets all inputs and outputs.
    fn clear(&mut self);

    /// Overwrites `displacement` with the output of step `now`.
    fn read(&mut self, now: usize, displacement: &mut [f64]);
}
