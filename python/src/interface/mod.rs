//! Laws between base and ground.

mod laws;
mod superclass;

pub(crate) use laws::{
    PyBonded, PyCohesive, PyCoulomb, PyCyclicYielding, PyEarthPressure, PyThinLayer,
    PyVariableFriction, PyYielding,
};
pub(crate) use superclass::{PyInterfaceLaw, law_recipes};
