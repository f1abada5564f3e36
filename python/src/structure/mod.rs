//! Structures.

mod beam_ends;
mod beam_sections;
mod bilinear_moment;
mod block;
mod building;
mod composed;
mod connectivity;
mod dof_combination;
mod fem;
mod fiber_material;
mod fiber_section;
mod gmsh_space;
mod grid;
mod hinges;
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
mod with_elements;

pub(crate) use beam_ends::{PyBeamEndRows, PyBeamRows};
pub(crate) use beam_sections::PyBeamSections;
pub(crate) use bilinear_moment::PyBilinearMoment;
pub(crate) use block::{PyRigidBlock, PyRigidBody};
pub(crate) use building::{PyPlanStorey, PyShearBuilding, PyStorey, PyStoreyBuilding};
pub(crate) use composed::{
    PyRayleighDamping, PyReducedModel, PyStructureGroup, PyWithModalDamping, PyWithWalls,
};
pub(crate) use fem::{PyFemModel, PyGmshMesh};
pub(crate) use fiber_material::{PyBilinearSteel, PyConcrete, PyMenegottoPinto, fiber_stress_path};
pub(crate) use fiber_section::PyFiberSection;
pub(crate) use gmsh_space::PyGmshSpaceMesh;
pub(crate) use grid::PyGrid;
pub(crate) use hinges::{PyAxialMomentSurface, PyHingeState};
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
pub(crate) use with_elements::PyWithElements;
