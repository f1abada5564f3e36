//! Laws for tests: linear elastic as a user would write it, and plastic with isotropic hardening.

use super::internal_energy::InternalEnergy;
use super::material::Material;
use super::solid::{SolidMaterial, SolidState};
use crate::error::{Error, Result};

/// Linear elastic material whose `as_elastic` returns `None`, as the law of a user might.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HiddenElastic(pub(crate) Material);

impl SolidMaterial for HiddenElastic {
    fn density(&self) -> f64 {
        self.0.density()
    }

    fn elasticity(&self) -> [[f64; 4]; 4] {
        SolidMaterial::elasticity(&self.0)
    }

    fn initialize(&self, initial_stress: [f64; 4], variables: &mut [f64]) -> Result<()> {
        self.0.initialize(initial_stress, variables)
    }

    fn stress(&self, strain: [f64; 4], variables: &[f64]) -> Result<[f64; 4]> {
        self.0.stress(strain, variables)
    }

    fn tangent(&self, strain: [f64; 4], variables: &[f64]) -> Result<[[f64; 4]; 4]> {
        self.0.tangent(strain, variables)
    }

    fn energy(&self, strain: [f64; 4], variables: &[f64]) -> Result<InternalEnergy> {
        self.0.energy(strain, variables)
    }

    fn commit(&self, _strain: [f64; 4], _variables: &mut [f64]) {}
}

/// Von Mises plasticity with linear isotropic hardening (Simo & Hughes 1998, box 3.1).
///
/// Variables: plastic strain (0 to 3), plastic arc length (4), dissipated energy (5), initial stress (6 to 9).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hardening {
    /// Shear modulus, Pa.
    pub(crate) shear_modulus: f64,
    /// Bulk modulus, Pa.
    pub(crate) bulk_modulus: f64,
    /// Norm of the deviator at first yield, Pa.
    pub(crate) strength: f64,
    /// Growth of the yield surface's radius with the plastic arc length, Pa.
    pub(crate) plastic_modulus: f64,
}

impl Hardening {
    pub(crate) const FIRM_SOIL: Self = Self {
        shear_modulus: 10.0e6,
        bulk_modulus: 30.0e6,
        strength: 20.0e3,
        plastic_modulus: 1.0e6,
    };
}

/// State after the return to the yield surface.
struct ReturnMapping {
    stress: [f64; 4],
    deviator: [f64; 4],
    trial_norm: f64,
    /// Increment of the plastic arc length.
    increment: f64,
    /// Unit tensor of the flow.
    flow: [f64; 4],
}

fn tensor_norm(tensor: [f64; 4]) -> f64 {
    let [xx, yy, zz, xy] = tensor;
    (xx * xx + yy * yy + zz * zz + 2.0 * xy * xy).sqrt()
}

impl Hardening {
    fn return_to_yield_surface(&self, strain: [f64; 4], variables: &[f64]) -> ReturnMapping {
        let dilatation = strain[0] + strain[1] + strain[2];
        let initial_pressure = (variables[6] + variables[7] + variables[8]) / 3.0;
        let mut trial = [0.0; 4];
        for i in 0..3 {
            let deviator = strain[i] - dilatation / 3.0 - variables[i];
            trial[i] = 2.0 * self.shear_modulus * deviator + variables[6 + i] - initial_pressure;
        }
        trial[3] = self.shear_modulus * (strain[3] - variables[3]) + variables[9];
        let trial_norm = tensor_norm(trial);
        let yield_radius = self.strength + self.plastic_modulus * variables[4];
        let increment = ((trial_norm - yield_radius)
            / (2.0 * self.shear_modulus + self.plastic_modulus))
            .max(0.0);
        let flow = trial.map(|s| if trial_norm > 0.0 { s / trial_norm } else { 0.0 });
        let deviator: [f64; 4] =
            std::array::from_fn(|i| trial[i] - 2.0 * self.shear_modulus * increment * flow[i]);
        let mut stress = deviator;
        for entry in &mut stress[..3] {
            *entry += self.bulk_modulus * dilatation + initial_pressure;
        }
        ReturnMapping { stress, deviator, trial_norm, increment, flow }
    }
}

impl SolidMaterial for Hardening {
    fn density(&self) -> f64 {
        1900.0
    }

    fn elasticity(&self) -> [[f64; 4]; 4] {
        let mut elasticity = [[0.0; 4]; 4];
        for i in 0..3 {
            for j in 0..3 {
                let diagonal = if i == j { 2.0 * self.shear_modulus } else { 0.0 };
                elasticity[i][j] = self.bulk_modulus - 2.0 * self.shear_modulus / 3.0 + diagonal;
            }
        }
        elasticity[3][3] = self.shear_modulus;
        elasticity
    }

    fn variable_count(&self) -> usize {
        10
    }

    fn initialize(&self, initial_stress: [f64; 4], variables: &mut [f64]) -> Result<()> {
        variables.fill(0.0);
        variables[6..].copy_from_slice(&initial_stress);
        if self.return_to_yield_surface([0.0; 4], variables).increment > 0.0 {
            return Err(Error::part("initial stress", "it is outside of the yield surface"));
        }
        Ok(())
    }

    fn stress(&self, strain: [f64; 4], variables: &[f64]) -> Result<[f64; 4]> {
        Ok(self.return_to_yield_surface(strain, variables).stress)
    }

    fn tangent(&self, strain: [f64; 4], variables: &[f64]) -> Result<[[f64; 4]; 4]> {
        let ReturnMapping { trial_norm, increment, flow, .. } =
            self.return_to_yield_surface(strain, variables);
        let mut tangent = self.elasticity();
        if increment == 0.0 {
            return Ok(tangent);
        }
        let shear_modulus = self.shear_modulus;
        let stress_reduction = 2.0 * shear_modulus * increment / trial_norm;
        let normal_factor =
            2.0 * shear_modulus / (2.0 * shear_modulus + self.plastic_modulus) - stress_reduction;
        for i in 0..4 {
            for j in 0..4 {
                let deviatoric_projection = match (i == j, i < 3 && j < 3) {
                    (true, true) => 1.0 - 1.0 / 3.0,
                    (false, true) => -1.0 / 3.0,
                    (true, false) => 0.5,
                    (false, false) => 0.0,
                };
                tangent[i][j] -= 2.0
                    * shear_modulus
                    * (stress_reduction * deviatoric_projection
                        + normal_factor * flow[i] * flow[j]);
            }
        }
        Ok(tangent)
    }

    fn energy(&self, strain: [f64; 4], variables: &[f64]) -> Result<InternalEnergy> {
        let ReturnMapping { stress, deviator, increment, .. } =
            self.return_to_yield_surface(strain, variables);
        let pressure = (stress[0] + stress[1] + stress[2]) / 3.0;
        let arc_length = variables[4] + increment;
        let hardening_energy = 0.5 * self.plastic_modulus * arc_length * arc_length;
        Ok(InternalEnergy {
            stored: tensor_norm(deviator).powi(2) / (4.0 * self.shear_modulus)
                + 0.5 * pressure * pressure / self.bulk_modulus
                + hardening_energy,
            dissipated: variables[5] + self.strength * increment,
        })
    }

    fn commit(&self, strain: [f64; 4], variables: &mut [f64]) {
        let dissipated_energy =
            self.energy(strain, variables).map_or(f64::NAN, |energy| energy.dissipated);
        let ReturnMapping { increment, flow, .. } = self.return_to_yield_surface(strain, variables);
        for (i, direction) in flow.iter().enumerate() {
            variables[i] += if i < 3 { 1.0 } else { 2.0 } * increment * direction;
        }
        variables[4] += increment;
        variables[5] = dissipated_energy;
    }

    fn state(&self, strain: [f64; 4], variables: &[f64]) -> SolidState {
        let ReturnMapping { deviator, increment, .. } =
            self.return_to_yield_surface(strain, variables);
        let yield_radius = self.strength + self.plastic_modulus * (variables[4] + increment);
        SolidState {
            plastic_strain: 2.0_f64.sqrt() * (variables[4] + increment),
            mobilised_strength: tensor_norm(deviator) / yield_radius,
        }
    }
}
