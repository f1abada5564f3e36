//! Response spectra.

use basemat::motion::SpectralOrdinate;
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::array::whole;
use crate::error::OrRaise;
use crate::saved::{Reduced, reduced};

/// A response spectrum: arrays of shape (m,), one value per natural period.
#[pyclass(name = "Spectrum", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PySpectrum(pub(crate) Vec<SpectralOrdinate>);

type Array<'py> = Bound<'py, PyArray1<f64>>;

impl PySpectrum {
    fn column<'py>(&self, py: Python<'py>, value: impl Fn(&SpectralOrdinate) -> f64) -> Array<'py> {
        PyArray1::from_iter(py, self.0.iter().map(value))
    }
}

/// ``count`` numbers from ``first`` to ``last`` with equal ratios, for periods in s: array of shape
/// (count,).
#[pyfunction]
pub(crate) fn log_spaced(
    py: Python<'_>,
    first: f64,
    last: f64,
    #[pyo3(from_py_with = whole)] count: usize,
) -> PyResult<Array<'_>> {
    Ok(PyArray1::from_vec(py, basemat::results::log_spaced(first, last, count).or_raise()?))
}

#[pymethods]
impl PySpectrum {
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf)
    }

    /// Natural periods: array of shape (m,), s.
    #[getter]
    fn period<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.column(py, |ordinate| ordinate.period)
    }

    /// Largest displacements relative to the ground or floor: array of shape (m,), m.
    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.column(py, |ordinate| ordinate.displacement)
    }

    /// Pseudo-velocities: array of shape (m,), m/s.
    #[getter]
    fn pseudo_velocity<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.column(py, |ordinate| ordinate.pseudo_velocity)
    }

    /// Pseudo-accelerations: array of shape (m,), m/s².
    #[getter]
    fn pseudo_acceleration<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.column(py, |ordinate| ordinate.pseudo_acceleration)
    }

    /// Largest total accelerations: array of shape (m,), m/s².
    #[getter]
    fn acceleration<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.column(py, |ordinate| ordinate.acceleration)
    }

    /// Spectrum with its peaks broadened to frequencies lower and higher by the fraction ``share``, 0.15
    /// by default (U.S. NRC R.G. 1.122).
    #[pyo3(signature = (share=0.15))]
    fn broadened(&self, share: f64) -> PyResult<Self> {
        Ok(Self(basemat::results::broadened(&self.0, share).or_raise()?))
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }

    fn __repr__(&self) -> String {
        format!("Spectrum({} periods)", self.0.len())
    }
}
