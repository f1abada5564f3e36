//! Internal variables of a fibre of steel with curved branches.

use super::steel_branch::SteelBranch;

/// Number of internal variables.
pub(super) const VARIABLE_COUNT: usize = 10;
/// Index of the strain at the end of the last step among the variables; its stress follows.
pub(super) const LAST_STRAIN: usize = 7;
/// Index of the work of the stress among the variables.
const STRESS_WORK: usize = 9;

/// Direction of loading since the last reversal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum LoadingDirection {
    /// No strain so far.
    Virgin,
    Tension,
    Compression,
}

/// Internal variables of a fibre by name.
#[derive(Debug, Clone, Copy)]
pub(super) struct SteelHistory {
    pub(super) direction: LoadingDirection,
    /// Extreme strains at reversals.
    pub(super) min_strain: f64,
    pub(super) max_strain: f64,
    /// The branch; without meaning before the first strain.
    pub(super) curve: SteelBranch,
    /// Strain and stress at the end of the last step.
    pub(super) last: [f64; 2],
    /// Work of the stress so far, J/m³.
    pub(super) work: f64,
}

impl SteelHistory {
    /// Work of the stress up to a strain with this stress, J/m³.
    pub(super) fn work_to(&self, strain: f64, stress: f64) -> f64 {
        self.work + 0.5 * (self.last[1] + stress) * (strain - self.last[0])
    }

    /// The stress at the end of the last step; `None` for another strain, or before the first step.
    pub(super) fn committed_stress(&self, strain: f64) -> Option<f64> {
        let is_last = strain == self.last[0] && self.direction != LoadingDirection::Virgin;
        is_last.then_some(self.last[1])
    }

    /// Whether a strain is on the branch of internal variables, without a reversal.
    #[inline]
    pub(super) fn follows_branch(strain: f64, variables: &[f64; VARIABLE_COUNT]) -> bool {
        let direction = variables[0];
        direction != 0.0 && direction * (strain - variables[LAST_STRAIN]) >= 0.0
    }

    /// The branch of internal variables.
    #[inline]
    pub(super) fn curve_of(variables: &[f64; VARIABLE_COUNT]) -> SteelBranch {
        SteelBranch {
            exponent: variables[3],
            strain_range: variables[4],
            reversal: [variables[5], variables[6]],
        }
    }

    /// The history of internal variables.
    #[inline]
    pub(super) fn read(variables: &[f64; VARIABLE_COUNT]) -> Self {
        let direction = match variables[0] {
            value if value > 0.0 => LoadingDirection::Tension,
            value if value < 0.0 => LoadingDirection::Compression,
            _ => LoadingDirection::Virgin,
        };
        Self {
            direction,
            min_strain: variables[1],
            max_strain: variables[2],
            curve: Self::curve_of(variables),
            last: [variables[LAST_STRAIN], variables[LAST_STRAIN + 1]],
            work: variables[STRESS_WORK],
        }
    }

    /// Overwrites strain and stress at the end of the last step, and the work of the stress.
    #[inline]
    pub(super) fn write_end(last: [f64; 2], work: f64, variables: &mut [f64; VARIABLE_COUNT]) {
        variables[LAST_STRAIN] = last[0];
        variables[LAST_STRAIN + 1] = last[1];
        variables[STRESS_WORK] = work;
    }

    /// Overwrites internal variables by the history.
    pub(super) fn write(&self, variables: &mut [f64; VARIABLE_COUNT]) {
        let direction = match self.direction {
            LoadingDirection::Virgin => 0.0,
            LoadingDirection::Tension => 1.0,
            LoadingDirection::Compression => -1.0,
        };
        *variables = [
            direction,
            self.min_strain,
            self.max_strain,
            self.curve.exponent,
            self.curve.strain_range,
            self.curve.reversal[0],
            self.curve.reversal[1],
            self.last[0],
            self.last[1],
            self.work,
        ];
    }
}
