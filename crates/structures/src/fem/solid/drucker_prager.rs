//! Drucker–Prager's law: drained sand, and soil with cohesion and friction.

use std::f64::consts::FRAC_PI_2;

use super::cone::{Cone, ConeReturn, Stress, cone_root, cone_slope};
use super::tensor::{check_strain, isotropic_matrix, scaled, shear_strain, strain_deviator, trace};
use super::{SolidMaterial, SolidState, StrainPath};
use crate::error::{Result, all_finite, finite, not_negative, require, same_length};
use crate::fem::internal_energy::InternalEnergy;
use crate::fem::material::Material;

/// Sand or other drained soil: yields on Drucker–Prager's cone, matched to Mohr–Coulomb in plane strain.
///
/// Elastic–perfectly plastic with cohesion c, friction angle φ and dilation angle ψ ≤ φ. A smaller ψ than φ makes the
/// tangent unsymmetric. Stress beyond the tip of the cone returns to the tip, where the tangent is 10⁻⁴ of the
/// elasticity in place of zero, so that stiffness matrices stay regular. With φ = 0 it is von Mises' law with the shear
/// strength c. The table of laws in [`SolidMaterial`] has the formulas.
///
/// An **initial stress** lies within the cone. Stress at rest with σ_h = K₀ σ_v and K₀ = 1 − sin φ (Jaky) lies outside
/// of it for c = 0 and φ above about 36°.
///
/// The internal variables are the plastic strain, the energy dissipated so far and the initial stress.
///
/// ```
/// use basemat::fem::{DruckerPrager, Material, SolidMaterial};
///
/// let elastic = Material::new(80.0e6, 0.3, 1800.0)?;
/// let sand = DruckerPrager::new(elastic, 0.0, 30.0_f64.to_radians(), 30.0_f64.to_radians())?;
/// let mut variables = vec![0.0; sand.variable_count()];
/// // 100 kPa of pressure in all directions, then shear without change of volume.
/// sand.initialize([-100.0e3, -100.0e3, -100.0e3, 0.0], &mut variables)?;
/// let sheared = [0.0, 0.0, 0.0, 1.0e-3];
/// let [xx, _, _, shear] = sand.stress(sheared, &variables)?;
/// // G γ = 30.8 kPa is elastic: the cone allows 48.0 kPa.
/// assert!((shear - 30.769e3).abs() < 1.0 && xx == -100.0e3);
/// assert!((sand.state(sheared, &variables).mobilised_strength - 0.641).abs() < 1e-3);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "DruckerPragerForm"))]
pub struct DruckerPrager {
    elastic: Material,
    cohesion: f64,
    friction_angle: f64,
    dilation_angle: f64,
    #[cfg_attr(feature = "serde", serde(skip))]
    cone: Cone,
}

validated! {
    DruckerPrager as DruckerPragerForm {
        elastic: Material,
        cohesion: f64,
        friction_angle: f64,
        dilation_angle: f64,
    }
    => DruckerPrager::new(elastic, cohesion, friction_angle, dilation_angle)
}

/// Number of internal variables: plastic strain, dissipated energy, initial stress.
const VARIABLE_COUNT: usize = 9;

/// Part of the elasticity that the tangent has at the tip of the cone.
///
/// The stress at the tip does not change with the strain. A tangent of zeros would make the stiffness matrix singular
/// where all points around a node are at the tip. With this part the condition number of the matrix is small enough for
/// double precision. Where only some points are at the tip, Newton's method needs less than one iteration more. Stress
/// and energies do not depend on it.
pub(super) const APEX_TANGENT_FRACTION: f64 = 1e-4;

/// Largest yield function of a stress on the cone, relative to the terms of the strength.
///
/// Rounding gives less.
const YIELD_FUNCTION_ROUNDING: f64 = 1e-9;

/// Internal variables of a point.
struct ConeVariables {
    /// Plastic strain, with the engineering shear strain.
    plastic_strain: [f64; 4],
    /// Energy dissipated since the initial state, J/m³.
    dissipated_energy: f64,
    /// Initial stress, Pa.
    initial_stress: [f64; 4],
}

impl DruckerPrager {
    /// Soil from its elasticity, cohesion (Pa), friction angle and dilation angle (rad).
    ///
    /// With t = tan φ, α = t/√(9 + 12 t²) and k = 3 c/√(9 + 12 t²): in plane strain with ψ = φ the strength is that of
    /// Mohr–Coulomb's law. β of the plastic potential follows from tan ψ as α from tan φ. With ψ = 0 the plastic strain
    /// has no change of volume.
    ///
    /// ```
    /// use basemat::fem::{DruckerPrager, Material};
    ///
    /// let elastic = Material::new(80.0e6, 0.3, 1800.0)?;
    /// let error = DruckerPrager::new(elastic, 0.0, 0.5, 0.6).unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     "dilation angle of the soil (rad) is 0.6, but must be from 0 to the friction angle of the soil"
    /// );
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless c ≥ 0 is finite, 0 ≤ φ < π/2 and 0 ≤ ψ ≤ φ, and for c = φ = 0.
    pub fn new(
        elastic: Material,
        cohesion: f64,
        friction_angle: f64,
        dilation_angle: f64,
    ) -> Result<Self> {
        not_negative("cohesion of the soil", cohesion)?;
        let is_in_range = (0.0..FRAC_PI_2).contains(&friction_angle);
        let quantity = "friction angle of the soil (rad)";
        require(quantity, friction_angle, is_in_range, "from 0 to below π/2")?;
        let is_in_range = (0.0..=friction_angle).contains(&dilation_angle);
        let needed = "from 0 to the friction angle of the soil";
        require("dilation angle of the soil (rad)", dilation_angle, is_in_range, needed)?;
        let has_strength = cohesion > 0.0 || friction_angle > 0.0;
        let needed = "above zero for a soil without friction";
        require("cohesion of the soil", cohesion, has_strength, needed)?;
        let g = elastic.shear_modulus();
        let cone = Cone {
            g,
            k: elastic.lame() + 2.0 * g / 3.0,
            alpha: cone_slope(friction_angle),
            beta: cone_slope(dilation_angle),
            shear_at_zero_pressure: 3.0 * cohesion / cone_root(friction_angle),
        };
        Ok(Self { elastic, cohesion, friction_angle, dilation_angle, cone })
    }

    /// Elastic part of the law, with the density.
    pub fn elastic(&self) -> Material {
        self.elastic
    }

    /// Cohesion c, Pa.
    pub fn cohesion(&self) -> f64 {
        self.cohesion
    }

    /// Friction angle φ, rad.
    pub fn friction_angle(&self) -> f64 {
        self.friction_angle
    }

    /// Dilation angle ψ, rad.
    pub fn dilation_angle(&self) -> f64 {
        self.dilation_angle
    }

    /// Returns an error for a strain that is not finite, or too large for the yield function.
    fn check_strain(&self, strain: [f64; 4]) -> Result<()> {
        check_strain(strain, self.cone.g.max(self.cone.k))
    }

    /// Shear stress below which a difference to the strength is rounding, Pa.
    fn strength_rounding(&self, stress: Stress) -> f64 {
        let pressure_term = (self.cone.alpha * stress.first_invariant).abs();
        YIELD_FUNCTION_ROUNDING * (self.cone.shear_at_zero_pressure + pressure_term)
    }

    /// Elastic trial stress at a strain.
    fn trial_stress(&self, strain: [f64; 4], variables: &ConeVariables) -> Stress {
        let elastic_strain = std::array::from_fn(|i| strain[i] - variables.plastic_strain[i]);
        let initial = Stress::of(variables.initial_stress);
        let increment = scaled(strain_deviator(elastic_strain), 2.0 * self.cone.g);
        Stress {
            deviator: std::array::from_fn(|i| initial.deviator[i] + increment[i]),
            first_invariant: initial.first_invariant + 3.0 * self.cone.k * trace(elastic_strain),
        }
    }

    /// Stress at a strain by the backward Euler scheme from the committed variables.
    fn stress_at(&self, strain: [f64; 4], variables: &ConeVariables) -> Stress {
        let trial = self.trial_stress(strain, variables);
        self.cone.returned(trial).stress(trial)
    }
}

/// Internal variables of a point, as named fields.
fn read(variables: &[f64]) -> Result<ConeVariables> {
    let quantity = "internal variables of Drucker-Prager's law";
    same_length(quantity, variables.len(), VARIABLE_COUNT)?;
    Ok(ConeVariables {
        plastic_strain: std::array::from_fn(|i| variables[i]),
        dissipated_energy: variables[4],
        initial_stress: std::array::from_fn(|i| variables[5 + i]),
    })
}

/// Elastic–perfectly plastic with a cone as yield surface.
impl SolidMaterial for DruckerPrager {
    fn density(&self) -> f64 {
        self.elastic.density()
    }

    fn elasticity(&self) -> [[f64; 4]; 4] {
        isotropic_matrix(2.0 * self.cone.g, self.cone.k)
    }

    fn variable_count(&self) -> usize {
        VARIABLE_COUNT
    }

    /// # Errors
    /// [`Error::Item`](crate::Error::Item) with the largest √J₂ at this pressure for a stress outside of the cone,
    /// [`Error::NotFinite`](crate::Error::NotFinite) for a stress that is not finite, and
    /// [`Error::Size`](crate::Error::Size) for another number of variables.
    fn initialize(&self, initial_stress: [f64; 4], variables: &mut [f64]) -> Result<()> {
        read(variables)?;
        all_finite("initial stress of Drucker-Prager's law", &initial_stress)?;
        let stress = Stress::of(initial_stress);
        let strength = self.cone.shear_strength(stress.first_invariant);
        let shear = stress.shear();
        let is_inside = shear <= strength + self.strength_rounding(stress);
        let needed = "at most the shear strength at this mean stress";
        require("shear stress √J₂ of the initial stress (Pa)", shear, is_inside, needed).map_err(
            |fault| {
                let mean = stress.first_invariant / 3.0;
                let strength = strength.max(0.0);
                fault.within(format!(
                    "soil with a strength √J₂ of {strength} Pa at a mean stress of {mean} Pa"
                ))
            },
        )?;
        variables[..5].fill(0.0);
        variables[5..].copy_from_slice(&initial_stress);
        Ok(())
    }

    fn stress(&self, strain: [f64; 4], variables: &[f64]) -> Result<[f64; 4]> {
        self.check_strain(strain)?;
        let stress = self.stress_at(strain, &read(variables)?).components();
        all_finite("stress of Drucker-Prager's law", &stress)?;
        Ok(stress)
    }

    /// Tangent of the backward Euler scheme.
    ///
    /// At the tip of the cone, 10⁻⁴ of the elasticity takes the place of zero, so that no stiffness matrix is singular.
    fn tangent(&self, strain: [f64; 4], variables: &[f64]) -> Result<[[f64; 4]; 4]> {
        self.check_strain(strain)?;
        let trial = self.trial_stress(strain, &read(variables)?);
        Ok(match self.cone.returned(trial) {
            ConeReturn::Elastic => self.elasticity(),
            ConeReturn::Surface { multiplier, .. } => self.cone.surface_tangent(trial, multiplier),
            ConeReturn::Apex { .. } => {
                self.elasticity().map(|row| row.map(|modulus| APEX_TANGENT_FRACTION * modulus))
            }
        })
    }

    fn has_symmetric_tangent(&self) -> bool {
        self.cone.alpha == self.cone.beta
    }

    fn energy(&self, strain: [f64; 4], variables: &[f64]) -> Result<InternalEnergy> {
        self.check_strain(strain)?;
        let variables = read(variables)?;
        let trial = self.trial_stress(strain, &variables);
        let cone_return = self.cone.returned(trial);
        let initial_stress = Stress::of(variables.initial_stress);
        let stored = self.cone.elastic_energy(cone_return.stress(trial))
            - self.cone.elastic_energy(initial_stress);
        let dissipated = variables.dissipated_energy + self.cone.dissipation(trial, cone_return);
        all_finite("energies of Drucker-Prager's law", &[stored, dissipated])?;
        Ok(InternalEnergy { stored, dissipated })
    }

    /// (σ_m − σ_1) : Δε + ½ Δσ : C⁻¹ : Δσ.
    ///
    /// With ψ = φ it is never below zero; with ψ < φ it has both signs.
    fn remainder(&self, path: &StrainPath, variables: &[f64]) -> Result<f64> {
        for strain in [path.start, path.midstep, path.end] {
            self.check_strain(strain)?;
        }
        let variables = read(variables)?;
        let start = self.stress_at(path.start, &variables);
        let midstep = self.stress_at(path.midstep, &variables).components();
        let end = self.stress_at(path.end, &variables);
        let end_components = end.components();
        let mut remainder = self.cone.elastic_energy(end.change_from(start));
        for i in 0..4 {
            remainder += (midstep[i] - end_components[i]) * (path.end[i] - path.start[i]);
        }
        finite("mid-step remainder of Drucker-Prager's law", remainder)
    }

    fn commit(&self, strain: [f64; 4], variables: &mut [f64]) {
        let Ok(committed) = read(variables) else { return };
        if self.check_strain(strain).is_err() {
            return;
        }
        let trial = self.trial_stress(strain, &committed);
        let cone_return = self.cone.returned(trial);
        if matches!(cone_return, ConeReturn::Elastic) {
            return;
        }
        let stress = cone_return.stress(trial);
        let stress_change = stress.change_from(Stress::of(committed.initial_stress));
        let elastic_strain = self.cone.elastic_strain(stress_change);
        for i in 0..4 {
            variables[i] = strain[i] - elastic_strain[i];
        }
        variables[4] += self.cone.dissipation(trial, cone_return);
    }

    /// The mobilised strength is √J₂/(k − α I₁); it is 1 at the tip of the cone.
    fn state(&self, strain: [f64; 4], variables: &[f64]) -> SolidState {
        let Ok(variables) = read(variables) else { return SolidState::default() };
        let stress = self.stress_at(strain, &variables);
        let stress_change = stress.change_from(Stress::of(variables.initial_stress));
        let elastic_strain = self.cone.elastic_strain(stress_change);
        let plastic_strain = std::array::from_fn(|i| strain[i] - elastic_strain[i]);
        let strength = self.cone.shear_strength(stress.first_invariant);
        let shear = stress.shear();
        let is_below_strength = shear < strength - self.strength_rounding(stress);
        let mobilised_strength = if is_below_strength { shear / strength } else { 1.0 };
        SolidState {
            plastic_strain: shear_strain(strain_deviator(plastic_strain)),
            mobilised_strength,
        }
    }
}
