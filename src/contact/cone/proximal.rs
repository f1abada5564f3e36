//! The proximal point method: the same problem with α D added to W and taken from q at the last iterate, again and again.
//!
//! Each is better conditioned than the problem itself, and what is added vanishes as the iterates stand still.

use super::problem::Problem;

/// First share of the mean diagonal D that is added.
const SHARE: f64 = 0.3;
/// Iterates.
const ITERATIONS: usize = 60;

/// What is put back in the end.
pub(super) struct Proximal {
    q: Vec<f64>,
    diagonal: Vec<f64>,
}

impl Proximal {
    pub(super) fn new(count: usize) -> Self {
        Self { q: vec![0.0; 3 * count], diagonal: vec![0.0; 3 * count] }
    }

    /// Finds the solution of `problem` by `solve`, which solves one that is changed; whether it did.
    pub(super) fn solve(
        &mut self,
        problem: &mut Problem,
        mut solve: impl FnMut(&mut Problem) -> bool,
    ) -> bool {
        let size = problem.size();
        self.q.copy_from_slice(&problem.q);
        for i in 0..size {
            self.diagonal[i] = problem.w[i * (size + 1)];
        }
        let mean = self.diagonal.iter().sum::<f64>() / size as f64;
        let mut share = SHARE;
        let mut found = false;
        for _ in 0..ITERATIONS {
            let added = share * mean;
            for i in 0..size {
                problem.w[i * (size + 1)] = self.diagonal[i] + added;
                problem.q[i] = self.q[i] - added * (problem.r[i] - problem.anchor[i]);
            }
            problem.find_scales();
            let solved = solve(problem);
            for i in 0..size {
                problem.w[i * (size + 1)] = self.diagonal[i];
            }
            problem.q.copy_from_slice(&self.q);
            problem.find_scales();
            share *= if solved { 0.5 } else { 3.0 };
            found = problem.is_solved();
            if found || !share.is_finite() {
                break;
            }
        }
        found
    }
}
