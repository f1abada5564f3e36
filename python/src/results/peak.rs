//! Extreme values with their times.

use basemat::results::{Extremes, Peak};
use pyo3::prelude::*;

/// A value of a run with its time; ``float()`` returns the value.
#[pyclass(name = "Peak", module = "basemat", frozen, eq)]
#[derive(Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct PyPeak(pub(crate) Peak);

#[pymethods]
impl PyPeak {
    /// The value, in the quantity's unit, with its sign.
    #[getter]
    fn value(&self) -> f64 {
        self.0.value
    }

    /// Time of the value, s.
    #[getter]
    fn time(&self) -> f64 {
        self.0.time
    }

    fn __float__(&self) -> f64 {
        self.0.value
    }

    fn __repr__(&self) -> String {
        format!("Peak(value={:?}, time={:?})", self.0.value, self.0.time)
    }
}

/// Smallest and largest value of a quantity over a run.
#[pyclass(name = "Extremes", module = "basemat", frozen, eq)]
#[derive(Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct PyExtremes(pub(crate) Extremes);

#[pymethods]
impl PyExtremes {
    /// The smallest value, a `Peak` in the quantity's unit.
    #[getter]
    fn lowest(&self) -> PyPeak {
        PyPeak(self.0.lowest)
    }

    /// The largest value, a `Peak` in the quantity's unit.
    #[getter]
    fn highest(&self) -> PyPeak {
        PyPeak(self.0.highest)
    }

    /// The one of `lowest` and `highest` that is further from zero, with its sign: a `Peak` in the quantity's unit.
    #[getter]
    fn largest(&self) -> PyPeak {
        PyPeak(self.0.largest())
    }

    /// Magnitude of `largest`, in the quantity's unit.
    #[getter]
    fn magnitude(&self) -> f64 {
        self.0.magnitude()
    }

    fn __repr__(&self) -> String {
        let Extremes { lowest, highest } = self.0;
        format!(
            "Extremes({:?} at {:?} s, {:?} at {:?} s)",
            lowest.value, lowest.time, highest.value, highest.time
        )
    }
}
