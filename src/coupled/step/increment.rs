//! Changes of one step.

use super::forcing::Forcing;
use crate::contact::SearchMethod;
use crate::coupled::motion::Motion;
use crate::coupled::scene::Scene;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::state::State;
use crate::error::LawError;
use crate::interface::{ContactState, Mode};

/// The answer to a [`Forcing`](super::forcing::Forcing); nothing of it is committed yet.
pub(crate) struct Increment {
    /// Δu relative to the free field's translation, in stepped coordinates.
    pub(crate) displacement: Vec<f64>,
    /// Displacement at the end of the step, relative likewise.
    pub(crate) end: Vec<f64>,
    /// Total Δu, with the share R Δy of the free field's translation.
    pub(crate) total: Vec<f64>,
    /// Total velocity and acceleration at the end of the step.
    pub(crate) velocity: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
    /// Change of traction against the static state, 2Q.
    pub(crate) traction: Vec<f64>,
    /// Openings and total tractions at the end, per element.
    pub(crate) contact: Vec<ContactState>,
    /// Mode of each element.
    pub(crate) modes: Vec<Mode>,
    /// Compliance of each element at the end; empty if all laws are hard or no energy balance is kept.
    pub(crate) compliance: Vec<[f64; 2]>,
    /// Memory of the laws at the end.
    pub(crate) memory: Vec<f64>,
    /// Linear solves of the mode search, and how far it had to go.
    pub(crate) trials: usize,
    pub(crate) method: SearchMethod,
    /// f(u*) less f at the static state, and the displacement that f sees at the end of the step;
    /// empty for a linear structure.
    pub(crate) force: Vec<f64>,
    pub(crate) seen: Vec<f64>,
}

impl Increment {
    /// Room for a step, and for compliances if they are asked for.
    pub(crate) fn new(scene: &Scene, state: &State, compliant: bool) -> Self {
        let (n, count) = (scene.model.coordinates, scene.count());
        let compliant = if compliant { count } else { 0 };
        let nonlinear = if scene.model.linear { 0 } else { n };
        Self {
            displacement: vec![0.0; n],
            end: vec![0.0; n],
            total: vec![0.0; n],
            velocity: vec![0.0; n],
            acceleration: vec![0.0; n],
            traction: vec![0.0; scene.layout().len()],
            contact: vec![ContactState::default(); count],
            modes: vec![Mode::Stick; count],
            compliance: vec![[0.0; 2]; compliant],
            memory: state.start.memory().to_vec(),
            trials: 0,
            method: SearchMethod::ActiveSet,
            force: vec![0.0; nonlinear],
            seen: vec![0.0; nonlinear],
        }
    }

    /// Displacement at the end of the step, from Δu.
    pub(super) fn reach(&mut self, state: &State) {
        let increments = state.motion.displacement.iter().zip(&self.displacement);
        self.end.iter_mut().zip(increments).for_each(|(end, (u, du))| *end = u + du);
    }

    /// Displacement, velocity and acceleration at the end, and the total Δu.
    pub(super) fn follow(&mut self, scene: &Scene, state: &State, forcing: &Forcing) {
        self.reach(state);
        let increments = self.displacement.iter().zip(&forcing.carried);
        self.total.iter_mut().zip(increments).for_each(|(total, (du, y))| *total = du + y);
        let Motion { velocity, acceleration, .. } = &state.motion;
        let (c, total) = (&scene.coefficients, &self.total);
        let [new_velocity, new_acceleration] = [&mut self.velocity, &mut self.acceleration];
        SchemeCoefficients::combine(c.new_velocity, total, velocity, acceleration, new_velocity);
        let coefficients = c.new_acceleration;
        SchemeCoefficients::combine(coefficients, total, velocity, acceleration, new_acceleration);
    }

    /// Asks the laws for the compliance that the step after `state` ends with and what they
    /// remember of it.
    pub(crate) fn ask_laws(&mut self, scene: &Scene, state: &State) -> Result<(), LawError> {
        for (e, compliance) in self.compliance.iter_mut().enumerate() {
            *compliance = scene.compliance(e, self.modes[e], &state.start)?;
        }
        state.start.remember(&scene.laws, &self.contact, &self.modes, &mut self.memory)
    }
}
