//! Exponentials fitted to late lags, and how well they fit.

use super::tail::Tail;

/// A fit as it was asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Request {
    /// Lags of the window.
    pub(crate) lags: usize,
    pub(super) horizon: usize,
    pub(super) tolerance: f64,
}

/// Exponentials behind a window, empty, and what was measured of them.
#[derive(Debug)]
pub(crate) struct Fit {
    pub(crate) request: Request,
    pub(super) tail: Tail,
    pub(super) accuracy: Measured,
    /// Least eigenvalue of the operator's Hermitian part.
    pub(super) margin: f64,
}

/// Measured errors.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Measured {
    /// Largest error of any coefficient over the largest coefficient of the same lag.
    pub(super) relative: f64,
    /// Σ over lags of the largest change of an error from lag to lag, m/Pa.
    pub(super) increments: f64,
    /// Largest coefficient at the end of the horizon, m/Pa.
    pub(super) last: f64,
}
