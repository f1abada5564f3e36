//! Iwan's model: clay without drainage, and soil with any modulus-reduction curve.
//!
//! The formulas are those of parallel elastic–perfectly plastic components (Iwan 1967, J. Appl. Mech. 34, 612–617;
//! Besseling 1958, J. Appl. Mech. 25, 529–536). Symbols:
//!
//! | symbol | quantity |
//! |---|---|
//! | (γ_j, τ_j), k_j | points of the backbone in simple shear, and the slopes up to them |
//! | G_j = k_j − k_{j+1} | shear modulus of component j |
//! | r_j = √2 G_j γ_j | radius of its yield surface \|s_j\| = √(s_j : s_j) |
//! | e, e_j | deviator of the strain, and the deviator at which component j has no stress |
//! | s_j = q 2 G_j (e − e_j) | its stress, q = min(1, r_j/\|2 G_j (e − e_j)\|) (radial return) |

use super::iwan_backbone::{Component, backbone_components, hyperbolic_points, virgin_strain_norm};
use super::tensor::{
    Deviator, check_strain, components, contraction, difference, isotropic_matrix, scaled,
    shear_strain, strain_deviator, stress_deviator, stress_of, trace,
};
use super::{SolidMaterial, SolidState, StrainPath};
use crate::error::{Result, all_finite, finite, not_negative, require, same_length};
use crate::fem::internal_energy::InternalEnergy;

/// Clay without drainage: yields in shear alone, along any concave backbone.
///
/// Elastic–perfectly plastic components act in parallel (Iwan 1967, Besseling 1958), so that the stress in simple shear
/// follows the backbone, and unloads and reloads by Masing's rules. The strength is the stress of the last point; it
/// does not depend on the mean stress, which stays elastic. The table of laws in [`SolidMaterial`] has the formulas.
///
/// An **initial stress** loads the components as shear from zero to this stress would: in proportion to their shear
/// moduli until they yield. The strength is still that of the backbone.
///
/// The internal variables are the initial stress with its stored energy, the energy dissipated so far, and, for each
/// component, the strain at which the component has no stress.
///
/// ```
/// use basemat::fem::{Iwan, SolidMaterial};
///
/// // 45.6 MPa, a strength of 40 kPa that is reached at 17.5 % of strain.
/// let clay = Iwan::hyperbolic(45.6e6, 40.0e3, 0.175, 0.49, 1900.0)?;
/// let mut variables = vec![0.0; clay.variable_count()];
/// clay.initialize([0.0; 4], &mut variables)?;
///
/// let sheared = [0.0, 0.0, 0.0, 0.2];
/// assert!((clay.stress(sheared, &variables)?[3] - 40.0e3).abs() < 1e-6);
/// clay.commit(sheared, &mut variables);
/// // Unloading by 2 · 10⁻⁵ is elastic: 912 Pa.
/// let unloaded = [0.0, 0.0, 0.0, 0.2 - 2.0e-5];
/// assert!((clay.stress(unloaded, &variables)?[3] - 39_088.0).abs() < 1e-6);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "IwanForm"))]
pub struct Iwan {
    points: Vec<[f64; 2]>,
    poisson: f64,
    density: f64,
    #[cfg_attr(feature = "serde", serde(skip))]
    shear_modulus: f64,
    #[cfg_attr(feature = "serde", serde(skip))]
    bulk_modulus: f64,
    #[cfg_attr(feature = "serde", serde(skip))]
    components: Vec<Component>,
}

validated! {
    Iwan as IwanForm { points: Vec<[f64; 2]>, poisson: f64, density: f64 }
    => Iwan::new(&points, poisson, density)
}

/// Number of internal variables before those of the components.
const COMMON_VARIABLE_COUNT: usize = 6;
/// Number of internal variables of a component.
const COMPONENT_VARIABLE_COUNT: usize = 3;

/// Relative excess over the strength that rounding leaves in an initial stress on the yield surface.
const INITIAL_STRESS_ROUNDING: f64 = 1e-9;

/// Internal variables of a point.
struct IwanVariables<'a> {
    /// Deviator of the initial stress, Pa.
    rest_deviator: Deviator,
    /// Mean of the initial stress, Pa.
    rest_mean_stress: f64,
    /// Energy stored under the initial stress, J/m³.
    rest_energy: f64,
    /// Energy dissipated since the initial state, J/m³.
    dissipated_energy: f64,
    /// Strain deviators at which the components have no stress.
    stress_free_strains: &'a [Deviator],
}

impl Iwan {
    /// Soil from `[γ, τ]` of its backbone, Poisson's ratio and density.
    ///
    /// `points`: shear strain γ (engineering, 0.01 is 1 %) and shear stress τ (Pa) in simple shear, without the origin.
    /// The backbone is straight between points and constant beyond the last one. `poisson`: Poisson's ratio ν of small
    /// strains; the bulk modulus is K = 2 G (1 + ν)/(3 (1 − 2ν)) with G = τ/γ of the first point. `density`: kg/m³; 0
    /// is allowed.
    ///
    /// ```
    /// use basemat::fem::Iwan;
    ///
    /// let clay = Iwan::new(&[[0.001, 20.0e3], [0.01, 50.0e3]], 0.45, 1800.0)?;
    /// assert_eq!((clay.shear_modulus(), clay.strength()), (20.0e6, 50.0e3));
    /// let convex = Iwan::new(&[[0.001, 20.0e3], [0.002, 50.0e3]], 0.45, 1800.0).unwrap_err();
    /// assert_eq!(
    ///     convex.to_string(),
    ///     "point 2 of the backbone: slope up to the point (Pa) is 30000000, but must be at most the slope before it \
    ///      (the backbone must be concave)"
    /// );
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) without points. [`Error::Item`](crate::Error::Item) with the number of the
    /// point unless strains ascend from above zero, stresses are above zero and do not descend, and the backbone is
    /// concave. [`Error::Input`](crate::Error::Input) unless −1 < ν < 0.5 and the density is not negative. All must be
    /// finite.
    pub fn new(points: &[[f64; 2]], poisson: f64, density: f64) -> Result<Self> {
        let components = backbone_components(points)?;
        let shear_modulus = points[0][1] / points[0][0];
        let is_in_range = poisson > -1.0 && poisson < 0.5;
        require("Poisson's ratio of the soil", poisson, is_in_range, "above -1 and below 0.5")?;
        not_negative("density of the soil", density)?;
        let bulk_modulus = 2.0 * shear_modulus * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson));
        finite("bulk modulus of the soil", bulk_modulus)?;
        let points = points.to_vec();
        Ok(Self { points, poisson, density, shear_modulus, bulk_modulus, components })
    }

    /// Soil with a hyperbolic backbone from shear modulus and strength.
    ///
    /// `shear_modulus`: G of small strains, Pa. `strength`: τ_s, Pa. `limit_strain`: γ_n at which the strength is
    /// reached; 200 τ_s/G is usual. `poisson` and `density` (kg/m³) are those of [`Iwan::new`]. The backbone is τ = G
    /// γ/(1 + G γ/τ_m) with 1/τ_m = 1/τ_s − 1/(γ_n G), at 12 strains in a geometric series from 0.02 τ_s/G to γ_n. Up
    /// to the first of them it is straight with the slope G.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless G and τ_s are positive and γ_n ≥ 5 τ_s/G, and those of
    /// [`Iwan::new`].
    pub fn hyperbolic(
        shear_modulus: f64,
        strength: f64,
        limit_strain: f64,
        poisson: f64,
        density: f64,
    ) -> Result<Self> {
        Self::new(&hyperbolic_points(shear_modulus, strength, limit_strain)?, poisson, density)
    }

    /// Points `[γ, τ]` of the backbone, with τ in Pa.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Shear modulus G of small strains, Pa.
    pub fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    /// Bulk modulus K, Pa.
    pub fn bulk_modulus(&self) -> f64 {
        self.bulk_modulus
    }

    /// Shear strength, Pa: the stress of the last point.
    pub fn strength(&self) -> f64 {
        self.points.last().map_or(0.0, |point| point[1])
    }

    /// Radius √2 τ_n of the surface that bounds all deviators of the stress, Pa.
    fn strength_radius(&self) -> f64 {
        std::f64::consts::SQRT_2 * self.strength()
    }

    /// Returns an error for a strain that is not finite, or too large for yield functions.
    fn check_strain(&self, strain: [f64; 4]) -> Result<()> {
        check_strain(strain, self.shear_modulus.max(self.bulk_modulus))
    }

    /// Internal variables of a point, as named fields.
    fn read<'a>(&self, variables: &'a [f64]) -> Result<IwanVariables<'a>> {
        let quantity = "internal variables of Iwan's model";
        same_length(quantity, variables.len(), self.variable_count())?;
        Ok(IwanVariables {
            rest_deviator: [variables[0], variables[1], variables[2]],
            rest_mean_stress: variables[3],
            rest_energy: variables[4],
            dissipated_energy: variables[5],
            stress_free_strains: variables[COMMON_VARIABLE_COUNT..].as_chunks().0,
        })
    }

    /// Deviator of the stress at a deviator of the strain.
    fn stress_deviator(
        &self,
        strain_deviator: Deviator,
        variables: &IwanVariables<'_>,
    ) -> Deviator {
        let mut stress = [0.0; 3];
        for (component, &stress_free_strain) in
            self.components.iter().zip(variables.stress_free_strains)
        {
            let component_stress = component.stress(strain_deviator, stress_free_strain);
            for (sum, addend) in stress.iter_mut().zip(component_stress) {
                *sum += addend;
            }
        }
        stress
    }
}

/// Parallel elastic–perfectly plastic components.
impl SolidMaterial for Iwan {
    fn density(&self) -> f64 {
        self.density
    }

    fn elasticity(&self) -> [[f64; 4]; 4] {
        isotropic_matrix(2.0 * self.shear_modulus, self.bulk_modulus)
    }

    fn variable_count(&self) -> usize {
        COMMON_VARIABLE_COUNT + COMPONENT_VARIABLE_COUNT * self.components.len()
    }

    /// # Errors
    /// [`Error::Item`](crate::Error::Item) with the strength for a stress with √J₂ above the strength; under principal
    /// stresses σ_v and σ_h = K₀ σ_v, √J₂ is |σ_v − σ_h|/√3. [`Error::NotFinite`](crate::Error::NotFinite) for a stress
    /// that is not finite, and [`Error::Size`](crate::Error::Size) for another number of variables.
    fn initialize(&self, initial_stress: [f64; 4], variables: &mut [f64]) -> Result<()> {
        self.read(variables)?;
        all_finite("initial stress of Iwan's model", &initial_stress)?;
        let deviator = stress_deviator(initial_stress);
        let norm = contraction(deviator, deviator).sqrt();
        let strength_radius = self.strength_radius();
        require(
            "shear stress √J₂ of the initial stress (Pa)",
            norm * std::f64::consts::FRAC_1_SQRT_2,
            norm <= strength_radius * (1.0 + INITIAL_STRESS_ROUNDING),
            "at most this strength",
        )
        .map_err(|fault| fault.within(format!("soil with a strength of {} Pa", self.strength())))?;
        let direction = if norm > 0.0 { scaled(deviator, 1.0 / norm) } else { deviator };
        let strain_norm = virgin_strain_norm(&self.components, norm.min(strength_radius));
        let mean_stress = trace(initial_stress) / 3.0;
        let mut rest_energy = 0.5 * mean_stress * mean_stress / self.bulk_modulus;
        let (common_variables, component_variables) = variables.split_at_mut(COMMON_VARIABLE_COUNT);
        let stress_free_strains = component_variables.as_chunks_mut().0;
        for (component, stress_free_strain) in self.components.iter().zip(stress_free_strains) {
            let elastic_norm = strain_norm.min(component.yield_strain_norm());
            rest_energy += component.shear_modulus * elastic_norm * elastic_norm;
            *stress_free_strain = scaled(direction, -elastic_norm);
        }
        common_variables[..3].copy_from_slice(&deviator);
        common_variables[3] = mean_stress;
        common_variables[4] = rest_energy;
        common_variables[5] = 0.0;
        Ok(())
    }

    fn stress(&self, strain: [f64; 4], variables: &[f64]) -> Result<[f64; 4]> {
        let variables = self.read(variables)?;
        self.check_strain(strain)?;
        let deviator = self.stress_deviator(strain_deviator(strain), &variables);
        let mean_stress = variables.rest_mean_stress + self.bulk_modulus * trace(strain);
        let stress = stress_of(deviator, mean_stress);
        all_finite("stress of Iwan's model", &stress)?;
        Ok(stress)
    }

    /// Sum of the components' tangents, and of the volumetric one.
    ///
    /// Where a component yields it has 2 G_j q (I_dev − n⊗n) with n = s_j/|s_j|, elsewhere 2 G_j I_dev.
    fn tangent(&self, strain: [f64; 4], variables: &[f64]) -> Result<[[f64; 4]; 4]> {
        let variables = self.read(variables)?;
        self.check_strain(strain)?;
        let strain_deviator = strain_deviator(strain);
        let mut isotropic_factor = 0.0;
        // Σ 2 G_j q n⊗n without the rows and columns zz, which follow because n is a deviator.
        let mut dyads = [[0.0; 3]; 3];
        for (component, &stress_free_strain) in
            self.components.iter().zip(variables.stress_free_strains)
        {
            let trial = component.trial_stress(strain_deviator, stress_free_strain);
            let squared_norm = contraction(trial, trial);
            let modulus = 2.0 * component.shear_modulus * component.return_factor(squared_norm);
            isotropic_factor += modulus;
            if component.yields(squared_norm) {
                let dyad_factor = modulus / squared_norm;
                for i in 0..3 {
                    for j in 0..3 {
                        dyads[i][j] += dyad_factor * trial[i] * trial[j];
                    }
                }
            }
        }
        let mut tangent = isotropic_matrix(isotropic_factor, self.bulk_modulus);
        subtract_dyads(dyads, &mut tangent);
        Ok(tangent)
    }

    fn energy(&self, strain: [f64; 4], variables: &[f64]) -> Result<InternalEnergy> {
        let variables = self.read(variables)?;
        self.check_strain(strain)?;
        let strain_deviator = strain_deviator(strain);
        let mean_stress = variables.rest_mean_stress + self.bulk_modulus * trace(strain);
        let mut stored = 0.5 * mean_stress * mean_stress / self.bulk_modulus;
        let mut dissipated = variables.dissipated_energy;
        for (component, &stress_free_strain) in
            self.components.iter().zip(variables.stress_free_strains)
        {
            let trial = component.trial_stress(strain_deviator, stress_free_strain);
            let squared_norm = contraction(trial, trial);
            let factor = component.return_factor(squared_norm);
            stored += 0.25 * factor * factor * squared_norm / component.shear_modulus;
            dissipated += component.dissipation(squared_norm);
        }
        stored -= variables.rest_energy;
        all_finite("energies of Iwan's model", &[stored, dissipated])?;
        Ok(InternalEnergy { stored, dissipated })
    }

    /// Σ [(s_m − s_1) : Δe + |Δs|²/(4 G_j)] over the components.
    ///
    /// There is also a term of the mean stress if `midstep` is not the middle of `start` and `end`.
    fn remainder(&self, path: &StrainPath, variables: &[f64]) -> Result<f64> {
        let variables = self.read(variables)?;
        for strain in [path.start, path.midstep, path.end] {
            self.check_strain(strain)?;
        }
        let start_trace = trace(path.start);
        let end_trace = trace(path.end);
        let midstep_offset = trace(path.midstep) - 0.5 * (start_trace + end_trace);
        let mut remainder = self.bulk_modulus * (end_trace - start_trace) * midstep_offset;
        let start = strain_deviator(path.start);
        let midstep = strain_deviator(path.midstep);
        let end = strain_deviator(path.end);
        let strain_increment = difference(end, start);
        for (component, &stress_free_strain) in
            self.components.iter().zip(variables.stress_free_strains)
        {
            let start_stress = component.stress(start, stress_free_strain);
            let midstep_stress = component.stress(midstep, stress_free_strain);
            let end_stress = component.stress(end, stress_free_strain);
            let stress_increment = difference(end_stress, start_stress);
            remainder += contraction(difference(midstep_stress, end_stress), strain_increment)
                + 0.25 * contraction(stress_increment, stress_increment) / component.shear_modulus;
        }
        finite("mid-step remainder of Iwan's model", remainder)
    }

    fn commit(&self, strain: [f64; 4], variables: &mut [f64]) {
        if variables.len() != self.variable_count() || self.check_strain(strain).is_err() {
            return;
        }
        let strain_deviator = strain_deviator(strain);
        let (common_variables, component_variables) = variables.split_at_mut(COMMON_VARIABLE_COUNT);
        let stress_free_strains = component_variables.as_chunks_mut().0;
        for (component, stress_free_strain) in self.components.iter().zip(stress_free_strains) {
            let trial = component.trial_stress(strain_deviator, *stress_free_strain);
            let squared_norm = contraction(trial, trial);
            if component.yields(squared_norm) {
                common_variables[5] += component.dissipation(squared_norm);
                let elastic_factor =
                    0.5 * component.return_factor(squared_norm) / component.shear_modulus;
                *stress_free_strain = difference(strain_deviator, scaled(trial, elastic_factor));
            }
        }
    }

    /// The plastic strain is the part of the strain deviator that stays when all stress unloads with G.
    ///
    /// It is Σ G_j e_j^p/G with the plastic strain e_j^p of each component since the initial state. The mobilised
    /// strength is |s|/(√2 τ_n).
    fn state(&self, strain: [f64; 4], variables: &[f64]) -> SolidState {
        let Ok(variables) = self.read(variables) else { return SolidState::default() };
        let strain_deviator = strain_deviator(strain);
        let stress = self.stress_deviator(strain_deviator, &variables);
        let stress_change = difference(stress, variables.rest_deviator);
        let elastic_strain = scaled(stress_change, 0.5 / self.shear_modulus);
        let mobilised_strength = contraction(stress, stress).sqrt() / self.strength_radius();
        SolidState {
            plastic_strain: shear_strain(difference(strain_deviator, elastic_strain)),
            mobilised_strength: mobilised_strength.min(1.0),
        }
    }
}

/// Subtracts dyads n⊗n of deviators from a tangent; `dyads` has the rows and columns xx, yy and xy.
fn subtract_dyads(dyads: [Deviator; 3], tangent: &mut [[f64; 4]; 4]) {
    let rows = dyads.map(components);
    for j in 0..4 {
        let column = components([rows[0][j], rows[1][j], rows[2][j]]);
        for i in 0..4 {
            tangent[i][j] -= column[i];
        }
    }
}
