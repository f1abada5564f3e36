//! Drucker–Prager's cone, and the return of elastic trial stresses to it.
//!
//! Elastic–perfectly plastic with a cone as yield surface (Drucker & Prager 1952, Q. Appl. Math. 10, 157–165), matched
//! to Mohr–Coulomb's law in plane strain. Symbols:
//!
//! | symbol | quantity |
//! |---|---|
//! | s, I₁, √J₂ = \|s\|/√2 | deviator of the stress, sum of its normal components, shear stress |
//! | f = √J₂ + α I₁ − k | yield function |
//! | g = √J₂ + β I₁ | potential of the plastic strain, Δε^p = Δλ ∂g/∂σ |
//! | A = G + 9 K α β | f/Δλ of the backward Euler scheme |

use std::f64::consts::SQRT_2;

use super::tensor::{
    Deviator, components, contraction, difference, isotropic_matrix, scaled, stress_deviator,
    stress_of, trace,
};

/// Yield surface, plastic potential and elasticity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cone {
    /// Shear modulus G, Pa.
    pub(super) g: f64,
    /// Bulk modulus K, Pa.
    pub(super) k: f64,
    /// Slope α of the cone.
    pub(super) alpha: f64,
    /// Slope β of the plastic potential.
    pub(super) beta: f64,
    /// √J₂ on the cone at I₁ = 0, Pa (k in the formulas).
    pub(super) shear_at_zero_pressure: f64,
}

/// Stress in its deviator and I₁, Pa.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stress {
    pub(super) deviator: Deviator,
    pub(super) first_invariant: f64,
}

/// Part of the cone to which an elastic trial stress returns.
#[derive(Debug, Clone, Copy)]
pub(super) enum ConeReturn {
    /// The trial stress is within the cone.
    Elastic,
    /// Surface of the cone.
    Surface {
        /// Plastic multiplier Δλ.
        multiplier: f64,
        /// The stress on the cone.
        stress: Stress,
    },
    /// Tip of the cone.
    Apex {
        /// I₁ at the tip, Pa.
        first_invariant: f64,
    },
}

impl Stress {
    pub(super) fn of(stress: [f64; 4]) -> Self {
        Self { deviator: stress_deviator(stress), first_invariant: trace(stress) }
    }

    /// Shear stress √J₂, Pa.
    pub(super) fn shear(self) -> f64 {
        (0.5 * contraction(self.deviator, self.deviator)).sqrt()
    }

    pub(super) fn components(self) -> [f64; 4] {
        stress_of(self.deviator, self.first_invariant / 3.0)
    }

    pub(super) fn change_from(self, start: Self) -> Self {
        Self {
            deviator: difference(self.deviator, start.deviator),
            first_invariant: self.first_invariant - start.first_invariant,
        }
    }
}

impl ConeReturn {
    /// Stress after the return of a trial stress.
    pub(super) fn stress(self, trial: Stress) -> Stress {
        match self {
            Self::Elastic => trial,
            Self::Surface { stress, .. } => stress,
            Self::Apex { first_invariant } => Stress { deviator: [0.0; 3], first_invariant },
        }
    }
}

impl Cone {
    /// Largest √J₂ at a sum I₁ of normal stresses, Pa.
    ///
    /// It is below zero beyond the tip of the cone.
    pub(super) fn shear_strength(&self, first_invariant: f64) -> f64 {
        self.shear_at_zero_pressure - self.alpha * first_invariant
    }

    /// f/Δλ of the backward Euler scheme, Pa.
    fn consistency_modulus(&self) -> f64 {
        self.g + 9.0 * self.k * self.alpha * self.beta
    }

    /// Return of an elastic trial stress by the backward Euler scheme.
    pub(super) fn returned(&self, trial: Stress) -> ConeReturn {
        let trial_shear = trial.shear();
        let yield_function = trial_shear - self.shear_strength(trial.first_invariant);
        if yield_function <= 0.0 || yield_function.is_nan() {
            return ConeReturn::Elastic;
        }
        let multiplier = yield_function / self.consistency_modulus();
        let shear = trial_shear - self.g * multiplier;
        if shear < 0.0 {
            // Without friction f = √J₂ − k, and `shear` is k, above zero. This branch is therefore reached only for a
            // cone with a tip.
            return ConeReturn::Apex { first_invariant: self.shear_at_zero_pressure / self.alpha };
        }
        let stress = Stress {
            deviator: scaled(trial.deviator, shear / trial_shear),
            first_invariant: trial.first_invariant - 9.0 * self.k * self.beta * multiplier,
        };
        ConeReturn::Surface { multiplier, stress }
    }

    /// Tangent where a trial stress returns to the surface of the cone, Pa.
    ///
    /// With n = s/|s|, and q = 1 − G Δλ/√J₂ of the trial stress: 2 G q I_dev + 2 G² (Δλ/√J₂ − 1/A) n⊗n −
    /// 3 √2 G K (α n⊗1 + β 1⊗n)/A + K (1 − 9 K α β/A) 1⊗1.
    pub(super) fn surface_tangent(&self, trial: Stress, multiplier: f64) -> [[f64; 4]; 4] {
        let Self { g, k, alpha, beta, .. } = *self;
        let trial_shear = trial.shear();
        let consistency = self.consistency_modulus();
        let deviator_factor = 2.0 * g * (1.0 - g * multiplier / trial_shear);
        let volume_factor = k * (1.0 - 9.0 * k * alpha * beta / consistency);
        let dyad_factor = 2.0 * g * g * (multiplier / trial_shear - 1.0 / consistency);
        let coupling_factor = 3.0 * SQRT_2 * g * k / consistency;
        let direction = components(scaled(trial.deviator, 1.0 / (SQRT_2 * trial_shear)));
        let unit = [1.0, 1.0, 1.0, 0.0];
        let mut tangent = isotropic_matrix(deviator_factor, volume_factor);
        for i in 0..4 {
            for j in 0..4 {
                let coupling = alpha * direction[i] * unit[j] + beta * unit[i] * direction[j];
                tangent[i][j] +=
                    dyad_factor * direction[i] * direction[j] - coupling_factor * coupling;
            }
        }
        tangent
    }

    /// Energy σ : Δε^p that the return of a trial stress dissipates, J/m³.
    ///
    /// On the cone σ : Δε^p = Δλ (√J₂ + β I₁), and there √J₂ = k − α I₁. For 0 ≤ ψ ≤ φ it is below zero by rounding
    /// alone, which the maximum removes.
    pub(super) fn dissipation(&self, trial: Stress, cone_return: ConeReturn) -> f64 {
        let dissipation = match cone_return {
            ConeReturn::Elastic => 0.0,
            ConeReturn::Surface { multiplier, stress } => {
                let flow_slope = self.alpha - self.beta;
                multiplier * (self.shear_at_zero_pressure - flow_slope * stress.first_invariant)
            }
            ConeReturn::Apex { first_invariant } => {
                let volume_increment = (trial.first_invariant - first_invariant) / (3.0 * self.k);
                first_invariant / 3.0 * volume_increment
            }
        };
        dissipation.max(0.0)
    }

    /// Elastic energy of a stress, |s|²/(4 G) + I₁²/(18 K), J/m³.
    pub(super) fn elastic_energy(&self, stress: Stress) -> f64 {
        0.25 * contraction(stress.deviator, stress.deviator) / self.g
            + stress.first_invariant * stress.first_invariant / (18.0 * self.k)
    }

    /// Elastic strain of a stress, with the engineering shear strain.
    pub(super) fn elastic_strain(&self, stress: Stress) -> [f64; 4] {
        let deviator = scaled(stress.deviator, 0.5 / self.g);
        let [xx, yy, zz, xy] = stress_of(deviator, stress.first_invariant / (9.0 * self.k));
        [xx, yy, zz, 2.0 * xy]
    }
}

/// √(9 + 12 tan²) of an angle.
pub(super) fn cone_root(angle: f64) -> f64 {
    (9.0 + 12.0 * angle.tan().powi(2)).sqrt()
}

/// Slope of a cone that matches Mohr–Coulomb's law in plane strain, tan/√(9 + 12 tan²) of an angle.
pub(super) fn cone_slope(angle: f64) -> f64 {
    angle.tan() / cone_root(angle)
}
