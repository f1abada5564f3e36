//! The trait of all histories.

use crate::error::{CheckpointError, Result};

/// Discrete convolution h^N = Σ_{m<N} G^{N−m+1} τ^m, with the inputs known only up to now.
///
/// Contact vectors are laid out as in [`crate::bem`].
#[auto_impl::auto_impl(Box)]
pub trait ConvolutionHistory: Send {
    /// Inputs accepted so far.
    fn steps(&self) -> usize;

    /// Hints that about `steps` inputs will come in all: kernels and memory are made ready.
    ///
    /// # Errors
    /// If a kernel cannot be evaluated.
    fn reserve(&mut self, steps: usize) -> Result<()>;

    /// Overwrites `displacement` with the history at the end of the next step.
    ///
    /// # Errors
    /// If the slice has the wrong length or a kernel cannot be evaluated.
    fn evaluate(&mut self, displacement: &mut [f64]) -> Result<()>;

    /// Accepts the tractions (Pa) of the step that ends now; the caller gives all 2Q.
    fn push(&mut self, traction: &[f64]);

    /// Bound on what is wrong with the change of any element's history displacement over the next
    /// step, m, for the tractions so far; zero (the default) for an exact history.
    fn increment_error_bound(&self) -> f64 {
        0.0
    }

    /// All that the tractions so far have left behind, for [`ConvolutionHistory::restore`].
    ///
    /// # Errors
    /// [`CheckpointError::Unsupported`], unless a history implements it.
    fn save(&self) -> Result<Vec<f64>> {
        Err(CheckpointError::Unsupported { part: "convolution history" }.into())
    }

    /// Goes back (or on) to where `steps` inputs had been accepted and [`save`] returned
    /// `values`; all that follows is then the same to the last bit. Unchanged on an error.
    ///
    /// # Errors
    /// [`CheckpointError::Corrupt`] for values that cannot be those of `steps` inputs,
    /// [`CheckpointError::Unsupported`] unless a history implements it.
    ///
    /// [`save`]: ConvolutionHistory::save
    fn restore(&mut self, _steps: usize, _values: &[f64]) -> Result<()> {
        Err(CheckpointError::Unsupported { part: "convolution history" }.into())
    }
}

/// An exact history, which has all tractions.
pub(super) trait ExactHistory: ConvolutionHistory {
    /// Overwrites `traction` with the input of `step`, one of those accepted.
    fn traction(&mut self, step: usize, traction: &mut [f64]);
}

/// Error unless `values` are `steps` inputs of `size` each.
pub(super) fn check_inputs(steps: usize, size: usize, values: &[f64]) -> Result<()> {
    if steps.checked_mul(size) == Some(values.len()) {
        Ok(())
    } else {
        Err(CheckpointError::Corrupt { quantity: "tractions of the history" }.into())
    }
}
