//! Results of one joint in a run.

use basemat::results::{JointQuantity, Run};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::PyRun;
use super::series;
use crate::array::{Array, Count, OrderedDict, Rows};
use crate::error::{OrRaise, input_error};

/// Results of one joint in a run: time series, snapshots and envelopes. `Run.joints` lists them.
///
/// ``run.joints[0]["mean_slip"]`` is the time series of a scalar at ``run.time``. Forces act from the upper side on the
/// lower side, per metre of thickness.
#[pyclass(name = "JointResults", module = "basemat", frozen)]
pub(crate) struct PyJointResults {
    run: Py<PyRun>,
    joint: usize,
}

/// The function that restores the results of a joint, and its arguments.
type ReducedJoint<'py> = (Bound<'py, PyAny>, (Py<PyRun>, usize));

#[pymethods]
impl PyJointResults {
    /// All time series: dict of arrays of shape (steps + 1,): "time" (s), "normal_force" (N/m, positive in compression),
    /// "shear_force" (N/m, on the lower side, positive in the sense of the joint's nodes), "moment" (N·m/m, of the
    /// pressures about the middle, positive if the pressure is larger before the middle), "open_fraction" (a ratio of
    /// lengths), "mean_slip", "largest_gap" (m) and "contact_energy" (J/m, lost by friction and impact).
    #[getter]
    fn series(&self) -> PyResult<OrderedDict<String, Array>> {
        let time_series = self.run.get().recorded()?;
        let time = ("time".to_owned(), Array::from(time_series.times()));
        let quantities = JointQuantity::ALL_QUANTITIES.into_iter().map(|quantity| {
            let values = time_series.joint_series(self.joint, quantity).or_raise()?;
            Ok((quantity.to_string(), Array::from(values)))
        });
        std::iter::once(Ok(time)).chain(quantities).collect::<PyResult<_>>()
    }

    /// SI units of the time series: dict of texts by their names, "" for ratios.
    #[getter]
    #[allow(clippy::unused_self, reason = "an attribute in Python")]
    fn units(&self) -> OrderedDict<String, &str> {
        let quantities = JointQuantity::ALL_QUANTITIES.into_iter();
        let units = quantities.map(|quantity| (quantity.to_string(), quantity.unit()));
        [("time".to_owned(), "s")].into_iter().chain(units).collect()
    }

    /// Places of the contact elements on the upper side at rest: array of shape (elements, 4), x at the first and at the
    /// second end, lower and upper height above the surface, m.
    #[getter]
    fn elements(&self) -> Rows {
        let envelopes = self.run.get().run.joint_envelopes[self.joint].iter();
        let places = envelopes.map(|envelope| {
            let [bottom, top] = envelope.element.heights();
            vec![envelope.element.left(), envelope.element.right(), bottom, top]
        });
        Rows(places.collect())
    }

    /// Snapshots of the joint (``contact_every`` of `Simulation.run`): dict of "time" (frames,), s, and "gap", "slip"
    /// (m), "pressure", "shear" (Pa), "mode" (numbers into `basemat.MODES`), each of shape (frames, elements).
    #[getter]
    fn contact<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let time_series = self.run.get().recorded()?;
        let frames: Vec<_> = time_series.joint_frames(self.joint).or_raise()?.collect();
        series::contact_arrays(py, &frames, false)
    }

    /// Envelopes of the elements: dict of arrays of shape (elements,): "left", "right", "bottom", "top", "gap", "slip"
    /// (m), "static_pressure", "lowest_pressure", "highest_pressure", "shear" (Pa), "open" (s); "gap_time",
    /// "lowest_pressure_time" and so on are the times of extremes (s).
    #[getter]
    fn envelope(&self) -> OrderedDict<&'static str, Array> {
        let run: &Run = &self.run.get().run;
        let envelopes = &run.joint_envelopes[self.joint];
        run.joint_envelope_columns()
            .map(|(word, _, value)| (word, envelopes.iter().map(value).collect()))
            .collect()
    }

    /// Time series of the scalar ``name``, such as "mean_slip": array of shape (steps + 1,).
    fn __getitem__(&self, name: &str) -> PyResult<Array> {
        let OrderedDict(mut series) = self.series()?;
        if let Some(index) = series.iter().position(|(word, _)| word == name) {
            return Ok(series.swap_remove(index).1);
        }
        let words: Vec<_> = series.iter().map(|(word, _)| word.as_str()).collect();
        let text = format!("'{name}' is no time series of a joint: {}", words.join(", "));
        Err(pyo3::exceptions::PyKeyError::new_err(text))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<ReducedJoint<'py>> {
        let restore = py.import("basemat._core")?.getattr("_joint_results")?;
        Ok((restore, (self.run.clone_ref(py), self.joint)))
    }

    fn __repr__(&self) -> String {
        let element_count = self.run.get().run.joint_envelopes[self.joint].len();
        format!("JointResults({element_count} elements)")
    }
}

/// Results of the ``joint`` with a number in a ``run``, as a pickle restores them.
#[pyfunction(name = "_joint_results")]
pub(crate) fn joint_results(run: Py<PyRun>, joint: Count) -> PyResult<PyJointResults> {
    let joint_count = run.get().run.joint_envelopes.len();
    if joint.0 >= joint_count {
        return Err(input_error(format!("joint is {}, but must be below {joint_count}", joint.0)));
    }
    Ok(PyJointResults { run, joint: joint.0 })
}

#[pymethods]
impl PyRun {
    /// Each joint separately: list of `JointResults`, in the order of ``joints`` of the simulation.
    #[getter]
    fn joints(slf: &Bound<'_, Self>) -> Vec<PyJointResults> {
        let joint_count = slf.get().run.joint_envelopes.len();
        let run_of = || slf.clone().unbind();
        (0..joint_count).map(|joint| PyJointResults { run: run_of(), joint }).collect()
    }
}
