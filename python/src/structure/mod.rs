//! Structures.

mod base;
mod block;
mod building;
mod contact_node;
mod matrices;

pub(crate) use base::{PyStructure, recipe};
pub(crate) use block::PyRigidBlock;
pub(crate) use building::{PyShearBuilding, PyStorey};
pub(crate) use contact_node::PyContactNode;
pub(crate) use matrices::PyMatrixModel;
