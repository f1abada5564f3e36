//! Concrete without tension: a parabola, a line, and straight unloading.

use super::{UniaxialMaterial, UniaxialResponse, check_variables};
use crate::error::{Result, not_negative, positive, require};
use crate::fem::internal_energy::InternalEnergy;

/// Concrete without tensile strength (Kent and Park 1971; unloading by Scott, Park and Priestley 1982).
///
/// In compression the stress follows a parabola to the strength f_c at the strain ε_c0, a straight line to the stress f_cu
/// at ε_cu, and is constant beyond. Unloading and reloading follow one straight line to a residual strain; beyond it a
/// crack is open and the stress is zero. The law is that of OpenSees' `Concrete01`; its residual strain falls by 0.006 ε_c0
/// where the largest compression passes 2 ε_c0, and the dissipated energy with it. The branch behind the strength softens,
/// so that strains localise at one integration point of a beam: results there depend on the lengths of the elements.
///
/// ```
/// use basemat::fem::{Concrete, UniaxialMaterial};
///
/// let concrete = Concrete::new(30.0e6, 0.002, 6.0e6, 0.006)?;
/// let mut variables = vec![0.0; concrete.variable_count()];
/// assert!((concrete.response(-0.001, &variables)?.stress + 22.5e6).abs() < 1.0);
/// assert!((concrete.response(-0.004, &variables)?.stress + 18.0e6).abs() < 1.0);
/// concrete.commit(-0.002, &mut variables);
/// // The residual strain is 0.145 + 0.13 of that at the strength.
/// assert_eq!(concrete.response(-0.275 * 0.002 + 1e-9, &variables)?.stress, 0.0);
/// assert!(concrete.response(-0.275 * 0.002 - 1e-6, &variables)?.stress < 0.0);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Concrete {
    strength: f64,
    strength_strain: f64,
    ultimate_stress: f64,
    ultimate_strain: f64,
}

/// Straight line along which a fibre unloads.
struct Unloading {
    /// Compressive strain at which the stress is zero.
    residual_strain: f64,
    slope: f64,
}

impl Concrete {
    /// Concrete by strength f_c (Pa) and its strain ε_c0, and ultimate stress f_cu (Pa) and its strain ε_cu.
    ///
    /// All four are magnitudes of compression, without sign.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless strength and its strain are positive, 0 ≤ f_cu ≤ f_c and ε_cu > ε_c0.
    pub fn new(
        strength: f64,
        strength_strain: f64,
        ultimate_stress: f64,
        ultimate_strain: f64,
    ) -> Result<Self> {
        positive("strength of the concrete", strength)?;
        positive("strain of the concrete at its strength", strength_strain)?;
        not_negative("ultimate stress of the concrete", ultimate_stress)?;
        let quantity = "ultimate stress of the concrete";
        require(quantity, ultimate_stress, ultimate_stress <= strength, "at most the strength")?;
        let is_beyond = ultimate_strain > strength_strain && ultimate_strain.is_finite();
        let needed = "finite, above the strain at the strength";
        require("ultimate strain of the concrete", ultimate_strain, is_beyond, needed)?;
        Ok(Self { strength, strength_strain, ultimate_stress, ultimate_strain })
    }

    /// Modulus 2 f_c/ε_c0 at the start of the parabola, Pa.
    fn initial_modulus(&self) -> f64 {
        2.0 * self.strength / self.strength_strain
    }

    /// Slope of the softening line, Pa, positive.
    fn softening_slope(&self) -> f64 {
        (self.strength - self.ultimate_stress) / (self.ultimate_strain - self.strength_strain)
    }

    /// Compressive stress of the envelope at a compressive strain, and its slope.
    fn envelope(&self, compression: f64) -> UniaxialResponse {
        if compression < self.strength_strain {
            let eta = compression / self.strength_strain;
            UniaxialResponse {
                stress: self.strength * (2.0 * eta - eta * eta),
                tangent: self.initial_modulus() * (1.0 - eta),
            }
        } else if compression < self.ultimate_strain {
            let slope = self.softening_slope();
            UniaxialResponse {
                stress: self.strength - slope * (compression - self.strength_strain),
                tangent: -slope,
            }
        } else {
            UniaxialResponse { stress: self.ultimate_stress, tangent: 0.0 }
        }
    }

    /// Work of the envelope's stress up to a compressive strain, J/m³.
    fn envelope_work(&self, compression: f64) -> f64 {
        let eta = (compression / self.strength_strain).min(1.0);
        let parabola = self.strength * self.strength_strain * eta * eta * (1.0 - eta / 3.0);
        let softened = (compression.min(self.ultimate_strain) - self.strength_strain).max(0.0);
        let line = softened * (self.strength - 0.5 * self.softening_slope() * softened);
        let constant = self.ultimate_stress * (compression - self.ultimate_strain).max(0.0);
        parabola + line + constant
    }

    /// Unloading from the largest compressive strain so far (Karsan and Jirsa's residual strains).
    fn unloading(&self, max_compression: f64) -> Unloading {
        let eta = max_compression.min(self.ultimate_strain) / self.strength_strain;
        let ratio =
            if eta < 2.0 { eta * (0.145 * eta + 0.13) } else { 0.707 * (eta - 2.0) + 0.834 };
        let stress = self.envelope(max_compression).stress;
        let length = max_compression - ratio * self.strength_strain;
        let elastic_length = stress / self.initial_modulus();
        // No unloading is steeper than the start of the parabola.
        if length <= elastic_length || length <= f64::EPSILON {
            let slope = self.initial_modulus();
            Unloading { residual_strain: max_compression - elastic_length, slope }
        } else {
            Unloading { residual_strain: max_compression - length, slope: stress / length }
        }
    }

    /// Overwrites the variables by their values at a largest compressive strain.
    fn write(&self, max_compression: f64, variables: &mut [f64]) {
        let Unloading { residual_strain, slope } = self.unloading(max_compression);
        let dissipated = self.dissipated(max_compression);
        let values = [max_compression, residual_strain, slope, dissipated];
        for (variable, value) in variables.iter_mut().zip(values) {
            *variable = value;
        }
    }

    /// Energy dissipated when the largest compressive strain was this, J/m³.
    fn dissipated(&self, max_compression: f64) -> f64 {
        let stress = self.envelope(max_compression).stress;
        let slope = self.unloading(max_compression).slope;
        let recovered = if slope > 0.0 { 0.5 * stress * stress / slope } else { 0.0 };
        self.envelope_work(max_compression) - recovered
    }
}

/// Variables: largest compressive strain so far; residual strain and slope of unloading from it; energy dissipated (J/m³).
impl UniaxialMaterial for Concrete {
    fn modulus(&self) -> f64 {
        self.initial_modulus()
    }

    fn variable_count(&self) -> usize {
        4
    }

    fn initialize(&self, variables: &mut [f64]) {
        self.write(0.0, variables);
    }

    fn response(&self, strain: f64, variables: &[f64]) -> Result<UniaxialResponse> {
        check_variables(variables, self.variable_count())?;
        let compression = -strain;
        if compression >= variables[0] {
            let envelope = self.envelope(compression);
            let stress = if compression > 0.0 { -envelope.stress } else { 0.0 };
            return Ok(UniaxialResponse { stress, tangent: envelope.tangent });
        }
        let residual_strain = variables[1];
        let slope = variables[2];
        if compression <= residual_strain {
            return Ok(UniaxialResponse::default());
        }
        Ok(UniaxialResponse { stress: -slope * (compression - residual_strain), tangent: slope })
    }

    fn energy(&self, strain: f64, variables: &[f64]) -> Result<InternalEnergy> {
        let stress = self.response(strain, variables)?.stress;
        let mut largest = [variables[0], variables[1], variables[2], variables[3]];
        if -strain > largest[0] {
            self.write(-strain, &mut largest);
        }
        let slope = largest[2];
        let dissipated = largest[3];
        let stored = if slope > 0.0 { 0.5 * stress * stress / slope } else { 0.0 };
        Ok(InternalEnergy { stored, dissipated })
    }

    /// Changes nothing for a wrong number of variables.
    fn commit(&self, strain: f64, variables: &mut [f64]) {
        if variables.len() == self.variable_count() && -strain > variables[0] {
            self.write(-strain, variables);
        }
    }
}
