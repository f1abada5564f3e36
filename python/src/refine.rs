//! Error against run time.

use basemat::coupled::Refinement;
use pyo3::prelude::*;

use crate::array::{Array, Numbers, real};
use crate::error::{OrRaise, heard, kept, returned};

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

members! {
    PyRefinement, own;
    /// Results of the settings, in the units of the scene: list of 6 arrays of shape (results,).
    results: Vec<Array> = own.0.settings.iter().map(|setting| setting.results.as_slice().into()).collect();
    /// Time steps of the settings: array of shape (6,), s.
    time_steps: Array = own.0.settings.iter().map(|setting| setting.time_step).collect();
    /// Estimated errors of the settings, relative to the size of the results: array of shape (6,).
    errors: Array = own.0.settings.iter().map(|setting| setting.error).collect();
    /// Wall times of the settings: array of shape (6,), s.
    wall_times: Array = own.0.settings.iter().map(|setting| setting.wall.as_secs_f64()).collect();
    /// Numbers of elements of the settings: list of 6.
    elements: Vec<usize> = own.0.settings.iter().map(|setting| setting.elements).collect();
    /// Results extrapolated to infinitely many elements and steps: array of shape (results,), in the
    /// units of the scene.
    extrapolated: Array = own.0.extrapolated.as_slice().into();
    /// Observed order of convergence in the element length; NaN if nothing depends on it.
    mesh_order: f64 = own.0.mesh_order;
    /// Observed order of convergence in the time step; NaN if nothing depends on it.
    step_order: f64 = own.0.step_order;
    /// Distance of the last setting's results from those that the other errors foretell, relative to
    /// the size of the results.
    mismatch: f64 = own.0.mismatch;
    /// Whether the estimate can be trusted: regular orders, and the coarsest error above the
    /// mismatch.
    is_regular: bool = own.0.is_regular();
}

#[pymethods]
impl PyRefinement {
    fn __str__(&self) -> String {
        self.0.to_string()
    }
}
