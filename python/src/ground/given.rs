//! Grounds in any form that Python may give them.

use basemat::bem::{ContactElement, Ground, Strip};
use pyo3::prelude::*;

use super::strip::Elements;
use super::{PyGround, PyTrenchElements};
use crate::error::OrRaise;
use crate::several::{no_class, no_such};
use crate::user::UserGround;

/// A ground for one simulation, and the object that it was made of: a copy if the user wrote it in Python.
pub(crate) fn made<'py>(
    object: &Bound<'py, PyAny>,
) -> PyResult<(Box<dyn Ground>, Bound<'py, PyAny>)> {
    if let Ok(own) = object.cast::<PyGround>() {
        return Ok(((own.get().make)().or_raise()?, object.clone()));
    }
    if !object.hasattr("step_compliance")? {
        return Err(no_such(object, "a Ground, or an object with the methods of UserGround"));
    }
    no_class(object)?;
    let own = UserGround::new(object, contact_elements)?;
    let copy = own.object(object.py());
    Ok((Box::new(own), copy))
}

/// Contact elements of strips, of a plan or of a trench.
fn contact_elements(object: &Bound<'_, PyAny>) -> PyResult<Vec<ContactElement>> {
    if let Ok(trench) = object.cast::<PyTrenchElements>() {
        return Ok(trench.get().0.elements());
    }
    let needed = "a Strip, a list of them, a Plan, or TrenchElements";
    match object.extract().map_err(|_: PyErr| no_such(object, needed))? {
        Elements::Strips(strips) => Ok(strips.iter().flat_map(Strip::elements).collect()),
        Elements::Plan(plan) => Ok(plan.elements()),
    }
}
