//! Steps as an iterator.

use pyo3::prelude::*;

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
