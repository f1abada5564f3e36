//! Error against run time.

use basemat::coupled::{PeakTwins, Refinement, Refinements, Sensitivity};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::{Array, Numbers, real};
use crate::error::{OrRaise, heard, in_python, kept, refuse, returned};

/// Error against run time at six settings: what `refine` returns. Printed, it is a table.
#[pyclass(name = "Refinement", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyRefinement(Refinement);

/// Runs a scene at six settings and estimates the error of each by Richardson's extrapolation.
///
/// ``scene(elements, time_step)`` builds and runs, and returns a number or an array: a peak, some
/// peaks, or a time series at times that all settings have (the times of the coarsest). Settings are
/// ``elements`` and ``time_step`` (s), half and a quarter of the step, two and four times the
/// elements, and twice the elements with half the step.
///
/// A dict of numbers by names, such as several peaks, makes `Refinements`: each of the numbers is
/// extrapolated by itself, so that units may differ.
///
/// An estimate that counts as regular may still be too low where the base slides or opens: 2.4 times for one of six
/// settings of a sliding block. On layers the number of stages of the convolution quadrature follows the error at 15 Hz
/// and may change between the settings; ``stages`` of `ElasticGround` keeps it.
#[pyfunction]
pub(crate) fn refine(
    py: Python<'_>,
    elements: usize,
    time_step: f64,
    scene: Py<PyAny>,
) -> PyResult<Py<PyAny>> {
    // Names of the first result, if it is a dict.
    let mut names: Option<Vec<String>> = None;
    let mut first = true;
    let results = |elements: usize, time_step: f64| {
        let found = scene.call1(py, (elements, time_step)).and_then(|value| {
            let value = value.bind(py);
            if value.is_instance_of::<PyDict>() || names.is_some() {
                let (own, values): (Vec<String>, Vec<f64>) = peaks(value)?.into_iter().unzip();
                if first {
                    names = Some(own);
                } else if names.as_ref() != Some(&own) {
                    return Err(refuse(format!(
                        "the scene returned {own:?}, but must return the same names at every setting"
                    )));
                }
                first = false;
                return Ok(values);
            }
            first = false;
            match real("the result of a scene", value) {
                Ok(number) => Ok(vec![number]),
                Err(_) => returned::<Numbers>("the scene", value).map(|numbers| numbers.0),
            }
        });
        found.map_err(|error| kept("scene", error))
    };
    let found = heard(|| basemat::coupled::refine(elements, time_step, results).or_raise())?;
    match names {
        None => PyRefinement(found).into_py_any(py),
        Some(names) => PyRefinements(Refinements::named(names, &found).or_raise()?).into_py_any(py),
    }
}

/// Names and numbers of the dict that a scene returned.
fn peaks(value: &Bound<'_, PyAny>) -> PyResult<Vec<(String, f64)>> {
    let dict = value.cast::<PyDict>().map_err(|_| {
        refuse("the scene must return a dict of numbers by their names, at every setting")
    })?;
    let each = dict.iter().map(|(name, value)| {
        let name = returned::<String>("the scene", &name)?;
        let value = real(&format!("'{name}' of a scene"), &value)?;
        Ok((name, value))
    });
    each.collect()
}

/// Runs a scene and three twins of it, and compares their peaks: with a time step shorter by 1 %, and on three quarters
/// and half of the elements.
///
/// ``scene(elements, time_step)`` builds and runs for a duration, and returns a dict of peaks by their names. A body that
/// rocks on its corners may lose the memory of its start; its peaks then belong to one motion out of many, and no
/// finer setting makes them converge. The twins tell how many digits of a peak can be quoted, and cost less than two
/// further runs.
#[pyfunction]
pub(crate) fn sensitivity(
    py: Python<'_>,
    elements: usize,
    time_step: f64,
    scene: Py<PyAny>,
) -> PyResult<PySensitivity> {
    let results = |elements: usize, time_step: f64| {
        let found = scene.call1(py, (elements, time_step));
        found.and_then(|value| peaks(value.bind(py))).map_err(|error| kept("scene", error))
    };
    heard(|| basemat::coupled::sensitivity(elements, time_step, results).or_raise())
        .map(PySensitivity)
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

    /// Estimated errors of the settings, relative to the size of the results: array of shape (6,).
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
        in_python(self.0.to_string())
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
        in_python(self.0.to_string())
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

    /// Significant digits that hold, six at most: half a unit of the last one is the spread or more.
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
