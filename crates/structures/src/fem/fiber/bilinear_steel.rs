//! Steel with two straight branches and kinematic hardening.
//!
//! | symbol | meaning |
//! |---|---|
//! | E, b | Young's modulus; ratio of the hardening modulus to it |
//! | s | stress of the part (1 − b) E that yields: elastic and perfectly plastic, \|s\| ≤ (1 − b) f_y |
//! | ε^p | plastic strain of this part |

use super::{UniaxialMaterial, UniaxialResponse, check_variables};
use crate::error::{Result, positive, require};
use crate::fem::internal_energy::InternalEnergy;

/// Steel with two straight branches and kinematic hardening.
///
/// The stress is σ = b E ε + s, with s = (1 − b) E (ε − ε^p) and |s| ≤ (1 − b) f_y: OpenSees' `Steel01` without isotropic
/// hardening. The stored energy is ½ b E ε² + s²/(2 (1 − b) E), and the dissipation (1 − b) f_y |Δε^p| never negative.
///
/// ```
/// use basemat::fem::{BilinearSteel, UniaxialMaterial};
///
/// let steel = BilinearSteel::new(355.0e6, 210.0e9, 0.01)?;
/// let mut variables = vec![0.0; steel.variable_count()];
/// let yielded = steel.response(0.01, &variables)?.stress;
/// let hardening = 0.01 * 210.0e9 * (0.01 - 355.0 / 210.0e3);
/// assert!((yielded - 355.0e6 - hardening).abs() < 1.0);
/// // The elastic range is 2 f_y: unloading yields at the opposite stress less 2 f_y.
/// steel.commit(0.01, &mut variables);
/// let unloaded = steel.response(0.01 - 2.0 * 355.0 / 210.0e3, &variables)?.stress;
/// assert!((unloaded - (yielded - 710.0e6)).abs() < 1.0);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BilinearSteel {
    yield_stress: f64,
    modulus: f64,
    hardening_ratio: f64,
}

/// Returns an error unless yield stress and modulus are positive and the hardening ratio is from 0 to below 1.
pub(super) fn check_steel(yield_stress: f64, modulus: f64, hardening_ratio: f64) -> Result<()> {
    positive("yield stress of the steel", yield_stress)?;
    positive("Young's modulus of the steel", modulus)?;
    let is_ratio = (0.0..1.0).contains(&hardening_ratio);
    require("hardening ratio of the steel", hardening_ratio, is_ratio, "from 0 to below 1")
        .map(drop)
}

/// Part of the stress that yields, and its plastic strain.
struct YieldingPart {
    stress: f64,
    plastic_strain: f64,
    yields: bool,
}

impl BilinearSteel {
    /// Steel of a yield stress f_y (Pa), Young's modulus E (Pa) and hardening ratio b.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless yield stress and modulus are positive and 0 ≤ b < 1.
    pub fn new(yield_stress: f64, modulus: f64, hardening_ratio: f64) -> Result<Self> {
        check_steel(yield_stress, modulus, hardening_ratio)?;
        Ok(Self { yield_stress, modulus, hardening_ratio })
    }

    /// Modulus (1 − b) E of the part that yields, Pa.
    fn yielding_modulus(&self) -> f64 {
        (1.0 - self.hardening_ratio) * self.modulus
    }

    /// Largest stress (1 − b) f_y of the part that yields, Pa.
    fn max_yielding_stress(&self) -> f64 {
        (1.0 - self.hardening_ratio) * self.yield_stress
    }

    /// The part that yields at a strain, from the plastic strain of the last step.
    fn yielding_part(&self, strain: f64, plastic_strain: f64) -> YieldingPart {
        let modulus = self.yielding_modulus();
        let trial = modulus * (strain - plastic_strain);
        let stress = trial.clamp(-self.max_yielding_stress(), self.max_yielding_stress());
        let yields = stress != trial;
        let plastic_strain = if yields { strain - stress / modulus } else { plastic_strain };
        YieldingPart { stress, plastic_strain, yields }
    }
}

/// Variables: plastic strain, and dissipated energy (J/m³).
impl UniaxialMaterial for BilinearSteel {
    fn modulus(&self) -> f64 {
        self.modulus
    }

    fn variable_count(&self) -> usize {
        2
    }

    fn response(&self, strain: f64, variables: &[f64]) -> Result<UniaxialResponse> {
        check_variables(variables, self.variable_count())?;
        let part = self.yielding_part(strain, variables[0]);
        let hardening_modulus = self.hardening_ratio * self.modulus;
        Ok(UniaxialResponse {
            stress: hardening_modulus * strain + part.stress,
            tangent: if part.yields { hardening_modulus } else { self.modulus },
        })
    }

    fn energy(&self, strain: f64, variables: &[f64]) -> Result<InternalEnergy> {
        check_variables(variables, self.variable_count())?;
        let part = self.yielding_part(strain, variables[0]);
        let hardening_energy = 0.5 * self.hardening_ratio * self.modulus * strain * strain;
        let yielding_energy = 0.5 * part.stress * part.stress / self.yielding_modulus();
        Ok(InternalEnergy {
            stored: hardening_energy + yielding_energy,
            dissipated: variables[1] + part.stress * (part.plastic_strain - variables[0]),
        })
    }

    /// From s at the start, at mid-step and at the end: (s_m − s_1) Δε + Δs²/(2 (1 − b) E), and ½ b E Δε (2 ε_m − ε_0 − ε_1).
    fn remainder(&self, strains: [f64; 3], variables: &[f64]) -> Result<f64> {
        check_variables(variables, self.variable_count())?;
        let [start, midstep, end] = strains;
        let stresses = strains.map(|strain| self.yielding_part(strain, variables[0]).stress);
        let stress_change = stresses[2] - stresses[0];
        let yielding = (stresses[1] - stresses[2]) * (end - start)
            + 0.5 * stress_change * stress_change / self.yielding_modulus();
        let hardening_modulus = self.hardening_ratio * self.modulus;
        let hardening = 0.5 * hardening_modulus * (end - start) * (2.0 * midstep - start - end);
        Ok(yielding + hardening)
    }

    /// Changes nothing for a wrong number of variables.
    fn commit(&self, strain: f64, variables: &mut [f64]) {
        if variables.len() != self.variable_count() {
            return;
        }
        let part = self.yielding_part(strain, variables[0]);
        variables[1] += part.stress * (part.plastic_strain - variables[0]);
        variables[0] = part.plastic_strain;
    }
}
