//! One step of the coupled problem.
//!
//! | symbol | meaning |
//! |---|---|
//! | Δu | displacement increment of the structure's unknowns |
//! | u*, v*, a* | where the time scheme writes the equation of motion |
//! | τ | change of contact traction against the static state |
//! | s | soil displacement by the changes of traction: history + G¹ τ |
//! | B, A | element means of the base displacement, element lengths |

use super::contact::ContactInput;
use super::coordinates::Motion;
use super::modes::SearchMethod;
use super::operators::Operators;
use super::scheme::SchemeCoefficients;
use super::simulation::Simulation;
use super::state::{State, Transition};
use crate::error::{Error, Result, StepError};
use crate::interface::StepStart;
use crate::linalg::{dot, largest, wide_transposed_multiply_add};

/// Newton iterations for a nonlinear structure.
const NEWTON_ITERATIONS: usize = 40;
/// Out-of-balance force at which Newton's iteration ends, relative to the largest force.
const NEWTON_TOLERANCE: f64 = 1e-12;
/// Change of an unknown in a step, in any units that somebody may use, beyond which no structure is
/// left.
const RUNAWAY: f64 = 1e15;

impl Simulation {
    /// Makes one step and returns the new state.
    ///
    /// # Errors
    /// [`Error::Step`] if the step could not be solved; the simulation is then as it was before.
    pub fn step(&mut self) -> Result<&State> {
        let step = self.state.step + 1;
        let time = step as f64 * self.time_step;
        let failed = |source| Error::Step { step, time, source };
        let observed = self.observe_ground(time);
        // A ground that cannot go with the motion says why.
        self.ground
            .history(&mut self.work.history)
            .map_err(|error| failed(StepError::Ground(Box::new(error))))?;
        observed.map_err(failed)?;
        if self.work.history.iter().any(|x| !x.is_finite()) {
            return Err(failed(StepError::NotFinite { quantity: "history of the ground" }));
        }
        let ride = self.known_forces();
        let (trials, method) = if self.model.linear {
            self.solve_linear().map_err(failed)?
        } else {
            self.solve_newton().map_err(failed)?
        };
        let finite = self.work.increment.iter().all(|x| x.is_finite());
        if !finite {
            return Err(failed(StepError::NotFinite { quantity: "displacement of the structure" }));
        }
        let increment = largest(&self.work.increment);
        if increment > RUNAWAY {
            return Err(failed(StepError::Runaway { increment }));
        }
        self.commit(step, time, &ride);
        self.state.trials = trials;
        self.state.method = method;
        Ok(&self.state)
    }

    /// Free field at the end of the step, measured from that at t = 0.
    fn observe_ground(&mut self, time: f64) -> std::result::Result<(), StepError> {
        let out = &mut self.work.free_field;
        self.ground.free_field(self.motion.as_ref(), time, out);
        for (value, start) in out.iter_mut().zip(&self.memory.start_motion) {
            *value -= start;
        }
        if out.iter().all(|x| x.is_finite()) {
            Ok(())
        } else {
            Err(StepError::NotFinite { quantity: "free field" })
        }
    }

    /// Fills `work.known` with the right-hand side of K_eff Δu = …, contact and f(u) left out, and
    /// returns how the free field rides: its increment and its velocity at v*.
    fn known_forces(&mut self) -> Ride {
        let c = self.coefficients;
        let ride = self.ride();
        let Motion { displacement: u, velocity: v, acceleration: a, .. } = &self.state.motion;
        let work = &mut self.work;
        work.load.fill(0.0);
        let load_time = self.state.time + c.load_fraction * self.time_step;
        self.model.load(load_time, &self.static_load, &mut work.vector, &mut work.load);
        work.known.copy_from_slice(&work.load);
        let [horizontal, vertical] = &self.model.ride;
        for (i, x) in work.vector.iter_mut().enumerate() {
            *x = SchemeCoefficients::apply(c.acceleration, 0.0, v[i], a[i]);
        }
        self.model.mass.multiply_add(-1.0, &work.vector, &mut work.known);
        if !self.model.damping.is_empty() {
            for (i, x) in work.vector.iter_mut().enumerate() {
                *x = SchemeCoefficients::apply(c.velocity, 0.0, v[i], a[i])
                    - horizontal[i] * ride.velocity[0]
                    - vertical[i] * ride.velocity[1];
            }
            self.model.damping.multiply_add(-1.0, &work.vector, &mut work.known);
        }
        for (i, x) in work.vector.iter_mut().enumerate() {
            *x = u[i] + SchemeCoefficients::apply(c.displacement, 0.0, v[i], a[i]);
        }
        if self.model.needs_sparing() {
            self.base.means(&work.vector, &mut work.means);
            self.model.spare(&mut work.vector, self.base.ride(&work.means));
        }
        self.model.stiffness.multiply_add(-1.0, &work.vector, &mut work.known);
        ride
    }

    /// The mean free field, stepped by the same scheme as the structure, so that a structure that
    /// rides with the ground sees no damping force.
    fn ride(&self) -> Ride {
        let c = &self.coefficients;
        let lengths = self.base.lengths();
        let width: f64 = lengths.iter().sum();
        let (down, along) = self.work.free_field.split_at(lengths.len());
        let mean = |s: &[f64]| dot(s, lengths) / width;
        let displacement = [mean(along), -mean(down)];
        let increment: [f64; 2] =
            std::array::from_fn(|k| displacement[k] - self.state.free_field[k]);
        let memory = &self.memory;
        let next = |coefficients| -> [f64; 2] {
            std::array::from_fn(|k| {
                let (v, a) = (memory.ride_velocity[k], memory.ride_acceleration[k]);
                SchemeCoefficients::apply(coefficients, increment[k], v, a)
            })
        };
        Ride {
            displacement,
            increment,
            velocity: next(c.velocity),
            new_velocity: next(c.new_velocity),
            new_acceleration: next(c.new_acceleration),
        }
    }

    /// Linear structure: one back-substitution, the contact problem, and the tractions' answer.
    fn solve_linear(&mut self) -> std::result::Result<Solved, StepError> {
        self.work.increment.copy_from_slice(&self.work.known);
        self.solve_contact()
    }

    /// Takes the right-hand side in `work.increment` and leaves the increment there.
    fn solve_contact(&mut self) -> std::result::Result<Solved, StepError> {
        let work = &mut self.work;
        self.operators.solve(&mut work.increment);
        let displacement = &self.state.motion.displacement;
        for ((x, u), du) in work.vector.iter_mut().zip(displacement).zip(&work.increment) {
            *x = u + du;
        }
        self.base.means(&work.vector, &mut work.means);
        let mut length_scale = 0.0_f64;
        let count = self.state.modes.len();
        for (i, jump) in work.free_jump.iter_mut().enumerate() {
            let (ground, means) = (work.free_field[i] + work.history[i], work.means[i]);
            *jump = ground - means;
            length_scale = length_scale.max(ground.abs()).max(means.abs());
        }
        for (jump, gap) in work.free_jump[..count].iter_mut().zip(&self.static_state.gap) {
            *jump += gap;
        }
        // `max` ignores NaN, so the jumps themselves are asked.
        if !(length_scale.is_finite() && work.free_jump.iter().all(|jump| jump.is_finite())) {
            return Err(StepError::NotFinite { quantity: "displacement of the structure" });
        }
        let input = ContactInput {
            delassus: &self.operators.delassus,
            free_jump: &work.free_jump,
            static_traction: &self.static_state.traction,
            start: &self.start,
            laws: &self.laws,
            length_scale,
        };
        work.modes.copy_from_slice(&self.state.modes);
        let solved = self.search.solve(&mut self.solver, &input, &mut work.modes)?;
        let columns = &self.operators.columns;
        wide_transposed_multiply_add(columns, -1.0, &self.solver.traction, &mut work.increment);
        Ok(solved)
    }

    /// Nonlinear structure: Newton's method around the whole step, contact inside.
    fn solve_newton(&mut self) -> std::result::Result<Solved, StepError> {
        let mut guess = std::mem::take(&mut self.work.guess);
        let mut linearised = std::mem::take(&mut self.work.linearised);
        let solved = self.iterate(&mut guess, &mut linearised);
        (self.work.guess, self.work.linearised) = (guess, linearised);
        solved
    }

    /// Newton's iterations, with the increment and its linearised force as scratch.
    fn iterate(
        &mut self,
        guess: &mut [f64],
        linearised: &mut [f64],
    ) -> std::result::Result<Solved, StepError> {
        let c = self.coefficients;
        let weight = c.displacement[0];
        let n = self.model.unknowns;
        // The increment that the last velocity suggests.
        for (guess, v) in guess.iter_mut().zip(&self.state.motion.velocity) {
            *guess = v * self.time_step;
        }
        let mut residual = f64::INFINITY;
        let (mut trials, mut method) = (0, SearchMethod::ActiveSet);
        for iteration in 0..NEWTON_ITERATIONS {
            self.evaluate_nonlinear(guess);
            self.model
                .refill_tangent(&self.work.total, &mut self.work.tangent)
                .map_err(|_| StepError::NotFinite { quantity: "tangent of the structure" })?;
            if !self.work.tangent.entries().eq(self.operators.tangent.entries()) {
                let (model, base, soil) = (&self.model, &self.base, &self.soil);
                let tangent = self.work.tangent.clone();
                self.operators = Operators::new(model, base, soil, &c, tangent)
                    .map_err(|_| StepError::Singular { matrix: "effective stiffness matrix" })?;
                self.solver.invalidate();
            }
            // K_eff Δu + f(u*) linearised at the guess: f + D weight (Δu − guess).
            linearised.copy_from_slice(&self.work.force);
            self.operators.tangent.multiply_add(-weight, guess, linearised);
            for i in 0..n {
                self.work.increment[i] = self.work.known[i] - linearised[i];
            }
            let (more, last_method) = self.solve_contact()?;
            trials += more;
            method = method.max(last_method);
            self.operators.tangent.multiply_add(weight, &self.work.increment, linearised);
            guess.copy_from_slice(&self.work.increment);
            self.evaluate_nonlinear(guess);
            if self.work.force.iter().any(|f| !f.is_finite()) {
                return Err(StepError::NotFinite { quantity: "nonlinear force of the structure" });
            }
            let scale = largest(&self.work.known).max(largest(&self.work.force));
            let open = linearised
                .iter()
                .zip(&self.work.force)
                .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
            residual = if scale > 0.0 { open / scale } else { 0.0 };
            // The first solve only predicts: its tangent may belong to the step before.
            if residual <= NEWTON_TOLERANCE && (iteration > 0 || open == 0.0) {
                return Ok((trials, method));
            }
        }
        if residual <= 1e3 * NEWTON_TOLERANCE {
            return Ok((trials, method));
        }
        Err(StepError::Newton {
            iterations: NEWTON_ITERATIONS,
            residual,
            modes: self.work.modes.clone(),
        })
    }

    /// f at u* for an increment, minus f at the static state, into `work.force`.
    fn evaluate_nonlinear(&mut self, increment: &[f64]) {
        let c = self.coefficients.displacement;
        let Motion { displacement: u, velocity: v, acceleration: a, .. } = &self.state.motion;
        let work = &mut self.work;
        for (i, total) in work.total.iter_mut().enumerate() {
            *total = self.static_state.displacement[i]
                + u[i]
                + SchemeCoefficients::apply(c, increment[i], v[i], a[i]);
        }
        work.force.fill(0.0);
        self.model.structure.nonlinear_force(&work.total, &mut work.force);
        for (force, at_rest) in work.force.iter_mut().zip(&self.static_force) {
            *force -= at_rest;
        }
    }

    /// Accepts the step: books it, then moves state, soil and structure to its end.
    fn commit(&mut self, step: usize, time: f64, ride: &Ride) {
        let c = self.coefficients;
        let Motion { velocity, acceleration, .. } = &self.state.motion;
        for (i, (v, a)) in velocity.iter().zip(acceleration).enumerate() {
            let du = self.work.increment[i];
            self.work.new_velocity[i] = SchemeCoefficients::apply(c.new_velocity, du, *v, *a);
            self.work.new_acceleration[i] =
                SchemeCoefficients::apply(c.new_acceleration, du, *v, *a);
        }
        self.book(ride);
        let state = &mut self.state;
        for (u, du) in state.motion.displacement.iter_mut().zip(&self.work.increment) {
            *u += du;
        }
        std::mem::swap(&mut state.motion.velocity, &mut self.work.new_velocity);
        std::mem::swap(&mut state.motion.acceleration, &mut self.work.new_acceleration);
        state.motion.changed();
        state.contact.copy_from_slice(&self.solver.states);
        state.transitions.clear();
        for (element, (from, &to)) in state.modes.iter_mut().zip(&self.work.modes).enumerate() {
            if *from != to {
                state.transitions.push(Transition { step, time, element, from: *from, to });
                *from = to;
            }
        }
        for (e, start) in self.start.iter_mut().enumerate() {
            let slip_rate = (state.contact[e].slip - start.state.slip) / self.time_step;
            *start = StepStart {
                state: state.contact[e],
                mode: state.modes[e],
                has_opened: start.has_opened || !state.modes[e].is_closed(),
                slip_rate,
                ..*start
            };
        }
        self.memory.ride_velocity = ride.new_velocity;
        self.memory.ride_acceleration = ride.new_acceleration;
        self.memory.free_field.copy_from_slice(&self.work.free_field);
        self.memory.soil_displacement.copy_from_slice(&self.work.soil_displacement);
        state.free_field = ride.displacement;
        state.step = step;
        state.time = time;
        self.ground.commit(&self.solver.traction);
        if !self.model.linear {
            for (i, total) in self.work.total.iter_mut().enumerate() {
                *total = self.static_state.displacement[i] + self.state.motion.displacement[i];
            }
            self.model.structure.commit(&self.work.total);
        }
        self.update_resultants();
    }

    /// Resultants and probes from the present state.
    pub(super) fn update_resultants(&mut self) {
        let state = &mut self.state;
        let Motion { displacement, velocity, acceleration, .. } = &state.motion;
        let (mut total, mut open, mut slip, mut width) = ([0.0; 3], 0.0, 0.0, 0.0);
        state.base_rotation = 0.0;
        for (k, foundation) in state.foundations.iter_mut().enumerate() {
            let (first, last) = (foundation.elements.start, foundation.elements.end - 1);
            let [mut shear, mut normal, mut moment] = [0.0; 3];
            let [mut own_open, mut own_slip, mut own_width] = [0.0; 3];
            for e in first..=last {
                let (contact, length) = (&state.contact[e], self.base.length(e));
                own_width += length;
                shear += length * contact.shear;
                normal += length * contact.pressure;
                own_slip += length * contact.slip;
                moment -= length * contact.pressure * self.arms[e];
                if !state.modes[e].is_closed() {
                    own_open += length;
                }
            }
            for (sum, own) in total.iter_mut().zip([shear, normal, moment]) {
                *sum += own;
            }
            open += own_open;
            slip += own_slip;
            width += own_width;
            let left = self.arms[first] - 0.5 * self.base.length(first);
            let right = self.arms[last] + 0.5 * self.base.length(last);
            foundation.shear = shear;
            foundation.normal_force = normal;
            foundation.moment = moment + normal * 0.5 * (left + right);
            foundation.uplifted_fraction = own_open / own_width;
            foundation.mean_slip = own_slip / own_width;
            foundation.rotation = self.base.rotation(k, displacement);
            if foundation.rotation.abs() > state.base_rotation.abs() {
                state.base_rotation = foundation.rotation;
            }
        }
        [state.base_shear, state.normal_force, state.base_moment] = total;
        state.uplifted_fraction = open / width;
        state.mean_slip = slip / width;
        for (value, [u, v, a]) in state.probes.iter_mut().zip(&self.probe_rows) {
            *value = u.of(displacement) + v.of(velocity) + a.of(acceleration);
        }
    }
}

/// Trials of the mode search and its method.
type Solved = (usize, SearchMethod);

/// The mean free field over a step: `[horizontal, vertical up]`.
pub(super) struct Ride {
    pub(super) displacement: [f64; 2],
    pub(super) increment: [f64; 2],
    pub(super) velocity: [f64; 2],
    new_velocity: [f64; 2],
    new_acceleration: [f64; 2],
}
