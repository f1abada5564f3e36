//! Cost model of the histories: the table of [`History`].

use super::choice::History;
use super::convolution_weights::{ConvolutionWeights, LateWeights};
use super::relaxed_fft::{LEAF, RelaxedFftHistory};
use crate::error::Result;

/// Longest window of exponentials: the step is so short that all of a run may lie in it.
pub(super) const LONGEST_WINDOW: usize = 1_000_000;

/// Memory in bytes, and multiply–adds.
#[derive(Clone, Copy)]
pub(super) struct Estimate {
    pub(super) memory: usize,
    /// Per step.
    pub(super) cost: f64,
    /// Before the first step.
    pub(super) making: f64,
}

/// Multiply–adds that a coefficient of one class takes, its transforms included. Measured, as are
/// those for the exponentials: 10 elements, 54 000 lags, 60 ms; exponentials 12 ms with 10 elements
/// and 250 ms with 100.
const COEFFICIENT: f64 = 500.0;
/// Exponentials, and the search for passivity per cubed number of elements.
const EXPONENTIALS: f64 = 5.0e7;
const PASSIVITY: f64 = 1200.0;
/// Multiply–adds per step for the exponentials behind the window.
const TAIL: f64 = 3000.0;

impl Estimate {
    /// Of a history over `steps` steps; without bound for exponentials that cannot be had.
    pub(super) fn new(
        kind: History,
        kernel: &dyn ConvolutionWeights,
        steps: usize,
    ) -> Result<Self> {
        let classes = kernel.classes();
        let (q, classes) = (classes.elements().len() as f64, classes.count() as f64);
        // A coupling that does not end is a third series of coefficients, and twice the products.
        let lasts = if couples_without_end(kernel)? { 1.0 } else { 0.0 };
        match kind {
            History::Direct => {
                let n = steps as f64;
                let memory = (16.0 * (classes + q) + 8.0 * lasts * classes) * n;
                let making = COEFFICIENT * classes * n;
                Ok(Self::of(q * q * n * (1.0 + lasts), memory, making))
            }
            History::RelaxedFft | History::Auto => Ok(Self::transforms(kernel, steps, lasts)),
            History::Exponentials => {
                let late = kernel.late_weights().map(LateWeights::window);
                let Some(late) = late.filter(|late| *late <= LONGEST_WINDOW && lasts == 0.0) else {
                    return Ok(Self::of(f64::INFINITY, f64::INFINITY, f64::INFINITY));
                };
                let window = late.next_power_of_two().max(LEAF);
                let block = Self::transforms(kernel, window, lasts);
                let memory = block.memory as f64 + 32.0 * q * window as f64;
                let making = block.making + EXPONENTIALS + PASSIVITY * q.powi(3);
                Ok(Self::of(block.cost + TAIL, memory, making))
            }
        }
    }

    /// Bytes of a window of so many lags with the inputs in it, and of the lags themselves while
    /// the exponentials behind it are made.
    pub(super) fn window(kernel: &dyn ConvolutionWeights, lags: usize) -> Result<f64> {
        let classes = kernel.classes();
        let (q, classes) = (classes.elements().len() as f64, classes.count() as f64);
        let lasts = if couples_without_end(kernel)? { 1.0 } else { 0.0 };
        let block = Self::transforms(kernel, lags, lasts).memory as f64;
        Ok(block + (32.0 * q + 16.0 * classes) * lags as f64)
    }

    /// Of blocks up to this many steps.
    fn transforms(kernel: &dyn ConvolutionWeights, steps: usize, lasts: f64) -> Self {
        let classes = kernel.classes();
        let (q, classes) = (classes.elements().len() as f64, classes.count() as f64);
        let length = (steps as f64).max(64.0).log2().ceil().exp2();
        let making = COEFFICIENT * classes * length;
        if RelaxedFftHistory::takes_wavenumbers(kernel) {
            let levels = (length / 32.0).log2();
            // Transforms of all lengths from 64 to M.
            let transforms = 5.0 * q * (2.0 * length).log2();
            Self::of(
                128.0 * q + levels * (8.0 * q * (1.0 + lasts) + transforms),
                (64.0 * q + 32.0 + 16.0 * lasts * q) * length,
                making,
            )
        } else {
            let levels = (length / 64.0).log2();
            let products = 16.0 * q * q * (1.0 + lasts);
            Self::of(
                64.0 * q * q + levels * (products + 5.0 * q * length.log2()),
                ((32.0 + 16.0 * lasts) * classes + 24.0 * q + 16.0) * length,
                making,
            )
        }
    }

    fn of(cost: f64, memory: f64, making: f64) -> Self {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let memory = memory as usize;
        Self { memory, cost, making }
    }

    /// Multiply–adds of a run of so many steps.
    pub(super) fn of_run(&self, steps: usize) -> f64 {
        self.making + self.cost * steps as f64
    }
}

/// Whether the coupling of the pair farthest apart never ends.
fn couples_without_end(kernel: &dyn ConvolutionWeights) -> Result<bool> {
    let classes = kernel.classes();
    let farthest = classes.pairs()[classes.elements().len() - 1].class;
    Ok(kernel.last_coupling_lag(farthest)?.is_none())
}
