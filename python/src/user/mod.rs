//! Parts that users write in Python. The core calls them without the GIL, which is taken here.

mod law;
mod nonlinear;
mod step_start;
mod structure;

pub(crate) use law::{PyCondition, PyContactState, PyTolerance, UserLaw};
pub(crate) use step_start::PyPreviousContact;
pub(crate) use structure::UserStructure;
