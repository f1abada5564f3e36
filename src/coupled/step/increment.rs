//! Changes of one step.

use super::forcing::StepData;
use crate::contact::SearchMethod;
use crate::coupled::model::kinematics::Kinematics;
use crate::coupled::scene::Scene;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::state::State;
use crate::error::LawError;
use crate::interface::{ContactState, Mode};

/// Response to a [`Forcing`](super::forcing::Forcing), not yet committed.
pub(crate) struct Increment {
    /// Δu relative to the free field's translation, in stepping coordinates.
    pub(crate) displacement: Vec<f64>,
    /// Displacement at the end of the step, relative to the free field's translation.
    pub(crate) end: Vec<f64>,
    /// Total Δu, including R Δy.
    pub(crate) total: Vec<f64>,
    /// Total velocity and acceleration at the end of the step.
    pub(crate) velocity: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
    /// Change of traction against the static state, 2Q or 3Q.
    pub(crate) traction: Vec<f64>,
    /// Change of traction spread over whole elements, for the ground.
    pub(crate) spread: Vec<f64>,
    /// Openings and total tractions at the end, per element.
    pub(crate) contact: Vec<ContactState>,
    /// Mode of each element.
    pub(crate) modes: Vec<Mode>,
    /// Compliance of each element at the end; empty if all laws are hard or there is no energy balance.
    pub(crate) compliance: Vec<[f64; 2]>,
    /// State variables of the laws at the end.
    pub(crate) state_variables: Vec<f64>,
    /// Number of linear solutions of the mode search, and the last method used.
    pub(crate) trials: usize,
    pub(crate) method: SearchMethod,
    /// Friction used instead of a larger one on a sliding element; `None` if there was none.
    pub(crate) substituted_friction: Option<f64>,
    /// f(u*) minus f at the static state, and the displacement at the end of the step that f receives.
    ///
    /// Empty for a linear structure.
    pub(crate) force: Vec<f64>,
    pub(crate) force_displacement: Vec<f64>,
}

impl Increment {
    /// Memory for a step, and for compliances if `compliant`.
    pub(crate) fn new(scene: &Scene, state: &State, compliant: bool) -> Self {
        let n = scene.model.coordinates;
        let count = scene.count();
        let compliant = if compliant { count } else { 0 };
        let nonlinear = if scene.model.linear { 0 } else { n };
        Self {
            displacement: vec![0.0; n],
            end: vec![0.0; n],
            total: vec![0.0; n],
            velocity: vec![0.0; n],
            acceleration: vec![0.0; n],
            traction: vec![0.0; scene.layout().len()],
            spread: vec![0.0; scene.layout().len()],
            contact: vec![ContactState::default(); count],
            modes: vec![Mode::Stick; count],
            compliance: vec![[0.0; 2]; compliant],
            state_variables: state.start.state_variables().to_vec(),
            trials: 0,
            method: SearchMethod::ActiveSet,
            substituted_friction: None,
            force: vec![0.0; nonlinear],
            force_displacement: vec![0.0; nonlinear],
        }
    }

    /// Computes the displacement at the end of the step from Δu.
    pub(crate) fn reach(&mut self, state: &State) {
        let increments = state.kinematics.displacement.iter().zip(&self.displacement);
        for (end, (u, du)) in self.end.iter_mut().zip(increments) {
            *end = u + du;
        }
    }

    /// Computes displacement, velocity and acceleration at the end, and the total Δu.
    pub(crate) fn follow(&mut self, StepData { scene, state, forcing, .. }: StepData<'_>) {
        self.reach(state);
        let increments = self.displacement.iter().zip(&forcing.carried);
        for (total, (du, y)) in self.total.iter_mut().zip(increments) {
            *total = du + y;
        }
        let Kinematics { velocity, acceleration, .. } = &state.kinematics;
        let c = &scene.coefficients;
        let total = &self.total;
        let new_velocity = &mut self.velocity;
        let new_acceleration = &mut self.acceleration;
        SchemeCoefficients::combine(c.new_velocity, total, velocity, acceleration, new_velocity);
        let coefficients = c.new_acceleration;
        SchemeCoefficients::combine(coefficients, total, velocity, acceleration, new_acceleration);
    }

    /// Evaluates the laws' compliances at the end of the step after `state`, and their state variables.
    pub(crate) fn ask_laws(&mut self, scene: &Scene, state: &State) -> Result<(), LawError> {
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
