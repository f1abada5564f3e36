//! Error against run time.

use basemat::coupled::Refinement;
use numpy::{PyArray1, ToPyArray};
use pyo3::prelude::*;

use crate::array::{Numbers, real};
use crate::error::{OrRaise, heard, kept, returned};
use crate::saved::{Reduced, reduced};

/// Error against run time at six settings: what :func:`refine` returns. Printed, it is a table.
#[pyclass(name = "Refinement", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyRefinement(Refinement);

/// Runs a scene at six settings and estimates the error of each by Richardson's extrapolation.
///
/// ``scene(elements, time_step)`` builds and runs, and returns a number or an array: a peak, some
/// peaks, or a time series at times that all settings have (those of the coarsest). Settings are
/// ``elements`` and ``time_step`` (s), half and a quarter of the step, two and four times the
/// elements, and twice the elements with half the step.
#[pyfunction]
pub(crate) fn refine(
    py: Python<'_>,
    elements: usize,
    time_step: f64,
    scene: Py<PyAny>,
) -> PyResult<PyRefinement> {
    let results = |elements: usize, time_step: f64| {
        let found = scene.call1(py, (elements, time_step)).and_then(|value| {
            let value = value.bind(py);
            match real("the result of a scene", value) {
                Ok(number) => Ok(vec![number]),
                Err(_) => returned::<Numbers>("the scene", value).map(|numbers| numbers.0),
            }
        });
        found.map_err(|error| kept("scene", error))
    };
    heard(|| basemat::coupled::refine(elements, time_step, results).or_raise()).map(PyRefinement)
}

impl PyRefinement {
    fn array<'py>(
        &self,
        py: Python<'py>,
        of: impl Fn(&basemat::coupled::Setting) -> f64,
    ) -> Bound<'py, PyArray1<f64>> {
        self.0.settings.iter().map(of).collect::<Vec<_>>().to_pyarray(py)
    }
}

#[pymethods]
impl PyRefinement {
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf)
    }

    /// Numbers of elements of the settings: list of 6.
    #[getter]
    fn elements(&self) -> Vec<usize> {
        self.0.settings.iter().map(|setting| setting.elements).collect()
    }

    /// Time steps of the settings: array of shape (6,), s.
    #[getter]
    fn time_steps<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.array(py, |setting| setting.time_step)
    }

    /// Estimated errors of the settings, relative to the size of the results: array of shape (6,).
    #[getter]
    fn errors<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.array(py, |setting| setting.error)
    }

    /// Wall times of the settings: array of shape (6,), s.
    #[getter]
    fn wall_times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.array(py, |setting| setting.wall.as_secs_f64())
    }

    /// Results of the settings, in the units of the scene: list of 6 arrays of shape (results,).
    #[getter]
    fn results<'py>(&self, py: Python<'py>) -> Vec<Bound<'py, PyArray1<f64>>> {
        self.0.settings.iter().map(|setting| setting.results.to_pyarray(py)).collect()
    }

    /// Results extrapolated to infinitely many elements and steps: array of shape (results,), in the
    /// units of the scene.
    #[getter]
    fn extrapolated<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.0.extrapolated.to_pyarray(py)
    }

    /// Observed order of convergence in the element length; NaN if nothing depends on it.
    #[getter]
    fn mesh_order(&self) -> f64 {
        self.0.mesh_order
    }

    /// Observed order of convergence in the time step; NaN if nothing depends on it.
    #[getter]
    fn step_order(&self) -> f64 {
        self.0.step_order
    }

    /// Distance of the last setting's results from those that the other errors foretell, relative to
    /// the size of the results.
    #[getter]
    fn mismatch(&self) -> f64 {
        self.0.mismatch
    }

    /// Whether the estimate can be trusted: regular orders, and the coarsest error above the
    /// mismatch.
    #[getter]
    fn is_regular(&self) -> bool {
        self.0.is_regular()
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }
}
