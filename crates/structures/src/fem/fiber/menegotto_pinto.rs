//! Steel with curved branches between two asymptotes (Menegotto and Pinto 1973).
//!
//! | symbol | meaning |
//! |---|---|
//! | ε_r, σ_r | last reversal |
//! | ε_0, σ_0 | intersection of the asymptotes: slope E through the reversal, slope b E of the hardening |
//! | ε*, σ* | (ε − ε_r)/(ε_0 − ε_r) and (σ − σ_r)/(σ_0 − σ_r) |
//! | R | exponent of the transition; it falls with the plastic excursion ξ of the last half cycle |
//!
//! `steel_branch.rs` has the curve.

use super::bilinear_steel::check_steel;
use super::steel_branch::{BranchLoops, MAX_LOOP_BRANCHES, SteelBranch, SteelBranches};
use super::steel_history::{LAST_STRAIN, LoadingDirection, SteelHistory, VARIABLE_COUNT};
use super::{
    MAX_BATCH_FIBERS, MAX_MEMBER_FIBERS, UniaxialMaterial, UniaxialResponse, check_variables,
};
use crate::error::{Error, Result, positive, require};
use crate::fem::internal_energy::InternalEnergy;
use crate::linalg::vectorized;

/// Exponent of the shift of asymptotes by isotropic hardening (Filippou, Popov and Bertero 1983).
const SHIFT_EXPONENT: f64 = 0.8;

/// Steel with curved branches and the Bauschinger effect.
///
/// ```text
/// σ* = b ε* + (1 − b) ε*/(1 + |ε*|^R)^(1/R),  R = R_0 (1 − c_1 ξ/(c_2 + ξ))
/// ```
///
/// (Menegotto and Pinto 1973; Filippou, Popov and Bertero 1983). The law is that of OpenSees' `Steel02` without initial stress.
/// The stored energy is σ²/(2E). Work is integrated by the trapezoidal rule over the steps. The rest is dissipated; just
/// after a reversal its rate is slightly negative, because the curve leaves the straight line at once.
///
/// ```
/// use basemat::fem::{MenegottoPinto, UniaxialMaterial};
///
/// let steel = MenegottoPinto::new(450.0e6, 200.0e9, 0.01)?;
/// let mut variables = vec![0.0; steel.variable_count()];
/// steel.initialize(&mut variables);
/// // σ at twice the yield strain: ε* = 2 and R = 15.
/// let root = (1.0 + 2.0_f64.powf(15.0)).powf(1.0 / 15.0);
/// let stress = 450.0e6 * (0.01 * 2.0 + 0.99 * 2.0 / root);
/// assert!((steel.response(0.0045, &variables)?.stress - stress).abs() < 1.0);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MenegottoPinto {
    yield_stress: f64,
    modulus: f64,
    hardening_ratio: f64,
    /// R_0, c_1 and c_2.
    transition: [f64; 3],
    /// a_1 to a_4: shifts of the asymptotes in compression (first two) and in tension.
    isotropic_hardening: [f64; 4],
}

impl MenegottoPinto {
    /// Steel of a yield stress f_y (Pa), Young's modulus E (Pa) and hardening ratio b.
    ///
    /// R_0 = 15, c_1 = 0.925 and c_2 = 0.15, without isotropic hardening: the defaults of OpenSees.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless yield stress and modulus are positive and 0 ≤ b < 1.
    pub fn new(yield_stress: f64, modulus: f64, hardening_ratio: f64) -> Result<Self> {
        check_steel(yield_stress, modulus, hardening_ratio)?;
        Ok(Self {
            yield_stress,
            modulus,
            hardening_ratio,
            transition: [15.0, 0.925, 0.15],
            isotropic_hardening: [0.0, 1.0, 0.0, 1.0],
        })
    }

    /// Replaces R_0, c_1 and c_2 of the transition between the asymptotes.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless R_0 and c_2 are positive and 0 ≤ c_1 < 1.
    pub fn with_transition(self, exponent: f64, c1: f64, c2: f64) -> Result<Self> {
        positive("exponent R₀ of the steel's transition", exponent)?;
        let is_ratio = (0.0..1.0).contains(&c1);
        require("c₁ of the steel's transition", c1, is_ratio, "from 0 to below 1")?;
        positive("c₂ of the steel's transition", c2)?;
        Ok(Self { transition: [exponent, c1, c2], ..self })
    }

    /// Adds isotropic hardening: a_1 and a_2 for compression, a_3 and a_4 for tension.
    ///
    /// The asymptotes shift by a_1 f_y (Δε/(2 a_2 ε_y))^0.8, with the range Δε of the strains at reversals.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless a_1 and a_3 are not negative and a_2 and a_4 are positive.
    pub fn with_isotropic_hardening(self, [a1, a2, a3, a4]: [f64; 4]) -> Result<Self> {
        for factor in [a1, a3] {
            crate::error::not_negative("isotropic hardening of the steel", factor)?;
        }
        for strain in [a2, a4] {
            positive("strain ratio of the steel's isotropic hardening", strain)?;
        }
        Ok(Self { isotropic_hardening: [a1, a2, a3, a4], ..self })
    }

    fn yield_strain(&self) -> f64 {
        self.yield_stress / self.modulus
    }

    /// Branch of a strain.
    #[inline]
    fn branch_at(&self, strain: f64, variables: &[f64; VARIABLE_COUNT]) -> SteelBranch {
        // Most fibres follow their last branch.
        if SteelHistory::follows_branch(strain, variables) {
            return SteelHistory::curve_of(variables);
        }
        self.branch_of(&self.history_at(strain, variables))
    }

    /// History with the branch of a strain, after a reversal if there is one.
    fn history_at(&self, strain: f64, variables: &[f64; VARIABLE_COUNT]) -> SteelHistory {
        let mut history = SteelHistory::read(variables);
        let increment = strain - history.last[0];
        let next_direction = if increment > 0.0 {
            LoadingDirection::Tension
        } else if increment < 0.0 {
            LoadingDirection::Compression
        } else {
            history.direction
        };
        if next_direction == history.direction {
            return history;
        }
        let sign = if next_direction == LoadingDirection::Tension { 1.0 } else { -1.0 };
        if history.direction == LoadingDirection::Virgin {
            history.max_strain = self.yield_strain();
            history.min_strain = -self.yield_strain();
            history.curve = SteelBranch {
                exponent: self.transition[0],
                strain_range: sign * self.yield_strain(),
                reversal: [0.0; 2],
            };
        } else {
            self.reverse(sign, &mut history);
        }
        history.direction = next_direction;
        history
    }

    /// Begins a half cycle towards tension (`sign` 1) or compression (−1) at the last strain.
    fn reverse(&self, sign: f64, history: &mut SteelHistory) {
        let last_strain = history.last[0];
        history.min_strain = history.min_strain.min(last_strain);
        history.max_strain = history.max_strain.max(last_strain);
        let shift = self.isotropic_shift(sign, history.max_strain - history.min_strain);
        let hardening_modulus = self.hardening_ratio * self.modulus;
        let yield_stress = sign * shift * self.yield_stress;
        let yield_strain = sign * shift * self.yield_strain();
        let intersection = (yield_stress - hardening_modulus * yield_strain - history.last[1]
            + self.modulus * last_strain)
            / (self.modulus - hardening_modulus);
        let plastic_strain = if sign > 0.0 { history.max_strain } else { history.min_strain };
        let excursion = ((plastic_strain - intersection) / self.yield_strain()).abs();
        let [exponent, c1, c2] = self.transition;
        history.curve = SteelBranch {
            exponent: exponent * (1.0 - c1 * excursion / (c2 + excursion)),
            strain_range: intersection - last_strain,
            reversal: history.last,
        };
        if history.curve.strain_range == 0.0 {
            // A reversal on the asymptote of the new half cycle, but for rounding: along the asymptote.
            history.curve = SteelBranch::line(history.last, self.yield_strain());
        }
    }

    /// Factor of the yield stress after strains of this range, in tension (`sign` 1) or compression (−1).
    fn isotropic_shift(&self, sign: f64, range: f64) -> f64 {
        // a_1 and a_2 in compression, a_3 and a_4 in tension.
        let first = if sign > 0.0 { 2 } else { 0 };
        let factor = self.isotropic_hardening[first];
        if factor == 0.0 {
            return 1.0;
        }
        let strain_ratio = self.isotropic_hardening[first + 1];
        let relative_range = range / (2.0 * strain_ratio * self.yield_strain());
        1.0 + factor * relative_range.powf(SHIFT_EXPONENT)
    }

    /// The branch of a history; an elastic one before the first strain.
    fn branch_of(&self, history: &SteelHistory) -> SteelBranch {
        match history.direction {
            LoadingDirection::Virgin => SteelBranch {
                exponent: self.transition[0],
                strain_range: self.yield_strain(),
                reversal: [0.0; 2],
            },
            LoadingDirection::Tension | LoadingDirection::Compression => history.curve,
        }
    }

    /// Stress and tangent on the branch of a history.
    fn on_branch(&self, strain: f64, history: &SteelHistory) -> UniaxialResponse {
        self.branch_of(history).response(self.modulus, self.hardening_ratio, strain)
    }

    /// Stress at a strain, with the history of its branch.
    fn stress_at(&self, strain: f64, history: &SteelHistory) -> f64 {
        let committed_stress = history.committed_stress(strain);
        committed_stress.unwrap_or_else(|| self.on_branch(strain, history).stress)
    }

    /// Stresses and tangents of fibres on their branches.
    fn respond(&self, branches: &SteelBranches, responses: &mut [UniaxialResponse]) {
        let Self { modulus, hardening_ratio, .. } = *self;
        vectorized(BranchLoops { branches, modulus, hardening_ratio, responses });
    }

    /// Remainder of a step, with the stresses of the branches at mid-step and at the end.
    #[inline]
    fn remainder_with(
        &self,
        [start_strain, _, end_strain]: [f64; 3],
        [midstep_stress, end_stress]: [f64; 2],
        variables: &[f64; VARIABLE_COUNT],
    ) -> f64 {
        let history = SteelHistory::read(variables);
        let start_stress = history.committed_stress(start_strain).unwrap_or_else(|| {
            self.stress_at(start_strain, &self.history_at(start_strain, variables))
        });
        let end_stress = history.committed_stress(end_strain).unwrap_or(end_stress);
        (midstep_stress - 0.5 * (start_stress + end_stress)) * (end_strain - start_strain)
    }

    /// Energy at a strain with a stress, after a history.
    fn energy_with(&self, history: &SteelHistory, strain: f64, stress: f64) -> InternalEnergy {
        let stored = 0.5 * stress * stress / self.modulus;
        InternalEnergy { stored, dissipated: history.work_to(strain, stress) - stored }
    }

    /// Ends a step at a strain with a stress.
    fn commit_stress(&self, strain: f64, stress: f64, variables: &mut [f64; VARIABLE_COUNT]) {
        let work = SteelHistory::read(variables).work_to(strain, stress);
        if !SteelHistory::follows_branch(strain, variables) {
            self.history_at(strain, variables).write(variables);
        }
        SteelHistory::write_end([strain, stress], work, variables);
    }
}

/// The internal variables of a fibre; an error for a wrong number.
fn checked(variables: &[f64]) -> Result<&[f64; VARIABLE_COUNT]> {
    check_variables(variables, VARIABLE_COUNT)?;
    let needed = "ten internal variables";
    variables.try_into().map_err(|_| Error::Scene { quantity: "fibre of steel", needed })
}

/// Variables: see the documentation of `SteelHistory`.
impl UniaxialMaterial for MenegottoPinto {
    fn modulus(&self) -> f64 {
        self.modulus
    }

    fn variable_count(&self) -> usize {
        VARIABLE_COUNT
    }

    fn response(&self, strain: f64, variables: &[f64]) -> Result<UniaxialResponse> {
        let history = self.history_at(strain, checked(variables)?);
        Ok(self.on_branch(strain, &history))
    }

    fn responses(
        &self,
        strains: &[f64],
        variables: &[f64],
        responses: &mut [UniaxialResponse],
    ) -> std::result::Result<(), (usize, Error)> {
        self.responses_of_sections(strains, &[variables], responses)
    }

    fn responses_of_sections(
        &self,
        strains: &[f64],
        variables: &[&[f64]],
        responses: &mut [UniaxialResponse],
    ) -> std::result::Result<(), (usize, Error)> {
        let mut histories = variables.iter().flat_map(|fibers| fibers.as_chunks().0);
        let strains = strains.chunks(MAX_LOOP_BRANCHES);
        for (strains, responses) in strains.zip(responses.chunks_mut(MAX_LOOP_BRANCHES)) {
            let mut branches = SteelBranches::WITHOUT_STRAIN;
            for (k, (strain, variables)) in strains.iter().zip(&mut histories).enumerate() {
                branches.set(k, *strain, self.branch_at(*strain, variables));
            }
            self.respond(&branches, responses);
        }
        Ok(())
    }

    fn energies(
        &self,
        strains: &[f64],
        variables: &[f64],
        energies: &mut [InternalEnergy],
    ) -> std::result::Result<(), (usize, Error)> {
        let mut responses = [UniaxialResponse::default(); MAX_BATCH_FIBERS];
        let responses = &mut responses[..strains.len()];
        let histories = variables.as_chunks().0;
        // At the end of the last step all stresses are stored.
        let mut fibers = strains.iter().zip(histories);
        if fibers.any(|(strain, variables)| *strain != variables[LAST_STRAIN]) {
            self.responses(strains, variables, responses)?;
        }
        let histories = histories.iter().map(SteelHistory::read);
        let fibers = strains.iter().zip(histories).zip(responses);
        for (energy, ((strain, history), response)) in energies.iter_mut().zip(fibers) {
            let stress = history.committed_stress(*strain).unwrap_or(response.stress);
            *energy = self.energy_with(&history, *strain, stress);
        }
        Ok(())
    }

    /// (σ(midstep) − (σ(start) + σ(end))/2) (end − start): work is integrated by the trapezoidal rule.
    fn remainder(&self, strains: [f64; 3], variables: &[f64]) -> Result<f64> {
        let variables = checked(variables)?;
        let stresses = [strains[1], strains[2]]
            .map(|strain| self.on_branch(strain, &self.history_at(strain, variables)).stress);
        Ok(self.remainder_with(strains, stresses, variables))
    }

    fn end_step(
        &self,
        strains: [&[f64]; 3],
        variables: &[&[f64]],
        stresses: &mut [f64],
        remainders: &mut [f64],
        energies: &mut [InternalEnergy],
    ) -> std::result::Result<(), (usize, Error)> {
        let mut responses = [UniaxialResponse::default(); MAX_MEMBER_FIBERS];
        let responses = &mut responses[..remainders.len()];
        self.responses_of_sections(strains[2], variables, responses)?;
        let histories = variables.iter().flat_map(|fibers| fibers.as_chunks().0);
        for (k, (variables, response)) in histories.zip(responses).enumerate() {
            let end_stress = response.stress;
            let midstep_stress = std::mem::replace(&mut stresses[k], end_stress);
            let fiber_strains = strains.map(|strains| strains[k]);
            let fiber_stresses = [midstep_stress, end_stress];
            remainders[k] = self.remainder_with(fiber_strains, fiber_stresses, variables);
            let history = SteelHistory::read(variables);
            let end_stress = history.committed_stress(fiber_strains[2]).unwrap_or(end_stress);
            energies[k] = self.energy_with(&history, fiber_strains[2], end_stress);
        }
        Ok(())
    }

    fn commit_stresses(&self, strains: &[f64], stresses: &[f64], variables: &mut [f64]) {
        let histories = variables.as_chunks_mut().0;
        for ((variables, strain), stress) in histories.iter_mut().zip(strains).zip(stresses) {
            self.commit_stress(*strain, *stress, variables);
        }
    }

    fn energy(&self, strain: f64, variables: &[f64]) -> Result<InternalEnergy> {
        let history = self.history_at(strain, checked(variables)?);
        let stress = self.stress_at(strain, &history);
        Ok(self.energy_with(&history, strain, stress))
    }

    /// Changes nothing for a wrong number of variables.
    fn commit(&self, strain: f64, variables: &mut [f64]) {
        if let Ok(variables) = <&mut [f64; VARIABLE_COUNT]>::try_from(variables) {
            let stress = self.on_branch(strain, &self.history_at(strain, variables)).stress;
            self.commit_stress(strain, stress, variables);
        }
    }

    fn commit_fibers(&self, strains: &[f64], variables: &mut [f64]) {
        let mut responses = [UniaxialResponse::default(); MAX_BATCH_FIBERS];
        if self.responses(strains, variables, &mut responses[..strains.len()]).is_err() {
            return;
        }
        let stresses = responses.map(|response| response.stress);
        self.commit_stresses(strains, &stresses, variables);
    }
}
