//! Sections of fibres: stress–strain laws along a bar, areas, points along a beam.
//!
//! | part | files |
//! |---|---|
//! | laws of a fibre | [`UniaxialMaterial`] here; `bilinear_steel.rs`, `menegotto_pinto.rs` (`steel_branch.rs`, `steel_history.rs`, `elementary.rs`), `concrete.rs` |
//! | sections of fibres | `section.rs`, `member_sections.rs`, `section_response.rs`, `section_shapes.rs`, `section_checks.rs` |
//! | forces of a beam without rigid motions | `basic_beam.rs`, `force_based.rs`, `basic_state.rs`, `solution_memo.rs`; `interpolation.rs`, and `quadrature.rs`: points along a beam |

mod basic_beam;
mod basic_state;
mod bilinear_steel;
mod concrete;
mod elementary;
mod force_based;
mod interpolation;
mod member_sections;
mod menegotto_pinto;
mod quadrature;
mod section;
mod section_checks;
mod section_response;
mod section_shapes;
mod solution_memo;
mod steel_branch;
mod steel_history;
#[cfg(test)]
mod tests;

use std::any::Any;
use std::fmt::Debug;

use super::internal_energy::InternalEnergy;
use super::material::Material;
use crate::error::{Error, Result, same_length};

pub(super) use basic_beam::BasicBeam;
pub use basic_beam::BeamFormulation;
pub(super) use basic_state::BasicState;
use basic_state::MAX_SECTIONS;
pub use bilinear_steel::BilinearSteel;
pub use concrete::Concrete;
pub(super) use interpolation::{PLANE_BENDING, SPACE_BENDING};
pub(super) use member_sections::StepEnd;
pub use menegotto_pinto::MenegottoPinto;
pub(super) use quadrature::BeamPoint;
pub use quadrature::BeamQuadrature;
pub use section::FiberSection;
pub(super) use solution_memo::SolutionMemo;

/// Largest number of fibres of a section that a law evaluates at once.
const MAX_BATCH_FIBERS: usize = 16;
/// Largest number of fibres of all sections of a beam that a law evaluates at once.
const MAX_MEMBER_FIBERS: usize = MAX_SECTIONS * MAX_BATCH_FIBERS;

/// Number of fibres of a loop with those that complete its last vector; loops over a rest would take longer.
#[inline]
fn padded_count(fiber_count: usize, max_count: usize) -> usize {
    /// Numbers in a vector of the instruction sets that most machines have.
    const VECTOR_LENGTH: usize = 4;
    fiber_count.next_multiple_of(VECTOR_LENGTH).min(max_count)
}

/// Stress of a fibre and its derivative.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct UniaxialResponse {
    /// Stress, Pa; tension is positive.
    pub stress: f64,
    /// Derivative of the stress with respect to the strain, Pa.
    pub tangent: f64,
}

/// Stress–strain law of a fibre: implement this for materials of your own.
///
/// Strains and stresses are along the bar, with tension positive. The element that has the fibre stores its internal
/// variables. `variables` are those **committed** at the end of the last step. Stress, tangent and energy belong to the
/// straight path from the committed strain to `strain`; only [`commit`](UniaxialMaterial::commit) changes variables.
///
/// # Laws of the library
///
/// | law | for | source |
/// |---|---|---|
/// | [`Material`] | linear elastic fibres, with Young's modulus | |
/// | [`BilinearSteel`] | steel with kinematic hardening | OpenSees `Steel01` without isotropic hardening |
/// | [`MenegottoPinto`] | steel with the Bauschinger effect | Menegotto and Pinto 1973; OpenSees `Steel02` |
/// | [`Concrete`] | concrete without tension | Kent and Park 1971, Scott, Park and Priestley 1982; OpenSees `Concrete01` |
///
/// # A law of your own
///
/// ```
/// use basemat::fem::{UniaxialMaterial, UniaxialResponse};
/// use basemat::structure::InternalEnergy;
/// use basemat::Result;
///
/// /// A cable: no stress in compression.
/// #[derive(Debug)]
/// struct Cable {
///     modulus: f64,
/// }
///
/// impl UniaxialMaterial for Cable {
///     fn modulus(&self) -> f64 {
///         self.modulus
///     }
///     fn response(&self, strain: f64, _variables: &[f64]) -> Result<UniaxialResponse> {
///         let tangent = if strain > 0.0 { self.modulus } else { 0.0 };
///         Ok(UniaxialResponse { stress: tangent * strain, tangent })
///     }
///     fn energy(&self, strain: f64, _variables: &[f64]) -> Result<InternalEnergy> {
///         let stored = 0.5 * self.modulus * strain.max(0.0).powi(2);
///         Ok(InternalEnergy { stored, dissipated: 0.0 })
///     }
///     // Elastic, without internal variables.
///     fn commit(&self, _strain: f64, _variables: &mut [f64]) {}
/// }
///
/// let cable = Cable { modulus: 160.0e9 };
/// assert_eq!(cable.response(1e-3, &[])?.stress, 160.0e6);
/// assert_eq!(cable.response(-1e-3, &[])?.stress, 0.0);
/// # Ok::<(), basemat::Error>(())
/// ```
#[auto_impl::auto_impl(Arc, Box)]
pub trait UniaxialMaterial: Any + Debug + Send + Sync {
    /// Modulus of small strains, Pa.
    ///
    /// It is that of the element's stiffness in Rayleigh damping and in the static forces of P–Δ.
    fn modulus(&self) -> f64;

    /// Number of internal variables of a fibre. Default: none.
    fn variable_count(&self) -> usize {
        0
    }

    /// Overwrites `variables` by those of a fibre without strain and stress. Default: zeros.
    fn initialize(&self, variables: &mut [f64]) {
        variables.fill(0.0);
    }

    /// Stress and tangent at a strain.
    ///
    /// # Errors
    /// Any: the step ends with it, and nothing of the step is committed. The laws of the library return
    /// [`Error::Size`] for a wrong number of variables.
    fn response(&self, strain: f64, variables: &[f64]) -> Result<UniaxialResponse>;

    /// Overwrites `responses` with those of several fibres, whose variables follow each other.
    ///
    /// # Errors
    /// The first of a fibre, with its index.
    #[doc(hidden)]
    fn responses(
        &self,
        strains: &[f64],
        variables: &[f64],
        responses: &mut [UniaxialResponse],
    ) -> std::result::Result<(), (usize, Error)> {
        let count = self.variable_count();
        for (k, (response, strain)) in responses.iter_mut().zip(strains).enumerate() {
            let fiber_variables = &variables[k * count..(k + 1) * count];
            *response = self.response(*strain, fiber_variables).map_err(|fault| (k, fault))?;
        }
        Ok(())
    }

    /// Overwrites `responses` with those of the same fibres of several sections, section by section.
    ///
    /// `variables`: those of the fibres of each section.
    ///
    /// # Errors
    /// The first of a fibre, with its index in its section.
    #[doc(hidden)]
    fn responses_of_sections(
        &self,
        strains: &[f64],
        variables: &[&[f64]],
        responses: &mut [UniaxialResponse],
    ) -> std::result::Result<(), (usize, Error)> {
        let count = strains.len() / variables.len().max(1);
        for (k, variables) in variables.iter().enumerate() {
            let fibers = k * count..(k + 1) * count;
            self.responses(&strains[fibers.clone()], variables, &mut responses[fibers])?;
        }
        Ok(())
    }

    /// Overwrites `energies` with those of several fibres, as [`responses`](UniaxialMaterial::responses).
    ///
    /// # Errors
    /// The first of a fibre, with its index.
    #[doc(hidden)]
    fn energies(
        &self,
        strains: &[f64],
        variables: &[f64],
        energies: &mut [InternalEnergy],
    ) -> std::result::Result<(), (usize, Error)> {
        let count = self.variable_count();
        for (k, (energy, strain)) in energies.iter_mut().zip(strains).enumerate() {
            let fiber_variables = &variables[k * count..(k + 1) * count];
            *energy = self.energy(*strain, fiber_variables).map_err(|fault| (k, fault))?;
        }
        Ok(())
    }

    /// Overwrites remainders of a step and energies at its end, of the same fibres of several sections.
    ///
    /// `strains`: at the start, at mid-step and at the end. `variables` and errors are as for
    /// [`responses_of_sections`](UniaxialMaterial::responses_of_sections). `stresses` are those at mid-step. A law whose
    /// [`commit_stresses`](UniaxialMaterial::commit_stresses) needs the stresses at the end overwrites them.
    ///
    /// # Errors
    /// The first of a fibre, with its index in its section.
    #[doc(hidden)]
    fn end_step(
        &self,
        strains: [&[f64]; 3],
        variables: &[&[f64]],
        _stresses: &mut [f64],
        remainders: &mut [f64],
        energies: &mut [InternalEnergy],
    ) -> std::result::Result<(), (usize, Error)> {
        let fiber_count = remainders.len() / variables.len().max(1);
        let variable_count = self.variable_count();
        for (section, variables) in variables.iter().enumerate() {
            let first = section * fiber_count;
            for k in 0..fiber_count {
                let fiber_variables = &variables[k * variable_count..(k + 1) * variable_count];
                let fiber_strains = strains.map(|strains| strains[first + k]);
                remainders[first + k] =
                    self.remainder(fiber_strains, fiber_variables).map_err(|fault| (k, fault))?;
            }
            let fibers = first..first + fiber_count;
            self.energies(&strains[2][fibers.clone()], variables, &mut energies[fibers])?;
        }
        Ok(())
    }

    /// Commits several fibres with their stresses from [`end_step`](UniaxialMaterial::end_step).
    #[doc(hidden)]
    fn commit_stresses(&self, strains: &[f64], _stresses: &[f64], variables: &mut [f64]) {
        self.commit_fibers(strains, variables);
    }

    /// Commits several fibres, as [`responses`](UniaxialMaterial::responses).
    #[doc(hidden)]
    fn commit_fibers(&self, strains: &[f64], variables: &mut [f64]) {
        let count = self.variable_count();
        for (k, strain) in strains.iter().enumerate() {
            self.commit(*strain, &mut variables[k * count..(k + 1) * count]);
        }
    }

    /// Energy stored and dissipated since the initial state, J/m³.
    ///
    /// # Errors
    /// As for [`response`](UniaxialMaterial::response).
    fn energy(&self, strain: f64, variables: &[f64]) -> Result<InternalEnergy>;

    /// Work of the midstep stress that is neither stored nor dissipated, J/m³.
    ///
    /// `strains` are those at the start, where the stress is evaluated (usually the middle), and at the end of the step.
    /// The remainder is σ(midstep)·(end − start) less the changes of [`energy`](UniaxialMaterial::energy). The default
    /// evaluates this definition.
    ///
    /// # Errors
    /// As for [`response`](UniaxialMaterial::response).
    fn remainder(&self, strains: [f64; 3], variables: &[f64]) -> Result<f64> {
        let [start, midstep, end] = strains;
        let work = self.response(midstep, variables)?.stress * (end - start);
        let start_energy = self.energy(start, variables)?;
        let end_energy = self.energy(end, variables)?;
        let stored_change = end_energy.stored - start_energy.stored;
        let dissipated_change = end_energy.dissipated - start_energy.dissipated;
        Ok(work - stored_change - dissipated_change)
    }

    /// Overwrites `variables` by those after a step that ended with `strain`.
    fn commit(&self, strain: f64, variables: &mut [f64]);
}

/// Returns an error for a wrong number of internal variables.
fn check_variables(variables: &[f64], count: usize) -> Result<()> {
    same_length("internal variables of a fibre", variables.len(), count)
}

/// Linear elastic, with Young's modulus.
impl UniaxialMaterial for Material {
    fn modulus(&self) -> f64 {
        self.young_modulus()
    }

    fn response(&self, strain: f64, _variables: &[f64]) -> Result<UniaxialResponse> {
        let tangent = self.young_modulus();
        Ok(UniaxialResponse { stress: tangent * strain, tangent })
    }

    fn energy(&self, strain: f64, _variables: &[f64]) -> Result<InternalEnergy> {
        let stored = 0.5 * self.young_modulus() * strain * strain;
        Ok(InternalEnergy { stored, dissipated: 0.0 })
    }

    fn commit(&self, _strain: f64, _variables: &mut [f64]) {}
}
