//! The static state: equilibrium on the ground, and causes of its absence.

pub(crate) mod buckling;
pub(crate) mod compliance;
mod convergence;
pub(crate) mod equilibrium;
mod fictitious_springs;
mod imbalance;
pub(crate) mod increment_search;
mod loaded_part;
pub(crate) mod prescribed_displacement;
mod shortened_increment;
pub(crate) mod stability;
pub(crate) mod static_state;
pub(crate) mod strength;
