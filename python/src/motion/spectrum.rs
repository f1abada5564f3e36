//! Response spectra.

use basemat::motion::{Record, SpectralOrdinate};
use pyo3::prelude::*;

use crate::array::{Array, whole_numbers};
use crate::error::OrRaise;

/// A response spectrum: arrays of shape (m,), one value per natural period.
#[pyclass(name = "Spectrum", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PySpectrum(pub(crate) Vec<SpectralOrdinate>, pub(crate) Vec<String>);

/// Warnings of periods that are too short for the time step of a record.
pub(crate) fn coarse_period_warnings(record: &Record, periods: &[f64]) -> Vec<String> {
    record.coarse_spectrum(periods).iter().map(ToString::to_string).collect()
}

/// ``count`` numbers from ``first`` to ``last`` with equal ratios, such as periods: array of shape (count,).
#[pyfunction]
pub(crate) fn log_spaced(
    first: f64,
    last: f64,
    #[pyo3(from_py_with = whole_numbers)] count: usize,
) -> PyResult<Array> {
    Ok(basemat::results::log_spaced(first, last, count).or_raise()?.into())
}

#[pymethods]
impl PySpectrum {
    /// Natural periods: array of shape (m,), s.
    #[getter]
    fn period(&self) -> Array {
        self.0.iter().map(|ordinate| ordinate.period).collect()
    }

    /// Largest displacements relative to the ground or floor: array of shape (m,), m.
    #[getter]
    fn displacement(&self) -> Array {
        self.0.iter().map(|ordinate| ordinate.displacement).collect()
    }

    /// Pseudo-velocities: array of shape (m,), m/s.
    #[getter]
    fn pseudo_velocity(&self) -> Array {
        self.0.iter().map(|ordinate| ordinate.pseudo_velocity).collect()
    }

    /// Pseudo-accelerations: array of shape (m,), m/s².
    #[getter]
    fn pseudo_acceleration(&self) -> Array {
        self.0.iter().map(|ordinate| ordinate.pseudo_acceleration).collect()
    }

    /// Largest total accelerations: array of shape (m,), m/s².
    #[getter]
    fn acceleration(&self) -> Array {
        self.0.iter().map(|ordinate| ordinate.acceleration).collect()
    }

    /// Texts of warnings of periods shorter than ten time steps of the record, where the spectrum is not exact.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.1.clone()
    }

    /// Spectrum with peaks that are broadened to both sides by the ``fraction`` of their frequency, 0.15 by default
    /// (U.S. NRC R.G. 1.122).
    #[pyo3(signature = (fraction=0.15))]
    fn broadened(&self, fraction: f64) -> PyResult<Self> {
        let broadened = basemat::results::broadened(&self.0, fraction).or_raise()?;
        Ok(Self(broadened, self.1.clone()))
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }

    fn __repr__(&self) -> String {
        format!("Spectrum({} periods)", self.0.len())
    }
}
