//! Structures: the trait that users implement, implementations of it, and hysteretic springs.

pub use basemat_structures::structure::*;

pub(crate) use basemat_structures::internal::{
    HeldBase, MassAndStiffness, NEGLIGIBLE_SQUARED_FREQUENCY, Probe, Tangent, check_attached,
    check_damping, check_line, check_mass, check_probes, check_stiffness, combination,
    from_the_left, is_nonlinear, mass_and_stiffness, massless, nonlinear_state, probe_index,
    restore_variables, save_variables, stiffest, unknown_numbers,
};
