//! Time schemes.

use std::sync::Arc;

use basemat::coupled::{DissipativeMidpoint, HhtAlpha, Midpoint, Newmark, Theta, TimeScheme};
use pyo3::prelude::*;

use crate::error::OrRaise;
use crate::recipe::Recipe;

/// A time scheme of the structure: the midpoint rule unless given.
#[pyclass(name = "TimeScheme", module = "basemat", frozen, dict)]
#[derive(Clone)]
pub(crate) struct PyTimeScheme {
    pub(super) make: Recipe<dyn TimeScheme>,
}

/// The object of Python for a time scheme of the core.
fn new_scheme(
    scheme: basemat::Result<impl TimeScheme + Clone + Sync + 'static>,
) -> PyResult<PyTimeScheme> {
    let scheme = scheme.or_raise()?;
    Ok(PyTimeScheme { make: Arc::new(move || Ok(Box::new(scheme.clone()))) })
}

#[pymethods]
impl PyTimeScheme {
    /// The midpoint rule, which conserves energy.
    #[staticmethod]
    fn midpoint() -> PyResult<Self> {
        new_scheme(Ok(Midpoint))
    }

    /// The midpoint rule with damping of high frequencies. It is of second order, and its coupling with the soil adds
    /// no energy. ``gamma``: ½ (the midpoint rule) to 1; 0.8 by default.
    #[pyo3(signature = (gamma=0.8))]
    #[staticmethod]
    fn dissipative_midpoint(gamma: f64) -> PyResult<Self> {
        new_scheme(DissipativeMidpoint::new(gamma))
    }

    /// The θ rule; ``theta``: ½ (the midpoint rule) to 1. First order above ½.
    #[staticmethod]
    fn theta(theta: f64) -> PyResult<Self> {
        new_scheme(Theta::new(theta))
    }

    /// Newmark's rule, for comparison with papers: its coupling with the soil may add energy. ``gamma`` and ``beta``:
    /// Newmark's γ and β, by default ½ and ¼ (average acceleration).
    #[pyo3(signature = (gamma=0.5, beta=0.25))]
    #[staticmethod]
    fn newmark(gamma: f64, beta: f64) -> PyResult<Self> {
        new_scheme(Newmark::new(gamma, beta))
    }

    /// The rule of Hilber, Hughes and Taylor, for comparison with papers: its coupling with the soil may add energy.
    /// ``alpha``: −⅓ (most damping) to 0 (none).
    #[staticmethod]
    fn hht_alpha(alpha: f64) -> PyResult<Self> {
        new_scheme(HhtAlpha::new(alpha))
    }
}
