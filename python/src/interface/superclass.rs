//! The superclass of interface laws, and recipes of laws of this package or written in Python.

use std::sync::Arc;

use basemat::interface::InterfaceLaw;
use pyo3::prelude::*;

use crate::error::{OrRaise, input_error, raise_user_exceptions};
use crate::list_arguments::reject_class;
use crate::names::{mode_name, parse_mode};
use crate::recipe::Recipe;
use crate::user::{PyCondition, PyContactState, PyLimits, PyPreviousContact, PyTolerance, UserLaw};

/// A law between base and ground: the limits of an element's tractions, and in the plane its contact modes (see
/// `MODES`) and the conditions that each of them imposes.
#[pyclass(name = "InterfaceLaw", module = "basemat", subclass, frozen, dict)]
pub(crate) struct PyInterfaceLaw {
    pub(crate) make: Recipe<dyn InterfaceLaw>,
}

impl PyInterfaceLaw {
    /// The superclass object of a law that can be cloned.
    pub(crate) fn from_law(law: impl InterfaceLaw + Clone + Sync + 'static) -> Self {
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

    /// The two `Condition` that ``mode`` imposes at the end of a step that begins with ``start`` (`PreviousContact`).
    fn conditions(
        &self,
        mode: &str,
        start: &PyPreviousContact,
    ) -> PyResult<(PyCondition, PyCondition)> {
        raise_user_exceptions(|| {
            let law = (self.make)().or_raise()?;
            let conditions = law.conditions(parse_mode(mode)?, &start.core());
            Ok(conditions.map(PyCondition).into())
        })
    }

    /// The mode to try next after the ``trial`` (`ContactState`) that ``mode`` led to in the step that begins with
    /// ``start``; ``mode`` itself if the trial is admissible apart from differences below the ``tolerance``.
    fn next_mode(
        &self,
        mode: &str,
        start: &PyPreviousContact,
        trial: &PyContactState,
        tolerance: &PyTolerance,
    ) -> PyResult<&'static str> {
        raise_user_exceptions(|| {
            let law = (self.make)().or_raise()?;
            let mode = parse_mode(mode)?;
            Ok(mode_name(law.next_mode(mode, &start.core(), &trial.0, tolerance.0)))
        })
    }

    /// The `Limits` of an element's tractions in the step that begins with ``start`` (`PreviousContact`).
    fn limits(&self, start: &PyPreviousContact) -> PyResult<PyLimits> {
        raise_user_exceptions(|| {
            (self.make)().and_then(|law| law.limits(&start.core())).or_raise().map(PyLimits)
        })
    }
}

/// The recipe of a law of this package, or of one written in Python.
fn law_recipe(object: &Bound<'_, PyAny>) -> PyResult<Recipe<dyn InterfaceLaw>> {
    if let Ok(law) = object.cast::<PyInterfaceLaw>() {
        return Ok(law.get().make.clone());
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
    let type_name = object.get_type().name()?;
    Err(input_error(format!("{type_name} is no interface law: {hint}")))
}

/// Recipes of laws: one for all elements, or one for each element.
pub(crate) fn law_recipes(object: &Bound<'_, PyAny>) -> PyResult<Vec<Recipe<dyn InterfaceLaw>>> {
    reject_class(object)?;
    match object.extract::<Vec<Bound<'_, PyAny>>>() {
        Ok(laws) => laws.iter().map(law_recipe).collect(),
        Err(_) => Ok(vec![law_recipe(object)?]),
    }
}
