//! Search for the forces of a contact problem in plan, by one method after the other.

use super::newton::Newton;
use super::problem::{Problem, STAND_IN};
use super::proximal::Proximal;
use crate::contact::SearchMethod;

/// Largest number of sweeps of a round.
const SWEEPS: usize = 60;
/// Rounds of sweeps and Newton's method, alone or within the proximal method.
const ROUNDS: usize = 12;
/// Accelerated sweeps of a round end at this change, relative to the largest force, for Newton's method to begin.
const CHANGES_BEFORE_NEWTON: [f64; 4] = [1e-3, 1e-5, 1e-8, 0.0];
/// Largest friction that all methods are tried with; a higher one is approached from below.
const GRIP: f64 = 100.0;
/// Smallest friction from which a higher one is approached.
const LEAST_GRIP: f64 = 3.0;
/// Attempts of Newton's method with partial steps: alone, while friction is raised, and within the proximal method.
const ATTEMPTS: u64 = 60;
const SOME_ATTEMPTS: u64 = 12;
const FEW_ATTEMPTS: u64 = 4;
/// Smallest factor by which friction is raised.
const STRIDE: f64 = 1.2;

/// Tries one method after the other, with `start` and `limited` as scratch.
///
/// Returns the number of iterations, and the last method used. A friction above [`GRIP`] that is not solved at
/// once is limited, and raised from that solution as far as possible. `lasts`: whether W is constant for the whole
/// run.
pub(super) fn search(
    problem: &mut Problem,
    newton: &mut Newton,
    proximal: &mut Proximal,
    [start, limited]: [&mut [f64]; 2],
    lasts: bool,
) -> (usize, Option<SearchMethod>) {
    start.copy_from_slice(&problem.change);
    problem.hold(f64::INFINITY);
    let greatest = problem.bounds.iter().fold(0.0_f64, |most, bounds| most.max(bounds.friction));
    if greatest <= GRIP {
        return search_held(problem, newton, proximal, start, lasts);
    }
    let (mut all, found) = newton.solve(problem, false);
    if found {
        return (all, Some(SearchMethod::Newton));
    }
    // The largest friction with a solution, and its method.
    let mut most: Option<(f64, SearchMethod)> = None;
    for grip in [STAND_IN, GRIP, 0.1 * GRIP, LEAST_GRIP] {
        problem.hold(grip);
        problem.change.copy_from_slice(start);
        let is_last = grip == LEAST_GRIP && most.is_none();
        let (iterations, found) = if grip == GRIP || is_last {
            search_held(problem, newton, proximal, start, lasts)
        } else {
            rounds(problem, newton)
        };
        all += iterations;
        let Some(found) = found else { continue };
        let found = found.max(SearchMethod::Newton);
        all += let_go(problem, newton, start, greatest);
        let reached = problem.bounds[0].grip;
        if reached >= GRIP {
            return (all, Some(found));
        }
        if most.is_none_or(|(grip, _)| reached > grip) {
            most = Some((reached, found));
            limited.copy_from_slice(&problem.change);
        }
    }
    let Some((grip, found)) = most else { return (all, None) };
    problem.hold(grip);
    problem.change.copy_from_slice(limited);
    problem.respond();
    (all, Some(found))
}

/// Raises the limit of friction from a solution towards `greatest`; returns the number of iterations.
///
/// Where that fails it uses smaller factors.
fn let_go(problem: &mut Problem, newton: &mut Newton, start: &mut [f64], greatest: f64) -> usize {
    let (mut grip, mut stride) = (problem.bounds[0].grip, f64::INFINITY);
    let mut all = 0;
    start.copy_from_slice(&problem.change);
    while grip < greatest && stride > STRIDE {
        problem.hold(grip * stride);
        let (mut iterations, mut found) = newton.solve(problem, false);
        if !found {
            let (more, wandered) = newton.wander(problem, start, SOME_ATTEMPTS);
            (iterations, found) = (iterations + more, wandered);
        }
        all += iterations;
        if found {
            (grip, stride) = (grip * stride, f64::INFINITY);
            start.copy_from_slice(&problem.change);
        } else {
            problem.change.copy_from_slice(start);
            stride = stride.min(100.0).sqrt();
        }
    }
    problem.hold(grip);
    problem.respond();
    all
}

/// Tries one method after the other, with friction limited.
fn search_held(
    problem: &mut Problem,
    newton: &mut Newton,
    proximal: &mut Proximal,
    start: &mut [f64],
    lasts: bool,
) -> (usize, Option<SearchMethod>) {
    let mut all = 0;
    if problem.low_rank.is_some() {
        // Its iterations take no more time than sweeps, and need no soft structure.
        let (iterations, found) = newton.solve(problem, false);
        all += iterations;
        if found {
            return (all, Some(SearchMethod::Newton));
        }
        problem.change.copy_from_slice(start);
    }
    let (iterations, found) = rounds(problem, newton);
    all += iterations;
    if found.is_some() {
        return (all, found);
    }
    let (iterations, found) = newton.wander(problem, start, ATTEMPTS);
    all += iterations;
    if found {
        return (all, Some(SearchMethod::Newton));
    }
    problem.change.copy_from_slice(start);
    let found = proximal.solve(problem, |problem| {
        newton.forget(false);
        start.copy_from_slice(&problem.change);
        let (iterations, found) = rounds(problem, newton);
        all += iterations;
        found.is_some() || {
            let (iterations, found) = newton.wander(problem, start, FEW_ATTEMPTS);
            all += iterations;
            found
        }
    });
    newton.forget(lasts);
    (all, found.then_some(SearchMethod::Proximal))
}

/// Sweeps and Newton's method in turn; returns the number of iterations, and the last method used.
fn rounds(problem: &mut Problem, newton: &mut Newton) -> (usize, Option<SearchMethod>) {
    if problem.acceleration.is_some() {
        return accelerated_rounds(problem, newton);
    }
    let mut all = 0;
    for round in 0..ROUNDS {
        let (sweeps, found) = problem.sweep(SWEEPS);
        all += sweeps;
        if found {
            let alone = SearchMethod::GaussSeidel;
            return (all, Some(if round == 0 { alone } else { SearchMethod::Newton }));
        }
        let (iterations, found) = newton.solve(problem, round % 2 == 1);
        all += iterations;
        if found {
            return (all, Some(SearchMethod::Newton));
        }
        // Forces that are not finite cannot start an iteration.
        if problem.change.iter().any(|change| !change.is_finite()) {
            problem.change.fill(0.0);
        }
    }
    (all, None)
}

/// The same for many elements: sweeps that bring the forces ever nearer to the solution, and Newton's method in turn.
fn accelerated_rounds(problem: &mut Problem, newton: &mut Newton) -> (usize, Option<SearchMethod>) {
    let mut all = 0;
    for (round, relative_change) in CHANGES_BEFORE_NEWTON.into_iter().enumerate() {
        let (sweeps, found) = problem.sweep_accelerated(relative_change);
        all += sweeps;
        if found {
            let alone = SearchMethod::GaussSeidel;
            return (all, Some(if round == 0 { alone } else { SearchMethod::Newton }));
        }
        if problem.change.iter().any(|change| !change.is_finite()) {
            problem.change.fill(0.0);
        }
        let (iterations, found) = newton.solve_briefly(problem, round % 2 == 1);
        all += iterations;
        if found {
            return (all, Some(SearchMethod::Newton));
        }
    }
    (all, None)
}

#[cfg(test)]
mod tests;
