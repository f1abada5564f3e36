//! Structures.

mod beam_ends;
mod block;
mod building;
mod composed;
mod connectivity;
mod dof_combination;
mod fem;
mod gmsh_space;
mod grid;
mod hysteresis;
mod in_space;
mod layer;
mod material;
mod matrices;
mod mesh;
mod quads;
mod shells;
mod solid_material;
mod solid_points;
mod stress_at_rest;
mod superclass;

pub(crate) use beam_ends::{PyBeamEndRows, PyBeamRows};
pub(crate) use block::{PyRigidBlock, PyRigidBody};
pub(crate) use building::{PyPlanStorey, PyShearBuilding, PyStorey, PyStoreyBuilding};
pub(crate) use composed::{
    PyRayleighDamping, PyReducedModel, PyStructureGroup, PyWithModalDamping, PyWithWalls,
};
pub(crate) use fem::{PyFemModel, PyGmshMesh};
pub(crate) use gmsh_space::PyGmshSpaceMesh;
pub(crate) use grid::PyGrid;
pub(crate) use hysteresis::{
    PyBilinear, PyBoucWen, PyFrictionPendulum, PyHysteresis, PyLeadRubber, PyPendulumBearing,
    PyWithSprings,
};
pub(crate) use layer::PyLayer;
pub(crate) use material::{PyBeamSection, PyMaterial};
pub(crate) use matrices::PyMatrixModel;
pub(crate) use mesh::PyMesh;
pub(crate) use shells::{PyShellResultants, PyShellRows};
pub(crate) use solid_material::{PyDruckerPrager, PyIwan, stress_path};
pub(crate) use solid_points::PySolidPoints;
pub(crate) use stress_at_rest::PyStressAtRest;
pub(crate) use superclass::{PyStructure, new_structure, structure_recipe};
