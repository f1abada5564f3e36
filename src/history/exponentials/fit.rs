//! Fits of exponentials to late convolution weights, shared by the histories of these weights.

use std::sync::Arc;

use super::exact_lags::Lags;
use super::passivity::{self, PassivityMargin};
use super::tail::{MeasuredErrors, Tail};
use crate::error::{Error, Result};
use crate::history::convolution_weights::{ConvolutionWeights, LateWeights};
use crate::history::shared_spectra::SharedSpectra;

/// Ratio of an attempt's target tolerance to that of the previous attempt.
const TOLERANCE_REDUCTION: f64 = 0.2;
/// Largest number of attempts: the last one has 5e-7 of the required tolerance as its target.
const MAX_FIT_ATTEMPTS: usize = 10;

/// Window, horizon and tolerance of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FitRequest {
    /// Number of lags in the window.
    pub(super) lags: usize,
    /// Last lag up to which the tolerance must be satisfied.
    pub(super) horizon: usize,
    /// Largest error of a coefficient, relative to the largest coefficient of its lag.
    pub(super) tolerance: f64,
}

/// Exponentials for the lags after a window, without inputs, and their measured errors.
#[derive(Debug)]
pub(super) struct TailFit {
    pub(super) request: FitRequest,
    pub(super) tail: Tail,
    pub(super) errors: MeasuredErrors,
    /// Smallest eigenvalue of the Hermitian part of the operator; see [`ExponentialFit`](super::ExponentialFit).
    pub(super) passivity_margin: f64,
}

impl TailFit {
    /// Fits exponentials, more in each attempt, until they are accurate and passive.
    pub(super) fn new(
        kernel: &dyn ConvolutionWeights,
        late_weights: &dyn LateWeights,
        request: FitRequest,
    ) -> Result<Self> {
        let FitRequest { lags, horizon, tolerance } = request;
        let exact_lags = Lags::new(kernel, lags)?;
        let mut target_tolerance = tolerance;
        let mut failure = None;
        for _ in 0..MAX_FIT_ATTEMPTS {
            let elements = kernel.classes().elements();
            let tail =
                Tail::new(late_weights.exponentials(lags, horizon, target_tolerance)?, elements)?;
            let errors = MeasuredErrors::measure(kernel, &tail, lags, horizon)?;
            target_tolerance *= TOLERANCE_REDUCTION;
            if errors.largest_relative > tolerance {
                failure.get_or_insert_with(|| accuracy_error(tolerance, errors.largest_relative));
                continue;
            }
            let PassivityMargin { min_eigenvalue, frequency } =
                passivity::margin(kernel, &exact_lags, &tail, horizon as f64);
            // NaN is not passive.
            if min_eigenvalue.is_nan() || min_eigenvalue < 0.0 {
                failure = Some(Error::NotPassive {
                    quantity: "history by exponentials",
                    margin: min_eigenvalue,
                    allowed: 0.0,
                    angle: frequency,
                    radius: 1.0,
                });
                continue;
            }
            return Ok(Self { request, tail, errors, passivity_margin: min_eigenvalue });
        }
        Err(failure.unwrap_or_else(|| accuracy_error(tolerance, f64::INFINITY)))
    }
}

/// Error for a fit whose error is `reached_error`, above `tolerance`.
fn accuracy_error(tolerance: f64, reached_error: f64) -> Error {
    let remedy = "with the largest number of poles tried".to_owned();
    Error::Accuracy {
        quantity: "history by exponentials",
        reached: reached_error,
        tolerance,
        remedy,
    }
}

/// A fit, and the spectra of its window of exact lags.
#[derive(Clone)]
pub(super) struct StoredFit {
    pub(super) fit: Arc<TailFit>,
    pub(super) spectra: SharedSpectra,
}

/// Stores a fit and returns it, or the equal fit that another thread stored first.
///
/// Windows of one length share their spectra.
pub(super) fn store_fit(stored: &mut Vec<StoredFit>, fit: Arc<TailFit>) -> StoredFit {
    if let Some(earlier_fit) =
        stored.iter().find(|earlier_fit| earlier_fit.fit.request == fit.request)
    {
        return earlier_fit.clone();
    }
    let same_window =
        stored.iter().find(|earlier_fit| earlier_fit.fit.request.lags == fit.request.lags);
    let spectra =
        same_window.map_or_else(SharedSpectra::default, |earlier_fit| earlier_fit.spectra.clone());
    let new_fit = StoredFit { fit, spectra };
    stored.push(new_fit.clone());
    new_fit
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bem::{PatchKernel, Strip};
    use crate::soil::Soil;

    /// Two threads may compute the same fit; both then use the fit that is stored first.
    #[test]
    fn histories_share_the_fit_that_is_stored_first() {
        let soil = Soil::new(1.0, 0.3, 1.0).unwrap();
        let elements = Strip::uniform(-1.0..1.0, 3).unwrap().elements();
        let kernel = PatchKernel::new(soil, elements, 0.2).unwrap();
        let mut store = vec![];
        let fits = [1e-9, 1e-9, 1e-4].map(|tolerance| {
            let request = FitRequest { lags: 64, horizon: 1000, tolerance };
            Arc::new(TailFit::new(&kernel, &kernel, request).unwrap())
        });
        let stored = fits.map(|fit| store_fit(&mut store, fit));
        assert!(Arc::ptr_eq(&stored[0].fit, &stored[1].fit));
        assert!(!Arc::ptr_eq(&stored[0].fit, &stored[2].fit));
        assert_eq!(store.len(), 2);
    }
}
