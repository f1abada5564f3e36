//! Concrete without tension: a parabola, a line, and straight unloading.

#![allow(clippy::inline_always, reason = "the caller compiles them for its instruction set")]

use super::{MAX_BATCH_FIBERS, UniaxialMaterial, UniaxialResponse, check_variables, padded_count};
use crate::error::{Error, Result, not_negative, positive, require};
use crate::fem::internal_energy::InternalEnergy;
use crate::linalg::{Simd, WithSimd, vectorized};

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
    #[inline(always)]
    fn envelope(&self, compression: f64) -> UniaxialResponse {
        let eta = compression / self.strength_strain;
        let slope = self.softening_slope();
        // Without branches: compilers turn loops over fibres into vector instructions.
        let is_rising = compression < self.strength_strain;
        let is_softening = compression < self.ultimate_strain;
        let line = self.strength - slope * (compression - self.strength_strain);
        let behind_strength = if is_softening { line } else { self.ultimate_stress };
        let slope_behind = if is_softening { -slope } else { 0.0 };
        let parabola = self.strength * (2.0 * eta - eta * eta);
        let slope_before = self.initial_modulus() * (1.0 - eta);
        UniaxialResponse {
            stress: if is_rising { parabola } else { behind_strength },
            tangent: if is_rising { slope_before } else { slope_behind },
        }
    }

    /// Stress and tangent at a strain, after this unloading from the largest compressive strain.
    #[inline(always)]
    fn response_after(
        &self,
        strain: f64,
        max_compression: f64,
        unloading: &Unloading,
    ) -> UniaxialResponse {
        let compression = -strain;
        let envelope = self.envelope(compression);
        let is_envelope = compression >= max_compression;
        let envelope_stress = if compression > 0.0 { -envelope.stress } else { 0.0 };
        let is_open = compression <= unloading.residual_strain;
        let line = -unloading.slope * (compression - unloading.residual_strain);
        let unloaded_stress = if is_open { 0.0 } else { line };
        let unloaded_tangent = if is_open { 0.0 } else { unloading.slope };
        UniaxialResponse {
            stress: if is_envelope { envelope_stress } else { unloaded_stress },
            tangent: if is_envelope { envelope.tangent } else { unloaded_tangent },
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

    /// Energy at a strain with a stress, after the variables of the last step.
    #[inline]
    fn energy_with(
        &self,
        strain: f64,
        stress: f64,
        mut variables: [f64; VARIABLE_COUNT],
    ) -> InternalEnergy {
        if -strain > variables[0] {
            self.write(-strain, &mut variables);
        }
        let [_, _, slope, dissipated] = variables;
        let stored = if slope > 0.0 { 0.5 * stress * stress / slope } else { 0.0 };
        InternalEnergy { stored, dissipated }
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

/// Number of internal variables.
const VARIABLE_COUNT: usize = 4;

/// Stresses and tangents of several fibres, whose variables follow each other.
struct ConcreteLoops<'a> {
    concrete: &'a Concrete,
    strains: &'a [f64],
    variables: &'a [f64],
    responses: &'a mut [UniaxialResponse],
}

impl WithSimd for ConcreteLoops<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self { concrete, strains: fiber_strains, variables, responses } = self;
        // A list of each quantity, of which vectors are loaded at once.
        let mut strains = [0.0; MAX_BATCH_FIBERS];
        let mut max_compressions = [0.0; MAX_BATCH_FIBERS];
        let mut residual_strains = [0.0; MAX_BATCH_FIBERS];
        let mut slopes = [0.0; MAX_BATCH_FIBERS];
        let histories = variables.as_chunks::<VARIABLE_COUNT>().0;
        for (k, (strain, history)) in fiber_strains.iter().zip(histories).enumerate() {
            strains[k] = *strain;
            max_compressions[k] = history[0];
            residual_strains[k] = history[1];
            slopes[k] = history[2];
        }
        let mut stresses = [0.0; MAX_BATCH_FIBERS];
        let mut tangents = [0.0; MAX_BATCH_FIBERS];
        for k in 0..padded_count(responses.len(), MAX_BATCH_FIBERS) {
            let unloading = Unloading { residual_strain: residual_strains[k], slope: slopes[k] };
            let response = concrete.response_after(strains[k], max_compressions[k], &unloading);
            stresses[k] = response.stress;
            tangents[k] = response.tangent;
        }
        for (k, response) in responses.iter_mut().enumerate() {
            *response = UniaxialResponse { stress: stresses[k], tangent: tangents[k] };
        }
    }
}

/// Variables: largest compressive strain so far; residual strain and slope of unloading from it; energy dissipated (J/m³).
impl UniaxialMaterial for Concrete {
    fn modulus(&self) -> f64 {
        self.initial_modulus()
    }

    fn variable_count(&self) -> usize {
        VARIABLE_COUNT
    }

    fn initialize(&self, variables: &mut [f64]) {
        self.write(0.0, variables);
    }

    fn response(&self, strain: f64, variables: &[f64]) -> Result<UniaxialResponse> {
        check_variables(variables, VARIABLE_COUNT)?;
        let unloading = Unloading { residual_strain: variables[1], slope: variables[2] };
        Ok(self.response_after(strain, variables[0], &unloading))
    }

    fn responses(
        &self,
        strains: &[f64],
        variables: &[f64],
        responses: &mut [UniaxialResponse],
    ) -> std::result::Result<(), (usize, Error)> {
        vectorized(ConcreteLoops { concrete: self, strains, variables, responses });
        Ok(())
    }

    fn energy(&self, strain: f64, variables: &[f64]) -> Result<InternalEnergy> {
        let stress = self.response(strain, variables)?.stress;
        Ok(self.energy_with(strain, stress, std::array::from_fn(|i| variables[i])))
    }

    fn energies(
        &self,
        strains: &[f64],
        variables: &[f64],
        energies: &mut [InternalEnergy],
    ) -> std::result::Result<(), (usize, Error)> {
        let mut responses = [UniaxialResponse::default(); MAX_BATCH_FIBERS];
        self.responses(strains, variables, &mut responses[..energies.len()])?;
        let fibers = strains.iter().zip(variables.as_chunks().0).zip(responses);
        for (energy, ((strain, history), response)) in energies.iter_mut().zip(fibers) {
            *energy = self.energy_with(*strain, response.stress, *history);
        }
        Ok(())
    }

    /// The remainder is the work of the stresses at mid-step less the changes of energy.
    fn end_step(
        &self,
        [start, _, end]: [&[f64]; 3],
        variables: &[&[f64]],
        stresses: &mut [f64],
        remainders: &mut [f64],
        energies: &mut [InternalEnergy],
    ) -> std::result::Result<(), (usize, Error)> {
        let count = remainders.len() / variables.len().max(1);
        let mut start_energies = [InternalEnergy::default(); MAX_BATCH_FIBERS];
        let start_energies = &mut start_energies[..count];
        for (section, variables) in variables.iter().enumerate() {
            let fibers = section * count..(section + 1) * count;
            self.energies(&start[fibers.clone()], variables, start_energies)?;
            self.energies(&end[fibers.clone()], variables, &mut energies[fibers.clone()])?;
            for (k, start_energy) in fibers.zip(&*start_energies) {
                let work = stresses[k] * (end[k] - start[k]);
                let stored_change = energies[k].stored - start_energy.stored;
                let dissipated_change = energies[k].dissipated - start_energy.dissipated;
                remainders[k] = work - stored_change - dissipated_change;
            }
        }
        Ok(())
    }

    /// Changes nothing for a wrong number of variables.
    fn commit(&self, strain: f64, variables: &mut [f64]) {
        if variables.len() == self.variable_count() && -strain > variables[0] {
            self.write(-strain, variables);
        }
    }
}
