//! Search for the contact modes of a step.
//!
//! 1. Active set: solve for the modes, let every law say its next mode, repeat (the flow chart of
//!    Patel & Spyrakos' Appendix; a primal–dual active set method, Hüeber, Stadler & Wohlmuth 2008).
//! 2. If a mode vector comes back: Gauss–Seidel over the elements, each solved exactly by trying
//!    its modes with the other tractions held, then the modes so found solved together.
//! 3. If that does not settle: follow the solution from a load under which every element is open,
//!    one change of mode at a time (see [`super::path`]).

use super::path::Path;
use super::problem::{ContactInput, ContactSolver};
use crate::error::StepError;
use crate::interface::{Condition, ContactState, Mode, Tolerance};

/// Trials of the active set before it counts as cycling.
const ACTIVE_SET_TRIALS: usize = 60;
/// Sweeps of Gauss–Seidel.
const SWEEPS: usize = 400;
/// Paths followed. At infinite friction and c₁Δt/l from 13 to 60 one run in 5000 has a step that
/// needs more than eight, one in 100 000 one that needs more than sixty.
const PATHS: usize = 128;

/// Search for the contact modes of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
#[non_exhaustive]
pub enum ContactSearch {
    /// Active set, then Gauss–Seidel, then path following: finds what there is to find.
    #[default]
    Robust,
    /// The flow chart in the Appendix of Patel & Spyrakos alone: assume the modes of the step
    /// before, solve, ask every element, change modes, repeat until nothing changes. Where it
    /// comes back to modes it has tried, or needs more than `iterations` of them, the step is an
    /// error.
    FlowChart {
        /// Solves per step, at most; one or more.
        iterations: usize,
    },
}

/// Method that found the modes of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum SearchMethod {
    /// The active set converged.
    ActiveSet,
    /// Gauss–Seidel with local enumeration was needed.
    GaussSeidel,
    /// The solution was followed from a known one.
    Path,
}

words! { SearchMethod, "search method", {
    ActiveSet = "active_set",
    GaussSeidel = "gauss_seidel",
    Path = "path",
} }

/// Memory of the mode search.
pub(crate) struct ModeSearch {
    visited: Vec<Mode>,
    next: Vec<Mode>,
    before: Vec<Mode>,
    path: Path,
    search: ContactSearch,
}

impl ModeSearch {
    pub(crate) fn new(count: usize, search: ContactSearch) -> Self {
        Self {
            search,
            visited: Vec::with_capacity(count * ACTIVE_SET_TRIALS),
            next: vec![Mode::Stick; count],
            before: vec![Mode::Stick; count],
            path: Path::new(count),
        }
    }

    /// Finds admissible `modes`, starting from those given; the solver then holds the solution.
    /// Returns the number of trials and the method.
    pub(crate) fn solve(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> Result<(usize, SearchMethod), StepError> {
        solver.fault = None;
        let found = self.find(solver, input, modes);
        match solver.fault.take() {
            Some(fault) => Err(fault.into()),
            None => found,
        }
    }

    /// As [`ModeSearch::solve`]; the solver knows whether a law was at fault.
    fn find(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> Result<(usize, SearchMethod), StepError> {
        let mut trials = 0;
        // Laws with a single mode skip the search: one solve, with factors made once.
        let bonded = modes.iter().enumerate().all(|(e, mode)| input.law(e).modes() == [*mode]);
        if bonded && solver.trial(input, modes) {
            return Ok((1, SearchMethod::ActiveSet));
        }
        if self.active_set(solver, input, modes, &mut trials) {
            return Ok((trials, SearchMethod::ActiveSet));
        }
        if self.search != ContactSearch::Robust || solver.fault.is_some() {
            return Err(self.failure(solver, input, modes, trials));
        }
        if self.gauss_seidel(solver, input, modes, &mut trials) {
            return Ok((trials, SearchMethod::GaussSeidel));
        }
        if solver.fault.is_none() && self.along_path(solver, input, modes, &mut trials) {
            return Ok((trials, SearchMethod::Path));
        }
        Err(self.failure(solver, input, modes, trials))
    }

    fn failure(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &[Mode],
        iterations: usize,
    ) -> StepError {
        let residual = self.disagreement(solver, input, modes);
        StepError::Contact { iterations, residual, modes: modes.to_vec() }
    }

    /// Distance of the tractions of `modes` from those of the modes that the laws ask for instead,
    /// relative to the largest; 1 if either set of modes is singular.
    fn disagreement(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &[Mode],
    ) -> f64 {
        if !solver.trial(input, modes) {
            return 1.0;
        }
        self.ask_laws(solver, input, modes);
        let before = solver.states.clone();
        if !solver.trial(input, &self.next) {
            return 1.0;
        }
        let (mut largest, mut apart) = (f64::MIN_POSITIVE, 0.0_f64);
        for (a, b) in before.iter().zip(&solver.states) {
            for (a, b) in [(a.pressure, b.pressure), (a.shear, b.shear)] {
                largest = largest.max(a.abs()).max(b.abs());
                apart = apart.max((a - b).abs());
            }
        }
        apart / largest
    }

    /// Next modes of all elements; whether all agree with `modes`.
    fn ask_laws(
        &mut self,
        solver: &ContactSolver,
        input: &ContactInput<'_>,
        modes: &[Mode],
    ) -> bool {
        let tolerance = solver.tolerance(input);
        let mut settled = true;
        for (e, &mode) in modes.iter().enumerate() {
            let trial = &solver.states[e];
            self.next[e] = input.next_mode(e, mode, trial, tolerance);
            settled &= self.next[e] == mode;
        }
        settled
    }

    fn active_set(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
        trials: &mut usize,
    ) -> bool {
        self.visited.clear();
        let most = match self.search {
            ContactSearch::Robust => ACTIVE_SET_TRIALS,
            ContactSearch::FlowChart { iterations } => iterations,
        };
        for _ in 0..most {
            *trials += 1;
            if !solver.trial(input, modes) {
                return false;
            }
            if self.ask_laws(solver, input, modes) {
                return true;
            }
            self.visited.extend_from_slice(modes);
            modes.copy_from_slice(&self.next);
            if self.visited.chunks_exact(modes.len()).any(|seen| seen == modes) {
                return false;
            }
        }
        false
    }

    fn along_path(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
        trials: &mut usize,
    ) -> bool {
        for attempt in 0..PATHS {
            self.path.follow(solver, input, attempt, modes, trials);
            // Where a path was lost, the solution is often near.
            if self.active_set(solver, input, modes, trials) {
                return true;
            }
        }
        false
    }

    fn gauss_seidel(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
        trials: &mut usize,
    ) -> bool {
        solver.traction.fill(0.0);
        solver.evaluate(input);
        self.before.copy_from_slice(modes);
        let mut wait = 1;
        for sweep in 1..=SWEEPS {
            *trials += 1;
            for e in 0..modes.len() {
                modes[e] = local_mode(solver, input, e, modes[e]);
            }
            if solver.fault.is_some() {
                return false;
            }
            // Modes that survive a sweep are worth an exact solve; wait longer after each failure.
            if modes == self.before.as_slice() && sweep >= wait {
                if solver.trial(input, modes) && self.ask_laws(solver, input, modes) {
                    return true;
                }
                wait = 2 * sweep;
            }
            self.before.copy_from_slice(modes);
        }
        false
    }
}

/// Solves element `e` alone, the tractions of the others held, and returns its mode.
fn local_mode(
    solver: &mut ContactSolver,
    input: &ContactInput<'_>,
    e: usize,
    current: Mode,
) -> Mode {
    let count = solver.states.len();
    let size = 2 * count;
    let (n, t) = (e, count + e);
    let row = |i: usize| &input.delassus[i * size..(i + 1) * size];
    let others = |i: usize| {
        let all: f64 = crate::linalg::dot(row(i), &solver.traction);
        input.free_jump[i] + all - row(i)[n] * solver.traction[n] - row(i)[t] * solver.traction[t]
    };
    let jump = [others(n), others(t)];
    let block = [[row(n)[n], row(n)[t]], [row(t)[n], row(t)[t]]];
    let fixed = [input.static_traction[n], input.static_traction[t]];
    let law = input.law(e);
    let scale = fixed[0].abs().max(jump[0].abs() / block[0][0].abs()).max(fixed[1].abs());
    let tolerance = Tolerance { length: 1e-13 * input.length_scale, traction: 1e-12 * scale };
    let candidates = std::iter::once(current).chain(law.modes().iter().copied());
    for mode in candidates {
        let conditions = match input.conditions(e, mode) {
            Ok(conditions) => conditions,
            Err(fault) => {
                solver.fault = Some(fault);
                return current;
            }
        };
        let Some(change) = solve_element(conditions, jump, block, fixed) else { continue };
        let gap = jump[0] + block[0][0] * change[0] + block[0][1] * change[1];
        let tangential = jump[1] + block[1][0] * change[0] + block[1][1] * change[1];
        let state = ContactState {
            gap,
            slip: -tangential,
            pressure: fixed[0] + change[0],
            shear: fixed[1] + change[1],
        };
        if input.next_mode(e, mode, &state, tolerance) == mode {
            solver.traction[n] = change[0];
            solver.traction[t] = change[1];
            solver.states[e] = state;
            return mode;
        }
    }
    current
}

/// The change of traction of one element from its two conditions; `None` if they are dependent.
fn solve_element(
    conditions: [Condition; 2],
    jump: [f64; 2],
    block: [[f64; 2]; 2],
    fixed: [f64; 2],
) -> Option<[f64; 2]> {
    let [[a, b, r], [c, d, s]] = conditions.map(|k| {
        [
            k.gap * block[0][0] - k.slip * block[1][0] + k.pressure,
            k.gap * block[0][1] - k.slip * block[1][1] + k.shear,
            k.value - k.gap * jump[0] + k.slip * jump[1]
                - k.pressure * fixed[0]
                - k.shear * fixed[1],
        ]
    });
    let determinant = a * d - b * c;
    let change = [(r * d - b * s) / determinant, (a * s - r * c) / determinant];
    (determinant != 0.0 && change.iter().all(|x| x.is_finite())).then_some(change)
}

#[cfg(test)]
#[path = "search_tests.rs"]
mod tests;
