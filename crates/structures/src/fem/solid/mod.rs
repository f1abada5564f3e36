//! Constitutive laws of solids with internal variables.
//!
//! | law | files |
//! |---|---|
//! | linear elastic | `fem/material.rs`, and its `impl SolidMaterial` here |
//! | Iwan's model: clay without drainage | `iwan.rs`; `iwan_backbone.rs`: its components from a backbone |
//! | Drucker–Prager: drained sand | `drucker_prager.rs`; `cone.rs`: return of stresses to the cone |
//!
//! Formulas, units and sources stand in the documentation of [`SolidMaterial`]. `tensor.rs` has the algebra of
//! deviators.

mod cone;
mod drucker_prager;
mod iwan;
mod iwan_backbone;
mod shared;
mod tensor;
#[cfg(test)]
mod tests;

use std::any::Any;
use std::fmt::Debug;

use super::internal_energy::InternalEnergy;
use super::material::Material;
use crate::error::Result;

pub use drucker_prager::DruckerPrager;
pub use iwan::Iwan;
pub use shared::SharedMaterial;

/// Strains of a step at a point of a solid.
///
/// Each is `[xx, yy, zz, xy]` with the engineering shear strain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrainPath {
    /// Strain at the end of the last step, to which the internal variables belong.
    pub start: [f64; 4],
    /// Strain at which the time scheme evaluates the stress, usually the middle of the step.
    pub midstep: [f64; 4],
    /// Strain at the end of the step.
    pub end: [f64; 4],
}

/// Plastic deformation of a solid at a point, for results and pictures.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SolidState {
    /// Plastic shear strain √(2 e^p : e^p) of the deviator e^p.
    ///
    /// In simple shear it is |γ^p|.
    pub plastic_strain: f64,
    /// Shear stress over shear strength, from 0 to 1.
    ///
    /// At 1 the solid yields with its full strength.
    pub mobilised_strength: f64,
}

/// Constitutive law of a solid in plane strain: implement this for materials of your own.
///
/// Stresses and strains are `[xx, yy, zz, xy]`, with tension positive, stresses in Pa, energies in J/m³, and the
/// engineering shear strain γ_xy = 2 ε_xy. The element that has the material stores its internal variables. `variables`
/// are those **committed** at the end of the last step. Stress, tangent and energy belong to the straight path from the
/// committed strain to `strain`; only [`commit`](SolidMaterial::commit) changes variables.
///
/// # Laws of the library
///
/// | law | for | yield surface | tangent |
/// |---|---|---|---|
/// | [`Material`] | linear elastic solids | none | symmetric |
/// | [`Iwan`] | clay without drainage; any modulus-reduction curve | \|s_j\| = r_j of parallel components; \|s\| = √2 τ_n in all | symmetric |
/// | [`DruckerPrager`] | drained sand; soil with friction and cohesion | √J₂ + α I₁ = k | symmetric for ψ = φ |
///
/// All have the elasticity C : ε = 2 G e + K tr ε 1, with the deviator e of the strain, and evaluate the plastic strain
/// at the end of the path (backward Euler). |s| = √(s : s), I₁ = tr σ, √J₂ = |s|/√2.
///
/// **Iwan** (Iwan 1967; Besseling 1958): from the points (γ_j, τ_j) of the backbone in simple shear, with slopes k_j,
///
/// ```text
/// G_j = k_j − k_(j+1),  r_j = √2 G_j γ_j,  σ = Σ s_j + K tr ε 1
/// s_j = q_j 2 G_j (e − e_j^p),  q_j = min(1, r_j/|2 G_j (e − e_j^p)|)
/// tangent:    Σ 2 G_j q_j (I_dev − n_j⊗n_j where the component yields) + K 1⊗1,  n_j = s_j/|s_j|
/// stored:     Σ |s_j|²/(4 G_j) + ½ K (tr ε)²
/// dissipated: Σ s_j : Δe_j^p
/// remainder:  Σ [(s_j,m − s_j,1) : Δe + |Δs_j|²/(4 G_j)] ≥ 0
/// ```
///
/// **Drucker–Prager** (Drucker and Prager 1952), matched to Mohr–Coulomb's law in plane strain: with t = tan φ,
///
/// ```text
/// f = √J₂ + α I₁ − k,  α = t/√(9 + 12 t²),  k = 3 c/√(9 + 12 t²)
/// Δε^p = Δλ (s/(2 √J₂) + β 1),  β as α from tan ψ,  Δλ = f/(G + 9 K α β) of the elastic stress
/// stored:     |s|²/(4 G) + I₁²/(18 K)
/// dissipated: σ : Δε^p = Δλ (k − (α − β) I₁);  at the tip of the cone I₁/3 tr Δε^p with I₁ = k/α
/// remainder:  (σ_m − σ_1) : Δε + ½ Δσ : C⁻¹ : Δσ, ≥ 0 for ψ = φ
/// ```
///
/// Stored energy is relative to the initial state. It is therefore negative where an initial stress is relieved.
///
/// # A law of your own
///
/// ```
/// use basemat::fem::{Material, SolidMaterial, StrainPath};
/// use basemat::structure::InternalEnergy;
/// use basemat::Result;
///
/// /// Foam: linear elastic, and a pressure that grows with the cube of the change of volume.
/// #[derive(Debug)]
/// struct Foam {
///     linear: Material,
///     hardening: f64,
/// }
///
/// fn volume_change([xx, yy, zz, _]: [f64; 4]) -> f64 {
///     xx + yy + zz
/// }
///
/// impl SolidMaterial for Foam {
///     fn density(&self) -> f64 {
///         self.linear.density()
///     }
///     fn elasticity(&self) -> [[f64; 4]; 4] {
///         SolidMaterial::elasticity(&self.linear)
///     }
///     fn initialize(&self, initial_stress: [f64; 4], variables: &mut [f64]) -> Result<()> {
///         self.linear.initialize(initial_stress, variables) // accepts no stress but zero
///     }
///     fn stress(&self, strain: [f64; 4], variables: &[f64]) -> Result<[f64; 4]> {
///         let mut stress = self.linear.stress(strain, variables)?;
///         for normal_stress in &mut stress[..3] {
///             *normal_stress += self.hardening * volume_change(strain).powi(3);
///         }
///         Ok(stress)
///     }
///     fn tangent(&self, strain: [f64; 4], _variables: &[f64]) -> Result<[[f64; 4]; 4]> {
///         let mut tangent = self.elasticity();
///         for row in &mut tangent[..3] {
///             for entry in &mut row[..3] {
///                 *entry += 3.0 * self.hardening * volume_change(strain).powi(2);
///             }
///         }
///         Ok(tangent)
///     }
///     fn energy(&self, strain: [f64; 4], variables: &[f64]) -> Result<InternalEnergy> {
///         let mut energy = self.linear.energy(strain, variables)?;
///         energy.stored += 0.25 * self.hardening * volume_change(strain).powi(4);
///         Ok(energy)
///     }
///     // Elastic, without internal variables.
///     fn commit(&self, _strain: [f64; 4], _variables: &mut [f64]) {}
/// }
///
/// let foam = Foam { linear: Material::new(1.0e6, 0.0, 30.0)?, hardening: 1.0e9 };
/// let pressed = [0.0, -0.1, 0.0, 0.0];
/// let [xx, yy, ..] = foam.stress(pressed, &[])?;
/// assert!((xx + 1.0e6).abs() < 1e-6 && (yy + 1.1e6).abs() < 1e-6);
/// // A step from rest: half of the work of the hardening is missing at mid-step.
/// let path = StrainPath { start: [0.0; 4], midstep: [0.0, -0.05, 0.0, 0.0], end: pressed };
/// assert!((foam.remainder(&path, &[])? + 12.5e3).abs() < 1e-6);
/// # Ok::<(), basemat::Error>(())
/// ```
#[auto_impl::auto_impl(Arc, Box)]
pub trait SolidMaterial: Any + Debug + Send + Sync {
    /// Density, kg/m³; 0 is allowed.
    fn density(&self) -> f64;

    /// Elasticity matrix of small strains, Pa.
    fn elasticity(&self) -> [[f64; 4]; 4];

    /// Number of internal variables at a point. Default: none.
    fn variable_count(&self) -> usize {
        0
    }

    /// Overwrites `variables` by those at zero strain under an initial stress, Pa.
    ///
    /// The stress at zero strain is then `initial_stress`. An error leaves `variables` as they are.
    ///
    /// # Errors
    /// Any, for an initial stress that the material cannot have, such as one outside of the yield surface.
    fn initialize(&self, initial_stress: [f64; 4], variables: &mut [f64]) -> Result<()>;

    /// Stress at a strain, Pa.
    ///
    /// # Errors
    /// Any: the step ends with it, and nothing of the step is committed.
    fn stress(&self, strain: [f64; 4], variables: &[f64]) -> Result<[f64; 4]>;

    /// Tangent ∂stress/∂strain at a strain, Pa: entry `[i][j]` is ∂σ_i/∂ε_j.
    ///
    /// # Errors
    /// As for [`stress`](SolidMaterial::stress).
    fn tangent(&self, strain: [f64; 4], variables: &[f64]) -> Result<[[f64; 4]; 4]>;

    /// Whether the tangent is symmetric at every strain. Default: yes.
    fn has_symmetric_tangent(&self) -> bool {
        true
    }

    /// Energy stored and dissipated since the initial state, J/m³.
    ///
    /// Both are zero at zero strain with the variables of [`initialize`](SolidMaterial::initialize), but for rounding.
    ///
    /// # Errors
    /// As for [`stress`](SolidMaterial::stress).
    fn energy(&self, strain: [f64; 4], variables: &[f64]) -> Result<InternalEnergy>;

    /// Work of the midstep stress that is neither stored nor dissipated, J/m³.
    ///
    /// It is σ(`midstep`):(`end` − `start`) less the changes of [`energy`](SolidMaterial::energy). The default
    /// evaluates this definition. If a material computes the remainder from a separate formula, the energy balance of a
    /// run checks the stress and the energies.
    ///
    /// # Errors
    /// As for [`stress`](SolidMaterial::stress).
    fn remainder(&self, path: &StrainPath, variables: &[f64]) -> Result<f64> {
        let midstep_stress = self.stress(path.midstep, variables)?;
        let work: f64 = (0..4).map(|i| midstep_stress[i] * (path.end[i] - path.start[i])).sum();
        let start_energy = self.energy(path.start, variables)?;
        let end_energy = self.energy(path.end, variables)?;
        let stored_change = end_energy.stored - start_energy.stored;
        let dissipated_change = end_energy.dissipated - start_energy.dissipated;
        Ok(work - stored_change - dissipated_change)
    }

    /// Overwrites `variables` by those after a step that ended with `strain`.
    ///
    /// `variables` must stay finite. For a step that it cannot follow, a material does not change `variables`, and
    /// returns an error from the next [`stress`](SolidMaterial::stress).
    fn commit(&self, strain: [f64; 4], variables: &mut [f64]);

    /// Plastic strain and mobilised strength at a strain. Default: zeros.
    fn state(&self, _strain: [f64; 4], _variables: &[f64]) -> SolidState {
        SolidState::default()
    }

    /// The material itself, if it is linear elastic. Default: `None`.
    fn as_elastic(&self) -> Option<Material> {
        None
    }
}

/// Linear elastic: without variables.
impl SolidMaterial for Material {
    fn density(&self) -> f64 {
        Material::density(self)
    }

    fn elasticity(&self) -> [[f64; 4]; 4] {
        let lame = self.lame();
        let shear = self.shear_modulus();
        let direct_modulus = lame + 2.0 * shear;
        [
            [direct_modulus, lame, lame, 0.0],
            [lame, direct_modulus, lame, 0.0],
            [lame, lame, direct_modulus, 0.0],
            [0.0, 0.0, 0.0, shear],
        ]
    }

    fn initialize(&self, initial_stress: [f64; 4], _variables: &mut [f64]) -> Result<()> {
        crate::error::require(
            "initial stress of a linear elastic material",
            initial_stress.iter().fold(0.0_f64, |max, stress| max.max(stress.abs())),
            initial_stress == [0.0; 4],
            "zero",
        )?;
        Ok(())
    }

    fn stress(&self, strain: [f64; 4], _variables: &[f64]) -> Result<[f64; 4]> {
        let elasticity = SolidMaterial::elasticity(self);
        Ok(elasticity.map(|row| row.iter().zip(&strain).map(|(d, e)| d * e).sum()))
    }

    fn tangent(&self, _strain: [f64; 4], _variables: &[f64]) -> Result<[[f64; 4]; 4]> {
        Ok(SolidMaterial::elasticity(self))
    }

    fn energy(&self, strain: [f64; 4], variables: &[f64]) -> Result<InternalEnergy> {
        let stress = self.stress(strain, variables)?;
        let stored = stress.iter().zip(&strain).map(|(s, e)| 0.5 * s * e).sum();
        Ok(InternalEnergy { stored, dissipated: 0.0 })
    }

    fn commit(&self, _strain: [f64; 4], _variables: &mut [f64]) {}

    fn as_elastic(&self) -> Option<Material> {
        Some(*self)
    }
}
