//! The nonlinear force of a structure written in Python.

use basemat::structure::{InternalEnergy, NonlinearForce, Triplets};
use basemat::{CheckpointError, Error, Result};
use numpy::PyArray1;
use pyo3::prelude::*;

use super::structure::{PART, add_matrix, add_numbers, matrix_of, vector_of};
use crate::array::Numbers;
use crate::error::{keep, kept, returned};

/// `force(u)` and `tangent(u)`, and as it may be `energy(u)`, `commit(u)`, `save()`, `restore(values)`.
pub(super) struct UserForce {
    object: Py<PyAny>,
    dofs: usize,
    has_energy: bool,
    has_commit: bool,
    has_save: bool,
}

impl UserForce {
    pub(super) fn new(object: &Bound<'_, PyAny>, dofs: usize) -> PyResult<Self> {
        Ok(Self {
            dofs,
            has_energy: object.hasattr("energy")?,
            has_commit: object.hasattr("commit")?,
            has_save: object.hasattr("save")?,
            object: object.clone().unbind(),
        })
    }

    /// Calls a method with the displacement: array of shape (n,).
    fn call<'py>(
        &self,
        py: Python<'py>,
        method: &str,
        displacement: &[f64],
    ) -> PyResult<Bound<'py, PyAny>> {
        let displacement = PyArray1::from_slice(py, displacement);
        self.object.bind(py).call_method1(method, (displacement,))
    }
}

impl NonlinearForce for UserForce {
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> Result<()> {
        let found = Python::attach(|py| -> PyResult<Vec<f64>> {
            vector_of("force", &self.call(py, "force", displacement)?, force.len())
        });
        add_numbers(&found.map_err(|error| kept(PART, error))?, force);
        Ok(())
    }

    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> Result<()> {
        let found = Python::attach(|py| -> PyResult<Triplets> {
            matrix_of("tangent", &self.call(py, "tangent", displacement)?, self.dofs)
        });
        add_matrix(&found.map_err(|error| kept(PART, error))?, matrix);
        Ok(())
    }

    fn energy(&self, displacement: &[f64]) -> Option<InternalEnergy> {
        if !self.has_energy {
            return None;
        }
        let found = Python::attach(|py| -> PyResult<(f64, f64)> {
            returned("energy of the structure", &self.call(py, "energy", displacement)?)
        });
        let (stored, dissipated) = found.unwrap_or_else(|error| {
            keep(error);
            (f64::NAN, f64::NAN)
        });
        Some(InternalEnergy { stored, dissipated })
    }

    fn commit(&mut self, displacement: &[f64]) {
        if self.has_commit {
            let done = Python::attach(|py| self.call(py, "commit", displacement).map(|_| ()));
            // The step is accepted by now: the exception ends the run after it.
            done.unwrap_or_else(keep);
        }
    }

    fn save(&self) -> Result<Vec<f64>> {
        if self.has_save {
            let found = Python::attach(|py| -> PyResult<Vec<f64>> {
                let found = self.object.bind(py).call_method0("save")?;
                Ok(returned::<Numbers>("save of the structure", &found)?.0)
            });
            return found.map_err(|error| kept(PART, error));
        }
        if self.has_commit {
            return Err(Error::Checkpoint(CheckpointError::Unsupported { part: "structure" }));
        }
        Ok(Vec::new())
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        if !self.has_save && values.is_empty() {
            return Ok(());
        }
        let done = Python::attach(|py| {
            let values = PyArray1::from_slice(py, values);
            self.object.bind(py).call_method1("restore", (values,)).map(|_| ())
        });
        done.map_err(|error| kept(PART, error))
    }
}
