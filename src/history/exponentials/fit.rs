//! Fits of exponentials to late convolution weights, shared by the histories of these weights.

use std::sync::Arc;

use super::exact_lags::Lags;
use super::passivity::{self, Margin};
use super::tail::{Measured, Tail};
use crate::error::{Error, Result};
use crate::history::convolution_weights::{ConvolutionWeights, LateWeights};
use crate::history::shared_spectra::SharedSpectra;

/// Ratio of the error aimed at in an attempt to the error aimed at in the attempt before.
const CLOSER: f64 = 0.2;
/// Largest number of attempts: enough to reach rounding from any tolerance.
const ATTEMPTS: usize = 10;

/// Window, horizon and tolerance of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Request {
    /// Number of lags in the window.
    pub(super) lags: usize,
    pub(super) horizon: usize,
    pub(super) tolerance: f64,
}

/// Exponentials for the lags after a window, without inputs, and their measured errors.
#[derive(Debug)]
pub(super) struct Fit {
    pub(super) request: Request,
    pub(super) tail: Tail,
    pub(super) accuracy: Measured,
    /// Smallest eigenvalue of the operator's Hermitian part.
    pub(super) margin: f64,
}

impl Fit {
    /// Fits the fewest exponentials that are accurate and passive.
    pub(super) fn new(
        kernel: &dyn ConvolutionWeights,
        late: &dyn LateWeights,
        request: Request,
    ) -> Result<Self> {
        let Request { lags, horizon, tolerance } = request;
        let exact = Lags::new(kernel, lags)?;
        let (mut aim, mut refusal) = (tolerance, None);
        for _ in 0..ATTEMPTS {
            let elements = kernel.classes().elements();
            let tail = Tail::new(late.exponentials(lags, horizon, aim)?, elements)?;
            let accuracy = Measured::over(kernel, &tail, lags, horizon)?;
            aim *= CLOSER;
            if accuracy.relative > tolerance {
                let reached = accuracy.relative;
                refusal.get_or_insert_with(|| inaccurate(tolerance, reached));
                continue;
            }
            let Margin { least, frequency } =
                passivity::margin(kernel, &exact, &tail, horizon as f64);
            // A NaN is an error as well.
            if least.is_nan() || least < 0.0 {
                refusal = Some(Error::NotPassive {
                    quantity: "history by exponentials",
                    margin: least,
                    allowed: 0.0,
                    angle: frequency,
                    radius: 1.0,
                });
                continue;
            }
            return Ok(Self { request, tail, accuracy, margin: least });
        }
        Err(refusal.unwrap_or_else(|| inaccurate(tolerance, f64::INFINITY)))
    }
}

fn inaccurate(tolerance: f64, reached: f64) -> Error {
    let remedy = "with the largest number of poles tried".to_owned();
    Error::Accuracy { quantity: "history by exponentials", reached, tolerance, remedy }
}

/// A fit, and the spectra of its window alone.
#[derive(Clone)]
pub(super) struct Windowed {
    pub(super) fit: Arc<Fit>,
    pub(super) spectra: SharedSpectra,
}

/// Stores a fit and returns it; if another thread was first, returns the fit of that thread.
///
/// Windows of one length share their spectra.
pub(super) fn keep(made: &mut Vec<Windowed>, fit: Arc<Fit>) -> Windowed {
    if let Some(known) = made.iter().find(|known| known.fit.request == fit.request) {
        return known.clone();
    }
    let same = made.iter().find(|known| known.fit.request.lags == fit.request.lags);
    let spectra = same.map_or_else(SharedSpectra::default, |known| known.spectra.clone());
    let new = Windowed { fit, spectra };
    made.push(new.clone());
    new
}
