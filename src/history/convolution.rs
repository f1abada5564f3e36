//! Trait of the methods that convolve weights with all past tractions.

use crate::error::{CheckpointError, Observer, Result};

/// Discrete convolution h^N = Σ_{m<N} G^{N−m+1} τ^m, for inputs that arrive step by step.
///
/// Contact vectors are laid out as in [`crate::bem`].
#[auto_impl::auto_impl(Box)]
pub trait ConvolutionHistory: Send {
    /// Number of inputs accepted so far.
    fn steps(&self) -> usize;

    /// Prepares weights and memory for `steps` inputs in total.
    ///
    /// # Errors
    /// [`Error::Stopped`](crate::Error::Stopped) by the observer; [`Error::Memory`](crate::Error::Memory) if the steps
    /// need more memory than allowed; an error if the weights cannot be computed. The history is then unchanged.
    fn prepare(&mut self, steps: usize, observer: &mut Observer<'_>) -> Result<()>;

    /// Overwrites `displacement` with the history at the end of the next step.
    ///
    /// # Errors
    /// An error if the slice has the wrong length or the convolution weights cannot be computed.
    fn evaluate(&mut self, displacement: &mut [f64]) -> Result<()>;

    /// Accepts the tractions (Pa) of the step that ends now.
    ///
    /// `traction` contains all components of all elements.
    fn push(&mut self, traction: &[f64]);

    /// Bytes used by coefficients, tractions and scratch; zero (the default) if unknown.
    fn memory(&self) -> usize {
        0
    }

    /// Upper bound of the error of any element's displacement increment due to past tractions, m.
    ///
    /// It holds for the next step and the tractions so far; zero (the default) for an exact history.
    fn increment_error_bound(&self) -> f64 {
        0.0
    }

    /// Saves the state of the history, for [`ConvolutionHistory::restore`].
    ///
    /// # Errors
    /// [`CheckpointError::Unsupported`], unless a history implements it.
    fn save(&self) -> Result<Vec<f64>> {
        Err(CheckpointError::Unsupported { part: "convolution history" }.into())
    }

    /// Restores the state in which `steps` inputs had been accepted and [`save`] returned `values`.
    ///
    /// All later results are then the same to the last bit. The history is unchanged on an error.
    ///
    /// # Errors
    /// [`CheckpointError::Corrupt`] for values that do not belong to `steps` inputs, [`CheckpointError::Unsupported`]
    /// unless a history implements it.
    ///
    /// [`save`]: ConvolutionHistory::save
    fn restore(&mut self, _steps: usize, _values: &[f64]) -> Result<()> {
        Err(CheckpointError::Unsupported { part: "convolution history" }.into())
    }
}

/// Returns an error unless `values` are `steps` inputs of `input_width` numbers each.
pub(super) fn check_inputs(steps: usize, input_width: usize, values: &[f64]) -> Result<()> {
    if steps.checked_mul(input_width) == Some(values.len()) {
        Ok(())
    } else {
        Err(CheckpointError::Corrupt { quantity: "tractions of the history" }.into())
    }
}
