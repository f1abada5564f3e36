//! Steel with curved branches between two asymptotes (Menegotto and Pinto 1973).
//!
//! | symbol | meaning |
//! |---|---|
//! | ε_r, σ_r | last reversal |
//! | ε_0, σ_0 | intersection of the asymptotes: slope E through the reversal, slope b E of the hardening |
//! | ε*, σ* | (ε − ε_r)/(ε_0 − ε_r) and (σ − σ_r)/(σ_0 − σ_r) |
//! | R | exponent of the transition; it falls with the plastic excursion ξ of the last half cycle |

use super::bilinear_steel::check_steel;
use super::{UniaxialMaterial, UniaxialResponse, check_variables};
use crate::error::{Result, positive, require};
use crate::fem::internal_energy::InternalEnergy;

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

/// Smallest logarithm of a power that changes its sum with one; smaller powers count as zero.
const MIN_POWER_LOGARITHM: f64 = -40.0;

/// Direction of loading since the last reversal.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Branch {
    /// No strain so far.
    Virgin,
    Tension,
    Compression,
}

/// Internal variables of a fibre by name.
#[derive(Debug, Clone, Copy)]
struct History {
    branch: Branch,
    /// Extreme strains at reversals.
    min_strain: f64,
    max_strain: f64,
    /// Strain at which the asymptote of the last half cycle began.
    plastic_strain: f64,
    /// ε_0 and σ_0.
    intersection: [f64; 2],
    /// ε_r and σ_r.
    reversal: [f64; 2],
    /// Strain and stress at the end of the last step.
    last: [f64; 2],
    /// Work of the stress so far, J/m³.
    work: f64,
}

impl History {
    /// Work of the stress up to a strain with this stress, J/m³.
    fn work_to(&self, strain: f64, stress: f64) -> f64 {
        self.work + 0.5 * (self.last[1] + stress) * (strain - self.last[0])
    }

    fn read(variables: &[f64]) -> Self {
        let branch = match variables[0] {
            value if value > 0.0 => Branch::Tension,
            value if value < 0.0 => Branch::Compression,
            _ => Branch::Virgin,
        };
        Self {
            branch,
            min_strain: variables[1],
            max_strain: variables[2],
            plastic_strain: variables[3],
            intersection: [variables[4], variables[5]],
            reversal: [variables[6], variables[7]],
            last: [variables[8], variables[9]],
            work: variables[10],
        }
    }

    fn write(&self, variables: &mut [f64]) {
        let branch = match self.branch {
            Branch::Virgin => 0.0,
            Branch::Tension => 1.0,
            Branch::Compression => -1.0,
        };
        let values = [
            branch,
            self.min_strain,
            self.max_strain,
            self.plastic_strain,
            self.intersection[0],
            self.intersection[1],
            self.reversal[0],
            self.reversal[1],
            self.last[0],
            self.last[1],
            self.work,
        ];
        for (variable, value) in variables.iter_mut().zip(values) {
            *variable = value;
        }
    }
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

    /// History with the branch of a strain, after a reversal if there is one.
    fn history_at(&self, strain: f64, variables: &[f64]) -> History {
        let mut history = History::read(variables);
        let increment = strain - history.last[0];
        let next_branch = if increment > 0.0 {
            Branch::Tension
        } else if increment < 0.0 {
            Branch::Compression
        } else {
            history.branch
        };
        if next_branch == history.branch {
            return history;
        }
        let sign = if next_branch == Branch::Tension { 1.0 } else { -1.0 };
        if history.branch == Branch::Virgin {
            history.max_strain = self.yield_strain();
            history.min_strain = -self.yield_strain();
            history.plastic_strain = sign * self.yield_strain();
            history.intersection = [sign * self.yield_strain(), sign * self.yield_stress];
        } else {
            self.reverse(sign, &mut history);
        }
        history.branch = next_branch;
        history
    }

    /// Begins a half cycle towards tension (`sign` 1) or compression (−1) at the last strain.
    fn reverse(&self, sign: f64, history: &mut History) {
        history.reversal = history.last;
        history.min_strain = history.min_strain.min(history.last[0]);
        history.max_strain = history.max_strain.max(history.last[0]);
        // a_1 and a_2 in compression, a_3 and a_4 in tension.
        let first = if sign > 0.0 { 2 } else { 0 };
        let factor = self.isotropic_hardening[first];
        let strain_ratio = self.isotropic_hardening[first + 1];
        let range = history.max_strain - history.min_strain;
        let relative_range = range / (2.0 * strain_ratio * self.yield_strain());
        let shift = 1.0 + factor * relative_range.powf(SHIFT_EXPONENT);
        let hardening_modulus = self.hardening_ratio * self.modulus;
        let yield_stress = sign * shift * self.yield_stress;
        let yield_strain = sign * shift * self.yield_strain();
        let strain = (yield_stress - hardening_modulus * yield_strain - history.reversal[1]
            + self.modulus * history.reversal[0])
            / (self.modulus - hardening_modulus);
        let stress = yield_stress + hardening_modulus * (strain - yield_strain);
        history.intersection = [strain, stress];
        history.plastic_strain = if sign > 0.0 { history.max_strain } else { history.min_strain };
    }

    /// Stress and tangent on the branch of a history.
    fn on_branch(&self, strain: f64, history: &History) -> UniaxialResponse {
        if history.branch == Branch::Virgin {
            return UniaxialResponse { stress: 0.0, tangent: self.modulus };
        }
        let [exponent, c1, c2] = self.transition;
        let excursion =
            ((history.plastic_strain - history.intersection[0]) / self.yield_strain()).abs();
        let r = exponent * (1.0 - c1 * excursion / (c2 + excursion));
        let strain_range = history.intersection[0] - history.reversal[0];
        let stress_range = history.intersection[1] - history.reversal[1];
        let b = self.hardening_ratio;
        if strain_range == 0.0 {
            // A reversal on the asymptote of the new half cycle, but for rounding: along the asymptote.
            let tangent = b * self.modulus;
            let stress = history.reversal[1] + tangent * (strain - history.reversal[0]);
            return UniaxialResponse { stress, tangent };
        }
        let ratio = (strain - history.reversal[0]) / strain_range;
        // Powers by logarithms, which take half the time of `powf`.
        let power_logarithm = r * ratio.abs().ln();
        let power = if power_logarithm < MIN_POWER_LOGARITHM { 0.0 } else { power_logarithm.exp() };
        let sum = 1.0 + power;
        let root = if power == 0.0 { 1.0 } else { (sum.ln() / r).exp() };
        UniaxialResponse {
            stress: (b * ratio + (1.0 - b) * ratio / root) * stress_range + history.reversal[1],
            tangent: (b + (1.0 - b) / (sum * root)) * stress_range / strain_range,
        }
    }
}

/// Variables: see the documentation of `History`.
impl UniaxialMaterial for MenegottoPinto {
    fn modulus(&self) -> f64 {
        self.modulus
    }

    fn variable_count(&self) -> usize {
        11
    }

    fn response(&self, strain: f64, variables: &[f64]) -> Result<UniaxialResponse> {
        check_variables(variables, self.variable_count())?;
        Ok(self.on_branch(strain, &self.history_at(strain, variables)))
    }

    fn energy(&self, strain: f64, variables: &[f64]) -> Result<InternalEnergy> {
        check_variables(variables, self.variable_count())?;
        let history = self.history_at(strain, variables);
        // The stress at the end of the last step is stored.
        let is_last = strain == history.last[0] && history.branch != Branch::Virgin;
        let stress =
            if is_last { history.last[1] } else { self.on_branch(strain, &history).stress };
        let stored = 0.5 * stress * stress / self.modulus;
        Ok(InternalEnergy { stored, dissipated: history.work_to(strain, stress) - stored })
    }

    /// Changes nothing for a wrong number of variables.
    fn commit(&self, strain: f64, variables: &mut [f64]) {
        if variables.len() != self.variable_count() {
            return;
        }
        let mut history = self.history_at(strain, variables);
        let stress = self.on_branch(strain, &history).stress;
        history.work = history.work_to(strain, stress);
        history.last = [strain, stress];
        history.write(variables);
    }
}
