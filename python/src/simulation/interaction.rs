//! Interaction of soil and structure, from runs of the same scene on its ground and on a fixed base.

use pyo3::prelude::*;

use super::PySimulation;
use super::build::missing_end_error;
use super::run_reporter::step_result;
use crate::error::{take_exception, user_code_error};
use crate::names::DofNames;
use crate::results::PyInteraction;

#[pymethods]
impl PySimulation {
    /// The `Interaction` of the soil with the structure: this scene from its start, run for a ``duration`` (s; the
    /// duration of the motion unless given) on its ground and on a fixed base, and the period lengthening and damping
    /// of its first mode (ASCE 7, chapter 19). The state of this simulation is unchanged.
    ///
    /// T and β belong to the mode with the largest participating mass along an axis, with fixed contact nodes; the
    /// modes of a nonlinear structure are those of its first tangent. For T̃ and β₀ the structure is bonded to its
    /// ground and released from a deflection in this mode. The soil is linear: give it the moduli of the design motion.
    #[pyo3(signature = (duration=None))]
    fn interaction(&self, py: Python<'_>, duration: Option<f64>) -> PyResult<PyInteraction> {
        let duration =
            duration.or(self.motion_duration).ok_or_else(|| missing_end_error("a duration"))?;
        take_exception();
        let interaction = py.detach(|| {
            step_result(basemat::analyses::interaction(duration, || {
                let parts = Python::attach(|py| self.parts.builder_parts(py));
                parts.map(|parts| parts.builder).map_err(|error| user_code_error("scene", error))
            }))
        })?;
        Ok(PyInteraction { interaction, dof_names: self.dof_names.as_ref().map(DofNames::to_vec) })
    }
}
