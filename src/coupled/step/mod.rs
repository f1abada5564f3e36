//! One time step: forcing, increment, and advance of the state.

pub(crate) mod advance;
pub(crate) mod energy_accumulator;
pub(crate) mod forcing;
pub(crate) mod increment;
pub(crate) mod joint_losses;
mod linear;
mod modal_loops;
mod newton;
pub(crate) mod solver;
