//! Outcomes of the mode search for many problems.

use super::*;

/// Numbers of problems by outcome.
#[derive(Debug, Default)]
pub(super) struct Tally {
    pub(super) problems: usize,
    /// Numbers of problems that the search solved, by its last method: active set, Gauss–Seidel, path.
    pub(super) methods: [usize; 3],
    pub(super) trials: usize,
    /// Numbers of problems that active set, Gauss–Seidel and path each solved alone.
    pub(super) solved_alone: [usize; 3],
    /// Number of problems with several solutions.
    pub(super) multiple_solutions: usize,
    pub(super) multiple_with_strength: usize,
    /// Number of problems without a solution.
    pub(super) unsolvable: usize,
    /// Number of problems with a solution that the search did not find.
    pub(super) failed: usize,
    pub(super) failed_with_strength: usize,
    pub(super) max_violation: f64,
}

impl Tally {
    pub(super) fn add(&mut self, other: &Self) {
        self.problems += other.problems;
        self.trials += other.trials;
        for k in 0..3 {
            self.methods[k] += other.methods[k];
            self.solved_alone[k] += other.solved_alone[k];
        }
        self.multiple_solutions += other.multiple_solutions;
        self.multiple_with_strength += other.multiple_with_strength;
        self.unsolvable += other.unsolvable;
        self.failed += other.failed;
        self.failed_with_strength += other.failed_with_strength;
        self.max_violation = self.max_violation.max(other.max_violation);
    }

    /// Solves one problem by all methods.
    ///
    /// Returns the modes and states for the next step.
    pub(super) fn examine(&mut self, problem: &Problem) -> Option<(Vec<Mode>, Vec<ContactState>)> {
        let count = problem.start.len();
        let input = problem.input();
        let mut search = ModeSearch::new(count, ContactSearch::Robust);
        self.problems += 1;
        let solutions = brute_force(problem);
        let has_multiple_solutions = solution_count(&solutions) > 1;
        let has_solution = !solutions.is_empty();
        self.unsolvable += usize::from(!has_solution);
        let has_strength = problem.parameters.strength > 0.0;
        self.multiple_solutions += usize::from(has_multiple_solutions && !has_strength);
        self.multiple_with_strength += usize::from(has_multiple_solutions && has_strength);
        for (_, traction) in &solutions {
            self.max_violation = self.max_violation.max(problem.violation(traction));
        }
        let check = |search: &ModeSearch, modes: &[Mode]| {
            let is_solution = solutions.iter().any(|(solution_modes, _)| solution_modes == modes);
            assert!(is_solution, "{modes:?} is not among {solutions:?}");
            problem.violation(&search.solver.response.traction)
        };
        for method in 0..3 {
            search.solver.invalidate();
            let mut modes = problem.modes.clone();
            let is_solved = match method {
                0 => search.active_set(&input, &mut modes),
                1 => search.gauss_seidel(&input, &mut modes),
                _ => search.follow_paths(&input, &mut modes),
            };
            if is_solved.unwrap() {
                self.solved_alone[method] += 1;
                self.max_violation = self.max_violation.max(check(&search, &modes));
            }
        }
        search.solver.invalidate();
        let mut modes = problem.modes.clone();
        let Ok((trials, method)) = search.solve(&input, &mut modes) else {
            self.failed += usize::from(has_solution && !has_strength);
            self.failed_with_strength += usize::from(has_solution && has_strength);
            return None;
        };
        self.trials += trials;
        self.methods[method as usize] += 1;
        self.max_violation = self.max_violation.max(check(&search, &modes));
        Some((modes, search.solver.response.states))
    }
}
