//! Convolution histories: what all past tractions give at the end of the next step.

mod direct;
mod relaxed_fft;
mod source;

pub use direct::DirectHistory;
pub use relaxed_fft::RelaxedFftHistory;

use crate::error::Result;

/// Discrete convolution h^N = Σ_{m<N} G^{N−m+1} τ^m, with the inputs known only up to now.
///
/// Contact vectors are laid out as in [`crate::bem`].
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

    /// Accepts the tractions of the step that ends now (2Q, Pa; missing entries count as zero).
    fn push(&mut self, traction: &[f64]);
}
