//! Increment of one step: changes of motion and contact, not yet committed.

use super::forcing::StepData;
use crate::contact::SearchMethod;
use crate::coupled::model::kinematics::Kinematics;
use crate::coupled::scene::Scene;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::state::State;
use crate::error::LawError;
use crate::interface::{ContactState, Mode};

/// Response of a step to its [`Forcing`](super::forcing::Forcing), not yet committed.
pub(crate) struct Increment {
    /// Δu relative to the free field's translation, in stepping coordinates.
    pub(crate) displacement: Vec<f64>,
    /// Displacement at the end of the step, relative to the free field's translation.
    pub(crate) end_displacement: Vec<f64>,
    /// Total Δu, including R Δy.
    pub(crate) total_displacement: Vec<f64>,
    /// Total velocity at the end of the step.
    pub(crate) end_velocity: Vec<f64>,
    /// Total acceleration at the end of the step.
    pub(crate) end_acceleration: Vec<f64>,
    /// Change of traction against the static state, Pa, 2Q or 3Q.
    pub(crate) traction: Vec<f64>,
    /// Change of traction on whole elements, for the ground, Pa.
    pub(crate) spread_traction: Vec<f64>,
    /// Gap, slip and total tractions of each element at the end.
    pub(crate) contact: Vec<ContactState>,
    /// Mode of each element.
    pub(crate) modes: Vec<Mode>,
    /// Normal and shear compliance of each element at the end, m/Pa.
    ///
    /// Empty without compliant laws, and without an energy balance.
    pub(crate) compliance: Vec<[f64; 2]>,
    /// State variables of the laws at the end.
    pub(crate) state_variables: Vec<f64>,
    /// Number of trials of the search for contact modes, as in `State::trials`.
    pub(crate) trials: usize,
    /// Last method of the mode search.
    pub(crate) method: SearchMethod,
    /// Friction coefficient that replaced a larger coefficient on a sliding element.
    ///
    /// `None` if no coefficient was replaced.
    pub(crate) substituted_friction: Option<f64>,
    /// f(u*) minus f at the static state; empty for a linear structure.
    pub(crate) nonlinear_force: Vec<f64>,
    /// Displacement u* that f receives in the equation of motion.
    ///
    /// Empty for a linear structure.
    pub(crate) midstep_displacement: Vec<f64>,
    /// Displacement at the end of the step that f receives.
    ///
    /// Empty for a linear structure.
    pub(crate) force_displacement: Vec<f64>,
}

impl Increment {
    /// Buffers for a step; `stores_compliance` includes a buffer for compliances.
    pub(crate) fn new(scene: &Scene, state: &State, stores_compliance: bool) -> Self {
        let coordinates = scene.model.coordinate_count;
        let element_count = scene.element_count();
        let compliance_count = if stores_compliance { element_count } else { 0 };
        let force_count = if scene.model.is_linear { 0 } else { coordinates };
        Self {
            displacement: vec![0.0; coordinates],
            end_displacement: vec![0.0; coordinates],
            total_displacement: vec![0.0; coordinates],
            end_velocity: vec![0.0; coordinates],
            end_acceleration: vec![0.0; coordinates],
            traction: vec![0.0; scene.layout().len()],
            spread_traction: vec![0.0; scene.base.elements().layout().len()],
            contact: vec![ContactState::default(); element_count],
            modes: vec![Mode::Stick; element_count],
            compliance: vec![[0.0; 2]; compliance_count],
            state_variables: state.start.state_variables().to_vec(),
            trials: 0,
            method: SearchMethod::ActiveSet,
            substituted_friction: None,
            nonlinear_force: vec![0.0; force_count],
            midstep_displacement: vec![0.0; force_count],
            force_displacement: vec![0.0; force_count],
        }
    }

    /// Computes the change of traction on the ground.
    ///
    /// The tractions of the free field are subtracted; `free_traction` is empty on the surface.
    pub(crate) fn set_ground_traction(&mut self, scene: &Scene, free_traction: &[f64]) {
        let Self { traction, spread_traction, .. } = self;
        scene.base.copy_ground_part(traction, spread_traction);
        if free_traction.is_empty() {
            return;
        }
        let ground_layout = scene.base.elements().layout();
        for (i, value) in spread_traction.iter_mut().enumerate() {
            let [component, e] = ground_layout.component_and_element(i);
            *value -= free_traction[scene.layout().index_of(component, e)];
        }
    }

    /// Computes the displacement at the end of the step from Δu.
    pub(crate) fn set_end_displacement(&mut self, state: &State) {
        let pairs = state.kinematics.displacement.iter().zip(&self.displacement);
        for (end, (u, du)) in self.end_displacement.iter_mut().zip(pairs) {
            *end = u + du;
        }
    }

    /// Computes the motion at the end of the step, and the total Δu, from Δu.
    pub(crate) fn set_end_motion(&mut self, StepData { scene, state, forcing, .. }: StepData<'_>) {
        self.set_end_displacement(state);
        let increments = self.displacement.iter().zip(&forcing.translation_increment);
        for (total, (du, dy)) in self.total_displacement.iter_mut().zip(increments) {
            *total = du + dy;
        }
        let Kinematics { velocity, acceleration, .. } = &state.kinematics;
        let c = &scene.coefficients;
        let total = &self.total_displacement;
        let end_velocity = &mut self.end_velocity;
        SchemeCoefficients::combine(c.new_velocity, total, velocity, acceleration, end_velocity);
        let coefficients = c.new_acceleration;
        let end_acceleration = &mut self.end_acceleration;
        SchemeCoefficients::combine(coefficients, total, velocity, acceleration, end_acceleration);
    }

    /// Evaluates the laws' compliances and state variables at the end of the step after `state`.
    pub(crate) fn evaluate_laws(&mut self, scene: &Scene, state: &State) -> Result<(), LawError> {
        for (e, compliance) in self.compliance.iter_mut().enumerate() {
            *compliance = scene.compliance(e, self.modes[e], &state.start)?;
        }
        state.start.update_state_variables(
            &scene.laws,
            &self.contact,
            &self.modes,
            &mut self.state_variables,
        )
    }
}
