//! Time schemes.

use std::sync::Arc;

use basemat::coupled::{DissipativeMidpoint, HhtAlpha, Midpoint, Newmark, Theta, TimeScheme};
use pyo3::prelude::*;

use crate::error::OrRaise;
use crate::recipe::Recipe;

/// A time scheme of the structure: the midpoint rule unless told otherwise.
#[pyclass(name = "TimeScheme", module = "basemat", frozen, dict)]
pub(crate) struct PyTimeScheme {
    pub(super) make: Recipe<dyn TimeScheme>,
}

fn copied(scheme: impl TimeScheme + Clone + Sync + 'static) -> PyTimeScheme {
    PyTimeScheme { make: Arc::new(move || Ok(Box::new(scheme.clone()))) }
}

#[pymethods]
impl PyTimeScheme {
    /// The midpoint rule: conserves energy.
    #[staticmethod]
    fn midpoint() -> Self {
        copied(Midpoint)
    }

    /// The midpoint rule that damps high frequencies: second order, makes no energy with the soil.
    /// ``gamma``: ½ (the midpoint rule) to 1; 0.8 by default.
    #[staticmethod]
    #[pyo3(signature = (gamma=0.8))]
    fn dissipative_midpoint(gamma: f64) -> PyResult<Self> {
        Ok(copied(DissipativeMidpoint::new(gamma).or_raise()?))
    }

    /// The θ rule; ``theta``: ½ (the midpoint rule) to 1. First order above ½.
    #[staticmethod]
    fn theta(theta: f64) -> PyResult<Self> {
        Ok(copied(Theta::new(theta).or_raise()?))
    }

    /// Newmark's rule, for comparison with papers: its coupling with the soil may make energy.
    /// ``gamma`` and ``beta`` are his γ and β, by default ½ and ¼ (average acceleration).
    #[staticmethod]
    #[pyo3(signature = (gamma=0.5, beta=0.25))]
    fn newmark(gamma: f64, beta: f64) -> PyResult<Self> {
        Ok(copied(Newmark::new(gamma, beta).or_raise()?))
    }

    /// The rule of Hilber, Hughes and Taylor, for comparison with papers: its coupling with the soil may
    /// make energy. ``alpha``: −⅓ (most damping) to 0 (none).
    #[staticmethod]
    fn hht_alpha(alpha: f64) -> PyResult<Self> {
        Ok(copied(HhtAlpha::new(alpha).or_raise()?))
    }
}
