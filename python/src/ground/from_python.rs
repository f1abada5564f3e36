//! Grounds of this package, and grounds written in Python.

use basemat::bem::{ContactElement, Ground, Strip};
use pyo3::prelude::*;

use super::strip::ContactMesh;
use super::{PyGround, PyTrenchElements};
use crate::error::OrRaise;
use crate::several::{reject_class, type_error};
use crate::user::UserGround;

/// A ground for one simulation, and its object of Python: a copy if the ground is written in Python.
pub(crate) fn new_ground<'py>(
    object: &Bound<'py, PyAny>,
) -> PyResult<(Box<dyn Ground>, Bound<'py, PyAny>)> {
    if let Ok(ground) = object.cast::<PyGround>() {
        return Ok(((ground.get().make)().or_raise()?, object.clone()));
    }
    if !object.hasattr("step_compliance")? {
        return Err(type_error(object, "a Ground, or an object with the methods of UserGround"));
    }
    reject_class(object)?;
    let ground = UserGround::new(object, contact_elements)?;
    let copy = ground.object(object.py());
    Ok((Box::new(ground), copy))
}

/// Contact elements of strips, of a plan or of a trench.
fn contact_elements(object: &Bound<'_, PyAny>) -> PyResult<Vec<ContactElement>> {
    if let Ok(trench) = object.cast::<PyTrenchElements>() {
        return Ok(trench.get().0.elements());
    }
    let needed = "a Strip, a list of them, a Plan, or TrenchElements";
    match object.extract().map_err(|_: PyErr| type_error(object, needed))? {
        ContactMesh::Strips(strips) => Ok(strips.iter().flat_map(Strip::elements).collect()),
        ContactMesh::Plan(plan) => Ok(plan.elements()),
    }
}
