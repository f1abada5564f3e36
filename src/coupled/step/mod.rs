//! Forcing of one step, and the increment in response to it.

pub(crate) mod advance;
pub(crate) mod energy_accumulator;
pub(crate) mod forcing;
pub(crate) mod increment;
mod linear;
mod modal_loops;
mod newton;
pub(crate) mod solver;
