//! Structures.

mod block;
mod building;
mod composed;
mod dof_combination;
mod fem;
mod hysteresis;
mod matrices;
mod mesh;
mod superclass;

pub(crate) use block::{PyRigidBlock, PyRigidBody};
pub(crate) use building::{PyPlanStorey, PyShearBuilding, PyStorey, PyStoreyBuilding};
pub(crate) use composed::{
    PyRayleighDamping, PyReducedModel, PyStructureGroup, PyWithModalDamping,
};
pub(crate) use fem::{PyFemModel, PyGmshMesh};
pub(crate) use hysteresis::{
    PyBilinear, PyBoucWen, PyFrictionPendulum, PyHysteresis, PyLeadRubber, PyWithSprings,
};
pub(crate) use matrices::PyMatrixModel;
pub(crate) use mesh::{PyLayer, PyMaterial, PyMesh};
pub(crate) use superclass::{PyStructure, made, recipe};
