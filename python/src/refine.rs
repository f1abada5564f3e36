//! Error against run time at several settings, and sensitivity of peaks.

use basemat::analyses::{PeakTwins, Refinement, Refinements, Sensitivity};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::{Array, Numbers, real_number};
use crate::error::{
    OrRaise, extract_returned, in_python_words, input_error, raise_user_exceptions, user_code_error,
};

/// Error against run time at six settings: what `refine` returns. Printed, it is a table.
#[pyclass(name = "Refinement", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyRefinement(Refinement);

/// Runs a scene at six settings and estimates the error of each.
///
/// The estimate is Richardson's extrapolation. ``scene(elements, time_step)`` builds and runs a simulation, and returns
/// a number or an array: a peak, some peaks, or a time series at times that all settings have (the times of the
/// coarsest setting). The settings are: ``elements`` and ``time_step`` (s); half and a quarter of the step; two and
/// four times the elements; twice the elements with half the step.
///
/// If the scene returns a dict of numbers by names, such as several peaks, the result is `Refinements`: each number is
/// extrapolated separately, so that units may differ.
///
/// Even a regular estimate may be too low if the base slides or opens: for a sliding block it was too low by a factor
/// of 2.4 at one of the six settings. On layers the number of stages of the convolution quadrature depends on the error
/// at 15 Hz and may change between the settings; ``stages`` of `ElasticGround` fixes it.
#[pyfunction]
pub(crate) fn refine(
    py: Python<'_>,
    elements: usize,
    time_step: f64,
    scene: Py<PyAny>,
) -> PyResult<Py<PyAny>> {
    let mut result_form = ResultForm::Unknown;
    let refinement = raise_user_exceptions(|| {
        let result = basemat::analyses::refine(elements, time_step, |elements, time_step| {
            let result = scene.call1(py, (elements, time_step));
            let values = result.and_then(|result| result_form.values(result.bind(py)));
            values.map_err(|error| user_code_error("scene", error))
        });
        result.or_raise()
    })?;
    match result_form {
        ResultForm::Named(names) => {
            PyRefinements(Refinements::named(names, &refinement).or_raise()?).into_py_any(py)
        }
        ResultForm::Unknown | ResultForm::Unnamed => PyRefinement(refinement).into_py_any(py),
    }
}

/// Form of the results of a scene, which its first result determines.
enum ResultForm {
    Unknown,
    /// A number or an array.
    Unnamed,
    /// A dict with these names.
    Named(Vec<String>),
}

impl ResultForm {
    /// The numbers of a result, which must have the form of the first one.
    fn values(&mut self, result: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
        if !result.is_instance_of::<PyDict>() && !matches!(self, Self::Named(_)) {
            *self = Self::Unnamed;
            return match real_number("the result of a scene", result) {
                Ok(number) => Ok(vec![number]),
                Err(_) => extract_returned::<Numbers>("the scene", result).map(|numbers| numbers.0),
            };
        }
        let named_values = named_values(result)?;
        let names: Vec<String> = named_values.iter().map(|(name, _)| name.clone()).collect();
        match self {
            Self::Unknown => *self = Self::Named(names),
            Self::Named(first_names) if *first_names == names => {}
            _ => {
                return Err(input_error(format!(
                    "the scene returned {names:?}, but must return the same names at every setting"
                )));
            }
        }
        Ok(named_values.into_iter().map(|(_, value)| value).collect())
    }
}

/// Names and numbers of the dict that a scene returned.
fn named_values(result: &Bound<'_, PyAny>) -> PyResult<Vec<(String, f64)>> {
    let dict = result.cast::<PyDict>().map_err(|_| {
        input_error("the scene must return a dict of numbers by their names, at every setting")
    })?;
    let pairs = dict.iter().map(|(name, value)| {
        let name = extract_returned::<String>("the scene", &name)?;
        let value = real_number(&format!("'{name}' of a scene"), &value)?;
        Ok((name, value))
    });
    pairs.collect()
}

/// Runs a scene and three twins of it, and compares their peaks: with a time step shorter by 1 %, and on three quarters
/// and half of the elements.
///
/// ``scene(elements, time_step)`` builds a simulation and runs it for a duration, and returns a dict of peaks by their
/// names. The motion of a body that rocks on its corners may be chaotic: its peaks then belong to one motion out of
/// many, and no finer setting makes them converge. The twins show how many digits of a peak can be quoted, and take
/// less time than two further runs.
#[pyfunction]
pub(crate) fn sensitivity(
    py: Python<'_>,
    elements: usize,
    time_step: f64,
    scene: Py<PyAny>,
) -> PyResult<PySensitivity> {
    raise_user_exceptions(|| {
        let sensitivity =
            basemat::analyses::sensitivity(elements, time_step, |elements, time_step| {
                let result = scene.call1(py, (elements, time_step));
                let peaks = result.and_then(|result| named_values(result.bind(py)));
                peaks.map_err(|error| user_code_error("scene", error))
            });
        sensitivity.or_raise().map(PySensitivity)
    })
}

#[pymethods]
impl PyRefinement {
    /// Results of the settings, in the units of the scene: list of 6 arrays of shape (results,).
    #[getter]
    fn results(&self) -> Vec<Array> {
        self.0.settings.iter().map(|setting| setting.results.as_slice().into()).collect()
    }

    /// Time steps of the settings: array of shape (6,), s.
    #[getter]
    fn time_steps(&self) -> Array {
        self.0.settings.iter().map(|setting| setting.time_step).collect()
    }

    /// Estimated errors of the settings, relative to the magnitude of the results: array of shape (6,).
    #[getter]
    fn errors(&self) -> Array {
        self.0.settings.iter().map(|setting| setting.error).collect()
    }

    /// Wall times of the settings: array of shape (6,), s.
    #[getter]
    fn wall_times(&self) -> Array {
        self.0.settings.iter().map(|setting| setting.wall.as_secs_f64()).collect()
    }

    /// Numbers of elements of the settings: list of 6.
    #[getter]
    fn elements(&self) -> Vec<usize> {
        self.0.settings.iter().map(|setting| setting.elements).collect()
    }

    /// Results extrapolated to infinitely many elements and steps: array of shape (results,), in the
    /// units of the scene.
    #[getter]
    fn extrapolated(&self) -> Array {
        self.0.extrapolated.as_slice().into()
    }

    /// Observed order of convergence in the element length; NaN if the results do not depend on it.
    #[getter]
    fn mesh_order(&self) -> f64 {
        self.0.mesh_order
    }

    /// Observed order of convergence in the time step; NaN if the results do not depend on it.
    #[getter]
    fn step_order(&self) -> f64 {
        self.0.step_order
    }

    /// Difference between the results of the last setting and the results predicted from the other errors, relative to
    /// the magnitude of the results.
    #[getter]
    fn mismatch(&self) -> f64 {
        self.0.mismatch
    }

    /// Whether the estimate can be trusted: the orders are regular, and the error of the coarsest setting is above the
    /// mismatch.
    #[getter]
    fn is_regular(&self) -> bool {
        self.0.is_regular()
    }

    fn __str__(&self) -> String {
        in_python_words(self.0.to_string())
    }
}

/// Error against run time of several peaks: what `refine` returns for a scene that returns a dict. Printed, it is
/// one table.
#[pyclass(name = "Refinements", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyRefinements(Refinements);

#[pymethods]
impl PyRefinements {
    /// Names of the peaks, in the order of the scene.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.0.peaks.iter().map(|(name, _)| name.clone()).collect()
    }

    /// The `Refinement` of the peak called ``name``.
    fn __getitem__(&self, name: &str) -> PyResult<PyRefinement> {
        self.0.peak(name).cloned().or_raise().map(PyRefinement)
    }

    fn __str__(&self) -> String {
        in_python_words(self.0.to_string())
    }
}

/// Value of a peak in a run and in its twins.
#[pyclass(name = "PeakTwins", module = "basemat", frozen, eq)]
#[derive(Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct PyPeakTwins(PeakTwins);

#[pymethods]
impl PyPeakTwins {
    /// Name of the peak.
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// Value of the run, in the unit of the peak.
    #[getter]
    fn value(&self) -> f64 {
        self.0.value
    }

    /// Value with a time step shorter by 1 %, in the unit of the peak.
    #[getter]
    fn shorter_step(&self) -> f64 {
        self.0.shorter_step
    }

    /// Value on three quarters of the elements, rounded up, in the unit of the peak.
    #[getter]
    fn three_quarters(&self) -> f64 {
        self.0.three_quarters
    }

    /// Value on half the elements, rounded up, in the unit of the peak.
    #[getter]
    fn half(&self) -> f64 {
        self.0.half
    }

    /// Largest difference between a twin and the run, in the unit of the peak.
    #[getter]
    fn spread(&self) -> f64 {
        self.0.spread()
    }

    /// Number of reliable significant digits, at most six: half a unit of the last digit is the spread or more.
    #[getter]
    fn digits(&self) -> u32 {
        self.0.digits()
    }

    fn __repr__(&self) -> String {
        format!("PeakTwins({:?}, {:?} ± {:?})", self.0.name, self.0.value, self.0.spread())
    }
}

/// Peaks of a run and of its twins: what `sensitivity` returns. Printed, it is a table.
#[pyclass(name = "Sensitivity", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PySensitivity(Sensitivity);

#[pymethods]
impl PySensitivity {
    /// The peaks, in the order of the scene: list of `PeakTwins`.
    #[getter]
    fn peaks(&self) -> Vec<PyPeakTwins> {
        self.0.peaks.iter().cloned().map(PyPeakTwins).collect()
    }

    /// The `PeakTwins` of the peak called ``name``.
    fn __getitem__(&self, name: &str) -> PyResult<PyPeakTwins> {
        self.0.peak(name).cloned().or_raise().map(PyPeakTwins)
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }
}
