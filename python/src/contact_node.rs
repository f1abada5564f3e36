//! Points of the base: nodes of a line in the plane, corners of faces in plan.

use basemat::structure::BaseNode;
use pyo3::prelude::*;

use crate::array::wholes;
use crate::row::{Order, PyDofCombination, RowLike};
use crate::several::no_such;

/// A point of the base: its coordinate ``x`` (m), and the rows (:class:`DofCombination`, or what makes
/// one) of its displacement to the right, ``horizontal``, and up, ``vertical``.
#[pyclass(name = "ContactNode", module = "basemat", frozen)]
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct PyContactNode(pub(crate) BaseNode, Order);

impl From<BaseNode> for PyContactNode {
    fn from(node: BaseNode) -> Self {
        Self(node, Order::default())
    }
}

#[pymethods]
impl PyContactNode {
    #[new]
    fn new(x: f64, horizontal: RowLike, vertical: RowLike) -> PyResult<Self> {
        let order = horizontal.1.and(vertical.1)?;
        Ok(Self(
            BaseNode { x, horizontal: horizontal.0, vertical: vertical.0, ..BaseNode::default() },
            order,
        ))
    }

    /// A point at ``x`` (m) of a rigid flat base whose degrees of freedom at ``center`` (x, m) have the
    /// numbers ``dofs`` (horizontal, vertical, rotation).
    #[staticmethod]
    fn rigid(x: f64, center: f64, #[pyo3(from_py_with = wholes)] dofs: [usize; 3]) -> Self {
        BaseNode::rigid(x, center, dofs).into()
    }

    /// Coordinate to the right, m.
    #[getter]
    fn x(&self) -> f64 {
        self.0.x
    }

    /// The :class:`DofCombination` of its displacement to the right.
    #[getter]
    fn horizontal(&self) -> PyDofCombination {
        PyDofCombination(self.0.horizontal.clone(), self.1)
    }

    /// The :class:`DofCombination` of its displacement up.
    #[getter]
    fn vertical(&self) -> PyDofCombination {
        PyDofCombination(self.0.vertical.clone(), self.1)
    }

    /// The two ends, a list, of a rigid flat base from ``left`` to ``right`` (m) whose degrees of freedom
    /// at its middle have the numbers ``dofs`` (horizontal, vertical, rotation).
    #[staticmethod]
    fn rigid_base(
        left: f64,
        right: f64,
        #[pyo3(from_py_with = wholes)] dofs: [usize; 3],
    ) -> Vec<Self> {
        BaseNode::rigid_base(left, right, dofs).into_iter().map(Self::from).collect()
    }

    fn __repr__(&self) -> String {
        let BaseNode { x, horizontal, vertical, .. } = &self.0;
        format!("ContactNode({x:?}, {:?}, {:?})", &**horizontal, &**vertical)
    }
}

/// A corner of a face of a base in plan: its coordinates ``x`` (to the right) and ``y`` (away), m, and the rows
/// (:class:`DofCombination`, or what makes one) of its displacement along x, ``horizontal``, along y, ``across``, and up,
/// ``vertical``.
#[pyclass(name = "FaceNode", module = "basemat", frozen)]
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct PyFaceNode(BaseNode, Order);

impl From<BaseNode> for PyFaceNode {
    fn from(node: BaseNode) -> Self {
        Self(node, Order::default())
    }
}

#[pymethods]
impl PyFaceNode {
    #[new]
    fn new(
        x: f64,
        y: f64,
        horizontal: RowLike,
        across: RowLike,
        vertical: RowLike,
    ) -> PyResult<Self> {
        let order = horizontal.1.and(across.1)?.and(vertical.1)?;
        let (horizontal, across, vertical) = (horizontal.0, across.0, vertical.0);
        Ok(Self(BaseNode { x, y, z: 0.0, horizontal, across, vertical }, order))
    }

    /// Coordinate to the right, m.
    #[getter]
    fn x(&self) -> f64 {
        self.0.x
    }

    /// Coordinate away from the reader, m.
    #[getter]
    fn y(&self) -> f64 {
        self.0.y
    }

    /// The :class:`DofCombination` of its displacement along x.
    #[getter]
    fn horizontal(&self) -> PyDofCombination {
        PyDofCombination(self.0.horizontal.clone(), self.1)
    }

    /// The :class:`DofCombination` of its displacement along y.
    #[getter]
    fn across(&self) -> PyDofCombination {
        PyDofCombination(self.0.across.clone(), self.1)
    }

    /// The :class:`DofCombination` of its displacement up.
    #[getter]
    fn vertical(&self) -> PyDofCombination {
        PyDofCombination(self.0.vertical.clone(), self.1)
    }

    /// The face, a list of its corners, of a rigid flat base: ``corners`` (list of x and y, m) from ``center`` (x and y, m),
    /// whose displacements along x, along y and up and rotations about these have the numbers ``dofs`` (six).
    #[staticmethod]
    fn rigid_base(
        corners: Vec<[f64; 2]>,
        center: [f64; 2],
        #[pyo3(from_py_with = wholes)] dofs: [usize; 6],
    ) -> Vec<Self> {
        BaseNode::rigid_face(&corners, center, dofs).into_iter().map(Self::from).collect()
    }

    fn __repr__(&self) -> String {
        let BaseNode { x, y, horizontal, across, vertical, .. } = &self.0;
        format!("FaceNode({x:?}, {y:?}, {:?}, {:?}, {:?})", &**horizontal, &**across, &**vertical)
    }
}

/// Parts of the base that touch the ground, as Python gives them: nodes of a line in the plane, or faces in plan.
pub(crate) enum Contact<'py> {
    Line(Vec<Bound<'py, PyContactNode>>),
    Faces(Vec<Vec<Bound<'py, PyFaceNode>>>),
}

extracts!(Contact<'py>, object => {
    let line = object.extract().map(Self::Line);
    let line = line.or_else(|_: PyErr| object.extract().map(Self::Faces));
    // A single face may be given without a list.
    let line = line.or_else(|_: PyErr| object.extract().map(|face| Self::Faces(vec![face])));
    line.map_err(|_: PyErr| {
        no_such(&object, "a list of ContactNode, or in plan a list of faces, lists of FaceNode")
    })
});

impl Contact<'_> {
    /// Nodes and faces, one of them empty, of a structure of so many degrees of freedom.
    pub(crate) fn nodes(&self, dofs: usize) -> PyResult<(Vec<BaseNode>, Vec<Vec<BaseNode>>)> {
        let check = |order: Order, x: f64| order.check(&format!("the contact node at {x} m"), dofs);
        let node = |node: &Bound<'_, PyContactNode>| {
            let PyContactNode(node, order) = node.get();
            check(*order, node.x).map(|()| node.clone())
        };
        let corner = |node: &Bound<'_, PyFaceNode>| {
            let PyFaceNode(node, order) = node.get();
            check(*order, node.x).map(|()| node.clone())
        };
        Ok(match self {
            Self::Line(line) => (line.iter().map(node).collect::<PyResult<_>>()?, Vec::new()),
            Self::Faces(faces) => {
                let faces = faces.iter().map(|face| face.iter().map(corner).collect());
                (Vec::new(), faces.collect::<PyResult<_>>()?)
            }
        })
    }
}
