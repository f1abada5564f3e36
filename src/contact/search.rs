//! Search for the contact modes of a step.
//!
//! 1. Active set: solve for the modes, determine the next mode of every law, repeat (the flow chart in the Appendix of
//!    Patel & Spyrakos; a primal–dual active set method, Hüeber, Stadler & Wohlmuth 2008).
//! 2. If a set of modes occurs again: Gauss–Seidel over the elements. Each element is solved exactly by trying its
//!    modes
//!    with the other tractions fixed. Then all elements are solved together in the resulting modes.
//! 3. If Gauss–Seidel does not converge: follow the solution from a load under which every element is open, or every
//!    element is closed, one change of mode at a time (see [`super::path`]).
//! 4. If the path does not reach the solution, and there are few elements: try all sets of modes.
//!
//! Laws with bonds that break are not monotone, so these methods could cycle between broken and intact bonds. Bonds
//! therefore stay intact within a method, and break between solutions. After each solution those bonds break whose
//! overload is at least half of the largest, until no bond is overloaded. Each problem is then one of Coulomb friction
//! with some elements that stick, and there are at most as many problems as bonds. If one of these problems has no
//! solution, all bonds break. Where friction alone lets an element stick, its bond carries less than its strength, so
//! the solution without bonds satisfies the law, too.

use std::cell::Cell;

use super::element::local_mode;
use super::fixed_modes::ContactModeSolver;
use super::linearisation::Linearisation;
use super::path::Path;
use super::problem::{Bond, ContactInput, LawResult};
use super::trial_line::{LineMotion, TrialLine};
use super::{ContactSearch, SearchMethod};
use crate::error::StepError;
use crate::interface::Mode;

/// Largest number of trials of the active set; a search that needs more counts as cycling.
const ACTIVE_SET_TRIALS: usize = 60;
/// Largest number of Gauss–Seidel sweeps; then the search follows paths.
const MAX_SWEEPS: usize = 400;
/// Largest number of paths.
///
/// At infinite friction, one run in 5000 has a step that needs more than eight paths, and one in 100 000 a step that
/// needs more than sixty. These runs have time steps in which waves cross 13 to 60 elements (c₁Δt/l).
const MAX_PATHS: usize = 128;
/// Largest number of sets of modes that an enumeration tries.
const MAX_MODE_SETS: usize = 1 << 16;
/// Smallest overload of a bond that breaks, relative to the largest.
///
/// Mirror images then break together in spite of rounding.
const BREAKING_OVERLOAD_RATIO: f64 = 0.5;

/// Search for the modes of a step in the plane.
pub(crate) struct ModeSearch {
    /// Solver for prescribed modes; it stores the solution of a search.
    pub(super) solver: ContactModeSolver,
    /// Sets of modes that the active set has tried.
    visited_modes: Vec<Mode>,
    /// Modes that the laws require after a trial.
    next_modes: Vec<Mode>,
    /// Modes before a sweep.
    previous_modes: Vec<Mode>,
    path: Path,
    bonds: Vec<Bond>,
    overloads: Vec<f64>,
    /// Lines in place of the curves of the laws.
    trial_lines: Vec<Cell<TrialLine>>,
    /// Number of trials of this search so far.
    trials: usize,
    /// Number of all sets of modes, if the last search tried all of them without success.
    rejected_set_count: Option<usize>,
    method: ContactSearch,
}

impl ModeSearch {
    /// Search for the modes of `count` elements.
    pub(super) fn new(count: usize, method: ContactSearch) -> Self {
        Self {
            solver: ContactModeSolver::new(count),
            visited_modes: Vec::with_capacity(count * ACTIVE_SET_TRIALS),
            next_modes: vec![Mode::Stick; count],
            previous_modes: vec![Mode::Stick; count],
            path: Path::new(count),
            bonds: vec![Bond::Free; count],
            overloads: Vec::with_capacity(count),
            trial_lines: vec![Cell::new(TrialLine::default()); count],
            trials: 0,
            rejected_set_count: None,
            method,
        }
    }

    /// Finds admissible `modes` from their present values; the solver then stores the solution.
    ///
    /// Returns the number of trials and the method.
    pub(super) fn solve(
        &mut self,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> Result<(usize, SearchMethod), StepError> {
        self.trials = 0;
        self.solver.begin_step();
        // Laws with a single mode need no search: one solve, with the factors of the first step.
        let has_single_modes =
            modes.iter().enumerate().all(|(e, mode)| input.law(e).modes() == [*mode]);
        if has_single_modes && self.solver.solve_for_modes(input, modes)? {
            return Ok((1, SearchMethod::ActiveSet));
        }
        let trial_lines = std::mem::take(&mut self.trial_lines);
        for line in &trial_lines {
            line.take();
        }
        let linearised = ContactInput { trial_lines: &trial_lines, ..*input };
        let method = self.follow_curves(&linearised, modes);
        self.trial_lines = trial_lines;
        Ok((self.trials, method?))
    }

    /// Finds modes with all bonds intact, breaks the most overloaded bonds, and repeats.
    ///
    /// `None` if the search finds no modes without bonds either.
    fn break_bonds(
        &mut self,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
        bonds: &mut [Bond],
    ) -> LawResult<Option<SearchMethod>> {
        self.rejected_set_count = None;
        self.begin_with_intact_bonds(input, modes, bonds);
        let mut last_method = SearchMethod::ActiveSet;
        loop {
            let bonded_input = ContactInput { bonds, ..*input };
            let method = self.find_modes_with_bonds(&bonded_input, modes)?;
            let has_intact_bond = bonds.contains(&Bond::Intact);
            let Some(method) = method else {
                if !has_intact_bond {
                    return Ok(None);
                }
                for bond in bonds.iter_mut().filter(|bond| **bond == Bond::Intact) {
                    *bond = Bond::Broken;
                }
                continue;
            };
            last_method = last_method.max(method);
            if !has_intact_bond || !self.break_overloaded_bonds(input, bonds)? {
                return Ok(Some(last_method));
            }
        }
    }

    /// Sets `bonds`, and the modes of elements with an intact bond to their mode of rest.
    fn begin_with_intact_bonds(
        &self,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
        bonds: &mut [Bond],
    ) {
        bonds.fill(Bond::Free);
        if self.method != ContactSearch::Robust {
            return;
        }
        for (e, bond) in bonds.iter_mut().enumerate() {
            let law = input.law(e);
            if law.bond_overload(&input.start.element(e), input.start.state(e)).is_some() {
                *bond = Bond::Intact;
                modes[e] = law.modes()[0];
            }
        }
    }

    /// Breaks the most overloaded of the intact bonds in the last solution.
    ///
    /// `false` if none is overloaded.
    fn break_overloaded_bonds(
        &mut self,
        input: &ContactInput<'_>,
        bonds: &mut [Bond],
    ) -> LawResult<bool> {
        self.overloads.clear();
        for (e, state) in self.solver.response.states.iter().enumerate() {
            let is_intact = bonds[e] == Bond::Intact;
            let overload = if is_intact { input.overload(e, state)? } else { None };
            self.overloads.push(overload.unwrap_or(0.0));
        }
        let max_overload = self.overloads.iter().copied().fold(0.0, f64::max);
        if max_overload <= self.solver.tolerance(input).traction {
            return Ok(false);
        }
        for (bond, overload) in bonds.iter_mut().zip(&self.overloads) {
            if *overload >= BREAKING_OVERLOAD_RATIO * max_overload {
                *bond = Bond::Broken;
            }
        }
        Ok(true)
    }

    /// Finds modes with the present bonds by one method after the other.
    fn find_modes_with_bonds(
        &mut self,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> LawResult<Option<SearchMethod>> {
        if self.active_set(input, modes)? {
            return Ok(Some(SearchMethod::ActiveSet));
        }
        if self.method != ContactSearch::Robust {
            return Ok(None);
        }
        if self.gauss_seidel(input, modes)? {
            return Ok(Some(SearchMethod::GaussSeidel));
        }
        let is_found = self.follow_paths(input, modes)? || self.enumerate(input, modes)?;
        Ok(is_found.then_some(SearchMethod::Path))
    }

    /// Tries all sets of modes, if there are at most [`MAX_MODE_SETS`].
    ///
    /// Returns whether one is admissible.
    fn enumerate(&mut self, input: &ContactInput<'_>, modes: &mut [Mode]) -> LawResult<bool> {
        let set_count =
            (0..modes.len()).try_fold(1, |sets: usize, e| sets.checked_mul(input.modes(e).len()));
        let Some(set_count) = set_count.filter(|count| *count <= MAX_MODE_SETS) else {
            return Ok(false);
        };
        for set in 0..set_count {
            let mut quotient = set;
            for (e, mode) in modes.iter_mut().enumerate() {
                let choices = input.modes(e);
                *mode = choices[quotient % choices.len()];
                quotient /= choices.len();
            }
            self.trials += 1;
            if self.are_admissible(input, modes)? {
                return Ok(true);
            }
        }
        // With intact bonds, the laws would allow more sets of modes.
        let has_no_bonds = input.bonds.iter().all(|bond| *bond == Bond::Free);
        self.rejected_set_count = has_no_bonds.then_some(set_count);
        Ok(false)
    }

    /// Error of a search that found no modes, or of a law.
    fn failure(&mut self, input: &ContactInput<'_>, modes: &[Mode]) -> StepError {
        match self.disagreement(input, modes) {
            Ok(residual) => {
                let modes = modes.iter().map(|mode| mode.word()).collect();
                let sets = self.rejected_set_count;
                StepError::Contact { iterations: self.trials, residual, modes, sets }
            }
            Err(error) => error.into(),
        }
    }

    /// Difference between the tractions of `modes` and of the laws' next modes, relative to the largest.
    ///
    /// Returns 1 if either set of modes is singular.
    fn disagreement(&mut self, input: &ContactInput<'_>, modes: &[Mode]) -> LawResult<f64> {
        if !self.solver.solve_for_modes(input, modes)? {
            return Ok(1.0);
        }
        self.update_next_modes(input, modes)?;
        let states = self.solver.response.states.clone();
        if !self.solver.solve_for_modes(input, &self.next_modes)? {
            return Ok(1.0);
        }
        let mut max_traction = f64::MIN_POSITIVE;
        let mut max_difference = 0.0_f64;
        for (a, b) in states.iter().zip(&self.solver.response.states) {
            for (a, b) in [(a.pressure, b.pressure), (a.shear, b.shear)] {
                max_traction = max_traction.max(a.abs()).max(b.abs());
                max_difference = max_difference.max((a - b).abs());
            }
        }
        Ok(max_difference / max_traction)
    }

    /// Whether the solution for `modes` exists and satisfies the laws.
    fn are_admissible(&mut self, input: &ContactInput<'_>, modes: &[Mode]) -> LawResult<bool> {
        Ok(self.solver.solve_for_modes(input, modes)? && self.update_next_modes(input, modes)?)
    }

    /// Updates the next modes of all elements after a trial.
    ///
    /// Returns whether all equal `modes`.
    fn update_next_modes(&mut self, input: &ContactInput<'_>, modes: &[Mode]) -> LawResult<bool> {
        let tolerance = self.solver.tolerance(input);
        let mut is_admissible = true;
        for (e, &mode) in modes.iter().enumerate() {
            let state = &self.solver.response.states[e];
            self.next_modes[e] = input.next_mode(e, mode, state, tolerance)?;
            is_admissible &= self.next_modes[e] == mode;
        }
        Ok(is_admissible)
    }

    /// Replaces modes by the next modes of the laws until they stay the same.
    ///
    /// Returns `false` if a set of modes occurs again, a set is singular, or there are too many trials.
    fn active_set(&mut self, input: &ContactInput<'_>, modes: &mut [Mode]) -> LawResult<bool> {
        self.visited_modes.clear();
        let max_trials = match self.method {
            ContactSearch::Robust => ACTIVE_SET_TRIALS,
            ContactSearch::FlowChart { iterations } => iterations,
        };
        let mut linearisation = Linearisation::new();
        for _ in 0..max_trials {
            self.trials += 1;
            if !self.solver.solve_for_modes(input, modes)? {
                return Ok(false);
            }
            let mut is_admissible = self.update_next_modes(input, modes)?;
            let mut motion = self.move_tangents(input, modes, &mut linearisation)?;
            if is_admissible && motion == LineMotion::Shifted {
                motion = self.correct(input, modes, &mut linearisation)?;
                is_admissible = self.update_next_modes(input, modes)?;
            }
            if motion != LineMotion::None {
                // Other tangents make another problem, in which the same modes may occur again.
                self.begin_lines(input, modes);
                modes.copy_from_slice(&self.next_modes);
                self.visited_modes.clear();
                continue;
            }
            if is_admissible {
                return Ok(true);
            }
            self.visited_modes.extend_from_slice(modes);
            self.begin_lines(input, modes);
            modes.copy_from_slice(&self.next_modes);
            if self.visited_modes.chunks_exact(modes.len()).any(|visited| visited == modes) {
                return Ok(false);
            }
        }
        Ok(false)
    }

    /// Follows paths, and starts the active set at the end of each.
    fn follow_paths(&mut self, input: &ContactInput<'_>, modes: &mut [Mode]) -> LawResult<bool> {
        for attempt in 0..MAX_PATHS {
            self.trials += self.path.follow(&mut self.solver, input, attempt, modes)?;
            // A path that ends early often ends near the solution.
            if self.active_set(input, modes)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Sweeps over the elements from zero changes of traction, until their modes are admissible.
    fn gauss_seidel(&mut self, input: &ContactInput<'_>, modes: &mut [Mode]) -> LawResult<bool> {
        self.solver.response.traction.fill(0.0);
        self.solver.response.evaluate(input);
        self.previous_modes.copy_from_slice(modes);
        let mut next_trial = 1;
        for sweep in 1..=MAX_SWEEPS {
            self.trials += 1;
            for e in 0..modes.len() {
                modes[e] = local_mode(&mut self.solver.response, input, e, modes[e])?;
            }
            // Modes that stay the same in a sweep are solved for together; the interval doubles after each failure.
            if modes == self.previous_modes.as_slice() && sweep >= next_trial {
                if self.are_admissible(input, modes)? {
                    return Ok(true);
                }
                next_trial = 2 * sweep;
            }
            self.previous_modes.copy_from_slice(modes);
        }
        Ok(false)
    }
}

mod curves;
#[cfg(test)]
mod tests;
