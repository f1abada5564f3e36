//! Newton's method for a step of a nonlinear structure; each iteration solves the contact problem.

use crate::contact::SearchMethod;
use crate::coupled::statics::increment_search::IncrementSearch;
use crate::coupled::step::evaluation::{change_tangent, evaluate_force};
use crate::coupled::step::forcing::StepData;
use crate::coupled::step::increment::Increment;
use crate::coupled::step::kept_tangent::{FirstTangent, may_keep_tangent};
use crate::coupled::step::linear::LinearStep;
use crate::error::StepError;
use crate::linalg::{SparseMatrix, largest};
use crate::structure::Tangent;

/// Largest number of iterations of a step before the continuation; most steps need fewer than ten.
const MAX_NEWTON_ITERATIONS: usize = 40;
/// Out-of-balance force at which the iteration ends, relative to the largest force.
const RESIDUAL_TOLERANCE: f64 = 1e-12;
/// Out-of-balance force that is accepted if the iteration stagnates.
const STAGNATION_TOLERANCE: f64 = 1e3 * RESIDUAL_TOLERANCE;
/// Rounding error of a displacement that may cause a force, in units of its last digit.
const DISPLACEMENT_ROUNDING_FACTOR: f64 = 32.0;
/// Ratio of two successive out-of-balance forces from which on they may be rounding.
const ROUNDING_RATIO: f64 = 0.5;
/// Number of iterations without a smaller out-of-balance force after which the iteration counts as a cycle.
const MAX_STAGNANT_ITERATIONS: usize = 15;
/// Number of degrees of freedom with the largest out-of-balance force that an error passes to the structure.
const REPORTED_DOFS: usize = 8;

/// Largest number of iterations of a stage of the continuation: a stage with one kink converges within them.
const MAX_STAGE_ITERATIONS: usize = 8;
/// Largest number of iterations of all stages of the continuation; it bounds the time of a step.
const MAX_TOTAL_ITERATIONS: usize = 2000;
/// Shortest stage, as a fraction of the initial out-of-balance force.
const MIN_STAGE_FRACTION: f64 = 1e-6;

/// Newton's method with its buffers.
pub(crate) struct NewtonIteration {
    tangent: Tangent,
    first_tangent: FirstTangent,
    /// The present iterate of Δu.
    guess: Vec<f64>,
    /// Nonlinear force, linearised about the iterate.
    linearised_force: Vec<f64>,
    /// Displacement u* that the nonlinear force receives.
    force_displacement: Vec<f64>,
    search: IncrementSearch,
    /// Iterate at the end of the last stage of the continuation.
    stage_solution: Vec<f64>,
    /// Out-of-balance force at the start of the continuation.
    initial_imbalance: Vec<f64>,
    /// Largest force of the last iteration.
    force_scale: f64,
    /// Number of iterations so far.
    iterations: usize,
    /// Number of trials of the search for contact modes so far.
    trials: usize,
    /// Slowest method of the contact search so far.
    method: SearchMethod,
}

impl NewtonIteration {
    /// Buffers for this number of degrees of freedom.
    pub(crate) fn new(dofs: usize) -> Self {
        let zeros = vec![0.0; dofs];
        Self {
            tangent: Tangent::new(dofs),
            first_tangent: FirstTangent::default(),
            guess: zeros.clone(),
            linearised_force: zeros.clone(),
            force_displacement: zeros.clone(),
            search: IncrementSearch::new(dofs),
            stage_solution: zeros.clone(),
            initial_imbalance: zeros,
            force_scale: 0.0,
            iterations: 0,
            trials: 0,
            method: SearchMethod::ActiveSet,
        }
    }

    /// Computes the increment from the right-hand side in `linear`.
    pub(crate) fn solve(
        &mut self,
        linear: &mut LinearStep,
        data: StepData<'_>,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        let StepData { scene, state, forcing, .. } = data;
        self.trials = 0;
        self.iterations = 0;
        self.method = SearchMethod::ActiveSet;
        // The first iterate is the increment with the last velocity, without the ground's translation.
        let velocity = state.kinematics.velocity.iter();
        let pairs = velocity.zip(&forcing.translation_increment);
        for (guess, (v, dy)) in self.guess.iter_mut().zip(pairs) {
            *guess = v * scene.time_step - dy;
        }
        self.evaluate(linear, data, increment)?;
        let has_tangent = self.start_with_last_tangent(linear, data)?;
        let residual = self.iterate_whole_step(linear, data, has_tangent, increment)?;
        if residual.is_nan() || residual > STAGNATION_TOLERANCE.max(self.rounding(linear)) {
            self.continue_in_stages(linear, data, residual, increment)?;
        }
        increment.midstep_displacement.copy_from_slice(&self.force_displacement);
        increment.trials = self.trials;
        increment.method = self.method;
        let u = &state.kinematics.displacement;
        for (i, entry) in increment.force_displacement.iter_mut().enumerate() {
            *entry = u[i] + increment.displacement[i];
        }
        let translations = forcing.translations.iter().map(|translation| translation.displacement);
        scene.convert_to_force_displacement(
            &mut increment.force_displacement,
            &mut linear.base_means,
            translations,
        );
        Ok(())
    }

    /// Sets the operators to the tangent with which the step begins; false if it needs a new one.
    fn start_with_last_tangent(
        &mut self,
        linear: &mut LinearStep,
        data: StepData<'_>,
    ) -> Result<bool, StepError> {
        let first_tangent = self.first_tangent.of_step(data.state.step, &linear.operators.tangent);
        let Some(tangent) = first_tangent else { return Ok(false) };
        change_tangent(linear, data, tangent)?;
        Ok(true)
    }

    /// Values of the tangent with which the next step begins, for a checkpoint; empty for none.
    pub(crate) fn first_tangent<'a>(
        &'a self,
        step: usize,
        last_tangent: &'a SparseMatrix,
    ) -> &'a [f64] {
        self.first_tangent.values(step, last_tangent)
    }

    /// Sets the tangent with which the next step begins; an empty matrix for none.
    pub(crate) fn set_first_tangent(&mut self, step: usize, tangent: SparseMatrix) {
        self.first_tangent = FirstTangent::from_checkpoint(step, tangent);
    }

    /// Iterates until the out-of-balance force vanishes or does not decrease; returns its last relative value.
    ///
    /// `has_tangent`: whether the first iteration has the tangent of the operators.
    fn iterate_whole_step(
        &mut self,
        linear: &mut LinearStep,
        data: StepData<'_>,
        has_tangent: bool,
        increment: &mut Increment,
    ) -> Result<f64, StepError> {
        let mut residual = f64::INFINITY;
        let mut smallest_residual = f64::INFINITY;
        let mut stagnant_iterations = 0;
        // Out-of-balance force after the last iteration, relative to that before it.
        let mut contraction = f64::INFINITY;
        // Whether the last increment did not reduce the out-of-balance force.
        let mut has_grown = false;
        for iteration in 0..MAX_NEWTON_ITERATIONS {
            if has_grown && residual > STAGNATION_TOLERANCE.max(self.rounding(linear)) {
                self.search_along_increment(linear, data, increment)?;
                residual = self.relative_imbalance(increment);
            }
            // The iterate before the first solution does not satisfy the linear part of the equation.
            if iteration > 0 {
                let force = &increment.nonlinear_force;
                self.search.start_at(&self.guess, &self.linearised_force, force);
            }
            let keeps_tangent = if iteration == 0 {
                has_tangent
            } else {
                may_keep_tangent(self.guess.len(), contraction, residual, RESIDUAL_TOLERANCE)
            };
            if !keeps_tangent {
                self.update_tangent(linear, data)?;
            }
            let previous_residual = residual;
            residual = self.iterate(linear, data, 0.0, increment)?;
            if previous_residual.is_finite() {
                contraction = residual / previous_residual;
            }
            has_grown = iteration > 0 && residual >= previous_residual;
            // The first solution is only a prediction, since its tangent may belong to the previous step.
            if residual <= RESIDUAL_TOLERANCE && (iteration > 0 || residual == 0.0) {
                break;
            }
            if self.has_reached_rounding(linear, contraction, residual) {
                break;
            }
            stagnant_iterations =
                if residual < smallest_residual { 0 } else { stagnant_iterations + 1 };
            smallest_residual = smallest_residual.min(residual);
            if stagnant_iterations >= MAX_STAGNANT_ITERATIONS
                && smallest_residual > STAGNATION_TOLERANCE
            {
                break;
            }
        }
        Ok(residual)
    }

    /// Whether the out-of-balance force is rounding that further iterations do not reduce.
    fn has_reached_rounding(&self, linear: &LinearStep, contraction: f64, residual: f64) -> bool {
        let has_stalled = contraction.is_finite() && contraction >= ROUNDING_RATIO;
        has_stalled && residual <= self.rounding(linear)
    }

    /// Relative out-of-balance force due to rounding of displacements.
    ///
    /// A building with yielded columns comes to rest with an offset. The last digit of the offset times the stiffness is not
    /// small relative to forces that tend to zero.
    fn rounding(&self, linear: &LinearStep) -> f64 {
        let entries = linear.operators.tangent.entries();
        let forces = entries.map(|(_, j, stiffness)| stiffness * self.force_displacement[j]);
        DISPLACEMENT_ROUNDING_FACTOR
            * f64::EPSILON
            * forces.fold(0.0_f64, |max, force| max.max(force.abs()))
            / self.force_scale
    }

    /// Continuation: removes the out-of-balance force of the last iterate in stages.
    ///
    /// The last iterate is the solution with an external force equal to its out-of-balance force. Newton's method cycles
    /// if a hysteretic law sticks between two states in which it slides, since the tangent of sliding does not contain the
    /// stiffness of sticking. A stage that is short enough crosses at most one kink, where the method converges. For
    /// monotone forces the path is continuous and does not turn back.
    ///
    /// `initial_residual` is the relative out-of-balance force of the last iterate, for errors.
    fn continue_in_stages(
        &mut self,
        linear: &mut LinearStep,
        data: StepData<'_>,
        initial_residual: f64,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        for (i, imbalance) in self.initial_imbalance.iter_mut().enumerate() {
            *imbalance = increment.nonlinear_force[i] - self.linearised_force[i];
        }
        self.stage_solution.copy_from_slice(&self.guess);
        let mut remaining_fraction = 1.0;
        let mut stage_fraction = 0.5;
        while remaining_fraction > 0.0 {
            let target_fraction = if stage_fraction < remaining_fraction {
                remaining_fraction - stage_fraction
            } else {
                0.0
            };
            let tolerance =
                if target_fraction > 0.0 { STAGNATION_TOLERANCE } else { RESIDUAL_TOLERANCE };
            let mut residual = f64::INFINITY;
            for _ in 0..MAX_STAGE_ITERATIONS {
                self.update_tangent(linear, data)?;
                residual = self.iterate(linear, data, target_fraction, increment)?;
                if residual <= tolerance {
                    break;
                }
            }
            if residual <= STAGNATION_TOLERANCE {
                self.stage_solution.copy_from_slice(&self.guess);
                remaining_fraction = target_fraction;
                stage_fraction *= 2.0;
                continue;
            }
            stage_fraction = 0.5 * stage_fraction.min(remaining_fraction);
            if stage_fraction < MIN_STAGE_FRACTION || self.iterations > MAX_TOTAL_ITERATIONS {
                let residual = remaining_fraction * initial_residual;
                return Err(self.failure(data, residual, increment));
            }
            self.guess.copy_from_slice(&self.stage_solution);
            self.evaluate(linear, data, increment)?;
        }
        Ok(())
    }

    /// Computes the tangent at the iterate, and the operators with it if it differs from the last one.
    fn update_tangent(
        &mut self,
        linear: &mut LinearStep,
        data: StepData<'_>,
    ) -> Result<(), StepError> {
        self.tangent
            .refill(data.structure, &self.force_displacement)
            .map_err(StepError::part("tangent of the structure"))?;
        change_tangent(linear, data, &self.tangent.matrix)
    }

    /// Solves the step with the force linearised about the iterate, and returns the relative out-of-balance force.
    ///
    /// The fraction `imbalance_fraction` of the initial out-of-balance force acts as an external force. The increment becomes
    /// the next iterate. The result is relative to the largest force.
    fn iterate(
        &mut self,
        linear: &mut LinearStep,
        data: StepData<'_>,
        imbalance_fraction: f64,
        increment: &mut Increment,
    ) -> Result<f64, StepError> {
        let StepData { scene, .. } = data;
        self.iterations += 1;
        let stiffness_factor = scene.coefficients.displacement[0];
        // f(u*) linearised about the iterate g: f + θ D (Δu − g), with θ = `stiffness_factor`.
        self.linearised_force.copy_from_slice(&increment.nonlinear_force);
        let tangent = &linear.operators.tangent;
        tangent.multiply_add(-stiffness_factor, &self.guess, &mut self.linearised_force);
        for (i, du) in increment.displacement.iter_mut().enumerate() {
            *du = linear.right_hand_side[i] - self.linearised_force[i];
        }
        if imbalance_fraction > 0.0 {
            for (du, imbalance) in increment.displacement.iter_mut().zip(&self.initial_imbalance) {
                *du += imbalance_fraction * imbalance;
            }
        }
        linear.solve_contact(data, increment)?;
        self.trials += increment.trials;
        self.method = self.method.max(increment.method);
        let tangent = &linear.operators.tangent;
        tangent.multiply_add(stiffness_factor, &increment.displacement, &mut self.linearised_force);
        self.guess.copy_from_slice(&increment.displacement);
        self.evaluate(linear, data, increment)?;
        self.force_scale =
            largest(&linear.right_hand_side).max(largest(&increment.nonlinear_force));
        Ok(self.relative_imbalance(increment))
    }

    /// Largest out-of-balance force of the iterate, relative to the largest force.
    fn relative_imbalance(&self, increment: &Increment) -> f64 {
        let imbalance = self
            .linearised_force
            .iter()
            .zip(&increment.nonlinear_force)
            .fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()));
        if self.force_scale > 0.0 { imbalance / self.force_scale } else { 0.0 }
    }

    /// Moves the iterate back along its last increment, if the increment passed the balance on this line.
    fn search_along_increment(
        &mut self,
        linear: &mut LinearStep,
        data: StepData<'_>,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        let Self { search, guess, linearised_force, force_displacement, .. } = self;
        let nonlinear_force = &mut increment.nonlinear_force;
        search.search(guess, linearised_force, nonlinear_force, |guess, force| {
            evaluate_force(linear, data, guess, force_displacement, force)
        })?;
        Ok(())
    }

    /// Error for an iteration that did not converge; `residual` is its relative out-of-balance force.
    fn failure(&self, data: StepData<'_>, residual: f64, increment: &Increment) -> StepError {
        let forces = self.linearised_force.iter().zip(&increment.nonlinear_force);
        let imbalance: Vec<f64> = forces.map(|(a, b)| (a - b).abs()).collect();
        let mut dofs: Vec<usize> = (0..imbalance.len()).filter(|i| imbalance[*i] > 0.0).collect();
        dofs.sort_by(|i, j| imbalance[*j].total_cmp(&imbalance[*i]));
        dofs.truncate(REPORTED_DOFS);
        let nonlinear_force = data.structure.nonlinear();
        let state = nonlinear_force.and_then(|f| f.describe_state(&self.force_displacement, &dofs));
        StepError::Newton {
            iterations: self.iterations,
            residual,
            modes: increment.modes.iter().map(|mode| mode.word()).collect(),
            state,
        }
    }

    /// Evaluates f at u* for the present iterate, minus f at the static state.
    fn evaluate(
        &mut self,
        linear: &mut LinearStep,
        data: StepData<'_>,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        let Self { guess, force_displacement, .. } = self;
        evaluate_force(linear, data, guess, force_displacement, &mut increment.nonlinear_force)
    }
}
