//! Laws between base and ground.

mod base;
mod laws;

pub(crate) use base::{PyInterfaceLaw, recipes};
pub(crate) use laws::{
    PyBonded, PyCohesive, PyCoulomb, PyThinLayer, PyVariableFriction, PyYielding,
};
