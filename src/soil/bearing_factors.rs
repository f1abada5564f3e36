//! Bearing capacity factors (EN 1997-1:2004, Annex D).

use std::f64::consts::PI;

use super::SoilStrength;
use crate::error::{Result, finite};

/// N_c of undrained soil (Prandtl 1920).
pub(super) const UNDRAINED_COHESION_FACTOR: f64 = PI + 2.0;

/// Bearing capacity factors N of drained soil under a rough strip.
///
/// ```
/// use basemat::soil::BearingFactors;
/// let factors = BearingFactors::new(30.0_f64.to_radians())?;
/// assert!((factors.surcharge - 18.40).abs() < 5e-3);
/// assert!((factors.cohesion - 30.14).abs() < 5e-3);
/// assert!((factors.unit_weight - 20.09).abs() < 5e-3);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct BearingFactors {
    /// N_c = (N_q − 1) cot φ, of the cohesion; π + 2 without friction.
    pub cohesion: f64,
    /// N_q = e^(π tan φ) tan²(π/4 + φ/2), of the pressure beside the base (Prandtl 1920, Reissner 1924).
    pub surcharge: f64,
    /// N_γ = 2 (N_q − 1) tan φ, of the weight of the soil below the base.
    pub unit_weight: f64,
}

impl BearingFactors {
    /// Factors for a friction angle (rad), by EN 1997-1:2004, D.4.
    ///
    /// N_γ holds for a rough base, whose friction angle is at least φ/2.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for an angle below zero or not below π/2, and for an angle so close to π/2
    /// that a factor overflows.
    pub fn new(friction_angle: f64) -> Result<Self> {
        // The constructor of the strength checks the angle.
        Self::of(&SoilStrength::new(friction_angle)?)
    }

    /// Factors for the friction angle of `strength`.
    pub(super) fn of(strength: &SoilStrength) -> Result<Self> {
        let tan_phi = strength.friction_angle().tan();
        // ln tan(π/4 + φ/2) = asinh(tan φ): no digits are lost in N_q − 1 at small angles.
        let surcharge_minus_one = (PI * tan_phi + 2.0 * tan_phi.asinh()).exp_m1();
        let cohesion =
            if tan_phi > 0.0 { surcharge_minus_one / tan_phi } else { UNDRAINED_COHESION_FACTOR };
        let unit_weight = 2.0 * surcharge_minus_one * tan_phi;
        finite("bearing capacity factor of the unit weight", unit_weight)?;
        Ok(Self { cohesion, surcharge: 1.0 + surcharge_minus_one, unit_weight })
    }
}
