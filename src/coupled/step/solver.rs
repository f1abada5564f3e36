//! Solving a step: the increment of the structure's unknowns and the contact tractions.
//!
//! | symbol | meaning |
//! |---|---|
//! | Δu | increment of displacement relative to the free field's translation y |
//! | u*, v*, a* | where the time scheme writes the equation of motion |
//! | τ | change of contact traction against the static state |
//! | B | element means of the base displacement |
//! | R | influence vectors |

use super::forcing::Forcing;
use super::increment::Increment;
use super::newton::Newton;
use crate::contact::{ContactInput, ContactSolver, ModeSearch};
use crate::coupled::motion::Motion;
use crate::coupled::scene::Scene;
use crate::coupled::scene::operators::Operators;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::state::State;
use crate::error::StepError;
use crate::linalg::{largest, wide_transposed_multiply_add};
use crate::structure::Structure;

/// Change of an unknown in a step, in any units that somebody may use, beyond which no structure is
/// left.
const RUNAWAY: f64 = 1e15;

/// Factored operators, the contact problem and the scratch of a step.
pub(crate) struct Solver {
    /// Valid while the tangent is unchanged.
    pub(super) operators: Operators,
    pub(super) contact: ContactSolver,
    pub(super) search: ModeSearch,
    /// Right-hand side of K_eff Δu = …, without contact and nonlinear force.
    pub(super) known: Vec<f64>,
    free_jump: Vec<f64>,
    pub(super) means: Vec<f64>,
    vector: Vec<f64>,
    newton: Option<Newton>,
}

impl Solver {
    pub(crate) fn new(scene: &Scene, operators: Operators, search: ModeSearch) -> Self {
        let (n, count) = (scene.model.unknowns, scene.count());
        Self {
            operators,
            contact: ContactSolver::new(count),
            search,
            known: vec![0.0; n],
            free_jump: vec![0.0; 2 * count],
            means: vec![0.0; 2 * count],
            vector: vec![0.0; n],
            newton: (!scene.model.linear).then(|| Newton::new(n)),
        }
    }

    /// The operators of the last solve.
    pub(crate) fn operators(&self) -> &Operators {
        &self.operators
    }

    /// Both, for the assessment of their condition.
    pub(crate) fn parts_mut(&mut self) -> (&mut Operators, &mut ContactSolver) {
        (&mut self.operators, &mut self.contact)
    }

    /// Finds the increment of the step after `state`.
    pub(crate) fn solve(
        &mut self,
        scene: &Scene,
        structure: &dyn Structure,
        state: &State,
        forcing: &Forcing,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        self.predict(scene, state, forcing);
        if let Some(mut newton) = self.newton.take() {
            let solved = newton.solve(self, scene, structure, state, forcing, increment);
            self.newton = Some(newton);
            solved?;
        } else {
            increment.displacement.copy_from_slice(&self.known);
            self.solve_contact(scene, state, forcing, increment)?;
        }
        if increment.displacement.iter().any(|x| !x.is_finite()) {
            let quantity = "displacement of the structure";
            return Err(StepError::NotFinite { quantity });
        }
        let change = largest(&increment.displacement);
        if change > RUNAWAY {
            return Err(StepError::Runaway { increment: change });
        }
        let c = &scene.coefficients;
        let Motion { velocity, acceleration, .. } = &state.motion;
        for (i, (v, a)) in velocity.iter().zip(acceleration).enumerate() {
            let du = increment.displacement[i] + forcing.carried[i];
            increment.velocity[i] = SchemeCoefficients::apply(c.new_velocity, du, *v, *a);
            increment.acceleration[i] = SchemeCoefficients::apply(c.new_acceleration, du, *v, *a);
        }
        Ok(())
    }

    /// Right-hand side of the equation of motion: loads, inertia and damping of a structure that is
    /// carried along by y, and its stiffness forces so far.
    fn predict(&mut self, scene: &Scene, state: &State, forcing: &Forcing) {
        let (c, model) = (&scene.coefficients, &scene.model);
        let Motion { displacement: u, velocity: v, acceleration: a, .. } = &state.motion;
        let carried = &forcing.carried;
        let Self { known, vector, means, .. } = self;
        known.copy_from_slice(&forcing.load);
        for (i, x) in vector.iter_mut().enumerate() {
            *x = SchemeCoefficients::apply(c.acceleration, carried[i], v[i], a[i]);
        }
        model.mass.multiply_add(-1.0, vector, known);
        if !model.damping.is_empty() {
            for (i, x) in vector.iter_mut().enumerate() {
                *x = SchemeCoefficients::apply(c.velocity, carried[i], v[i], a[i]);
            }
            let velocities = forcing.translations.iter().map(|translation| translation.velocity);
            model.influence.translate(-1.0, velocities, vector);
            model.damping.multiply_add(-1.0, vector, known);
        }
        for (i, x) in vector.iter_mut().enumerate() {
            *x = u[i] + SchemeCoefficients::apply(c.displacement, 0.0, v[i], a[i]);
        }
        scene.subtract_base(vector, means);
        model.stiffness.multiply_add(-1.0, vector, known);
    }

    /// Takes the right-hand side in the increment's displacement and leaves the increment there.
    pub(super) fn solve_contact(
        &mut self,
        scene: &Scene,
        state: &State,
        forcing: &Forcing,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        let Self { operators, contact, search, free_jump, means, vector, .. } = self;
        operators.solve(&mut increment.displacement);
        let displacement = &state.motion.displacement;
        for ((x, u), du) in vector.iter_mut().zip(displacement).zip(&increment.displacement) {
            *x = u + du;
        }
        scene.base.means(vector, means);
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
            return Err(StepError::NotFinite { quantity: "displacement of the structure" });
        }
        let input = ContactInput {
            delassus: &operators.delassus,
            free_jump,
            static_traction: &scene.static_state.traction,
            start: &state.start,
            laws: &scene.laws,
            length_scale,
        };
        increment.modes.copy_from_slice(&state.modes);
        let (trials, method) = search.solve(contact, &input, &mut increment.modes)?;
        (increment.trials, increment.method) = (trials, method);
        increment.traction.copy_from_slice(&contact.traction);
        increment.contact.copy_from_slice(&contact.states);
        let answer = &mut increment.displacement;
        wide_transposed_multiply_add(&operators.columns, -1.0, &contact.traction, answer);
        Ok(())
    }
}
