//! Finite elements, and models of structures: their matrices, damping, reduction and hysteretic springs.
//!
//! `basemat` re-exports both modules under the same paths. Examples in the documentation use these paths.
#![forbid(unsafe_code)]

#[macro_use]
extern crate basemat_base;

#[macro_use]
pub mod structure;

pub mod fem;

pub use basemat_base::{Error, Result};
use basemat_base::{error, geometry, text};
use basemat_linalg as linalg;

/// Functions for `basemat` itself, which may change with any version.
#[doc(hidden)]
pub mod internal {
    pub use crate::fem::coincident::first_coincident_points;
    pub use crate::structure::base_node::{check_left_to_right, check_line};
    pub use crate::structure::detached::{check_attached, dof_list_text};
    pub use crate::structure::matrix_checks::{
        NEGLIGIBLE_SQUARED_FREQUENCY, check_damping, check_mass, check_stiffness, massless,
        proportional_factors,
    };
    pub use crate::structure::nonlinear::{
        MassAndStiffness, Tangent, check_nonlinear_force, mass_and_stiffness, nonlinear_state,
        restore_variables, save_variables,
    };
    pub use crate::structure::probe::{Probe, check_probes, probe_index};
    pub use crate::structure::spring_supported_base::{
        SpringSupportedBase, max_diagonal_stiffness,
    };
}
