//! Linear part of a step: one solve with the factored operators, the contact problem, and the response
//! to the tractions.
//!
//! | symbol | meaning |
//! |---|---|
//! | Δu | increment of displacement relative to the free field's translation y |
//! | u*, v*, a* | where the time scheme writes the equation of motion |
//! | τ | change of contact traction against the static state |
//! | B | element means of the base displacement |
//! | R | influence vectors |

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use super::{Forcing, Increment, StepData};
use crate::contact::{ContactInput, ContactSearch, ContactSolver, ModeSearch};
use crate::coupled::motion::Motion;
use crate::coupled::scene::Scene;
use crate::coupled::scene::operators::Operators;
use crate::coupled::scheme::SchemeCoefficients;
use crate::error::StepError;
use crate::linalg::matrix::Diagonals;
use crate::linalg::{Simd, WithSimd, transposed_multiply_add, vectorized};

/// Factored operators, the contact problem and the scratch of a step.
pub(super) struct LinearStep {
    /// Valid while the tangent is unchanged.
    pub(super) operators: Operators,
    pub(super) contact: ContactSolver,
    search: ModeSearch,
    /// Right-hand side of K_eff Δu = …, without contact and nonlinear force.
    pub(super) known: Vec<f64>,
    free_jump: Vec<f64>,
    pub(super) means: Vec<f64>,
    vector: Vec<f64>,
}

impl LinearStep {
    pub(super) fn new(scene: &Scene, operators: Operators, search: ContactSearch) -> Self {
        let n = scene.model.coordinates;
        Self {
            operators,
            contact: ContactSolver::new(scene.layout()),
            search: ModeSearch::new(scene.layout(), scene.base.areas(), scene.model.linear, search),
            known: vec![0.0; n],
            free_jump: vec![0.0; scene.layout().len()],
            means: vec![0.0; scene.layout().len()],
            vector: vec![0.0; n],
        }
    }

    /// Right-hand side of the equation of motion: loads, inertia and damping of a structure that is
    /// carried along by y, and its stiffness forces so far.
    pub(super) fn predict(&mut self, StepData { scene, state, forcing, .. }: StepData<'_>) {
        let (c, model) = (&scene.coefficients, &scene.model);
        let Motion { displacement: u, velocity: v, acceleration: a, .. } = &state.motion;
        let carried = &forcing.carried;
        let Self { known, vector, means, .. } = self;
        known.copy_from_slice(&forcing.load);
        SchemeCoefficients::combine(c.acceleration, carried, v, a, vector);
        model.mass.multiply_add(-1.0, vector, known);
        if model.damped {
            SchemeCoefficients::combine(c.velocity, carried, v, a, vector);
            vector.iter_mut().zip(&forcing.dragged).for_each(|(v, dragged)| *v -= dragged);
            model.damping.multiply_add(-1.0, vector, known);
        }
        for (x, ((u, v), a)) in vector.iter_mut().zip(u.iter().zip(v).zip(a)) {
            *x = u + SchemeCoefficients::apply(c.displacement, 0.0, *v, *a);
        }
        scene.subtract_base(vector, means);
        model.stiffness.multiply_add(-1.0, vector, known);
    }

    /// The increment of a linear structure, with what follows from it.
    pub(super) fn solve(
        &mut self,
        data: StepData<'_>,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        let StepData { scene, state, forcing, .. } = data;
        let (scheme, motion) = (&scene.coefficients, &state.motion);
        let Some(matrices) = scene.model.diagonals() else {
            self.predict(data);
            increment.displacement.copy_from_slice(&self.known);
            self.solve_contact(data, increment)?;
            increment.follow(data);
            return Ok(());
        };
        free(scheme, matrices, self.operators.reciprocals(), motion, forcing, increment);
        self.solve_tractions(data, increment)?;
        let Self { operators, contact, vector, .. } = self;
        vector.fill(0.0);
        scene.base.add_forces(1.0, &contact.traction, vector);
        let inverse = operators.reciprocals();
        answer(scheme, inverse, vector, motion, &forcing.carried, increment);
        Ok(())
    }

    /// Takes the right-hand side in the increment's displacement and leaves the increment there.
    pub(super) fn solve_contact(
        &mut self,
        data: StepData<'_>,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        self.operators.solve(&mut increment.displacement);
        increment.reach(data.state);
        self.solve_tractions(data, increment)?;
        let (columns, traction) = (&self.operators.columns, &self.contact.traction);
        transposed_multiply_add(columns, -1.0, traction, &mut increment.displacement);
        Ok(())
    }

    /// Contact tractions for the displacement that the step would end with without their change.
    fn solve_tractions(
        &mut self,
        data: StepData<'_>,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        let StepData { scene, state, forcing, .. } = data;
        let Self { operators, contact, search, free_jump, means, .. } = self;
        scene.base.means(&increment.end, means);
        let mut length_scale = 0.0_f64;
        for (i, jump) in free_jump.iter_mut().enumerate() {
            let (ground, base) = (forcing.distortion[i] + forcing.history[i], means[i]);
            *jump = ground - base;
            length_scale = length_scale.max(ground.abs()).max(base.abs());
        }
        for (jump, gap) in free_jump.iter_mut().zip(&scene.static_state.gap) {
            *jump += gap;
        }
        // `max` ignores NaN, so the jumps themselves are looked at.
        if !(length_scale.is_finite() && free_jump.iter().all(|jump| jump.is_finite())) {
            StepError::check_finite("displacement of the structure", &increment.end)?;
            StepError::check_finite("jump between soil and base", free_jump)?;
            StepError::check_finite("displacement of the base", means)?;
        }
        let input = ContactInput {
            delassus: &operators.delassus,
            free_jump,
            static_traction: &scene.static_state.traction,
            start: &state.start,
            laws: &scene.laws,
            length_scale,
            bonds: &[],
            frictionless: false,
        };
        increment.modes.copy_from_slice(&state.modes);
        let (trials, method) = search.solve(contact, &input, &mut increment.modes)?;
        (increment.trials, increment.method) = (trials, method);
        increment.stand_in = contact.stand_in;
        increment.traction.copy_from_slice(&contact.traction);
        increment.contact.copy_from_slice(&contact.states);
        Ok(())
    }
}

// The loops of a step in modes, where every matrix is diagonal: one before contact, one after.
//
// | symbol | meaning |
// |---|---|
// | m, d, k | modal mass, damping and stiffness |
// | 1/k_eff | reciprocals of the effective stiffness |
// | u, v, a | coordinates at the beginning of the step |
// | Δu, u₁, v₁, a₁ | increment, and coordinates at the end |
// | R Δy, R ẏ | part of the free field's translation |
//
// The loops are functions of their own, since the compiler knows of an argument, and not of a
// field, that nothing else points to what is written.

/// Δu and u₁ with the tractions held at their static values.
pub(super) fn free(
    scheme: &SchemeCoefficients,
    matrices: Diagonals<'_>,
    inverse: &[f64],
    motion: &Motion,
    forcing: &Forcing,
    increment: &mut Increment,
) {
    let [out, end] = [&mut increment.displacement, &mut increment.end].map(Vec::as_mut_slice);
    vectorized(Free { scheme, matrices, inverse, motion, forcing, out, end });
}

/// Takes away what the tractions' `force` does to Δu, and finds what follows from it.
pub(super) fn answer(
    scheme: &SchemeCoefficients,
    inverse: &[f64],
    force: &[f64],
    motion: &Motion,
    carried: &[f64],
    increment: &mut Increment,
) {
    vectorized(Answer { scheme, inverse, force, motion, carried, increment });
}

struct Free<'a> {
    scheme: &'a SchemeCoefficients,
    matrices: Diagonals<'a>,
    inverse: &'a [f64],
    motion: &'a Motion,
    forcing: &'a Forcing,
    out: &'a mut [f64],
    end: &'a mut [f64],
}

impl WithSimd for Free<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { scheme, matrices, inverse, motion, forcing, out, end } = self;
        balance(scheme, matrices, motion, forcing, out);
        release(inverse, &motion.displacement, out, end);
    }
}

/// Right-hand side of the equation of motion, as `LinearStep::predict` has it in degrees of freedom.
#[inline(always)]
fn balance(
    scheme: &SchemeCoefficients,
    matrices: Diagonals<'_>,
    motion: &Motion,
    forcing: &Forcing,
    out: &mut [f64],
) {
    let n = out.len();
    let Diagonals { mass, damping, stiffness } = matrices;
    let (m, k) = (&mass[..n], &stiffness[..n]);
    let (u, v, a) = (&motion.displacement[..n], &motion.velocity[..n], &motion.acceleration[..n]);
    let (load, carried) = (&forcing.load[..n], &forcing.carried[..n]);
    for j in 0..n {
        let acceleration = SchemeCoefficients::apply(scheme.acceleration, carried[j], v[j], a[j]);
        let displacement = u[j] + SchemeCoefficients::apply(scheme.displacement, 0.0, v[j], a[j]);
        out[j] = load[j] - m[j] * acceleration - k[j] * displacement;
    }
    if let Some(d) = damping {
        let (d, dragged) = (&d[..n], &forcing.dragged[..n]);
        for j in 0..n {
            let velocity = SchemeCoefficients::apply(scheme.velocity, carried[j], v[j], a[j]);
            out[j] -= d[j] * (velocity - dragged[j]);
        }
    }
}

/// Δu from the right-hand side, and u₁.
#[inline(always)]
fn release(inverse: &[f64], u: &[f64], out: &mut [f64], end: &mut [f64]) {
    let n = out.len();
    let (inverse, u, end) = (&inverse[..n], &u[..n], &mut end[..n]);
    for j in 0..n {
        out[j] *= inverse[j];
        end[j] = u[j] + out[j];
    }
}

struct Answer<'a> {
    scheme: &'a SchemeCoefficients,
    inverse: &'a [f64],
    force: &'a [f64],
    motion: &'a Motion,
    carried: &'a [f64],
    increment: &'a mut Increment,
}

impl WithSimd for Answer<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { scheme, inverse, force, motion, carried, increment } = self;
        let Increment { displacement, end, total, velocity, acceleration, .. } = increment;
        apply_force(inverse, force, displacement, end);
        follow(scheme, motion, carried, displacement, total, [velocity, acceleration]);
    }
}

/// Takes the response to the tractions' force out of Δu and u₁.
#[inline(always)]
fn apply_force(inverse: &[f64], force: &[f64], out: &mut [f64], end: &mut [f64]) {
    let n = out.len();
    let (inverse, force, end) = (&inverse[..n], &force[..n], &mut end[..n]);
    for j in 0..n {
        let taken = inverse[j] * force[j];
        out[j] -= taken;
        end[j] -= taken;
    }
}

/// Total increment, and velocity and acceleration at the end, as `Increment::follow` has them.
#[inline(always)]
fn follow(
    scheme: &SchemeCoefficients,
    motion: &Motion,
    carried: &[f64],
    out: &[f64],
    total: &mut [f64],
    [velocity, acceleration]: [&mut [f64]; 2],
) {
    let n = out.len();
    let (v, a, carried) = (&motion.velocity[..n], &motion.acceleration[..n], &carried[..n]);
    let (total, velocity, acceleration) =
        (&mut total[..n], &mut velocity[..n], &mut acceleration[..n]);
    for j in 0..n {
        let du = out[j] + carried[j];
        total[j] = du;
        velocity[j] = SchemeCoefficients::apply(scheme.new_velocity, du, v[j], a[j]);
        acceleration[j] = SchemeCoefficients::apply(scheme.new_acceleration, du, v[j], a[j]);
    }
}
