//! Contact elements: strips in the plane and plans; and the ground of a simulation.

use basemat::Soil;
use basemat::bem::plan::Plan;
use basemat::bem::{ContactElement, Grading, Ground, Strip};
use basemat::structure::Base;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use super::{PyGround, PyPlan, PyTrenchElements};
use crate::array::{Numbers, whole_numbers};
use crate::error::OrRaise;
use crate::list_arguments::{reject_class, type_error};
use crate::user::UserGround;

/// A strip of contact elements from ``left`` to ``right`` (m): ``count`` elements with the ``grading``
/// "cosine" (the default: short at the edges, where tractions are singular) or "uniform".
#[pyclass(name = "Strip", module = "basemat", frozen, dict)]
#[derive(Clone)]
pub(crate) struct PyStrip(pub(crate) Strip);

/// The grading with this name.
pub(super) fn grading(name: &str) -> PyResult<Grading> {
    name.parse().or_raise()
}

#[pymethods]
impl PyStrip {
    #[pyo3(signature = (left, right, count, *, grading="cosine"))]
    #[new]
    fn new(
        left: f64,
        right: f64,
        #[pyo3(from_py_with = whole_numbers)] count: usize,
        grading: &str,
    ) -> PyResult<Self> {
        Ok(Self(Strip::new(left..right, count, self::grading(grading)?).or_raise()?))
    }

    /// Strip of elements between ``nodes`` (array of shape (elements + 1,), m, ascending).
    #[staticmethod]
    fn from_nodes(nodes: Numbers) -> PyResult<Self> {
        Strip::from_nodes(nodes.0).or_raise().map(Self)
    }

    /// Ends of the elements: list of elements + 1 numbers, m.
    #[getter]
    fn nodes(&self) -> Vec<f64> {
        self.0.nodes().to_vec()
    }

    fn __repr__(&self) -> String {
        format!("Strip.from_nodes({:?})", self.0.nodes())
    }
}

/// Contact elements: strips in the plane, or a plan.
#[derive(Clone)]
pub(super) enum ContactMesh {
    Strips(Vec<Strip>),
    Plan(Plan),
}

impl ContactMesh {
    /// Elements under the foundations or faces of a structure, as Python's object.
    ///
    /// In plan the elements depend on the soil, if it is given.
    pub(super) fn under(
        structure: &Bound<'_, PyAny>,
        count: usize,
        grading: Grading,
        soil: Option<Soil>,
    ) -> PyResult<Py<PyAny>> {
        let py = structure.py();
        let structure = crate::structure::structure_recipe(structure)?().or_raise()?;
        if matches!(structure.base(), Base::Faces(_)) {
            let plan = match soil {
                Some(soil) => Plan::on_soil(&*structure, count, &soil),
                None => Plan::under(&*structure, count),
            };
            return PyPlan(plan.or_raise()?).into_py_any(py);
        }
        let strips = Strip::under(&*structure, count, grading).or_raise()?;
        strips.into_iter().map(PyStrip).collect::<Vec<_>>().into_py_any(py)
    }
}

extracts!(ContactMesh, object => {
    if let Ok(plan) = object.cast::<PyPlan>() {
        return Ok(Self::Plan(plan.get().0.clone()));
    }
    if let Ok(strip) = object.cast::<PyStrip>() {
        return Ok(Self::Strips(vec![strip.get().0.clone()]));
    }
    let strips: Vec<Bound<'_, PyStrip>> =
        object.extract().map_err(|_| type_error(&object, "a Strip, a list of them, or a Plan"))?;
    Ok(Self::Strips(strips.iter().map(|strip| strip.get().0.clone()).collect()))
});

/// A ground for one simulation, and its Python object: a copy of `object` if the ground is written in Python.
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
    let requirement = "a Strip, a list of them, a Plan, or TrenchElements";
    match object.extract().map_err(|_: PyErr| type_error(object, requirement))? {
        ContactMesh::Strips(strips) => Ok(strips.iter().flat_map(Strip::elements).collect()),
        ContactMesh::Plan(plan) => Ok(plan.elements()),
    }
}
