//! Points of the base.

use basemat::structure::ContactNode;
use pyo3::prelude::*;

use crate::array::whole;
use crate::row::{Order, PyDofCombination, RowLike};

/// A point of the base: its coordinate ``x`` (m), and the rows (:class:`DofCombination`, or what makes
/// one) of its displacement to the right, ``horizontal``, and up, ``vertical``.
#[pyclass(name = "ContactNode", module = "basemat", frozen)]
#[derive(Clone)]
pub(crate) struct PyContactNode(pub(crate) ContactNode, Order);

impl From<ContactNode> for PyContactNode {
    fn from(node: ContactNode) -> Self {
        Self(node, Order::default())
    }
}

getters! {
    PyContactNode, own;
    /// Coordinate to the right, m.
    x: f64 = own.0.x;
    /// The :class:`DofCombination` of its displacement to the right.
    horizontal: PyDofCombination = PyDofCombination(own.0.horizontal.clone(), own.1);
    /// The :class:`DofCombination` of its displacement up.
    vertical: PyDofCombination = PyDofCombination(own.0.vertical.clone(), own.1);
}

#[pymethods]
impl PyContactNode {
    #[new]
    fn new(x: f64, horizontal: RowLike, vertical: RowLike) -> PyResult<Self> {
        let order = horizontal.1.and(vertical.1)?;
        Ok(Self(ContactNode { x, horizontal: horizontal.0, vertical: vertical.0 }, order))
    }

    /// A point at ``x`` (m) of a rigid flat base whose degrees of freedom at ``center`` (x, m) have the
    /// numbers ``dofs`` (horizontal, vertical, rotation).
    #[staticmethod]
    fn rigid(x: f64, center: f64, #[pyo3(from_py_with = whole)] dofs: [usize; 3]) -> Self {
        ContactNode::rigid(x, center, dofs).into()
    }

    /// The two ends, a list, of a rigid flat base from ``left`` to ``right`` (m) whose degrees of freedom
    /// at its middle have the numbers ``dofs`` (horizontal, vertical, rotation).
    #[staticmethod]
    fn rigid_base(
        left: f64,
        right: f64,
        #[pyo3(from_py_with = whole)] dofs: [usize; 3],
    ) -> Vec<Self> {
        ContactNode::rigid_base(left, right, dofs).into_iter().map(Self::from).collect()
    }

    fn __repr__(&self) -> String {
        format!(
            "ContactNode({:?}, {:?}, {:?})",
            self.0.x,
            self.0.horizontal.to_vec(),
            self.0.vertical.to_vec()
        )
    }

    fn __getnewargs__(&self) -> (f64, PyDofCombination, PyDofCombination) {
        (self.x(), self.horizontal(), self.vertical())
    }
}

/// Contact nodes as Python gives them, of a structure of so many degrees of freedom.
pub(crate) fn nodes(list: &[Bound<'_, PyContactNode>], dofs: usize) -> PyResult<Vec<ContactNode>> {
    let own = |node: &Bound<'_, PyContactNode>| {
        let PyContactNode(node, order) = node.get();
        order.check(&format!("the contact node at {} m", node.x), dofs)?;
        Ok(node.clone())
    };
    list.iter().map(own).collect()
}
