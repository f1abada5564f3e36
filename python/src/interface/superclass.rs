//! The superclass of laws, and laws in any form that Python may give them.

use std::sync::Arc;

use basemat::interface::InterfaceLaw;
use pyo3::prelude::*;

use crate::error::{OrRaise, heard, refuse};
use crate::names::{mode, mode_name};
use crate::recipe::Recipe;
use crate::several::no_class;
use crate::user::{PyCondition, PyContactState, PyLimits, PyPreviousContact, PyTolerance, UserLaw};

/// A law between base and ground: what an element of the contact does in a step, its mode (see
/// `MODES`), and which conditions that imposes.
#[pyclass(name = "InterfaceLaw", module = "basemat", subclass, frozen, dict)]
pub(crate) struct PyInterfaceLaw {
    pub(crate) make: Recipe<dyn InterfaceLaw>,
}

impl PyInterfaceLaw {
    /// A law that can be copied.
    pub(crate) fn copied(law: impl InterfaceLaw + Clone + Sync + 'static) -> Self {
        Self { make: Arc::new(move || Ok(Box::new(law.clone()))) }
    }
}

#[pymethods]
impl PyInterfaceLaw {
    /// List of the names of the modes that this law uses; the first is the mode of an element at rest.
    #[getter]
    fn modes(&self) -> PyResult<Vec<&'static str>> {
        Ok((self.make)().or_raise()?.modes().iter().map(|mode| mode_name(*mode)).collect())
    }

    /// The two `Condition` that ``mode`` imposes on the end of a step, whose beginning ``start``
    /// (`PreviousContact`) is.
    fn conditions(
        &self,
        mode: &str,
        start: &PyPreviousContact,
    ) -> PyResult<(PyCondition, PyCondition)> {
        heard(|| {
            let law = (self.make)().or_raise()?;
            let [first, second] = law.conditions(self::mode(mode)?, &start.core());
            Ok((PyCondition(first), PyCondition(second)))
        })
    }

    /// The mode to try next after the ``trial`` (`ContactState`) that ``mode`` led to in the step
    /// that begins with ``start``; ``mode`` itself if the trial is admissible, differences below the
    /// ``tolerance`` left aside.
    fn next_mode(
        &self,
        mode: &str,
        start: &PyPreviousContact,
        trial: &PyContactState,
        tolerance: &PyTolerance,
    ) -> PyResult<&'static str> {
        heard(|| {
            let law = (self.make)().or_raise()?;
            let mode = self::mode(mode)?;
            Ok(mode_name(law.next_mode(mode, &start.core(), &trial.0, tolerance.0)))
        })
    }

    /// The `Limits` of an element's tractions on a ground in plan, in the step after ``start``
    /// (`PreviousContact`).
    fn limits(&self, start: &PyPreviousContact) -> PyResult<PyLimits> {
        heard(|| (self.make)().and_then(|law| law.limits(&start.core())).or_raise().map(PyLimits))
    }
}

/// The recipe of a law of this package, or of one written in Python.
fn recipe(object: &Bound<'_, PyAny>) -> PyResult<Recipe<dyn InterfaceLaw>> {
    if let Ok(own) = object.cast::<PyInterfaceLaw>() {
        return Ok(own.get().make.clone());
    }
    if object.hasattr("limits")? || object.hasattr("conditions")? {
        let law = UserLaw::new(object)?;
        return Ok(Arc::new(move || Ok(Box::new(law.clone()))));
    }
    let hint = if let Ok(number) = object.extract::<f64>() {
        format!("Coulomb({number}) has this friction coefficient")
    } else if object.is_callable() {
        "VariableFriction(function) has the friction coefficient that a function returns".into()
    } else {
        "it has no method `limits`".into()
    };
    let found = object.get_type().name()?;
    Err(refuse(format!("{found} is no interface law: {hint}")))
}

/// One law for all elements, or a sequence of one each.
pub(crate) fn recipes(object: &Bound<'_, PyAny>) -> PyResult<Vec<Recipe<dyn InterfaceLaw>>> {
    no_class(object)?;
    match object.extract::<Vec<Bound<'_, PyAny>>>() {
        Ok(list) => list.iter().map(recipe).collect(),
        Err(_) => Ok(vec![recipe(object)?]),
    }
}
