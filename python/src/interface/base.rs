//! The base class of laws, and laws in any form that Python may give them.

use std::sync::Arc;

use basemat::interface::InterfaceLaw;
use pyo3::prelude::*;

use crate::error::refuse;
use crate::recipe::Recipe;

/// A law between base and ground.
#[pyclass(name = "InterfaceLaw", module = "basemat", subclass, frozen)]
pub(crate) struct PyInterfaceLaw {
    pub(crate) make: Recipe<dyn InterfaceLaw>,
}

impl PyInterfaceLaw {
    /// A law that can be copied.
    pub(crate) fn copied(law: impl InterfaceLaw + Clone + Sync + 'static) -> Self {
        Self { make: Arc::new(move || Ok(Box::new(law.clone()))) }
    }
}

/// The recipe of a law of this package, or of one written in Python.
fn recipe(object: &Bound<'_, PyAny>) -> PyResult<Recipe<dyn InterfaceLaw>> {
    if let Ok(own) = object.cast::<PyInterfaceLaw>() {
        return Ok(own.get().make.clone());
    }
    Err(refuse(format!(
        "{} is no interface law: it has no method `conditions`",
        object.get_type().name()?
    )))
}

/// One law for all elements, or a sequence of one each.
pub(crate) fn recipes(object: &Bound<'_, PyAny>) -> PyResult<Vec<Recipe<dyn InterfaceLaw>>> {
    match object.extract::<Vec<Bound<'_, PyAny>>>() {
        Ok(list) => list.iter().map(recipe).collect(),
        Err(_) => Ok(vec![recipe(object)?]),
    }
}
