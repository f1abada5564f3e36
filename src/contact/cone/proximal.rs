//! The proximal point method: a sequence of better conditioned problems.
//!
//! Each problem has W + α d and q − α d (r − r₀), with d the mean of W's diagonal and r the last iterate. The added
//! terms vanish as the iterates converge.

use super::problem::ConeProblem;

/// Initial fraction α of the mean diagonal d that is added.
const INITIAL_DIAGONAL_FRACTION: f64 = 0.3;
/// Factor of α after a problem that was solved.
const FRACTION_REDUCTION: f64 = 0.5;
/// Factor of α after a problem that was not solved.
const FRACTION_GROWTH: f64 = 3.0;
/// Largest number of problems: α may fall below 1e-16.
const MAX_PROXIMAL_ITERATIONS: usize = 60;

/// Original q and diagonal of W, and the last iterate.
pub(super) struct Proximal {
    q: Vec<f64>,
    diagonal: Vec<f64>,
    /// r − r₀ of the last iterate.
    last_change: Vec<f64>,
}

impl Proximal {
    /// Allocates for the components of `element_count` elements.
    pub(super) fn new(element_count: usize) -> Self {
        let zero = vec![0.0; 3 * element_count];
        Self { q: zero.clone(), diagonal: zero.clone(), last_change: zero }
    }

    /// Solves `problem` by `solve`, a solver for modified problems; returns whether it succeeded.
    pub(super) fn solve(
        &mut self,
        problem: &mut ConeProblem,
        mut solve: impl FnMut(&mut ConeProblem) -> bool,
    ) -> bool {
        let size = problem.component_count();
        self.q.copy_from_slice(&problem.q);
        self.last_change.copy_from_slice(&problem.force_change);
        for i in 0..size {
            self.diagonal[i] = problem.diagonal(i);
        }
        let mean_diagonal = self.diagonal.iter().sum::<f64>() / size as f64;
        let mut fraction = INITIAL_DIAGONAL_FRACTION;
        for _ in 0..MAX_PROXIMAL_ITERATIONS {
            let added_diagonal = fraction * mean_diagonal;
            for i in 0..size {
                problem.q[i] = self.q[i] - added_diagonal * self.last_change[i];
            }
            problem.set_added_diagonal(&self.diagonal, added_diagonal);
            let is_solved = solve(problem);
            problem.q.copy_from_slice(&self.q);
            problem.set_added_diagonal(&self.diagonal, 0.0);
            if !is_solved {
                problem.force_change.copy_from_slice(&self.last_change);
                fraction *= FRACTION_GROWTH;
                continue;
            }
            self.last_change.copy_from_slice(&problem.force_change);
            fraction *= FRACTION_REDUCTION;
            if problem.is_solved() {
                return true;
            }
        }
        false
    }
}

impl ConeProblem {
    /// Entry on the diagonal of W.
    fn diagonal(&self, i: usize) -> f64 {
        let component = i / self.element_count;
        self.element_blocks[i % self.element_count][component][component]
    }

    /// Adds a number to the diagonal of W, whose original entries are `diagonal`.
    fn set_added_diagonal(&mut self, diagonal: &[f64], added_diagonal: f64) {
        self.added_diagonal = added_diagonal;
        let size = self.component_count();
        for (entry, original) in self.w.iter_mut().step_by(size + 1).zip(diagonal) {
            *entry = original + added_diagonal;
        }
        self.update_scales();
    }
}
