//! Springs between two iterates of the static search.

use crate::coupled::model::assembled::Assembled;

/// Factor by which the springs are softened.
const SPRING_SOFTENING_FACTOR: f64 = 0.1;

/// Fictitious springs ε M between two iterates.
pub(super) struct FictitiousSprings {
    /// Shift ε: stiffness per mass, 1/s².
    pub(super) shift: f64,
    /// Smallest shift to which the springs may be softened, 1/s².
    pub(super) min_shift: f64,
}

impl FictitiousSprings {
    /// Force of the springs between two displacements.
    pub(super) fn force(&self, assembled: &Assembled, to: &[f64], from: &[f64]) -> Vec<f64> {
        let step = difference(to, from);
        let mut force = vec![0.0; step.len()];
        assembled.mass.multiply_add(self.shift, &step, &mut force);
        force
    }

    /// Whether the springs have their smallest stiffness, as for a structure that is unstable on softer springs.
    pub(super) fn must_stay_stiff(&self) -> bool {
        self.min_shift == self.shift
    }

    /// Softens the springs tenfold; returns `false` at their smallest stiffness.
    pub(super) fn soften(&mut self) -> bool {
        let can_soften = self.shift > self.min_shift;
        if can_soften {
            self.shift *= SPRING_SOFTENING_FACTOR;
        }
        can_soften
    }
}

/// Difference of two displacements.
pub(super) fn difference(to: &[f64], from: &[f64]) -> Vec<f64> {
    to.iter().zip(from).map(|(a, b)| a - b).collect()
}
