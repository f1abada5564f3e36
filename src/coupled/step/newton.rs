//! Newton's method around the whole step of a nonlinear structure, contact inside.

use crate::contact::SearchMethod;
use crate::coupled::model::kinematics::Kinematics;
use crate::coupled::model::operators::{Factor, Operators};
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::step::forcing::StepData;
use crate::coupled::step::increment::Increment;
use crate::coupled::step::linear::LinearStep;
use crate::error::StepError;
use crate::linalg::largest;
use crate::structure::Tangent;

/// Largest number of iterations of a step.
const MAX_NEWTON_ITERATIONS: usize = 40;
/// Out-of-balance force at which the iteration ends, relative to the largest force.
const RESIDUAL_TOLERANCE: f64 = 1e-12;
/// Out-of-balance force that is accepted if the iteration stagnates.
const STAGNATION_TOLERANCE: f64 = 1e3 * RESIDUAL_TOLERANCE;
/// Rounding errors of a displacement, in units of its last digit, that may cause a force.
const DISPLACEMENT_ROUNDINGS: f64 = 32.0;
/// Number of iterations without a smaller out-of-balance force that counts as a cycle.
const MAX_STAGNANT_ITERATIONS: usize = 15;

/// Largest number of iterations of a stage of the continuation.
const MAX_STAGE_ITERATIONS: usize = 8;
/// Largest number of iterations of all stages of the continuation.
const MAX_TOTAL_ITERATIONS: usize = 2000;
/// Shortest stage, as a fraction of the initial out-of-balance force.
const MIN_STAGE_FRACTION: f64 = 1e-6;

/// Scratch of the iteration.
pub(crate) struct NewtonIteration {
    tangent: Tangent,
    /// The iterate, and the force linearised about it.
    guess: Vec<f64>,
    linearised: Vec<f64>,
    /// Displacement at u* that the force receives.
    force_displacement: Vec<f64>,
    /// Increment at the end of the last stage of the continuation.
    reached: Vec<f64>,
    /// Out-of-balance force at the start of the continuation.
    open: Vec<f64>,
    /// Largest force of the last iteration.
    scale: f64,
    /// Number of iterations and contact trials, and the slowest method used so far.
    iterations: usize,
    trials: usize,
    method: SearchMethod,
}

impl NewtonIteration {
    pub(crate) fn new(dofs: usize) -> Self {
        let zeros = vec![0.0; dofs];
        Self {
            tangent: Tangent::new(dofs),
            guess: zeros.clone(),
            linearised: zeros.clone(),
            force_displacement: zeros.clone(),
            reached: zeros.clone(),
            open: zeros,
            scale: 0.0,
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
        (self.trials, self.method) = (0, SearchMethod::ActiveSet);
        // The increment by the last velocity, without the ground's translation.
        let velocity = state.kinematics.velocity.iter();
        for ((guess, v), carried) in self.guess.iter_mut().zip(velocity).zip(&forcing.carried) {
            *guess = v * scene.time_step - carried;
        }
        self.evaluate(linear, data, increment)?;
        let mut residual = f64::INFINITY;
        let mut smallest_residual = f64::INFINITY;
        let mut stagnant_iterations = 0;
        self.iterations = 0;
        for iteration in 0..MAX_NEWTON_ITERATIONS {
            residual = self.iterate(linear, data, 0.0, increment)?;
            // The first solution only predicts: its tangent may belong to the previous step.
            if residual <= RESIDUAL_TOLERANCE && (iteration > 0 || residual == 0.0) {
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
        if residual.is_nan() || residual > STAGNATION_TOLERANCE.max(self.rounding(linear)) {
            self.continuation(linear, data, residual, increment)?;
        }
        (increment.trials, increment.method) = (self.trials, self.method);
        let u = &state.kinematics.displacement;
        for (i, entry) in increment.force_displacement.iter_mut().enumerate() {
            *entry = u[i] + increment.displacement[i];
        }
        let translations = forcing.translations.iter().map(|translation| translation.displacement);
        scene.to_force_displacement(
            &mut increment.force_displacement,
            &mut linear.means,
            translations,
        );
        Ok(())
    }

    /// Relative out-of-balance force due to rounding of displacements.
    ///
    /// Once columns have yielded, a building comes to rest at an offset. The last digit of the offset times the
    /// stiffness is not small relative to forces that vanish.
    fn rounding(&self, linear: &LinearStep) -> f64 {
        let entries = linear.operators.tangent.entries();
        let forces = entries.map(|(_, j, stiffness)| stiffness * self.force_displacement[j]);
        DISPLACEMENT_ROUNDINGS
            * f64::EPSILON
            * forces.fold(0.0_f64, |largest, f| largest.max(f.abs()))
            / self.scale
    }

    /// Follows the solution from the last iterate while its out-of-balance force is removed in stages.
    ///
    /// The last iterate solves the step with an external force equal to its out-of-balance force. Newton's method
    /// returns to earlier iterates if a law sticks between two states in which it slides: tangents of sliding omit
    /// the force that sticking bears. A stage that is short enough crosses one kink at most, and there the method
    /// converges. For monotone forces the path is continuous and does not turn back.
    fn continuation(
        &mut self,
        linear: &mut LinearStep,
        data: StepData<'_>,
        began: f64,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        for (i, open) in self.open.iter_mut().enumerate() {
            *open = increment.force[i] - self.linearised[i];
        }
        self.reached.copy_from_slice(&self.guess);
        let mut remaining = 1.0;
        let mut stage = 0.5;
        while remaining > 0.0 {
            let aim = if stage < remaining { remaining - stage } else { 0.0 };
            let tolerance = if aim > 0.0 { STAGNATION_TOLERANCE } else { RESIDUAL_TOLERANCE };
            let mut residual = f64::INFINITY;
            for _ in 0..MAX_STAGE_ITERATIONS {
                residual = self.iterate(linear, data, aim, increment)?;
                if residual <= tolerance {
                    break;
                }
            }
            if residual <= STAGNATION_TOLERANCE {
                self.reached.copy_from_slice(&self.guess);
                remaining = aim;
                stage *= 2.0;
                continue;
            }
            stage = 0.5 * stage.min(remaining);
            if stage < MIN_STAGE_FRACTION || self.iterations > MAX_TOTAL_ITERATIONS {
                let modes = increment.modes.iter().map(|mode| mode.word()).collect();
                let iterations = self.iterations;
                return Err(StepError::Newton { iterations, residual: remaining * began, modes });
            }
            self.guess.copy_from_slice(&self.reached);
            self.evaluate(linear, data, increment)?;
        }
        Ok(())
    }

    /// Solves the step with the force linearised about the guess, and the fraction `remaining` of the open force.
    ///
    /// The open force acts as an external force. The increment becomes the next guess. Returns the out-of-balance
    /// force relative to the largest force.
    fn iterate(
        &mut self,
        linear: &mut LinearStep,
        data: StepData<'_>,
        remaining: f64,
        increment: &mut Increment,
    ) -> Result<f64, StepError> {
        let StepData { scene, structure, .. } = data;
        self.iterations += 1;
        let weight = scene.coefficients.displacement[0];
        self.tangent
            .refill(structure, &self.force_displacement)
            .map_err(StepError::part("tangent of the structure"))?;
        let tangent = &self.tangent.matrix;
        if !tangent.entries().eq(linear.operators.tangent.entries()) {
            let model = &scene.model;
            let base = &scene.base;
            let factor = Factor::of_dofs(model, &scene.coefficients, tangent)
                .map_err(StepError::part("tangent of the structure"))?;
            let tangent = tangent.clone();
            linear.operators =
                Operators::new(model, base, &scene.soil, Factor::Sparse(factor), tangent)
                    .map_err(StepError::part("tangent of the structure"))?;
            linear.contact.invalidate();
        }
        // K_eff Δu + f(u*) linearised at the guess: f + D weight (Δu − guess).
        self.linearised.copy_from_slice(&increment.force);
        let tangent = &linear.operators.tangent;
        tangent.multiply_add(-weight, &self.guess, &mut self.linearised);
        for (i, du) in increment.displacement.iter_mut().enumerate() {
            *du = linear.right_side[i] - self.linearised[i];
        }
        if remaining > 0.0 {
            let open = self.open.iter();
            increment
                .displacement
                .iter_mut()
                .zip(open)
                .for_each(|(du, open)| *du += remaining * open);
        }
        linear.solve_contact(data, increment)?;
        self.trials += increment.trials;
        self.method = self.method.max(increment.method);
        let tangent = &linear.operators.tangent;
        tangent.multiply_add(weight, &increment.displacement, &mut self.linearised);
        self.guess.copy_from_slice(&increment.displacement);
        self.evaluate(linear, data, increment)?;
        self.scale = largest(&linear.right_side).max(largest(&increment.force));
        let open = self
            .linearised
            .iter()
            .zip(&increment.force)
            .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        Ok(if self.scale > 0.0 { open / self.scale } else { 0.0 })
    }

    /// f at u* for the guess, minus f at the static state.
    fn evaluate(
        &mut self,
        linear: &mut LinearStep,
        data: StepData<'_>,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        let StepData { scene, structure, state, forcing } = data;
        let c = scene.coefficients.displacement;
        let Kinematics { displacement: u, velocity: v, acceleration: a, .. } = &state.kinematics;
        for (i, entry) in self.force_displacement.iter_mut().enumerate() {
            *entry = u[i] + SchemeCoefficients::apply(c, self.guess[i], v[i], a[i]);
        }
        let translations = forcing
            .translations
            .iter()
            .map(|y| [0, 1, 2].map(|k| y.displacement[k] - (1.0 - c[0]) * y.increment[k]));
        scene.to_force_displacement(&mut self.force_displacement, &mut linear.means, translations);
        increment.force.fill(0.0);
        if let Some(nonlinear) = structure.nonlinear() {
            nonlinear
                .force(&self.force_displacement, &mut increment.force)
                .map_err(StepError::part("nonlinear force of the structure"))?;
        }
        for (force, at_rest) in increment.force.iter_mut().zip(&scene.static_state.force) {
            *force -= at_rest;
        }
        StepError::check_finite("nonlinear force of the structure", &increment.force)
    }
}
