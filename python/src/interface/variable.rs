//! Friction that a Python function gives.

use std::sync::Arc;

use basemat::interface::{PreviousContact, VariableFriction};
use pyo3::prelude::*;

use super::PyInterfaceLaw;
use crate::array::real;
use crate::error::{OrRaise, keep, refuse};
use crate::user::PyPreviousContact;

/// Coulomb friction whose coefficient is a function of the start of the step:
/// ``coefficient(start)`` returns a number for a :class:`PreviousContact`. It may raise: the exception
/// comes out of the run. ``tensile_strength`` (Pa; 0 by default) holds an element until it first opens.
#[pyclass(name = "VariableFriction", module = "basemat", extends = PyInterfaceLaw, frozen)]
pub(crate) struct PyVariableFriction;

#[pymethods]
impl PyVariableFriction {
    #[new]
    #[pyo3(signature = (coefficient, *, tensile_strength=0.0))]
    fn new(
        coefficient: Bound<'_, PyAny>,
        tensile_strength: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        if !coefficient.is_callable() {
            return Err(refuse("the coefficient must be a function of the start of a step"));
        }
        let function = Arc::new(coefficient.unbind());
        // A strength that is refused is refused now.
        VariableFriction::new(|_| 0.0).with_tensile_strength(tensile_strength).or_raise()?;
        let make = move || {
            let function = Arc::clone(&function);
            let own = move |start: &PreviousContact<'_>| coefficient_of(&function, start);
            Ok(Box::new(VariableFriction::new(own).with_tensile_strength(tensile_strength)?)
                as Box<_>)
        };
        Ok(PyClassInitializer::from(PyInterfaceLaw { make: Arc::new(make) }).add_subclass(Self))
    }
}

/// The coefficient, or NaN (which ends the step) if the function raises.
fn coefficient_of(function: &Py<PyAny>, start: &PreviousContact<'_>) -> f64 {
    Python::attach(|py| {
        let found = function.call1(py, (PyPreviousContact::of(start),));
        let found = found.and_then(|value| real("the coefficient's function", value.bind(py)));
        found.unwrap_or_else(|error: PyErr| {
            keep(error);
            f64::NAN
        })
    })
}
