//! Structures: the trait that users implement, implementations of it, and hysteretic springs.

pub use basemat_structures::structure::*;

pub(crate) use basemat_structures::internal::{
    MassAndStiffness, NEGLIGIBLE_SQUARED_FREQUENCY, Probe, SpringSupportedBase, Tangent,
    check_attached, check_damping, check_left_to_right, check_line, check_mass,
    check_nonlinear_force, check_probes, check_stiffness, dof_list_text, mass_and_stiffness,
    massless, max_diagonal_stiffness, nonlinear_state, probe_index, proportional_factors,
    restore_variables, save_variables,
};
