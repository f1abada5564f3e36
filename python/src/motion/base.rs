//! The base class of free fields, and functions written in Python.

use std::sync::Arc;

use basemat::motion::{FreeField, FreeFieldFn};
use pyo3::prelude::*;

use crate::error::{OrRaise, heard, keep, refuse};
use crate::recipe::Recipe;

/// Motion of the ground's surface without the structure.
#[pyclass(name = "FreeField", module = "basemat", subclass, frozen, dict)]
pub(crate) struct PyFreeField {
    pub(crate) make: Recipe<dyn FreeField>,
}

#[pymethods]
impl PyFreeField {
    /// Displacement (to the right, up), m, at ``x`` (m) and ``time`` (s).
    fn displacement(&self, x: f64, time: f64) -> PyResult<[f64; 2]> {
        heard(|| Ok((self.make)().or_raise()?.displacement(x, time)))
    }

    /// Velocity (to the right, up), m/s, at ``x`` (m) and ``time`` (s).
    fn velocity(&self, x: f64, time: f64) -> PyResult<[f64; 2]> {
        heard(|| Ok((self.make)().or_raise()?.velocity(x, time)))
    }
}

/// The recipe of a free field: of this package, or a function ``(x, time) -> (right, up)`` in m.
pub(crate) fn recipe(object: &Bound<'_, PyAny>) -> PyResult<Recipe<dyn FreeField>> {
    if let Ok(own) = object.cast::<PyFreeField>() {
        return Ok(own.get().make.clone());
    }
    if !object.is_callable() {
        let name = object.get_type().name()?;
        return Err(refuse(format!("{name} is no motion: neither a free field nor a function")));
    }
    let function = Arc::new(object.clone().unbind());
    Ok(Arc::new(move || {
        let function = Arc::clone(&function);
        Ok(Box::new(FreeFieldFn::new(move |x, time| displacement(&function, x, time))))
    }))
}

/// Value of the function, or NaN (which ends the step) if it raises.
fn displacement(function: &Py<PyAny>, x: f64, time: f64) -> [f64; 2] {
    Python::attach(|py| {
        let found = function.call1(py, (x, time));
        found.and_then(|value| value.extract(py)).unwrap_or_else(|error: PyErr| {
            keep(error);
            [f64::NAN; 2]
        })
    })
}
