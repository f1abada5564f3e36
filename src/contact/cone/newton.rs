//! Newton's method on the semi-smooth equations r = P(r − ρ y).
//!
//! The present r and y give each element a status: open, closed or at its cap; sticking or slipping in a direction. The
//! linear system of all statuses gives the next r.

use std::mem::Discriminant;

use super::low_rank_system::LowRankSystem;
use super::problem::{ConeProblem, InfiniteFriction, SolveOutcome};
use super::status::{Normal, Status, Tangential};
use super::system::System;

/// Largest number of iterations.
const MAX_NEWTON_ITERATIONS: usize = 15;
/// With many elements: factor by which an iteration must reduce the residual, and the number of iterations that may not.
const MIN_REDUCTION: f64 = 0.5;
const MAX_SLOW_ITERATIONS: usize = 2;
/// With many elements: residual, relative to the largest force, below which factors of the same step solve.
const NEAR_RESIDUAL: f64 = 1e-4;
/// Largest number of iterations of an attempt with partial steps, and the smallest part of a step.
const MAX_RESTART_ITERATIONS: usize = 60;
const MIN_STEP_FRACTION: f64 = 0.2;

/// The linear system of the statuses.
enum StatusSystem {
    /// For W with stored entries.
    Dense(Box<System>),
    /// For W of low rank, on a bed of many springs.
    LowRank(Box<LowRankSystem>),
}

/// Newton's method, with its scratch.
pub(super) struct Newton {
    pub(super) statuses: Vec<Status>,
    system: StatusSystem,
    /// Kinds of the statuses and changes of force in the previous iteration.
    kinds: Vec<(Discriminant<Normal>, Discriminant<Tangential>)>,
    before: Vec<f64>,
}

impl Newton {
    pub(super) fn new(count: usize) -> Self {
        Self::with_system(count, StatusSystem::Dense(Box::new(System::new(count))))
    }

    /// The method for W of low rank.
    pub(super) fn on_bed(count: usize) -> Self {
        Self::with_system(count, StatusSystem::LowRank(Box::new(LowRankSystem::new(count))))
    }

    fn with_system(count: usize, system: StatusSystem) -> Self {
        Self {
            statuses: vec![Status::CLOSED_STICKING; count],
            system,
            kinds: Vec::with_capacity(count),
            before: vec![0.0; 3 * count],
        }
    }

    /// Allocates for W of this rank, if it is of low rank.
    pub(super) fn reserve(&mut self, rank: usize) {
        if let StatusSystem::LowRank(system) = &mut self.system {
            system.reserve(rank);
        }
    }

    /// Discards the factors; call it when W has changed. Factors for W of low rank are never kept.
    ///
    /// `is_constant`: whether W will stay constant.
    pub(super) fn forget(&mut self, is_constant: bool) {
        if let StatusSystem::Dense(system) = &mut self.system {
            system.forget(is_constant);
        }
    }

    /// Discards the results of previous steps that influence the choice of a system.
    pub(super) fn begin_step(&mut self) {
        if let StatusSystem::Dense(system) = &mut self.system {
            system.begin_step();
        }
    }

    /// Iterates from the present r; returns the number of iterations, and whether they found a solution.
    ///
    /// With `ahead` the radius follows from the trial's p instead of the present p.
    pub(super) fn solve(&mut self, problem: &mut ConeProblem, ahead: bool) -> SolveOutcome {
        for iteration in 0..MAX_NEWTON_ITERATIONS {
            if problem.is_solved() {
                return SolveOutcome::new(iteration, true);
            }
            self.classify(problem, ahead);
            if !self.step(problem) {
                return SolveOutcome::new(iteration + 1, false);
            }
        }
        SolveOutcome::new(MAX_NEWTON_ITERATIONS, problem.is_solved())
    }

    /// Iterates from a solution whose bounds have changed a little, at first with the factors of the same step.
    pub(super) fn solve_again(&mut self, problem: &mut ConeProblem) -> SolveOutcome {
        let mut previous_residual = f64::INFINITY;
        for iteration in 0..MAX_NEWTON_ITERATIONS {
            let residual = problem.residual();
            if residual <= problem.tolerance() {
                return SolveOutcome::new(iteration, true);
            }
            self.classify(problem, false);
            let falls = residual <= MIN_REDUCTION * previous_residual;
            let is_near = falls && residual <= NEAR_RESIDUAL * problem.largest_force();
            if !self.solve_system(problem, is_near) {
                return SolveOutcome::new(iteration + 1, false);
            }
            previous_residual = residual;
        }
        SolveOutcome::new(MAX_NEWTON_ITERATIONS, problem.is_solved())
    }

    /// Iterates between the sweeps of many elements: ends early if the residual hardly falls.
    ///
    /// The forces with the smallest residual then remain.
    ///
    /// Iterations that start too far from the solution let more and more elements slip, and one of them takes longer
    /// than several sweeps.
    pub(super) fn solve_briefly(&mut self, problem: &mut ConeProblem, ahead: bool) -> SolveOutcome {
        let mut smallest = f64::INFINITY;
        let mut slow = 0;
        let mut iteration = 0;
        self.before.copy_from_slice(&problem.change);
        loop {
            let residual = problem.residual();
            if residual <= problem.tolerance() {
                return SolveOutcome::new(iteration, true);
            }
            // False for NaN.
            let falls = residual <= MIN_REDUCTION * smallest;
            if iteration > 0 && !falls {
                slow += 1;
            }
            if residual < smallest {
                smallest = residual;
                self.before.copy_from_slice(&problem.change);
            }
            if slow == MAX_SLOW_ITERATIONS || iteration == MAX_NEWTON_ITERATIONS {
                problem.change.copy_from_slice(&self.before);
                return SolveOutcome::new(iteration, false);
            }
            self.classify(problem, ahead);
            let is_near = slow == 0 && residual <= NEAR_RESIDUAL * problem.largest_force();
            if !self.solve_system(problem, is_near) {
                problem.change.copy_from_slice(&self.before);
                return SolveOutcome::new(iteration + 1, false);
            }
            iteration += 1;
        }
    }

    /// Randomised restarts: `attempts` in turn, from `start`, from zero forces and with all elements sticking.
    ///
    /// Until the statuses stay the same, each element takes a random part of each step, which keeps the iterates
    /// from cycling.
    pub(super) fn restart_randomly(
        &mut self,
        problem: &mut ConeProblem,
        start: &[f64],
        attempts: u64,
    ) -> SolveOutcome {
        let mut iterations = 0;
        for attempt in 0..attempts {
            match attempt % 3 {
                0 => problem.change.copy_from_slice(start),
                1 => (0..problem.size()).for_each(|i| problem.set_force(i, 0.0)),
                _ => {
                    problem.reset_forces();
                    self.statuses.fill(Status::CLOSED_STICKING);
                    self.step(problem);
                }
            }
            let outcome = self.attempt(problem, attempt);
            iterations += outcome.iterations;
            if outcome.is_solved {
                return SolveOutcome::new(iterations, true);
            }
        }
        SolveOutcome::new(iterations, false)
    }

    /// Makes one randomised restart; `number` seeds its random fractions.
    fn attempt(&mut self, problem: &mut ConeProblem, number: u64) -> SolveOutcome {
        let mut state = number.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        self.kinds.clear();
        for iteration in 0..MAX_RESTART_ITERATIONS {
            if problem.is_solved() {
                return SolveOutcome::new(iteration, true);
            }
            self.before.copy_from_slice(&problem.change);
            self.classify(problem, number % 2 == 1);
            let stays = self.kinds.iter().copied().eq(self.statuses.iter().map(Status::kind));
            self.kinds.clear();
            self.kinds.extend(self.statuses.iter().map(Status::kind));
            if !self.step(problem) {
                return SolveOutcome::new(iteration + 1, false);
            }
            if stays {
                continue;
            }
            for e in 0..problem.count {
                // Marsaglia's generator (2003).
                state ^= state << 13;
                state ^= state >> 7;
                state ^= state << 17;
                let fraction = MIN_STEP_FRACTION
                    + (1.0 - MIN_STEP_FRACTION) * (state >> 11) as f64 / (1_u64 << 53) as f64;
                for i in problem.places(e) {
                    let old = self.before[i];
                    let new = problem.change[i];
                    problem.change[i] = old + fraction * (new - old);
                }
            }
        }
        SolveOutcome::new(MAX_RESTART_ITERATIONS, problem.is_solved())
    }

    /// Sets the statuses by the trials of the present r and y.
    ///
    /// With `ahead` the radius follows from the trial's p instead of the present p.
    pub(super) fn classify(&mut self, problem: &ConeProblem, ahead: bool) {
        for (e, status) in self.statuses.iter_mut().enumerate() {
            let bounds = &problem.bounds[e];
            *status = if bounds.bonded {
                Status::CLOSED_STICKING
            } else if bounds.has_infinite_friction() {
                status_with_infinite_friction(problem, e)
            } else {
                status_with_finite_friction(problem, e, ahead)
            };
        }
    }

    /// Solves the system of the statuses; `false` if it is singular.
    pub(super) fn step(&mut self, problem: &mut ConeProblem) -> bool {
        self.solve_system(problem, false)
    }

    /// Solves the system of the statuses, with `is_near` as in [`System::solve`].
    fn solve_system(&mut self, problem: &mut ConeProblem, is_near: bool) -> bool {
        match &mut self.system {
            StatusSystem::Dense(system) => system.solve(problem, &self.statuses, is_near),
            StatusSystem::LowRank(system) => system.solve(problem, &self.statuses),
        }
    }
}

/// Status of an element with infinite friction by its trial.
fn status_with_infinite_friction(problem: &ConeProblem, e: usize) -> Status {
    let trial = problem.trial(e);
    match problem.infinite_friction_status(e) {
        InfiniteFriction::Open => Status::OPEN_FREE,
        InfiniteFriction::Stick if trial[0] >= problem.bounds[e].interval[1] => {
            let normal = problem.bounds[e].status_at_cap();
            Status { normal, tangential: Tangential::Stick }
        }
        InfiniteFriction::Stick => Status::CLOSED_STICKING,
        InfiniteFriction::Slip(direction) => {
            let places = problem.places(e);
            let along =
                direction[0] * problem.force(places[1]) + direction[1] * problem.force(places[2]);
            let turn = (along / trial[1].hypot(trial[2])).clamp(0.0, 1.0);
            let slope = f64::INFINITY;
            let tangential = Tangential::Slip { direction, turn, slope };
            Status { normal: Normal::Closed, tangential }
        }
    }
}

/// Status of an element with finite friction by its trial; `ahead` as in [`Newton::classify`].
fn status_with_finite_friction(problem: &ConeProblem, e: usize, ahead: bool) -> Status {
    let bounds = &problem.bounds[e];
    let trial = problem.trial(e);
    let normal = if trial[0] <= bounds.interval[0] {
        Normal::Open
    } else if trial[0] >= bounds.interval[1] {
        bounds.status_at_cap()
    } else {
        Normal::Closed
    };
    let pressure = if ahead {
        bounds.project_pressure(trial[0], problem.rho[e][0])
    } else {
        problem.force(e)
    };
    let radius = bounds.radius(pressure);
    let size = trial[1].hypot(trial[2]);
    let tangential = if radius == 0.0 && (normal == Normal::Open || bounds.friction == 0.0) {
        Tangential::Free
    } else if size <= radius {
        Tangential::Stick
    } else {
        let has_friction = pressure + bounds.attraction > 0.0;
        let slope = if has_friction { bounds.effective_friction() } else { 0.0 };
        let direction = [trial[1] / size, trial[2] / size];
        Tangential::Slip { direction, turn: radius / size, slope }
    };
    Status { normal, tangential }
}
