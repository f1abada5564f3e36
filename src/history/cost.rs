//! Cost model of the histories: the table of [`History`].

use super::choice::History;
use super::lag_kernel::LagKernel;
use super::relaxed_fft::RelaxedFftHistory;
use crate::error::Result;

/// Memory in bytes, and multiply–adds per step.
#[derive(Clone, Copy)]
pub(super) struct Estimate {
    pub(super) memory: usize,
    pub(super) cost: f64,
}

impl Estimate {
    /// Of a history over `steps` steps; without bound for exponentials of a kernel without late lags.
    pub(super) fn new(kind: History, kernel: &dyn LagKernel, steps: usize) -> Result<Self> {
        let classes = kernel.classes();
        let (q, classes) = (classes.elements().len() as f64, classes.count() as f64);
        let n = steps as f64;
        let length = n.max(64.0).log2().ceil().exp2();
        // A coupling that does not end is a third series of coefficients, and twice the products.
        let lasts = if couples_without_end(kernel)? { 1.0 } else { 0.0 };
        let (cost, memory) = match kind {
            History::Direct => {
                (q * q * n * (1.0 + lasts), (16.0 * (classes + q) + 8.0 * lasts * classes) * n)
            }
            History::RelaxedFft | History::Auto if RelaxedFftHistory::takes_wavenumbers(kernel) => {
                let levels = (length / 32.0).log2();
                // Transforms of all lengths from 64 to M.
                let transforms = 5.0 * q * (2.0 * length).log2();
                (
                    128.0 * q + levels * (8.0 * q * (1.0 + lasts) + transforms),
                    (64.0 * q + 32.0 + 16.0 * lasts * q) * length,
                )
            }
            History::RelaxedFft | History::Auto => {
                let levels = (length / 64.0).log2();
                let products = 16.0 * q * q * (1.0 + lasts);
                (
                    64.0 * q * q + levels * (products + 5.0 * q * length.log2()),
                    ((32.0 + 16.0 * lasts) * classes + 24.0 * q + 16.0) * length,
                )
            }
            History::Exponentials => {
                let Some(late) = kernel.late_lags() else {
                    return Ok(Self { memory: usize::MAX, cost: f64::INFINITY });
                };
                let window = late.window() as f64;
                let block = 4.0 * window.sqrt();
                (
                    2.0 * q * q * block
                        + 16.0 * q * q * window / block
                        + 20.0 * q * (2.0 * block).log2()
                        + 3000.0,
                    16.0 * classes * block + 48.0 * classes * window + 64.0 * q * window,
                )
            }
        };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let memory = memory as usize;
        Ok(Self { memory, cost })
    }
}

/// Whether the coupling of the pair farthest apart never ends.
fn couples_without_end(kernel: &dyn LagKernel) -> Result<bool> {
    let classes = kernel.classes();
    let farthest = classes.pairs()[classes.elements().len() - 1].class;
    Ok(kernel.last_coupling_lag(farthest)?.is_none())
}
