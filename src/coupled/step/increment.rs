//! What one step changes.

use crate::contact::SearchMethod;
use crate::coupled::scene::Scene;
use crate::interface::{ContactState, Mode};

/// The answer to a [`Forcing`](super::forcing::Forcing); nothing of it is committed yet.
pub(crate) struct Increment {
    /// Δu relative to the free field's translation, in stepped coordinates.
    pub(crate) displacement: Vec<f64>,
    /// Total velocity and acceleration at the end of the step.
    pub(crate) velocity: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
    /// Change of traction against the static state, 2Q.
    pub(crate) traction: Vec<f64>,
    /// Openings and total tractions at the end, per element.
    pub(crate) contact: Vec<ContactState>,
    /// Mode of each element.
    pub(crate) modes: Vec<Mode>,
    /// Linear solves of the mode search, and how far it had to go.
    pub(crate) trials: usize,
    pub(crate) method: SearchMethod,
    /// f(u*) less f at the static state, and the displacement that f sees at the end of the step;
    /// empty for a linear structure.
    pub(crate) force: Vec<f64>,
    pub(crate) seen: Vec<f64>,
}

impl Increment {
    pub(crate) fn new(scene: &Scene) -> Self {
        let (n, count) = (scene.model.unknowns, scene.count());
        let nonlinear = if scene.model.linear { 0 } else { n };
        Self {
            displacement: vec![0.0; n],
            velocity: vec![0.0; n],
            acceleration: vec![0.0; n],
            traction: vec![0.0; 2 * count],
            contact: vec![ContactState::default(); count],
            modes: vec![Mode::Stick; count],
            trials: 0,
            method: SearchMethod::ActiveSet,
            force: vec![0.0; nonlinear],
            seen: vec![0.0; nonlinear],
        }
    }
}
