//! Constitutive laws of solids with internal variables.

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

/// Strains of a step at a point of a solid, each `[xx, yy, zz, xy]` with the engineering shear strain.
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
    /// Plastic shear strain √(2 e^p : e^p) of the deviator e^p; in simple shear it is |γ^p|.
    pub plastic_strain: f64,
    /// Shear stress over shear strength, from 0 to 1 (1: the solid yields with its full strength).
    pub mobilised_strength: f64,
}

/// Constitutive law of a solid in plane strain: implement this for materials of your own.
///
/// Stresses and strains are `[xx, yy, zz, xy]`, with tension positive, stresses in Pa and the engineering shear strain
/// γ_xy = 2 ε_xy. The element that has the material stores its internal variables. `variables` are those **committed**
/// at the end of the last step. Stress, tangent and energy belong to the straight path from the committed strain to
/// `strain`; only [`commit`](SolidMaterial::commit) changes variables.
///
/// [`Material`] is the linear elastic one of these laws; it has no variables.
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
    /// The stress at zero strain is then `initial_stress`.
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

    /// Stored energy, and energy dissipated since the initial state, J/m³.
    ///
    /// # Errors
    /// As for [`stress`](SolidMaterial::stress).
    fn energy(&self, strain: [f64; 4], variables: &[f64]) -> Result<InternalEnergy>;

    /// Work of the midstep stress that is neither stored nor dissipated, J/m³.
    ///
    /// It is σ(`midstep`):(`end` − `start`) less the changes of [`energy`](SolidMaterial::energy). The default
    /// evaluates this definition. With a formula of its own, the energy balance of a run checks stress and energies.
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
    /// `variables` must stay finite. A material that cannot follow the step keeps them, and returns an error from the
    /// next [`stress`](SolidMaterial::stress).
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
