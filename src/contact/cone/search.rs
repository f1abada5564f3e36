//! Search for the forces of a contact problem in space, by one method after the other.

use super::collective::solve_collectively;
use super::newton::Newton;
use super::problem::{ConeProblem, SUBSTITUTED_FRICTION, SolveOutcome};
use super::proximal::Proximal;
use crate::contact::SearchMethod;

/// Largest number of sweeps before Newton's method takes over.
const MAX_SWEEPS_PER_ROUND: usize = 60;
/// Largest number of rounds of sweeps and Newton's method.
const MAX_ROUNDS: usize = 12;
/// Changes at which Newton's method follows the accelerated sweeps of a round.
///
/// One for each round, relative to the largest force.
const CHANGES_BEFORE_NEWTON: [f64; 4] = [3e-3, 1e-5, 1e-8, 0.0];
/// The first of these changes on soil that hardens, where a Newton iteration takes little more time than a sweep.
const HARDENING_CHANGE_BEFORE_NEWTON: f64 = 3e-2;
/// Largest friction for which all methods are tried.
///
/// A search for higher friction begins with lower friction.
const MAX_DIRECT_FRICTION: f64 = 100.0;
/// Smallest friction with which such a search begins.
const MIN_FRICTION_LIMIT: f64 = 3.0;
/// Largest number of randomised restarts of Newton's method.
const MAX_RESTARTS: u64 = 60;
/// Largest number of restarts while friction is raised.
const MAX_RESTARTS_WHILE_RAISING: u64 = 12;
/// Largest number of restarts within the proximal point method.
const MAX_RESTARTS_WITHIN_PROXIMAL: u64 = 4;
/// Smallest factor by which friction is raised.
const MIN_FRICTION_FACTOR: f64 = 1.2;
/// Upper bound of a factor that failed, before its square root replaces it.
///
/// The first factor is infinite.
const MAX_FAILED_FACTOR: f64 = 100.0;

/// Number of iterations of a search, and the last method used.
///
/// There is no method if no solution was found.
pub(super) struct SearchOutcome {
    pub(super) iterations: usize,
    pub(super) method: Option<SearchMethod>,
}

impl SearchOutcome {
    /// Outcome of a search whose last method ended with `outcome`, after `iterations` in all.
    fn with_method(method: SearchMethod, outcome: SolveOutcome, iterations: usize) -> Self {
        Self { iterations, method: outcome.is_solved.then_some(method) }
    }
}

/// Finds forces by one method after the other, with `initial_change` and `limited_change` as scratch.
///
/// If Newton's method alone finds no forces for a friction above [`MAX_DIRECT_FRICTION`], the search limits the friction,
/// and raises it from that solution as far as possible. `is_constant`: whether W is constant for the whole run.
pub(super) fn find_forces(
    problem: &mut ConeProblem,
    newton: &mut Newton,
    proximal: &mut Proximal,
    initial_change: &mut [f64],
    limited_change: &mut [f64],
    is_constant: bool,
) -> SearchOutcome {
    initial_change.copy_from_slice(&problem.force_change);
    problem.limit_friction(f64::INFINITY);
    let max_friction = problem.bounds.iter().fold(0.0_f64, |max, bounds| max.max(bounds.friction));
    if max_friction <= MAX_DIRECT_FRICTION {
        return search_by_all_methods(problem, newton, proximal, initial_change, is_constant);
    }
    let outcome = newton.solve(problem, false);
    let mut iterations = outcome.iterations;
    if outcome.is_solved {
        return SearchOutcome::with_method(SearchMethod::Newton, outcome, iterations);
    }
    // The largest friction with a solution, and the method that found it.
    let mut best: Option<(f64, SearchMethod)> = None;
    for friction_limit in
        [SUBSTITUTED_FRICTION, MAX_DIRECT_FRICTION, 0.1 * MAX_DIRECT_FRICTION, MIN_FRICTION_LIMIT]
    {
        problem.limit_friction(friction_limit);
        problem.force_change.copy_from_slice(initial_change);
        let is_last = friction_limit == MIN_FRICTION_LIMIT && best.is_none();
        let outcome = if friction_limit == MAX_DIRECT_FRICTION || is_last {
            search_by_all_methods(problem, newton, proximal, initial_change, is_constant)
        } else {
            alternate_sweeps_and_newton(problem, newton)
        };
        iterations += outcome.iterations;
        let Some(method) = outcome.method else { continue };
        let method = method.max(SearchMethod::Newton);
        iterations += raise_friction_limit(problem, newton, initial_change, max_friction);
        let raised_limit = problem.bounds[0].friction_limit;
        if raised_limit >= MAX_DIRECT_FRICTION {
            return SearchOutcome { iterations, method: Some(method) };
        }
        if best.is_none_or(|(best_limit, _)| raised_limit > best_limit) {
            best = Some((raised_limit, method));
            limited_change.copy_from_slice(&problem.force_change);
        }
    }
    let Some((friction_limit, method)) = best else {
        return SearchOutcome { iterations, method: None };
    };
    problem.limit_friction(friction_limit);
    problem.force_change.copy_from_slice(limited_change);
    problem.update_displacements();
    SearchOutcome { iterations, method: Some(method) }
}

/// Raises the friction limit from a solution towards `max_friction`; returns the number of iterations.
///
/// Where a factor fails, it tries smaller ones.
fn raise_friction_limit(
    problem: &mut ConeProblem,
    newton: &mut Newton,
    solved_change: &mut [f64],
    max_friction: f64,
) -> usize {
    let mut friction_limit = problem.bounds[0].friction_limit;
    let mut factor = f64::INFINITY;
    let mut iterations = 0;
    solved_change.copy_from_slice(&problem.force_change);
    while friction_limit < max_friction && factor > MIN_FRICTION_FACTOR {
        problem.limit_friction(friction_limit * factor);
        let mut outcome = newton.solve(problem, false);
        iterations += outcome.iterations;
        if !outcome.is_solved {
            outcome = newton.restart_randomly(problem, solved_change, MAX_RESTARTS_WHILE_RAISING);
            iterations += outcome.iterations;
        }
        if outcome.is_solved {
            friction_limit *= factor;
            factor = f64::INFINITY;
            solved_change.copy_from_slice(&problem.force_change);
        } else {
            problem.force_change.copy_from_slice(solved_change);
            factor = factor.min(MAX_FAILED_FACTOR).sqrt();
        }
    }
    problem.limit_friction(friction_limit);
    problem.update_displacements();
    iterations
}

/// Finds forces by one method after the other, with the present friction limit.
fn search_by_all_methods(
    problem: &mut ConeProblem,
    newton: &mut Newton,
    proximal: &mut Proximal,
    initial_change: &mut [f64],
    is_constant: bool,
) -> SearchOutcome {
    let mut iterations = 0;
    if problem.form.low_rank().is_some() {
        // Newton's iterations take no more time than sweeps here, and converge for stiff structures, too.
        let outcome = newton.solve(problem, false);
        iterations += outcome.iterations;
        if outcome.is_solved {
            return SearchOutcome::with_method(SearchMethod::Newton, outcome, iterations);
        }
        problem.force_change.copy_from_slice(initial_change);
    }
    let outcome = alternate_sweeps_and_newton(problem, newton);
    iterations += outcome.iterations;
    if outcome.method.is_some() {
        return SearchOutcome { iterations, ..outcome };
    }
    if problem.has_pressure_cap() {
        let outcome = solve_collectively(problem, newton);
        iterations += outcome.iterations;
        if outcome.is_solved {
            return SearchOutcome::with_method(SearchMethod::Newton, outcome, iterations);
        }
    }
    let outcome = newton.restart_randomly(problem, initial_change, MAX_RESTARTS);
    iterations += outcome.iterations;
    if outcome.is_solved {
        return SearchOutcome::with_method(SearchMethod::Newton, outcome, iterations);
    }
    problem.force_change.copy_from_slice(initial_change);
    let is_solved = proximal.solve(problem, |problem| {
        newton.invalidate(false);
        initial_change.copy_from_slice(&problem.force_change);
        let outcome = alternate_sweeps_and_newton(problem, newton);
        iterations += outcome.iterations;
        if outcome.method.is_some() {
            return true;
        }
        let outcome =
            newton.restart_randomly(problem, initial_change, MAX_RESTARTS_WITHIN_PROXIMAL);
        iterations += outcome.iterations;
        outcome.is_solved
    });
    newton.invalidate(is_constant);
    SearchOutcome { iterations, method: is_solved.then_some(SearchMethod::Proximal) }
}

/// Alternates between sweeps and Newton's method.
fn alternate_sweeps_and_newton(problem: &mut ConeProblem, newton: &mut Newton) -> SearchOutcome {
    if problem.acceleration.is_some() {
        return alternate_accelerated_sweeps_and_newton(problem, newton);
    }
    let mut iterations = 0;
    for round in 0..MAX_ROUNDS {
        let outcome = problem.sweep(MAX_SWEEPS_PER_ROUND);
        iterations += outcome.iterations;
        if outcome.is_solved {
            return SearchOutcome::with_method(sweep_method(round), outcome, iterations);
        }
        let outcome = newton.solve(problem, round % 2 == 1);
        iterations += outcome.iterations;
        if outcome.is_solved {
            return SearchOutcome::with_method(SearchMethod::Newton, outcome, iterations);
        }
        reset_if_not_finite(problem);
    }
    SearchOutcome { iterations, method: None }
}

/// Alternates between accelerated sweeps, ever closer to the solution, and Newton's method, for many elements.
fn alternate_accelerated_sweeps_and_newton(
    problem: &mut ConeProblem,
    newton: &mut Newton,
) -> SearchOutcome {
    let mut iterations = 0;
    for (round, relative_change) in CHANGES_BEFORE_NEWTON.into_iter().enumerate() {
        let sufficient_change = if round == 0 && problem.has_hardening() {
            HARDENING_CHANGE_BEFORE_NEWTON
        } else {
            relative_change
        };
        let outcome = problem.sweep_accelerated(sufficient_change);
        iterations += outcome.iterations;
        if outcome.is_solved {
            return SearchOutcome::with_method(sweep_method(round), outcome, iterations);
        }
        reset_if_not_finite(problem);
        let outcome = newton.solve_briefly(problem, round % 2 == 1);
        iterations += outcome.iterations;
        if outcome.is_solved {
            return SearchOutcome::with_method(SearchMethod::Newton, outcome, iterations);
        }
    }
    SearchOutcome { iterations, method: None }
}

/// Method of a solution by sweeps.
///
/// After the first round, sweeps start from the forces of Newton's method.
fn sweep_method(round: usize) -> SearchMethod {
    if round == 0 { SearchMethod::GaussSeidel } else { SearchMethod::Newton }
}

/// Sets all changes of force to zero if one is not finite.
///
/// An iteration cannot start from such forces.
fn reset_if_not_finite(problem: &mut ConeProblem) {
    if problem.force_change.iter().any(|change| !change.is_finite()) {
        problem.force_change.fill(0.0);
    }
}

#[cfg(test)]
mod tests;
