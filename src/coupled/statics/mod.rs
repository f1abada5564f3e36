//! The static state: equilibrium on the ground, and why there may be none.

pub(crate) mod equilibrium;
pub(crate) mod stability;
pub(crate) mod strength;
