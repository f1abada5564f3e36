//! Newton's method on the semi-smooth equations r = P(r − ρ y).
//!
//! [`problem`](super::problem) explains the symbols. The current r and y determine the status of each element: open,
//! closed or at its cap; sticking or slipping in a direction. The linear system of all statuses determines the next r.

use std::mem::Discriminant;

use super::low_rank_system::LowRankSystem;
use super::problem::{ConeProblem, InfiniteFriction, SolveOutcome};
use super::status::{Normal, Status, Tangential};
use super::system::System;

/// Largest number of iterations; then other methods are tried.
const MAX_NEWTON_ITERATIONS: usize = 15;
/// Largest ratio of the residual to an earlier one at which convergence is not slow.
const MAX_RESIDUAL_RATIO: f64 = 0.5;
/// With many elements: largest number of iterations with slow convergence.
const MAX_SLOW_ITERATIONS: usize = 2;
/// Largest residual, relative to the largest force, at which factors are reused.
///
/// Below it, factors from an earlier iteration of the same time step are accurate enough.
const FACTOR_REUSE_RESIDUAL: f64 = 1e-4;
/// The same on soil that hardens, where a new matrix takes little time, since iterations need no factors.
const MATRIX_REUSE_RESIDUAL: f64 = 1e-5;
/// Smallest residual that the iterations of a linear system leave, relative to the present one.
///
/// Newton's method then needs hardly more iterations than with factors.
const MIN_LINEAR_TOLERANCE: f64 = 1e-4;
/// Residual of a linear system's solution, relative to the tolerance of Newton's method.
const RESIDUAL_SAFETY_FACTOR: f64 = 0.1;
/// Largest number of iterations of a restart with partial steps.
const MAX_RESTART_ITERATIONS: usize = 60;
/// Smallest random fraction of a Newton step.
const MIN_STEP_FRACTION: f64 = 0.2;

/// The linear system that belongs to the statuses.
enum StatusSystem {
    /// The system of W with stored entries.
    Dense(Box<System>),
    /// The system of W of low rank, on a bed of many springs.
    LowRank(Box<LowRankSystem>),
}

/// Newton's method: the current statuses, their system and scratch.
pub(super) struct Newton {
    pub(super) statuses: Vec<Status>,
    system: StatusSystem,
    /// Kinds of the statuses in the previous iteration.
    previous_kinds: Vec<(Discriminant<Normal>, Discriminant<Tangential>)>,
    /// `force_change` of the previous iterate, or of the one with the smallest residual.
    stored_change: Vec<f64>,
}

impl Newton {
    /// The method for W with stored entries.
    pub(super) fn new(element_count: usize) -> Self {
        let system = System::new(element_count);
        Self::with_system(element_count, StatusSystem::Dense(Box::new(system)))
    }

    /// The method for W of low rank.
    pub(super) fn on_bed(element_count: usize) -> Self {
        let system = LowRankSystem::new(element_count);
        Self::with_system(element_count, StatusSystem::LowRank(Box::new(system)))
    }

    fn with_system(element_count: usize, system: StatusSystem) -> Self {
        Self {
            statuses: vec![Status::CLOSED_STICKING; element_count],
            system,
            previous_kinds: Vec::with_capacity(element_count),
            stored_change: vec![0.0; 3 * element_count],
        }
    }

    /// Allocates for this number of modes, if W is of low rank.
    pub(super) fn reserve(&mut self, mode_count: usize) {
        if let StatusSystem::LowRank(system) = &mut self.system {
            system.reserve(mode_count);
        }
    }

    /// Discards the factors; call this when W has changed.
    ///
    /// Factors for W of low rank are never stored. `is_constant`: whether W will stay constant.
    pub(super) fn invalidate(&mut self, is_constant: bool) {
        if let StatusSystem::Dense(system) = &mut self.system {
            system.invalidate(is_constant);
        }
    }

    /// Makes the choice of unknowns independent of previous time steps.
    ///
    /// It discards stored data by which a step would choose forces or displacements as unknowns.
    pub(super) fn begin_step(&mut self, has_hardening: bool) {
        if let StatusSystem::Dense(system) = &mut self.system {
            system.begin_step(has_hardening);
        }
    }

    /// Iterates from the current r; `uses_trial_pressure` as in [`Newton::classify`].
    pub(super) fn solve(
        &mut self,
        problem: &mut ConeProblem,
        uses_trial_pressure: bool,
    ) -> SolveOutcome {
        for iteration in 0..MAX_NEWTON_ITERATIONS {
            if problem.is_solved() {
                return SolveOutcome::new(iteration, true);
            }
            self.classify(problem, uses_trial_pressure);
            if !self.solve_for_statuses(problem) {
                return SolveOutcome::new(iteration + 1, false);
            }
        }
        SolveOutcome::new(MAX_NEWTON_ITERATIONS, problem.is_solved())
    }

    /// Iterates from a solution whose bounds have changed a little.
    ///
    /// Close to the new solution it reuses factors of the same time step where possible.
    pub(super) fn solve_again(&mut self, problem: &mut ConeProblem) -> SolveOutcome {
        let mut previous_residual = f64::INFINITY;
        for iteration in 0..MAX_NEWTON_ITERATIONS {
            // The displacements of the solution are known.
            let residual = if iteration == 0 { problem.max_residual() } else { problem.residual() };
            if residual <= problem.tolerance() {
                return SolveOutcome::new(iteration, true);
            }
            if !self.iterate(problem, residual, previous_residual) {
                return SolveOutcome::new(iteration + 1, false);
            }
            previous_residual = residual;
        }
        SolveOutcome::new(MAX_NEWTON_ITERATIONS, problem.is_solved())
    }

    /// Makes one iteration; `false` if the system is singular.
    ///
    /// `residual`: of the present forces, N. The iteration reuses the matrix of the previous iteration, whose residual is `previous_residual`, close to the solution.
    pub(super) fn iterate(
        &mut self,
        problem: &mut ConeProblem,
        residual: f64,
        previous_residual: f64,
    ) -> bool {
        self.classify(problem, false);
        let reuses_factors = falls_fast(residual, previous_residual)
            && residual <= MATRIX_REUSE_RESIDUAL * problem.largest_force();
        self.solve_system(problem, reuses_factors, linear_tolerance(problem, residual))
    }

    /// Iterates between Gauss–Seidel sweeps over many elements; ends early if the residual hardly falls.
    ///
    /// It then restores the forces with the smallest residual. Iterations that start far from the solution let more and
    /// more elements slip, and one iteration takes longer than several sweeps.
    pub(super) fn solve_briefly(
        &mut self,
        problem: &mut ConeProblem,
        uses_trial_pressure: bool,
    ) -> SolveOutcome {
        let mut smallest_residual = f64::INFINITY;
        let mut slow_iterations = 0;
        let mut iteration = 0;
        self.stored_change.copy_from_slice(&problem.force_change);
        loop {
            let residual = problem.residual();
            if residual <= problem.tolerance() {
                return SolveOutcome::new(iteration, true);
            }
            // False for NaN.
            let is_reduced = residual <= MAX_RESIDUAL_RATIO * smallest_residual;
            if iteration > 0 && !is_reduced {
                slow_iterations += 1;
            }
            if residual < smallest_residual {
                smallest_residual = residual;
                self.stored_change.copy_from_slice(&problem.force_change);
            }
            if slow_iterations == MAX_SLOW_ITERATIONS || iteration == MAX_NEWTON_ITERATIONS {
                problem.force_change.copy_from_slice(&self.stored_change);
                return SolveOutcome::new(iteration, false);
            }
            self.classify(problem, uses_trial_pressure);
            let reuses_factors =
                slow_iterations == 0 && residual <= FACTOR_REUSE_RESIDUAL * problem.largest_force();
            let tolerance = linear_tolerance(problem, residual);
            if !self.solve_system(problem, reuses_factors, tolerance) {
                problem.force_change.copy_from_slice(&self.stored_change);
                return SolveOutcome::new(iteration + 1, false);
            }
            iteration += 1;
        }
    }

    /// Randomised restarts: in turn from `initial_change`, from zero forces, and with all elements sticking.
    ///
    /// Until the statuses stay the same, each element's force changes by a random fraction of each Newton step, so that
    /// the iterates do not cycle.
    pub(super) fn restart_randomly(
        &mut self,
        problem: &mut ConeProblem,
        initial_change: &[f64],
        max_restarts: u64,
    ) -> SolveOutcome {
        let mut iterations = 0;
        for restart in 0..max_restarts {
            match restart % 3 {
                0 => problem.force_change.copy_from_slice(initial_change),
                1 => (0..problem.component_count()).for_each(|i| problem.set_force(i, 0.0)),
                _ => {
                    problem.reset_forces();
                    self.statuses.fill(Status::CLOSED_STICKING);
                    self.solve_for_statuses(problem);
                }
            }
            let outcome = self.solve_with_random_steps(problem, restart);
            iterations += outcome.iterations;
            if outcome.is_solved {
                return SolveOutcome::new(iterations, true);
            }
        }
        SolveOutcome::new(iterations, false)
    }

    /// Iterates with random fractions of Newton steps; the number of the restart seeds them.
    fn solve_with_random_steps(&mut self, problem: &mut ConeProblem, restart: u64) -> SolveOutcome {
        let mut random_state = restart.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        self.previous_kinds.clear();
        for iteration in 0..MAX_RESTART_ITERATIONS {
            if problem.is_solved() {
                return SolveOutcome::new(iteration, true);
            }
            self.stored_change.copy_from_slice(&problem.force_change);
            self.classify(problem, restart % 2 == 1);
            let kinds = self.statuses.iter().map(Status::kind);
            let has_same_kinds = self.previous_kinds.iter().copied().eq(kinds.clone());
            self.previous_kinds.clear();
            self.previous_kinds.extend(kinds);
            if !self.solve_for_statuses(problem) {
                return SolveOutcome::new(iteration + 1, false);
            }
            if has_same_kinds {
                continue;
            }
            for e in 0..problem.element_count {
                // Marsaglia's generator (2003).
                random_state ^= random_state << 13;
                random_state ^= random_state >> 7;
                random_state ^= random_state << 17;
                let fraction = MIN_STEP_FRACTION
                    + (1.0 - MIN_STEP_FRACTION) * (random_state >> 11) as f64
                        / (1_u64 << 53) as f64;
                for i in problem.component_indices(e) {
                    let previous = self.stored_change[i];
                    let next = problem.force_change[i];
                    problem.force_change[i] = previous + fraction * (next - previous);
                }
            }
        }
        SolveOutcome::new(MAX_RESTART_ITERATIONS, problem.is_solved())
    }

    /// Sets the statuses by the trial forces r − ρ y of the current r and y.
    ///
    /// `uses_trial_pressure`: whether the radius of the friction disc follows from the projected trial p, not from the
    /// current p.
    pub(super) fn classify(&mut self, problem: &ConeProblem, uses_trial_pressure: bool) {
        for (e, status) in self.statuses.iter_mut().enumerate() {
            let bounds = &problem.bounds[e];
            *status = if bounds.is_bonded {
                Status::CLOSED_STICKING
            } else if bounds.has_infinite_friction() {
                status_with_infinite_friction(problem, e)
            } else {
                status_with_finite_friction(problem, e, uses_trial_pressure)
            };
        }
    }

    /// Solves the system of the statuses; `false` if it is singular.
    pub(super) fn solve_for_statuses(&mut self, problem: &mut ConeProblem) -> bool {
        self.solve_system(problem, false, 0.0)
    }

    /// Solves the system of the statuses, with the last two arguments of [`System::solve`].
    fn solve_system(
        &mut self,
        problem: &mut ConeProblem,
        accepts_recent_factors: bool,
        linear_tolerance: f64,
    ) -> bool {
        match &mut self.system {
            StatusSystem::Dense(system) => {
                system.solve(problem, &self.statuses, accepts_recent_factors, linear_tolerance)
            }
            StatusSystem::LowRank(system) => system.solve(problem, &self.statuses),
        }
    }
}

/// Whether the residual has fallen as fast as it should in an iteration; `false` for NaN.
pub(super) fn falls_fast(residual: f64, previous_residual: f64) -> bool {
    residual <= MAX_RESIDUAL_RATIO * previous_residual
}

/// Residual that the iterations of a linear system may leave, relative to the present `residual`.
///
/// It does not limit the convergence of Newton's method by much, nor is it below what the accepted solution needs
/// (Kelley 1995, § 6.3).
fn linear_tolerance(problem: &ConeProblem, residual: f64) -> f64 {
    (RESIDUAL_SAFETY_FACTOR * problem.tolerance() / residual).max(MIN_LINEAR_TOLERANCE)
}

/// Status of an element with infinite friction by its trial force.
fn status_with_infinite_friction(problem: &ConeProblem, e: usize) -> Status {
    let trial = problem.trial_force(e);
    match problem.infinite_friction_status(e) {
        InfiniteFriction::Open => Status::OPEN_FREE,
        InfiniteFriction::Stick if trial[0] >= problem.bounds[e].interval[1] => {
            let normal = problem.bounds[e].status_at_cap();
            Status { normal, tangential: Tangential::Stick }
        }
        InfiniteFriction::Stick => Status::CLOSED_STICKING,
        InfiniteFriction::Slip(direction) => {
            let force = problem.component_indices(e).map(|i| problem.force(i));
            let slip_shear = direction[0] * force[1] + direction[1] * force[2];
            let radius_ratio = (slip_shear / trial[1].hypot(trial[2])).clamp(0.0, 1.0);
            let radius_slope = f64::INFINITY;
            let tangential = Tangential::Slip { direction, radius_ratio, radius_slope };
            Status { normal: Normal::Closed, tangential }
        }
    }
}

/// Status of an element with finite friction by its trial force; `uses_trial_pressure` as in [`Newton::classify`].
fn status_with_finite_friction(
    problem: &ConeProblem,
    e: usize,
    uses_trial_pressure: bool,
) -> Status {
    let bounds = &problem.bounds[e];
    let trial = problem.trial_force(e);
    let normal = if trial[0] <= bounds.interval[0] {
        Normal::Open
    } else if trial[0] >= bounds.interval[1] {
        bounds.status_at_cap()
    } else {
        Normal::Closed
    };
    let pressure = if uses_trial_pressure {
        bounds.project_pressure(trial[0], problem.rho[e][0])
    } else {
        problem.force(e)
    };
    let radius = bounds.radius(pressure);
    let trial_shear = trial[1].hypot(trial[2]);
    let tangential = if radius == 0.0 && (normal == Normal::Open || bounds.friction == 0.0) {
        Tangential::Free
    } else if trial_shear <= radius {
        Tangential::Stick
    } else {
        let has_friction = pressure + bounds.attraction > 0.0;
        let radius_slope = if has_friction { bounds.effective_friction() } else { 0.0 };
        let direction = [trial[1] / trial_shear, trial[2] / trial_shear];
        Tangential::Slip { direction, radius_ratio: radius / trial_shear, radius_slope }
    };
    Status { normal, tangential }
}
