//! The proximal point method: a sequence of problems with W + α D and q − α D r, with r the last iterate.
//!
//! Each problem is better conditioned than the original one, and the added terms vanish as the iterates converge.

use super::problem::ConeProblem;

/// Initial fraction of the mean diagonal D that is added.
const INITIAL_DIAGONAL_FRACTION: f64 = 0.3;
/// Largest number of iterations.
const MAX_PROXIMAL_ITERATIONS: usize = 60;

/// Original q and diagonal of W, and the last iterate.
pub(super) struct Proximal {
    q: Vec<f64>,
    diagonal: Vec<f64>,
    center: Vec<f64>,
}

impl Proximal {
    pub(super) fn new(count: usize) -> Self {
        let zero = vec![0.0; 3 * count];
        Self { q: zero.clone(), diagonal: zero.clone(), center: zero }
    }

    /// Solves `problem` by `solve`, a solver for modified problems; returns whether it succeeded.
    pub(super) fn solve(
        &mut self,
        problem: &mut ConeProblem,
        mut solve: impl FnMut(&mut ConeProblem) -> bool,
    ) -> bool {
        let size = problem.size();
        self.q.copy_from_slice(&problem.q);
        self.center.copy_from_slice(&problem.change);
        for i in 0..size {
            self.diagonal[i] = problem.diagonal(i);
        }
        let mean = self.diagonal.iter().sum::<f64>() / size as f64;
        let mut fraction = INITIAL_DIAGONAL_FRACTION;
        let mut found = false;
        for _ in 0..MAX_PROXIMAL_ITERATIONS {
            let added = fraction * mean;
            for i in 0..size {
                problem.set_diagonal(i, self.diagonal[i] + added);
                problem.q[i] = self.q[i] - added * self.center[i];
            }
            problem.added = added;
            problem.update_scales();
            let solved = solve(problem);
            problem.added = 0.0;
            for i in 0..size {
                problem.set_diagonal(i, self.diagonal[i]);
            }
            problem.q.copy_from_slice(&self.q);
            problem.update_scales();
            if !solved {
                problem.change.copy_from_slice(&self.center);
                fraction *= 3.0;
                continue;
            }
            self.center.copy_from_slice(&problem.change);
            fraction *= 0.5;
            found = problem.is_solved();
            if found {
                break;
            }
        }
        found
    }
}

impl ConeProblem {
    /// Entry on the diagonal of W; `added` is not part of it if W is of low rank.
    fn diagonal(&self, i: usize) -> f64 {
        match &self.low_rank {
            Some(_) => self.element_blocks[i % self.count][i / self.count][i / self.count],
            None => self.w[i * (self.size() + 1)],
        }
    }

    /// Sets an entry on the diagonal of W, unless it is of low rank: then `added` changes it.
    fn set_diagonal(&mut self, i: usize, value: f64) {
        let place = i * (self.size() + 1);
        if self.low_rank.is_none() {
            self.w[place] = value;
        }
    }
}
