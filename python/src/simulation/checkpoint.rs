//! Checkpoints that pickle.

use basemat::coupled::Checkpoint;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::error::refuse;

/// A run between two steps: :meth:`Simulation.checkpoint` makes it, :meth:`Simulation.resume` goes
/// on from it, to the same bits. It pickles. ``data``: the bytes that :meth:`to_bytes` returned.
#[pyclass(name = "Checkpoint", module = "basemat", frozen, eq)]
#[derive(PartialEq)]
pub(crate) struct PyCheckpoint(pub(super) Checkpoint);

#[pymethods]
impl PyCheckpoint {
    #[new]
    fn new(data: &[u8]) -> PyResult<Self> {
        let read = postcard::from_bytes(data);
        Ok(Self(read.map_err(|error| refuse(format!("bytes of a checkpoint: {error}")))?))
    }

    /// Steps made before it.
    #[getter]
    fn steps(&self) -> usize {
        self.0.steps()
    }

    /// All of it as bytes, for a file.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let written = postcard::to_allocvec(&self.0);
        let bytes = written.map_err(|error| refuse(format!("checkpoint: {error}")))?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn __getnewargs__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyBytes>,)> {
        Ok((self.to_bytes(py)?,))
    }

    fn __repr__(&self) -> String {
        format!("Checkpoint(after {} steps)", self.0.steps())
    }
}
