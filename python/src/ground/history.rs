//! Options of a ground's convolution history.

use basemat::bem::{HalfPlaneGround, SharedKernels};
use basemat::history::History;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::error::OrRaise;

/// Kernels that grounds of equal soil and elements share: evaluated once for all simulations that
/// are built with the same object.
#[pyclass(name = "SharedKernels", module = "basemat", frozen)]
#[derive(Default)]
pub(crate) struct PySharedKernels(pub(crate) SharedKernels);

#[pymethods]
impl PySharedKernels {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// A copy in another process begins empty.
    #[allow(clippy::unused_self, reason = "a method of Python")]
    fn __getnewargs__<'py>(&self, py: Python<'py>) -> Bound<'py, PyTuple> {
        PyTuple::empty(py)
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }
}

/// History of a half-plane.
#[derive(Clone)]
pub(super) struct Options {
    pub(super) kind: History,
    pub(super) tolerance: Option<f64>,
    pub(super) memory: Option<usize>,
    pub(super) kernels: Option<SharedKernels>,
}

impl Options {
    pub(super) fn new(
        kind: &str,
        tolerance: Option<f64>,
        memory: Option<usize>,
        kernels: Option<&Bound<'_, PySharedKernels>>,
    ) -> PyResult<Self> {
        let kernels = kernels.map(|kernels| kernels.get().0.clone());
        Ok(Self { kind: kind.parse().or_raise()?, tolerance, memory, kernels })
    }

    pub(super) fn of(&self, ground: HalfPlaneGround) -> basemat::Result<HalfPlaneGround> {
        let mut ground = ground.with_history_kind(self.kind);
        if let Some(tolerance) = self.tolerance {
            ground = ground.with_history_tolerance(tolerance)?;
        }
        if let Some(memory) = self.memory {
            ground = ground.with_history_memory(memory);
        }
        Ok(match &self.kernels {
            Some(kernels) => ground.with_shared_kernels(kernels),
            None => ground,
        })
    }
}
