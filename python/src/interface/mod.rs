//! Laws between base and ground.

mod laws;
mod superclass;

pub(crate) use laws::{
    PyBonded, PyCohesive, PyCoulomb, PyThinLayer, PyVariableFriction, PyYielding,
};
pub(crate) use superclass::{PyInterfaceLaw, recipes};
