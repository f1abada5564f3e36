//! Laws between base and ground.

mod base;
mod laws;
mod variable;

pub(crate) use base::{PyInterfaceLaw, recipes};
pub(crate) use laws::{PyBonded, PyCohesive, PyCoulomb, PyThinLayer, PyYielding};
pub(crate) use variable::PyVariableFriction;
