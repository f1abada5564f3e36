//! Contact elements: strips of them in the plane, or those of a plan.

use basemat::Soil;
use basemat::bem::plan::Plan;
use basemat::bem::{Grading, Strip};
use basemat::structure::Base;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use super::PyPlan;
use crate::array::{Numbers, whole_numbers};
use crate::error::OrRaise;
use crate::several::type_error;

/// A strip of contact elements from ``left`` to ``right`` (m): ``count`` elements with the ``grading``
/// "cosine" (the default: short at the edges, where tractions are singular) or "uniform".
#[pyclass(name = "Strip", module = "basemat", frozen, dict)]
#[derive(Clone)]
pub(crate) struct PyStrip(pub(crate) Strip);

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

    /// Strip of elements between given ``nodes`` (array of shape (elements + 1,), m, ascending).
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

/// Elements in the plane, one strip or a list of them, or in plan.
#[derive(Clone)]
pub(super) enum ContactMesh {
    Strips(Vec<Strip>),
    Plan(Plan),
}

impl ContactMesh {
    /// Elements under the foundations of a structure, or under its faces in plan, on a soil if one is given.
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
    let list: Vec<Bound<'_, PyStrip>> =
        object.extract().map_err(|_| type_error(&object, "a Strip, a list of them, or a Plan"))?;
    Ok(Self::Strips(list.iter().map(|strip| strip.get().0.clone()).collect()))
});
