//! The base of a structure: its nodes, in lines in the plane or in faces in plan.

use basemat::structure::{Base, BaseNode};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyIterator;

use crate::array::whole_array;
use crate::list_arguments::type_error;
use crate::row::{PyDofCombination, RowLike, WeightCount};

/// A node of the base: its coordinate ``x`` (m), and the rows (`DofCombination` or its ``terms``) of its displacement
/// to the right, ``horizontal``, and up, ``vertical``. In plan also its coordinate ``y`` (away from the reader, m; zero
/// unless given) and the row of its displacement along y, ``across``. On walls and bases below the surface also its
/// height ``z`` above the surface (m, negative; zero unless given).
#[pyclass(name = "BaseNode", module = "basemat", frozen)]
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct PyBaseNode(BaseNode, WeightCount);

impl From<BaseNode> for PyBaseNode {
    fn from(node: BaseNode) -> Self {
        Self(node, WeightCount::default())
    }
}

/// Nodes of the core as objects of Python.
pub(crate) fn python_nodes(nodes: Vec<BaseNode>) -> Vec<PyBaseNode> {
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
        let mut weight_count = horizontal.1.common_with(vertical.1)?;
        let mut node = BaseNode {
            x,
            y,
            z,
            horizontal: horizontal.0,
            vertical: vertical.0,
            ..BaseNode::default()
        };
        if let Some(across) = across {
            weight_count = weight_count.common_with(across.1)?;
            node.across = across.0;
        }
        Ok(Self(node, weight_count))
    }

    /// A node at ``x`` (m) of a rigid flat base whose degrees of freedom at ``center`` (x, m) have the
    /// numbers ``dofs`` (horizontal, vertical, rotation).
    #[staticmethod]
    fn rigid(x: f64, center: f64, #[pyo3(from_py_with = whole_array)] dofs: [usize; 3]) -> Self {
        BaseNode::rigid(x, center, dofs).into()
    }

    /// The two ends, a list, of a rigid flat base from ``left`` to ``right`` (m) whose degrees of freedom
    /// at its middle have the numbers ``dofs`` (horizontal, vertical, rotation).
    #[staticmethod]
    fn rigid_base(
        left: f64,
        right: f64,
        #[pyo3(from_py_with = whole_array)] dofs: [usize; 3],
    ) -> Vec<Self> {
        python_nodes(BaseNode::rigid_base(left, right, dofs))
    }

    /// The face, a list of its corners, of a rigid flat base in plan: ``corners`` (list of x and y, m) from ``center``
    /// (x and y, m), whose displacements along x, along y and up and rotations about these axes have the numbers
    /// ``dofs`` (six).
    #[staticmethod]
    fn rigid_face(
        corners: Vec<[f64; 2]>,
        center: [f64; 2],
        #[pyo3(from_py_with = whole_array)] dofs: [usize; 6],
    ) -> Vec<Self> {
        python_nodes(BaseNode::rigid_face(&corners, center, dofs))
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
        let plan_text = if across.is_empty() && *y == 0.0 {
            String::new()
        } else {
            format!(", y={y:?}, across={:?}", &**across)
        };
        let height_text = if *z == 0.0 { String::new() } else { format!(", z={z:?}") };
        format!("BaseNode({x:?}, {:?}, {:?}{plan_text}{height_text})", &**horizontal, &**vertical)
    }
}

/// The base of a structure in plan: ``faces``, a list of lists of `BaseNode`. An iteration yields these lists.
///
/// A face is a convex polygon, given by its corners in either order, flat and at one height. A rigid base needs one
/// face, its outline, which may be given without a list. Faces that touch are one foundation.
#[pyclass(name = "BaseFaces", module = "basemat", frozen)]
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct PyBaseFaces(Vec<Vec<PyBaseNode>>);

#[pymethods]
impl PyBaseFaces {
    #[new]
    fn new(faces: NodeLists) -> Self {
        Self(faces.0)
    }

    /// Number of faces.
    fn __len__(&self) -> usize {
        self.0.len()
    }

    /// Iterates over the faces, each a list of its corners (`BaseNode`).
    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        self.0.clone().into_pyobject(py)?.try_iter()
    }

    fn __repr__(&self) -> String {
        let corner_counts: Vec<_> = self.0.iter().map(Vec::len).collect();
        format!("BaseFaces({} faces of {corner_counts:?} corners)", corner_counts.len())
    }
}

/// Lists of the nodes of lines or faces; a single line or face needs no list around it.
struct NodeLists(Vec<Vec<PyBaseNode>>);

extracts!(NodeLists, object => {
    let lists = object.extract().map(|nodes| vec![nodes]).or_else(|_: PyErr| object.extract());
    let lists: Vec<Vec<Bound<'_, PyBaseNode>>> =
        lists.map_err(|_: PyErr| type_error(&object, "a list of BaseNode, or a list of such lists"))?;
    let lists = lists.iter().map(|nodes| nodes.iter().map(|node| node.get().clone()).collect());
    Ok(Self(lists.collect()))
});

/// Python's description of the base of a structure: lines of nodes in the plane, or faces in plan.
pub(crate) enum BaseLike {
    Lines(Vec<Vec<PyBaseNode>>),
    Faces(Vec<Vec<PyBaseNode>>),
}

extracts!(BaseLike, object => {
    if let Ok(faces) = object.cast::<PyBaseFaces>() {
        return Ok(Self::Faces(faces.get().0.clone()));
    }
    let NodeLists(lines) = object.extract().map_err(|_: PyErr| {
        type_error(&object, "a list of BaseNode, a list of such lists, or in plan BaseFaces")
    })?;
    Ok(Self::Lines(lines))
});

impl BaseLike {
    /// The base of a structure with this number of degrees of freedom.
    pub(crate) fn of_structure(self, dof_count: usize) -> PyResult<Base> {
        match self {
            Self::Lines(lines) => structure_nodes(lines, Some(dof_count)).map(Base::Lines),
            Self::Faces(faces) => structure_nodes(faces, Some(dof_count)).map(Base::Faces),
        }
    }
}

/// Nodes whose rows belong to a structure with this number of degrees of freedom, if it is known.
pub(crate) fn structure_nodes(
    lists: Vec<Vec<PyBaseNode>>,
    dof_count: Option<usize>,
) -> PyResult<Vec<Vec<BaseNode>>> {
    let mut node_lists = Vec::with_capacity(lists.len());
    for python_nodes in lists {
        let mut nodes = Vec::with_capacity(python_nodes.len());
        for PyBaseNode(node, weight_count) in python_nodes {
            if let Some(dof_count) = dof_count {
                weight_count.check(&format!("the contact node at {} m", node.x), dof_count)?;
            }
            nodes.push(node);
        }
        node_lists.push(nodes);
    }
    Ok(node_lists)
}

/// A base as an object of Python: a list of lines, or faces in plan.
pub(crate) fn python_base(py: Python<'_>, base: Base) -> PyResult<Py<PyAny>> {
    match base {
        Base::Faces(faces) => {
            PyBaseFaces(faces.into_iter().map(python_nodes).collect()).into_py_any(py)
        }
        Base::Lines(lines) => {
            lines.into_iter().map(python_nodes).collect::<Vec<_>>().into_py_any(py)
        }
    }
}
