//! Strips of contact elements.

use basemat::bem::{Grading, Strip};
use pyo3::prelude::*;

use crate::array::{Numbers, whole};
use crate::error::OrRaise;

/// A strip of contact elements from ``left`` to ``right`` (m): ``count`` elements with the
/// ``grading`` "cosine" (short at the edges, where tractions are singular) or "uniform".
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

    /// Strip of elements between given nodes (array of shape (elements + 1,), m, ascending).
    #[staticmethod]
    fn from_nodes(nodes: Numbers) -> PyResult<Self> {
        Ok(Self(Strip::from_nodes(nodes.0).or_raise()?))
    }

    /// Ends of the elements, m.
    #[getter]
    fn nodes(&self) -> Vec<f64> {
        self.0.nodes().to_vec()
    }

    fn __repr__(&self) -> String {
        format!("Strip.from_nodes({:?})", self.0.nodes())
    }
}

/// One strip, or a list of them.
#[derive(FromPyObject)]
pub(super) enum Strips<'py> {
    One(Bound<'py, PyStrip>),
    Several(Vec<Bound<'py, PyStrip>>),
}

impl From<Strips<'_>> for Vec<Strip> {
    fn from(given: Strips<'_>) -> Self {
        let list = match given {
            Strips::One(strip) => vec![strip],
            Strips::Several(list) => list,
        };
        list.iter().map(|strip| strip.get().0.clone()).collect()
    }
}
