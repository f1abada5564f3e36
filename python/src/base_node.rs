//! The base of a structure: its nodes, in lines in the plane or in faces in plan.

use basemat::structure::{Base, BaseNode};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyIterator;

use crate::array::wholes;
use crate::row::{Order, PyDofCombination, RowLike};
use crate::several::no_such;

/// A node of the base: its coordinate ``x`` (m), and the rows (`DofCombination`, or what makes
/// one) of its displacement to the right, ``horizontal``, and up, ``vertical``. In plan also its coordinate ``y``
/// (away from the reader, m; zero unless given) and the row of its displacement along y, ``across``. On walls and bases
/// below the surface also its height ``z`` above the surface (m, negative; zero unless given).
#[pyclass(name = "BaseNode", module = "basemat", frozen)]
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct PyBaseNode(BaseNode, Order);

impl From<BaseNode> for PyBaseNode {
    fn from(node: BaseNode) -> Self {
        Self(node, Order::default())
    }
}

/// Nodes for Python.
fn listed(nodes: Vec<BaseNode>) -> Vec<PyBaseNode> {
    nodes.into_iter().map(PyBaseNode::from).collect()
}

#[pymethods]
impl PyBaseNode {
    #[pyo3(signature = (x, horizontal, vertical, *, y=0.0, across=None, z=0.0))]
    #[new]
    fn new(
        x: f64,
        horizontal: RowLike,
        vertical: RowLike,
        y: f64,
        across: Option<RowLike>,
        z: f64,
    ) -> PyResult<Self> {
        let mut order = horizontal.1.and(vertical.1)?;
        let mut node = BaseNode {
            x,
            y,
            z,
            horizontal: horizontal.0,
            vertical: vertical.0,
            ..BaseNode::default()
        };
        if let Some(RowLike(across, own)) = across {
            order = order.and(own)?;
            node.across = across;
        }
        Ok(Self(node, order))
    }

    /// A node at ``x`` (m) of a rigid flat base whose degrees of freedom at ``center`` (x, m) have the
    /// numbers ``dofs`` (horizontal, vertical, rotation).
    #[staticmethod]
    fn rigid(x: f64, center: f64, #[pyo3(from_py_with = wholes)] dofs: [usize; 3]) -> Self {
        BaseNode::rigid(x, center, dofs).into()
    }

    /// The two ends, a list, of a rigid flat base from ``left`` to ``right`` (m) whose degrees of freedom
    /// at its middle have the numbers ``dofs`` (horizontal, vertical, rotation).
    #[staticmethod]
    fn rigid_base(
        left: f64,
        right: f64,
        #[pyo3(from_py_with = wholes)] dofs: [usize; 3],
    ) -> Vec<Self> {
        listed(BaseNode::rigid_base(left, right, dofs))
    }

    /// The face, a list of its corners, of a rigid flat base in plan: ``corners`` (list of x and y, m) from ``center``
    /// (x and y, m), whose displacements along x, along y and up and rotations about these have the numbers ``dofs``
    /// (six).
    #[staticmethod]
    fn rigid_face(
        corners: Vec<[f64; 2]>,
        center: [f64; 2],
        #[pyo3(from_py_with = wholes)] dofs: [usize; 6],
    ) -> Vec<Self> {
        listed(BaseNode::rigid_face(&corners, center, dofs))
    }

    /// Coordinate to the right, m.
    #[getter]
    fn x(&self) -> f64 {
        self.0.x
    }

    /// Coordinate away from the reader, m; zero in the plane.
    #[getter]
    fn y(&self) -> f64 {
        self.0.y
    }

    /// Height above the surface, m; negative below it.
    #[getter]
    fn z(&self) -> f64 {
        self.0.z
    }

    /// The `DofCombination` of its displacement to the right.
    #[getter]
    fn horizontal(&self) -> PyDofCombination {
        PyDofCombination(self.0.horizontal.clone(), self.1)
    }

    /// The `DofCombination` of its displacement along y; empty in the plane.
    #[getter]
    fn across(&self) -> PyDofCombination {
        PyDofCombination(self.0.across.clone(), self.1)
    }

    /// The `DofCombination` of its displacement up.
    #[getter]
    fn vertical(&self) -> PyDofCombination {
        PyDofCombination(self.0.vertical.clone(), self.1)
    }

    fn __repr__(&self) -> String {
        let BaseNode { x, y, z, horizontal, across, vertical, .. } = &self.0;
        let in_plan = if across.is_empty() && *y == 0.0 {
            String::new()
        } else {
            format!(", y={y:?}, across={:?}", &**across)
        };
        let below = if *z == 0.0 { String::new() } else { format!(", z={z:?}") };
        format!("BaseNode({x:?}, {:?}, {:?}{in_plan}{below})", &**horizontal, &**vertical)
    }
}

/// The base of a structure in plan: ``faces``, a list of lists of `BaseNode`, over which it iterates.
///
/// A face is a convex polygon, given by its corners in either order, flat and at one height. A rigid base needs one
/// face, its outline, which may be given without a list. Faces that touch are one foundation.
#[pyclass(name = "BaseFaces", module = "basemat", frozen)]
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct PyBaseFaces(Vec<Vec<PyBaseNode>>);

#[pymethods]
impl PyBaseFaces {
    #[new]
    fn new(faces: Parts) -> Self {
        Self(faces.0)
    }

    /// Number of faces.
    fn __len__(&self) -> usize {
        self.0.len()
    }

    /// Goes through the faces, each a list of its corners (`BaseNode`).
    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        self.0.clone().into_pyobject(py)?.try_iter()
    }

    fn __repr__(&self) -> String {
        let corners: Vec<_> = self.0.iter().map(Vec::len).collect();
        format!("BaseFaces({} faces of {corners:?} corners)", corners.len())
    }
}

/// Lines or faces, each by its nodes; a single one may be given without a list.
struct Parts(Vec<Vec<PyBaseNode>>);

extracts!(Parts, object => {
    let parts = object.extract().map(|part| vec![part]).or_else(|_: PyErr| object.extract());
    let parts: Vec<Vec<Bound<'_, PyBaseNode>>> =
        parts.map_err(|_: PyErr| no_such(&object, "a list of BaseNode, or a list of such lists"))?;
    let own = |part: &Vec<Bound<'_, PyBaseNode>>| part.iter().map(|node| node.get().clone()).collect();
    Ok(Self(parts.iter().map(own).collect()))
});

/// The base of a structure as Python gives it: one or several lines of nodes in the plane, or faces in plan.
pub(crate) enum BaseLike {
    Lines(Vec<Vec<PyBaseNode>>),
    Faces(Vec<Vec<PyBaseNode>>),
}

extracts!(BaseLike, object => {
    if let Ok(faces) = object.cast::<PyBaseFaces>() {
        return Ok(Self::Faces(faces.get().0.clone()));
    }
    let Parts(lines) = object.extract().map_err(|_: PyErr| {
        no_such(&object, "a list of BaseNode, a list of such lists, or in plan BaseFaces")
    })?;
    Ok(Self::Lines(lines))
});

impl BaseLike {
    /// The base of a structure of so many degrees of freedom.
    pub(crate) fn of_structure(self, dofs: usize) -> PyResult<Base> {
        let node = |PyBaseNode(node, order): PyBaseNode| {
            order.check(&format!("the contact node at {} m", node.x), dofs).map(|()| node)
        };
        let all = |parts: Vec<Vec<_>>| -> PyResult<Vec<Vec<_>>> {
            parts.into_iter().map(|part| part.into_iter().map(node).collect()).collect()
        };
        Ok(match self {
            Self::Lines(lines) => Base::Lines(all(lines)?),
            Self::Faces(faces) => Base::Faces(all(faces)?),
        })
    }
}

/// A base for Python: a list of lines, or faces in plan.
pub(crate) fn shown(py: Python<'_>, base: Base) -> PyResult<Py<PyAny>> {
    let all = |parts: Vec<Vec<BaseNode>>| parts.into_iter().map(listed).collect::<Vec<_>>();
    match base {
        Base::Faces(faces) => PyBaseFaces(all(faces)).into_py_any(py),
        Base::Lines(lines) => all(lines).into_py_any(py),
        // A kind of base that is added to the library must be added here.
        _ => Err(crate::error::refuse("this kind of base has no form in Python")),
    }
}
