//! Search for the contact modes of a step.
//!
//! 1. Active set: solve for the modes, take the next mode of every law, repeat (the flow chart of Patel &
//!    Spyrakos' Appendix; a primal–dual active set method, Hüeber, Stadler & Wohlmuth 2008).
//! 2. If a set of modes occurs again: Gauss–Seidel over the elements. Each element is solved exactly by
//!    trying its modes with the other tractions fixed; then the modes found are solved together.
//! 3. If Gauss–Seidel does not converge: follow the solution from a load under which every element is open,
//!    one change of mode at a time (see [`super::path`]).
//! 4. If the path does not reach the solution, and there are few elements: try all sets of modes.
//!
//! Laws with bonds that break are not monotone, and these methods may return to bonds that they have broken.
//! All methods therefore keep bonds intact, and bonds break between their solutions. Each time, those bonds
//! break whose overload is at least half of the largest, until no bond is overloaded. Each problem is then
//! one of Coulomb friction with some elements that stick, and there are at most as many problems as bonds. If
//! one of these problems is not solved, all bonds break. Where friction alone lets an element stick, its bond
//! carries less than its strength, so the solution without bonds satisfies the law, too.

use super::cone::Cone;
use super::element::local_mode;
use super::path::Path;
use super::problem::{Bond, ContactInput, ContactSolver};
use super::{ContactSearch, SearchMethod};
use crate::error::StepError;
use crate::geometry::ContactLayout;
use crate::interface::Mode;

/// Number of trials after which the active set counts as cycling.
const ACTIVE_SET_TRIALS: usize = 60;
/// Largest number of Gauss–Seidel sweeps.
const MAX_SWEEPS: usize = 400;
/// Largest number of paths. At infinite friction and c₁Δt/l from 13 to 60, one run in 5000 has a step that
/// needs more than eight paths, and one in 100 000 a step that needs more than sixty.
const MAX_PATHS: usize = 128;
/// Largest number of sets of modes for which all are tried.
const MAX_MODE_SETS: usize = 1 << 16;
/// Bonds break together if their overload is at least this fraction of the largest. Mirror images then break
/// together in spite of rounding.
const BREAKING_OVERLOAD_RATIO: f64 = 0.5;

/// Workspace of the mode search.
pub(crate) struct ModeSearch {
    visited: Vec<Mode>,
    next: Vec<Mode>,
    before: Vec<Mode>,
    path: Path,
    bonds: Vec<Bond>,
    overloads: Vec<f64>,
    /// Number of trials of this search so far.
    trials: usize,
    /// Number of all sets of modes, if the last search tried all of them without success.
    sets: Option<usize>,
    search: ContactSearch,
    /// Search for forces, in plan.
    cone: Option<Box<Cone>>,
}

impl ModeSearch {
    /// Search for elements with these areas (m²), under a structure that `is_linear` or not; a ground in the plane needs
    /// neither.
    pub(crate) fn new(
        layout: ContactLayout,
        areas: &[f64],
        is_linear: bool,
        search: ContactSearch,
    ) -> Self {
        let cone = layout.is_plan().then(|| Box::new(Cone::new(areas, is_linear)));
        let count = cone.as_ref().map_or(layout.elements(), |_| 0);
        Self {
            cone,
            search,
            visited: Vec::with_capacity(count * ACTIVE_SET_TRIALS),
            next: vec![Mode::Stick; count],
            before: vec![Mode::Stick; count],
            path: Path::new(count),
            bonds: vec![Bond::Free; count],
            overloads: Vec::with_capacity(count),
            trials: 0,
            sets: None,
        }
    }

    /// Finds admissible `modes`, starting from their present values; the solver then holds the solution.
    ///
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

    /// Searches the modes for [`ModeSearch::solve`]; the solver stores the error of a law.
    fn find(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> Result<(usize, SearchMethod), StepError> {
        if let Some(cone) = &mut self.cone {
            return cone.solve(solver, input, modes);
        }
        self.trials = 0;
        // Laws with a single mode need no search: one solve, with the factors of the first step.
        let bonded = modes.iter().enumerate().all(|(e, mode)| input.law(e).modes() == [*mode]);
        if bonded && solver.trial(input, modes) {
            return Ok((1, SearchMethod::ActiveSet));
        }
        let mut bonds = std::mem::take(&mut self.bonds);
        let found = self.break_bonds(solver, input, modes, &mut bonds);
        self.bonds = bonds;
        found.map(|m| (self.trials, m)).ok_or_else(|| self.failure(solver, input, modes))
    }

    /// Finds modes with all bonds intact, breaks the most overloaded bonds, and repeats.
    ///
    /// `None` if no modes are found without bonds either.
    fn break_bonds(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
        bonds: &mut [Bond],
    ) -> Option<SearchMethod> {
        self.sets = None;
        bonds.fill(Bond::Free);
        if self.search == ContactSearch::Robust {
            for (e, bond) in bonds.iter_mut().enumerate() {
                let overload =
                    input.law(e).bond_overload(&input.start.element(e), input.start.state(e));
                if overload.is_some() {
                    *bond = Bond::Intact;
                    modes[e] = input.law(e).modes()[0];
                }
            }
        }
        let mut last_method = SearchMethod::ActiveSet;
        loop {
            let found =
                self.find_modes_with_bonds(solver, &ContactInput { bonds, ..*input }, modes);
            if solver.fault.is_some() || found.is_none() && !bonds.contains(&Bond::Intact) {
                return None;
            }
            let Some(method) = found else {
                for bond in bonds.iter_mut().filter(|bond| **bond == Bond::Intact) {
                    *bond = Bond::Broken;
                }
                continue;
            };
            last_method = last_method.max(method);
            if !bonds.contains(&Bond::Intact) {
                return Some(last_method);
            }
            let tolerance = solver.tolerance(input).traction;
            self.overloads.clear();
            for (e, state) in solver.states.iter().enumerate() {
                let is_intact = bonds[e] == Bond::Intact;
                match if is_intact { input.overload(e, state) } else { Ok(None) } {
                    Ok(overload) => self.overloads.push(overload.unwrap_or(0.0)),
                    Err(fault) => {
                        solver.fault = Some(fault);
                        return None;
                    }
                }
            }
            let largest = self.overloads.iter().copied().fold(0.0, f64::max);
            if largest <= tolerance {
                return Some(last_method);
            }
            for (bond, overload) in bonds.iter_mut().zip(&self.overloads) {
                if *overload >= BREAKING_OVERLOAD_RATIO * largest {
                    *bond = Bond::Broken;
                }
            }
        }
    }

    /// Finds modes with the present bonds, by one method after the other.
    fn find_modes_with_bonds(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> Option<SearchMethod> {
        if self.active_set(solver, input, modes) {
            return Some(SearchMethod::ActiveSet);
        }
        if self.search != ContactSearch::Robust || solver.fault.is_some() {
            return None;
        }
        if self.gauss_seidel(solver, input, modes) {
            return Some(SearchMethod::GaussSeidel);
        }
        let mut found = solver.fault.is_none() && self.along_path(solver, input, modes);
        found |= solver.fault.is_none() && !found && self.enumerate(solver, input, modes);
        found.then_some(SearchMethod::Path)
    }

    /// Tries all sets of modes, if there are at most [`MAX_MODE_SETS`].
    fn enumerate(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> bool {
        let sets =
            (0..modes.len()).try_fold(1, |sets: usize, e| sets.checked_mul(input.modes(e).len()));
        let Some(sets) = sets.filter(|sets| *sets <= MAX_MODE_SETS) else { return false };
        for set in 0..sets {
            let mut rest = set;
            for (e, mode) in modes.iter_mut().enumerate() {
                let choices = input.modes(e);
                *mode = choices[rest % choices.len()];
                rest /= choices.len();
            }
            self.trials += 1;
            if solver.trial(input, modes) && self.update_next_modes(solver, input, modes) {
                return true;
            }
            if solver.fault.is_some() {
                return false;
            }
        }
        // With bonds that were broken, the laws allow more sets of modes.
        self.sets = input.bonds.iter().all(|bond| *bond == Bond::Free).then_some(sets);
        false
    }

    fn failure(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &[Mode],
    ) -> StepError {
        let residual = self.disagreement(solver, input, modes);
        let modes = modes.iter().map(|mode| mode.word()).collect();
        StepError::Contact { iterations: self.trials, residual, modes, sets: self.sets }
    }

    /// Difference between the tractions of `modes` and of the laws' next modes, relative to the largest.
    ///
    /// Returns 1 if either set of modes is singular.
    fn disagreement(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &[Mode],
    ) -> f64 {
        if !solver.trial(input, modes) {
            return 1.0;
        }
        self.update_next_modes(solver, input, modes);
        let before = solver.states.clone();
        if !solver.trial(input, &self.next) {
            return 1.0;
        }
        let mut largest = f64::MIN_POSITIVE;
        let mut largest_difference = 0.0_f64;
        for (a, b) in before.iter().zip(&solver.states) {
            for (a, b) in [(a.pressure, b.pressure), (a.shear, b.shear)] {
                largest = largest.max(a.abs()).max(b.abs());
                largest_difference = largest_difference.max((a - b).abs());
            }
        }
        largest_difference / largest
    }

    /// Updates the next modes of all elements; returns whether all equal `modes`.
    fn update_next_modes(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &[Mode],
    ) -> bool {
        let tolerance = solver.tolerance(input);
        let mut is_admissible = true;
        for (e, &mode) in modes.iter().enumerate() {
            match input.next_mode(e, mode, &solver.states[e], tolerance) {
                Ok(next) => self.next[e] = next,
                Err(fault) => {
                    solver.fault = Some(fault);
                    return false;
                }
            }
            is_admissible &= self.next[e] == mode;
        }
        is_admissible
    }

    fn active_set(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> bool {
        self.visited.clear();
        let max_trials = match self.search {
            ContactSearch::Robust => ACTIVE_SET_TRIALS,
            ContactSearch::FlowChart { iterations } => iterations,
        };
        for _ in 0..max_trials {
            self.trials += 1;
            if !solver.trial(input, modes) {
                return false;
            }
            if self.update_next_modes(solver, input, modes) {
                return true;
            }
            if solver.fault.is_some() {
                return false;
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
    ) -> bool {
        for attempt in 0..MAX_PATHS {
            self.trials += self.path.follow(solver, input, attempt, modes);
            // Near the point where a path broke, the solution is often found by the active set.
            if self.active_set(solver, input, modes) {
                return true;
            }
            if solver.fault.is_some() {
                return false;
            }
        }
        false
    }

    fn gauss_seidel(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> bool {
        solver.traction.fill(0.0);
        solver.evaluate(input);
        self.before.copy_from_slice(modes);
        let mut wait = 1;
        for sweep in 1..=MAX_SWEEPS {
            self.trials += 1;
            for e in 0..modes.len() {
                modes[e] = local_mode(solver, input, e, modes[e]);
            }
            if solver.fault.is_some() {
                return false;
            }
            // Modes that stay the same for a sweep are tested by an exact solve; the wait grows after each
            // failure.
            if modes == self.before.as_slice() && sweep >= wait {
                if solver.trial(input, modes) && self.update_next_modes(solver, input, modes) {
                    return true;
                }
                wait = 2 * sweep;
            }
            self.before.copy_from_slice(modes);
        }
        false
    }
}

#[cfg(test)]
mod tests;
