//! Linear part of a step: the free increment, the contact problem, and the response to the tractions.
//!
//! | symbol | meaning |
//! |---|---|
//! | Δu | increment of displacement relative to the free field's translation y |
//! | u*, v*, a* | motion at the time at which the scheme writes the equation of motion |
//! | τ | change of contact traction against the static state |
//! | B | element means of the base displacement |
//! | R | influence vectors |

use super::modal_loops::{apply_tractions, free_increment};
use crate::contact::{ContactInput, ContactSearch, ContactSolver};
use crate::coupled::model::kinematics::Kinematics;
use crate::coupled::model::operators::Operators;
use crate::coupled::scene::Scene;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::step::forcing::StepData;
use crate::coupled::step::increment::Increment;
use crate::error::StepError;
use crate::linalg::transposed_multiply_add;

/// Factored operators, the contact problem and the scratch of a step.
pub(crate) struct LinearStep {
    /// Valid while the tangent is unchanged.
    pub(crate) operators: Operators,
    pub(crate) contact: ContactSolver,
    /// Right-hand side of K_eff Δu = …, without contact and nonlinear force.
    pub(crate) right_side: Vec<f64>,
    free_jump: Vec<f64>,
    pub(crate) means: Vec<f64>,
    vector: Vec<f64>,
}

impl LinearStep {
    pub(crate) fn new(scene: &Scene, operators: Operators, search: ContactSearch) -> Self {
        let n = scene.model.coordinates;
        Self {
            operators,
            contact: ContactSolver::new(
                scene.layout(),
                scene.base.areas(),
                scene.model.linear,
                search,
            ),
            right_side: vec![0.0; n],
            free_jump: vec![0.0; scene.layout().len()],
            means: vec![0.0; scene.layout().len()],
            vector: vec![0.0; n],
        }
    }

    /// Computes the right-hand side of the equation of motion.
    ///
    /// Loads, inertia and damping of a structure that moves with y, and its stiffness forces so far.
    pub(crate) fn predict(&mut self, StepData { scene, state, forcing, .. }: StepData<'_>) {
        let c = &scene.coefficients;
        let model = &scene.model;
        let Kinematics { displacement: u, velocity: v, acceleration: a, .. } = &state.kinematics;
        let carried = &forcing.carried;
        let Self { right_side, vector, means, .. } = self;
        right_side.copy_from_slice(&forcing.load);
        SchemeCoefficients::combine(c.acceleration, carried, v, a, vector);
        model.mass.multiply_add(-1.0, vector, right_side);
        if model.damped {
            SchemeCoefficients::combine(c.velocity, carried, v, a, vector);
            vector.iter_mut().zip(&forcing.dragged).for_each(|(v, dragged)| *v -= dragged);
            model.damping.multiply_add(-1.0, vector, right_side);
        }
        for (x, ((u, v), a)) in vector.iter_mut().zip(u.iter().zip(v).zip(a)) {
            *x = u + SchemeCoefficients::apply(c.displacement, 0.0, *v, *a);
        }
        scene.subtract_base(vector, means);
        model.stiffness.multiply_add(-1.0, vector, right_side);
    }

    /// Computes the increment of a linear structure, and the motion at its end.
    pub(crate) fn solve(
        &mut self,
        data: StepData<'_>,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        let StepData { scene, state, forcing, .. } = data;
        let scheme = &scene.coefficients;
        let kinematics = &state.kinematics;
        let Some(matrices) = scene.model.diagonals() else {
            self.predict(data);
            increment.displacement.copy_from_slice(&self.right_side);
            self.solve_contact(data, increment)?;
            increment.follow(data);
            return Ok(());
        };
        free_increment(
            scheme,
            matrices,
            self.operators.reciprocals(),
            kinematics,
            forcing,
            increment,
        );
        self.solve_tractions(data, increment)?;
        let Self { operators, contact, vector, .. } = self;
        vector.fill(0.0);
        scene.base.add_forces(1.0, &contact.response().traction, vector);
        let inverse = operators.reciprocals();
        apply_tractions(scheme, inverse, vector, kinematics, &forcing.carried, increment);
        Ok(())
    }

    /// Solves for the increment; on entry its displacement contains the right-hand side.
    pub(crate) fn solve_contact(
        &mut self,
        data: StepData<'_>,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        self.operators.solve(&mut increment.displacement);
        increment.reach(data.state);
        self.solve_tractions(data, increment)?;
        transposed_multiply_add(
            &self.operators.columns,
            -1.0,
            &self.contact.response().traction,
            &mut increment.displacement,
        );
        Ok(())
    }

    /// Contact tractions for the displacement at the end of the step without their change.
    fn solve_tractions(
        &mut self,
        data: StepData<'_>,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        let StepData { scene, state, forcing, .. } = data;
        let Self { operators, contact, free_jump, means, .. } = self;
        scene.base.means(&increment.end, means);
        let mut length_scale = 0.0_f64;
        for (i, jump) in free_jump.iter_mut().enumerate() {
            let ground = forcing.distortion[i] + forcing.history[i];
            let base = means[i];
            *jump = ground - base;
            length_scale = length_scale.max(ground.abs()).max(base.abs());
        }
        for (jump, gap) in free_jump.iter_mut().zip(&scene.static_state.gap) {
            *jump += gap;
        }
        // `max` ignores NaN, so the jumps themselves are checked.
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
            trial_settlements: &[],
            frictionless: false,
        };
        increment.modes.copy_from_slice(&state.modes);
        (increment.trials, increment.method) = contact.solve(&input, &mut increment.modes)?;
        increment.substituted_friction = contact.substituted_friction();
        let response = contact.response();
        increment.traction.copy_from_slice(&response.traction);
        increment.contact.copy_from_slice(&response.states);
        Ok(())
    }
}
