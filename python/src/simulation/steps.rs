//! Steps as an iterator.

use pyo3::prelude::*;

use super::PySimulation;
use crate::error::{self, refuse};

/// An iterator that makes a step whenever it is asked and yields the :class:`State` at its end, as long
/// as ``len()`` of them are left: see :meth:`Simulation.steps`.
#[pyclass(name = "Steps", module = "basemat")]
pub(crate) struct PySteps {
    /// Has a method `step`.
    pub(super) simulation: Py<PyAny>,
    pub(super) left: usize,
}

#[pymethods]
impl PySteps {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__(&mut self, py: Python<'_>) -> PyResult<Option<Py<PyAny>>> {
        if self.left == 0 {
            return Ok(None);
        }
        py.check_signals()?;
        let state = self.simulation.call_method0(py, "step")?;
        self.left -= 1;
        Ok(Some(state))
    }

    fn __len__(&self) -> usize {
        self.left
    }
}

impl PySimulation {
    /// Steps asked for directly, by a duration, or to the end of the motion.
    pub(super) fn count(
        &self,
        py: Python<'_>,
        steps: Option<usize>,
        duration: Option<f64>,
    ) -> PyResult<usize> {
        match (steps, duration, self.duration) {
            (Some(_), Some(_), _) => Err(refuse("give steps or a duration, not both")),
            (Some(steps), None, _) => Ok(steps),
            (None, Some(duration), _) => self.steps_for(duration),
            (None, None, Some(end)) => {
                let (all, made) = (self.steps_for(end)?, self.lock()?.state().step);
                if made < all {
                    return Ok(all - made);
                }
                let text = format!(
                    "the motion ended at {end} s, before these {all} steps: the ground does not \
                     accelerate in them; reset() goes back to the start, and steps or a duration \
                     say that they are meant"
                );
                error::warn(py, text)?;
                Ok(all)
            }
            (None, None, None) => {
                Err(refuse("give steps or a duration: no record says how long to run"))
            }
        }
    }
}
