//! Structures.

mod base;
mod block;
mod building;
mod composed;
mod dof_combination;
mod fem;
mod hysteresis;
mod matrices;
mod mesh;

pub(crate) use base::{PyStructure, made, recipe};
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
