//! Damping of structures: proportional to mass and stiffness, or mode by mode.

mod modal_damping;
mod rayleigh;
mod rigid_motions;

pub use modal_damping::{ModalDamping, WithModalDamping};
pub use rayleigh::RayleighDamping;
