//! Points of the base.

use basemat::structure::ContactNode;
use pyo3::prelude::*;

use crate::row::{PyRow, RowLike};

/// A point of the base: its coordinate x (m), and rows for its displacement to the right and up.
#[pyclass(name = "ContactNode", module = "basemat", frozen)]
#[derive(Clone)]
pub(crate) struct PyContactNode(pub(crate) ContactNode);

#[pymethods]
impl PyContactNode {
    #[new]
    fn new(x: f64, horizontal: RowLike, vertical: RowLike) -> Self {
        Self(ContactNode { x, horizontal: horizontal.0, vertical: vertical.0 })
    }

    /// A point of a rigid flat base with ``unknowns`` (horizontal, vertical, rotation) at ``center`` (m).
    #[staticmethod]
    fn rigid(x: f64, center: f64, unknowns: [usize; 3]) -> Self {
        Self(ContactNode::rigid(x, center, unknowns))
    }

    /// The two ends of a rigid flat base from ``left`` to ``right`` (m), with ``unknowns``
    /// (horizontal, vertical, rotation) at its middle.
    #[staticmethod]
    fn rigid_base(left: f64, right: f64, unknowns: [usize; 3]) -> Vec<Self> {
        ContactNode::rigid_base(left, right, unknowns).into_iter().map(Self).collect()
    }

    /// Coordinate, m.
    #[getter]
    fn x(&self) -> f64 {
        self.0.x
    }

    /// Displacement to the right.
    #[getter]
    fn horizontal(&self) -> PyRow {
        PyRow(self.0.horizontal.clone())
    }

    /// Displacement up.
    #[getter]
    fn vertical(&self) -> PyRow {
        PyRow(self.0.vertical.clone())
    }

    fn __repr__(&self) -> String {
        format!(
            "ContactNode({:?}, {:?}, {:?})",
            self.0.x,
            self.0.horizontal.terms(),
            self.0.vertical.terms()
        )
    }

    fn __getnewargs__(&self) -> (f64, PyRow, PyRow) {
        (self.x(), self.horizontal(), self.vertical())
    }
}

/// Contact nodes as Python gives them.
pub(super) fn nodes(list: &[Bound<'_, PyContactNode>]) -> Vec<ContactNode> {
    list.iter().map(|node| node.get().0.clone()).collect()
}
