//! The rigid block, and the rigid body in three dimensions.

use basemat::structure::{RigidBlock, RigidBody};
use pyo3::prelude::*;

use super::PyStructure;
use crate::array::Pairs;
use crate::base_node::{PyBaseNode, python_nodes};
use crate::error::{OrRaise, WithOption};
use crate::list_arguments::PairList;
use crate::names::DofNames;
use crate::row::{PyDofCombination, python_rows};

/// A rigid block on a flat base, in the plane.
///
/// Its three degrees of freedom are at the middle of its base: displacement to the right, displacement up and rotation.
/// `dof` has the names "x", "y" and "rotation" for them.
///
/// ``width`` and ``height``: m. ``density``: kg/m³. ``center``: x of the middle of its base, m; 0 by default.
/// ``p_delta``: gravitational acceleration (m/s²) for the P–Δ effect of its weight; no P–Δ effect unless given.
/// ``carried_weights``: list of pairs (weight in N/m, height above the base in m) of what stands on the block, such as
/// its share of a cap, for the P–Δ effect. These weights themselves act by loads or joints.
#[pyclass(name = "RigidBlock", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyRigidBlock(RigidBlock);

extends!(PyRigidBlock, block => {
    let dof_names = ["x", "y", "rotation"].map(String::from).to_vec();
    PyStructure::from_structure(block.0.clone()).with_dof_names(Some(DofNames::new(dof_names, 3)?))
});

/// The block with the middle of its base at x = `center`, and with the P–Δ effect of itself and of carried weights.
fn positioned_block(
    block: basemat::Result<RigidBlock>,
    center: f64,
    p_delta: Option<f64>,
    carried_weights: Option<PairList<f64, f64>>,
) -> PyResult<PyRigidBlock> {
    let block = block.and_then(|block| block.centered_at(center));
    let mut block = block.with(p_delta, RigidBlock::with_p_delta);
    for (weight, height) in carried_weights.into_iter().flat_map(|weights| weights.0) {
        block = block.and_then(|block| block.with_carried_weight(weight, height));
    }
    block.or_raise().map(PyRigidBlock)
}

#[pymethods]
impl PyRigidBlock {
    #[pyo3(signature = (width, height, density, *, center=0.0, p_delta=None, carried_weights=None))]
    #[new]
    fn new(
        width: f64,
        height: f64,
        density: f64,
        center: f64,
        p_delta: Option<f64>,
        carried_weights: Option<PairList<f64, f64>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let block = RigidBlock::new(width, height, density);
        positioned_block(block, center, p_delta, carried_weights)?.initializer()
    }

    /// Block of a ``width`` (m) and a ``mass`` (kg/m) with the ``rotary_inertia`` (kg m²/m) about its
    /// centre of mass, which is ``center_height`` (m) above the base; ``center`` is as in the class, and so are ``p_delta`` and
    /// ``carried_weights``, if given.
    #[pyo3(signature = (width, mass, rotary_inertia, center_height, *, center=0.0, p_delta=None, carried_weights=None))]
    #[staticmethod]
    fn from_mass(
        width: f64,
        mass: f64,
        rotary_inertia: f64,
        center_height: f64,
        center: f64,
        p_delta: Option<f64>,
        carried_weights: Option<PairList<f64, f64>>,
    ) -> PyResult<Self> {
        let block = RigidBlock::from_mass(width, mass, rotary_inertia, center_height);
        positioned_block(block, center, p_delta, carried_weights)
    }

    /// Points of the block as contact nodes, a list of `BaseNode`, for a `Joint`. ``points``: array of shape (n, 2) of the
    /// coordinate x on the surface and the height above the base, m.
    fn contact_nodes(&self, points: Pairs) -> PyResult<Vec<PyBaseNode>> {
        self.0.contact_nodes(&points.0).or_raise().map(python_nodes)
    }

    /// Mass, kg/m.
    #[getter]
    fn total_mass(&self) -> f64 {
        self.0.total_mass()
    }

    /// Rotary inertia about the middle of the base, kg m²/m.
    #[getter]
    fn base_inertia(&self) -> f64 {
        self.0.base_inertia()
    }

    /// Index of the degree of freedom of the displacement to the right.
    #[classattr]
    #[pyo3(name = "HORIZONTAL")]
    const HORIZONTAL_DOF: usize = RigidBlock::HORIZONTAL_DOF;
    /// Index of the degree of freedom of the displacement up.
    #[classattr]
    #[pyo3(name = "VERTICAL")]
    const VERTICAL_DOF: usize = RigidBlock::VERTICAL_DOF;
    /// Index of the degree of freedom of the rotation.
    #[classattr]
    #[pyo3(name = "ROTATION")]
    const ROTATION_DOF: usize = RigidBlock::ROTATION_DOF;

    /// The `DofCombination` of the displacement to the right at a ``height`` (m) above the base.
    fn horizontal_at(&self, height: f64) -> PyDofCombination {
        self.0.horizontal_at(height).into()
    }

    /// The `DofCombination` of the displacement up at ``x`` (m).
    fn vertical_at(&self, x: f64) -> PyDofCombination {
        self.0.vertical_at(x).into()
    }
}

/// A rigid body on a flat base, in space.
///
/// Its six degrees of freedom are at the middle of its base: displacements along x (to the right), y (away from the
/// viewer) and z (up), rotations about these: "x", "y", "z", "rx", "ry", "rz" for `dof`. Its ground has contact elements
/// along x and y: `ElasticGround.under` creates it. `cuboid`, `cylinder` and `from_mass` create the body.
#[pyclass(name = "RigidBody", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyRigidBody(pub(super) RigidBody);

/// Names of the degrees of freedom of a rigid body.
pub(super) const BODY_DOF_NAMES: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

extends!(PyRigidBody, body => {
    let dof_names = BODY_DOF_NAMES.map(String::from).to_vec();
    PyStructure::from_structure(body.0.clone()).with_dof_names(Some(DofNames::new(dof_names, 6)?))
});

/// The body with the point of its degrees of freedom at `center`, and with the P–Δ effect if `p_delta` is given.
fn positioned_body(
    body: basemat::Result<RigidBody>,
    center: (f64, f64),
    p_delta: Option<f64>,
) -> PyResult<PyRigidBody> {
    let body = body.and_then(|body| body.centered_at(center.into()));
    body.with(p_delta, RigidBody::with_p_delta).or_raise().map(PyRigidBody)
}

#[pymethods]
impl PyRigidBody {
    /// Homogeneous cuboid: its ``length`` along x, ``width`` along y and ``height`` (m), and its ``density`` (kg/m³).
    /// ``center``: x and y of the middle of its base, m; (0, 0) by default. ``p_delta``: gravitational acceleration
    /// (m/s²) for the P–Δ effect of its weight; no P–Δ effect unless given.
    #[pyo3(
        signature = (length, width, height, density, *, center=(0.0, 0.0), p_delta=None),
        text_signature = "(length, width, height, density, *, center=(0.0, 0.0), p_delta=None)"
    )]
    #[staticmethod]
    fn cuboid(
        length: f64,
        width: f64,
        height: f64,
        density: f64,
        center: (f64, f64),
        p_delta: Option<f64>,
    ) -> PyResult<Self> {
        positioned_body(RigidBody::cuboid([length, width, height], density), center, p_delta)
    }

    /// Homogeneous cylinder that stands on its base: ``radius`` and ``height`` (m), and its ``density`` (kg/m³).
    /// ``center`` and ``p_delta``, if given, are as in `cuboid`.
    #[pyo3(
        signature = (radius, height, density, *, center=(0.0, 0.0), p_delta=None),
        text_signature = "(radius, height, density, *, center=(0.0, 0.0), p_delta=None)"
    )]
    #[staticmethod]
    fn cylinder(
        radius: f64,
        height: f64,
        density: f64,
        center: (f64, f64),
        p_delta: Option<f64>,
    ) -> PyResult<Self> {
        positioned_body(RigidBody::cylinder(radius, height, density), center, p_delta)
    }

    /// Any rigid body on a convex base, by its mass and inertia.
    ///
    /// Coordinates are relative to the point whose motion the degrees of freedom describe. ``outline``: corners of the
    /// base, list of x and y, m. ``mass``: kg. ``inertia``: tensor about the centre of mass, 3 × 3, kg m², with the
    /// negative products of inertia off the diagonal. ``gravity_center``: x, y and z of the centre of mass, m.
    /// ``center``: x and y of that point, m; (0, 0) by default. ``p_delta``, if given, is as in `cuboid`.
    #[pyo3(
        signature = (outline, mass, inertia, gravity_center, *, center=(0.0, 0.0), p_delta=None),
        text_signature = "(outline, mass, inertia, gravity_center, *, center=(0.0, 0.0), p_delta=None)"
    )]
    #[staticmethod]
    fn from_mass(
        outline: Vec<[f64; 2]>,
        mass: f64,
        inertia: [[f64; 3]; 3],
        gravity_center: [f64; 3],
        center: (f64, f64),
        p_delta: Option<f64>,
    ) -> PyResult<Self> {
        positioned_body(
            RigidBody::from_mass(outline, mass, inertia, gravity_center),
            center,
            p_delta,
        )
    }

    /// Mass, kg.
    #[getter]
    fn total_mass(&self) -> f64 {
        self.0.total_mass()
    }

    /// The three `DofCombination` of the displacements along x, along y and up of the point at ``x``, ``y`` and ``z``
    /// from the middle of the base (m).
    fn displacement_at(&self, x: f64, y: f64, z: f64) -> [PyDofCombination; 3] {
        python_rows(self.0.displacement_at([x, y, z]))
    }
}
