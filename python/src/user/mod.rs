//! Parts that users write in Python. The core calls them without the GIL; these wrappers acquire it.

mod ground;
mod hysteresis;
mod law;
mod object;
mod previous_contact;
mod solid_material;
mod structure;
mod uniaxial_material;

pub(crate) use ground::UserGround;
pub(crate) use hysteresis::{hysteresis_recipe, take_made_springs};
pub(crate) use law::{PyCondition, PyTolerance, UserLaw};
pub(crate) use previous_contact::{PyContactState, PyLimits, PyPreviousContact};
pub(crate) use solid_material::solid_material;
pub(crate) use structure::UserStructure;
pub(crate) use uniaxial_material::uniaxial_material;
