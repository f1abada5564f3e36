//! Solutions on the curves of laws whose pressure grows with the settlement.
//!
//! The laws are linearised at trial settlements, as in [`linearisation`](crate::contact::linearisation).

use super::newton::falls_fast;
use super::problem::{RELATIVE_RESIDUAL_TOLERANCE, SolveOutcome};
use super::read::{ROUNDING_ERROR, bounds};
use super::{BOND_BREAKING_GAP, ForceSearch};
use crate::contact::SearchMethod;
use crate::contact::linearisation::{Linearisation, TangentSolution, point_on_curve};
use crate::contact::problem::ContactInput;
use crate::error::{LawError, StepError};
use crate::interface::Mode;

/// Error of an accepted solution, relative to the residual at which it is accepted.
const SOLUTION_ERROR_FACTOR: f64 = 10.0;
/// Largest number of iterations in which forces and tangents change together.
const MAX_JOINT_ITERATIONS: usize = 8;

impl ForceSearch {
    /// Linearises the laws at the settlements that each element alone would have under its present force.
    pub(super) fn predict_settlements(&mut self, input: &ContactInput<'_>) -> Result<(), LawError> {
        self.trial_settlements.fill(0.0);
        self.set_initial_forces(input);
        self.problem.update_displacements();
        for e in 0..self.areas.len() {
            if self.problem.bounds[e].hardening > 0.0 {
                let solution =
                    TangentSolution { yields: true, ..self.tangent_solution(input, e, 0.0) };
                let begin = solution.settlement.max(0.0);
                let limits = input.limits(e, begin)?;
                let point = point_on_curve(input, &solution, limits)?;
                self.trial_settlements[e] = point.settlement;
                self.linearise(input, e)?;
            }
        }
        Ok(())
    }

    /// Solution of an element in its present status.
    ///
    /// `residual`: error of its force, and of its gap times ρ, N.
    pub(super) fn tangent_solution(
        &self,
        input: &ContactInput<'_>,
        e: usize,
        residual: f64,
    ) -> TangentSolution {
        let Self { problem, newton, areas, .. } = self;
        let area = areas[e];
        let [stiffness, _] = problem.rho[e];
        let length_rounding = ROUNDING_ERROR * input.length_scale;
        TangentSolution {
            element: e,
            pressure: problem.force(e) / area,
            settlement: problem.bounds[e].closed_gap - problem.y[e],
            yields: newton.statuses[e].is_yield(),
            stiffness: stiffness / area,
            pressure_rounding: residual / area,
            settlement_rounding: length_rounding + residual / stiffness,
        }
    }

    /// Replaces the pressure of yielding soil by the tangent at the element's trial settlement.
    pub(super) fn linearise(&mut self, input: &ContactInput<'_>, e: usize) -> Result<(), LawError> {
        let tangent = bounds(&input.limits(e, self.trial_settlements[e])?, self.areas[e]);
        let bounds = &mut self.problem.bounds[e];
        bounds.interval[1] = tangent.interval[1];
        bounds.hardening = tangent.hardening;
        Ok(())
    }

    /// Solves with other tangents until the pressures are on the curves of their laws.
    ///
    /// `first_method`: of the present forces, up to [`TANGENT_TOLERANCE`].
    pub(super) fn follow_curves(
        &mut self,
        input: &ContactInput<'_>,
        first_method: SearchMethod,
        modes: &mut [Mode],
        trials: &mut usize,
    ) -> Result<SearchMethod, StepError> {
        let mut method = first_method;
        let mut is_exact = false;
        self.problem.relative_tolerance = RELATIVE_RESIDUAL_TOLERANCE;
        let gap = BOND_BREAKING_GAP * input.length_scale;
        // Sweeps with a near field take less time than Newton's method.
        if self.problem.form.near_field().is_none() {
            let outcome = self.solve_with_tangents(input)?;
            if outcome.iterations > 0 {
                *trials += outcome.iterations;
                method = method.max(SearchMethod::Newton);
                self.write_modes(modes);
            }
            if outcome.is_solved {
                if !self.break_bonds(gap) {
                    return Ok(method);
                }
                method = method.max(self.solve_again(input, trials)?);
                self.write_modes(modes);
                is_exact = true;
            }
        }
        let mut linearisation = Linearisation::new();
        loop {
            let has_moved = self.move_tangents(input, &mut linearisation)?;
            let is_solved = !has_moved && (is_exact || self.problem.is_solved());
            if is_solved && (is_exact || !self.break_bonds(gap)) {
                return Ok(method);
            }
            linearisation.is_done()?;
            let found = self.solve_again(input, trials)?;
            method = method.max(found);
            self.write_modes(modes);
            is_exact = true;
        }
    }

    /// Moves the tangents after each iteration of Newton's method, while the residual falls fast.
    ///
    /// Forces and tangents then converge together. Where they do not, the forces are the first ones again.
    fn solve_with_tangents(&mut self, input: &ContactInput<'_>) -> Result<SolveOutcome, StepError> {
        let mut linearisation = Linearisation::new();
        let mut previous_residual = f64::INFINITY;
        self.limited_change.copy_from_slice(&self.problem.force_change);
        let mut iterations = 0;
        while iterations < MAX_JOINT_ITERATIONS {
            // Tangents do not move to forces far from a solution.
            let residual = self.problem.max_residual();
            let is_near = residual <= self.problem.tolerance();
            if !(is_near || falls_fast(residual, previous_residual)) {
                break;
            }
            let has_moved = self.move_tangents(input, &mut linearisation)?;
            let Self { problem, newton, .. } = self;
            let residual = problem.max_residual();
            if !has_moved && residual <= problem.tolerance() {
                return Ok(SolveOutcome::new(iterations, true));
            }
            iterations += 1;
            if !newton.iterate(problem, residual, previous_residual) {
                break;
            }
            problem.update_displacements();
            newton.classify(problem, false);
            previous_residual = residual;
        }
        let Self { problem, newton, limited_change, .. } = self;
        problem.force_change.copy_from_slice(limited_change);
        problem.update_displacements();
        newton.classify(problem, false);
        Ok(SolveOutcome::new(iterations, false))
    }

    /// Moves the tangents towards the present forces; returns whether any has moved.
    ///
    /// A tangent stays where the force is near enough to the curve of its law.
    fn move_tangents(
        &mut self,
        input: &ContactInput<'_>,
        linearisation: &mut Linearisation,
    ) -> Result<bool, LawError> {
        linearisation.begin();
        let mut has_moved = false;
        let residual = SOLUTION_ERROR_FACTOR * self.problem.tolerance();
        for e in 0..self.areas.len() {
            let settlement = self.trial_settlements[e];
            let hardens = self.problem.bounds[e].hardening > 0.0;
            if settlement > 0.0 || hardens && self.newton.statuses[e].is_yield() {
                let solution = self.tangent_solution(input, e, residual);
                if let Some(next) = linearisation.compare(input, &solution, settlement)? {
                    self.trial_settlements[e] = next.settlement;
                    self.linearise(input, e)?;
                    has_moved = true;
                }
            }
        }
        Ok(has_moved)
    }

    /// Finds forces by Newton's method from a solution whose bounds have changed a little.
    fn solve_again(
        &mut self,
        input: &ContactInput<'_>,
        trials: &mut usize,
    ) -> Result<SearchMethod, StepError> {
        let Self { problem, newton, .. } = self;
        // Sweeps with a near field take less time.
        if problem.form.near_field().is_none() {
            let outcome = newton.solve_again(problem);
            *trials += outcome.iterations;
            if outcome.is_solved {
                newton.classify(problem, false);
                if !self.break_bonds(BOND_BREAKING_GAP * input.length_scale) {
                    return Ok(SearchMethod::Newton);
                }
            } else {
                self.set_initial_forces(input);
            }
        }
        self.search_forces(input, trials)
    }
}
