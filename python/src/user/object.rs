//! An object of Python whose methods the core calls.

use std::sync::Arc;

use basemat::coupled::CheckpointError;
use basemat::structure::InternalEnergy;
use pyo3::call::PyCallArgs;
use pyo3::prelude::*;

use crate::array::Numbers;
use crate::error::{
    call_user_code, extract_returned, has_stored_exception, input_error, user_code_error,
};

/// An object with the methods of a part, some of which may be missing.
#[derive(Clone)]
pub(super) struct UserObject {
    object: Arc<Py<PyAny>>,
    /// Kind of part that the object is, for errors.
    part: &'static str,
    /// The optional methods that it has.
    methods: Vec<&'static str>,
}

impl UserObject {
    pub(super) fn new(
        object: &Bound<'_, PyAny>,
        part: &'static str,
        optional: &[&'static str],
    ) -> PyResult<Self> {
        let mut methods = Vec::new();
        for &method in optional {
            if object.hasattr(method)? {
                methods.push(method);
            }
        }
        Ok(Self { object: Arc::new(object.clone().unbind()), part, methods })
    }

    /// Replaces the object by another one of the same class.
    pub(super) fn with_object(&self, object: Bound<'_, PyAny>) -> Self {
        Self { object: Arc::new(object.unbind()), ..self.clone() }
    }

    pub(super) fn bind<'py>(&self, py: Python<'py>) -> &Bound<'py, PyAny> {
        self.object.bind(py)
    }

    /// Whether the object has this optional method.
    pub(super) fn has(&self, method: &str) -> bool {
        self.methods.contains(&method)
    }

    /// Value returned by a method, extracted as a `T`.
    pub(super) fn call<'py, T>(
        &self,
        py: Python<'py>,
        method: &str,
        arguments: impl PyCallArgs<'py>,
    ) -> PyResult<T>
    where
        T: for<'a> FromPyObject<'a, 'py>,
    {
        let returned_value = self.bind(py).call_method1(method, arguments)?;
        returned_value.extract().or_else(|_| {
            extract_returned(&format!("{method} of the {}", self.part), &returned_value)
        })
    }

    /// Value that a method returned; an error unless its shape is the expected one.
    ///
    /// `value_kind`: "an array" or "a matrix", for the error.
    pub(super) fn checked_shape<T>(
        &self,
        method: &str,
        value_kind: &str,
        value: T,
        shape: &str,
        expected_shape: &str,
    ) -> PyResult<T> {
        if shape == expected_shape {
            return Ok(value);
        }
        let text = format!(
            "returned {value_kind} of shape {shape}, but must return one of {expected_shape}"
        );
        Err(input_error(format!("{method} of the {} {text}", self.part)))
    }

    /// Stored and dissipated energy that the method `energy` returns; `None` without this method.
    pub(super) fn energy(
        &self,
        deformation: impl for<'py> PyCallArgs<'py>,
    ) -> Option<InternalEnergy> {
        if !self.has("energy") {
            return None;
        }
        let energies =
            call_unless_raised((f64::NAN, f64::NAN), |py| self.call(py, "energy", deformation));
        Some(InternalEnergy { stored: energies.0, dissipated: energies.1 })
    }

    /// Internal variables that the method `save` returns; an error for an object with `commit` but no `save`.
    pub(super) fn saved_variables(&self) -> basemat::Result<Vec<f64>> {
        if self.has("save") {
            return self.try_call(|py| Ok(self.call::<Numbers>(py, "save", ())?.0));
        }
        if self.has("commit") {
            return Err(CheckpointError::Unsupported { part: self.part }.into());
        }
        Ok(Vec::new())
    }

    /// The result of user code, or an error of the core if the code raises an exception.
    pub(super) fn try_call<T>(
        &self,
        call: impl FnOnce(Python<'_>) -> PyResult<T>,
    ) -> basemat::Result<T> {
        Python::attach(call).map_err(|error| user_code_error(self.part, error))
    }
}

/// Result of user code, or `fallback` (which ends the step) if the code raises an exception or an exception is already
/// stored.
pub(super) fn call_unless_raised<T>(
    fallback: T,
    call: impl FnOnce(Python<'_>) -> PyResult<T>,
) -> T {
    if has_stored_exception() { fallback } else { call_user_code(fallback, call) }
}

/// A deep copy, with separate internal variables.
pub(super) fn deep_copy<'py>(object: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    object.py().import("copy")?.call_method1("deepcopy", (object,))
}
