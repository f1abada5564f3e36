//! Impedances of a rigid strip.

use basemat::Complex;
use basemat::bem::layered::{StripContact, StripImpedance};
use numpy::{Complex64, PyArray1};
use pyo3::prelude::*;

use crate::error::refuse;
use crate::saved::{Reduced, reduced};

/// Dynamic stiffness of a rigid, massless base for motions e^(iωt), per metre of thickness: complex
/// arrays of shape (m,), one value per frequency; the imaginary part is that of radiation and damping.
#[pyclass(name = "Impedances", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyImpedances(pub(super) Vec<StripImpedance>);

type Array<'py> = Bound<'py, PyArray1<Complex64>>;

pub(super) fn contact(name: &str) -> PyResult<StripContact> {
    match name {
        "bonded" => Ok(StripContact::Bonded),
        "relaxed" => Ok(StripContact::Relaxed),
        _ => Err(refuse(format!("contact is '{name}', but must be 'bonded' or 'relaxed'"))),
    }
}

impl PyImpedances {
    fn column<'py>(&self, py: Python<'py>, value: fn(&StripImpedance) -> Complex) -> Array<'py> {
        let numbers = self.0.iter().map(value).map(|value| Complex64::new(value.re, value.im));
        PyArray1::from_iter(py, numbers)
    }
}

#[pymethods]
impl PyImpedances {
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf)
    }

    /// Frequencies: array of shape (m,), Hz.
    #[getter]
    fn frequency<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, self.0.iter().map(|own| own.frequency))
    }

    /// Horizontal force by horizontal translation: complex array of shape (m,), N/m².
    #[getter]
    fn horizontal<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.column(py, |own| own.horizontal)
    }

    /// Vertical force by vertical translation: complex array of shape (m,), N/m².
    #[getter]
    fn vertical<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.column(py, |own| own.vertical)
    }

    /// Moment by rotation: complex array of shape (m,), N.
    #[getter]
    fn rocking<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.column(py, |own| own.rocking)
    }

    /// Horizontal force by rotation: complex array of shape (m,), N/m.
    #[getter]
    fn coupling<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.column(py, |own| own.coupling)
    }
}
