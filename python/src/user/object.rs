//! An object of Python whose methods the core calls.

use std::sync::Arc;

use basemat::coupled::CheckpointError;
use basemat::structure::InternalEnergy;
use pyo3::call::PyCallArgs;
use pyo3::prelude::*;

use crate::array::{Count, Numbers};
use crate::error::{
    call_user_code, extract_returned, has_stored_exception, input_error, store_exception,
    user_code_error,
};

/// Largest number of internal variables at a point, or of a fibre.
const MAX_VARIABLE_COUNT: usize = 10_000;

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
    /// Object that must have all `required` methods.
    pub(super) fn with_required(
        object: &Bound<'_, PyAny>,
        part: &'static str,
        required: &[&'static str],
        optional: &[&'static str],
    ) -> PyResult<Self> {
        for method in required {
            if !object.hasattr(*method)? {
                return Err(input_error(format!("the {part} has no method `{method}`")));
            }
        }
        Self::new(object, part, optional)
    }

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

    /// Attribute `variable_count`, the number of internal variables; zero without it.
    ///
    /// Returns an error for an object that has `commit`, but no variables.
    pub(super) fn variable_count(&self, py: Python<'_>) -> PyResult<usize> {
        let name = format!("variable_count of the {}", self.part);
        let variable_count = match self.bind(py).getattr_opt("variable_count")? {
            Some(count) => extract_returned::<Count>(&name, &count)?.0,
            None => 0,
        };
        if variable_count > MAX_VARIABLE_COUNT {
            return Err(input_error(format!(
                "{name} is {variable_count}, but must be {MAX_VARIABLE_COUNT} or less"
            )));
        }
        if variable_count == 0 && self.has("commit") {
            let text = "but no `variable_count`, the number of values that it returns";
            return Err(input_error(format!("the {} has `commit`, {text}", self.part)));
        }
        Ok(variable_count)
    }

    /// Numbers that a method returned, as many as `expected_count` and finite.
    pub(super) fn numbers(
        &self,
        method: &str,
        value: &Bound<'_, PyAny>,
        expected_count: usize,
    ) -> PyResult<Vec<f64>> {
        let Numbers(numbers) = extract_returned(&format!("{method} of the {}", self.part), value)?;
        let shape = format!("({},)", numbers.len());
        let expected_shape = format!("({expected_count},)");
        let numbers = self.checked_shape(method, "an array", numbers, &shape, &expected_shape)?;
        self.check_finite(method, numbers.iter())?;
        Ok(numbers)
    }

    /// Returns an error for numbers that a method returned unless all are finite.
    pub(super) fn check_finite<'a>(
        &self,
        method: &str,
        mut numbers: impl Iterator<Item = &'a f64>,
    ) -> PyResult<()> {
        match numbers.find(|number| !number.is_finite()) {
            Some(number) => Err(input_error(format!(
                "{method} of the {} returned {number}, but must return finite numbers",
                self.part
            ))),
            None => Ok(()),
        }
    }

    /// Overwrites internal variables by the value of `commit` for these arguments, if the object has this method.
    ///
    /// After an exception the variables are unchanged.
    pub(super) fn commit_variables(
        &self,
        variables: &mut [f64],
        call: impl for<'py> FnOnce(Python<'py>, &[f64]) -> PyResult<Bound<'py, PyAny>>,
    ) {
        if !self.has("commit") {
            return;
        }
        let committed_variables = Python::attach(|py| {
            let value = call(py, variables)?;
            self.numbers("commit", &value, variables.len())
        });
        match committed_variables {
            Ok(committed_variables) => variables.copy_from_slice(&committed_variables),
            // The step is already accepted: the exception ends the run after it.
            Err(exception) => store_exception(exception),
        }
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
