//! Newton's method around the whole step of a nonlinear structure, contact inside.

use super::forcing::Forcing;
use super::increment::Increment;
use super::linear::LinearStep;
use crate::contact::SearchMethod;
use crate::coupled::motion::Motion;
use crate::coupled::scene::Scene;
use crate::coupled::scene::model::Tangent;
use crate::coupled::scene::operators::{Factor, Operators};
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::state::State;
use crate::error::StepError;
use crate::linalg::largest;
use crate::structure::Structure;

/// Iterations of a step.
const ITERATIONS: usize = 40;
/// Out-of-balance force at which the iteration ends, relative to the largest force.
const TOLERANCE: f64 = 1e-12;

/// Scratch of the iteration.
pub(super) struct Newton {
    tangent: Tangent,
    /// The iterate, and the force linearised about it.
    guess: Vec<f64>,
    linearised: Vec<f64>,
    /// Displacement at u* that the force sees.
    seen: Vec<f64>,
}

impl Newton {
    pub(super) fn new(unknowns: usize) -> Self {
        let zero = || vec![0.0; unknowns];
        Self { tangent: Tangent::new(unknowns), guess: zero(), linearised: zero(), seen: zero() }
    }

    /// Finds the increment from the right-hand side that `linear` knows.
    pub(super) fn solve(
        &mut self,
        linear: &mut LinearStep,
        scene: &Scene,
        structure: &dyn Structure,
        state: &State,
        forcing: &Forcing,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        let weight = scene.coefficients.displacement[0];
        // The increment that the last velocity suggests, as far as it is not the ground's.
        let velocity = state.motion.velocity.iter();
        for ((guess, v), carried) in self.guess.iter_mut().zip(velocity).zip(&forcing.carried) {
            *guess = v * scene.time_step - carried;
        }
        let mut residual = f64::INFINITY;
        let (mut trials, mut method) = (0, SearchMethod::ActiveSet);
        self.evaluate(linear, scene, structure, state, forcing, increment)?;
        for iteration in 0..ITERATIONS {
            self.tangent
                .refill(structure, &self.seen)
                .map_err(StepError::structure("tangent of the structure"))?;
            let tangent = &self.tangent.matrix;
            if !tangent.entries().eq(linear.operators.tangent.entries()) {
                let (model, base) = (&scene.model, &scene.base);
                let factor = Factor::new(model, &scene.coefficients, tangent)
                    .map_err(|_| StepError::Singular { matrix: "effective stiffness matrix" })?;
                let tangent = tangent.clone();
                linear.operators = Operators::new(model, base, &scene.soil, factor, tangent);
                linear.contact.invalidate();
            }
            // K_eff Δu + f(u*) linearised at the guess: f + D weight (Δu − guess).
            self.linearised.copy_from_slice(&increment.force);
            let tangent = &linear.operators.tangent;
            tangent.multiply_add(-weight, &self.guess, &mut self.linearised);
            for (i, du) in increment.displacement.iter_mut().enumerate() {
                *du = linear.known[i] - self.linearised[i];
            }
            linear.solve_contact(scene, state, forcing, increment)?;
            trials += increment.trials;
            method = method.max(increment.method);
            let tangent = &linear.operators.tangent;
            tangent.multiply_add(weight, &increment.displacement, &mut self.linearised);
            self.guess.copy_from_slice(&increment.displacement);
            self.evaluate(linear, scene, structure, state, forcing, increment)?;
            if increment.force.iter().any(|f| !f.is_finite()) {
                return Err(StepError::NotFinite { quantity: "nonlinear force of the structure" });
            }
            let scale = largest(&linear.known).max(largest(&increment.force));
            let open = self
                .linearised
                .iter()
                .zip(&increment.force)
                .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
            residual = if scale > 0.0 { open / scale } else { 0.0 };
            // The first solve only predicts: its tangent may belong to the step before.
            if residual <= TOLERANCE && (iteration > 0 || open == 0.0) {
                break;
            }
        }
        if residual.is_nan() || residual > 1e3 * TOLERANCE {
            let modes = increment.modes.clone();
            return Err(StepError::Newton { iterations: ITERATIONS, residual, modes });
        }
        (increment.trials, increment.method) = (trials, method);
        let u = &state.motion.displacement;
        for (i, seen) in increment.seen.iter_mut().enumerate() {
            *seen = u[i] + increment.displacement[i];
        }
        let translations = forcing.translations.iter().map(|translation| translation.displacement);
        scene.seen_by_force(&mut increment.seen, &mut linear.means, translations);
        for (seen, at_rest) in increment.seen.iter_mut().zip(&scene.static_state.displacement) {
            *seen += at_rest;
        }
        Ok(())
    }

    /// f at u* for the guess, less f at the static state.
    fn evaluate(
        &mut self,
        linear: &mut LinearStep,
        scene: &Scene,
        structure: &dyn Structure,
        state: &State,
        forcing: &Forcing,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        let c = scene.coefficients.displacement;
        let Motion { displacement: u, velocity: v, acceleration: a, .. } = &state.motion;
        for (i, seen) in self.seen.iter_mut().enumerate() {
            *seen = u[i] + SchemeCoefficients::apply(c, self.guess[i], v[i], a[i]);
        }
        let translations = forcing
            .translations
            .iter()
            .map(|y| [0, 1].map(|k| y.displacement[k] - (1.0 - c[0]) * y.increment[k]));
        scene.seen_by_force(&mut self.seen, &mut linear.means, translations);
        for (seen, at_rest) in self.seen.iter_mut().zip(&scene.static_state.displacement) {
            *seen += at_rest;
        }
        increment.force.fill(0.0);
        if let Some(own) = structure.nonlinear() {
            own.force(&self.seen, &mut increment.force)
                .map_err(StepError::structure("nonlinear force of the structure"))?;
        }
        for (force, at_rest) in increment.force.iter_mut().zip(&scene.static_state.force) {
            *force -= at_rest;
        }
        Ok(())
    }
}
