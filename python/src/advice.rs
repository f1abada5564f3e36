//! Elements and time step for a wanted accuracy.

use basemat::coupled::{Advice, Outline};
use basemat::motion::FrequencyContent;
use pyo3::prelude::*;

use crate::error::OrRaise;
use crate::motion::PyRecord;
use crate::soil::PySoil;

/// Mesh and time step for a wanted accuracy of the base shear: what :func:`advise` returns.
#[pyclass(name = "Advice", module = "basemat", frozen)]
pub(crate) struct PyAdvice(Advice);

/// Elements, grading and time step for a base shear within ``tolerance`` (relative, 1e-4 to 0.5).
///
/// The structure is outlined by ``width`` of its base and ``height`` (m), ``mass`` (kg/m), and if it
/// sways its ``frequency`` on a fixed base (Hz) and ``damping_ratio``. Nothing is computed in time:
/// assumed are a bonded, rigid base and one mode of sway.
#[pyfunction]
#[pyo3(signature = (soil, record, tolerance, *, width, height, mass, frequency=None, damping_ratio=0.05))]
pub(crate) fn advise(
    soil: &PySoil,
    record: &PyRecord,
    tolerance: f64,
    width: f64,
    height: f64,
    mass: f64,
    frequency: Option<f64>,
    damping_ratio: f64,
) -> PyResult<PyAdvice> {
    let mut outline = Outline::new(width, height, mass).or_raise()?;
    if let Some(frequency) = frequency {
        outline = outline.with_frequency(frequency, damping_ratio).or_raise()?;
    }
    let content = FrequencyContent::of(&record.0).or_raise()?;
    let advice = basemat::coupled::advise(soil.0, &outline, &content, tolerance);
    Ok(PyAdvice(advice.or_raise()?))
}

#[pymethods]
impl PyAdvice {
    /// Elements under the base.
    #[getter]
    fn elements(&self) -> usize {
        self.0.elements
    }

    /// Their grading: "cosine" or "uniform".
    #[getter]
    fn grading(&self) -> String {
        self.0.grading.to_string()
    }

    /// Time step, s.
    #[getter]
    fn time_step(&self) -> f64 {
        self.0.time_step
    }

    /// Kind of history, as grounds are told.
    #[getter]
    fn history(&self) -> String {
        self.0.history.to_string().replace('_', " ")
    }

    /// Expected relative error of the base shear's time series due to the mesh.
    #[getter]
    fn mesh_error(&self) -> f64 {
        self.0.mesh_error
    }

    /// The same due to the step.
    #[getter]
    fn step_error(&self) -> f64 {
        self.0.step_error
    }

    /// Expected relative loss of the base shear's peak.
    #[getter]
    fn peak_error(&self) -> f64 {
        self.0.peak_error
    }

    fn __repr__(&self) -> String {
        format!(
            "Advice(elements={}, grading='{}', time_step={:?})",
            self.0.elements,
            self.grading(),
            self.0.time_step
        )
    }
}
