//! Search for the forces of a contact problem in plan, by one method after the other.

use super::newton::Newton;
use super::problem::{ConeProblem, SUBSTITUTED_FRICTION, SolveOutcome};
use super::proximal::Proximal;
use crate::contact::SearchMethod;

/// Largest number of sweeps of a round.
const MAX_SWEEPS_PER_ROUND: usize = 60;
/// Rounds of sweeps and Newton's method, alone or within the proximal method.
const MAX_ROUNDS: usize = 12;
/// Accelerated sweeps of a round end at this change, relative to the largest force, for Newton's method to begin.
const CHANGES_BEFORE_NEWTON: [f64; 4] = [3e-3, 1e-5, 1e-8, 0.0];
/// Largest friction that all methods are tried with; a higher one is approached from below.
const MAX_DIRECT_FRICTION: f64 = 100.0;
/// Smallest friction from which a higher one is approached.
const MIN_FRICTION_LIMIT: f64 = 3.0;
/// Randomised restarts of Newton's method: alone, while friction is raised, and within the proximal method.
const MAX_RESTARTS: u64 = 60;
const MAX_RESTARTS_WHILE_RAISING: u64 = 12;
const MAX_RESTARTS_WITHIN_PROXIMAL: u64 = 4;
/// Smallest factor by which friction is raised.
const MIN_FRICTION_FACTOR: f64 = 1.2;

/// Number of iterations of a search, and the last method used; no method if no solution was found.
pub(super) struct SearchOutcome {
    pub(super) iterations: usize,
    pub(super) method: Option<SearchMethod>,
}

impl SearchOutcome {
    /// Outcome of a search that ended with `outcome` after `iterations` in all, by `method`.
    fn by(method: SearchMethod, outcome: SolveOutcome, iterations: usize) -> Self {
        Self { iterations, method: outcome.is_solved.then_some(method) }
    }
}

/// Tries one method after the other, with `start` and `limited` as scratch.
///
/// A friction above [`MAX_DIRECT_FRICTION`] that is not solved at once is limited, and raised from that solution as far
/// as possible. `is_constant`: whether W is constant for the whole run.
pub(super) fn search(
    problem: &mut ConeProblem,
    newton: &mut Newton,
    proximal: &mut Proximal,
    start: &mut [f64],
    limited: &mut [f64],
    is_constant: bool,
) -> SearchOutcome {
    start.copy_from_slice(&problem.change);
    problem.limit_friction(f64::INFINITY);
    let max_friction = problem.bounds.iter().fold(0.0_f64, |max, bounds| max.max(bounds.friction));
    if max_friction <= MAX_DIRECT_FRICTION {
        return search_with_limited_friction(problem, newton, proximal, start, is_constant);
    }
    let outcome = newton.solve(problem, false);
    let mut iterations = outcome.iterations;
    if outcome.is_solved {
        return SearchOutcome::by(SearchMethod::Newton, outcome, iterations);
    }
    // The largest friction with a solution, and its method.
    let mut best: Option<(f64, SearchMethod)> = None;
    for friction_limit in
        [SUBSTITUTED_FRICTION, MAX_DIRECT_FRICTION, 0.1 * MAX_DIRECT_FRICTION, MIN_FRICTION_LIMIT]
    {
        problem.limit_friction(friction_limit);
        problem.change.copy_from_slice(start);
        let is_last = friction_limit == MIN_FRICTION_LIMIT && best.is_none();
        let outcome = if friction_limit == MAX_DIRECT_FRICTION || is_last {
            search_with_limited_friction(problem, newton, proximal, start, is_constant)
        } else {
            rounds(problem, newton)
        };
        iterations += outcome.iterations;
        let Some(method) = outcome.method else { continue };
        let method = method.max(SearchMethod::Newton);
        iterations += raise_friction_limit(problem, newton, start, max_friction);
        let reached = problem.bounds[0].friction_limit;
        if reached >= MAX_DIRECT_FRICTION {
            return SearchOutcome { iterations, method: Some(method) };
        }
        if best.is_none_or(|(friction_limit, _)| reached > friction_limit) {
            best = Some((reached, method));
            limited.copy_from_slice(&problem.change);
        }
    }
    let Some((friction_limit, method)) = best else {
        return SearchOutcome { iterations, method: None };
    };
    problem.limit_friction(friction_limit);
    problem.change.copy_from_slice(limited);
    problem.update_motions();
    SearchOutcome { iterations, method: Some(method) }
}

/// Raises the friction limit from a solution towards `max_friction`; returns the number of iterations.
///
/// Where that fails it uses smaller factors.
fn raise_friction_limit(
    problem: &mut ConeProblem,
    newton: &mut Newton,
    start: &mut [f64],
    max_friction: f64,
) -> usize {
    let mut friction_limit = problem.bounds[0].friction_limit;
    let mut factor = f64::INFINITY;
    let mut iterations = 0;
    start.copy_from_slice(&problem.change);
    while friction_limit < max_friction && factor > MIN_FRICTION_FACTOR {
        problem.limit_friction(friction_limit * factor);
        let mut outcome = newton.solve(problem, false);
        iterations += outcome.iterations;
        if !outcome.is_solved {
            outcome = newton.restart_randomly(problem, start, MAX_RESTARTS_WHILE_RAISING);
            iterations += outcome.iterations;
        }
        if outcome.is_solved {
            friction_limit *= factor;
            factor = f64::INFINITY;
            start.copy_from_slice(&problem.change);
        } else {
            problem.change.copy_from_slice(start);
            factor = factor.min(100.0).sqrt();
        }
    }
    problem.limit_friction(friction_limit);
    problem.update_motions();
    iterations
}

/// Tries one method after the other, with the friction limit as it is.
fn search_with_limited_friction(
    problem: &mut ConeProblem,
    newton: &mut Newton,
    proximal: &mut Proximal,
    start: &mut [f64],
    is_constant: bool,
) -> SearchOutcome {
    let mut iterations = 0;
    if problem.low_rank.is_some() {
        // Newton's iterations take no more time than sweeps here, and need no soft structure.
        let outcome = newton.solve(problem, false);
        iterations += outcome.iterations;
        if outcome.is_solved {
            return SearchOutcome::by(SearchMethod::Newton, outcome, iterations);
        }
        problem.change.copy_from_slice(start);
    }
    let outcome = rounds(problem, newton);
    iterations += outcome.iterations;
    if outcome.method.is_some() {
        return SearchOutcome { iterations, ..outcome };
    }
    let outcome = newton.restart_randomly(problem, start, MAX_RESTARTS);
    iterations += outcome.iterations;
    if outcome.is_solved {
        return SearchOutcome::by(SearchMethod::Newton, outcome, iterations);
    }
    problem.change.copy_from_slice(start);
    let is_solved = proximal.solve(problem, |problem| {
        newton.forget(false);
        start.copy_from_slice(&problem.change);
        let outcome = rounds(problem, newton);
        iterations += outcome.iterations;
        if outcome.method.is_some() {
            return true;
        }
        let outcome = newton.restart_randomly(problem, start, MAX_RESTARTS_WITHIN_PROXIMAL);
        iterations += outcome.iterations;
        outcome.is_solved
    });
    newton.forget(is_constant);
    SearchOutcome { iterations, method: is_solved.then_some(SearchMethod::Proximal) }
}

/// Sweeps and Newton's method in turn.
fn rounds(problem: &mut ConeProblem, newton: &mut Newton) -> SearchOutcome {
    if problem.acceleration.is_some() {
        return accelerated_rounds(problem, newton);
    }
    let mut iterations = 0;
    for round in 0..MAX_ROUNDS {
        let outcome = problem.sweep(MAX_SWEEPS_PER_ROUND);
        iterations += outcome.iterations;
        if outcome.is_solved {
            return SearchOutcome::by(method_of_sweeps(round), outcome, iterations);
        }
        let outcome = newton.solve(problem, round % 2 == 1);
        iterations += outcome.iterations;
        if outcome.is_solved {
            return SearchOutcome::by(SearchMethod::Newton, outcome, iterations);
        }
        reset_if_not_finite(problem);
    }
    SearchOutcome { iterations, method: None }
}

/// Accelerated sweeps, ever closer to the solution, and Newton's method in turn, for many elements.
fn accelerated_rounds(problem: &mut ConeProblem, newton: &mut Newton) -> SearchOutcome {
    let mut iterations = 0;
    for (round, relative_change) in CHANGES_BEFORE_NEWTON.into_iter().enumerate() {
        let outcome = problem.sweep_accelerated(relative_change);
        iterations += outcome.iterations;
        if outcome.is_solved {
            return SearchOutcome::by(method_of_sweeps(round), outcome, iterations);
        }
        reset_if_not_finite(problem);
        let outcome = newton.solve_briefly(problem, round % 2 == 1);
        iterations += outcome.iterations;
        if outcome.is_solved {
            return SearchOutcome::by(SearchMethod::Newton, outcome, iterations);
        }
    }
    SearchOutcome { iterations, method: None }
}

/// Method of a solution by sweeps: after the first round they started from Newton's forces.
fn method_of_sweeps(round: usize) -> SearchMethod {
    if round == 0 { SearchMethod::GaussSeidel } else { SearchMethod::Newton }
}

/// Sets all changes of force to zero if one is not finite: such forces cannot start an iteration.
fn reset_if_not_finite(problem: &mut ConeProblem) {
    if problem.change.iter().any(|change| !change.is_finite()) {
        problem.change.fill(0.0);
    }
}

#[cfg(test)]
mod tests;
