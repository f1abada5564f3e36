//! Linear part of a step: free increment, contact, and response to tractions.
//!
//! | symbol | meaning |
//! |---|---|
//! | Δu | increment of displacement relative to the free field's translation y |
//! | u*, v*, a* | motion at the time of the scheme's equation of motion |
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

/// Solver of a linear step: factored operators, contact problem and buffers.
pub(crate) struct LinearStep {
    /// Operators, valid while the tangent does not change.
    pub(crate) operators: Operators,
    pub(crate) contact: ContactSolver,
    /// Right-hand side of K_eff Δu = …, without contact and nonlinear force.
    pub(crate) right_hand_side: Vec<f64>,
    /// Jump between soil and base without the change of traction, m.
    free_jump: Vec<f64>,
    /// Mean displacements of the base over the elements, m.
    pub(crate) base_means: Vec<f64>,
    scratch: Vec<f64>,
}

impl LinearStep {
    /// Solver for a scene's steps.
    pub(crate) fn new(scene: &Scene, operators: Operators, search: ContactSearch) -> Self {
        let coordinates = scene.model.coordinate_count;
        Self {
            operators,
            contact: ContactSolver::new(
                scene.layout(),
                scene.base.areas(),
                scene.model.is_linear,
                search,
            ),
            right_hand_side: vec![0.0; coordinates],
            free_jump: vec![0.0; scene.layout().len()],
            base_means: vec![0.0; scene.layout().len()],
            scratch: vec![0.0; coordinates],
        }
    }

    /// Computes the right-hand side of the equation of motion.
    ///
    /// It contains the loads, inertia and damping of a motion with y, and the stiffness forces at the start of the step.
    pub(crate) fn predict(&mut self, StepData { scene, state, forcing, .. }: StepData<'_>) {
        let c = &scene.coefficients;
        let model = &scene.model;
        let Kinematics { displacement: u, velocity: v, acceleration: a, .. } = &state.kinematics;
        let translation_increment = &forcing.translation_increment;
        let Self { right_hand_side, scratch, base_means, .. } = self;
        right_hand_side.copy_from_slice(&forcing.load);
        SchemeCoefficients::combine(c.acceleration, translation_increment, v, a, scratch);
        model.mass.multiply_add(-1.0, scratch, right_hand_side);
        if model.is_damped {
            SchemeCoefficients::combine(c.velocity, translation_increment, v, a, scratch);
            scratch.iter_mut().zip(&forcing.translation_velocity).for_each(|(v, y)| *v -= y);
            model.damping.multiply_add(-1.0, scratch, right_hand_side);
        }
        for (x, ((u, v), a)) in scratch.iter_mut().zip(u.iter().zip(v).zip(a)) {
            *x = u + SchemeCoefficients::apply(c.displacement, 0.0, *v, *a);
        }
        scene.subtract_base_translation(scratch, base_means);
        model.stiffness.multiply_add(-1.0, scratch, right_hand_side);
    }

    /// Computes the increment of a linear structure, and the motion at the end of the step.
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
            increment.displacement.copy_from_slice(&self.right_hand_side);
            self.solve_contact(data, increment)?;
            increment.set_end_motion(data);
            return Ok(());
        };
        free_increment(
            scheme,
            matrices,
            self.operators.inverse_diagonal(),
            kinematics,
            forcing,
            increment,
        );
        self.solve_tractions(data, increment)?;
        let Self { operators, contact, scratch, .. } = self;
        scratch.fill(0.0);
        scene.base.add_forces(1.0, &contact.response().traction, scratch);
        let inverse_diagonal = operators.inverse_diagonal();
        let translation = &forcing.translation_increment;
        apply_tractions(scheme, inverse_diagonal, scratch, kinematics, translation, increment);
        Ok(())
    }

    /// Solves for the increment with contact.
    ///
    /// The displacement of the increment must contain the right-hand side and is overwritten.
    pub(crate) fn solve_contact(
        &mut self,
        data: StepData<'_>,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        self.operators.solve(&mut increment.displacement);
        increment.set_end_displacement(data.state);
        self.solve_tractions(data, increment)?;
        let Self { operators, contact, scratch, .. } = self;
        let traction = &contact.response().traction;
        operators.add_response(&data.scene.base, traction, scratch, &mut increment.displacement);
        Ok(())
    }

    /// Solves the contact problem, for an end displacement without the change of traction.
    fn solve_tractions(
        &mut self,
        data: StepData<'_>,
        increment: &mut Increment,
    ) -> Result<(), StepError> {
        let StepData { scene, state, forcing, .. } = data;
        let Self { operators, contact, free_jump, base_means, .. } = self;
        scene.base.means(&increment.end_displacement, base_means);
        let mut length_scale = 0.0_f64;
        for (i, jump) in free_jump.iter_mut().enumerate() {
            let soil_displacement = forcing.distortion[i] + forcing.history[i];
            let base_displacement = base_means[i];
            *jump = soil_displacement - base_displacement;
            length_scale = length_scale.max(soil_displacement.abs()).max(base_displacement.abs());
        }
        for (jump, gap) in free_jump.iter_mut().zip(&scene.static_state.gap) {
            *jump += gap;
        }
        // `max` ignores NaN, so the jumps themselves are checked.
        if !(length_scale.is_finite() && free_jump.iter().all(|jump| jump.is_finite())) {
            StepError::check_finite("displacement of the structure", &increment.end_displacement)?;
            StepError::check_finite("jump between soil and base", free_jump)?;
            StepError::check_finite("displacement of the base", base_means)?;
        }
        let input = ContactInput {
            delassus: &operators.delassus,
            free_jump,
            static_traction: &scene.static_state.traction,
            start: &state.start,
            laws: &scene.laws,
            length_scale,
            bonds: &[],
            trial_lines: &[],
            frictionless: false,
        };
        state.copy_modes(&mut increment.modes);
        (increment.trials, increment.method) = contact.solve(&input, &mut increment.modes)?;
        increment.substituted_friction = contact.substituted_friction();
        let response = contact.response();
        increment.traction.copy_from_slice(&response.traction);
        increment.contact.copy_from_slice(&response.states);
        Ok(())
    }
}
