//! The base class of grounds.

use std::sync::Arc;

use basemat::bem::{ContactElement, Ground};
use numpy::PyArray2;
use pyo3::prelude::*;

use crate::error::OrRaise;
use crate::recipe::Recipe;

/// A ground: a description from which every simulation makes one of its own.
#[pyclass(name = "Ground", module = "basemat", subclass, frozen, dict)]
pub(crate) struct PyGround {
    pub(crate) make: Recipe<dyn Ground>,
    elements: Vec<ContactElement>,
}

impl PyGround {
    /// A ground from what makes it, which is tried once.
    pub(crate) fn new<G: Ground + 'static>(
        make: impl Fn() -> basemat::Result<G> + Send + Sync + 'static,
    ) -> PyResult<Self> {
        let elements = make().or_raise()?.elements().to_vec();
        Ok(Self { make: Arc::new(move || Ok(Box::new(make()?))), elements })
    }
}

#[pymethods]
impl PyGround {
    /// Ends of the contact elements from left to right: array of shape (elements, 2), m.
    #[getter]
    fn elements<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let ends: Vec<Vec<f64>> = self.elements.iter().map(|e| vec![e.left, e.right]).collect();
        Ok(PyArray2::from_vec2(py, &ends)?)
    }
}
