//! Strips of contact elements.

use basemat::bem::{Grading, Strip};
use pyo3::prelude::*;

use crate::array::{Numbers, whole};
use crate::error::{OrRaise, no_such};

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
    #[new]
    #[pyo3(signature = (left, right, count, *, grading="cosine"))]
    fn new(
        left: f64,
        right: f64,
        #[pyo3(from_py_with = whole)] count: usize,
        grading: &str,
    ) -> PyResult<Self> {
        Ok(Self(Strip::new(left..right, count, self::grading(grading)?).or_raise()?))
    }

    /// Strip of elements between given ``nodes`` (array of shape (elements + 1,), m, ascending).
    #[staticmethod]
    fn from_nodes(nodes: Numbers) -> PyResult<Self> {
        Ok(Self(Strip::from_nodes(nodes.0).or_raise()?))
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

/// The strips under the foundations of a structure.
pub(super) fn under(
    structure: &Bound<'_, PyAny>,
    count: usize,
    grading: Grading,
) -> PyResult<Vec<PyStrip>> {
    let structure = crate::structure::recipe(structure)?().or_raise()?;
    let strips = Strip::under(&*structure, count, grading).or_raise()?;
    Ok(strips.into_iter().map(PyStrip).collect())
}

/// One strip, or a list of them.
#[derive(Clone)]
pub(super) struct Strips(pub(super) Vec<Strip>);

impl<'py> FromPyObject<'_, 'py> for Strips {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(strip) = object.cast::<PyStrip>() {
            return Ok(Self(vec![strip.get().0.clone()]));
        }
        let list: Vec<Bound<'_, PyStrip>> =
            object.extract().map_err(|_| no_such(&object, "a Strip or a list of them"))?;
        Ok(Self(list.iter().map(|strip| strip.get().0.clone()).collect()))
    }
}
