//! Newton's method for elements that move together, as under a light structure in a long step.
//!
//! ρ of an element is the reciprocal of its compliance alone. Where the structure moves all elements by nearly as much as
//! the loaded one, a trial r − ρ y corrects the same motion once for each element. The statuses then alternate between all
//! open and all at their largest pressure. The smaller ρ here is the reciprocal of the sum of the magnitudes in a row of W,
//! and the largest of these sums bounds the eigenvalues of W (Gershgorin 1931). Trials then share the correction.
//!
//! A fixed point of r = P(r − ρ y) for one ρ is a fixed point for all.

use super::newton::Newton;
use super::problem::{ConeProblem, SolveOutcome};

impl ConeProblem {
    /// Whether a pressure has an upper bound, without which statuses cannot alternate as above.
    pub(super) fn has_pressure_cap(&self) -> bool {
        self.bounds.iter().any(|bounds| bounds.interval[1] < f64::INFINITY)
    }

    /// Sets ρ to the reciprocals of the sums of magnitudes in the rows of W, which has stored entries.
    ///
    /// Returns the smallest ratio between these ρ and those of each element alone.
    fn set_collective_scales(&mut self) -> f64 {
        let size = self.component_count();
        let mut smallest_ratio = 1.0_f64;
        for e in 0..self.element_count {
            let [normal, x, y] = self
                .component_indices(e)
                .map(|i| self.w[i * size..][..size].iter().map(|entry| entry.abs()).sum::<f64>());
            let collective_rho = [normal.recip(), x.max(y).recip()];
            for (rho, collective_rho) in self.rho[e].iter_mut().zip(collective_rho) {
                smallest_ratio = smallest_ratio.min(collective_rho / *rho);
                *rho = collective_rho;
            }
        }
        smallest_ratio
    }
}

/// Iterates from r₀ with the smaller ρ, then with the ρ of each element alone, for which the residual is accepted.
///
/// A residual grows at most in proportion to ρ, so that the first iterations end at a tolerance smaller by the ratio of the
/// two. Without stored entries of W nothing is done: on a bed of many springs other methods find the forces.
pub(super) fn solve_collectively(problem: &mut ConeProblem, newton: &mut Newton) -> SolveOutcome {
    if problem.w.is_empty() {
        return SolveOutcome::new(0, false);
    }
    problem.reset_forces();
    let relative_tolerance = problem.relative_tolerance;
    problem.relative_tolerance *= problem.set_collective_scales();
    let collective_outcome = newton.solve(problem, false);
    problem.relative_tolerance = relative_tolerance;
    problem.update_scales();
    let outcome = newton.solve(problem, false);
    let iterations = collective_outcome.iterations + outcome.iterations;
    SolveOutcome::new(iterations, outcome.is_solved)
}
